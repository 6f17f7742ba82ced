//! Rules on the positions of triangles and boxes.

use omm_layout::index::{IndexBuffer, IndexType};
use omm_layout::vertex::VertexFormat;
use omm_model::memory::MemoryView;
use omm_model::vk;

use super::{range, span};
use crate::context::GeometryContext;
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::ViolationKind;

/// The components of a vertex, and those of a box behind its lowest x.
const COMPONENTS: [&str; 6] = ["x", "y", "z", "maxX", "maxY", "maxZ"];
/// Bytes of a box.
const AABB_SIZE: u64 = 24;

pub(super) fn check(geometry: &GeometryContext<'_>, memory: &dyn MemoryView, report: &mut Report) {
    if geometry.build.info.mode == vk::BuildAccelerationStructureMode::BUILD {
        triangle_01(geometry, memory, report);
        aabb_01(geometry, memory, report);
    }
}

/// Positions are numbers, apart from those of triangles that are taken out.
///
/// OMM-triangles_data-01
fn triangle_01(geometry: &GeometryContext<'_>, memory: &dyn MemoryView, report: &mut Report) {
    geometry.with_triangles(|at, triangles| {
        let found = Vertices::read(geometry, triangles, memory).and_then(|vertices| vertices.first_partly_nan());
        if let Some((vertex, component)) = found {
            report.push(RuleId::PartlyNan01, &at.element("vertexData", vertex), ViolationKind::PartlyNan { component });
        }
    });
}

/// So are those of boxes.
///
/// OMM-triangles_data-01
fn aabb_01(geometry: &GeometryContext<'_>, memory: &dyn MemoryView, report: &mut Report) {
    let vk::GeometryData::Aabbs(aabbs) = &geometry.geometry.geometry else { return };
    if geometry.geometry.geometry_type != vk::GeometryType::AABBS {
        return;
    }
    let Some(found) = partly_nan_aabb(geometry, aabbs, memory) else { return };
    let at = geometry.at.field("geometry");
    let at = at.field("aabbs");
    report.push(RuleId::PartlyNan01, &at.element("data", found.0), ViolationKind::PartlyNan { component: found.1 });
}

/// The first box that has NaN in another component than its first, and which one.
fn partly_nan_aabb(
    geometry: &GeometryContext<'_>,
    aabbs: &vk::GeometryAabbsData,
    memory: &dyn MemoryView,
) -> Option<(usize, &'static str)> {
    let range = range(geometry, memory)?;
    let data = offset_by(aabbs.data, range.primitive_offset.into())?;
    let bytes = memory.read_either(data, span(range.primitive_count.into(), aabbs.stride, AABB_SIZE)?).ok()?;
    let stride = usize::try_from(aabbs.stride).ok().filter(|stride| *stride > 0)?;
    bytes.chunks(stride).take(range.primitive_count as usize).enumerate().find_map(|(index, aabb)| {
        let components = aabb.first_chunk::<24>()?.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes));
        Some((index, partly_nan(components)?))
    })
}

/// The vertices of triangles and the indices that name them.
struct Vertices<'m> {
    bytes: &'m [u8],
    stride: usize,
    format: VertexFormat,
    indices: Option<IndexBuffer<'m>>,
    first_vertex: u64,
    count: u64,
}

impl<'m> Vertices<'m> {
    /// The vertices of the triangles that are built, if they can be NaN and are readable.
    fn read(
        geometry: &GeometryContext<'_>,
        triangles: &vk::GeometryTrianglesData,
        memory: &'m dyn MemoryView,
    ) -> Option<Self> {
        let format = VertexFormat::try_from(triangles.vertex_format).ok().filter(|format| format.has_nan())?;
        let range = range(geometry, memory)?;
        let index_type = IndexType::try_from(triangles.index_type).ok()?;
        let count = u64::from(range.primitive_count) * 3;
        let (offset, first_vertex) = (u64::from(range.primitive_offset), u64::from(range.first_vertex));
        let (data, indices, used) = if index_type == IndexType::None {
            (offset_by(triangles.vertex_data, offset)?, None, first_vertex + count)
        } else {
            let size = count.checked_mul(index_type.size().into())?;
            let bytes = memory.read_either(offset_by(triangles.index_data, offset)?, size).ok()?;
            let indices = IndexBuffer::new(bytes, index_type, count).ok()?;
            (triangles.vertex_data, Some(indices), u64::from(triangles.max_vertex) + 1)
        };
        let bytes = memory.read_either(data, span(used, triangles.vertex_stride, format.size() as u64)?).ok()?;
        let stride = usize::try_from(triangles.vertex_stride).ok()?;
        Some(Self { bytes, stride, format, indices, first_vertex, count })
    }

    /// The first vertex that has NaN in another component than its first, and which one.
    fn first_partly_nan(&self) -> Option<(usize, &'static str)> {
        // Nearly always there is none, and that is seen faster, unless there are many more vertices than corners.
        let start = usize::try_from(self.first_vertex).ok()?.checked_mul(self.stride)?;
        let vertices = self.bytes.get(start..)?;
        let few = (vertices.len() / self.stride.max(1)) as u64 <= self.count.saturating_mul(2);
        if few && !self.format.any_partly_nan(vertices, self.stride) {
            return None;
        }
        let mut corners = 0..self.count;
        corners.find_map(|corner| {
            let index = match &self.indices {
                Some(indices) => u64::from(indices.get(corner)?),
                None => corner,
            };
            let vertex = usize::try_from(index.checked_add(self.first_vertex)?).ok()?;
            let bytes = self.bytes.get(vertex.checked_mul(self.stride)?..)?;
            Some((vertex, partly_nan(self.format.read(bytes).ok()?)?))
        })
    }
}

/// The component other than the first that is NaN, if the first is a number.
fn partly_nan(components: impl IntoIterator<Item = f32>) -> Option<&'static str> {
    let mut components = components.into_iter().zip(COMPONENTS);
    components.next().filter(|(x, _)| !x.is_nan())?;
    components.find(|(number, _)| number.is_nan()).map(|(_, name)| name)
}

/// An address some bytes behind another.
pub(crate) fn offset_by(address: vk::DeviceOrHostAddress, bytes: u64) -> Option<vk::DeviceOrHostAddress> {
    Some(match address {
        vk::DeviceOrHostAddress::DeviceAddress(address) => address.checked_add(bytes)?.into(),
        vk::DeviceOrHostAddress::HostAddress(address) => vk::HostAddress(address.0.checked_add(bytes)?).into(),
    })
}
