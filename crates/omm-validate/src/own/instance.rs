//! The structures that instances refer to.

use omm_layout::instance;
use omm_model::call::Timeline;
use omm_model::vk;

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
    let size = if pointers { 8 } else { instance::SIZE as u64 };
    let start = (data.data, u64::from(range.primitive_offset));
    let Some(start) = executed.reach_items(&at.field("data"), start, (size, size, count), report) else { return };
    for index in 0..count {
        let at = at.element("data", usize::try_from(index).unwrap_or(usize::MAX));
        let Some(mut address) = offset_by(start, index * size) else { return };
        if pointers {
            let Ok(bytes) = executed.memory.read_either(address, 8) else { return };
            let pointer = bytes.first_chunk().map_or(0, |bytes| u64::from_le_bytes(*bytes));
            address = match address {
                vk::DeviceOrHostAddress::DeviceAddress(_) => vk::DeviceAddress(pointer).into(),
                vk::DeviceOrHostAddress::HostAddress(_) => vk::HostAddress(pointer).into(),
            };
            if !executed.reach(&at, address, instance::SIZE as u64, report) {
                return;
            }
        }
        let found = executed.memory.read_either(address, instance::SIZE as u64).ok();
        let Some(found) = found.and_then(|bytes| instance::read(bytes).ok()) else { return };
        if !visit(&at, found.acceleration_structure_reference, report) {
            return;
        }
    }
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
