//! Buffers with memory of their own.

use omm_model::call::{Call, Output};
use omm_model::vk;

use super::{Cost, DEVICE, QUEUE, World};
use crate::error::Mistake;
use crate::node::Node;
use crate::objects::{Object, Range};

/// How a buffer is made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BufferRequest<'a> {
    pub(crate) name: &'a str,
    pub(crate) size: u64,
    pub(crate) usage: vk::BufferUsageFlags,
    pub(crate) flags: vk::BufferCreateFlags,
    /// The type of its memory; `None` for one that host and device can use.
    pub(crate) memory_type: Option<u32>,
    /// Whether it is bound to memory.
    pub(crate) bound: bool,
}

impl<'a> BufferRequest<'a> {
    /// An ordinary buffer, bound to memory that host and device can use.
    pub(crate) const fn new(name: &'a str, size: u64, usage: vk::BufferUsageFlags) -> Self {
        Self { name, size, usage, flags: vk::BufferCreateFlags::empty(), memory_type: None, bound: true }
    }
}

/// Where the made-up addresses of buffers begin that the device does not simulate, far above its own.
const NOT_SIMULATED: u64 = 1 << 62;

/// Uses of a buffer that holds input of builds.
pub(crate) const INPUT: vk::BufferUsageFlags = vk::BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY
    .union(vk::BufferUsageFlags::MICROMAP_BUILD_INPUT_READ_ONLY)
    .union(vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS);

impl World {
    /// A buffer of at least one byte.
    pub(crate) fn make_buffer(&mut self, request: &BufferRequest<'_>, node: &Node) -> Result<Range, Mistake> {
        let buffer = vk::Buffer(self.handle());
        let size = request.size.max(1);
        let create_info =
            vk::BufferCreateInfo { size, usage: request.usage, flags: request.flags, ..Default::default() };
        self.prepare(&Call::CreateBuffer { device: DEVICE, create_info, buffer }, node)?;
        let is_simulated = self.group.calls.last().is_some_and(|call| call.output.is_some());
        let (mut handles, mut address) = (vec![("Buffer", buffer.0)], 0);
        if request.bound {
            let memory = self.allocate(request, size, node)?;
            handles.push(("DeviceMemory", memory.0));
            let bind = binding(request.flags, buffer, memory, size);
            let info = vk::BufferDeviceAddressInfo { buffer, ..Default::default() };
            let ask = Call::GetBufferDeviceAddress { device: DEVICE, info };
            let has_address = request.usage.contains(vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS);
            if is_simulated {
                self.prepare(&bind, node)?;
                if has_address && let Output::DeviceAddress(found) = self.prepare(&ask, node)? {
                    address = found.0;
                }
            } else {
                self.tell(&bind, &Output::None);
                if has_address {
                    address = NOT_SIMULATED | buffer.0 << 32;
                    self.tell(&ask, &Output::DeviceAddress(vk::DeviceAddress(address)));
                }
            }
        }
        let range = Range { address, size, host: false };
        let place = (address != 0).then_some(range);
        self.objects.insert(Object { name: request.name.to_owned(), handles, place });
        Ok(range)
    }

    /// Memory for a buffer.
    fn allocate(&mut self, request: &BufferRequest<'_>, size: u64, node: &Node) -> Result<vk::DeviceMemory, Mistake> {
        let memory = vk::DeviceMemory(self.handle());
        let both = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        let memory_type_index = request.memory_type.or_else(|| self.profile().find_memory_type(both)).unwrap_or(0);
        let flags = vk::MemoryAllocateFlags::DEVICE_ADDRESS;
        let next = vec![vk::MemoryAllocateFlagsInfo { flags, ..Default::default() }.into()];
        let allocate_info =
            vk::MemoryAllocateInfo { next, allocation_size: size, memory_type_index, ..Default::default() };
        self.prepare(&Call::AllocateMemory { device: DEVICE, allocate_info, memory }, node)?;
        Ok(memory)
    }

    /// Items of one size so many bytes apart. Bytes between them are no zeros, so that reading them shows.
    pub(crate) fn spread<T: AsRef<[u8]>>(&self, items: &[T], stride: u64, node: &Node) -> Result<Vec<u8>, Mistake> {
        let size = items.first().map_or(0, |item| item.as_ref().len() as u64);
        let last = (items.len() as u64).saturating_sub(1);
        let total = last.saturating_mul(stride).saturating_add(size);
        self.afford(Cost::Bytes, total, node)?;
        let mut out = vec![0xee; total as usize];
        for (index, item) in items.iter().enumerate() {
            let (start, item) = (index * stride as usize, item.as_ref());
            if let Some(target) = out.get_mut(start..start + item.len()) {
                target.copy_from_slice(item);
            }
        }
        Ok(out)
    }

    /// A buffer that holds input of builds. Zeros follow up to a multiple of 256 bytes, so that a stride that is a little too
    /// large breaks the rule on strides and none on the ends of buffers.
    pub(crate) fn upload(&mut self, name: &str, bytes: &[u8], node: &Node) -> Result<vk::DeviceAddress, Mistake> {
        self.spend(Cost::Bytes, bytes.len() as u64, node)?;
        let size = (bytes.len() as u64).max(1).next_multiple_of(256);
        let request = BufferRequest::new(name, size, INPUT);
        let address = vk::DeviceAddress(self.make_buffer(&request, node)?.address);
        let written = self.write_mapped(address, bytes);
        written.map_err(|error| node.mistake(format!("this cannot be uploaded: {error}")))?;
        Ok(address)
    }
}

/// The call that binds all of a buffer.
fn binding(flags: vk::BufferCreateFlags, buffer: vk::Buffer, memory: vk::DeviceMemory, size: u64) -> Call {
    if flags.contains(vk::BufferCreateFlags::SPARSE_BINDING) {
        let binds = vec![vk::SparseMemoryBind { size, memory, ..Default::default() }];
        Call::QueueBindSparse { queue: QUEUE, buffer_binds: vec![vk::SparseBufferMemoryBindInfo { buffer, binds }] }
    } else {
        Call::BindBufferMemory { device: DEVICE, buffer, memory, memory_offset: 0 }
    }
}
