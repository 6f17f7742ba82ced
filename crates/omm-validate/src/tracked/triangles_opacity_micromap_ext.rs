//! Rules of `VkAccelerationStructureTrianglesOpacityMicromapEXT` that ask what the micromap is.

use omm_model::format::OpacityMicromapFormat;
use omm_model::vk;

use crate::context::micromap_ext::OpacityMicromapExtContext;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::stateless::micromap_usage_ext;

pub(super) fn check(attached: &OpacityMicromapExtContext<'_>, state: &State, report: &mut Report) {
    match state.micromap(attached.attached.micromap).map(|micromap| micromap.ty) {
        Some(vk::MicromapType::OPACITY_MICROMAP) => {
            attached_usage_format_11679(attached, report);
            attached_two_state_level_11680(attached, report);
            attached_four_state_level_11681(attached, report);
        }
        Some(vk::MicromapType::DISPLACEMENT_MICROMAP) => {
            attached_displacement_format_11682(attached, report);
            attached_displacement_level_11683(attached, report);
        }
        _ => {}
    }
}

/// Usages of an opacity micromap have a format that exists.
///
/// VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-format-11679
fn attached_usage_format_11679(attached: &OpacityMicromapExtContext<'_>, report: &mut Report) {
    micromap_usage_ext::opacity_formats(attached.usages(), RuleId::AttachedUsageFormat11679, report);
}

/// Usages of 2-state triangles stay within the limit.
///
/// VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-subdivisionLevel-11680
fn attached_two_state_level_11680(attached: &OpacityMicromapExtContext<'_>, report: &mut Report) {
    let limits = attached.geometry.build.limits;
    let (format, rule) = (OpacityMicromapFormat::TwoState, RuleId::AttachedTwoStateLevel11680);
    micromap_usage_ext::opacity_levels(attached.usages(), format, limits, rule, report);
}

/// Usages of 4-state triangles stay within the limit.
///
/// VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-subdivisionLevel-11681
fn attached_four_state_level_11681(attached: &OpacityMicromapExtContext<'_>, report: &mut Report) {
    let limits = attached.geometry.build.limits;
    let (format, rule) = (OpacityMicromapFormat::FourState, RuleId::AttachedFourStateLevel11681);
    micromap_usage_ext::opacity_levels(attached.usages(), format, limits, rule, report);
}

/// Usages of a displacement micromap have a format that exists.
///
/// VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-format-11682
fn attached_displacement_format_11682(attached: &OpacityMicromapExtContext<'_>, report: &mut Report) {
    micromap_usage_ext::displacement_formats(attached.usages(), RuleId::AttachedDisplacementFormat11682, report);
}

/// Usages of a displacement micromap stay within the limit.
///
/// VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-subdivisionLevel-11683
fn attached_displacement_level_11683(attached: &OpacityMicromapExtContext<'_>, report: &mut Report) {
    let limits = attached.geometry.build.limits;
    let rule = RuleId::AttachedDisplacementLevel11683;
    micromap_usage_ext::displacement_levels(attached.usages(), limits, rule, report);
}
