//! Rules on the triangle array of a micromap build.

use omm_layout::triangle::{self, TriangleArray};
use omm_model::format::OpacityMicromapFormat;
use omm_model::memory::MemoryView;
use omm_model::vk;

use super::span;
use super::triangle_array::{Allowed, data_size};
use crate::context::MicromapDataContext;
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::violation::ViolationKind;

const TWO_STATE: u16 = OpacityMicromapFormat::TwoState.value();
const FOUR_STATE: u16 = OpacityMicromapFormat::FourState.value();

pub(super) fn check(data: &MicromapDataContext<'_>, state: &State, memory: &dyn MemoryView, report: &mut Report) {
    let Some(triangles) = read(data, memory) else { return };
    let available = state.bytes_from(data.data.data);
    if Allowed::new(|format| limit(data, format), available).allows(&triangles) {
        return;
    }
    triangle_format_11555(data, &triangles, report);
    lossy_format_11713(data, &triangles, report);
    two_state_level_11556(data, &triangles, report);
    four_state_level_11566(data, &triangles, report);
    lossy_level_11567(data, &triangles, report);
    if let Some(available) = available {
        data_range_11553(data, &triangles, available, report);
    }
}

/// The finest level that the build allows of a format, if it allows the format: what the rules below say together.
fn limit(data: &MicromapDataContext<'_>, format: OpacityMicromapFormat) -> Option<u32> {
    let limits = data.build.limits;
    match (format, data.build.is_lossy()) {
        (OpacityMicromapFormat::TwoState, false) => Some(limits.max_opacity2_state_subdivision_level),
        (OpacityMicromapFormat::TwoState, true) => None,
        (OpacityMicromapFormat::FourState, false) => Some(limits.max_opacity4_state_subdivision_level),
        (OpacityMicromapFormat::FourState, true) => Some(limits.max_opacity_lossy4_state_subdivision_level),
    }
}

/// The triangle array, if it is readable and its entries do not overlap.
fn read<'m>(data: &MicromapDataContext<'_>, memory: &'m dyn MemoryView) -> Option<TriangleArray<'m>> {
    let vk::GeometryMicromapData { triangle_array, triangle_array_stride: stride, .. } = *data.data;
    read_triangles(memory, triangle_array.into(), stride, data.triangle_count())
}

/// A triangle array, if it is readable and its entries do not overlap.
pub(super) fn read_triangles(
    memory: &dyn MemoryView,
    address: vk::DeviceOrHostAddress,
    stride: u64,
    count: u64,
) -> Option<TriangleArray<'_>> {
    let size = triangle::SIZE as u64;
    if stride < size {
        return None;
    }
    let bytes = memory.read_either(address, span(count, stride, size)?).ok()?;
    TriangleArray::new(bytes, stride, count).ok()
}

/// The first triangle for which `is_wrong` holds, with its place.
pub(super) fn first(
    triangles: &TriangleArray<'_>,
    is_wrong: impl Fn(&vk::MicromapTriangle) -> bool,
) -> Option<(usize, vk::MicromapTriangle)> {
    triangles.iter().enumerate().find(|(_, triangle)| is_wrong(triangle))
}

/// Every triangle has a known format.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11555
fn triangle_format_11555(data: &MicromapDataContext<'_>, triangles: &TriangleArray<'_>, report: &mut Report) {
    let wrong = first(triangles, |triangle| OpacityMicromapFormat::from_value(triangle.format.into()).is_none());
    if let Some((index, triangle)) = wrong {
        let found = vk::OpacityMicromapFormat(triangle.format.into()).into();
        let allowed = &["VK_OPACITY_MICROMAP_FORMAT_2_STATE_KHR", "VK_OPACITY_MICROMAP_FORMAT_4_STATE_KHR"];
        let at = data.at.element("triangleArray", index);
        let kind = ViolationKind::UnexpectedValue { found, allowed };
        report.push(RuleId::TriangleFormat11555, &at.field("format"), kind);
    }
}

/// Only 4-state triangles are stored lossily.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-format-11713
fn lossy_format_11713(data: &MicromapDataContext<'_>, triangles: &TriangleArray<'_>, report: &mut Report) {
    if !data.build.is_lossy() {
        return;
    }
    if let Some((index, triangle)) = first(triangles, |triangle| triangle.format != FOUR_STATE) {
        let found = vk::OpacityMicromapFormat(triangle.format.into()).into();
        let at = data.at.element("triangleArray", index);
        let kind = ViolationKind::UnexpectedValue { found, allowed: &["VK_OPACITY_MICROMAP_FORMAT_4_STATE_KHR"] };
        report.push(RuleId::LossyFormat11713, &at.field("format"), kind);
    }
}

/// A triangle's data ends before its buffer does.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11553
fn data_range_11553(
    data: &MicromapDataContext<'_>,
    triangles: &TriangleArray<'_>,
    available: u64,
    report: &mut Report,
) {
    let size = |triangle: &vk::MicromapTriangle| {
        let format = OpacityMicromapFormat::from_value(triangle.format.into())?;
        Some(data_size(format, triangle.subdivision_level))
    };
    let is_wrong = |triangle: &vk::MicromapTriangle| {
        size(triangle).is_some_and(|size| size.saturating_add(triangle.data_offset.into()) > available)
    };
    if let Some((index, triangle)) = first(triangles, is_wrong) {
        let (offset, size) = (triangle.data_offset.into(), size(&triangle).unwrap_or_default());
        let at = data.at.element("triangleArray", index);
        let kind = ViolationKind::DataBeyondBuffer { offset, size, available };
        report.push(RuleId::DataRange11553, &at.field("dataOffset"), kind);
    }
}

/// 2-state triangles stay within the limit.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11556
fn two_state_level_11556(data: &MicromapDataContext<'_>, triangles: &TriangleArray<'_>, report: &mut Report) {
    let limit = data.build.limits.max_opacity2_state_subdivision_level;
    let wrong = first(triangles, |it| it.format == TWO_STATE && u32::from(it.subdivision_level) > limit);
    let from = "maxOpacity2StateSubdivisionLevel";
    push_level(&data.at, wrong, limit, from, RuleId::TwoStateLevel11556, report);
}

/// 4-state triangles stay within the limit for exact storage.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-subdivisionLevel-11566
fn four_state_level_11566(data: &MicromapDataContext<'_>, triangles: &TriangleArray<'_>, report: &mut Report) {
    if data.build.is_lossy() {
        return;
    }
    let limit = data.build.limits.max_opacity4_state_subdivision_level;
    let wrong = first(triangles, |it| it.format == FOUR_STATE && u32::from(it.subdivision_level) > limit);
    let from = "maxOpacity4StateSubdivisionLevel";
    push_level(&data.at, wrong, limit, from, RuleId::FourStateLevel11566, report);
}

/// Triangles of any format stay within the limit for lossy storage.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-subdivisionLevel-11567
fn lossy_level_11567(data: &MicromapDataContext<'_>, triangles: &TriangleArray<'_>, report: &mut Report) {
    if !data.build.is_lossy() {
        return;
    }
    let limit = data.build.limits.max_opacity_lossy4_state_subdivision_level;
    let wrong = first(triangles, |it| u32::from(it.subdivision_level) > limit);
    let from = "maxOpacityLossy4StateSubdivisionLevel";
    push_level(&data.at, wrong, limit, from, RuleId::LossyLevel11567, report);
}

/// Reports a triangle above the limit of that name.
pub(super) fn push_level(
    at: &At<'_>,
    wrong: Option<(usize, vk::MicromapTriangle)>,
    limit: u32,
    from: &'static str,
    rule: RuleId,
    report: &mut Report,
) {
    if let Some((index, triangle)) = wrong {
        let at = at.element("triangleArray", index);
        let kind = ViolationKind::AboveLimit { found: triangle.subdivision_level.into(), limit: limit.into(), from };
        report.push(rule, &at.field("subdivisionLevel"), kind);
    }
}
