//! Rules of `VkMicromapBuildInfoEXT`.

use omm_model::format::OpacityMicromapFormat;
use omm_model::vk;

use super::micromap_usage_ext;
use crate::context::micromap_ext::MicromapBuildContext;
use crate::report::Report;
use crate::rule::RuleId;

pub(super) fn check(build: &MicromapBuildContext<'_>, report: &mut Report) {
    usage_counts_07516(build, report);
    match build.info.ty {
        vk::MicromapType::OPACITY_MICROMAP => {
            usage_format_11652(build, report);
            usage_two_state_level_11654(build, report);
            usage_four_state_level_11655(build, report);
        }
        vk::MicromapType::DISPLACEMENT_MICROMAP => {
            displacement_usage_format_11653(build, report);
            displacement_usage_level_11656(build, report);
        }
        _ => {}
    }
}

/// Usage counts come through one of the two pointers.
///
/// VUID-VkMicromapBuildInfoEXT-pUsageCounts-07516
fn usage_counts_07516(build: &MicromapBuildContext<'_>, report: &mut Report) {
    micromap_usage_ext::both_pointers(build.usages(), RuleId::UsageCounts07516, report);
}

/// Usages of opacity have a format that exists.
///
/// VUID-VkMicromapBuildInfoEXT-format-11652
fn usage_format_11652(build: &MicromapBuildContext<'_>, report: &mut Report) {
    micromap_usage_ext::opacity_formats(build.usages(), RuleId::UsageFormat11652, report);
}

/// Usages of displacement have a format that exists.
///
/// VUID-VkMicromapBuildInfoEXT-format-11653
fn displacement_usage_format_11653(build: &MicromapBuildContext<'_>, report: &mut Report) {
    micromap_usage_ext::displacement_formats(build.usages(), RuleId::DisplacementUsageFormat11653, report);
}

/// Usages of 2-state triangles stay within the limit.
///
/// VUID-VkMicromapBuildInfoEXT-subdivisionLevel-11654
fn usage_two_state_level_11654(build: &MicromapBuildContext<'_>, report: &mut Report) {
    let (format, rule) = (OpacityMicromapFormat::TwoState, RuleId::UsageTwoStateLevel11654);
    micromap_usage_ext::opacity_levels(build.usages(), format, build.limits, rule, report);
}

/// Usages of 4-state triangles stay within the limit.
///
/// VUID-VkMicromapBuildInfoEXT-subdivisionLevel-11655
fn usage_four_state_level_11655(build: &MicromapBuildContext<'_>, report: &mut Report) {
    let (format, rule) = (OpacityMicromapFormat::FourState, RuleId::UsageFourStateLevel11655);
    micromap_usage_ext::opacity_levels(build.usages(), format, build.limits, rule, report);
}

/// Usages of displacement stay within the limit.
///
/// VUID-VkMicromapBuildInfoEXT-subdivisionLevel-11656
fn displacement_usage_level_11656(build: &MicromapBuildContext<'_>, report: &mut Report) {
    let rule = RuleId::DisplacementUsageLevel11656;
    micromap_usage_ext::displacement_levels(build.usages(), build.limits, rule, report);
}
