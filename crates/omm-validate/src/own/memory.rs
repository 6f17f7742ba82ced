//! What a command reads and writes lies in memory that it can reach.

use omm_model::call::Timeline;
use omm_model::memory::MemoryView;
use omm_model::vk;

use crate::content::offset_by;
use crate::location::{At, Object};
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::{State, Storage};
use crate::violation::ViolationKind;

/// What rules look at when a command executes.
#[derive(Clone, Copy)]
pub(super) struct Executed<'a> {
    pub(super) state: &'a State,
    pub(super) memory: &'a dyn MemoryView,
    pub(super) timeline: Timeline,
}

impl<'a> Executed<'a> {
    /// Reports bytes that are not in the memory that commands of the timeline use; tells whether they are.
    ///
    /// OMM-memory-01
    pub(super) fn reach(&self, at: &At<'_>, address: vk::DeviceOrHostAddress, size: u64, report: &mut Report) -> bool {
        let wrong = match (self.timeline, address) {
            (Timeline::Device, vk::DeviceOrHostAddress::DeviceAddress(address)) => self.unreachable(address, size),
            (Timeline::Device, other) => Some(ViolationKind::InvalidAddress { found: other.raw() }),
            (Timeline::Host, vk::DeviceOrHostAddress::HostAddress(address)) => self.unreachable_host(address, size),
            (Timeline::Host, other) => Some(ViolationKind::InvalidHostAddress { found: other.raw() }),
        };
        if let Some(kind) = wrong {
            report.push(RuleId::Memory01, at, kind);
        }
        wrong.is_none()
    }

    /// The same for some items of one size at equal distances, behind an offset. Tells where the first begins, if all is well.
    pub(super) fn reach_items(
        &self,
        at: &At<'_>,
        (address, offset): (vk::DeviceOrHostAddress, u64),
        (stride, size, count): (u64, u64, u64),
        report: &mut Report,
    ) -> Option<vk::DeviceOrHostAddress> {
        let Some(start) = offset_by(address, offset) else {
            report.push(RuleId::Memory01, at, ViolationKind::InvalidAddress { found: address.raw() });
            return None;
        };
        let all = count.saturating_sub(1).saturating_mul(stride).saturating_add(size);
        self.reach(at, start, all, report).then_some(start)
    }

    /// What is wrong with bytes in device memory.
    pub(super) fn unreachable(&self, start: vk::DeviceAddress, size: u64) -> Option<ViolationKind> {
        let state = self.state;
        if !state.knows_addresses() {
            return None;
        }
        let Some(available) = state.bytes_from(start) else {
            return Some(ViolationKind::InvalidAddress { found: start.0 });
        };
        if available < size {
            return Some(ViolationKind::BeyondBuffer { start: start.0, size: size.into(), available });
        }
        let mut around = state.buffers_at(start).filter(|(_, _, _, available)| *available >= size);
        let is_bound = around
            .any(|(buffer, _, offset, _)| !state.sees_bindings() || state.is_bound(buffer, offset, size) == Some(true));
        (!is_bound).then_some(ViolationKind::Unbound { start: start.0 })
    }

    fn unreachable_host(&self, start: vk::HostAddress, size: u64) -> Option<ViolationKind> {
        if !self.memory.knows_host_memory() {
            return None;
        }
        let error = self.memory.read_host(start, size).err()?;
        Some(match error.available {
            0 => ViolationKind::InvalidHostAddress { found: start.0 },
            available => ViolationKind::BeyondHostMemory { start: start.0, size, available },
        })
    }

    /// Reports an object whose memory the command cannot reach, all of it.
    ///
    /// OMM-memory-01
    pub(super) fn object(&self, at: &At<'_>, object: Object, report: &mut Report) {
        let (state, handle) = (self.state, object.1);
        let storage = match object.0 {
            vk::ObjectType::MICROMAP => state.micromap(vk::Micromap(handle)).map(|found| Storage::Buffer {
                buffer: found.buffer,
                offset: found.offset,
                size: found.size,
            }),
            _ => state.acceleration_structure(vk::AccelerationStructure(handle)).map(|found| found.storage),
        };
        let Some(storage) = storage else { return };
        let wrong = match storage {
            Storage::AddressRange(range) => self.unreachable(range.address, range.size),
            Storage::Buffer { buffer, .. } if state.liveness((vk::Buffer::OBJECT_TYPE, buffer.0)).is_invalid() => {
                Some(ViolationKind::NotBound { buffer: buffer.0 })
            }
            Storage::Buffer { buffer, offset, size } => {
                let unbound = state.sees_bindings() && state.is_bound(buffer, offset, size) == Some(false);
                unbound.then_some(ViolationKind::NotBound { buffer: buffer.0 })
            }
        };
        let hidden = || {
            let spans = state.storage_memory(storage);
            let mut types = spans.into_iter().filter_map(|span| Some(state.memory(span.memory)?.property_flags));
            let is_hidden = |flags: &Option<vk::MemoryPropertyFlags>| {
                flags.is_none_or(|flags| !flags.contains(vk::MemoryPropertyFlags::HOST_VISIBLE))
            };
            types.find(is_hidden).map(|found| ViolationKind::NotHostVisible { found: found.map(Into::into) })
        };
        let wrong = wrong.or_else(|| if self.timeline == Timeline::Host { hidden() } else { None });
        if let Some(kind) = wrong {
            report.push(RuleId::Memory01, &at.about_object(object), kind);
        }
    }
}
