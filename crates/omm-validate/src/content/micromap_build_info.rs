//! Rules of `VkMicromapBuildInfoEXT` on the triangle array.

use omm_layout::triangle::TriangleArray;
use omm_model::format::OpacityMicromapFormat;
use omm_model::memory::MemoryView;
use omm_model::vk;

use super::micromap_data::{first, push_level, read_triangles};
use super::triangle_array::Allowed;
use crate::context::micromap_ext::{MicromapBuildContext, MicromapPurpose};
use crate::report::Report;
use crate::rule::RuleId;
use crate::stateless::micromap_usage_ext::{displacement_format, displacement_limit, opacity_format, opacity_limit};
use crate::violation::ViolationKind;

pub(super) fn check(build: &MicromapBuildContext<'_>, memory: &dyn MemoryView, report: &mut Report) {
    let Some(triangles) = read(build, memory) else { return };
    match build.info.ty {
        vk::MicromapType::OPACITY_MICROMAP => {
            let limit = |format| Some(opacity_limit(format, build.limits).0);
            if Allowed::new(limit, None).allows(&triangles) {
                return;
            }
            triangle_format_11657(build, &triangles, report);
            triangle_two_state_level_11659(build, &triangles, report);
            triangle_four_state_level_11660(build, &triangles, report);
        }
        vk::MicromapType::DISPLACEMENT_MICROMAP => {
            displacement_triangle_format_11658(build, &triangles, report);
            displacement_triangle_level_11661(build, &triangles, report);
        }
        _ => {}
    }
}

/// The triangle array, if it lies in the memory that the command reads, is readable and its entries do not overlap.
pub(super) fn read<'m>(build: &MicromapBuildContext<'_>, memory: &'m dyn MemoryView) -> Option<TriangleArray<'m>> {
    let address = build.info.triangle_array;
    let is_right_memory = match build.purpose {
        MicromapPurpose::Device => address.device_address().is_some(),
        MicromapPurpose::Host => address.host_address().is_some(),
        MicromapPurpose::Sizes => false,
    };
    let count = build.triangle_count();
    is_right_memory.then(|| read_triangles(memory, address, build.info.triangle_array_stride, count))?
}

/// Triangles of opacity have a format that exists.
///
/// VUID-VkMicromapBuildInfoEXT-format-11657
fn triangle_format_11657(build: &MicromapBuildContext<'_>, triangles: &TriangleArray<'_>, report: &mut Report) {
    format(build, triangles, opacity_format, RuleId::TriangleFormat11657, report);
}

/// Triangles of displacement have a format that exists.
///
/// VUID-VkMicromapBuildInfoEXT-format-11658
fn displacement_triangle_format_11658(
    build: &MicromapBuildContext<'_>,
    triangles: &TriangleArray<'_>,
    report: &mut Report,
) {
    format(build, triangles, displacement_format, RuleId::DisplacementTriangleFormat11658, report);
}

/// 2-state triangles stay within the limit.
///
/// VUID-VkMicromapBuildInfoEXT-subdivisionLevel-11659
fn triangle_two_state_level_11659(
    build: &MicromapBuildContext<'_>,
    triangles: &TriangleArray<'_>,
    report: &mut Report,
) {
    opacity_level(build, triangles, OpacityMicromapFormat::TwoState, RuleId::TriangleTwoStateLevel11659, report);
}

/// 4-state triangles stay within the limit.
///
/// VUID-VkMicromapBuildInfoEXT-subdivisionLevel-11660
fn triangle_four_state_level_11660(
    build: &MicromapBuildContext<'_>,
    triangles: &TriangleArray<'_>,
    report: &mut Report,
) {
    opacity_level(build, triangles, OpacityMicromapFormat::FourState, RuleId::TriangleFourStateLevel11660, report);
}

/// Triangles of displacement stay within the limit.
///
/// VUID-VkMicromapBuildInfoEXT-subdivisionLevel-11661
fn displacement_triangle_level_11661(
    build: &MicromapBuildContext<'_>,
    triangles: &TriangleArray<'_>,
    report: &mut Report,
) {
    let (limit, from) = displacement_limit(build.limits);
    let wrong = first(triangles, |it| u32::from(it.subdivision_level) > limit);
    push_level(&build.at, wrong, limit, from, RuleId::DisplacementTriangleLevel11661, report);
}

/// Reports the first triangle that `wrong` finds something wrong with in its format.
fn format(
    build: &MicromapBuildContext<'_>,
    triangles: &TriangleArray<'_>,
    wrong: fn(u32) -> Option<ViolationKind>,
    rule: RuleId,
    report: &mut Report,
) {
    let found = first(triangles, |triangle| wrong(triangle.format.into()).is_some());
    if let Some((index, kind)) = found.and_then(|(index, triangle)| Some((index, wrong(triangle.format.into())?))) {
        report.push(rule, &build.at.element("triangleArray", index).field("format"), kind);
    }
}

/// Reports the first triangle of that format above its limit.
fn opacity_level(
    build: &MicromapBuildContext<'_>,
    triangles: &TriangleArray<'_>,
    format: OpacityMicromapFormat,
    rule: RuleId,
    report: &mut Report,
) {
    let (limit, from) = opacity_limit(format, build.limits);
    let wrong = first(triangles, |it| it.format == format.value() && u32::from(it.subdivision_level) > limit);
    push_level(&build.at, wrong, limit, from, rule, report);
}
