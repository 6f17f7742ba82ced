//! The API's structures by name, as they are before an application fills them in.

use omm_model::call::{
    DeviceCreateInfo, DeviceQueueCreateInfo, PhysicalDeviceFeatures2, PhysicalDeviceProperties2,
    RayTracingPipelineCreateInfo, RenderingInfo, ShaderCreateInfo,
};
use omm_model::vk;
use serde::Serialize;

use crate::tree::{Tree, TreeError};

/// A structure's name in the API, its name in the model, and how to make one.
struct Structure {
    name: &'static str,
    model: &'static str,
    make: fn() -> Result<Tree, TreeError>,
    /// Whether it can stand in a chain.
    chained: bool,
}

fn empty<T: Default + Serialize>() -> Result<Tree, TreeError> {
    Tree::of(&T::default())
}

fn chained<T: Default + Into<vk::ChainStructure>>() -> Result<Tree, TreeError> {
    Tree::of(&T::default().into())
}

/// A table of structures: `plain` ones, and those that can stand in a chain.
macro_rules! structures {
    (plain { $($plain:ident as $plain_name:literal,)* } chained { $($chained:ident as $chained_name:literal,)* }) => {
        const STRUCTURES: &[Structure] = &[
            $(Structure { name: $plain_name, model: stringify!($plain), make: empty::<$plain>, chained: false },)*
            $(Structure {
                name: $chained_name,
                model: stringify!($chained),
                make: chained::<vk::$chained>,
                chained: true,
            },)*
        ];
    };
}

use vk::{
    AccelerationStructureCreateInfo, AccelerationStructureCreateInfo2, AccelerationStructureDeviceAddressInfo,
    AccelerationStructureVersionInfo, BufferCreateInfo, BufferDeviceAddressInfo, BuildGeometryInfo, BuildRangeInfo,
    CommandBufferAllocateInfo, CommandBufferBeginInfo, CommandBufferInheritanceInfo, CommandPoolCreateInfo,
    CopyAccelerationStructureInfo, CopyAccelerationStructureToMemoryInfo, CopyMemoryToAccelerationStructureInfo,
    CopyMemoryToMicromapInfo, CopyMicromapInfo, CopyMicromapToMemoryInfo, DeviceAddressRange, Geometry,
    GeometryAabbsData, GeometryInstancesData, GeometryTrianglesData, MemoryAllocateInfo, MicromapBuildInfo,
    MicromapCreateInfo, MicromapUsage, MicromapUsageExt, MicromapVersionInfo, QueryPoolCreateInfo,
    SparseBufferMemoryBindInfo, SparseMemoryBind,
};

structures! {
    plain {
    AccelerationStructureCreateInfo as "VkAccelerationStructureCreateInfoKHR",
    AccelerationStructureCreateInfo2 as "VkAccelerationStructureCreateInfo2KHR",
    AccelerationStructureDeviceAddressInfo as "VkAccelerationStructureDeviceAddressInfoKHR",
    AccelerationStructureVersionInfo as "VkAccelerationStructureVersionInfoKHR",
    BufferCreateInfo as "VkBufferCreateInfo",
    BufferDeviceAddressInfo as "VkBufferDeviceAddressInfo",
    BuildGeometryInfo as "VkAccelerationStructureBuildGeometryInfoKHR",
    BuildRangeInfo as "VkAccelerationStructureBuildRangeInfoKHR",
    CommandBufferAllocateInfo as "VkCommandBufferAllocateInfo",
    CommandBufferBeginInfo as "VkCommandBufferBeginInfo",
    CommandBufferInheritanceInfo as "VkCommandBufferInheritanceInfo",
    CommandPoolCreateInfo as "VkCommandPoolCreateInfo",
    CopyAccelerationStructureInfo as "VkCopyAccelerationStructureInfoKHR",
    CopyAccelerationStructureToMemoryInfo as "VkCopyAccelerationStructureToMemoryInfoKHR",
    CopyMemoryToAccelerationStructureInfo as "VkCopyMemoryToAccelerationStructureInfoKHR",
    CopyMemoryToMicromapInfo as "VkCopyMemoryToMicromapInfoEXT",
    CopyMicromapInfo as "VkCopyMicromapInfoEXT",
    CopyMicromapToMemoryInfo as "VkCopyMicromapToMemoryInfoEXT",
    DeviceAddressRange as "VkDeviceAddressRangeKHR",
    DeviceCreateInfo as "VkDeviceCreateInfo",
    DeviceQueueCreateInfo as "VkDeviceQueueCreateInfo",
    Geometry as "VkAccelerationStructureGeometryKHR",
    GeometryAabbsData as "VkAccelerationStructureGeometryAabbsDataKHR",
    GeometryInstancesData as "VkAccelerationStructureGeometryInstancesDataKHR",
    GeometryTrianglesData as "VkAccelerationStructureGeometryTrianglesDataKHR",
    MemoryAllocateInfo as "VkMemoryAllocateInfo",
    MicromapBuildInfo as "VkMicromapBuildInfoEXT",
    MicromapCreateInfo as "VkMicromapCreateInfoEXT",
    MicromapUsage as "VkMicromapUsageKHR",
    MicromapUsageExt as "VkMicromapUsageEXT",
    MicromapVersionInfo as "VkMicromapVersionInfoEXT",
    PhysicalDeviceFeatures2 as "VkPhysicalDeviceFeatures2",
    PhysicalDeviceProperties2 as "VkPhysicalDeviceProperties2",
    QueryPoolCreateInfo as "VkQueryPoolCreateInfo",
    RayTracingPipelineCreateInfo as "VkRayTracingPipelineCreateInfoKHR",
    RenderingInfo as "VkRenderingInfo",
    ShaderCreateInfo as "VkShaderCreateInfoEXT",
    SparseBufferMemoryBindInfo as "VkSparseBufferMemoryBindInfo",
    SparseMemoryBind as "VkSparseMemoryBind",
    }
    chained {
    AccelerationStructureFeatures as "VkPhysicalDeviceAccelerationStructureFeaturesKHR",
    AccelerationStructureMotionInfo as "VkAccelerationStructureMotionInfoNV",
    AccelerationStructureProperties as "VkPhysicalDeviceAccelerationStructurePropertiesKHR",
    DeviceGroupDeviceCreateInfo as "VkDeviceGroupDeviceCreateInfo",
    GeometryMicromapData as "VkAccelerationStructureGeometryMicromapDataKHR",
    GeometryMotionTrianglesData as "VkAccelerationStructureGeometryMotionTrianglesDataNV",
    MemoryAllocateFlagsInfo as "VkMemoryAllocateFlagsInfo",
    OpacityMicromapFeatures as "VkPhysicalDeviceOpacityMicromapFeaturesKHR",
    OpacityMicromapFeaturesExt as "VkPhysicalDeviceOpacityMicromapFeaturesEXT",
    OpacityMicromapProperties as "VkPhysicalDeviceOpacityMicromapPropertiesKHR",
    OpacityMicromapPropertiesExt as "VkPhysicalDeviceOpacityMicromapPropertiesEXT",
    RayTracingMotionBlurFeatures as "VkPhysicalDeviceRayTracingMotionBlurFeaturesNV",
    TrianglesOpacityMicromap as "VkAccelerationStructureTrianglesOpacityMicromapKHR",
    TrianglesOpacityMicromapExt as "VkAccelerationStructureTrianglesOpacityMicromapEXT",
    WriteDescriptorSetAccelerationStructure as "VkWriteDescriptorSetAccelerationStructureKHR",
    }
}

/// The structure of that name in the API, all of it zero but its type; one that can stand in a chain as an entry of a chain.
pub(crate) fn named(name: &str) -> Option<Tree> {
    let found = STRUCTURES.iter().find(|structure| structure.name == name)?;
    (found.make)().ok()
}

/// A structure that only its type is known of, as an entry of a chain.
pub(crate) fn unknown(structure_type: i32) -> Option<Tree> {
    Tree::of(&vk::ChainStructure::Unknown(vk::StructureType(structure_type))).ok()
}

/// The names of all structures.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    STRUCTURES.iter().map(|structure| structure.name)
}

/// What the API calls an entry of a chain.
pub(crate) fn chained_name(entry: &Tree) -> Option<&'static str> {
    let Tree::Variant("ChainStructure", variant, _) = entry else { return None };
    STRUCTURES.iter().find(|structure| structure.chained && structure.model == *variant).map(|found| found.name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_structure_can_be_made_and_goes_by_its_name() {
        for structure in STRUCTURES {
            let tree = named(structure.name).unwrap();
            match &tree {
                Tree::Struct(model, _) => assert_eq!(*model, structure.model),
                Tree::Variant(..) => assert_eq!(chained_name(&tree), Some(structure.name)),
                other => panic!("{other:?}"),
            }
        }
        assert!(named("VkNone").is_none());
        assert_eq!(chained_name(&unknown(7).unwrap()), None);
    }
}
