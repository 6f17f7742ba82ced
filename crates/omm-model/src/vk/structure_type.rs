//! The number that each structure begins with.

use super::enumerant::open_enum;

open_enum! {
    /// Which structure this is:
    /// [`VkStructureType`](https://docs.vulkan.org/refpages/latest/refpages/source/VkStructureType.html).
    ///
    /// The constants are those of the structures of this module.
    #[doc(alias = "VkStructureType")]
    pub struct StructureType {
        /// [`MemoryAllocateInfo`](super::MemoryAllocateInfo).
        MEMORY_ALLOCATE_INFO = 5, "VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO";
        /// [`QueryPoolCreateInfo`](super::QueryPoolCreateInfo).
        QUERY_POOL_CREATE_INFO = 11, "VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO";
        /// [`BufferCreateInfo`](super::BufferCreateInfo).
        BUFFER_CREATE_INFO = 12, "VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO";
        /// [`CommandPoolCreateInfo`](super::CommandPoolCreateInfo).
        COMMAND_POOL_CREATE_INFO = 39, "VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO";
        /// [`CommandBufferAllocateInfo`](super::CommandBufferAllocateInfo).
        COMMAND_BUFFER_ALLOCATE_INFO = 40, "VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO";
        /// [`CommandBufferInheritanceInfo`](super::CommandBufferInheritanceInfo).
        COMMAND_BUFFER_INHERITANCE_INFO = 41, "VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO";
        /// [`CommandBufferBeginInfo`](super::CommandBufferBeginInfo).
        COMMAND_BUFFER_BEGIN_INFO = 42, "VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO";
        /// [`MemoryAllocateFlagsInfo`](super::MemoryAllocateFlagsInfo).
        MEMORY_ALLOCATE_FLAGS_INFO = 1_000_060_000, "VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO";
        /// [`DeviceGroupDeviceCreateInfo`](super::DeviceGroupDeviceCreateInfo).
        DEVICE_GROUP_DEVICE_CREATE_INFO = 1_000_070_001, "VK_STRUCTURE_TYPE_DEVICE_GROUP_DEVICE_CREATE_INFO";
        /// [`BuildGeometryInfo`](super::BuildGeometryInfo).
        ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO = 1_000_150_000,
            "VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR";
        /// [`AccelerationStructureDeviceAddressInfo`](super::AccelerationStructureDeviceAddressInfo).
        ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO = 1_000_150_002,
            "VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR";
        /// [`GeometryAabbsData`](super::GeometryAabbsData).
        ACCELERATION_STRUCTURE_GEOMETRY_AABBS_DATA = 1_000_150_003,
            "VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_AABBS_DATA_KHR";
        /// [`GeometryInstancesData`](super::GeometryInstancesData).
        ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA = 1_000_150_004,
            "VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR";
        /// [`GeometryTrianglesData`](super::GeometryTrianglesData).
        ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA = 1_000_150_005,
            "VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR";
        /// [`Geometry`](super::Geometry).
        ACCELERATION_STRUCTURE_GEOMETRY = 1_000_150_006, "VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR";
        /// [`WriteDescriptorSetAccelerationStructure`](super::WriteDescriptorSetAccelerationStructure).
        WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE = 1_000_150_007,
            "VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR";
        /// [`AccelerationStructureVersionInfo`](super::AccelerationStructureVersionInfo).
        ACCELERATION_STRUCTURE_VERSION_INFO = 1_000_150_009,
            "VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_VERSION_INFO_KHR";
        /// [`CopyAccelerationStructureInfo`](super::CopyAccelerationStructureInfo).
        COPY_ACCELERATION_STRUCTURE_INFO = 1_000_150_010, "VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR";
        /// [`CopyAccelerationStructureToMemoryInfo`](super::CopyAccelerationStructureToMemoryInfo).
        COPY_ACCELERATION_STRUCTURE_TO_MEMORY_INFO = 1_000_150_011,
            "VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_TO_MEMORY_INFO_KHR";
        /// [`CopyMemoryToAccelerationStructureInfo`](super::CopyMemoryToAccelerationStructureInfo).
        COPY_MEMORY_TO_ACCELERATION_STRUCTURE_INFO = 1_000_150_012,
            "VK_STRUCTURE_TYPE_COPY_MEMORY_TO_ACCELERATION_STRUCTURE_INFO_KHR";
        /// [`AccelerationStructureFeatures`](super::AccelerationStructureFeatures).
        PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES = 1_000_150_013,
            "VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR";
        /// [`AccelerationStructureProperties`](super::AccelerationStructureProperties).
        PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES = 1_000_150_014,
            "VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR";
        /// [`AccelerationStructureCreateInfo`](super::AccelerationStructureCreateInfo).
        ACCELERATION_STRUCTURE_CREATE_INFO = 1_000_150_017, "VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR";
        /// [`BuildSizesInfo`](super::BuildSizesInfo).
        ACCELERATION_STRUCTURE_BUILD_SIZES_INFO = 1_000_150_020,
            "VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR";
        /// [`BufferDeviceAddressInfo`](super::BufferDeviceAddressInfo).
        BUFFER_DEVICE_ADDRESS_INFO = 1_000_244_001, "VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO";
        /// [`AccelerationStructureCreateInfo2`](super::AccelerationStructureCreateInfo2).
        ACCELERATION_STRUCTURE_CREATE_INFO_2 = 1_000_318_015,
            "VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_2_KHR";
        /// [`GeometryMotionTrianglesData`](super::GeometryMotionTrianglesData).
        ACCELERATION_STRUCTURE_GEOMETRY_MOTION_TRIANGLES_DATA = 1_000_327_000,
            "VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_MOTION_TRIANGLES_DATA_NV";
        /// [`RayTracingMotionBlurFeatures`](super::RayTracingMotionBlurFeatures).
        PHYSICAL_DEVICE_RAY_TRACING_MOTION_BLUR_FEATURES = 1_000_327_001,
            "VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_MOTION_BLUR_FEATURES_NV";
        /// [`AccelerationStructureMotionInfo`](super::AccelerationStructureMotionInfo).
        ACCELERATION_STRUCTURE_MOTION_INFO = 1_000_327_002, "VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_MOTION_INFO_NV";
        /// [`MicromapBuildInfo`](super::MicromapBuildInfo).
        MICROMAP_BUILD_INFO = 1_000_396_000, "VK_STRUCTURE_TYPE_MICROMAP_BUILD_INFO_EXT";
        /// [`MicromapVersionInfo`](super::MicromapVersionInfo).
        MICROMAP_VERSION_INFO = 1_000_396_001, "VK_STRUCTURE_TYPE_MICROMAP_VERSION_INFO_EXT";
        /// [`CopyMicromapInfo`](super::CopyMicromapInfo).
        COPY_MICROMAP_INFO = 1_000_396_002, "VK_STRUCTURE_TYPE_COPY_MICROMAP_INFO_EXT";
        /// [`CopyMicromapToMemoryInfo`](super::CopyMicromapToMemoryInfo).
        COPY_MICROMAP_TO_MEMORY_INFO = 1_000_396_003, "VK_STRUCTURE_TYPE_COPY_MICROMAP_TO_MEMORY_INFO_EXT";
        /// [`CopyMemoryToMicromapInfo`](super::CopyMemoryToMicromapInfo).
        COPY_MEMORY_TO_MICROMAP_INFO = 1_000_396_004, "VK_STRUCTURE_TYPE_COPY_MEMORY_TO_MICROMAP_INFO_EXT";
        /// [`OpacityMicromapFeaturesExt`](super::OpacityMicromapFeaturesExt).
        PHYSICAL_DEVICE_OPACITY_MICROMAP_FEATURES_EXT = 1_000_396_005,
            "VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_OPACITY_MICROMAP_FEATURES_EXT";
        /// [`OpacityMicromapPropertiesExt`](super::OpacityMicromapPropertiesExt).
        PHYSICAL_DEVICE_OPACITY_MICROMAP_PROPERTIES_EXT = 1_000_396_006,
            "VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_OPACITY_MICROMAP_PROPERTIES_EXT";
        /// [`MicromapCreateInfo`](super::MicromapCreateInfo).
        MICROMAP_CREATE_INFO = 1_000_396_007, "VK_STRUCTURE_TYPE_MICROMAP_CREATE_INFO_EXT";
        /// [`MicromapBuildSizesInfo`](super::MicromapBuildSizesInfo).
        MICROMAP_BUILD_SIZES_INFO = 1_000_396_008, "VK_STRUCTURE_TYPE_MICROMAP_BUILD_SIZES_INFO_EXT";
        /// [`TrianglesOpacityMicromapExt`](super::TrianglesOpacityMicromapExt).
        ACCELERATION_STRUCTURE_TRIANGLES_OPACITY_MICROMAP_EXT = 1_000_396_009,
            "VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_TRIANGLES_OPACITY_MICROMAP_EXT";
        /// [`OpacityMicromapFeatures`](super::OpacityMicromapFeatures).
        PHYSICAL_DEVICE_OPACITY_MICROMAP_FEATURES = 1_000_623_000,
            "VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_OPACITY_MICROMAP_FEATURES_KHR";
        /// [`OpacityMicromapProperties`](super::OpacityMicromapProperties).
        PHYSICAL_DEVICE_OPACITY_MICROMAP_PROPERTIES = 1_000_623_001,
            "VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_OPACITY_MICROMAP_PROPERTIES_KHR";
        /// [`GeometryMicromapData`](super::GeometryMicromapData).
        ACCELERATION_STRUCTURE_GEOMETRY_MICROMAP_DATA = 1_000_623_002,
            "VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_MICROMAP_DATA_KHR";
        /// [`TrianglesOpacityMicromap`](super::TrianglesOpacityMicromap).
        ACCELERATION_STRUCTURE_TRIANGLES_OPACITY_MICROMAP = 1_000_623_003,
            "VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_TRIANGLES_OPACITY_MICROMAP_KHR";
    }
}
