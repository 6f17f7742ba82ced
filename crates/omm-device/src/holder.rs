//! What holds built objects: acceleration structures, and micromap objects of the EXT extension. Commands treat both alike.

use omm_layout::object::{Object, ObjectKind};
use omm_model::call::Timeline;
use omm_model::vk;

use crate::acceleration_structure::kind_of;
use crate::device::Device;
use crate::memory::{Origin, Place};
use crate::undefined::Reason;

/// A handle of either kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Holder {
    Structure(vk::AccelerationStructure),
    Micromap(vk::Micromap),
}

impl From<vk::AccelerationStructure> for Holder {
    fn from(handle: vk::AccelerationStructure) -> Self {
        Self::Structure(handle)
    }
}

impl From<vk::Micromap> for Holder {
    fn from(handle: vk::Micromap) -> Self {
        Self::Micromap(handle)
    }
}

impl Holder {
    /// What the handle names, in words.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Structure(_) => "acceleration structure",
            Self::Micromap(_) => "micromap",
        }
    }

    pub(crate) const fn handle(self) -> u64 {
        match self {
            Self::Structure(handle) => handle.0,
            Self::Micromap(handle) => handle.0,
        }
    }
}

/// The range of addresses of a holder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Range {
    pub(crate) address: u64,
    pub(crate) size: u64,
}

impl Device {
    /// The range that a handle stands for.
    pub(crate) fn range(&self, holder: Holder) -> Result<Range, Reason> {
        let (address, size) = match holder {
            Holder::Structure(handle) => self.structures.get(handle).map(|found| (found.address, found.size))?,
            Holder::Micromap(handle) => self.micromaps.get(handle).map(|found| (found.address, found.size))?,
        };
        Ok(Range { address: address.0, size })
    }

    /// What was built or copied into a holder, for a command of that timeline.
    pub(crate) fn object(&self, timeline: Timeline, holder: impl Into<Holder>) -> Result<Object<'_>, Reason> {
        let holder = holder.into();
        let range = self.range(holder)?;
        let bytes = self.memory.read(range.address, range.size)?;
        self.check_reach(timeline, &self.memory.place(range.address, range.size)?)?;
        Object::read(bytes).map_err(|error| Reason::NotConstructed {
            object: holder.name(),
            handle: holder.handle(),
            error: Box::new(error),
        })
    }

    /// The holder that a command writes an object of `kind` into, which takes `required` bytes.
    pub(crate) fn destination(
        &self,
        timeline: Timeline,
        holder: Holder,
        kind: ObjectKind,
        required: u64,
    ) -> Result<Range, Reason> {
        let range = self.range(holder)?;
        let (created, fully_bound) = match holder {
            Holder::Structure(handle) => {
                let found = self.structures.get(handle)?;
                (kind_of(found.ty), found.fully_bound)
            }
            Holder::Micromap(_) => (Some(ObjectKind::Micromap), false),
        };
        if let Some(found) = created.filter(|found| *found != kind) {
            return Err(Reason::CreatedAs { object: holder.name(), handle: holder.handle(), found, required: kind });
        }
        if range.size < required {
            return Err(Reason::TooSmall { required, available: range.size });
        }
        let place = self.memory.place(range.address, if fully_bound { range.size } else { required })?;
        self.check_reach(timeline, &place)?;
        Ok(range)
    }

    /// Requires the host to be able to map what a host command accesses.
    fn check_reach(&self, timeline: Timeline, place: &Place) -> Result<(), Reason> {
        let Origin::Device(memory) = place.origin else {
            return Ok(());
        };
        let ty = self.memory.memory_type_index(memory).and_then(|index| self.profile.memory_type(index));
        let visible = ty.is_some_and(|ty| ty.property_flags.contains(vk::MemoryPropertyFlags::HOST_VISIBLE));
        if timeline == Timeline::Host && !visible {
            return Err(Reason::NotHostVisible { memory: memory.0 });
        }
        Ok(())
    }

    /// Requires an address to be a structure's or a micromap's.
    pub(crate) fn check_address(&self, address: u64) -> Result<(), Reason> {
        if self.structures.has_address(address) || self.micromaps.has_address(address) {
            Ok(())
        } else {
            Err(Reason::UnknownReference { address })
        }
    }
}
