//! Reading memory at an address: the one interface that validator, tracer and tools share.

use crate::vk::{DeviceAddress, DeviceOrHostAddress, HostAddress};

/// A view of the memory behind device addresses and, where the implementor offers it, host addresses.
///
/// The simulated device implements it over its buffers; an engine implements it over mapped memory, or does without it
/// ([`NoMemory`]) and forgoes the checks that look at contents.
pub trait MemoryView {
    /// The `size` bytes from `address` on, which must lie within one range of memory that the view knows.
    ///
    /// # Errors
    /// [`MemoryError`] says how much is readable at `address`. A view never allocates because of `size`.
    fn read(&self, address: DeviceAddress, size: u64) -> Result<&[u8], MemoryError>;

    /// The `size` bytes of host memory from `address` on, likewise; host commands take their data there.
    ///
    /// A view that implements this implements [`knows_host_memory`](Self::knows_host_memory) too.
    ///
    /// # Errors
    /// [`MemoryError`] says how much is readable at `address`; nothing is unless the view implements this.
    fn read_host(&self, address: HostAddress, size: u64) -> Result<&[u8], MemoryError> {
        Err(MemoryError { address: address.0, size, available: 0 })
    }

    /// Whether the view knows host memory, so that what [`read_host`](Self::read_host) cannot read is not there.
    ///
    /// Without this, an error of `read_host` says nothing about the application.
    fn knows_host_memory(&self) -> bool {
        false
    }

    /// The `size` bytes from `address` on, in whichever memory it lies.
    ///
    /// # Errors
    /// As [`read`](Self::read) and [`read_host`](Self::read_host).
    fn read_either(&self, address: DeviceOrHostAddress, size: u64) -> Result<&[u8], MemoryError> {
        match address {
            DeviceOrHostAddress::DeviceAddress(address) => self.read(address, size),
            DeviceOrHostAddress::HostAddress(address) => self.read_host(address, size),
        }
    }
}

/// Memory that cannot be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{size} bytes from address {address:#x} are wanted, but {available} are readable there")]
pub struct MemoryError {
    /// The first address wanted.
    pub address: u64,
    /// The bytes wanted.
    pub size: u64,
    /// The bytes readable from `address` on; 0 if it lies in no known range.
    pub available: u64,
}

/// The view that can read nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoMemory;

impl MemoryView for NoMemory {
    fn read(&self, address: DeviceAddress, size: u64) -> Result<&[u8], MemoryError> {
        Err(MemoryError { address: address.0, size, available: 0 })
    }
}

/// One range of device memory: some bytes and the address of the first.
#[derive(Clone, Copy, Debug)]
pub struct MemoryRange<'a> {
    /// Address of the first byte.
    pub address: DeviceAddress,
    /// The bytes.
    pub bytes: &'a [u8],
}

impl MemoryView for MemoryRange<'_> {
    fn read(&self, address: DeviceAddress, size: u64) -> Result<&[u8], MemoryError> {
        part(self.bytes, self.address.0, address.0, size)
    }
}

/// A view with one range of host memory beside the device memory of another view.
#[derive(Clone, Copy, Debug)]
pub struct WithHostMemory<'a, V> {
    /// The view of device memory.
    pub device: V,
    /// Address of the first byte of host memory.
    pub address: HostAddress,
    /// The bytes there.
    pub bytes: &'a [u8],
}

impl<V: MemoryView> MemoryView for WithHostMemory<'_, V> {
    fn read(&self, address: DeviceAddress, size: u64) -> Result<&[u8], MemoryError> {
        self.device.read(address, size)
    }

    fn read_host(&self, address: HostAddress, size: u64) -> Result<&[u8], MemoryError> {
        part(self.bytes, self.address.0, address.0, size)
    }

    fn knows_host_memory(&self) -> bool {
        true
    }
}

/// The part of `bytes`, which begin at address `first`, that is `size` bytes long and begins at `address`.
fn part(bytes: &[u8], first: u64, address: u64, size: u64) -> Result<&[u8], MemoryError> {
    let start = address.checked_sub(first).and_then(|start| usize::try_from(start).ok());
    let rest = start.and_then(|start| bytes.get(start..)).unwrap_or_default();
    let wanted = usize::try_from(size).ok().and_then(|size| rest.get(..size));
    wanted.ok_or(MemoryError { address, size, available: rest.len() as u64 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_reads_what_it_holds() {
        let view = MemoryRange { address: DeviceAddress(0x100), bytes: &[1, 2, 3] };
        assert_eq!(view.read(DeviceAddress(0x101), 2), Ok(&[2, 3][..]));
        assert_eq!(view.read(DeviceAddress(0x103), 0), Ok(&[][..]));
        let error = |address, size, available| Err(MemoryError { address, size, available });
        assert_eq!(view.read(DeviceAddress(0x101), 3), error(0x101, 3, 2));
        assert_eq!(view.read(DeviceAddress(0xff), 1), error(0xff, 1, 0));
        assert_eq!(view.read(DeviceAddress(u64::MAX), u64::MAX), error(u64::MAX, u64::MAX, 0));
        assert_eq!(NoMemory.read(DeviceAddress(1), 0), error(1, 0, 0));
    }

    #[test]
    fn host_memory_is_read_where_it_is_known() {
        let device = MemoryRange { address: DeviceAddress(0x100), bytes: &[1, 2, 3] };
        let view = WithHostMemory { device, address: HostAddress(0x100), bytes: &[7, 8] };
        assert_eq!(view.read_either(DeviceAddress(0x101).into(), 2), Ok(&[2, 3][..]));
        assert_eq!(view.read_either(HostAddress(0x101).into(), 1), Ok(&[8][..]));
        let error = |address, size, available| Err(MemoryError { address, size, available });
        assert_eq!(view.read_host(HostAddress(0x101), 2), error(0x101, 2, 1));
        assert!(view.knows_host_memory() && !device.knows_host_memory());
        assert_eq!(device.read_host(HostAddress(0x100), 1), error(0x100, 1, 0));
    }
}
