//! Memory and the address space: allocations are bytes, buffers are windows onto them at device addresses.

use std::collections::BTreeMap;

use omm_model::call::Output;
use omm_model::memory::MemoryError;
use omm_model::vk;

use crate::buffer::Buffer;
use crate::undefined::{At, Reason, Stop};

mod address;
mod host;

pub(crate) use address::{Address, Origin, Place, add};
use host::HostMemory;

/// All memory of a device and all buffers that look onto it, and the host memory that the application shows to the device.
#[derive(Debug)]
pub(crate) struct Memory {
    /// Bytes that all allocations together can have.
    heap_size: u64,
    allocations: BTreeMap<vk::DeviceMemory, Allocation>,
    pub(crate) host: HostMemory,
    pub(crate) buffers: BTreeMap<vk::Buffer, Buffer>,
    /// The buffer at each base address.
    pub(crate) by_address: BTreeMap<u64, vk::Buffer>,
    /// Where the next buffer goes.
    pub(crate) next_address: u64,
    /// What was overwritten since [`Memory::begin`], oldest first.
    journal: Option<Vec<(Place, Vec<u8>)>>,
}

/// Memory that was allocated on the device.
#[derive(Debug)]
struct Allocation {
    bytes: Vec<u8>,
    memory_type_index: u32,
}

impl Memory {
    pub(crate) fn new(heap_size: u64) -> Self {
        Self {
            heap_size,
            allocations: BTreeMap::new(),
            host: HostMemory::default(),
            buffers: BTreeMap::new(),
            by_address: BTreeMap::new(),
            next_address: crate::buffer::FIRST_ADDRESS,
            journal: None,
        }
    }

    /// Bytes that all allocations together can have.
    pub(crate) const fn heap_size(&self) -> u64 {
        self.heap_size
    }

    /// `vkAllocateMemory`: zeros, which the operating system need not provide before they are touched.
    pub(crate) fn allocate(&mut self, info: &vk::MemoryAllocateInfo, memory: vk::DeviceMemory) -> Result<Output, Stop> {
        if memory.is_null() || self.allocations.contains_key(&memory) {
            return Err(Reason::HandleTaken { object: "memory", handle: memory.0 }).at("pMemory");
        }
        let used: u64 = self.allocations.values().map(|found| found.bytes.len() as u64).sum();
        let free = self.heap_size.saturating_sub(used);
        let Some(bytes) = Some(info.allocation_size).filter(|&size| size <= free).and_then(zeros) else {
            return Ok(Output::Result(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY));
        };
        let new = Allocation { bytes, memory_type_index: info.memory_type_index };
        self.allocations.insert(memory, new);
        Ok(Output::None)
    }

    /// `vkFreeMemory`. Buffers bound to it stay and can no longer be accessed.
    pub(crate) fn free(&mut self, memory: vk::DeviceMemory) -> Result<Output, Stop> {
        if !memory.is_null() && self.allocations.remove(&memory).is_none() {
            return Err(Reason::UnknownHandle { object: "memory", handle: memory.0 }).at("memory");
        }
        // They are not to come back to life with an allocation that gets the same handle.
        for binding in self.buffers.values_mut().filter_map(|buffer| buffer.binding.as_mut()) {
            if binding.memory == memory {
                binding.memory = vk::DeviceMemory::NULL;
            }
        }
        Ok(Output::None)
    }

    /// Bytes of an allocation.
    pub(crate) fn allocation_size(&self, memory: vk::DeviceMemory) -> Result<u64, Reason> {
        let unknown = Reason::UnknownHandle { object: "memory", handle: memory.0 };
        Ok(self.allocations.get(&memory).ok_or(unknown)?.bytes.len() as u64)
    }

    /// The memory type that an allocation was taken from.
    pub(crate) fn memory_type_index(&self, memory: vk::DeviceMemory) -> Option<u32> {
        self.allocations.get(&memory).map(|found| found.memory_type_index)
    }

    /// The place behind a range of addresses, which must lie in one buffer that is bound to memory, or in one piece of host
    /// memory.
    pub(crate) fn place(&self, address: impl Into<Address>, size: u64) -> Result<Place, MemoryError> {
        match address.into() {
            Address::Device(address) => self.device_place(address, size),
            Address::Host(address) => self.host.place(address, size),
        }
    }

    fn device_place(&self, address: u64, size: u64) -> Result<Place, MemoryError> {
        let unknown = MemoryError { address, size, available: 0 };
        let (base, buffer) = self.by_address.range(..=address).next_back().ok_or(unknown)?;
        let buffer = self.buffers.get(buffer).ok_or(unknown)?;
        let binding = buffer.binding.ok_or(unknown)?;
        if !self.allocations.contains_key(&binding.memory) {
            return Err(unknown);
        }
        let offset = (address - base).checked_sub(binding.start).ok_or(unknown)?;
        let available = binding.size.checked_sub(offset).ok_or(unknown)?;
        if size > available {
            return Err(MemoryError { address, size, available });
        }
        // The binding was checked against the allocation, so all of this fits.
        let start = binding.memory_offset.checked_add(offset).ok_or(unknown)?;
        let end = start.checked_add(size).ok_or(unknown)?;
        let start = usize::try_from(start).map_err(|_| unknown)?;
        let end = usize::try_from(end).map_err(|_| unknown)?;
        Ok(Place { origin: Origin::Device(binding.memory), bytes: start..end })
    }

    /// Requires a range of addresses to lie in one buffer, bound to memory or not.
    pub(crate) fn in_buffer(&self, address: u64, size: u64) -> Result<(), MemoryError> {
        let unknown = MemoryError { address, size, available: 0 };
        let (base, buffer) = self.by_address.range(..=address).next_back().ok_or(unknown)?;
        let limit = self.buffers.get(buffer).ok_or(unknown)?.size;
        let available = limit.checked_sub(address - base).filter(|available| *available > 0).ok_or(unknown)?;
        if size <= available { Ok(()) } else { Err(MemoryError { available, ..unknown }) }
    }

    pub(crate) fn read(&self, address: impl Into<Address>, size: u64) -> Result<&[u8], MemoryError> {
        let address = address.into();
        let place = self.place(address, size)?;
        let all = match place.origin {
            Origin::Device(memory) => self.allocations.get(&memory).map(|found| found.bytes.as_slice()),
            Origin::Host(base) => self.host.bytes(base),
        };
        all.and_then(|all| all.get(place.bytes)).ok_or(MemoryError { address: address.raw(), size, available: 0 })
    }

    /// The bytes of a place.
    fn target(&mut self, place: &Place) -> Option<&mut [u8]> {
        let all = match place.origin {
            Origin::Device(memory) => self.allocations.get_mut(&memory).map(|found| found.bytes.as_mut_slice()),
            Origin::Host(base) => self.host.bytes_mut(base),
        };
        all?.get_mut(place.bytes.clone())
    }

    pub(crate) fn write(&mut self, address: impl Into<Address>, bytes: &[u8]) -> Result<(), MemoryError> {
        let (address, size) = (address.into(), bytes.len() as u64);
        let place = self.place(address, size)?;
        let target = self.target(&place).ok_or(MemoryError { address: address.raw(), size, available: 0 })?;
        let old = target.to_vec();
        target.copy_from_slice(bytes);
        if let Some(journal) = &mut self.journal {
            journal.push((place, old));
        }
        Ok(())
    }

    /// From here on, remembers what is overwritten.
    pub(crate) fn begin(&mut self) {
        self.journal = Some(Vec::new());
    }

    /// Keeps what was written since [`Memory::begin`].
    pub(crate) fn commit(&mut self) {
        self.journal = None;
    }

    /// Restores what was overwritten since [`Memory::begin`].
    pub(crate) fn roll_back(&mut self) {
        for (place, old) in self.journal.take().into_iter().flatten().rev() {
            if let Some(target) = self.target(&place) {
                target.copy_from_slice(&old);
            }
        }
    }
}

/// So many zeros, or `None` where the machine has not got them.
pub(crate) fn zeros(size: u64) -> Option<Vec<u8>> {
    let size = usize::try_from(size).ok()?;
    // The question comes before the real allocation because that one, which costs nothing until touched, ends the program if
    // it fails.
    Vec::<u8>::new().try_reserve_exact(size).ok()?;
    Some(vec![0; size])
}

#[cfg(test)]
mod tests;
