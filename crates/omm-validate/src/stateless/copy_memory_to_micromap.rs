//! Rules of `vkCmdCopyMemoryToMicromapEXT`, `vkCopyMemoryToMicromapEXT` and `VkCopyMemoryToMicromapInfoEXT` on their parameters.

use omm_model::call::Call;
use omm_model::profile::Features;
use omm_model::vk;

use super::copy_micromap::{alignment, host_commands, only_mode};
use super::copy_micromap_to_memory::{DEVICE_ALIGNMENT, HOST_ALIGNMENT};
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;

pub(super) fn check(call: &Call, command: &At<'_>, features: &Features, report: &mut Report) {
    match call {
        Call::CmdCopyMemoryToMicromap { info, .. } => {
            deserialize_alignment_07544(command, info, report);
            deserialize_mode_07548(command, info, report);
        }
        Call::CopyMemoryToMicromap { info, .. } => {
            host_commands(command, features, RuleId::HostDeserializeFeature07566, report);
            host_deserialize_alignment_07564(command, info, report);
            deserialize_mode_07548(command, info, report);
        }
        _ => {}
    }
}

/// Data is read from an aligned device address.
///
/// VUID-vkCmdCopyMemoryToMicromapEXT-pInfo-07544
fn deserialize_alignment_07544(command: &At<'_>, info: &vk::CopyMemoryToMicromapInfo, report: &mut Report) {
    if let Some(address) = info.src.device_address() {
        alignment(command, ("src", address.0), DEVICE_ALIGNMENT, RuleId::DeserializeAlignment07544, report);
    }
}

/// Data is read from an aligned host address.
///
/// VUID-vkCopyMemoryToMicromapEXT-pInfo-07564
fn host_deserialize_alignment_07564(command: &At<'_>, info: &vk::CopyMemoryToMicromapInfo, report: &mut Report) {
    if let Some(address) = info.src.host_address() {
        alignment(command, ("src", address.0), HOST_ALIGNMENT, RuleId::HostDeserializeAlignment07564, report);
    }
}

/// From memory to a micromap is a deserialization.
///
/// VUID-VkCopyMemoryToMicromapInfoEXT-mode-07548
fn deserialize_mode_07548(command: &At<'_>, info: &vk::CopyMemoryToMicromapInfo, report: &mut Report) {
    let allowed = &["VK_COPY_MICROMAP_MODE_DESERIALIZE_EXT"];
    only_mode(command, info.mode, vk::CopyMicromapMode::DESERIALIZE, allowed, RuleId::DeserializeMode07548, report);
}
