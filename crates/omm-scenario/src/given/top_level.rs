//! `tlas(["card", inactive, (of: "card", mask: 1)])`: instances.

use omm_layout::instance;
use omm_model::vk;

use super::bottom_level::matrix;
use crate::error::Mistake;
use crate::node::{Arguments, Kind, Node};
use crate::world::{Cost, Preparation, Recipe, World};

impl World {
    /// `tlas(…)`
    pub(super) fn top_level(&mut self, name: &str, node: &Node, wanted: Preparation) -> Result<String, Mistake> {
        let arguments = Arguments::of(node, &["instances", "flags", "pointers", "created_as", "size", "built"])?;
        let nodes = arguments.need("instances")?.list()?;
        self.spend(Cost::Primitives, nodes.len() as u64, node)?;
        let mut bytes = Vec::with_capacity(nodes.len() * instance::SIZE);
        for node in nodes {
            let instance = self.instance(node)?;
            bytes.extend(instance::encode(&instance).map_err(|error| node.mistake(error.to_string()))?);
        }
        let mut data = self.upload(&format!("{name}.instances"), &bytes, node)?;
        let array_of_pointers = arguments.get("pointers").map_or(Ok(false), Node::boolean)?;
        if array_of_pointers {
            let pointers = (0..nodes.len() as u64).filter_map(|index| data.checked_add(index * instance::SIZE as u64));
            let pointers: Vec<u8> = pointers.flat_map(|pointer| pointer.0.to_le_bytes()).collect();
            data = self.upload(&format!("{name}.pointers"), &pointers, node)?;
        }
        let data = vk::GeometryInstancesData {
            array_of_pointers: array_of_pointers.into(),
            data: data.into(),
            ..Default::default()
        };
        let geometry = vk::Geometry {
            geometry_type: vk::GeometryType::INSTANCES,
            geometry: vk::GeometryData::Instances(data),
            ..Default::default()
        };
        let info = Box::new(vk::BuildGeometryInfo {
            ty: vk::AccelerationStructureType::TOP_LEVEL,
            flags: self.typed_or_default(arguments.get("flags"))?,
            geometries: Some(vec![geometry]),
            ..Default::default()
        });
        let ranges = vec![vk::BuildRangeInfo { primitive_count: nodes.len() as u32, ..Default::default() }];
        let (storage, wanted) = self.storage(&arguments, wanted)?;
        let recipe = Recipe::AccelerationStructure { info, ranges: Some(ranges) };
        self.make_structure(name, recipe, &storage, wanted, node)?;
        Ok(format!("top level of {}", super::counted(nodes.len(), "instance", "instances")))
    }

    /// `"card"`, `inactive`, or `(of, mask, custom_index, offset, flags, transform)`.
    fn instance(&self, node: &Node) -> Result<vk::Instance, Mistake> {
        let identity = vk::Instance { transform: vk::TransformMatrix::IDENTITY, mask: 0xff, ..Default::default() };
        if node.name() == Some("inactive") {
            return Ok(identity);
        }
        let reference = |node: &Node| {
            let found = self.objects.address(node.text()?);
            Ok(found.map_err(|unknown| crate::change::unknown(node, unknown))?.value)
        };
        if let Kind::Text(_) = node.kind {
            return Ok(vk::Instance { acceleration_structure_reference: reference(node)?, ..identity });
        }
        let arguments = Arguments::of(node, &["of", "mask", "custom_index", "offset", "flags", "transform"])?;
        Ok(vk::Instance {
            transform: arguments.get("transform").map_or(Ok(identity.transform), matrix)?,
            instance_custom_index: arguments.get("custom_index").map_or(Ok(0), Node::integer)?,
            mask: arguments.get("mask").map_or(Ok(0xff), Node::integer)?,
            instance_shader_binding_table_record_offset: arguments.get("offset").map_or(Ok(0), Node::integer)?,
            flags: self.typed_or_default(arguments.get("flags"))?,
            acceleration_structure_reference: match arguments.get("of") {
                Some(node) => reference(node)?,
                None => 0,
            },
        })
    }
}
