//! What calls leave behind, seen through the questions that rules ask.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod devices;
mod execution;
mod memory;
mod queries;

use omm_model::call::{Call, Output};
use omm_model::profile::DeviceProfile;
use omm_model::vk;
use omm_validate::Validator;
use omm_validate::state::State;

pub(crate) const DEVICE: vk::Device = vk::Device(1);
pub(crate) const QUEUE: vk::Queue = vk::Queue(2);
pub(crate) const BUFFER: vk::Buffer = vk::Buffer(3);
pub(crate) const MEMORY: vk::DeviceMemory = vk::DeviceMemory(4);
pub(crate) const COMMAND_BUFFER: vk::CommandBuffer = vk::CommandBuffer(7);

/// A validator that is only shown calls.
pub(crate) struct Program(Validator);

impl Program {
    pub(crate) fn new() -> Self {
        Self(Validator::new(DeviceProfile::reference()))
    }

    pub(crate) fn calls(&mut self, call: Call) -> &mut Self {
        self.returns(call, Output::None)
    }

    pub(crate) fn returns(&mut self, call: Call, output: Output) -> &mut Self {
        self.0.track(&call, &output);
        self
    }

    pub(crate) fn state(&self) -> &State {
        self.0.state()
    }

    /// A buffer of that size.
    pub(crate) fn buffer(&mut self, buffer: vk::Buffer, size: u64, flags: vk::BufferCreateFlags) -> &mut Self {
        let create_info = vk::BufferCreateInfo { size, flags, ..Default::default() };
        self.calls(Call::CreateBuffer { device: DEVICE, create_info, buffer })
    }

    pub(crate) fn allocate(&mut self, memory: vk::DeviceMemory, memory_type_index: u32) -> &mut Self {
        let allocate_info = vk::MemoryAllocateInfo { allocation_size: 0x1000, memory_type_index, ..Default::default() };
        self.calls(Call::AllocateMemory { device: DEVICE, allocate_info, memory })
    }

    pub(crate) fn bind(&mut self, buffer: vk::Buffer, memory_offset: u64) -> &mut Self {
        self.calls(Call::BindBufferMemory { device: DEVICE, buffer, memory: MEMORY, memory_offset })
    }

    pub(crate) fn address(&mut self, buffer: vk::Buffer, address: u64) -> &mut Self {
        let info = vk::BufferDeviceAddressInfo { buffer, ..Default::default() };
        let call = Call::GetBufferDeviceAddress { device: DEVICE, info };
        self.returns(call, Output::DeviceAddress(vk::DeviceAddress(address)))
    }

    pub(crate) fn begin(&mut self, command_buffer: vk::CommandBuffer) -> &mut Self {
        self.calls(Call::BeginCommandBuffer { command_buffer, begin_info: vk::CommandBufferBeginInfo::default() })
    }

    pub(crate) fn submit(&mut self) -> &mut Self {
        self.calls(Call::EndCommandBuffer { command_buffer: COMMAND_BUFFER });
        self.calls(Call::QueueSubmit { queue: QUEUE, command_buffers: vec![COMMAND_BUFFER] })
    }

    /// A micromap object of 256 bytes in the buffer.
    pub(crate) fn micromap(&mut self, micromap: vk::Micromap, offset: u64) -> &mut Self {
        let create_info = vk::MicromapCreateInfo { buffer: BUFFER, offset, size: 0x100, ..Default::default() };
        self.calls(Call::CreateMicromap { device: DEVICE, create_info, micromap })
    }

    pub(crate) fn structure(&mut self, acceleration_structure: vk::AccelerationStructure) -> &mut Self {
        let create_info = vk::AccelerationStructureCreateInfo2::default();
        self.calls(Call::CreateAccelerationStructure2 { device: DEVICE, create_info, acceleration_structure })
    }
}

pub(crate) fn micromap_build(dst_micromap: vk::Micromap, count: u32) -> vk::MicromapBuildInfo {
    let usage = vk::MicromapUsageExt { count, subdivision_level: 1, format: 2 };
    vk::MicromapBuildInfo { dst_micromap, usage_counts: Some(vec![usage]), ..Default::default() }
}
