//! Rules of `VkMicromapCreateInfoEXT` on the buffer, and on the device.

use omm_model::call::Call;
use omm_model::vk;

use super::build_micromaps::multi_device;
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::{BufferState, State};
use crate::violation::ViolationKind;

pub(super) fn check(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    let Call::CreateMicromap { device, create_info, .. } = call else { return };
    let at = command.pointer("pCreateInfo");
    multi_device_replay_11617(&at, *device, create_info, state, report);
    // No such buffer: another rule's business.
    if let Some(buffer) = state.buffer(create_info.buffer) {
        buffer_usage_07435(&at, buffer, report);
        sparse_buffer_07436(&at, buffer, report);
        range_07437(&at, create_info, buffer, report);
    }
}

/// On several physical devices, addresses can be replayed only if they are the same on each.
///
/// VUID-VkMicromapCreateInfoEXT-bufferDeviceAddressMultiDevice-11617
fn multi_device_replay_11617(
    at: &At<'_>,
    device: vk::Device,
    create_info: &vk::MicromapCreateInfo,
    state: &State,
    report: &mut Report,
) {
    if create_info.create_flags.contains(vk::MicromapCreateFlags::DEVICE_ADDRESS_CAPTURE_REPLAY) {
        multi_device(&at.field("createFlags"), device, state, RuleId::MultiDeviceReplay11617, report);
    }
}

/// The buffer is made to hold micromaps.
///
/// VUID-VkMicromapCreateInfoEXT-buffer-07435
fn buffer_usage_07435(at: &At<'_>, buffer: &BufferState, report: &mut Report) {
    let required = vk::BufferUsageFlags::MICROMAP_STORAGE;
    if !buffer.usage.contains(required) {
        let kind = ViolationKind::MissingFlags { found: buffer.usage.into(), required: required.into() };
        report.push(RuleId::BufferUsage07435, &at.field("buffer"), kind);
    }
}

/// The buffer has no parts without memory.
///
/// VUID-VkMicromapCreateInfoEXT-buffer-07436
fn sparse_buffer_07436(at: &At<'_>, buffer: &BufferState, report: &mut Report) {
    let forbidden = vk::BufferCreateFlags::SPARSE_RESIDENCY;
    if buffer.flags.contains(forbidden) {
        let kind = ViolationKind::ForbiddenFlags { found: buffer.flags.into(), forbidden: forbidden.into() };
        report.push(RuleId::SparseBuffer07436, &at.field("buffer"), kind);
    }
}

/// The micromap ends before its buffer does.
///
/// VUID-VkMicromapCreateInfoEXT-offset-07437
fn range_07437(at: &At<'_>, create_info: &vk::MicromapCreateInfo, buffer: &BufferState, report: &mut Report) {
    let vk::MicromapCreateInfo { offset: start, size, .. } = *create_info;
    let (size, available) = (u128::from(size), buffer.size.saturating_sub(start));
    if u128::from(start) + size > buffer.size.into() {
        report.push(RuleId::Range07437, &at.field("size"), ViolationKind::BeyondBuffer { start, size, available });
    }
}
