//! Rules of `vkCmdCopyMicromapToMemoryEXT`, `vkCopyMicromapToMemoryEXT` and `VkCopyMicromapToMemoryInfoEXT` on their parameters.

use omm_model::call::Call;
use omm_model::profile::Features;
use omm_model::vk;

use super::copy_micromap::{alignment, host_commands, only_mode};
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;

/// Serialized data lies on a multiple of this in device memory.
pub(super) const DEVICE_ALIGNMENT: u64 = 256;
/// Serialized data lies on a multiple of this in host memory.
pub(super) const HOST_ALIGNMENT: u64 = 16;

pub(super) fn check(call: &Call, command: &At<'_>, features: &Features, report: &mut Report) {
    match call {
        Call::CmdCopyMicromapToMemory { info, .. } => {
            serialize_alignment_07537(command, info, report);
            serialize_mode_07542(command, info, report);
        }
        Call::CopyMicromapToMemory { info, .. } => {
            host_commands(command, features, RuleId::HostSerializeFeature07571, report);
            host_serialize_alignment_07570(command, info, report);
            serialize_mode_07542(command, info, report);
        }
        _ => {}
    }
}

/// Data is written to an aligned device address.
///
/// VUID-vkCmdCopyMicromapToMemoryEXT-pInfo-07537
fn serialize_alignment_07537(command: &At<'_>, info: &vk::CopyMicromapToMemoryInfo, report: &mut Report) {
    if let Some(address) = info.dst.device_address() {
        alignment(command, ("dst", address.0), DEVICE_ALIGNMENT, RuleId::SerializeAlignment07537, report);
    }
}

/// Data is written to an aligned host address.
///
/// VUID-vkCopyMicromapToMemoryEXT-pInfo-07570
fn host_serialize_alignment_07570(command: &At<'_>, info: &vk::CopyMicromapToMemoryInfo, report: &mut Report) {
    if let Some(address) = info.dst.host_address() {
        alignment(command, ("dst", address.0), HOST_ALIGNMENT, RuleId::HostSerializeAlignment07570, report);
    }
}

/// From a micromap to memory is a serialization.
///
/// VUID-VkCopyMicromapToMemoryInfoEXT-mode-07542
fn serialize_mode_07542(command: &At<'_>, info: &vk::CopyMicromapToMemoryInfo, report: &mut Report) {
    let allowed = &["VK_COPY_MICROMAP_MODE_SERIALIZE_EXT"];
    only_mode(command, info.mode, vk::CopyMicromapMode::SERIALIZE, allowed, RuleId::SerializeMode07542, report);
}
