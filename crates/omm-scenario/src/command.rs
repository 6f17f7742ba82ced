//! The API's commands by name, with parameters that say as little as they can.

use omm_model::call::{
    Call, DeviceCreateInfo, DeviceQueueCreateInfo, PhysicalDeviceFeatures2, PhysicalDeviceProperties2,
    RayTracingPipelineCreateInfo, RenderingInfo, ShaderCreateInfo,
};
use omm_model::vk;

use crate::world::{DEVICE, PHYSICAL_DEVICE, QUEUE};

/// A call of each command. Arrays have one element, so that it can be changed; a new object gets `handle`; `command_buffer` is
/// what recorded commands go into.
fn calls(handle: u64, command_buffer: vk::CommandBuffer) -> Vec<Call> {
    let (device, physical_device, queue) = (DEVICE, PHYSICAL_DEVICE, QUEUE);
    let query_type = vk::QueryType::ACCELERATION_STRUCTURE_SIZE;
    let build = || vk::BuildGeometryInfo { geometries: Some(vec![vk::Geometry::default()]), ..Default::default() };
    let ranges = || vec![Some(vec![vk::BuildRangeInfo::default()])];
    let usage = vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS | vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE;
    vec![
        Call::GetPhysicalDeviceFeatures2 { physical_device, features: PhysicalDeviceFeatures2::default() },
        Call::GetPhysicalDeviceProperties2 { physical_device, properties: PhysicalDeviceProperties2::default() },
        Call::CreateDevice {
            physical_device,
            create_info: DeviceCreateInfo {
                queue_create_infos: vec![DeviceQueueCreateInfo { queue_family_index: 0, queue_count: 1 }],
                ..Default::default()
            },
            device: vk::Device(handle),
        },
        Call::DestroyDevice { device },
        Call::GetDeviceQueue { device, queue_family_index: 0, queue_index: 0, queue: vk::Queue(handle) },
        Call::CreateBuffer {
            device,
            create_info: vk::BufferCreateInfo { size: 256, usage, ..Default::default() },
            buffer: vk::Buffer(handle),
        },
        Call::DestroyBuffer { device, buffer: vk::Buffer::NULL },
        Call::AllocateMemory {
            device,
            allocate_info: vk::MemoryAllocateInfo {
                next: vec![
                    vk::MemoryAllocateFlagsInfo {
                        flags: vk::MemoryAllocateFlags::DEVICE_ADDRESS,
                        ..Default::default()
                    }
                    .into(),
                ],
                allocation_size: 256,
                ..Default::default()
            },
            memory: vk::DeviceMemory(handle),
        },
        Call::FreeMemory { device, memory: vk::DeviceMemory::NULL },
        Call::BindBufferMemory { device, buffer: vk::Buffer::NULL, memory: vk::DeviceMemory::NULL, memory_offset: 0 },
        Call::QueueBindSparse {
            queue,
            buffer_binds: vec![vk::SparseBufferMemoryBindInfo {
                buffer: vk::Buffer::NULL,
                binds: vec![vk::SparseMemoryBind::default()],
            }],
        },
        Call::GetBufferDeviceAddress { device, info: vk::BufferDeviceAddressInfo::default() },
        Call::CreateCommandPool {
            device,
            create_info: vk::CommandPoolCreateInfo::default(),
            command_pool: vk::CommandPool(handle),
        },
        Call::DestroyCommandPool { device, command_pool: vk::CommandPool::NULL },
        Call::AllocateCommandBuffers {
            device,
            allocate_info: vk::CommandBufferAllocateInfo { command_buffer_count: 1, ..Default::default() },
            command_buffers: vec![vk::CommandBuffer(handle)],
        },
        Call::FreeCommandBuffers {
            device,
            command_pool: vk::CommandPool::NULL,
            command_buffers: vec![vk::CommandBuffer::NULL],
        },
        Call::BeginCommandBuffer { command_buffer, begin_info: vk::CommandBufferBeginInfo::default() },
        Call::EndCommandBuffer { command_buffer },
        Call::ResetCommandBuffer { command_buffer, flags: vk::CommandBufferResetFlags::empty() },
        Call::QueueSubmit { queue, command_buffers: vec![command_buffer] },
        Call::CmdExecuteCommands { command_buffer, command_buffers: vec![vk::CommandBuffer::NULL] },
        Call::CmdBeginRendering { command_buffer, rendering_info: RenderingInfo::default() },
        Call::CmdEndRendering { command_buffer },
        Call::CreateQueryPool {
            device,
            create_info: vk::QueryPoolCreateInfo { query_type, query_count: 1, ..Default::default() },
            query_pool: vk::QueryPool(handle),
        },
        Call::DestroyQueryPool { device, query_pool: vk::QueryPool::NULL },
        Call::ResetQueryPool { device, query_pool: vk::QueryPool::NULL, first_query: 0, query_count: 1 },
        Call::CmdResetQueryPool { command_buffer, query_pool: vk::QueryPool::NULL, first_query: 0, query_count: 1 },
        Call::GetQueryPoolResults {
            device,
            query_pool: vk::QueryPool::NULL,
            first_query: 0,
            query_count: 1,
            data_size: 8,
            stride: 8,
            flags: vk::QueryResultFlags::RESULT_64 | vk::QueryResultFlags::WAIT,
        },
        Call::CreateAccelerationStructure {
            device,
            create_info: vk::AccelerationStructureCreateInfo::default(),
            acceleration_structure: vk::AccelerationStructure(handle),
        },
        Call::CreateAccelerationStructure2 {
            device,
            create_info: vk::AccelerationStructureCreateInfo2::default(),
            acceleration_structure: vk::AccelerationStructure(handle),
        },
        Call::DestroyAccelerationStructure { device, acceleration_structure: vk::AccelerationStructure::NULL },
        Call::GetAccelerationStructureDeviceAddress {
            device,
            info: vk::AccelerationStructureDeviceAddressInfo::default(),
        },
        Call::GetAccelerationStructureBuildSizes {
            device,
            build_type: vk::AccelerationStructureBuildType::DEVICE,
            build_info: build(),
            max_primitive_counts: Some(vec![0]),
        },
        Call::GetDeviceAccelerationStructureCompatibility {
            device,
            version_info: vk::AccelerationStructureVersionInfo {
                version_data: vec![0; 2 * vk::UUID_SIZE],
                ..Default::default()
            },
        },
        Call::CmdBuildAccelerationStructures { command_buffer, infos: vec![build()], build_range_infos: ranges() },
        Call::CmdBuildAccelerationStructuresIndirect {
            command_buffer,
            infos: vec![build()],
            indirect_device_addresses: vec![vk::DeviceAddress::NULL],
            indirect_strides: vec![16],
            max_primitive_counts: vec![Some(vec![0])],
        },
        Call::CmdCopyAccelerationStructure { command_buffer, info: vk::CopyAccelerationStructureInfo::default() },
        Call::CmdCopyAccelerationStructureToMemory {
            command_buffer,
            info: vk::CopyAccelerationStructureToMemoryInfo {
                mode: vk::CopyAccelerationStructureMode::SERIALIZE,
                ..Default::default()
            },
        },
        Call::CmdCopyMemoryToAccelerationStructure {
            command_buffer,
            info: vk::CopyMemoryToAccelerationStructureInfo {
                mode: vk::CopyAccelerationStructureMode::DESERIALIZE,
                ..Default::default()
            },
        },
        Call::CmdWriteAccelerationStructuresProperties {
            command_buffer,
            acceleration_structures: vec![vk::AccelerationStructure::NULL],
            query_type,
            query_pool: vk::QueryPool::NULL,
            first_query: 0,
        },
        Call::BuildAccelerationStructures {
            device,
            deferred_operation: vk::DeferredOperation::NULL,
            infos: vec![build()],
            build_range_infos: ranges(),
        },
        Call::CopyAccelerationStructure {
            device,
            deferred_operation: vk::DeferredOperation::NULL,
            info: vk::CopyAccelerationStructureInfo::default(),
        },
        Call::CopyAccelerationStructureToMemory {
            device,
            deferred_operation: vk::DeferredOperation::NULL,
            info: vk::CopyAccelerationStructureToMemoryInfo {
                dst: vk::HostAddress::NULL.into(),
                mode: vk::CopyAccelerationStructureMode::SERIALIZE,
                ..Default::default()
            },
        },
        Call::CopyMemoryToAccelerationStructure {
            device,
            deferred_operation: vk::DeferredOperation::NULL,
            info: vk::CopyMemoryToAccelerationStructureInfo {
                src: vk::HostAddress::NULL.into(),
                mode: vk::CopyAccelerationStructureMode::DESERIALIZE,
                ..Default::default()
            },
        },
        Call::WriteAccelerationStructuresProperties {
            device,
            acceleration_structures: vec![vk::AccelerationStructure::NULL],
            query_type,
            data_size: 8,
            stride: 8,
        },
        Call::CreateMicromap { device, create_info: vk::MicromapCreateInfo::default(), micromap: vk::Micromap(handle) },
        Call::DestroyMicromap { device, micromap: vk::Micromap::NULL },
        Call::GetMicromapBuildSizes {
            device,
            build_type: vk::AccelerationStructureBuildType::DEVICE,
            build_info: vk::MicromapBuildInfo::default(),
        },
        Call::GetDeviceMicromapCompatibility {
            device,
            version_info: vk::MicromapVersionInfo { version_data: vec![0; 2 * vk::UUID_SIZE], ..Default::default() },
        },
        Call::CmdBuildMicromaps { command_buffer, infos: vec![vk::MicromapBuildInfo::default()] },
        Call::CmdCopyMicromap { command_buffer, info: vk::CopyMicromapInfo::default() },
        Call::CmdCopyMicromapToMemory {
            command_buffer,
            info: vk::CopyMicromapToMemoryInfo { mode: vk::CopyMicromapMode::SERIALIZE, ..Default::default() },
        },
        Call::CmdCopyMemoryToMicromap {
            command_buffer,
            info: vk::CopyMemoryToMicromapInfo { mode: vk::CopyMicromapMode::DESERIALIZE, ..Default::default() },
        },
        Call::CmdWriteMicromapsProperties {
            command_buffer,
            micromaps: vec![vk::Micromap::NULL],
            query_type: vk::QueryType::MICROMAP_COMPACTED_SIZE,
            query_pool: vk::QueryPool::NULL,
            first_query: 0,
        },
        Call::BuildMicromaps {
            device,
            deferred_operation: vk::DeferredOperation::NULL,
            infos: vec![vk::MicromapBuildInfo::default()],
        },
        Call::CopyMicromap {
            device,
            deferred_operation: vk::DeferredOperation::NULL,
            info: vk::CopyMicromapInfo::default(),
        },
        Call::CopyMicromapToMemory {
            device,
            deferred_operation: vk::DeferredOperation::NULL,
            info: vk::CopyMicromapToMemoryInfo {
                dst: vk::HostAddress::NULL.into(),
                mode: vk::CopyMicromapMode::SERIALIZE,
                ..Default::default()
            },
        },
        Call::CopyMemoryToMicromap {
            device,
            deferred_operation: vk::DeferredOperation::NULL,
            info: vk::CopyMemoryToMicromapInfo {
                src: vk::HostAddress::NULL.into(),
                mode: vk::CopyMicromapMode::DESERIALIZE,
                ..Default::default()
            },
        },
        Call::WriteMicromapsProperties {
            device,
            micromaps: vec![vk::Micromap::NULL],
            query_type: vk::QueryType::MICROMAP_COMPACTED_SIZE,
            data_size: 8,
            stride: 8,
        },
        Call::CreateDeferredOperation { device, deferred_operation: vk::DeferredOperation(handle) },
        Call::DestroyDeferredOperation { device, operation: vk::DeferredOperation::NULL },
        Call::GetDeferredOperationMaxConcurrency { device, operation: vk::DeferredOperation::NULL },
        Call::GetDeferredOperationResult { device, operation: vk::DeferredOperation::NULL },
        Call::DeferredOperationJoin { device, operation: vk::DeferredOperation::NULL },
        Call::CreateRayTracingPipelines {
            device,
            create_infos: vec![RayTracingPipelineCreateInfo::default()],
            pipelines: vec![vk::Pipeline(handle)],
        },
        Call::DestroyPipeline { device, pipeline: vk::Pipeline::NULL },
        Call::CreateShaders {
            device,
            create_infos: vec![ShaderCreateInfo::default()],
            shaders: vec![vk::Shader(handle)],
        },
        Call::DestroyShader { device, shader: vk::Shader::NULL },
        Call::CmdTraceRays { command_buffer, pipeline: vk::Pipeline::NULL, top_level: vk::DeviceAddress::NULL },
        Call::CmdDispatch { command_buffer, shader: vk::Shader::NULL, top_level: vk::DeviceAddress::NULL },
    ]
}

/// A call of the command of that name.
pub(crate) fn named(name: &str, handle: u64, command_buffer: vk::CommandBuffer) -> Option<Call> {
    calls(handle, command_buffer).into_iter().find(|call| call.command() == name)
}

/// The names of all commands.
pub(crate) fn names() -> Vec<&'static str> {
    calls(0, vk::CommandBuffer::NULL).iter().map(Call::command).collect()
}
