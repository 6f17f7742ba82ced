//! Addresses and the bytes behind them.

use std::ops::Range;

use omm_model::call::Timeline;
use omm_model::vk;

use crate::undefined::Reason;

/// An address in one of the two memories.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Address {
    /// In a buffer.
    Device(u64),
    /// In memory of the application.
    Host(u64),
}

impl Address {
    /// The address that a union holds, which must lie in the memory that commands of that timeline use.
    pub(crate) fn of(timeline: Timeline, address: vk::DeviceOrHostAddress) -> Result<Self, Reason> {
        match (timeline, address) {
            (Timeline::Device, vk::DeviceOrHostAddress::DeviceAddress(address)) => Ok(Self::Device(address.0)),
            (Timeline::Host, vk::DeviceOrHostAddress::HostAddress(address)) => Ok(Self::Host(address.0)),
            (Timeline::Device, other) => Err(Reason::HostAddress { address: other.raw() }),
            (Timeline::Host, other) => Err(Reason::DeviceAddress { address: other.raw() }),
        }
    }

    /// The same kind of address with another number.
    pub(crate) const fn same(self, address: u64) -> Self {
        match self {
            Self::Device(_) => Self::Device(address),
            Self::Host(_) => Self::Host(address),
        }
    }

    /// The number.
    pub(crate) const fn raw(self) -> u64 {
        match self {
            Self::Device(address) | Self::Host(address) => address,
        }
    }
}

impl From<u64> for Address {
    fn from(address: u64) -> Self {
        Self::Device(address)
    }
}

/// The address so many bytes behind another.
pub(crate) fn add(address: Address, offset: u64) -> Result<Address, Reason> {
    let sum = address.raw().checked_add(offset);
    Ok(address.same(sum.ok_or(Reason::AddressOverflow { address: address.raw(), offset })?))
}

/// What a place is a part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Origin {
    /// An allocation on the device.
    Device(vk::DeviceMemory),
    /// The host memory that begins at that address.
    Host(u64),
}

/// A range of an allocation: two ranges of addresses that share bytes share a place, even if they belong to different buffers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    pub(crate) origin: Origin,
    pub(crate) bytes: Range<usize>,
}

impl Place {
    /// Whether the two have a byte in common.
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        let (a, b) = (&self.bytes, &other.bytes);
        self.origin == other.origin && a.start.max(b.start) < a.end.min(b.end)
    }
}
