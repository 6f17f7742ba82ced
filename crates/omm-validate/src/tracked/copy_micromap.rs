//! Rules of `vkCmdCopyMicromapEXT`, `vkCopyMicromapEXT` and `VkCopyMicromapInfoEXT` on objects, and what they share with other
//! commands on micromap objects.

use omm_model::call::Call;
use omm_model::vk;

use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::value::Flags;
use crate::violation::ViolationKind;

pub(super) fn check(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    let at = command.pointer("pInfo");
    match call {
        Call::CmdCopyMicromap { info: vk::CopyMicromapInfo { src, dst, .. }, .. } => {
            bound_memory(&at.field("src"), *src, state, RuleId::CopySrcMemory07529, report);
            bound_memory(&at.field("dst"), *dst, state, RuleId::CopyDstMemory07530, report);
        }
        Call::CopyMicromap { deferred_operation, info: vk::CopyMicromapInfo { src, dst, .. }, .. } => {
            let (src, dst) = ((&at.field("src"), *src), (&at.field("dst"), *dst));
            complete_operation(command, *deferred_operation, state, RuleId::CopyDeferredOperation03678, report);
            host_visible_memory(src.0, src.1, state, RuleId::HostCopySrcMemory07558, report);
            host_visible_memory(dst.0, dst.1, state, RuleId::HostCopyDstMemory07559, report);
            single_instance_memory(src.0, src.1, state, RuleId::HostCopySrcInstances07561, report);
            single_instance_memory(dst.0, dst.1, state, RuleId::HostCopyDstInstances07562, report);
        }
        _ => {}
    }
}

/// Checks what the command finds when it executes.
pub(super) fn check_executed(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    let (info, source_rule) = match call {
        Call::CmdCopyMicromap { info, .. } => (info, RuleId::CopySource07532),
        Call::CopyMicromap { info, .. } => (info, RuleId::HostCopySource11670),
        _ => return,
    };
    let at = command.pointer("pInfo");
    constructed(&at.field("src"), info.src, state, source_rule, report);
    compaction_flag_07533(&at, info, state, report);
}

/// Only what was built for it can be compacted.
///
/// VUID-VkCopyMicromapInfoEXT-mode-07533
fn compaction_flag_07533(at: &At<'_>, info: &vk::CopyMicromapInfo, state: &State, report: &mut Report) {
    if info.mode == vk::CopyMicromapMode::COMPACT {
        compaction_allowed(&at.field("src"), info.src, state, RuleId::CompactionFlag07533, report);
    }
}

/// A micromap that the device uses has memory under all of it.
///
/// VUID-vkCmdCopyMicromapEXT-buffer-07529,
/// VUID-vkCmdCopyMicromapEXT-buffer-07530,
/// VUID-vkCmdCopyMemoryToMicromapEXT-buffer-07546,
/// VUID-vkCmdCopyMicromapToMemoryEXT-buffer-07539,
/// VUID-vkCmdWriteMicromapsPropertiesEXT-buffer-07527
pub(super) fn bound_memory(at: &At<'_>, micromap: vk::Micromap, state: &State, rule: RuleId, report: &mut Report) {
    if let Some(object) = state.micromap(micromap)
        && state.micromap_is_bound(micromap) == Some(false)
    {
        report.push(rule, &at.about_micromap(micromap), ViolationKind::NotBound { buffer: object.buffer.0 });
    }
}

/// A micromap that the host uses lies in memory that it can map.
///
/// VUID-vkCopyMicromapEXT-buffer-07558,
/// VUID-vkCopyMicromapEXT-buffer-07559,
/// VUID-vkCopyMemoryToMicromapEXT-buffer-07565,
/// VUID-vkCopyMicromapToMemoryEXT-buffer-07568,
/// VUID-vkWriteMicromapsPropertiesEXT-buffer-07577
pub(super) fn host_visible_memory(
    at: &At<'_>,
    micromap: vk::Micromap,
    state: &State,
    rule: RuleId,
    report: &mut Report,
) {
    let types = || state.micromap_memory(micromap).filter_map(|span| state.memory(span.memory)?.property_flags);
    let hidden = |flags: &vk::MemoryPropertyFlags| !flags.contains(vk::MemoryPropertyFlags::HOST_VISIBLE);
    let found = match state.micromap_is_bound(micromap) {
        Some(false) => None,
        Some(true) => match types().find(hidden) {
            Some(flags) => Some(Flags::from(flags)),
            None => return,
        },
        None => return,
    };
    report.push(rule, &at.about_micromap(micromap), ViolationKind::NotHostVisible { found });
}

/// A micromap that the host uses lies in memory of which there is one instance.
///
/// VUID-vkCopyMicromapEXT-buffer-07561,
/// VUID-vkCopyMicromapEXT-buffer-07562,
/// VUID-vkCopyMemoryToMicromapEXT-buffer-07567,
/// VUID-vkCopyMicromapToMemoryEXT-buffer-07572,
/// VUID-vkWriteMicromapsPropertiesEXT-buffer-07579
pub(super) fn single_instance_memory(
    at: &At<'_>,
    micromap: vk::Micromap,
    state: &State,
    rule: RuleId,
    report: &mut Report,
) {
    let memories = state.micromap_memory(micromap).filter_map(|span| state.memory(span.memory));
    let instances = memories.map(|memory| memory.instances).max();
    if let Some(instances) = instances.filter(|instances| *instances > 1) {
        let kind = ViolationKind::MultipleInstances { found: instances as u64 };
        report.push(rule, &at.about_micromap(micromap), kind);
    }
}

/// A command is deferred on an operation that has no other to complete.
///
/// VUID-vkCopyMicromapEXT-deferredOperation-03678,
/// VUID-vkCopyMicromapToMemoryEXT-deferredOperation-03678,
/// VUID-vkCopyMemoryToMicromapEXT-deferredOperation-03678
pub(super) fn complete_operation(
    command: &At<'_>,
    operation: vk::DeferredOperation,
    state: &State,
    rule: RuleId,
    report: &mut Report,
) {
    if let Some(pending) = state.deferred_operation(operation).and_then(|operation| operation.pending.as_ref()) {
        let kind = ViolationKind::Pending { command: pending.command() };
        report.push(rule, &command.field("deferredOperation"), kind);
    }
}

/// What a command reads was built, copied or deserialized before it executes.
///
/// VUID-vkCmdCopyMicromapEXT-src-07532,
/// VUID-vkCopyMicromapEXT-src-11670,
/// VUID-VkCopyMicromapToMemoryInfoEXT-src-07540,
/// VUID-vkCmdWriteMicromapsPropertiesEXT-pMicromaps-11662,
/// VUID-vkWriteMicromapsPropertiesEXT-pMicromaps-11671
pub(super) fn constructed(at: &At<'_>, micromap: vk::Micromap, state: &State, rule: RuleId, report: &mut Report) {
    if state.micromap(micromap).is_some_and(|object| object.contents.is_none()) {
        report.push(rule, &at.about_micromap(micromap), ViolationKind::NotBuilt { found: micromap.0 });
    }
}

/// The build behind a micromap, as far as it is known, allows compaction. What deserialization leaves of a build is not known.
///
/// VUID-VkCopyMicromapInfoEXT-mode-07533,
/// VUID-vkCmdWriteMicromapsPropertiesEXT-pMicromaps-07502,
/// VUID-vkWriteMicromapsPropertiesEXT-pMicromaps-07502
pub(super) fn compaction_allowed(
    at: &At<'_>,
    micromap: vk::Micromap,
    state: &State,
    rule: RuleId,
    report: &mut Report,
) {
    let contents = state.micromap(micromap).and_then(|object| object.contents.as_ref());
    let contents = contents.filter(|contents| contents.deserialized.is_none());
    let required = vk::BuildMicromapFlags::ALLOW_COMPACTION;
    if let Some(built) = contents.and_then(|contents| contents.built.as_ref())
        && !built.flags.contains(required)
    {
        let kind = ViolationKind::MissingFlags { found: built.flags.into(), required: required.into() };
        report.push(rule, &at.about_micromap(micromap), kind);
    }
}

/// A device command is given an address in a buffer.
///
/// VUID-vkCmdCopyMicromapToMemoryEXT-pInfo-07536,
/// VUID-vkCmdCopyMemoryToMicromapEXT-pInfo-07543
pub(super) fn device_address(
    at: &At<'_>,
    address: vk::DeviceOrHostAddress,
    state: &State,
    rule: RuleId,
    report: &mut Report,
) {
    let is_wrong = match address.device_address() {
        Some(device) => device.is_null() || state.knows_addresses() && state.bytes_from(device).is_none(),
        None => true,
    };
    if is_wrong {
        report.push(rule, at, ViolationKind::InvalidAddress { found: address.raw() });
    }
}
