//! Objects that a command reads hold something, of the kind that it reads, and those that it writes have room.

use omm_model::call::{Call, Timeline};
use omm_model::vk;

use super::memory::Executed;
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::{Contents, MemorySpan, MicromapState, State, Storage};
use crate::value::Constant;
use crate::violation::ViolationKind;

const fn object(handle: vk::AccelerationStructure) -> crate::location::Object {
    (vk::AccelerationStructure::OBJECT_TYPE, handle.0)
}

const fn micromap_object(handle: vk::Micromap) -> crate::location::Object {
    (vk::Micromap::OBJECT_TYPE, handle.0)
}

/// What is wrong with what copies and questions for sizes read and write.
pub(super) fn check_executed(call: &Call, command: &At<'_>, executed: &Executed<'_>, report: &mut Report) {
    let info = command.pointer("pInfo");
    match call {
        Call::CmdCopyAccelerationStructure { info: copy, .. } | Call::CopyAccelerationStructure { info: copy, .. } => {
            source(&info.field("src"), copy.src, executed, report);
            executed.object(&info.field("dst"), object(copy.dst), report);
            compacted_size(&info.field("dst"), copy, executed.state, report);
        }
        Call::CmdCopyAccelerationStructureToMemory { info: copy, .. }
        | Call::CopyAccelerationStructureToMemory { info: copy, .. } => {
            source(&info.field("src"), copy.src, executed, report);
            let told = executed.state.acceleration_structure(copy.src).and_then(|it| it.contents.as_ref());
            let size = told.and_then(|contents| contents.serialization_size);
            executed.reach(&info.field("dst"), copy.dst, size.unwrap_or(1), report);
        }
        Call::CmdWriteAccelerationStructuresProperties { acceleration_structures, .. }
        | Call::WriteAccelerationStructuresProperties { acceleration_structures, .. } => {
            for (index, handle) in acceleration_structures.iter().enumerate() {
                source(&command.element("pAccelerationStructures", index), *handle, executed, report);
            }
        }
        Call::CmdCopyMicromap { info: copy, .. } | Call::CopyMicromap { info: copy, .. } => {
            executed.object(&info.field("src"), micromap_object(copy.src), report);
            executed.object(&info.field("dst"), micromap_object(copy.dst), report);
            micromap_size(&info.field("dst"), copy, executed.state, report);
            micromap_overlap(&info.field("dst"), copy, executed.state, report);
        }
        Call::CmdCopyMicromapToMemory { info: copy, .. } | Call::CopyMicromapToMemory { info: copy, .. } => {
            executed.object(&info.field("src"), micromap_object(copy.src), report);
            let told = executed.state.micromap(copy.src).and_then(MicromapState::serialization_size);
            executed.reach(&info.field("dst"), copy.dst, told.unwrap_or(1), report);
        }
        Call::CmdWriteMicromapsProperties { micromaps, .. } | Call::WriteMicromapsProperties { micromaps, .. } => {
            for (index, handle) in micromaps.iter().enumerate() {
                executed.object(&command.element("pMicromaps", index), micromap_object(*handle), report);
            }
        }
        Call::GetAccelerationStructureDeviceAddress { info: asked, .. } => {
            // The address is that of memory, whoever asks.
            let executed = Executed { timeline: Timeline::Device, ..*executed };
            executed.object(&info.field("accelerationStructure"), object(asked.acceleration_structure), report);
        }
        Call::CmdTraceRays { top_level, .. } | Call::CmdDispatch { top_level, .. } => {
            traced(&command.field("topLevel"), *top_level, executed, report);
        }
        _ => {}
    }
}

/// An acceleration structure that is read: its memory and its contents.
///
/// OMM-contents-01
pub(super) fn source(at: &At<'_>, handle: vk::AccelerationStructure, executed: &Executed<'_>, report: &mut Report) {
    executed.object(at, object(handle), report);
    let found = executed.state.acceleration_structure(handle);
    if found.is_some_and(|found| found.contents.is_none()) {
        report.push(RuleId::Contents01, &at.about(handle), ViolationKind::NotBuilt { found: handle.0 });
    }
}

/// The same for a micromap object.
pub(super) fn micromap_source(at: &At<'_>, handle: vk::Micromap, executed: &Executed<'_>, report: &mut Report) {
    executed.object(at, micromap_object(handle), report);
    if executed.state.micromap(handle).is_some_and(|found| found.contents.is_none()) {
        report.push(RuleId::Contents01, &at.about_micromap(handle), ViolationKind::NotBuilt { found: handle.0 });
    }
}

/// What an acceleration structure holds, or was created to hold where that is not known.
pub(super) fn type_of(state: &State, handle: vk::AccelerationStructure) -> Option<vk::AccelerationStructureType> {
    let found = state.acceleration_structure(handle)?;
    let built = found.built().map(|built| built.ty);
    built.or(Some(found.ty).filter(|ty| *ty != vk::AccelerationStructureType::GENERIC))
}

/// Rays are traced against a top-level structure that is built.
fn traced(at: &At<'_>, address: vk::DeviceAddress, executed: &Executed<'_>, report: &mut Report) {
    let state = executed.state;
    let Some(handle) = state.acceleration_structure_at(address) else {
        if state.knows_addresses() {
            report.push(RuleId::Contents01, at, ViolationKind::InvalidAddress { found: address.0 });
        }
        return;
    };
    source(at, handle, executed, report);
    let required = vk::AccelerationStructureType::TOP_LEVEL;
    if let Some(found) = type_of(state, handle).filter(|found| *found != required) {
        let kind = ViolationKind::WrongValue { found: found.into(), required: required.into() };
        report.push(RuleId::Contents01, &at.about(handle), kind);
    }
}

/// An object that is written as a type was created for it.
///
/// OMM-contents-01
pub(super) fn destination_type(
    at: &At<'_>,
    handle: vk::AccelerationStructure,
    required: vk::AccelerationStructureType,
    state: &State,
    report: &mut Report,
) {
    let created = state.acceleration_structure(handle).map(|found| found.ty);
    let can_be = |ty: vk::AccelerationStructureType| ty == required || ty == vk::AccelerationStructureType::GENERIC;
    if let Some(found) = created.filter(|found| !can_be(*found)) {
        let (found, required): (Constant, Constant) = (found.into(), required.into());
        report.push(RuleId::Contents01, &at.about(handle), ViolationKind::WrongValue { found, required });
    }
}

/// Bytes that an acceleration structure was created with.
pub(super) fn created_size(state: &State, handle: vk::AccelerationStructure) -> Option<u64> {
    Some(match state.acceleration_structure(handle)?.storage {
        Storage::Buffer { size, .. } => size,
        Storage::AddressRange(range) => range.size,
    })
}

/// A compaction has room for as many bytes as the query for its size said.
///
/// OMM-size-01
fn compacted_size(at: &At<'_>, copy: &vk::CopyAccelerationStructureInfo, state: &State, report: &mut Report) {
    if copy.mode != vk::CopyAccelerationStructureMode::COMPACT {
        return;
    }
    let contents: Option<&Contents> = state.acceleration_structure(copy.src).and_then(|it| it.contents.as_ref());
    let told = contents.and_then(|contents| contents.compacted_size);
    if let (Some(required), Some(found)) = (told, created_size(state, copy.dst)) {
        room(&at.about(copy.dst), found, required, report);
    }
}

/// The same for micromap objects, clones among them.
///
/// OMM-size-01
fn micromap_size(at: &At<'_>, copy: &vk::CopyMicromapInfo, state: &State, report: &mut Report) {
    let (Some(src), Some(dst)) = (state.micromap(copy.src), state.micromap(copy.dst)) else { return };
    let told = src.contents.as_ref().and_then(|contents| contents.compacted_size);
    let required = match copy.mode {
        vk::CopyMicromapMode::COMPACT => told,
        _ => Some(src.size),
    };
    if let Some(required) = required {
        room(&at.about_micromap(copy.dst), dst.size, required, report);
    }
}

/// A micromap object is not copied onto itself.
///
/// OMM-overlap-01
fn micromap_overlap(at: &At<'_>, copy: &vk::CopyMicromapInfo, state: &State, report: &mut Report) {
    let overlaps = |span: &MemorySpan| state.micromap_memory(copy.src).any(|other| span.overlaps(&other));
    if let Some(shared) = state.micromap_memory(copy.dst).find(overlaps) {
        let kind = ViolationKind::OverlapsObject { start: shared.offset, size: shared.size, other: copy.src.0 };
        report.push(RuleId::Overlap01, &at.about_micromap(copy.dst), kind);
    }
}

pub(super) fn room(at: &At<'_>, found: u64, required: u64, report: &mut Report) {
    if found < required {
        report.push(RuleId::Size01, at, ViolationKind::TooSmallFor { found, required });
    }
}

/// Where a copy of serialized data reads from and writes to.
pub(super) fn deserialized(
    at: &At<'_>,
    (src, dst): (vk::DeviceOrHostAddress, crate::location::Object),
    executed: &Executed<'_>,
    report: &mut Report,
) -> bool {
    executed.object(&at.field("dst"), dst, report);
    executed.reach(&at.field("src"), src, omm_serialize::header::FIXED_SIZE, report)
}
