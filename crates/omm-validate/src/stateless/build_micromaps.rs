//! Rules of `vkCmdBuildMicromapsEXT`, `vkBuildMicromapsEXT` and `vkGetMicromapBuildSizesEXT` on their parameters.

use omm_model::call::Call;
use omm_model::profile::Features;
use omm_model::vk;

use super::copy_micromap::host_commands;
use super::micromap_compatibility::micromap_feature;
use crate::context::micromap_ext::{MicromapBuildContext, MicromapPurpose};
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::ViolationKind;

/// What addresses of micromap data and triangle arrays are a multiple of.
const INPUT_ALIGNMENT: u64 = 256;

/// Checks the command as a whole.
pub(super) fn check_command(call: &Call, command: &At<'_>, features: &Features, report: &mut Report) {
    match call {
        Call::CmdBuildMicromaps { .. } => build_feature_11648(command, features, report),
        Call::BuildMicromaps { .. } => host_build_feature_07555(command, features, report),
        Call::GetMicromapBuildSizes { .. } => build_sizes_feature_11618(command, features, report),
        _ => {}
    }
}

/// Checks one build.
pub(super) fn check(build: &MicromapBuildContext<'_>, report: &mut Report) {
    if build.purpose != MicromapPurpose::Sizes {
        mode_07462(build, report);
    }
    if build.purpose == MicromapPurpose::Device {
        scratch_alignment_07514(build, report);
        input_alignment_07515(build, report);
    }
}

/// Micromap objects belong to a feature.
///
/// VUID-vkCmdBuildMicromapsEXT-micromap-11648
fn build_feature_11648(command: &At<'_>, features: &Features, report: &mut Report) {
    if !features.micromap_ext {
        let feature = "VkPhysicalDeviceOpacityMicromapFeaturesEXT::micromap";
        let kind = ViolationKind::FeatureDisabled { feature };
        report.push(RuleId::BuildFeature11648, &command.field("commandBuffer"), kind);
    }
}

/// Builds on the host have a feature of their own.
///
/// VUID-vkBuildMicromapsEXT-micromapHostCommands-07555
fn host_build_feature_07555(command: &At<'_>, features: &Features, report: &mut Report) {
    host_commands(command, features, RuleId::HostBuildFeature07555, report);
}

/// The query belongs to the feature too.
///
/// VUID-vkGetMicromapBuildSizesEXT-micromap-11618
fn build_sizes_feature_11618(command: &At<'_>, features: &Features, report: &mut Report) {
    micromap_feature(command, features, RuleId::BuildSizesFeature11618, report);
}

/// Micromaps are always built afresh.
///
/// VUID-vkCmdBuildMicromapsEXT-mode-07462,
/// VUID-vkBuildMicromapsEXT-mode-07462
fn mode_07462(build: &MicromapBuildContext<'_>, report: &mut Report) {
    let found = build.info.mode;
    if found != vk::BuildMicromapMode::BUILD {
        let allowed = &["VK_BUILD_MICROMAP_MODE_BUILD_EXT"];
        let kind = ViolationKind::UnexpectedValue { found: found.into(), allowed };
        report.push(build.twin(RuleId::Mode07462, RuleId::HostMode07462), &build.at.field("mode"), kind);
    }
}

/// Scratch memory is aligned as the device wants it.
///
/// VUID-vkCmdBuildMicromapsEXT-pInfos-07514
fn scratch_alignment_07514(build: &MicromapBuildContext<'_>, report: &mut Report) {
    let alignment = build.limits.min_acceleration_structure_scratch_offset_alignment.into();
    let scratch = ("scratchData", build.info.scratch_data);
    device_alignment(build, scratch, alignment, RuleId::ScratchAlignment07514, report);
}

/// Data and triangle array are aligned.
///
/// VUID-vkCmdBuildMicromapsEXT-pInfos-07515
fn input_alignment_07515(build: &MicromapBuildContext<'_>, report: &mut Report) {
    for input in [("triangleArray", build.info.triangle_array), ("data", build.info.data)] {
        device_alignment(build, input, INPUT_ALIGNMENT, RuleId::InputAlignment07515, report);
    }
}

/// An address of device memory is a multiple of `alignment`. One of host memory is another rule's business.
fn device_alignment(
    build: &MicromapBuildContext<'_>,
    (name, address): (&'static str, vk::DeviceOrHostAddress),
    alignment: u64,
    rule: RuleId,
    report: &mut Report,
) {
    if let Some(address) = address.device_address().filter(|address| !address.is_aligned_to(alignment)) {
        report.push(rule, &build.at.field(name), ViolationKind::Misaligned { found: address.0, alignment });
    }
}
