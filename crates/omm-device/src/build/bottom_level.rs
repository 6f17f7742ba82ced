//! Bottom-level builds: triangles, with or without a micromap, and axis-aligned boxes.

use omm_layout::index::IndexType;
use omm_layout::object::{
    BlasContents, BlasGeometry, BlasPrimitives, MappedTriangle, MovingMappedTriangle, MovingVertices, TriangleVertices,
};
use omm_layout::vertex::VertexFormat;
use omm_layout::{aabb, transform};
use omm_model::call::Timeline;
use omm_model::vk;

use super::access::Access;
use super::attached::{Attached, Maps};
use super::geometry::{self, Body, Items};
use crate::device::Device;
use crate::memory::{Address, add};
use crate::undefined::{At, Reason, Stop};

impl Device {
    /// The bytes of a bottom-level structure.
    pub(crate) fn build_bottom_level(
        &self,
        info: &vk::BuildGeometryInfo,
        ranges: &[vk::BuildRangeInfo],
        timeline: Timeline,
        access: &mut Access,
    ) -> Result<Vec<u8>, Stop> {
        let array = geometry::array_name(info);
        let mut geometries = Vec::with_capacity(ranges.len());
        for (index, (geometry, range)) in info.geometries_iter().zip(ranges).enumerate() {
            let primitives = self.primitives(geometry, range, timeline, access, &format!("{array}[{index}]"))?;
            geometries.push(BlasGeometry { flags: geometry.flags, primitives });
        }
        Ok(BlasContents { flags: info.flags.bits(), geometries }.encode().map_err(super::too_large)?)
    }

    fn primitives(
        &self,
        geometry: &vk::Geometry,
        range: &vk::BuildRangeInfo,
        timeline: Timeline,
        access: &mut Access,
        at: &str,
    ) -> Result<BlasPrimitives, Stop> {
        match geometry::body(geometry).at(at)? {
            Body::Triangles(data) => {
                let at = format!("{at}.geometry.triangles");
                let triangles = self.triangles(data, range, timeline).at(&at)?;
                let ends = self.ends(data, range, timeline).at(&at)?;
                match Attached::of(data, timeline).at(&at)? {
                    Some(attached) => {
                        let at = format!("{at}.{}", attached.structure);
                        let maps = self.maps(&attached, &triangles, timeline, access, &at).at(&at)?;
                        Ok(mapped(triangles, ends, maps))
                    }
                    None => Ok(match ends {
                        None => BlasPrimitives::Triangles(triangles),
                        Some(ends) => BlasPrimitives::MovingTriangles(moving(triangles, ends).collect()),
                    }),
                }
            }
            Body::Aabbs(data) => {
                Ok(BlasPrimitives::Aabbs(self.aabbs(data, range, timeline).at("geometry.aabbs").at(at)?))
            }
            _ => Err(Reason::GeometryType { found: geometry.geometry_type }).at("geometryType").at(at),
        }
    }

    /// The triangles of a geometry at time 1, if it has motion: with the same indices and the same transformation.
    fn ends(
        &self,
        data: &vk::GeometryTrianglesData,
        range: &vk::BuildRangeInfo,
        timeline: Timeline,
    ) -> Result<Option<Vec<Option<TriangleVertices>>>, Stop> {
        let Some(motion) = data.motion_data() else { return Ok(None) };
        let end = vk::GeometryTrianglesData { vertex_data: motion.vertex_data, ..data.clone() };
        self.triangles(&end, range, timeline)
            .at("pNext<VkAccelerationStructureGeometryMotionTrianglesDataNV>")
            .map(Some)
    }

    /// The triangles of a geometry, transformed; `None` for an inactive one.
    fn triangles(
        &self,
        data: &vk::GeometryTrianglesData,
        range: &vk::BuildRangeInfo,
        timeline: Timeline,
    ) -> Result<Vec<Option<TriangleVertices>>, Stop> {
        let format = VertexFormat::try_from(data.vertex_format);
        let unknown = |found: vk::Format| match found {
            vk::Format::UNDEFINED => Reason::UnknownValue { found: found.0.into() },
            _ => Reason::Unsupported { what: "vertices of that format" },
        };
        let format = format.map_err(unknown).at("vertexFormat")?;
        let index_type = checked_index_type(data.index_type).at("indexType")?;
        let transform = self.transform(data, range, timeline).at("transformData")?;
        let corners = u64::from(range.primitive_count) * 3;
        if corners == 0 {
            return Ok(Vec::new());
        }
        let mut offset = 0;
        let indices = if index_type == IndexType::None {
            offset = range.primitive_offset.into();
            None
        } else {
            let address = Address::of(timeline, data.index_data).at("indexData")?;
            let size = index_type.size().into();
            Some(
                Items::new(&self.memory, (address, range.primitive_offset.into()), (size, size), corners)
                    .at("indexData")?,
            )
        };
        let index = |corner: u64| match &indices {
            None => Ok(corner),
            Some(indices) => {
                indices.get(corner).map(index_value).map(u64::from).at(format_args!("indexData[{corner}]"))
            }
        };
        let mut last = 0;
        for corner in if indices.is_some() { 0..corners } else { corners - 1..corners } {
            last = last.max(index(corner)?);
        }
        let address = Address::of(timeline, data.vertex_data).at("vertexData")?;
        let first = u64::from(range.first_vertex);
        // All indices are 32-bit numbers, so the count of vertices is a little more than that at most.
        let vertices =
            Items::new(&self.memory, (address, offset), (data.vertex_stride, format.size() as u64), first + last + 1);
        let vertices = vertices.at("vertexData")?;
        let vertex = |corner: u64| -> Result<Option<[f32; 3]>, Stop> {
            let number = first + index(corner)?;
            let at = format_args!("vertexData[{number}]");
            let position = format.read(vertices.get(number).at(at)?).at(at)?;
            let [x, y, z] = position;
            if x.is_nan() {
                return Ok(None);
            }
            match [y, z].iter().zip(1..).find(|(component, _)| component.is_nan()) {
                Some((_, component)) => Err(Reason::NotANumber { component }).at(at),
                None => Ok(Some(transform.as_ref().map_or(position, |matrix| transform::apply(matrix, position)))),
            }
        };
        let triangle = |first: u64| -> Result<Option<TriangleVertices>, Stop> {
            let [a, b, c] = [vertex(first)?, vertex(first + 1)?, vertex(first + 2)?];
            Ok(a.zip(b).zip(c).map(|((a, b), c)| [a, b, c]))
        };
        (0..corners).step_by(3).map(triangle).collect()
    }

    /// The transformation of a geometry, if it has one.
    fn transform(
        &self,
        data: &vk::GeometryTrianglesData,
        range: &vk::BuildRangeInfo,
        timeline: Timeline,
    ) -> Result<Option<vk::TransformMatrix>, Stop> {
        if data.transform_data.is_null() {
            return Ok(None);
        }
        let address = add(Address::of(timeline, data.transform_data)?, range.transform_offset.into())?;
        Ok(Some(transform::read(self.memory.read(address, transform::SIZE as u64)?)?))
    }

    /// The boxes of a geometry; `None` for an inactive one.
    fn aabbs(
        &self,
        data: &vk::GeometryAabbsData,
        range: &vk::BuildRangeInfo,
        timeline: Timeline,
    ) -> Result<Vec<Option<vk::AabbPositions>>, Stop> {
        let count = u64::from(range.primitive_count);
        if count == 0 {
            return Ok(Vec::new());
        }
        let address = Address::of(timeline, data.data).at("data")?;
        let start = (address, range.primitive_offset.into());
        let items = Items::new(&self.memory, start, (data.stride, aabb::SIZE as u64), count).at("data")?;
        let positions = |index: u64| -> Result<Option<vk::AabbPositions>, Stop> {
            let at = format_args!("data[{index}]");
            let positions = aabb::read(items.get(index).at(at)?).at(at)?;
            if !aabb::is_active(&positions) {
                return Ok(None);
            }
            let vk::AabbPositions { min_x: _, min_y, min_z, max_x, max_y, max_z } = positions;
            match [min_y, min_z, max_x, max_y, max_z].iter().zip(1..).find(|(component, _)| component.is_nan()) {
                Some((_, component)) => Err(Reason::NotANumber { component }).at(at),
                None => Ok(Some(positions)),
            }
        };
        (0..count).map(positions).collect()
    }
}

/// Triangles at the times 0 and 1; one that is inactive at either time is inactive.
fn moving(
    starts: Vec<Option<TriangleVertices>>,
    ends: Vec<Option<TriangleVertices>>,
) -> impl Iterator<Item = Option<MovingVertices>> {
    starts.into_iter().zip(ends).map(|(start, end)| Some([start?, end?]))
}

/// Triangles with what each has of a micromap.
fn mapped(
    triangles: Vec<Option<TriangleVertices>>,
    ends: Option<Vec<Option<TriangleVertices>>>,
    maps: Maps,
) -> BlasPrimitives {
    let Maps { micromap, maps } = maps;
    match ends {
        None => {
            let mapped =
                |(vertices, map): (Option<_>, Option<_>)| Some(MappedTriangle { vertices: vertices?, map: map? });
            let triangles = triangles.into_iter().zip(maps).map(mapped).collect();
            BlasPrimitives::MicromapTriangles { micromap, triangles }
        }
        Some(ends) => {
            let mapped =
                |(vertices, map): (Option<_>, Option<_>)| Some(MovingMappedTriangle { vertices: vertices?, map: map? });
            let triangles = moving(triangles, ends).zip(maps).map(mapped).collect();
            BlasPrimitives::MovingMicromapTriangles { micromap, triangles }
        }
    }
}

pub(super) fn checked_index_type(raw: vk::IndexType) -> Result<IndexType, Reason> {
    IndexType::try_from(raw).map_err(|found| Reason::UnknownValue { found: found.0.into() })
}

/// The number that one, two or four bytes hold.
pub(super) fn index_value(bytes: &[u8]) -> u32 {
    bytes.iter().take(4).rev().fold(0, |value, byte| value << 8 | u32::from(*byte))
}
