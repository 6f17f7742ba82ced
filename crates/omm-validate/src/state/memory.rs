//! Buffers and the memory behind them.

use std::sync::Arc;

use omm_model::vk;

use super::{Liveness, State, Storage};

/// A buffer.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct BufferState {
    /// Bytes in it.
    pub size: u64,
    /// How it was made.
    pub flags: vk::BufferCreateFlags,
    /// What it is used for.
    pub usage: vk::BufferUsageFlags,
    /// The memory that all of it is bound to, and the offset of its first byte there.
    pub memory: Option<(vk::DeviceMemory, u64)>,
    /// For a sparse buffer: the bound ranges, not overlapping.
    pub bindings: Vec<Binding>,
    /// Its address, once it was asked for.
    pub address: Option<vk::DeviceAddress>,
}

/// A range of a buffer bound to memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Binding {
    /// First byte of the buffer.
    pub offset: u64,
    /// Bytes.
    pub size: u64,
    /// The memory.
    pub memory: vk::DeviceMemory,
    /// First byte of the memory.
    pub memory_offset: u64,
}

/// A memory allocation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct MemoryState {
    /// Bytes in it.
    pub size: u64,
    /// What its type can do; `None` if the profile has no such type.
    pub property_flags: Option<vk::MemoryPropertyFlags>,
    /// On how many physical devices it has an instance.
    pub instances: usize,
}

/// A range of a memory allocation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MemorySpan {
    /// The allocation.
    pub memory: vk::DeviceMemory,
    /// First byte.
    pub offset: u64,
    /// Bytes.
    pub size: u64,
}

impl MemorySpan {
    /// Whether the two have a byte in common.
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        let end = |span: &Self| u128::from(span.offset) + u128::from(span.size);
        self.memory == other.memory && u128::from(self.offset.max(other.offset)) < end(self).min(end(other))
    }
}

impl BufferState {
    /// Binds a range, or unbinds it where the memory is null.
    fn bind(&mut self, new: Binding) {
        let new_end = new.offset.saturating_add(new.size);
        let mut bindings = Vec::with_capacity(self.bindings.len().saturating_add(1));
        for old in self.bindings.drain(..) {
            let old_end = old.offset.saturating_add(old.size);
            for (start, end) in [(old.offset, old_end.min(new.offset)), (old.offset.max(new_end), old_end)] {
                if start < end {
                    let memory_offset = old.memory_offset.saturating_add(start - old.offset);
                    bindings.push(Binding { offset: start, size: end - start, memory: old.memory, memory_offset });
                }
            }
        }
        if !new.memory.is_null() && new.size > 0 {
            bindings.push(new);
        }
        self.bindings = bindings;
    }

    /// The memory behind a range, as far as there is any.
    fn spans(&self, offset: u64, size: u64) -> impl Iterator<Item = MemorySpan> {
        let end = offset.saturating_add(size);
        let all =
            self.memory.map(|(memory, memory_offset)| Binding { offset: 0, size: self.size, memory, memory_offset });
        all.into_iter().chain(self.bindings.iter().copied()).filter_map(move |binding| {
            let start = offset.max(binding.offset);
            let end = end.min(binding.offset.saturating_add(binding.size));
            let size = end.checked_sub(start).filter(|size| *size > 0)?;
            let offset = binding.memory_offset.checked_add(start - binding.offset)?;
            Some(MemorySpan { memory: binding.memory, offset, size })
        })
    }
}

impl State {
    /// Whether the address of any buffer was ever told. If not, calls that ask for addresses are probably not shown to the validator,
    /// and nothing can be said about an address.
    #[must_use]
    pub fn knows_addresses(&self) -> bool {
        self.sees_addresses
    }

    /// The buffers that an address lies in, each with the offset of the address and the bytes from there on. Only buffers whose
    /// address was asked for are known by address.
    pub fn buffers_at(&self, address: vk::DeviceAddress) -> impl Iterator<Item = (vk::Buffer, &BufferState, u64, u64)> {
        let lowest = vk::DeviceAddress(address.0.saturating_sub(self.largest_buffer));
        let candidates = self.addresses.range((lowest, vk::Buffer(0))..=(address, vk::Buffer(u64::MAX)));
        candidates.filter_map(move |((start, buffer), size)| {
            let offset = address.0.checked_sub(start.0)?;
            let available = size.checked_sub(offset).filter(|available| *available > 0)?;
            Some((*buffer, self.buffer(*buffer)?, offset, available))
        })
    }

    /// The buffers that all of a range lies in.
    pub fn buffers_around(&self, range: vk::DeviceAddressRange) -> impl Iterator<Item = (vk::Buffer, &BufferState)> {
        let around = self.buffers_at(range.address).filter(move |(_, _, _, available)| range.size <= *available);
        around.map(|(handle, buffer, _, _)| (handle, buffer))
    }

    /// Bytes from `address` to the end of the buffer that it lies in, of the one that reaches farthest where buffers share
    /// memory; `None` if it lies in no buffer whose address is known.
    #[must_use]
    pub fn bytes_from(&self, address: vk::DeviceAddress) -> Option<u64> {
        self.buffers_at(address).map(|(_, _, _, available)| available).max()
    }

    /// The memory behind a range of a buffer: as far as it is bound, and the memory lives.
    pub fn buffer_memory(&self, buffer: vk::Buffer, offset: u64, size: u64) -> impl Iterator<Item = MemorySpan> {
        let spans = self.buffer(buffer).into_iter().flat_map(move |buffer| buffer.spans(offset, size));
        spans.filter(|span| self.liveness((vk::DeviceMemory::OBJECT_TYPE, span.memory.0)) != Liveness::Destroyed)
    }

    /// Whether memory is bound to all of a range of a buffer, as far as the buffer reaches; `None` if the buffer is not known.
    #[must_use]
    pub fn is_bound(&self, buffer: vk::Buffer, offset: u64, size: u64) -> Option<bool> {
        let wanted = size.min(self.buffer(buffer)?.size.saturating_sub(offset));
        let bound = self.buffer_memory(buffer, offset, wanted).fold(0_u64, |sum, span| sum.saturating_add(span.size));
        Some(bound >= wanted && self.buffer_memory(buffer, 0, u64::MAX).next().is_some())
    }

    /// Whether any part of a buffer is or was bound, so that binding is among the calls that are seen.
    #[must_use]
    pub fn was_bound(&self, buffer: vk::Buffer) -> bool {
        self.buffer(buffer).is_some_and(|buffer| buffer.memory.is_some() || !buffer.bindings.is_empty())
    }

    /// The memory behind a range of addresses, through every buffer that it begins in.
    pub fn memory_behind(&self, range: vk::DeviceAddressRange) -> impl Iterator<Item = MemorySpan> {
        self.buffers_at(range.address).flat_map(move |(buffer, _, offset, available)| {
            self.buffer_memory(buffer, offset, range.size.min(available))
        })
    }

    /// The memory that an acceleration structure lies in, as far as it is known.
    pub fn structure_memory(&self, handle: vk::AccelerationStructure) -> impl Iterator<Item = MemorySpan> {
        let (in_buffer, behind) = match self.acceleration_structure(handle).map(|structure| structure.storage) {
            Some(Storage::Buffer { buffer, offset, size }) => (Some(self.buffer_memory(buffer, offset, size)), None),
            Some(Storage::AddressRange(range)) => (None, Some(self.memory_behind(range))),
            None => (None, None),
        };
        in_buffer.into_iter().flatten().chain(behind.into_iter().flatten())
    }

    /// The buffers that are bound to any byte of a span of memory.
    pub fn buffers_on(&self, span: MemorySpan) -> impl Iterator<Item = (vk::Buffer, &BufferState)> {
        self.buffers
            .iter()
            .filter(move |(_, buffer)| buffer.spans(0, buffer.size).any(|other| other.overlaps(&span)))
            .map(|(handle, buffer)| (*handle, buffer))
    }

    pub(super) fn create_buffer(&mut self, create_info: &vk::BufferCreateInfo, buffer: vk::Buffer) {
        self.destroy_buffer(buffer);
        let vk::BufferCreateInfo { size, usage, flags, .. } = *create_info;
        let new = BufferState { size, usage, flags, memory: None, bindings: Vec::new(), address: None };
        Arc::make_mut(&mut self.buffers).insert(buffer, new);
    }

    pub(super) fn destroy_buffer(&mut self, buffer: vk::Buffer) {
        if let Some(BufferState { address: Some(address), .. }) = Arc::make_mut(&mut self.buffers).remove(&buffer) {
            Arc::make_mut(&mut self.addresses).remove(&(address, buffer));
        }
    }

    pub(super) fn set_buffer_address(&mut self, buffer: vk::Buffer, address: vk::DeviceAddress) {
        self.sees_addresses = true;
        let Some(state) = Arc::make_mut(&mut self.buffers).get_mut(&buffer) else { return };
        if let Some(old) = state.address.replace(address) {
            Arc::make_mut(&mut self.addresses).remove(&(old, buffer));
        }
        Arc::make_mut(&mut self.addresses).insert((address, buffer), state.size);
        self.largest_buffer = self.largest_buffer.max(state.size);
    }

    /// What lay in a buffer lies elsewhere, or nowhere, once it is bound anew.
    fn rebound(&mut self, buffer: vk::Buffer) {
        let spans: Vec<_> = self.buffer_memory(buffer, 0, u64::MAX).collect();
        self.overwritten(&spans, None);
    }

    pub(super) fn bind_sparse(&mut self, infos: &[vk::SparseBufferMemoryBindInfo]) {
        self.sees_bindings = true;
        for info in infos {
            self.rebound(info.buffer);
            let Some(buffer) = Arc::make_mut(&mut self.buffers).get_mut(&info.buffer) else { continue };
            for bind in &info.binds {
                let vk::SparseMemoryBind { resource_offset, size, memory, memory_offset, .. } = *bind;
                buffer.bind(Binding { offset: resource_offset, size, memory, memory_offset });
            }
        }
    }

    pub(super) fn allocate_memory(
        &mut self,
        device: vk::Device,
        info: &vk::MemoryAllocateInfo,
        memory: vk::DeviceMemory,
    ) {
        let physical_devices = self.physical_devices(device);
        let heap = self.profile.memory_heap_of_type(info.memory_type_index);
        let shared = heap.is_some_and(|heap| heap.flags.contains(vk::MemoryHeapFlags::MULTI_INSTANCE));
        let masked = info.allocate_flags().filter(|it| it.flags.contains(vk::MemoryAllocateFlags::DEVICE_MASK));
        let instances = match masked {
            _ if physical_devices <= 1 || !shared => 1,
            Some(masked) => usize::try_from(masked.device_mask.count_ones()).unwrap_or(usize::MAX),
            None => physical_devices,
        };
        let property_flags = self.profile.memory_type(info.memory_type_index).map(|ty| ty.property_flags);
        let new = MemoryState { size: info.allocation_size, property_flags, instances };
        Arc::make_mut(&mut self.memories).insert(memory, new);
    }
}
