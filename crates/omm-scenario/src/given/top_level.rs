//! `tlas(["card", inactive, (of: "card", mask: 1)])`: instances.

use omm_layout::{instance, motion_instance};
use omm_model::vk::{self, MotionInstanceData};

use super::bottom_level::{matrix, numbers};
use crate::error::Mistake;
use crate::node::{Arguments, Kind, Node};
use crate::world::{Cost, Preparation, Recipe, World};

impl World {
    /// `tlas(…)`
    pub(super) fn top_level(&mut self, name: &str, node: &Node, wanted: Preparation) -> Result<String, Mistake> {
        let arguments = Arguments::of(node, &["instances", "flags", "pointers", "created_as", "size", "built"])?;
        let nodes = arguments.need("instances")?.list()?;
        self.spend(Cost::Primitives, nodes.len() as u64, node)?;
        let mut flags: vk::BuildAccelerationStructureFlags = self.typed_or_default(arguments.get("flags"))?;
        let mut instances = Vec::with_capacity(nodes.len());
        for node in nodes {
            instances.push((self.instance(node)?, node));
        }
        if instances.iter().any(|(instance, _)| instance.ty() != vk::MotionInstanceType::STATIC) {
            flags |= vk::BuildAccelerationStructureFlags::MOTION;
        }
        let motion = flags.contains(vk::BuildAccelerationStructureFlags::MOTION);
        let array_of_pointers = arguments.get("pointers").map_or(Ok(false), Node::boolean)?;
        let stride = if motion { motion_instance::STRIDE } else { instance::SIZE as u64 };
        let mut bytes = Vec::with_capacity(nodes.len() * stride as usize);
        for (instance, node) in &instances {
            // A pointer leads to the structure itself, which says nothing about its type.
            let encoded = if motion && !array_of_pointers {
                motion_instance::encode(instance).map(|bytes| bytes.to_vec())
            } else {
                motion_instance::encode_data(instance)
            };
            let end = bytes.len() + stride as usize;
            bytes.extend(encoded.map_err(|error| node.mistake(error.to_string()))?);
            bytes.resize(end, 0);
        }
        let mut data = self.upload(&format!("{name}.instances"), &bytes, node)?;
        if array_of_pointers {
            let pointer = |(index, (instance, _)): (u64, &(MotionInstanceData, &Node))| {
                let ty = if motion { instance.ty().0 as u64 } else { 0 };
                data.checked_add(index * stride + ty)
            };
            let pointers = (0..).zip(&instances).filter_map(pointer);
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
            flags,
            geometries: Some(vec![geometry]),
            ..Default::default()
        });
        let ranges = vec![vk::BuildRangeInfo { primitive_count: nodes.len() as u32, ..Default::default() }];
        let (storage, wanted) = self.storage(&arguments, wanted)?;
        let recipe = Recipe::AccelerationStructure { info, ranges: Some(ranges) };
        self.make_structure(name, recipe, &storage, wanted, node)?;
        Ok(format!("top level of {}", super::counted(nodes.len(), "instance", "instances")))
    }

    /// `"card"`, `inactive`, or `(of, mask, custom_index, offset, flags, transform)`; with `transform_end`, or with `srt` and
    /// `srt_end`, it moves.
    fn instance(&self, node: &Node) -> Result<MotionInstanceData, Mistake> {
        let identity = vk::Instance { transform: vk::TransformMatrix::IDENTITY, mask: 0xff, ..Default::default() };
        if node.name() == Some("inactive") {
            return Ok(MotionInstanceData::StaticInstance(identity));
        }
        let reference = |node: &Node| {
            let found = self.objects.address(node.text()?);
            Ok::<_, Mistake>(found.map_err(|unknown| crate::change::unknown(node, unknown))?.value)
        };
        if let Kind::Text(_) = node.kind {
            let found = vk::Instance { acceleration_structure_reference: reference(node)?, ..identity };
            return Ok(MotionInstanceData::StaticInstance(found));
        }
        let arguments = Arguments::of(node, INSTANCE)?;
        arguments.exclusive("srt", "transform")?;
        arguments.exclusive("srt", "transform_end")?;
        let transform = arguments.get("transform").map_or(Ok(identity.transform), matrix)?;
        let instance_custom_index = arguments.get("custom_index").map_or(Ok(0), Node::integer)?;
        let mask = arguments.get("mask").map_or(Ok(0xff), Node::integer)?;
        let instance_shader_binding_table_record_offset = arguments.get("offset").map_or(Ok(0), Node::integer)?;
        let flags = self.typed_or_default(arguments.get("flags"))?;
        let acceleration_structure_reference = arguments.get("of").map_or(Ok(0), reference)?;
        if let Some(node) = arguments.get("srt") {
            let transform_t0 = srt(node)?;
            return Ok(MotionInstanceData::SrtMotionInstance(vk::SrtMotionInstance {
                transform_t0,
                transform_t1: arguments.get("srt_end").map_or(Ok(transform_t0), srt)?,
                instance_custom_index,
                mask,
                instance_shader_binding_table_record_offset,
                flags,
                acceleration_structure_reference,
            }));
        }
        if let Some(node) = arguments.get("transform_end") {
            return Ok(MotionInstanceData::MatrixMotionInstance(vk::MatrixMotionInstance {
                transform_t0: transform,
                transform_t1: matrix(node)?,
                instance_custom_index,
                mask,
                instance_shader_binding_table_record_offset,
                flags,
                acceleration_structure_reference,
            }));
        }
        Ok(MotionInstanceData::StaticInstance(vk::Instance {
            transform,
            instance_custom_index,
            mask,
            instance_shader_binding_table_record_offset,
            flags,
            acceleration_structure_reference,
        }))
    }
}

/// What an instance says about itself.
const INSTANCE: &[&str] =
    &["of", "mask", "custom_index", "offset", "flags", "transform", "transform_end", "srt", "srt_end"];

/// `(scale: (1, 1, 1), shear: (0, 0, 0), pivot: (0, 0, 0), quaternion: (0, 0, 0, 1), translation: (0, 0, 0))`, each part as
/// here where it is left out. The shear is (a, b, c).
fn srt(node: &Node) -> Result<vk::SrtData, Mistake> {
    let arguments = Arguments::of(node, &["scale", "shear", "pivot", "quaternion", "translation"])?;
    let three = |name: &str, default: f32| arguments.get(name).map_or(Ok([default; 3]), numbers);
    let [sx, sy, sz] = three("scale", 1.0)?;
    let [a, b, c] = three("shear", 0.0)?;
    let [pvx, pvy, pvz] = three("pivot", 0.0)?;
    let [qx, qy, qz, qw] = arguments.get("quaternion").map_or(Ok([0.0, 0.0, 0.0, 1.0]), numbers)?;
    let [tx, ty, tz] = three("translation", 0.0)?;
    Ok(vk::SrtData { sx, a, b, pvx, sy, c, pvy, sz, pvz, qx, qy, qz, qw, tx, ty, tz })
}
