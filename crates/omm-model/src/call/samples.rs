//! A call of every command.

use super::*;
use crate::profile::Features;

const DEVICE: vk::Device = vk::Device(1);

/// A call of each command, with something odd here and there.
pub(super) fn samples() -> Vec<Call> {
    vec![
        Call::GetPhysicalDeviceFeatures2 {
            physical_device: vk::PhysicalDevice(20),
            features: PhysicalDeviceFeatures2 { next: vec![vk::OpacityMicromapFeaturesExt::default().into()] },
        },
        Call::GetPhysicalDeviceProperties2 {
            physical_device: vk::PhysicalDevice(20),
            properties: PhysicalDeviceProperties2 { next: vec![vk::OpacityMicromapProperties::default().into()] },
        },
        Call::CreateDevice {
            physical_device: vk::PhysicalDevice(20),
            create_info: DeviceCreateInfo {
                next: vec![
                    vk::OpacityMicromapFeatures::default().into(),
                    vk::DeviceGroupDeviceCreateInfo::default().into(),
                ],
                queue_create_infos: vec![DeviceQueueCreateInfo { queue_family_index: 9, queue_count: 2 }],
                enabled_features: Some(Features::ALL),
            },
            device: DEVICE,
        },
        Call::DestroyDevice { device: DEVICE },
        Call::GetDeviceQueue { device: DEVICE, queue_family_index: 1, queue_index: 1, queue: vk::Queue(10) },
        Call::CreateBuffer { device: DEVICE, create_info: vk::BufferCreateInfo::default(), buffer: vk::Buffer(11) },
        Call::DestroyBuffer { device: DEVICE, buffer: vk::Buffer(11) },
        Call::AllocateMemory {
            device: DEVICE,
            allocate_info: vk::MemoryAllocateInfo {
                next: vec![vk::MemoryAllocateFlagsInfo::default().into()],
                ..Default::default()
            },
            memory: vk::DeviceMemory(12),
        },
        Call::FreeMemory { device: DEVICE, memory: vk::DeviceMemory(12) },
        Call::BindBufferMemory {
            device: DEVICE,
            buffer: vk::Buffer(11),
            memory: vk::DeviceMemory(12),
            memory_offset: 256,
        },
        Call::QueueBindSparse {
            queue: vk::Queue(10),
            buffer_binds: vec![vk::SparseBufferMemoryBindInfo {
                buffer: vk::Buffer(11),
                binds: vec![vk::SparseMemoryBind { size: u64::MAX, ..Default::default() }],
            }],
        },
        Call::GetBufferDeviceAddress { device: DEVICE, info: vk::BufferDeviceAddressInfo::default() },
        Call::CreateCommandPool {
            device: DEVICE,
            create_info: vk::CommandPoolCreateInfo::default(),
            command_pool: vk::CommandPool(13),
        },
        Call::DestroyCommandPool { device: DEVICE, command_pool: vk::CommandPool(13) },
        Call::AllocateCommandBuffers {
            device: DEVICE,
            allocate_info: vk::CommandBufferAllocateInfo::default(),
            command_buffers: vec![vk::CommandBuffer(3)],
        },
        Call::FreeCommandBuffers {
            device: DEVICE,
            command_pool: vk::CommandPool(13),
            command_buffers: vec![vk::CommandBuffer(3)],
        },
        Call::BeginCommandBuffer {
            command_buffer: vk::CommandBuffer(3),
            begin_info: vk::CommandBufferBeginInfo::default(),
        },
        Call::EndCommandBuffer { command_buffer: vk::CommandBuffer(3) },
        Call::ResetCommandBuffer {
            command_buffer: vk::CommandBuffer(3),
            flags: vk::CommandBufferResetFlags::RELEASE_RESOURCES,
        },
        Call::QueueSubmit { queue: vk::Queue(10), command_buffers: vec![vk::CommandBuffer(3)] },
        Call::CmdExecuteCommands { command_buffer: vk::CommandBuffer(3), command_buffers: vec![vk::CommandBuffer(3)] },
        Call::CmdBeginRendering {
            command_buffer: vk::CommandBuffer(3),
            rendering_info: RenderingInfo { flags: vk::RenderingFlags::SUSPENDING },
        },
        Call::CmdEndRendering { command_buffer: vk::CommandBuffer(3) },
        Call::CreateQueryPool {
            device: DEVICE,
            create_info: vk::QueryPoolCreateInfo::default(),
            query_pool: vk::QueryPool(14),
        },
        Call::DestroyQueryPool { device: DEVICE, query_pool: vk::QueryPool(14) },
        Call::ResetQueryPool { device: DEVICE, query_pool: vk::QueryPool(14), first_query: 2, query_count: 4 },
        Call::CmdResetQueryPool {
            command_buffer: vk::CommandBuffer(3),
            query_pool: vk::QueryPool(14),
            first_query: 2,
            query_count: 4,
        },
        Call::GetQueryPoolResults {
            device: DEVICE,
            query_pool: vk::QueryPool(14),
            first_query: 2,
            query_count: 4,
            data_size: 64,
            stride: 8,
            flags: vk::QueryResultFlags::from_bits_retain(!0),
        },
        Call::CreateAccelerationStructure {
            device: DEVICE,
            create_info: vk::AccelerationStructureCreateInfo::default(),
            acceleration_structure: vk::AccelerationStructure(15),
        },
        Call::CreateAccelerationStructure2 {
            device: DEVICE,
            create_info: vk::AccelerationStructureCreateInfo2::default(),
            acceleration_structure: vk::AccelerationStructure(15),
        },
        Call::DestroyAccelerationStructure { device: DEVICE, acceleration_structure: vk::AccelerationStructure(15) },
        Call::GetAccelerationStructureDeviceAddress {
            device: DEVICE,
            info: vk::AccelerationStructureDeviceAddressInfo::default(),
        },
        Call::GetAccelerationStructureBuildSizes {
            device: DEVICE,
            build_type: vk::AccelerationStructureBuildType::HOST_OR_DEVICE,
            build_info: odd_build(),
            max_primitive_counts: Some(vec![7]),
        },
        Call::GetDeviceAccelerationStructureCompatibility {
            device: DEVICE,
            version_info: vk::AccelerationStructureVersionInfo::default(),
        },
        Call::CmdBuildAccelerationStructures {
            command_buffer: vk::CommandBuffer(3),
            infos: vec![odd_build()],
            build_range_infos: vec![None, Some(vec![vk::BuildRangeInfo::default()])],
        },
        Call::CmdBuildAccelerationStructuresIndirect {
            command_buffer: vk::CommandBuffer(3),
            infos: vec![odd_build()],
            indirect_device_addresses: vec![vk::DeviceAddress(256)],
            indirect_strides: vec![1],
            max_primitive_counts: vec![None, Some(vec![7])],
        },
        Call::CmdCopyAccelerationStructure {
            command_buffer: vk::CommandBuffer(3),
            info: vk::CopyAccelerationStructureInfo::default(),
        },
        Call::CmdCopyAccelerationStructureToMemory {
            command_buffer: vk::CommandBuffer(3),
            info: vk::CopyAccelerationStructureToMemoryInfo::default(),
        },
        Call::CmdCopyMemoryToAccelerationStructure {
            command_buffer: vk::CommandBuffer(3),
            info: vk::CopyMemoryToAccelerationStructureInfo::default(),
        },
        Call::CmdWriteAccelerationStructuresProperties {
            command_buffer: vk::CommandBuffer(3),
            acceleration_structures: vec![vk::AccelerationStructure(15)],
            query_type: vk::QueryType::ACCELERATION_STRUCTURE_SERIALIZATION_SIZE,
            query_pool: vk::QueryPool(14),
            first_query: 2,
        },
        Call::BuildAccelerationStructures {
            device: DEVICE,
            deferred_operation: vk::DeferredOperation(17),
            infos: vec![odd_build()],
            build_range_infos: vec![None, Some(vec![vk::BuildRangeInfo::default()])],
        },
        Call::CopyAccelerationStructure {
            device: DEVICE,
            deferred_operation: vk::DeferredOperation(17),
            info: vk::CopyAccelerationStructureInfo::default(),
        },
        Call::CopyAccelerationStructureToMemory {
            device: DEVICE,
            deferred_operation: vk::DeferredOperation(17),
            info: vk::CopyAccelerationStructureToMemoryInfo::default(),
        },
        Call::CopyMemoryToAccelerationStructure {
            device: DEVICE,
            deferred_operation: vk::DeferredOperation(17),
            info: vk::CopyMemoryToAccelerationStructureInfo::default(),
        },
        Call::WriteAccelerationStructuresProperties {
            device: DEVICE,
            acceleration_structures: vec![vk::AccelerationStructure(15)],
            query_type: vk::QueryType::ACCELERATION_STRUCTURE_SERIALIZATION_SIZE,
            data_size: 64,
            stride: 8,
        },
        Call::CreateMicromap {
            device: DEVICE,
            create_info: vk::MicromapCreateInfo::default(),
            micromap: vk::Micromap(16),
        },
        Call::DestroyMicromap { device: DEVICE, micromap: vk::Micromap(16) },
        Call::GetMicromapBuildSizes {
            device: DEVICE,
            build_type: vk::AccelerationStructureBuildType::HOST_OR_DEVICE,
            build_info: odd_micromap_build(),
        },
        Call::GetDeviceMicromapCompatibility { device: DEVICE, version_info: vk::MicromapVersionInfo::default() },
        Call::CmdBuildMicromaps { command_buffer: vk::CommandBuffer(3), infos: vec![odd_micromap_build()] },
        Call::CmdCopyMicromap {
            command_buffer: vk::CommandBuffer(3),
            info: vk::CopyMicromapInfo { mode: vk::CopyMicromapMode(-4), ..Default::default() },
        },
        Call::CmdCopyMicromapToMemory {
            command_buffer: vk::CommandBuffer(3),
            info: vk::CopyMicromapToMemoryInfo { dst: vk::HostAddress(16).into(), ..Default::default() },
        },
        Call::CmdCopyMemoryToMicromap {
            command_buffer: vk::CommandBuffer(3),
            info: vk::CopyMemoryToMicromapInfo { src: vk::DeviceAddress(256).into(), ..Default::default() },
        },
        Call::CmdWriteMicromapsProperties {
            command_buffer: vk::CommandBuffer(3),
            micromaps: vec![vk::Micromap(16)],
            query_type: vk::QueryType::MICROMAP_COMPACTED_SIZE,
            query_pool: vk::QueryPool(14),
            first_query: 2,
        },
        Call::BuildMicromaps {
            device: DEVICE,
            deferred_operation: vk::DeferredOperation(17),
            infos: vec![odd_micromap_build()],
        },
        Call::CopyMicromap {
            device: DEVICE,
            deferred_operation: vk::DeferredOperation(17),
            info: vk::CopyMicromapInfo { mode: vk::CopyMicromapMode(-4), ..Default::default() },
        },
        Call::CopyMicromapToMemory {
            device: DEVICE,
            deferred_operation: vk::DeferredOperation(17),
            info: vk::CopyMicromapToMemoryInfo { dst: vk::HostAddress(16).into(), ..Default::default() },
        },
        Call::CopyMemoryToMicromap {
            device: DEVICE,
            deferred_operation: vk::DeferredOperation(17),
            info: vk::CopyMemoryToMicromapInfo { src: vk::DeviceAddress(256).into(), ..Default::default() },
        },
        Call::WriteMicromapsProperties {
            device: DEVICE,
            micromaps: vec![vk::Micromap(16)],
            query_type: vk::QueryType::MICROMAP_COMPACTED_SIZE,
            data_size: 64,
            stride: 8,
        },
        Call::CreateDeferredOperation { device: DEVICE, deferred_operation: vk::DeferredOperation(17) },
        Call::DestroyDeferredOperation { device: DEVICE, operation: vk::DeferredOperation(17) },
        Call::GetDeferredOperationMaxConcurrency { device: DEVICE, operation: vk::DeferredOperation(17) },
        Call::GetDeferredOperationResult { device: DEVICE, operation: vk::DeferredOperation(17) },
        Call::DeferredOperationJoin { device: DEVICE, operation: vk::DeferredOperation(17) },
        Call::CreateRayTracingPipelines {
            device: DEVICE,
            create_infos: vec![RayTracingPipelineCreateInfo {
                flags: vk::PipelineCreateFlags2::OPACITY_MICROMAP_DISALLOW_MIXED_SPECIAL_INDEX,
            }],
            pipelines: vec![vk::Pipeline(18)],
        },
        Call::DestroyPipeline { device: DEVICE, pipeline: vk::Pipeline(18) },
        Call::CreateShaders {
            device: DEVICE,
            create_infos: vec![ShaderCreateInfo {
                flags: vk::ShaderCreateFlags::OPACITY_MICROMAP_DISALLOW_MIXED_SPECIAL_INDEX,
            }],
            shaders: vec![vk::Shader(19)],
        },
        Call::DestroyShader { device: DEVICE, shader: vk::Shader(19) },
        Call::CmdTraceRays {
            command_buffer: vk::CommandBuffer(3),
            pipeline: vk::Pipeline(18),
            top_level: vk::DeviceAddress(256),
        },
        Call::CmdDispatch {
            command_buffer: vk::CommandBuffer(3),
            shader: vk::Shader(19),
            top_level: vk::DeviceAddress(256),
        },
    ]
}

fn odd_build() -> vk::BuildGeometryInfo {
    vk::BuildGeometryInfo {
        ty: vk::AccelerationStructureType(-17),
        geometries: Some(vec![vk::Geometry::default()]),
        ..Default::default()
    }
}

fn odd_micromap_build() -> vk::MicromapBuildInfo {
    vk::MicromapBuildInfo {
        ty: vk::MicromapType::DISPLACEMENT_MICROMAP,
        usage_counts: Some(vec![]),
        usage_count_pointers: Some(vec![vk::MicromapUsageExt { format: 3, ..Default::default() }]),
        data: vk::HostAddress(1).into(),
        ..Default::default()
    }
}
