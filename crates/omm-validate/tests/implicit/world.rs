//! A program that has made one of everything.

use omm_model::call::{Call, DeviceCreateInfo, DeviceQueueCreateInfo, Output, RenderingInfo};
use omm_model::profile::DeviceProfile;
use omm_model::vk;
use omm_validate::Validator;

pub(crate) const DEVICE: vk::Device = vk::Device(1);
/// Another device, with one micromap, query pool, operation and command buffer.
pub(crate) const OTHER_DEVICE: vk::Device = vk::Device(2);
/// A device without queues.
pub(crate) const IDLE_DEVICE: vk::Device = vk::Device(3);
const QUEUE: vk::Queue = vk::Queue(5);
pub(crate) const COMMAND_BUFFER: vk::CommandBuffer = vk::CommandBuffer(7);
pub(crate) const TRANSFER_COMMAND_BUFFER: vk::CommandBuffer = vk::CommandBuffer(0x71);
pub(crate) const BUFFER: vk::Buffer = vk::Buffer(9);
const STRUCTURE_BUFFER: vk::Buffer = vk::Buffer(0xa);
pub(crate) const MICROMAP: vk::Micromap = vk::Micromap(0x20);
pub(crate) const TARGET: vk::Micromap = vk::Micromap(0x21);
pub(crate) const OTHER_MICROMAP: vk::Micromap = vk::Micromap(0x22);
pub(crate) const POOL: vk::QueryPool = vk::QueryPool(0x30);
pub(crate) const OTHER_POOL: vk::QueryPool = vk::QueryPool(0x31);
pub(crate) const OPERATION: vk::DeferredOperation = vk::DeferredOperation(0x40);
pub(crate) const OTHER_OPERATION: vk::DeferredOperation = vk::DeferredOperation(0x41);
pub(crate) const STRUCTURE: vk::AccelerationStructure = vk::AccelerationStructure(0x50);
const STRUCTURE_TARGET: vk::AccelerationStructure = vk::AccelerationStructure(0x51);
pub(crate) const BOTTOM_LEVEL: vk::AccelerationStructure = vk::AccelerationStructure(0x52);
/// What was made and destroyed again, of every kind.
pub(crate) const GONE: u64 = 0x66;
/// What was never made.
pub(crate) const NEVER: u64 = 0xdead;

/// Where the buffers lie.
const BASE: u64 = 0x1_0000;
const STRUCTURES: u64 = 0x10_0000;
/// Places in the first: triangle array, opacity data, indices, scratch memory and serialized data; micromaps behind them.
const TRIANGLES: u64 = BASE;
const DATA: u64 = BASE + 0x100;
pub(crate) const INDICES: u64 = BASE + 0x200;
pub(crate) const SCRATCH: u64 = BASE + 0x1000;
pub(crate) const SERIALIZED: u64 = BASE + 0x2000;
const MICROMAPS: u64 = 0x8000;

pub(crate) struct World(pub(crate) Validator);

impl World {
    pub(crate) fn new() -> Self {
        let mut world = Self(Validator::new(DeviceProfile::reference()));
        world.devices();
        world.memory();
        world.command_buffers();
        world.objects();
        world.gone();
        world.submit();
        world
    }

    pub(crate) fn track(&mut self, call: &Call) {
        self.0.track(call, &Output::None);
    }

    fn devices(&mut self) {
        let queue = DeviceQueueCreateInfo { queue_family_index: 0, queue_count: 1 };
        for (device, queue_create_infos) in
            [(DEVICE, vec![queue]), (OTHER_DEVICE, vec![queue]), (IDLE_DEVICE, vec![]), (vk::Device(GONE), vec![queue])]
        {
            let create_info = DeviceCreateInfo { queue_create_infos, ..Default::default() };
            self.track(&Call::CreateDevice { physical_device: vk::PhysicalDevice(4), create_info, device });
        }
        self.track(&Call::DestroyDevice { device: vk::Device(GONE) });
        self.track(&Call::GetDeviceQueue { device: DEVICE, queue_family_index: 0, queue_index: 0, queue: QUEUE });
    }

    fn memory(&mut self) {
        let inputs = vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS
            | vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY
            | vk::BufferUsageFlags::MICROMAP_BUILD_INPUT_READ_ONLY
            | vk::BufferUsageFlags::MICROMAP_STORAGE;
        let storage =
            vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS | vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE;
        for (buffer, usage, address, memory) in [
            (BUFFER, inputs, BASE, vk::DeviceMemory(0x90)),
            (STRUCTURE_BUFFER, storage, STRUCTURES, vk::DeviceMemory(0x91)),
        ] {
            let create_info = vk::BufferCreateInfo { size: 0x1_0000, usage, ..Default::default() };
            self.track(&Call::CreateBuffer { device: DEVICE, create_info, buffer });
            let allocate_info =
                vk::MemoryAllocateInfo { allocation_size: 0x1_0000, memory_type_index: 2, ..Default::default() };
            self.track(&Call::AllocateMemory { device: DEVICE, allocate_info, memory });
            self.track(&Call::BindBufferMemory { device: DEVICE, buffer, memory, memory_offset: 0 });
            let info = vk::BufferDeviceAddressInfo { buffer, ..Default::default() };
            let address = Output::DeviceAddress(vk::DeviceAddress(address));
            self.0.track(&Call::GetBufferDeviceAddress { device: DEVICE, info }, &address);
        }
    }

    fn command_buffers(&mut self) {
        for (device, family, pool, command_buffer) in [
            (DEVICE, 1, vk::CommandPool(0x60), COMMAND_BUFFER),
            (DEVICE, 2, vk::CommandPool(0x61), TRANSFER_COMMAND_BUFFER),
        ] {
            let create_info = vk::CommandPoolCreateInfo { queue_family_index: family, ..Default::default() };
            self.track(&Call::CreateCommandPool { device, create_info, command_pool: pool });
            self.allocate(device, pool, command_buffer);
            self.begin(command_buffer);
        }
    }

    fn allocate(&mut self, device: vk::Device, command_pool: vk::CommandPool, command_buffer: vk::CommandBuffer) {
        let allocate_info = vk::CommandBufferAllocateInfo { command_pool, ..Default::default() };
        self.track(&Call::AllocateCommandBuffers { device, allocate_info, command_buffers: vec![command_buffer] });
    }

    pub(crate) fn begin(&mut self, command_buffer: vk::CommandBuffer) {
        let begin_info = vk::CommandBufferBeginInfo::default();
        self.track(&Call::BeginCommandBuffer { command_buffer, begin_info });
    }

    pub(crate) fn render(&mut self, flags: vk::RenderingFlags) {
        self.track(&Call::CmdBeginRendering {
            command_buffer: COMMAND_BUFFER,
            rendering_info: RenderingInfo { flags },
        });
    }

    /// Builds the micromaps that others read, and starts anew.
    fn submit(&mut self) {
        let mut build = micromap_build();
        build.dst_micromap = MICROMAP;
        self.track(&Call::CmdBuildMicromaps { command_buffer: COMMAND_BUFFER, infos: vec![build] });
        let mut build = structure_build();
        build.dst_acceleration_structure = STRUCTURE;
        self.track(&Call::CmdBuildAccelerationStructures {
            command_buffer: COMMAND_BUFFER,
            infos: vec![build],
            build_range_infos: vec![None],
        });
        self.track(&Call::CmdResetQueryPool {
            command_buffer: COMMAND_BUFFER,
            query_pool: POOL,
            first_query: 0,
            query_count: 4,
        });
        self.track(&Call::EndCommandBuffer { command_buffer: COMMAND_BUFFER });
        self.track(&Call::QueueSubmit { queue: QUEUE, command_buffers: vec![COMMAND_BUFFER] });
        self.begin(COMMAND_BUFFER);
    }

    fn objects(&mut self) {
        for (device, micromap) in [(DEVICE, MICROMAP), (DEVICE, TARGET), (OTHER_DEVICE, OTHER_MICROMAP)] {
            let mut create_info = micromap_create_info();
            create_info.offset = MICROMAPS + 0x400 * (micromap.0 % 16);
            self.track(&Call::CreateMicromap { device, create_info, micromap });
        }
        for (device, query_pool) in [(DEVICE, POOL), (OTHER_DEVICE, OTHER_POOL)] {
            let query_type = vk::QueryType::MICROMAP_SERIALIZATION_SIZE;
            let create_info = vk::QueryPoolCreateInfo { query_type, query_count: 4, ..Default::default() };
            self.track(&Call::CreateQueryPool { device, create_info, query_pool });
        }
        for (device, deferred_operation) in [(DEVICE, OPERATION), (OTHER_DEVICE, OTHER_OPERATION)] {
            self.track(&Call::CreateDeferredOperation { device, deferred_operation });
        }
        let micromap = vk::AccelerationStructureType::OPACITY_MICROMAP;
        for (acceleration_structure, ty) in [
            (STRUCTURE, micromap),
            (STRUCTURE_TARGET, micromap),
            (BOTTOM_LEVEL, vk::AccelerationStructureType::BOTTOM_LEVEL),
        ] {
            let mut create_info = create_info_2();
            create_info.ty = ty;
            create_info.address_range.address.0 += 0x400 * (acceleration_structure.0 % 16);
            self.track(&Call::CreateAccelerationStructure2 { device: DEVICE, create_info, acceleration_structure });
        }
    }

    /// Makes one more of everything and destroys it.
    fn gone(&mut self) {
        let device = DEVICE;
        let (micromap, query_pool) = (vk::Micromap(GONE), vk::QueryPool(GONE));
        self.track(&Call::CreateMicromap { device, create_info: micromap_create_info(), micromap });
        self.track(&Call::DestroyMicromap { device, micromap });
        self.track(&Call::CreateQueryPool { device, create_info: vk::QueryPoolCreateInfo::default(), query_pool });
        self.track(&Call::DestroyQueryPool { device, query_pool });
        let operation = vk::DeferredOperation(GONE);
        self.track(&Call::CreateDeferredOperation { device, deferred_operation: operation });
        self.track(&Call::DestroyDeferredOperation { device, operation });
        let buffer = vk::Buffer(GONE);
        self.track(&Call::CreateBuffer { device, create_info: vk::BufferCreateInfo::default(), buffer });
        self.track(&Call::DestroyBuffer { device, buffer });
        let acceleration_structure = vk::AccelerationStructure(GONE);
        self.track(&Call::CreateAccelerationStructure2 {
            device,
            create_info: create_info_2(),
            acceleration_structure,
        });
        self.track(&Call::DestroyAccelerationStructure { device, acceleration_structure });
        let (command_pool, command_buffer) = (vk::CommandPool(0x60), vk::CommandBuffer(GONE));
        self.allocate(device, command_pool, command_buffer);
        self.track(&Call::FreeCommandBuffers { device, command_pool, command_buffers: vec![command_buffer] });
    }
}

pub(crate) fn micromap_create_info() -> vk::MicromapCreateInfo {
    vk::MicromapCreateInfo { buffer: BUFFER, offset: MICROMAPS, size: 0x400, ..Default::default() }
}

pub(crate) fn create_info_2() -> vk::AccelerationStructureCreateInfo2 {
    let address_range = vk::DeviceAddressRange { address: vk::DeviceAddress(STRUCTURES), size: 0x400 };
    let ty = vk::AccelerationStructureType::OPACITY_MICROMAP;
    vk::AccelerationStructureCreateInfo2 { address_range, ty, ..Default::default() }
}

pub(crate) const FOUR_STATE: u32 = 2;

pub(crate) fn micromap_build() -> vk::MicromapBuildInfo {
    vk::MicromapBuildInfo {
        dst_micromap: TARGET,
        usage_counts: Some(vec![vk::MicromapUsageExt { count: 2, subdivision_level: 1, format: FOUR_STATE }]),
        data: vk::DeviceAddress(DATA).into(),
        scratch_data: vk::DeviceAddress(SCRATCH).into(),
        triangle_array: vk::DeviceAddress(TRIANGLES).into(),
        triangle_array_stride: 8,
        ..Default::default()
    }
}

pub(crate) fn structure_build() -> vk::BuildGeometryInfo {
    let usage = vk::MicromapUsage { count: 2, subdivision_level: 1, format: vk::OpacityMicromapFormat::FOUR_STATE };
    let data = vk::GeometryMicromapData {
        usage_counts: Some(vec![usage]),
        data: vk::DeviceAddress(DATA),
        triangle_array: vk::DeviceAddress(TRIANGLES),
        triangle_array_stride: 8,
        ..Default::default()
    };
    let geometry =
        vk::Geometry { next: vec![data.into()], geometry_type: vk::GeometryType::MICROMAP, ..Default::default() };
    vk::BuildGeometryInfo {
        ty: vk::AccelerationStructureType::OPACITY_MICROMAP,
        dst_acceleration_structure: STRUCTURE_TARGET,
        geometries: Some(vec![geometry]),
        scratch_data: vk::DeviceAddress(SCRATCH).into(),
        ..Default::default()
    }
}
