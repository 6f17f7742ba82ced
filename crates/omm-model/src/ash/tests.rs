//! Every member arrives in its place, with its number, known or not.

use std::ptr;

use ::ash::vk::{self as ash, Handle};

use super::*;

/// Pairs of their constant and ours.
macro_rules! same {
    ($($theirs:ident = $ours:ident: $($name:ident as $our_name:ident),* ;)*) => {$($(
        assert_eq!(vk::$ours::from(ash::$theirs::$name), vk::$ours::$our_name, stringify!($theirs::$name));
    )*)*};
}

#[test]
fn constants_are_the_same_by_name() {
    same! {
        MicromapTypeEXT = MicromapType: OPACITY_MICROMAP as OPACITY_MICROMAP,
            DISPLACEMENT_MICROMAP_NV as DISPLACEMENT_MICROMAP;
        BuildMicromapModeEXT = BuildMicromapMode: BUILD as BUILD;
        CopyMicromapModeEXT = CopyMicromapMode: CLONE as CLONE, SERIALIZE as SERIALIZE, DESERIALIZE as DESERIALIZE,
            COMPACT as COMPACT;
        OpacityMicromapFormatEXT = OpacityMicromapFormat: TYPE_2_STATE as TWO_STATE, TYPE_4_STATE as FOUR_STATE;
        OpacityMicromapSpecialIndexEXT = OpacityMicromapSpecialIndex: FULLY_TRANSPARENT as FULLY_TRANSPARENT,
            FULLY_OPAQUE as FULLY_OPAQUE, FULLY_UNKNOWN_TRANSPARENT as FULLY_UNKNOWN_TRANSPARENT,
            FULLY_UNKNOWN_OPAQUE as FULLY_UNKNOWN_OPAQUE;
        AccelerationStructureTypeKHR = AccelerationStructureType: TOP_LEVEL as TOP_LEVEL, BOTTOM_LEVEL as BOTTOM_LEVEL;
        BuildAccelerationStructureModeKHR = BuildAccelerationStructureMode: BUILD as BUILD, UPDATE as UPDATE;
        AccelerationStructureBuildTypeKHR = AccelerationStructureBuildType: HOST as HOST, DEVICE as DEVICE;
        GeometryTypeKHR = GeometryType: TRIANGLES as TRIANGLES, AABBS as AABBS, INSTANCES as INSTANCES;
        IndexType = IndexType: UINT16 as UINT16, UINT32 as UINT32, NONE_KHR as NONE, UINT8_KHR as UINT8;
        Format = Format: R32G32B32_SFLOAT as R32G32B32_SFLOAT;
        QueryType = QueryType: MICROMAP_COMPACTED_SIZE_EXT as MICROMAP_COMPACTED_SIZE,
            MICROMAP_SERIALIZATION_SIZE_EXT as MICROMAP_SERIALIZATION_SIZE;
        StructureType = StructureType: MICROMAP_BUILD_INFO_EXT as MICROMAP_BUILD_INFO,
            ACCELERATION_STRUCTURE_TRIANGLES_OPACITY_MICROMAP_EXT as ACCELERATION_STRUCTURE_TRIANGLES_OPACITY_MICROMAP_EXT;
        MicromapCreateFlagsEXT = MicromapCreateFlags: DEVICE_ADDRESS_CAPTURE_REPLAY as DEVICE_ADDRESS_CAPTURE_REPLAY;
        BuildMicromapFlagsEXT = BuildMicromapFlags: PREFER_FAST_TRACE as PREFER_FAST_TRACE,
            PREFER_FAST_BUILD as PREFER_FAST_BUILD, ALLOW_COMPACTION as ALLOW_COMPACTION;
        BuildAccelerationStructureFlagsKHR = BuildAccelerationStructureFlags:
            ALLOW_OPACITY_MICROMAP_UPDATE_EXT as ALLOW_OPACITY_MICROMAP_UPDATE,
            ALLOW_DISABLE_OPACITY_MICROMAPS_EXT as ALLOW_DISABLE_OPACITY_MICROMAPS,
            ALLOW_OPACITY_MICROMAP_DATA_UPDATE_EXT as ALLOW_OPACITY_MICROMAP_DATA_UPDATE;
        GeometryFlagsKHR = GeometryFlags: OPAQUE as OPAQUE;
        BufferUsageFlags = BufferUsageFlags: MICROMAP_STORAGE_EXT as MICROMAP_STORAGE,
            MICROMAP_BUILD_INPUT_READ_ONLY_EXT as MICROMAP_BUILD_INPUT_READ_ONLY;
        BufferCreateFlags = BufferCreateFlags: SPARSE_RESIDENCY as SPARSE_RESIDENCY;
    }
}

#[test]
fn unknown_values_arrive_as_written() {
    assert_eq!(vk::MicromapType::from(ash::MicromapTypeEXT::from_raw(-7)), vk::MicromapType(-7));
    let flags = vk::BuildMicromapFlags::from(ash::BuildMicromapFlagsEXT::from_raw(0x8000_0001));
    assert_eq!(flags.bits(), 0x8000_0001);
    assert_eq!(vk::Micromap::from(ash::MicromapEXT::from_raw(u64::MAX)), vk::Micromap(u64::MAX));
    assert_eq!(vk::Device::from(ash::Device::null()), vk::Device::NULL);
    let lying = ash::CopyMicromapInfoEXT { s_type: ash::StructureType::from_raw(3), ..Default::default() };
    assert_eq!(vk::CopyMicromapInfo::from(&lying).s_type, vk::StructureType(3));
}

#[test]
fn defaults_are_the_same() {
    let usages = MicromapBuildPointers {
        usage_counts: &[],
        data: Default::default(),
        scratch_data: Default::default(),
        triangle_array: Default::default(),
    };
    assert_eq!(vk::MicromapBuildInfo::from_ash(&Default::default(), usages), Ok(Default::default()));
    assert_eq!(vk::MicromapCreateInfo::from(&Default::default()), Default::default());
    assert_eq!(vk::MicromapBuildSizesInfo::from(&Default::default()), Default::default());
    assert_eq!(vk::CopyMicromapInfo::from(&Default::default()), Default::default());
    let address = vk::DeviceOrHostAddress::default();
    assert_eq!(vk::CopyMicromapToMemoryInfo::from_ash(&Default::default(), address), Default::default());
    assert_eq!(vk::CopyMemoryToMicromapInfo::from_ash(&Default::default(), address), Default::default());
    assert_eq!(vk::MicromapVersionInfo::from_ash(&Default::default(), &[7; 32]), Default::default());
    assert_eq!(vk::OpacityMicromapFeaturesExt::from(&Default::default()), Default::default());
    assert_eq!(vk::OpacityMicromapPropertiesExt::from(&Default::default()), Default::default());
    assert_eq!(vk::AccelerationStructureCreateInfo::from(&Default::default()), Default::default());
    let triangles = vk::GeometryTrianglesData::from_ash(&Default::default(), TrianglesPointers::default());
    assert_eq!(triangles, Default::default());
    assert_eq!(vk::Geometry::from_ash(&Default::default(), Default::default()), Default::default());
    let pointers = TrianglesOpacityMicromapPointers { index_buffer: address, usage_counts: &[] };
    assert_eq!(vk::TrianglesOpacityMicromapExt::from_ash(&Default::default(), pointers), Ok(Default::default()));
    let pointers = BuildGeometryPointers { geometries: Vec::new(), scratch_data: address };
    assert_eq!(vk::BuildGeometryInfo::from_ash(&Default::default(), pointers), Ok(Default::default()));
}

#[test]
fn a_micromap_arrives_whole() {
    let create = ash::MicromapCreateInfoEXT::default()
        .create_flags(ash::MicromapCreateFlagsEXT::DEVICE_ADDRESS_CAPTURE_REPLAY)
        .buffer(ash::Buffer::from_raw(2))
        .offset(256)
        .size(512)
        .ty(ash::MicromapTypeEXT::DISPLACEMENT_MICROMAP_NV)
        .device_address(0x4000);
    let expected = vk::MicromapCreateInfo {
        create_flags: vk::MicromapCreateFlags::DEVICE_ADDRESS_CAPTURE_REPLAY,
        buffer: vk::Buffer(2),
        offset: 256,
        size: 512,
        ty: vk::MicromapType::DISPLACEMENT_MICROMAP,
        device_address: vk::DeviceAddress(0x4000),
        ..Default::default()
    };
    assert_eq!(vk::MicromapCreateInfo::from(&create), expected);
    let sizes = ash::MicromapBuildSizesInfoEXT::default().micromap_size(1).build_scratch_size(2).discardable(true);
    let expected = vk::MicromapBuildSizesInfo {
        micromap_size: 1,
        build_scratch_size: 2,
        discardable: vk::Bool32::TRUE,
        ..Default::default()
    };
    assert_eq!(vk::MicromapBuildSizesInfo::from(&sizes), expected);
    let triangle = ash::MicromapTriangleEXT { data_offset: 1, subdivision_level: 2, format: 3 };
    assert_eq!(
        vk::MicromapTriangle::from(triangle),
        vk::MicromapTriangle { data_offset: 1, subdivision_level: 2, format: 3 }
    );
}

#[test]
fn a_build_takes_what_its_pointers_hold() {
    let usages = [
        ash::MicromapUsageEXT { count: 1, subdivision_level: 2, format: 3 },
        ash::MicromapUsageEXT { count: 4, subdivision_level: 5, format: 6 },
    ];
    let ours = vec![
        vk::MicromapUsageExt { count: 1, subdivision_level: 2, format: 3 },
        vk::MicromapUsageExt { count: 4, subdivision_level: 5, format: 6 },
    ];
    let host = vk::DeviceOrHostAddress::HostAddress(vk::HostAddress(0x30));
    let pointers = MicromapBuildPointers {
        usage_counts: &usages,
        data: vk::DeviceAddress(0x10).into(),
        scratch_data: vk::DeviceAddress(0x20).into(),
        triangle_array: host,
    };
    let info = ash::MicromapBuildInfoEXT::default()
        .ty(ash::MicromapTypeEXT::OPACITY_MICROMAP)
        .flags(ash::BuildMicromapFlagsEXT::ALLOW_COMPACTION)
        .mode(ash::BuildMicromapModeEXT::from_raw(9))
        .dst_micromap(ash::MicromapEXT::from_raw(8))
        .usage_counts(&usages)
        .triangle_array_stride(12);
    let expected = vk::MicromapBuildInfo {
        flags: vk::BuildMicromapFlags::ALLOW_COMPACTION,
        mode: vk::BuildMicromapMode(9),
        dst_micromap: vk::Micromap(8),
        usage_counts: Some(ours.clone()),
        data: vk::DeviceAddress(0x10).into(),
        scratch_data: vk::DeviceAddress(0x20).into(),
        triangle_array: host,
        triangle_array_stride: 12,
        ..Default::default()
    };
    assert_eq!(vk::MicromapBuildInfo::from_ash(&info, pointers), Ok(expected.clone()));
    // The array of pointers instead, then both.
    let array = usages.each_ref().map(ptr::from_ref);
    let indirect = ash::MicromapBuildInfoEXT { p_usage_counts: ptr::null(), pp_usage_counts: array.as_ptr(), ..info };
    let other =
        vk::MicromapBuildInfo { usage_counts: None, usage_count_pointers: Some(ours.clone()), ..expected.clone() };
    assert_eq!(vk::MicromapBuildInfo::from_ash(&indirect, pointers), Ok(other));
    let both = ash::MicromapBuildInfoEXT { pp_usage_counts: array.as_ptr(), ..info };
    let other = vk::MicromapBuildInfo { usage_count_pointers: Some(ours), ..expected };
    assert_eq!(vk::MicromapBuildInfo::from_ash(&both, pointers), Ok(other));
    let short = MicromapBuildPointers { usage_counts: &usages[..1], ..pointers };
    let error = vk::MicromapBuildInfo::from_ash(&info, short).unwrap_err();
    assert_eq!(error, CountError { member: "usageCounts", found: 1, required: 2 });
    assert_eq!(error.to_string(), "1 elements were passed for usageCounts, which has 2");
}

#[test]
fn copies_arrive_whole() {
    let (src, dst) = (ash::MicromapEXT::from_raw(3), ash::MicromapEXT::from_raw(4));
    let (from, to) = (vk::Micromap(3), vk::Micromap(4));
    let mode = ash::CopyMicromapModeEXT::COMPACT;
    let info = ash::CopyMicromapInfoEXT::default().src(src).dst(dst).mode(mode);
    let expected =
        vk::CopyMicromapInfo { src: from, dst: to, mode: vk::CopyMicromapMode::COMPACT, ..Default::default() };
    assert_eq!(vk::CopyMicromapInfo::from(&info), expected);
    let address = vk::DeviceAddress(0x100).into();
    let info = ash::CopyMicromapToMemoryInfoEXT::default().src(src).mode(ash::CopyMicromapModeEXT::SERIALIZE);
    let mode = vk::CopyMicromapMode::SERIALIZE;
    let expected = vk::CopyMicromapToMemoryInfo { src: from, dst: address, mode, ..Default::default() };
    assert_eq!(vk::CopyMicromapToMemoryInfo::from_ash(&info, address), expected);
    let info = ash::CopyMemoryToMicromapInfoEXT::default().dst(dst).mode(ash::CopyMicromapModeEXT::DESERIALIZE);
    let mode = vk::CopyMicromapMode::DESERIALIZE;
    let expected = vk::CopyMemoryToMicromapInfo { src: address, dst: to, mode, ..Default::default() };
    assert_eq!(vk::CopyMemoryToMicromapInfo::from_ash(&info, address), expected);
    let data = [5; 32];
    let info = ash::MicromapVersionInfoEXT::default().version_data(&data);
    assert_eq!(vk::MicromapVersionInfo::from_ash(&info, &data).version_data, data);
}

#[test]
fn a_bottom_level_build_arrives_whole() {
    let usages = [ash::MicromapUsageEXT { count: 1, subdivision_level: 2, format: 2 }];
    let attached = ash::AccelerationStructureTrianglesOpacityMicromapEXT::default()
        .index_type(ash::IndexType::UINT8_KHR)
        .index_stride(3)
        .base_triangle(5)
        .usage_counts(&usages)
        .micromap(ash::MicromapEXT::from_raw(6));
    let pointers =
        TrianglesOpacityMicromapPointers { index_buffer: vk::DeviceAddress(0x40).into(), usage_counts: &usages };
    let attached = vk::TrianglesOpacityMicromapExt::from_ash(&attached, pointers).unwrap();
    let expected = vk::TrianglesOpacityMicromapExt {
        index_type: vk::IndexType::UINT8,
        index_buffer: vk::DeviceAddress(0x40).into(),
        index_stride: 3,
        base_triangle: 5,
        usage_counts: Some(vec![vk::MicromapUsageExt { count: 1, subdivision_level: 2, format: 2 }]),
        micromap: vk::Micromap(6),
        ..Default::default()
    };
    assert_eq!(attached, expected);
    let triangles = ash::AccelerationStructureGeometryTrianglesDataKHR::default()
        .vertex_format(ash::Format::R32G32B32_SFLOAT)
        .vertex_stride(12)
        .max_vertex(3)
        .index_type(ash::IndexType::NONE_KHR);
    let pointers = TrianglesPointers { vertex_data: vk::DeviceAddress(0x50).into(), ..Default::default() };
    let mut triangles = vk::GeometryTrianglesData::from_ash(&triangles, pointers);
    triangles.next.push(attached.clone().into());
    let expected = vk::GeometryTrianglesData {
        next: vec![attached.into()],
        vertex_format: vk::Format::R32G32B32_SFLOAT,
        vertex_data: vk::DeviceAddress(0x50).into(),
        vertex_stride: 12,
        max_vertex: 3,
        index_type: vk::IndexType::NONE,
        ..Default::default()
    };
    assert_eq!(triangles, expected);
    let geometry = ash::AccelerationStructureGeometryKHR::default().flags(ash::GeometryFlagsKHR::OPAQUE);
    let ours = vk::Geometry::from_ash(&geometry, vk::GeometryData::Triangles(triangles));
    assert_eq!((ours.geometry_type, ours.flags), (vk::GeometryType::TRIANGLES, vk::GeometryFlags::OPAQUE));
    assert!(matches!(&ours.geometry, vk::GeometryData::Triangles(found) if *found == expected));
    let geometries = [geometry];
    let info = ash::AccelerationStructureBuildGeometryInfoKHR::default()
        .ty(ash::AccelerationStructureTypeKHR::BOTTOM_LEVEL)
        .flags(ash::BuildAccelerationStructureFlagsKHR::ALLOW_UPDATE)
        .mode(ash::BuildAccelerationStructureModeKHR::UPDATE)
        .src_acceleration_structure(ash::AccelerationStructureKHR::from_raw(8))
        .dst_acceleration_structure(ash::AccelerationStructureKHR::from_raw(9))
        .geometries(&geometries);
    let scratch_data = vk::DeviceAddress(0x60).into();
    let pointers = BuildGeometryPointers { geometries: vec![ours.clone()], scratch_data };
    let expected = vk::BuildGeometryInfo {
        ty: vk::AccelerationStructureType::BOTTOM_LEVEL,
        flags: vk::BuildAccelerationStructureFlags::ALLOW_UPDATE,
        mode: vk::BuildAccelerationStructureMode::UPDATE,
        src_acceleration_structure: vk::AccelerationStructure(8),
        dst_acceleration_structure: vk::AccelerationStructure(9),
        geometries: Some(vec![ours]),
        scratch_data,
        ..Default::default()
    };
    assert_eq!(vk::BuildGeometryInfo::from_ash(&info, pointers), Ok(expected));
    let none = BuildGeometryPointers { geometries: Vec::new(), scratch_data };
    let error = vk::BuildGeometryInfo::from_ash(&info, none).unwrap_err();
    assert_eq!(error, CountError { member: "geometries", found: 0, required: 1 });
}

#[test]
fn the_rest_arrives_whole() {
    let range = ash::AccelerationStructureBuildRangeInfoKHR {
        primitive_count: 1,
        primitive_offset: 2,
        first_vertex: 3,
        transform_offset: 4,
    };
    let expected = vk::BuildRangeInfo { primitive_count: 1, primitive_offset: 2, first_vertex: 3, transform_offset: 4 };
    assert_eq!(vk::BuildRangeInfo::from(range), expected);
    let features = ash::PhysicalDeviceOpacityMicromapFeaturesEXT::default().micromap(true).micromap_host_commands(true);
    let ours = vk::OpacityMicromapFeaturesExt::from(&features);
    let found = [ours.micromap, ours.micromap_capture_replay, ours.micromap_host_commands];
    assert_eq!(found, [vk::Bool32::TRUE, vk::Bool32::FALSE, vk::Bool32::TRUE]);
    let properties = ash::PhysicalDeviceOpacityMicromapPropertiesEXT::default()
        .max_opacity2_state_subdivision_level(9)
        .max_opacity4_state_subdivision_level(8);
    let ours = vk::OpacityMicromapPropertiesExt::from(&properties);
    assert_eq!((ours.max_opacity2_state_subdivision_level, ours.max_opacity4_state_subdivision_level), (9, 8));
    let create = ash::AccelerationStructureCreateInfoKHR::default()
        .create_flags(ash::AccelerationStructureCreateFlagsKHR::DEVICE_ADDRESS_CAPTURE_REPLAY)
        .buffer(ash::Buffer::from_raw(1))
        .offset(2)
        .size(3)
        .ty(ash::AccelerationStructureTypeKHR::BOTTOM_LEVEL)
        .device_address(4);
    let expected = vk::AccelerationStructureCreateInfo {
        create_flags: vk::AccelerationStructureCreateFlags::DEVICE_ADDRESS_CAPTURE_REPLAY,
        buffer: vk::Buffer(1),
        offset: 2,
        size: 3,
        ty: vk::AccelerationStructureType::BOTTOM_LEVEL,
        device_address: vk::DeviceAddress(4),
        ..Default::default()
    };
    assert_eq!(vk::AccelerationStructureCreateInfo::from(&create), expected);
}
