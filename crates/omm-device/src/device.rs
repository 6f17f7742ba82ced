//! The device: its objects, and the way of a call to the room that executes it.

use omm_model::call::{Call, Output};
use omm_model::memory::{MemoryError, MemoryView};
use omm_model::profile::DeviceProfile;
use omm_model::vk;

use crate::acceleration_structure::{AccelerationStructure, AccelerationStructures};
use crate::command_buffer::CommandBuffers;
use crate::deferred::Operations;
use crate::memory::{Address, Memory};
use crate::micromap::{Micromap, Micromaps};
use crate::query::QueryPools;
use crate::undefined::Undefined;

mod at_once;
mod info;
mod submit;

use info::Kept;

/// Bytes of the heap of a [`Device::new`]: 4 GiB.
pub const DEFAULT_HEAP_SIZE: u64 = 4 << 30;

/// A simulated device with its memory, objects and command buffers.
///
/// There is one device: the `device`, `queue` and `physical_device` of a call are not looked at.
#[derive(Debug)]
pub struct Device {
    pub(crate) profile: DeviceProfile,
    pub(crate) memory: Memory,
    pub(crate) structures: AccelerationStructures,
    pub(crate) micromaps: Micromaps,
    pub(crate) operations: Operations,
    pub(crate) pipelines: Kept<vk::PipelineCreateFlags2>,
    pub(crate) shaders: Kept<vk::ShaderCreateFlags>,
    pub(crate) command_buffers: CommandBuffers,
    pub(crate) queries: QueryPools,
    /// The largest handle that was ever given to an object.
    largest_handle: u64,
}

impl Device {
    /// A device without any objects and with a heap of [`DEFAULT_HEAP_SIZE`] bytes.
    #[must_use]
    pub fn new(profile: DeviceProfile) -> Self {
        Self::with_heap_size(profile, DEFAULT_HEAP_SIZE)
    }

    /// A device all of whose allocations together have at most `heap_size` bytes. Memory that nobody wrote costs nothing.
    #[must_use]
    pub fn with_heap_size(profile: DeviceProfile, heap_size: u64) -> Self {
        Self {
            profile,
            memory: Memory::new(heap_size),
            structures: AccelerationStructures::default(),
            micromaps: Micromaps::default(),
            operations: Operations::default(),
            pipelines: Kept::new("pipeline"),
            shaders: Kept::new("shader"),
            command_buffers: CommandBuffers::default(),
            queries: QueryPools::default(),
            largest_handle: 0,
        }
    }

    /// What the device is and can do.
    #[must_use]
    pub const fn profile(&self) -> &DeviceProfile {
        &self.profile
    }

    /// A handle that no object has or had: one more than the largest so far (0 once there are 2<sup>64</sup>-1).
    #[must_use]
    pub const fn unused_handle(&self) -> u64 {
        self.largest_handle.wrapping_add(1)
    }

    /// What an acceleration structure's handle stands for, if it stands for anything.
    #[must_use]
    pub fn acceleration_structure(&self, handle: vk::AccelerationStructure) -> Option<&AccelerationStructure> {
        self.structures.get(handle).ok()
    }

    /// What a micromap's handle stands for, if it stands for anything.
    #[must_use]
    pub fn micromap(&self, handle: vk::Micromap) -> Option<&Micromap> {
        self.micromaps.get(handle).ok()
    }

    /// Host memory for host commands: `size` zeros at an address of their own. `None` where it would exceed the size of the heap.
    pub fn allocate_host(&mut self, size: u64) -> Option<vk::HostAddress> {
        let limit = self.memory.heap_size();
        self.memory.host.allocate(size, limit).map(vk::HostAddress)
    }

    /// Frees host memory. Tells whether some began at that address.
    pub fn free_host(&mut self, address: vk::HostAddress) -> bool {
        self.memory.host.free(address.0)
    }

    /// Writes bytes into host memory.
    ///
    /// # Errors
    /// The range must lie in one piece of [`Device::allocate_host`]; otherwise nothing is written.
    pub fn write_host(&mut self, address: vk::HostAddress, bytes: &[u8]) -> Result<(), MemoryError> {
        self.settle();
        self.memory.write(Address::Host(address.0), bytes)
    }

    /// Writes bytes through the host's mapping of the memory, as an application uploads its data.
    ///
    /// # Errors
    /// The range must lie in one buffer that is bound to memory; otherwise nothing is written.
    pub fn write(&mut self, address: vk::DeviceAddress, bytes: &[u8]) -> Result<(), MemoryError> {
        self.settle();
        self.memory.write(address.0, bytes)
    }

    /// Executes a command: at once, or by recording it, or for `vkQueueSubmit` by executing what was recorded.
    ///
    /// # Errors
    /// [`Undefined`] if the specification leaves open what happens and the device cannot give it a meaning. The device is then
    /// as it was before the call. That a result is *not* an error does not mean that the call was valid.
    pub fn execute(&mut self, call: &Call) -> Result<Output, Undefined> {
        self.settle();
        let output = match call {
            Call::QueueSubmit { queue: _, command_buffers } => return self.submit(command_buffers),
            // What fails is the deferred command, not this one.
            Call::DeferredOperationJoin { device: _, operation } => self.join(*operation)?,
            _ => self.at_once(call).map_err(|stop| stop.of(call.command()))?,
        };
        self.settle();
        if !matches!(output, Output::Result(_)) {
            self.largest_handle = self.largest_handle.max(created(call));
        }
        Ok(output)
    }
}

impl MemoryView for Device {
    fn read(&self, address: vk::DeviceAddress, size: u64) -> Result<&[u8], MemoryError> {
        self.memory.read(address.0, size)
    }

    fn read_host(&self, address: vk::HostAddress, size: u64) -> Result<&[u8], MemoryError> {
        self.memory.read(Address::Host(address.0), size)
    }

    fn knows_host_memory(&self) -> bool {
        true
    }
}

/// The largest handle that a call gives to a new object; 0 if it creates none.
fn created(call: &Call) -> u64 {
    match call {
        Call::CreateBuffer { buffer, .. } => buffer.0,
        Call::AllocateMemory { memory, .. } => memory.0,
        Call::CreateCommandPool { command_pool, .. } => command_pool.0,
        Call::AllocateCommandBuffers { command_buffers, .. } => {
            command_buffers.iter().map(|buffer| buffer.0).max().unwrap_or(0)
        }
        Call::CreateQueryPool { query_pool, .. } => query_pool.0,
        Call::CreateDevice { device, .. } => device.0,
        Call::GetDeviceQueue { queue, .. } => queue.0,
        Call::CreateMicromap { micromap, .. } => micromap.0,
        Call::CreateDeferredOperation { deferred_operation, .. } => deferred_operation.0,
        Call::CreateRayTracingPipelines { pipelines, .. } => {
            pipelines.iter().map(|pipeline| pipeline.0).max().unwrap_or(0)
        }
        Call::CreateShaders { shaders, .. } => shaders.iter().map(|shader| shader.0).max().unwrap_or(0),
        Call::CreateAccelerationStructure { acceleration_structure, .. }
        | Call::CreateAccelerationStructure2 { acceleration_structure, .. } => acceleration_structure.0,
        _ => 0,
    }
}
