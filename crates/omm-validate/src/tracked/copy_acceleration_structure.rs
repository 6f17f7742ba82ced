//! Rules of copies of acceleration structures on the objects that they read and write.

use omm_model::call::Call;
use omm_model::vk;

use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::{MemorySpan, State, Storage};
use crate::violation::ViolationKind;

/// What the addresses of serialized micromaps are aligned to.
const SERIALIZED_MICROMAP_ALIGNMENT: u64 = 128;

pub(super) fn check(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    let at = command.pointer("pInfo");
    match call {
        Call::CmdCopyAccelerationStructureToMemory { command_buffer, info } => {
            dst_address_11699(&at, *command_buffer, info, state, report);
        }
        Call::CmdCopyMemoryToAccelerationStructure { info, .. } => src_address_11700(&at, info, state, report),
        Call::CmdCopyAccelerationStructure { info, .. } | Call::CopyAccelerationStructure { info, .. } => {
            size_01(&at, info, state, report);
            overlap_02(&at, info, state, report);
            type_03(&at, info, state, report);
        }
        _ => {}
    }
}

/// Checks what a command finds when it executes: the memory of the objects that it reads and writes.
pub(super) fn check_executed(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    let at = command.pointer("pInfo");
    let mut object = |name: &'static str, handle| check_bound(&at.field(name).about(handle), handle, state, report);
    match call {
        Call::CmdCopyAccelerationStructure { info, .. } | Call::CopyAccelerationStructure { info, .. } => {
            object("src", info.src);
            object("dst", info.dst);
        }
        Call::CmdCopyAccelerationStructureToMemory { info, .. }
        | Call::CopyAccelerationStructureToMemory { info, .. } => object("src", info.src),
        Call::CmdCopyMemoryToAccelerationStructure { info, .. }
        | Call::CopyMemoryToAccelerationStructure { info, .. } => object("dst", info.dst),
        Call::CmdWriteAccelerationStructuresProperties { acceleration_structures, .. }
        | Call::WriteAccelerationStructuresProperties { acceleration_structures, .. } => {
            for (index, handle) in acceleration_structures.iter().enumerate() {
                let at = command.element("pAccelerationStructures", index).about(*handle);
                check_bound(&at, *handle, state, report);
            }
        }
        _ => {}
    }
}

/// The memory of an object that promised to be bound is bound when it is read or written.
///
/// VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-13097
pub(super) fn check_bound(at: &At<'_>, handle: vk::AccelerationStructure, state: &State, report: &mut Report) {
    let Some(object) = state.acceleration_structure(handle) else { return };
    let promised = object.address_flags.is_some_and(|it| it.contains(vk::AddressCommandFlags::FULLY_BOUND));
    let Storage::AddressRange(range) = object.storage else { return };
    if !promised {
        return;
    }
    let unbound = state.buffers_at(range.address).find(|(buffer, _, offset, available)| {
        let (offset, size) = (*offset, range.size.min(*available));
        // Of a buffer that was never bound at all the binding was not seen.
        let (is_seen, is_bound) = (state.was_bound(*buffer), state.is_bound(*buffer, offset, size));
        is_seen && is_bound == Some(false)
    });
    if unbound.is_some() {
        report.push(RuleId::FullyBound13097, at, ViolationKind::Unbound { start: range.address.0 });
    }
}

/// Reports an address that no serialized micromap can have.
fn serialized_micromap_aligned(at: &At<'_>, address: vk::DeviceOrHostAddress, rule: RuleId, report: &mut Report) {
    let alignment = SERIALIZED_MICROMAP_ALIGNMENT;
    if !address.raw().is_multiple_of(alignment) {
        report.push(rule, &at.field("deviceAddress"), ViolationKind::Misaligned { found: address.raw(), alignment });
    }
}

fn was_created_as_micromap(state: &State, handle: vk::AccelerationStructure) -> bool {
    let object = state.acceleration_structure(handle);
    object.is_some_and(|object| object.ty == vk::AccelerationStructureType::OPACITY_MICROMAP)
}

/// Micromaps are serialized to aligned memory.
///
/// VUID-vkCmdCopyAccelerationStructureToMemoryKHR-pInfo-11699
fn dst_address_11699(
    at: &At<'_>,
    command_buffer: vk::CommandBuffer,
    info: &vk::CopyAccelerationStructureToMemoryInfo,
    state: &State,
    report: &mut Report,
) {
    let built = state.built(command_buffer, info.src).map(|built| built.ty);
    if built == Some(vk::AccelerationStructureType::OPACITY_MICROMAP) || was_created_as_micromap(state, info.src) {
        serialized_micromap_aligned(&at.field("dst").about(info.src), info.dst, RuleId::DstAddress11699, report);
    }
}

/// Micromaps are deserialized from aligned memory.
///
/// VUID-vkCmdCopyAccelerationStructureToMemoryKHR-pInfo-11700
fn src_address_11700(
    at: &At<'_>,
    info: &vk::CopyMemoryToAccelerationStructureInfo,
    state: &State,
    report: &mut Report,
) {
    let built = state.serialized_structure(info.src).and_then(|(_, contents)| contents.built.as_deref());
    let was_micromap = built.is_some_and(|built| built.ty == vk::AccelerationStructureType::OPACITY_MICROMAP);
    if was_micromap || was_created_as_micromap(state, info.dst) {
        serialized_micromap_aligned(&at.field("src").about(info.dst), info.src, RuleId::SrcAddress11700, report);
    }
}

/// A clone has room for what it clones.
///
/// OMM-copy_acceleration_structure-01
fn size_01(at: &At<'_>, info: &vk::CopyAccelerationStructureInfo, state: &State, report: &mut Report) {
    let size = |handle| match state.acceleration_structure(handle)?.storage {
        Storage::Buffer { size, .. } | Storage::AddressRange(vk::DeviceAddressRange { size, .. }) => Some(size),
    };
    let (Some(required), Some(found)) = (size(info.src), size(info.dst)) else { return };
    if info.mode == vk::CopyAccelerationStructureMode::CLONE && found < required {
        let at = at.field("dst").about(info.dst);
        report.push(RuleId::CopySize01, &at, ViolationKind::TooSmallFor { found, required });
    }
}

/// A copy does not write over what it reads.
///
/// OMM-copy_acceleration_structure-02
fn overlap_02(at: &At<'_>, info: &vk::CopyAccelerationStructureInfo, state: &State, report: &mut Report) {
    if state.acceleration_structure(info.src).is_some() && share_memory(info.src, info.dst, state) {
        let vk::DeviceAddressRange { address, size } = state.address_range(info.dst).unwrap_or_default();
        let kind = ViolationKind::OverlapsObject { start: address.0, size, other: info.src.0 };
        report.push(RuleId::CopyOverlap02, &at.field("dst").about(info.dst), kind);
    }
}

/// Whether two objects are known to have memory, or addresses, in common.
pub(super) fn share_memory(first: vk::AccelerationStructure, second: vk::AccelerationStructure, state: &State) -> bool {
    let overlaps = |span: MemorySpan| state.structure_memory(second).any(|other| span.overlaps(&other));
    if state.structure_memory(first).any(overlaps) {
        return true;
    }
    match (state.address_range(first), state.address_range(second)) {
        (Some(first), Some(second)) => overlap(first, second),
        _ => false,
    }
}

/// Whether two ranges have an address in common.
fn overlap(first: vk::DeviceAddressRange, second: vk::DeviceAddressRange) -> bool {
    let end = |range: vk::DeviceAddressRange| u128::from(range.address.0) + u128::from(range.size);
    u128::from(first.address.0.max(second.address.0)) < end(first).min(end(second))
}

/// A copy goes into an object made for what it holds.
///
/// OMM-copy_acceleration_structure-03
fn type_03(at: &At<'_>, info: &vk::CopyAccelerationStructureInfo, state: &State, report: &mut Report) {
    let ty = |handle| state.acceleration_structure(handle).map(|object| object.ty);
    let (Some(required), Some(found)) = (ty(info.src), ty(info.dst)) else { return };
    if found != required && found != vk::AccelerationStructureType::GENERIC {
        let kind = ViolationKind::WrongValue { found: found.into(), required: required.into() };
        report.push(RuleId::CopyType03, &at.field("dst").about(info.dst), kind);
    }
}
