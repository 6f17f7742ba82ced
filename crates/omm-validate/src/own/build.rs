//! Builds read memory that is there, in room that was asked for.

use omm_layout::index::{IndexBuffer, IndexType};
use omm_layout::index_buffer::MicromapIndexBuffer;
use omm_layout::vertex::VertexFormat;
use omm_layout::{aabb, build_range, transform};
use omm_model::call::Timeline;
use omm_model::special_index::TriangleMap;
use omm_model::vk;
use vk::AccelerationStructureType as Type;

use super::contents::{created_size, destination_type, micromap_source, room, source, type_of};
use super::memory::Executed;
use super::{instance, micromap_build};
use crate::content::range;
use crate::context::{BuildContext, GeometryContext, Purpose};
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::{Built, MicromapBuilt, State};
use crate::violation::ViolationKind;

/// One build that executes.
pub(super) fn check(build: &BuildContext<'_>, executed: &Executed<'_>, report: &mut Report) {
    let (info, state) = (build.info, executed.state);
    if let Purpose::Indirect { ranges, stride, .. } = build.purpose {
        let items = (stride.into(), build_range::SIZE as u64, info.geometries_iter().count() as u64);
        if executed.reach_items(&build.at, (ranges.into(), 0), items, report).is_none() {
            return;
        }
    }
    let dst = build.at.field("dstAccelerationStructure");
    executed.object(&dst, (vk::AccelerationStructure::OBJECT_TYPE, info.dst_acceleration_structure.0), report);
    destination_type(&dst, info.dst_acceleration_structure, info.ty, state, report);
    if info.mode == vk::BuildAccelerationStructureMode::UPDATE {
        source(&build.at.field("srcAccelerationStructure"), info.src_acceleration_structure, executed, report);
    }
    sizes(build, executed, report);
    build.each_geometry(|geometry| {
        let found = range(geometry, executed.memory);
        indirect_count(geometry, found, report);
        match (&geometry.geometry.geometry, found) {
            (vk::GeometryData::Triangles(data), Some(range)) if report.is_empty() => {
                triangles(geometry, data, range, executed, report);
            }
            (vk::GeometryData::Aabbs(data), Some(range)) if range.primitive_count > 0 => {
                let at = geometry.at.field("geometry");
                let items = (data.stride, aabb::SIZE as u64, range.primitive_count.into());
                let start = (data.data, range.primitive_offset.into());
                executed.reach_items(&at.field("aabbs"), start, items, report);
            }
            (vk::GeometryData::Instances(data), Some(range)) if info.ty == Type::TOP_LEVEL => {
                let known = &mut |at: &At<'_>, reference, report: &mut Report| {
                    instance::is_known(at, reference, executed, report)
                };
                instance::each_reference(geometry, data, range, executed, (known, report));
            }
            _ => {}
        }
        geometry.each_micromap_data(|data| micromap_build::check_khr(data, executed, report));
    });
}

/// No more primitives are built than were announced.
///
/// OMM-size-01
fn indirect_count(geometry: &GeometryContext<'_>, range: Option<vk::BuildRangeInfo>, report: &mut Report) {
    let (Some(limit), Some(range)) = (geometry.announced, range) else { return };
    if range.primitive_count > limit {
        let (found, limit, from) = (range.primitive_count.into(), limit.into(), "ppMaxPrimitiveCounts");
        report.push(RuleId::Size01, &geometry.at, ViolationKind::AboveLimit { found, limit, from });
    }
}

/// Destination and scratch memory are as large as the device said.
///
/// OMM-size-01, OMM-memory-01
fn sizes(build: &BuildContext<'_>, executed: &Executed<'_>, report: &mut Report) {
    let info = build.info;
    let Some(sizes) = build.sizes(executed.state, executed.timeline) else { return };
    let dst = info.dst_acceleration_structure;
    if let Some(found) = created_size(executed.state, dst) {
        let at = build.at.field("dstAccelerationStructure");
        room(&at.about(dst), found, sizes.acceleration_structure_size, report);
    }
    if let Some(scratch) = build.scratch_size(executed.state, executed.timeline) {
        executed.reach(&build.at.field("scratchData"), info.scratch_data, scratch, report);
    }
}

impl BuildContext<'_> {
    /// The sizes that the device named for the build, if it was asked.
    pub(super) fn sizes<'s>(&self, state: &'s State, timeline: Timeline) -> Option<&'s vk::BuildSizesInfo> {
        let ranges = self.ranges.and_then(|(_, ranges)| ranges);
        let count = |index: usize| match self.announced {
            Some(counts) => counts.get(index).copied(),
            None => ranges.and_then(|ranges| ranges.get(index)).map(|range| range.primitive_count),
        };
        state.build_sizes(self.info, count, timeline)
    }

    /// Bytes of scratch memory that the build needs, if that is known and it needs any.
    pub(super) fn scratch_size(&self, state: &State, timeline: Timeline) -> Option<u64> {
        let sizes = self.sizes(state, timeline)?;
        let size = match self.info.mode {
            vk::BuildAccelerationStructureMode::UPDATE => sizes.update_scratch_size,
            _ => sizes.build_scratch_size,
        };
        Some(size).filter(|size| *size > 0)
    }
}

fn triangles(
    geometry: &GeometryContext<'_>,
    data: &vk::GeometryTrianglesData,
    range: vk::BuildRangeInfo,
    executed: &Executed<'_>,
    report: &mut Report,
) {
    let at = geometry.at.field("geometry");
    let at = at.field("triangles");
    let Ok(format) = VertexFormat::try_from(data.vertex_format) else { return };
    let Ok(index_type) = IndexType::try_from(data.index_type) else { return };
    if !data.transform_data.is_null() {
        let items = (0, transform::SIZE as u64, 1);
        let start = (data.transform_data, range.transform_offset.into());
        executed.reach_items(&at.field("transformData"), start, items, report);
    }
    attached_micromaps(geometry, executed, report);
    let corners = u64::from(range.primitive_count) * 3;
    if corners == 0 {
        return;
    }
    let (mut offset, mut last) = (u64::from(range.primitive_offset), corners - 1);
    if index_type != IndexType::None {
        let size = u64::from(index_type.size());
        let items = (size, size, corners);
        let Some(start) = executed.reach_items(&at.field("indexData"), (data.index_data, offset), items, report) else {
            return;
        };
        let bytes = executed.memory.read_either(start, size * corners).ok();
        let indices = bytes.and_then(|bytes| IndexBuffer::new(bytes, index_type, corners).ok());
        let Some(highest) = indices.and_then(|indices| indices.iter().max()) else { return };
        (offset, last) = (0, highest.into());
    }
    let items = (data.vertex_stride, format.size() as u64, u64::from(range.first_vertex) + last + 1);
    executed.reach_items(&at.field("vertexData"), (data.vertex_data, offset), items, report);
    attached_indices(geometry, range.primitive_count.into(), executed, report);
}

/// Micromaps of either extension that are attached.
fn attached_micromaps(geometry: &GeometryContext<'_>, executed: &Executed<'_>, report: &mut Report) {
    geometry.each_opacity_micromap(|attached| {
        let micromap = attached.attached.micromap;
        if !micromap.is_null() {
            let at = attached.at.field("micromap");
            source(&at, micromap, executed, report);
            if let Some(found) = type_of(executed.state, micromap).filter(|ty| *ty != Type::OPACITY_MICROMAP) {
                let kind = ViolationKind::WrongValue { found: found.into(), required: Type::OPACITY_MICROMAP.into() };
                report.push(RuleId::Contents01, &at, kind);
            }
        }
    });
    geometry.each_opacity_micromap_ext(|attached| {
        let micromap = attached.attached.micromap;
        if !micromap.is_null() {
            micromap_source(&attached.at.field("micromap"), micromap, executed, report);
        }
    });
}

/// The index buffers of micromaps of either extension.
fn attached_indices(geometry: &GeometryContext<'_>, count: u64, executed: &Executed<'_>, report: &mut Report) {
    geometry.each_opacity_micromap(|attached| {
        let found = attached.attached;
        let built = executed.state.acceleration_structure(found.micromap).and_then(|it| it.built());
        let indices = Indices {
            index_type: found.index_type,
            // The structure has room for a device address only.
            address: found.index_buffer.into(),
            stride: found.index_stride,
            base_triangle: found.base_triangle,
            is_null: found.micromap.is_null(),
            triangles: built.and_then(Built::micromap_triangles),
        };
        let executed = Executed { timeline: Timeline::Device, ..*executed };
        indices.check(&attached.at, count, &executed, report);
    });
    geometry.each_opacity_micromap_ext(|attached| {
        let found = attached.attached;
        let built = executed.state.micromap(found.micromap).and_then(|it| it.built());
        let indices = Indices {
            index_type: found.index_type,
            address: found.index_buffer,
            stride: found.index_stride,
            base_triangle: found.base_triangle,
            is_null: found.micromap.is_null(),
            triangles: built.map(MicromapBuilt::triangles),
        };
        indices.check(&attached.at, count, executed, report);
    });
}

/// Which triangle of a micromap each triangle has.
struct Indices {
    index_type: vk::IndexType,
    address: vk::DeviceOrHostAddress,
    stride: u64,
    base_triangle: u32,
    is_null: bool,
    /// Triangles of the micromap, if they are known.
    triangles: Option<u64>,
}

impl Indices {
    /// Indices lie in memory, and name triangles that the micromap has.
    ///
    /// OMM-memory-01, OMM-index-01
    fn check(&self, at: &At<'_>, count: u64, executed: &Executed<'_>, report: &mut Report) {
        let Ok(index_type) = IndexType::try_from(self.index_type) else { return };
        let triangles = if self.is_null { Some(0) } else { self.triangles };
        let base_triangle = u64::from(self.base_triangle);
        let wrong = |index: u64| triangles.filter(|triangles| index.saturating_add(base_triangle) >= *triangles);
        let mut push = |at: &At<'_>, index, triangles| {
            let kind = ViolationKind::TriangleOutOfRange { index, base_triangle, triangles };
            report.push(RuleId::Index01, at, kind);
        };
        if index_type == IndexType::None {
            if let Some(triangles) = wrong(count - 1) {
                push(&at.field("baseTriangle"), count - 1, triangles);
            }
            return;
        }
        let size = u64::from(index_type.size());
        let items = (self.stride, size, count);
        let at_buffer = at.field("indexBuffer");
        let Some(start) = executed.reach_items(&at_buffer, (self.address, 0), items, report) else { return };
        let length = (count - 1).saturating_mul(self.stride).saturating_add(size);
        let Ok(bytes) = executed.memory.read_either(start, length) else { return };
        for index in 0..count {
            let Some(item) = item(bytes, index, self.stride, size) else { return };
            let Ok(one) = MicromapIndexBuffer::new(item, index_type, size, 0, 1) else { return };
            if let Some(Ok(TriangleMap::Triangle(found))) = one.get(0)
                && let Some(triangles) = wrong(found.into())
            {
                let kind = ViolationKind::TriangleOutOfRange { index: found.into(), base_triangle, triangles };
                report.push(RuleId::Index01, &at.element("indexBuffer", index as usize), kind);
                return;
            }
        }
    }
}

/// One of some items at equal distances.
fn item(bytes: &[u8], index: u64, stride: u64, size: u64) -> Option<&[u8]> {
    let start = usize::try_from(index.checked_mul(stride)?).ok()?;
    bytes.get(start..)?.get(..usize::try_from(size).ok()?)
}
