//! Rules on the addresses of micromaps in serialized data.

use omm_model::call::Call;
use omm_model::memory::MemoryView;
use omm_model::profile::Features;
use omm_model::vk;
use omm_serialize::blob::Blob;
use omm_serialize::byte_order::ByteOrder;

use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::{Attachment, Contents, State};
use crate::stateless::MICROMAP_KHR;
use crate::value::Found;
use crate::violation::{Origin, ViolationKind};

/// Where the header holds the number of its bytes and those of the payload.
const SIZE_AT: u64 = 32;

/// Checks serialized data as it is when a command is recorded, or called on the host.
pub(super) fn check(call: &Call, command: &At<'_>, features: &Features, memory: &dyn MemoryView, report: &mut Report) {
    let Some(info) = deserialization(call) else { return };
    let at = command.pointer("pInfo");
    if let Some(blob) = read(info.src, memory) {
        block_feature_11584(&at.field("src").about(info.dst), &blob, features, report);
    }
}

/// Checks serialized data as it is when a command executes.
pub(super) fn check_executed(
    call: &Call,
    command: &At<'_>,
    state: &State,
    memory: &dyn MemoryView,
    report: &mut Report,
) {
    let at = command.pointer("pInfo");
    let (src, rule) = match call {
        Call::CmdCopyAccelerationStructure { info, .. } => (info.src, RuleId::SrcMicromaps11634),
        Call::CopyAccelerationStructure { info, .. } => (info.src, RuleId::SrcMicromaps11587),
        Call::CmdCopyAccelerationStructureToMemory { info, .. }
        | Call::CopyAccelerationStructureToMemory { info, .. } => (info.src, RuleId::SrcMicromaps11582),
        _ => {
            let Some(info) = deserialization(call) else { return };
            if let Some(blob) = read(info.src, memory) {
                block_address_11585(&at.field("src").about(info.dst), &blob, state, report);
            }
            return;
        }
    };
    src_micromaps_11634(&at.field("src").about(src), src, rule, state, memory, report);
}

fn deserialization(call: &Call) -> Option<&vk::CopyMemoryToAccelerationStructureInfo> {
    match call {
        Call::CmdCopyMemoryToAccelerationStructure { info, .. }
        | Call::CopyMemoryToAccelerationStructure { info, .. } => Some(info),
        _ => None,
    }
}

/// Serialized data, if it is readable and well formed.
fn read(address: vk::DeviceOrHostAddress, memory: &dyn MemoryView) -> Option<Blob<'_>> {
    let header = memory.read_either(address, SIZE_AT + 8).ok()?;
    let size = u64::from_le_bytes(*header.last_chunk()?);
    Blob::read(memory.read_either(address, size).ok()?, ByteOrder::Little).ok()
}

/// Blocks of micromaps need micromaps.
///
/// VUID-VkCopyMemoryToAccelerationStructureInfoKHR-dst-11584
fn block_feature_11584(at: &At<'_>, blob: &Blob<'_>, features: &Features, report: &mut Report) {
    let micromap = vk::AccelerationStructureSerializedBlockType::OPACITY_MICROMAP;
    let mut blocks = blob.blocks();
    if !features.micromap && blocks.any(|block| i64::from(block.block_type) == i64::from(micromap.0)) {
        let found = Some(Found::Constant(micromap.into()));
        let kind = ViolationKind::NeedsFeature { found, features: &[MICROMAP_KHR] };
        report.push(RuleId::BlockFeature11584, at, kind);
    }
}

/// Addresses in blocks are those of built micromaps.
///
/// VUID-VkCopyMemoryToAccelerationStructureInfoKHR-dst-11585
fn block_address_11585(at: &At<'_>, blob: &Blob<'_>, state: &State, report: &mut Report) {
    if !state.knows_addresses() {
        return;
    }
    let wrong = blob.micromaps().find_map(|address| Some((address, not_a_micromap(address, state)?)));
    if let Some((found, origin)) = wrong {
        report.push(RuleId::BlockAddress11585, at, ViolationKind::NoMicromapAt { found, origin });
    }
}

/// What is at an address instead of a built micromap; `None` if one is there.
fn not_a_micromap(address: u64, state: &State) -> Option<Origin> {
    let Some(object) = object_at(address, state) else { return Some(Origin::Nothing) };
    let object = state.acceleration_structure(object)?;
    let Some(contents) = &object.contents else { return Some(Origin::NotBuilt) };
    let ty = contents.built.as_deref().map_or(object.ty, |built| built.ty);
    let can_be = [vk::AccelerationStructureType::OPACITY_MICROMAP, vk::AccelerationStructureType::GENERIC];
    (!can_be.contains(&ty)).then_some(Origin::NotMicromap)
}

fn object_at(address: u64, state: &State) -> Option<vk::AccelerationStructure> {
    state.acceleration_structure_at(vk::DeviceAddress(address))
}

/// A deserialized structure is copied with the micromaps that were deserialized for it. The addresses are read where the
/// structure was deserialized from, as long as serialized data lies there.
///
/// VUID-vkCmdCopyAccelerationStructureKHR-src-11634, for host copies 11587, for copies to memory 11582
fn src_micromaps_11634(
    at: &At<'_>,
    src: vk::AccelerationStructure,
    rule: RuleId,
    state: &State,
    memory: &dyn MemoryView,
    report: &mut Report,
) {
    let contents = state.acceleration_structure(src).and_then(|object| object.contents.as_ref());
    // An update named every micromap anew.
    let Some(contents) = contents.filter(|contents| !contents.updated) else { return };
    let Some(blob) = contents.deserialized.and_then(|it| read(it.address, memory)) else { return };
    let wrong = blob.micromaps().find_map(|address| Some((address, wrong_origin(address, contents, state)?)));
    if let Some((found, origin)) = wrong.filter(|_| state.knows_addresses()) {
        report.push(rule, at, ViolationKind::WrongOrigin { found, origin });
    }
}

/// How a micromap that a deserialized structure refers to got its contents, if that is not as it should be.
fn wrong_origin(address: u64, structure: &Contents, state: &State) -> Option<Origin> {
    let Some(micromap) = object_at(address, state) else { return Some(Origin::Nothing) };
    let Some(contents) = &state.acceleration_structure(micromap)?.contents else { return Some(Origin::NotBuilt) };
    let Some(deserialized) = contents.deserialized else { return Some(Origin::Built) };
    let (built, origin) = (structure.built.as_deref()?, deserialized.origin?);
    let is_original = |attachment: Attachment| matches!(attachment, Attachment::Khr(handle) if handle.0 == origin);
    let is_known = built.geometries.iter().any(|geometry| is_original(geometry.attachment));
    (!is_known).then_some(Origin::Other)
}
