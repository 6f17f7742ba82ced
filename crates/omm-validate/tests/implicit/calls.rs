//! For each command a call that is valid next.

use omm_model::call::{
    Call, DeviceCreateInfo, DeviceQueueCreateInfo, PhysicalDeviceFeatures2, PhysicalDeviceProperties2,
};
use omm_model::vk;

use crate::world::*;

fn host_micromap_build() -> vk::MicromapBuildInfo {
    vk::MicromapBuildInfo {
        data: vk::HostAddress(0x5000).into(),
        scratch_data: vk::HostAddress(0x6000).into(),
        triangle_array: vk::HostAddress(0x7000).into(),
        ..micromap_build()
    }
}

fn bottom_level(attached: vk::ChainStructure) -> Call {
    let triangles = vk::GeometryTrianglesData {
        next: vec![attached],
        vertex_format: vk::Format::R32G32B32_SFLOAT,
        vertex_stride: 12,
        max_vertex: 5,
        index_type: vk::IndexType::NONE,
        ..Default::default()
    };
    let geometry = vk::Geometry {
        geometry_type: vk::GeometryType::TRIANGLES,
        geometry: vk::GeometryData::Triangles(triangles),
        ..Default::default()
    };
    let info = vk::BuildGeometryInfo {
        ty: vk::AccelerationStructureType::BOTTOM_LEVEL,
        dst_acceleration_structure: BOTTOM_LEVEL,
        geometries: Some(vec![geometry]),
        scratch_data: vk::DeviceAddress(SCRATCH).into(),
        ..Default::default()
    };
    Call::CmdBuildAccelerationStructures {
        command_buffer: COMMAND_BUFFER,
        infos: vec![info],
        build_range_infos: vec![Some(vec![vk::BuildRangeInfo { primitive_count: 2, ..Default::default() }])],
    }
}

/// The valid calls, by name of the command; of builds of acceleration structures there are three.
pub(crate) fn base(name: &str) -> Call {
    let (device, command_buffer, deferred_operation) = (DEVICE, COMMAND_BUFFER, OPERATION);
    let micromaps = vec![MICROMAP];
    let device_memory = vk::DeviceOrHostAddress::from(vk::DeviceAddress(SERIALIZED));
    let host_memory = vk::DeviceOrHostAddress::from(vk::HostAddress(0x8000));
    let copy = vk::CopyMicromapInfo { src: MICROMAP, dst: TARGET, ..Default::default() };
    let to_memory = vk::CopyMicromapToMemoryInfo {
        src: MICROMAP,
        dst: device_memory,
        mode: vk::CopyMicromapMode::SERIALIZE,
        ..Default::default()
    };
    let from_memory = vk::CopyMemoryToMicromapInfo {
        src: device_memory,
        dst: TARGET,
        mode: vk::CopyMicromapMode::DESERIALIZE,
        ..Default::default()
    };
    let query_type = vk::QueryType::MICROMAP_SERIALIZATION_SIZE;
    let (operation, physical_device) = (OPERATION, vk::PhysicalDevice(4));
    match name {
        "CmdBuildMicromaps" => Call::CmdBuildMicromaps { command_buffer, infos: vec![micromap_build()] },
        "BuildMicromaps" => Call::BuildMicromaps { device, deferred_operation, infos: vec![host_micromap_build()] },
        "CmdCopyMicromap" => Call::CmdCopyMicromap { command_buffer, info: copy },
        "CopyMicromap" => Call::CopyMicromap { device, deferred_operation, info: copy },
        "CmdCopyMicromapToMemory" => Call::CmdCopyMicromapToMemory { command_buffer, info: to_memory },
        "CopyMicromapToMemory" => {
            let info = vk::CopyMicromapToMemoryInfo { dst: host_memory, ..to_memory };
            Call::CopyMicromapToMemory { device, deferred_operation, info }
        }
        "CmdCopyMemoryToMicromap" => Call::CmdCopyMemoryToMicromap { command_buffer, info: from_memory },
        "CopyMemoryToMicromap" => {
            let info = vk::CopyMemoryToMicromapInfo { src: host_memory, ..from_memory };
            Call::CopyMemoryToMicromap { device, deferred_operation, info }
        }
        "CmdWriteMicromapsProperties" => Call::CmdWriteMicromapsProperties {
            command_buffer,
            micromaps,
            query_type,
            query_pool: POOL,
            first_query: 0,
        },
        "WriteMicromapsProperties" => {
            Call::WriteMicromapsProperties { device, micromaps, query_type, data_size: 8, stride: 8 }
        }
        "CreateMicromap" => {
            Call::CreateMicromap { device, create_info: micromap_create_info(), micromap: vk::Micromap(0x29) }
        }
        "DestroyMicromap" => Call::DestroyMicromap { device, micromap: TARGET },
        "GetMicromapBuildSizes" => Call::GetMicromapBuildSizes {
            device,
            build_type: vk::AccelerationStructureBuildType::DEVICE,
            build_info: micromap_build(),
        },
        "GetDeviceMicromapCompatibility" => {
            let version_info = vk::MicromapVersionInfo { version_data: vec![0; 32], ..Default::default() };
            Call::GetDeviceMicromapCompatibility { device, version_info }
        }
        "CreateAccelerationStructure2" => Call::CreateAccelerationStructure2 {
            device,
            create_info: create_info_2(),
            acceleration_structure: vk::AccelerationStructure(0x59),
        },
        "CreateDeferredOperation" => {
            Call::CreateDeferredOperation { device, deferred_operation: vk::DeferredOperation(0x49) }
        }
        "DestroyDeferredOperation" => Call::DestroyDeferredOperation { device, operation },
        "GetDeferredOperationMaxConcurrency" => Call::GetDeferredOperationMaxConcurrency { device, operation },
        "GetDeferredOperationResult" => Call::GetDeferredOperationResult { device, operation },
        "DeferredOperationJoin" => Call::DeferredOperationJoin { device, operation },
        "CreateDevice" => {
            let queue_create_infos = vec![DeviceQueueCreateInfo { queue_family_index: 0, queue_count: 1 }];
            let next =
                vec![vk::OpacityMicromapFeatures::default().into(), vk::OpacityMicromapFeaturesExt::default().into()];
            let create_info = DeviceCreateInfo { next, queue_create_infos, ..Default::default() };
            Call::CreateDevice { physical_device, create_info, device: vk::Device(0x10) }
        }
        "GetPhysicalDeviceFeatures2" => {
            let next = vec![vk::OpacityMicromapFeatures::default().into()];
            Call::GetPhysicalDeviceFeatures2 { physical_device, features: PhysicalDeviceFeatures2 { next } }
        }
        "GetPhysicalDeviceProperties2" => {
            let next = vec![
                vk::OpacityMicromapProperties::default().into(),
                vk::OpacityMicromapPropertiesExt::default().into(),
            ];
            Call::GetPhysicalDeviceProperties2 { physical_device, properties: PhysicalDeviceProperties2 { next } }
        }
        "micromap" => Call::CmdBuildAccelerationStructures {
            command_buffer,
            infos: vec![structure_build()],
            build_range_infos: vec![None],
        },
        "KHR" => {
            let attached = vk::TrianglesOpacityMicromap {
                index_type: vk::IndexType::UINT16,
                index_buffer: vk::DeviceAddress(INDICES),
                index_stride: 2,
                micromap: STRUCTURE,
                ..Default::default()
            };
            bottom_level(attached.into())
        }
        "EXT" => {
            let attached = vk::TrianglesOpacityMicromapExt {
                index_type: vk::IndexType::UINT16,
                index_buffer: vk::DeviceAddress(INDICES).into(),
                index_stride: 2,
                usage_counts: Some(vec![vk::MicromapUsageExt { count: 2, subdivision_level: 1, format: FOUR_STATE }]),
                micromap: MICROMAP,
                ..Default::default()
            };
            bottom_level(attached.into())
        }
        _ => panic!("no call {name}"),
    }
}

/// Every name that [`base`] knows.
pub(crate) const BASES: &[&str] = &[
    "CmdBuildMicromaps",
    "BuildMicromaps",
    "CmdCopyMicromap",
    "CopyMicromap",
    "CmdCopyMicromapToMemory",
    "CopyMicromapToMemory",
    "CmdCopyMemoryToMicromap",
    "CopyMemoryToMicromap",
    "CmdWriteMicromapsProperties",
    "WriteMicromapsProperties",
    "CreateMicromap",
    "DestroyMicromap",
    "GetMicromapBuildSizes",
    "GetDeviceMicromapCompatibility",
    "CreateAccelerationStructure2",
    "CreateDeferredOperation",
    "DestroyDeferredOperation",
    "GetDeferredOperationMaxConcurrency",
    "GetDeferredOperationResult",
    "DeferredOperationJoin",
    "CreateDevice",
    "GetPhysicalDeviceFeatures2",
    "GetPhysicalDeviceProperties2",
    "micromap",
    "KHR",
    "EXT",
];
