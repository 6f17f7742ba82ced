//! The structures that instances refer to.

use omm_layout::{instance, motion_instance};
use omm_model::call::Timeline;
use omm_model::vk::{self, MotionInstanceData};

use super::memory::Executed;
use crate::content::offset_by;
use crate::context::GeometryContext;
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::violation::ViolationKind;

/// Takes the path of an instance and what it refers to; tells whether to go on.
type Visit<'v> = &'v mut dyn FnMut(&At<'_>, u64, &mut Report) -> bool;

/// Visits the references of all instances that lie in memory.
///
/// OMM-memory-01
pub(super) fn each_reference(
    geometry: &GeometryContext<'_>,
    data: &vk::GeometryInstancesData,
    range: vk::BuildRangeInfo,
    executed: &Executed<'_>,
    (visit, report): (Visit<'_>, &mut Report),
) {
    let count = u64::from(range.primitive_count);
    if count == 0 {
        return;
    }
    let at = geometry.at.field("geometry");
    let at = at.field("instances");
    let pointers = data.array_of_pointers.is_true();
    let motion = geometry.build.info.flags.contains(vk::BuildAccelerationStructureFlags::MOTION);
    let (stride, size) = match (pointers, motion) {
        (true, _) => (8, 8),
        (false, true) => (motion_instance::STRIDE, motion_instance::SIZE as u64),
        (false, false) => (instance::SIZE as u64, instance::SIZE as u64),
    };
    let start = (data.data, u64::from(range.primitive_offset));
    let Some(start) = executed.reach_items(&at.field("data"), start, (stride, size, count), report) else { return };
    for index in 0..count {
        let at = at.element("data", usize::try_from(index).unwrap_or(usize::MAX));
        let Some(item) = offset_by(start, index * stride) else { return };
        let Ok(bytes) = executed.memory.read_either(item, size) else { return };
        let found = match (pointers, motion) {
            (true, _) => pointed_to(&at, (item, bytes), motion, executed, report),
            (false, true) => motion_instance::read(bytes).ok(),
            (false, false) => instance::read(bytes).ok().map(MotionInstanceData::StaticInstance),
        };
        let Some(found) = found else { return };
        if !visit(&at, found.acceleration_structure_reference(), report) {
            return;
        }
    }
}

/// The instance that an entry of an array of pointers leads to; with motion the pointer's lowest bits are its type.
fn pointed_to(
    at: &At<'_>,
    (entry, bytes): (vk::DeviceOrHostAddress, &[u8]),
    motion: bool,
    executed: &Executed<'_>,
    report: &mut Report,
) -> Option<MotionInstanceData> {
    let pointer = bytes.first_chunk().map_or(0, |bytes| u64::from_le_bytes(*bytes));
    let ty = if motion { pointer & motion_instance::POINTER_TYPE } else { 0 };
    let (pointer, ty) = (pointer - ty, vk::MotionInstanceType(ty as i32));
    let address = match entry {
        vk::DeviceOrHostAddress::DeviceAddress(_) => vk::DeviceAddress(pointer).into(),
        vk::DeviceOrHostAddress::HostAddress(_) => vk::HostAddress(pointer).into(),
    };
    let size = motion_instance::data_size(ty)? as u64;
    if !executed.reach(at, address, size, report) {
        return None;
    }
    motion_instance::read_data(ty, executed.memory.read_either(address, size).ok()?).ok()
}

/// What an instance refers to: on the host by handle, on the device by address.
pub(super) fn referenced(reference: u64, timeline: Timeline, state: &State) -> Option<vk::AccelerationStructure> {
    match timeline {
        Timeline::Host => Some(vk::AccelerationStructure(reference)),
        Timeline::Device => state.acceleration_structure_at(vk::DeviceAddress(reference)),
    }
}

/// Tells whether an instance refers to a structure that is there, or to none.
///
/// OMM-instance-01
pub(super) fn is_known(at: &At<'_>, reference: u64, executed: &Executed<'_>, report: &mut Report) -> bool {
    let state = executed.state;
    let is_known = match referenced(reference, executed.timeline, state) {
        _ if reference == 0 => true,
        Some(handle) => !state.liveness((vk::AccelerationStructure::OBJECT_TYPE, handle.0)).is_invalid(),
        None => !state.knows_addresses(),
    };
    if !is_known {
        let at = at.field("accelerationStructureReference");
        report.push(RuleId::Instance01, &at, ViolationKind::InvalidAddress { found: reference });
    }
    is_known
}
