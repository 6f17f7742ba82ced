//! Serialized data is of this device, whole, and refers to structures that are there.

use omm_layout::object::{self, ObjectHeader, ObjectKind};
use omm_model::call::Call;
use omm_model::profile::DeviceProfile;
use omm_model::vk;
use omm_serialize::ByteOrder;
use omm_serialize::blob::Prefix;
use omm_serialize::header::FIXED_SIZE;

use super::contents::{created_size, deserialized, destination_type, room};
use super::memory::Executed;
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::{Origin, ViolationKind};

/// OMM-serialized-01
pub(super) fn check(call: &Call, command: &At<'_>, executed: &Executed<'_>, report: &mut Report) {
    let at = command.pointer("pInfo");
    match call {
        Call::CmdCopyMemoryToAccelerationStructure { info, .. }
        | Call::CopyMemoryToAccelerationStructure { info, .. } => {
            let dst = (vk::AccelerationStructure::OBJECT_TYPE, info.dst.0);
            if deserialized(&at, (info.src, dst), executed, report) && !executed.state.was_just_serialized(info.src) {
                structure(&at, info, executed, report);
            }
        }
        Call::CmdCopyMemoryToMicromap { info, .. } | Call::CopyMemoryToMicromap { info, .. } => {
            deserialized(&at, (info.src, (vk::Micromap::OBJECT_TYPE, info.dst.0)), executed, report);
        }
        _ => {}
    }
}

fn structure(
    at: &At<'_>,
    info: &vk::CopyMemoryToAccelerationStructureInfo,
    executed: &Executed<'_>,
    report: &mut Report,
) {
    let (src, profile) = (at.field("src"), executed.state.profile());
    let Ok(bytes) = executed.memory.read_either(info.src, FIXED_SIZE) else { return };
    let Ok(prefix) = Prefix::read(bytes, ByteOrder::Little) else {
        return malformed(&src, (0, false), report);
    };
    let found = [prefix.driver_uuid, prefix.compatibility_uuid];
    let required = [profile.driver_uuid, profile.compatibility_uuid];
    if found != required {
        report.push(RuleId::Serialized01, &src, ViolationKind::Incompatible { found, required });
        return;
    }
    if !executed.reach(&src, info.src, prefix.serialized_size, report) {
        return;
    }
    if let Some(found) = created_size(executed.state, info.dst) {
        room(&at.field("dst").about(info.dst), found, prefix.deserialized_size, report);
    }
    // Only the payload of simulated devices can be read.
    if profile.driver_uuid == DeviceProfile::reference().driver_uuid
        && let Ok(blob) = executed.memory.read_either(info.src, prefix.serialized_size)
    {
        payload(at, info, blob, executed, report);
    }
}

fn payload(
    at: &At<'_>,
    info: &vk::CopyMemoryToAccelerationStructureInfo,
    blob: &[u8],
    executed: &Executed<'_>,
    report: &mut Report,
) {
    let src = at.field("src");
    let object = match omm_serialize::deserialize_object(blob) {
        Ok(object) => object,
        Err(error) => return malformed(&src, (error.offset, error.is_truncated()), report),
    };
    let ty = match ObjectHeader::read(&object).map(|header| header.kind) {
        Ok(ObjectKind::TopLevel) => vk::AccelerationStructureType::TOP_LEVEL,
        Ok(ObjectKind::BottomLevel) => vk::AccelerationStructureType::BOTTOM_LEVEL,
        Ok(ObjectKind::Micromap) => vk::AccelerationStructureType::OPACITY_MICROMAP,
        Err(error) => return malformed(&src, (error.offset, error.is_truncated()), report),
    };
    destination_type(&at.field("dst"), info.dst, ty, executed.state, report);
    if let Some(found) = created_size(executed.state, info.dst) {
        room(&at.field("dst").about(info.dst), found, object.len() as u64, report);
    }
    let Ok(mut references) = object::references(&object) else { return malformed(&src, (0, false), report) };
    let is_known = |address: u64| {
        let address = vk::DeviceAddress(address);
        executed.state.acceleration_structure_at(address).is_some() || executed.state.micromap_at(address).is_some()
    };
    if let Some(found) = references.find(|address| executed.state.knows_addresses() && !is_known(*address)) {
        let kind = ViolationKind::NoMicromapAt { found, origin: Origin::Nothing };
        report.push(RuleId::Serialized01, &src, kind);
    }
}

fn malformed(at: &At<'_>, (offset, truncated): (u64, bool), report: &mut Report) {
    let writer = "vkCmdCopyAccelerationStructureToMemoryKHR";
    report.push(RuleId::Serialized01, at, ViolationKind::NotSerialized { offset, truncated, writer });
}
