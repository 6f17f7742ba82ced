//! Rules of `vkCopyMicromapToMemoryEXT` and `VkCopyMicromapToMemoryInfoEXT` on the memory that is written.

use omm_model::call::Call;
use omm_model::memory::MemoryView;
use omm_model::vk;

use super::copy_memory_to_micromap::host_memory;
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::violation::ViolationKind;

pub(super) fn check(call: &Call, command: &At<'_>, state: &State, memory: &dyn MemoryView, report: &mut Report) {
    match call {
        Call::CopyMicromapToMemory { info, .. } => {
            host_serialize_pointer_07569(command, info, memory, report);
            serialize_room_07541(command, info, state, memory, report);
        }
        Call::CmdCopyMicromapToMemory { info, .. } => serialize_room_07541(command, info, state, memory, report),
        _ => {}
    }
}

/// The host writes to its own memory.
///
/// VUID-vkCopyMicromapToMemoryEXT-pInfo-07569
fn host_serialize_pointer_07569(
    command: &At<'_>,
    info: &vk::CopyMicromapToMemoryInfo,
    memory: &dyn MemoryView,
    report: &mut Report,
) {
    host_memory(command, ("dst", info.dst), memory, RuleId::HostSerializePointer07569, report);
}

/// There is room for as many bytes as the size query answered.
///
/// VUID-VkCopyMicromapToMemoryInfoEXT-dst-07541
fn serialize_room_07541(
    command: &At<'_>,
    info: &vk::CopyMicromapToMemoryInfo,
    state: &State,
    memory: &dyn MemoryView,
    report: &mut Report,
) {
    let contents = state.micromap(info.src).and_then(|object| object.contents.as_ref());
    let Some(needed) = contents.and_then(|contents| contents.serialization_size) else { return };
    let kind = match info.dst {
        vk::DeviceOrHostAddress::DeviceAddress(start) => {
            let available = state.bytes_from(start).filter(|available| *available < needed);
            available.map(|available| ViolationKind::BeyondBuffer { start: start.0, size: needed.into(), available })
        }
        vk::DeviceOrHostAddress::HostAddress(start) => {
            let error = memory.read_host(start, needed).err();
            // Nothing there: another rule's business.
            let error = error.filter(|error| memory.knows_host_memory() && error.available > 0);
            error.map(|error| ViolationKind::BeyondHostMemory {
                start: start.0,
                size: needed,
                available: error.available,
            })
        }
    };
    if let Some(kind) = kind {
        report.push(RuleId::SerializeRoom07541, &command.pointer("pInfo").field("dst"), kind);
    }
}
