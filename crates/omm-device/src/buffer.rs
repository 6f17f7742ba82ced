//! Buffers: windows onto memory, each with its own range of device addresses.

use omm_model::call::Output;
use omm_model::vk;

use crate::memory::Memory;
use crate::undefined::{At, Reason, Stop};

mod sparse;

/// The address of the first buffer. Small numbers, which are easily mistaken for offsets, are no addresses.
pub(crate) const FIRST_ADDRESS: u64 = 0x1_0000_0000;
/// Every buffer's address is a multiple of this, and at least this many bytes behind the end of the one before it are no
/// address, so that overruns are noticed.
pub(crate) const ADDRESS_ALIGNMENT: u64 = 0x1_0000;

/// A buffer.
#[derive(Clone, Debug)]
pub(crate) struct Buffer {
    /// The address of its first byte, given at creation.
    pub(crate) address: u64,
    /// Bytes.
    pub(crate) size: u64,
    /// The memory behind it, checked when it was bound.
    pub(crate) binding: Option<Binding>,
    /// Whether it can be bound in parts, and has an address before it is bound.
    pub(crate) sparse: bool,
}

/// The part of a buffer that is bound, and the memory behind it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Binding {
    /// Where the part begins in the buffer: 0 unless the buffer is sparse.
    pub(crate) start: u64,
    /// Bytes of the part.
    pub(crate) size: u64,
    /// The memory; null once it was freed.
    pub(crate) memory: vk::DeviceMemory,
    /// Where the part begins in the memory.
    pub(crate) memory_offset: u64,
}

impl Memory {
    /// The buffer of that handle.
    pub(crate) fn buffer(&self, buffer: vk::Buffer) -> Result<&Buffer, Reason> {
        self.buffers.get(&buffer).ok_or(Reason::UnknownHandle { object: "buffer", handle: buffer.0 })
    }

    /// `vkCreateBuffer`. The address depends on nothing but the buffers created before.
    pub(crate) fn create_buffer(&mut self, info: &vk::BufferCreateInfo, buffer: vk::Buffer) -> Result<Output, Stop> {
        if buffer.is_null() || self.buffers.contains_key(&buffer) {
            return Err(Reason::HandleTaken { object: "buffer", handle: buffer.0 }).at("pBuffer");
        }
        if info.flags.contains(vk::BufferCreateFlags::SPARSE_RESIDENCY) {
            return Err(Reason::Unsupported { what: "buffers that are used while parts of them are not bound" })
                .at("pCreateInfo->flags");
        }
        let address = self.next_address;
        let end = address.checked_add(info.size).and_then(|end| end.checked_add(ADDRESS_ALIGNMENT));
        let next = end.and_then(|end| end.checked_next_multiple_of(ADDRESS_ALIGNMENT));
        let Some(next) = next.filter(|_| info.size <= self.heap_size()) else {
            return Ok(Output::Result(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY));
        };
        let sparse = info.flags.contains(vk::BufferCreateFlags::SPARSE_BINDING);
        self.next_address = next;
        self.by_address.insert(address, buffer);
        self.buffers.insert(buffer, Buffer { address, size: info.size, binding: None, sparse });
        Ok(Output::None)
    }

    /// `vkDestroyBuffer`. Its addresses are never used again.
    pub(crate) fn destroy_buffer(&mut self, buffer: vk::Buffer) -> Result<Output, Stop> {
        if !buffer.is_null() {
            let address = self.buffer(buffer).at("buffer")?.address;
            self.by_address.remove(&address);
            self.buffers.remove(&buffer);
        }
        Ok(Output::None)
    }

    /// `vkBindBufferMemory`.
    pub(crate) fn bind_buffer(
        &mut self,
        buffer: vk::Buffer,
        memory: vk::DeviceMemory,
        offset: u64,
    ) -> Result<Output, Stop> {
        let found = self.buffer(buffer).at("buffer")?;
        if found.binding.is_some() {
            return Err(Reason::AlreadyBound { buffer: buffer.0 }).at("buffer");
        }
        let limit = self.allocation_size(memory).at("memory")?;
        let size = found.size;
        if offset.checked_add(size).is_none_or(|end| end > limit) {
            return Err(Reason::OutsideObject { offset, size, limit }).at("memoryOffset");
        }
        if let Some(found) = self.buffers.get_mut(&buffer) {
            found.binding = Some(Binding { start: 0, size, memory, memory_offset: offset });
        }
        Ok(Output::None)
    }

    /// `vkGetBufferDeviceAddress`.
    pub(crate) fn buffer_address(&self, buffer: vk::Buffer) -> Result<Output, Stop> {
        let found = self.buffer(buffer).at("pInfo->buffer")?;
        if found.binding.is_none() && !found.sparse {
            return Err(Reason::NotBound { buffer: buffer.0 }).at("pInfo->buffer");
        }
        Ok(Output::DeviceAddress(vk::DeviceAddress(found.address)))
    }

    /// The first address of a range of a buffer, bound or not.
    pub(crate) fn address_in(&self, buffer: vk::Buffer, offset: u64, size: u64) -> Result<u64, Reason> {
        let found = self.buffer(buffer)?;
        let end = offset.checked_add(size);
        if end.is_none_or(|end| end > found.size) {
            return Err(Reason::OutsideObject { offset, size, limit: found.size });
        }
        // The buffer's end was an address when it was created.
        Ok(found.address.saturating_add(offset))
    }
}
