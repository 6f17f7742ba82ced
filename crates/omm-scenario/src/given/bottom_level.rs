//! `blas(triangles: 2, micromap: "leaf", indices: u16([0, T]))`: triangles, with a micromap or without, and boxes.

use omm_layout::{aabb, transform};
use omm_model::vk;

use crate::error::Mistake;
use crate::node::{Arguments, Kind, Node};
use crate::world::{Cost, Handle, Preparation, Recipe, World};

/// What a geometry says about itself; a structure of one geometry says it in its own parentheses.
const GEOMETRY: &[&str] = &[
    "triangles",
    "triangles_end",
    "micromap",
    "indices",
    "base_triangle",
    "index_stride",
    "vertex_indices",
    "transform",
    "geometry_flags",
    "aabbs",
];
const STRUCTURE: &[&str] = &[
    "triangles",
    "triangles_end",
    "micromap",
    "indices",
    "base_triangle",
    "index_stride",
    "vertex_indices",
    "transform",
    "geometry_flags",
    "aabbs",
    "geometries",
    "flags",
    "created_as",
    "size",
    "built",
];

/// Micromap indices: how they are stored, and which.
struct Indices {
    ty: vk::IndexType,
    values: Vec<i64>,
}

impl World {
    /// `blas(…)`
    pub(super) fn bottom_level(&mut self, name: &str, node: &Node, wanted: Preparation) -> Result<String, Mistake> {
        let arguments = Arguments::of(node, STRUCTURE)?;
        let (mut geometries, mut ranges, mut descriptions) = (Vec::new(), Vec::new(), Vec::new());
        let mut add = |(geometry, range, description): (vk::Geometry, vk::BuildRangeInfo, String)| {
            geometries.push(geometry);
            ranges.push(range);
            descriptions.push(description);
        };
        match arguments.get("geometries") {
            Some(list) => {
                arguments.exclusive("geometries", "triangles")?;
                arguments.exclusive("geometries", "aabbs")?;
                for (index, node) in list.list()?.iter().enumerate() {
                    let prefix = format!("{name}[{index}]");
                    add(self.geometry(&prefix, &Arguments::of(node, GEOMETRY)?, node)?);
                }
            }
            None => add(self.geometry(name, &arguments, node)?),
        }
        let info = Box::new(vk::BuildGeometryInfo {
            ty: vk::AccelerationStructureType::BOTTOM_LEVEL,
            flags: self.typed_or_default(arguments.get("flags"))?,
            geometries: Some(geometries),
            ..Default::default()
        });
        let (storage, wanted) = self.storage(&arguments, wanted)?;
        self.make_structure(
            name,
            Recipe::AccelerationStructure { info, ranges: Some(ranges) },
            &storage,
            wanted,
            node,
        )?;
        let is_built = if wanted < Preparation::Built { ", not built" } else { "" };
        Ok(format!("bottom level of {}{is_built}", descriptions.join(" and ")))
    }

    fn geometry(
        &mut self,
        prefix: &str,
        arguments: &Arguments<'_>,
        node: &Node,
    ) -> Result<(vk::Geometry, vk::BuildRangeInfo, String), Mistake> {
        arguments.exclusive("triangles", "aabbs")?;
        let flags = self.typed_or_default(arguments.get("geometry_flags"))?;
        if let Some(boxes) = arguments.get("aabbs") {
            let boxes = self.boxes(boxes)?;
            let bytes: Vec<u8> = boxes.iter().flat_map(aabb::encode).collect();
            let data = self.upload(&format!("{prefix}.boxes"), &bytes, node)?;
            let data = vk::GeometryAabbsData { data: data.into(), stride: aabb::SIZE as u64, ..Default::default() };
            let geometry = vk::Geometry {
                geometry_type: vk::GeometryType::AABBS,
                geometry: vk::GeometryData::Aabbs(data),
                flags,
                ..Default::default()
            };
            let range = vk::BuildRangeInfo { primitive_count: boxes.len() as u32, ..Default::default() };
            return Ok((geometry, range, super::counted(boxes.len(), "box", "boxes")));
        }
        let triangles = self.triangles(arguments.need("triangles")?)?;
        let count = triangles.len() as u32;
        let vertices = self.upload(&format!("{prefix}.vertices"), &corners(&triangles), node)?;
        let index_type = arguments.get("vertex_indices").map_or(Ok(vk::IndexType::UINT32), index_type)?;
        let size = index_type.size().unwrap_or(0) as usize;
        let bytes: Vec<u8> = (0..3 * count).flat_map(|index| index.to_le_bytes().into_iter().take(size)).collect();
        let mut index_data = vk::DeviceAddress::NULL;
        if size > 0 {
            index_data = self.upload(&format!("{prefix}.indices"), &bytes, node)?;
        }
        let mut transform_data = vk::DeviceAddress::NULL;
        if let Some(node) = arguments.get("transform") {
            let bytes = transform::encode(&matrix(node)?);
            transform_data = self.upload(&format!("{prefix}.transform"), &bytes, node)?;
        }
        let mut description = super::counted(triangles.len(), "triangle", "triangles");
        let mut next = self.attached(prefix, arguments, count, node)?;
        if let (Some(micromap), false) = (arguments.get("micromap"), next.is_empty()) {
            description += &format!(" with {}", micromap.describe().trim_matches('"'));
        }
        if let Some(ends) = arguments.get("triangles_end") {
            let triangles = self.triangles(ends)?;
            if triangles.len() != count as usize {
                return Err(ends.mistake(format!("{} triangles end where {count} begin", triangles.len())));
            }
            let vertex_data = self.upload(&format!("{prefix}.vertices_end"), &corners(&triangles), node)?.into();
            next.push(vk::GeometryMotionTrianglesData { vertex_data, ..Default::default() }.into());
            description += " that move";
        }
        let triangles = vk::GeometryTrianglesData {
            next,
            vertex_format: vk::Format::R32G32B32_SFLOAT,
            vertex_data: vertices.into(),
            vertex_stride: 12,
            max_vertex: (3 * count).saturating_sub(1),
            index_type,
            index_data: index_data.into(),
            transform_data: transform_data.into(),
            ..Default::default()
        };
        let geometry = vk::Geometry {
            geometry_type: vk::GeometryType::TRIANGLES,
            geometry: vk::GeometryData::Triangles(triangles),
            flags,
            ..Default::default()
        };
        Ok((geometry, vk::BuildRangeInfo { primitive_count: count, ..Default::default() }, description))
    }

    /// So many triangles side by side, or those of a list of corners; `inactive` for one without a place.
    fn triangles(&mut self, node: &Node) -> Result<Vec<[[f32; 3]; 3]>, Mistake> {
        if let Kind::Integer(_) = node.kind {
            let count: u64 = node.integer()?;
            self.spend(Cost::Primitives, count, node)?;
            let triangle = |index: u64| {
                let x = index as f32;
                [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0]]
            };
            return Ok((0..count).map(triangle).collect());
        }
        let nodes = node.list()?;
        self.spend(Cost::Primitives, nodes.len() as u64, node)?;
        let triangle = |node: &Node| match node.name() {
            Some("inactive") => Ok([[f32::NAN; 3]; 3]),
            _ => array(node, numbers),
        };
        nodes.iter().map(triangle).collect()
    }

    /// So many boxes side by side, or those of a list of corners; `inactive` for one without a place.
    fn boxes(&mut self, node: &Node) -> Result<Vec<vk::AabbPositions>, Mistake> {
        let positions = |[low, high]: [[f32; 3]; 2]| {
            let ([min_x, min_y, min_z], [max_x, max_y, max_z]) = (low, high);
            vk::AabbPositions { min_x, min_y, min_z, max_x, max_y, max_z }
        };
        if let Kind::Integer(_) = node.kind {
            let count: u64 = node.integer()?;
            self.spend(Cost::Primitives, count, node)?;
            let corners = |index: u64| [[index as f32, 0.0, 0.0], [index as f32 + 1.0, 1.0, 1.0]];
            return Ok((0..count).map(corners).map(positions).collect());
        }
        let nodes = node.list()?;
        self.spend(Cost::Primitives, nodes.len() as u64, node)?;
        let corners = |node: &Node| match node.name() {
            Some("inactive") => Ok([[f32::NAN; 3]; 2]),
            _ => array(node, numbers),
        };
        nodes.iter().map(|node| corners(node).map(positions)).collect()
    }

    /// The chain of triangles that have a micromap, or indices that say that all of them are special.
    fn attached(
        &mut self,
        prefix: &str,
        arguments: &Arguments<'_>,
        count: u32,
        node: &Node,
    ) -> Result<vk::Chain, Mistake> {
        let (micromap, indices) = (arguments.get("micromap"), arguments.get("indices"));
        if micromap.is_none() && indices.is_none() {
            return Ok(vk::Chain::new());
        }
        let indices = indices.map_or(Ok(Indices { ty: vk::IndexType::NONE, values: Vec::new() }), read_indices)?;
        let base_triangle: u32 = arguments.get("base_triangle").map_or(Ok(0), Node::integer)?;
        let size = indices.ty.size().unwrap_or(0) as usize;
        let stride = arguments.get("index_stride").map_or(Ok(size as u64), Node::integer)?;
        let mut index_buffer = vk::DeviceAddress::NULL;
        if size > 0 {
            let entries: Vec<_> = indices.values.iter().map(|value| value.to_le_bytes()).collect();
            let entries: Vec<_> = entries.iter().map(|bytes| bytes.get(..size).unwrap_or_default()).collect();
            let bytes = self.spread(&entries, stride, node)?;
            index_buffer = self.upload(&format!("{prefix}.micromap_indices"), &bytes, node)?;
        }
        let name = micromap.and_then(|node| node.text().ok());
        let handle = name.and_then(|name| self.structures.get(name)).map(|structure| structure.handle);
        if let (Some(name), Some(Handle::Micromap(micromap))) = (name, handle) {
            let usage_counts = Some(self.used(name, &indices, base_triangle, count));
            let attached = vk::TrianglesOpacityMicromapExt {
                index_type: indices.ty,
                index_buffer: index_buffer.into(),
                index_stride: stride,
                base_triangle,
                usage_counts,
                micromap,
                ..Default::default()
            };
            return Ok(vec![attached.into()]);
        }
        let attached = vk::TrianglesOpacityMicromap {
            index_type: indices.ty,
            index_buffer,
            index_stride: stride,
            base_triangle,
            micromap: match micromap {
                Some(node) => self.acceleration_structure(node)?,
                None => vk::AccelerationStructure::NULL,
            },
            ..Default::default()
        };
        Ok(vec![attached.into()])
    }

    /// How many triangles of each level and format of an EXT micromap a geometry uses.
    fn used(&self, name: &str, indices: &Indices, base_triangle: u32, count: u32) -> Vec<vk::MicromapUsageExt> {
        let mut usages: Vec<vk::MicromapUsageExt> = Vec::new();
        let triangles = self.micromaps.get(name).map(Vec::as_slice).unwrap_or_default();
        for index in 0..count {
            let value = match indices.ty {
                vk::IndexType::NONE => i64::from(index),
                _ => indices.values.get(index as usize).copied().unwrap_or(-1),
            };
            let found = usize::try_from(value + i64::from(base_triangle)).ok().filter(|_| value >= 0);
            let Some((level, format)) = found.and_then(|found| triangles.get(found)).copied() else { continue };
            match usages.iter_mut().find(|usage| (usage.subdivision_level, usage.format) == (level, format)) {
                Some(usage) => usage.count += 1,
                None => usages.push(vk::MicromapUsageExt { count: 1, subdivision_level: level, format }),
            }
        }
        usages
    }
}

/// `u8([…])`, `u16([…])` or `u32([…])`, with T, O, u and U for the special indices; `none`.
fn read_indices(node: &Node) -> Result<Indices, Mistake> {
    let ty = index_type(node)?;
    let values = match &node.kind {
        Kind::Tuple(_, values) => match values.as_slice() {
            [list] => list.list()?,
            _ => return Err(node.mistake("one list of indices is needed")),
        },
        _ => &[],
    };
    let value = |node: &Node| match node.name() {
        Some("T") => Ok(-1),
        Some("O") => Ok(-2),
        Some("u") => Ok(-3),
        Some("U") => Ok(-4),
        Some(_) => Err(node.mistake("the special indices are T, O, u and U")),
        None => node.integer::<i64>(),
    };
    Ok(Indices { ty, values: values.iter().map(value).collect::<Result<_, _>>()? })
}

/// `none`, `u8`, `u16` or `u32`.
fn index_type(node: &Node) -> Result<vk::IndexType, Mistake> {
    match node.head() {
        Some("none") => Ok(vk::IndexType::NONE),
        Some("u8") => Ok(vk::IndexType::UINT8),
        Some("u16") => Ok(vk::IndexType::UINT16),
        Some("u32") => Ok(vk::IndexType::UINT32),
        _ => Err(node.mistake(format!("{} is none of none, u8, u16 and u32", node.describe()))),
    }
}

/// The bytes of vertices.
fn corners(triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    triangles.as_flattened().as_flattened().iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// So many numbers.
pub(super) fn numbers<const N: usize>(node: &Node) -> Result<[f32; N], Mistake> {
    array(node, |number| Ok(number.float()? as f32))
}

/// Exactly `N` of something in a list or in parentheses.
fn array<T: Copy + Default, const N: usize>(
    node: &Node,
    mut element: impl FnMut(&Node) -> Result<T, Mistake>,
) -> Result<[T; N], Mistake> {
    let nodes = match &node.kind {
        Kind::List(nodes) | Kind::Tuple(None, nodes) => nodes.as_slice(),
        _ => &[],
    };
    if nodes.len() != N {
        return Err(node.mistake(format!("{N} values are needed here")));
    }
    let mut out = [T::default(); N];
    for (slot, node) in out.iter_mut().zip(nodes) {
        *slot = element(node)?;
    }
    Ok(out)
}

/// Three rows of four numbers.
pub(super) fn matrix(node: &Node) -> Result<vk::TransformMatrix, Mistake> {
    Ok(vk::TransformMatrix { matrix: array(node, numbers)? })
}
