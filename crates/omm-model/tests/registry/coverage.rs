//! Everything that `omm_model::vk` has, by Vulkan name.

use omm_model::vk::*;
use serde_json::Value;

/// Which constants of an enumeration the model has to have.
#[derive(Clone, Copy)]
pub(crate) enum Scope {
    /// All that the registry has.
    Whole,
    /// Those of its definition, of core versions and of the extensions in scope.
    Own,
    /// Those of the extensions in scope; the type is larger than the model's subject.
    Named,
}

/// An enumeration, or the bits of a set of flags.
#[derive(Clone)]
pub(crate) struct Enumeration {
    /// Its Vulkan name.
    pub(crate) name: &'static str,
    /// Which constants the model has to have.
    pub(crate) scope: Scope,
    /// The names and values of those it has, the canonical name of each value first.
    pub(crate) constants: &'static [(&'static str, i64)],
    /// The identifier of our constant of a value.
    pub(crate) identifier: fn(i64) -> String,
}

/// What the model has, by Vulkan name.
pub(crate) struct Coverage {
    /// Enumerations and bits of flags.
    pub(crate) enumerations: Vec<Enumeration>,
    /// Structures with their default.
    pub(crate) structures: Vec<(&'static str, Value)>,
    /// Unions with one value of each variant.
    pub(crate) unions: Vec<(&'static str, Vec<Value>)>,
    /// Handles with their object type.
    pub(crate) handles: Vec<(&'static str, ObjectType)>,
}

macro_rules! enums {
    ($($name:ident $type:ident $scope:ident,)*) => {
        vec![$(Enumeration {
            name: stringify!($name),
            scope: Scope::$scope,
            constants: $type::NAMES,
            identifier: |value| format!("{:?}", $type(value.try_into().unwrap())),
        }),*]
    };
}

macro_rules! flags {
    ($($name:ident $type:ident $scope:ident,)*) => {
        vec![$(Enumeration {
            name: stringify!($name),
            scope: Scope::$scope,
            constants: $type::NAMES,
            identifier: |value| $type::from_bits_retain(value.try_into().unwrap()).iter_names().map(|(name, _)| name).collect(),
        }),*]
    };
}

macro_rules! structures {
    ($($name:ident $type:ident,)*) => {
        vec![$((stringify!($name), serde_json::to_value($type::default()).unwrap())),*]
    };
}

macro_rules! unions {
    ($($name:ident [$($variant:expr),* $(,)?],)*) => {
        vec![$((stringify!($name), vec![$(serde_json::to_value($variant).unwrap()),*])),*]
    };
}

macro_rules! handles {
    ($($name:ident $type:ident,)*) => { vec![$((stringify!($name), $type::OBJECT_TYPE)),*] };
}

pub(crate) fn coverage() -> Coverage {
    Coverage {
        enumerations: [
            enums! {
                VkAccelerationStructureBuildTypeKHR AccelerationStructureBuildType Own,
                VkAccelerationStructureCompatibilityKHR AccelerationStructureCompatibility Own,
                VkAccelerationStructureMotionInstanceTypeNV MotionInstanceType Own,
                VkAccelerationStructureSerializedBlockTypeKHR AccelerationStructureSerializedBlockType Own,
                VkAccelerationStructureTypeKHR AccelerationStructureType Own,
                VkBuildAccelerationStructureModeKHR BuildAccelerationStructureMode Own,
                VkBuildMicromapModeEXT BuildMicromapMode Own,
                VkCommandBufferLevel CommandBufferLevel Own,
                VkCopyAccelerationStructureModeKHR CopyAccelerationStructureMode Own,
                VkCopyMicromapModeEXT CopyMicromapMode Own,
                VkDescriptorType DescriptorType Named,
                VkFormat Format Named,
                VkGeometryTypeKHR GeometryType Own,
                VkIndexType IndexType Own,
                VkMicromapTypeEXT MicromapType Own,
                VkObjectType ObjectType Named,
                VkOpacityMicromapFormatKHR OpacityMicromapFormat Own,
                VkOpacityMicromapSpecialIndexKHR OpacityMicromapSpecialIndex Own,
                VkQueryType QueryType Own,
                VkResult Result Own,
                VkSharingMode SharingMode Own,
                VkStructureType StructureType Named,
            },
            flags! {
                VkAccelerationStructureCreateFlagBitsKHR AccelerationStructureCreateFlags Own,
                VkAccelerationStructureMotionInfoFlagsNV AccelerationStructureMotionInfoFlags Own,
                VkAccelerationStructureMotionInstanceFlagsNV MotionInstanceFlags Own,
                VkAccessFlagBits AccessFlags Named,
                VkAccessFlagBits2 AccessFlags2 Named,
                VkAddressCommandFlagBitsKHR AddressCommandFlags Own,
                VkBufferCreateFlagBits BufferCreateFlags Own,
                VkBufferUsageFlagBits BufferUsageFlags Whole,
                VkBufferUsageFlagBits2 BufferUsageFlags2 Named,
                VkBuildAccelerationStructureFlagBitsKHR BuildAccelerationStructureFlags Own,
                VkBuildMicromapFlagBitsEXT BuildMicromapFlags Own,
                VkCommandBufferResetFlagBits CommandBufferResetFlags Own,
                VkCommandBufferUsageFlagBits CommandBufferUsageFlags Own,
                VkCommandPoolCreateFlagBits CommandPoolCreateFlags Own,
                VkFormatFeatureFlagBits FormatFeatureFlags Named,
                VkFormatFeatureFlagBits2 FormatFeatureFlags2 Named,
                VkGeometryFlagBitsKHR GeometryFlags Own,
                VkGeometryInstanceFlagBitsKHR GeometryInstanceFlags Own,
                VkMemoryAllocateFlagBits MemoryAllocateFlags Own,
                VkMemoryHeapFlagBits MemoryHeapFlags Own,
                VkMemoryPropertyFlagBits MemoryPropertyFlags Own,
                VkMicromapCreateFlagBitsEXT MicromapCreateFlags Own,
                VkPipelineCreateFlagBits PipelineCreateFlags Named,
                VkPipelineCreateFlagBits2 PipelineCreateFlags2 Named,
                VkPipelineStageFlagBits PipelineStageFlags Named,
                VkPipelineStageFlagBits2 PipelineStageFlags2 Named,
                VkQueryControlFlagBits QueryControlFlags Own,
                VkQueryPipelineStatisticFlagBits QueryPipelineStatisticFlags Named,
                VkQueryPoolCreateFlagBits QueryPoolCreateFlags Own,
                VkQueryResultFlagBits QueryResultFlags Own,
                VkQueueFlagBits QueueFlags Own,
                VkRenderingFlagBits RenderingFlags Own,
                VkShaderCreateFlagBitsEXT ShaderCreateFlags Named,
                VkSparseMemoryBindFlagBits SparseMemoryBindFlags Own,
            },
        ]
        .concat(),
        structures: structures! {
            VkAabbPositionsKHR AabbPositions,
            VkAccelerationStructureBuildGeometryInfoKHR BuildGeometryInfo,
            VkAccelerationStructureBuildRangeInfoKHR BuildRangeInfo,
            VkAccelerationStructureBuildSizesInfoKHR BuildSizesInfo,
            VkAccelerationStructureCreateInfo2KHR AccelerationStructureCreateInfo2,
            VkAccelerationStructureCreateInfoKHR AccelerationStructureCreateInfo,
            VkAccelerationStructureDeviceAddressInfoKHR AccelerationStructureDeviceAddressInfo,
            VkAccelerationStructureGeometryAabbsDataKHR GeometryAabbsData,
            VkAccelerationStructureGeometryInstancesDataKHR GeometryInstancesData,
            VkAccelerationStructureGeometryKHR Geometry,
            VkAccelerationStructureGeometryMicromapDataKHR GeometryMicromapData,
            VkAccelerationStructureGeometryMotionTrianglesDataNV GeometryMotionTrianglesData,
            VkAccelerationStructureGeometryTrianglesDataKHR GeometryTrianglesData,
            VkAccelerationStructureInstanceKHR Instance,
            VkAccelerationStructureMatrixMotionInstanceNV MatrixMotionInstance,
            VkAccelerationStructureMotionInfoNV AccelerationStructureMotionInfo,
            VkAccelerationStructureMotionInstanceNV MotionInstance,
            VkAccelerationStructureSRTMotionInstanceNV SrtMotionInstance,
            VkAccelerationStructureTrianglesOpacityMicromapEXT TrianglesOpacityMicromapExt,
            VkAccelerationStructureTrianglesOpacityMicromapKHR TrianglesOpacityMicromap,
            VkAccelerationStructureVersionInfoKHR AccelerationStructureVersionInfo,
            VkBufferCreateInfo BufferCreateInfo,
            VkBufferDeviceAddressInfo BufferDeviceAddressInfo,
            VkCommandBufferAllocateInfo CommandBufferAllocateInfo,
            VkCommandBufferBeginInfo CommandBufferBeginInfo,
            VkCommandBufferInheritanceInfo CommandBufferInheritanceInfo,
            VkCommandPoolCreateInfo CommandPoolCreateInfo,
            VkCopyAccelerationStructureInfoKHR CopyAccelerationStructureInfo,
            VkCopyAccelerationStructureToMemoryInfoKHR CopyAccelerationStructureToMemoryInfo,
            VkCopyMemoryToAccelerationStructureInfoKHR CopyMemoryToAccelerationStructureInfo,
            VkCopyMemoryToMicromapInfoEXT CopyMemoryToMicromapInfo,
            VkCopyMicromapInfoEXT CopyMicromapInfo,
            VkCopyMicromapToMemoryInfoEXT CopyMicromapToMemoryInfo,
            VkDeviceAddressRangeKHR DeviceAddressRange,
            VkDeviceGroupDeviceCreateInfo DeviceGroupDeviceCreateInfo,
            VkMemoryAllocateFlagsInfo MemoryAllocateFlagsInfo,
            VkMemoryAllocateInfo MemoryAllocateInfo,
            VkMemoryHeap MemoryHeap,
            VkMemoryType MemoryType,
            VkMicromapBuildInfoEXT MicromapBuildInfo,
            VkMicromapBuildSizesInfoEXT MicromapBuildSizesInfo,
            VkMicromapCreateInfoEXT MicromapCreateInfo,
            VkMicromapTriangleKHR MicromapTriangle,
            VkMicromapUsageEXT MicromapUsageExt,
            VkMicromapUsageKHR MicromapUsage,
            VkMicromapVersionInfoEXT MicromapVersionInfo,
            VkPhysicalDeviceAccelerationStructureFeaturesKHR AccelerationStructureFeatures,
            VkPhysicalDeviceAccelerationStructurePropertiesKHR AccelerationStructureProperties,
            VkPhysicalDeviceOpacityMicromapFeaturesEXT OpacityMicromapFeaturesExt,
            VkPhysicalDeviceOpacityMicromapFeaturesKHR OpacityMicromapFeatures,
            VkPhysicalDeviceOpacityMicromapPropertiesEXT OpacityMicromapPropertiesExt,
            VkPhysicalDeviceOpacityMicromapPropertiesKHR OpacityMicromapProperties,
            VkPhysicalDeviceRayTracingMotionBlurFeaturesNV RayTracingMotionBlurFeatures,
            VkQueryPoolCreateInfo QueryPoolCreateInfo,
            VkSparseBufferMemoryBindInfo SparseBufferMemoryBindInfo,
            VkSparseMemoryBind SparseMemoryBind,
            VkSRTDataNV SrtData,
            VkTransformMatrixKHR TransformMatrix,
            VkWriteDescriptorSetAccelerationStructureKHR WriteDescriptorSetAccelerationStructure,
        },
        unions: unions! {
            VkAccelerationStructureGeometryDataKHR [
                GeometryData::Triangles(GeometryTrianglesData::default()),
                GeometryData::Aabbs(GeometryAabbsData::default()),
                GeometryData::Instances(GeometryInstancesData::default()),
            ],
            VkAccelerationStructureMotionInstanceDataNV [
                MotionInstanceData::StaticInstance(Instance::default()),
                MotionInstanceData::MatrixMotionInstance(MatrixMotionInstance::default()),
                MotionInstanceData::SrtMotionInstance(SrtMotionInstance::default()),
            ],
            VkDeviceOrHostAddressKHR [
                DeviceOrHostAddress::DeviceAddress(DeviceAddress::NULL),
                DeviceOrHostAddress::HostAddress(HostAddress::NULL),
            ],
            VkDeviceOrHostAddressConstKHR [
                DeviceOrHostAddress::DeviceAddress(DeviceAddress::NULL),
                DeviceOrHostAddress::HostAddress(HostAddress::NULL),
            ],
        },
        handles: handles! {
            VkAccelerationStructureKHR AccelerationStructure,
            VkBuffer Buffer,
            VkCommandBuffer CommandBuffer,
            VkCommandPool CommandPool,
            VkDeferredOperationKHR DeferredOperation,
            VkDevice Device,
            VkDeviceMemory DeviceMemory,
            VkFramebuffer Framebuffer,
            VkMicromapEXT Micromap,
            VkPhysicalDevice PhysicalDevice,
            VkPipeline Pipeline,
            VkQueryPool QueryPool,
            VkQueue Queue,
            VkRenderPass RenderPass,
            VkShaderEXT Shader,
        },
    }
}
