//! Rules of `vkCmdCopyMicromapEXT`, `vkCopyMicromapEXT` and `VkCopyMicromapInfoEXT` on their parameters.

use omm_model::call::Call;
use omm_model::profile::Features;
use omm_model::vk;
use vk::CopyMicromapMode as Mode;

use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::ViolationKind;

pub(super) fn check(call: &Call, command: &At<'_>, features: &Features, report: &mut Report) {
    match call {
        Call::CmdCopyMicromap { info, .. } => copy_mode_07531(command, info, report),
        Call::CopyMicromap { info, .. } => {
            host_commands(command, features, RuleId::HostCopyFeature07560, report);
            copy_mode_07531(command, info, report);
        }
        _ => {}
    }
}

/// Between micromaps there are clones and compactions.
///
/// VUID-VkCopyMicromapInfoEXT-mode-07531
fn copy_mode_07531(command: &At<'_>, info: &vk::CopyMicromapInfo, report: &mut Report) {
    if ![Mode::COMPACT, Mode::CLONE].contains(&info.mode) {
        let allowed = &["VK_COPY_MICROMAP_MODE_COMPACT_EXT", "VK_COPY_MICROMAP_MODE_CLONE_EXT"];
        let kind = ViolationKind::UnexpectedValue { found: info.mode.into(), allowed };
        report.push(RuleId::CopyMode07531, &command.pointer("pInfo").field("mode"), kind);
    }
}

/// A copy from or to memory says so. Numbers that are no mode at all break another rule.
pub(super) fn only_mode(
    command: &At<'_>,
    found: Mode,
    required: Mode,
    allowed: &'static [&'static str],
    rule: RuleId,
    report: &mut Report,
) {
    if found != required && found.name().is_some() {
        let kind = ViolationKind::UnexpectedValue { found: found.into(), allowed };
        report.push(rule, &command.pointer("pInfo").field("mode"), kind);
    }
}

/// The address of that name begins on a multiple of `alignment`.
pub(super) fn alignment(
    command: &At<'_>,
    (name, address): (&'static str, u64),
    alignment: u64,
    rule: RuleId,
    report: &mut Report,
) {
    if !address.is_multiple_of(alignment) {
        let kind = ViolationKind::Misaligned { found: address, alignment };
        report.push(rule, &command.pointer("pInfo").field(name), kind);
    }
}

/// Work on micromaps on the host has a feature of its own.
///
/// VUID-vkCopyMicromapEXT-micromapHostCommands-07560,
/// VUID-vkCopyMicromapToMemoryEXT-micromapHostCommands-07571,
/// VUID-vkCopyMemoryToMicromapEXT-micromapHostCommands-07566,
/// VUID-vkWriteMicromapsPropertiesEXT-micromapHostCommands-07578
pub(super) fn host_commands(command: &At<'_>, features: &Features, rule: RuleId, report: &mut Report) {
    if !features.micromap_host_commands {
        let feature = "VkPhysicalDeviceOpacityMicromapFeaturesEXT::micromapHostCommands";
        report.push(rule, &command.field("device"), ViolationKind::FeatureDisabled { feature });
    }
}
