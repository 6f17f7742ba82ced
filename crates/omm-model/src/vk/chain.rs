//! `pNext` chains and the structures that can carry one.

use serde::{Deserialize, Serialize};

use super::*;

/// What a structure's `pNext` points to: every structure of the chain, in order.
///
/// The list is flat. A structure that stands in a chain has an empty `next` of its own, because what its `pNext` would point
/// to is the following entry of the same list.
pub type Chain = Vec<ChainStructure>;

/// One structure of a `pNext` chain.
///
/// The variant says which structure the application put there; `s_type` inside it says what the application claims it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ChainStructure {
    /// Input of a micromap build; extends [`Geometry`].
    GeometryMicromapData(GeometryMicromapData),
    /// A micromap attached to triangles; extends [`GeometryTrianglesData`].
    TrianglesOpacityMicromap(TrianglesOpacityMicromap),
    /// A micromap object of the EXT extension attached to triangles; extends [`GeometryTrianglesData`].
    TrianglesOpacityMicromapExt(TrianglesOpacityMicromapExt),
    /// Vertex positions at the end of the motion; extends [`GeometryTrianglesData`].
    GeometryMotionTrianglesData(GeometryMotionTrianglesData),
    /// Size of a structure with motion; extends [`AccelerationStructureCreateInfo`].
    AccelerationStructureMotionInfo(AccelerationStructureMotionInfo),
    /// Flags of a memory allocation; extends [`MemoryAllocateInfo`].
    MemoryAllocateFlagsInfo(MemoryAllocateFlagsInfo),
    /// Acceleration structures to write to descriptors; extends `VkWriteDescriptorSet`.
    WriteDescriptorSetAccelerationStructure(WriteDescriptorSetAccelerationStructure),
    /// Features of the KHR micromap extension; extends `VkPhysicalDeviceFeatures2` and `VkDeviceCreateInfo`.
    OpacityMicromapFeatures(OpacityMicromapFeatures),
    /// Features of the EXT micromap extension; extends `VkPhysicalDeviceFeatures2` and `VkDeviceCreateInfo`.
    OpacityMicromapFeaturesExt(OpacityMicromapFeaturesExt),
    /// Features of acceleration structures; extends `VkPhysicalDeviceFeatures2` and `VkDeviceCreateInfo`.
    AccelerationStructureFeatures(AccelerationStructureFeatures),
    /// Features of motion blur; extends `VkPhysicalDeviceFeatures2` and `VkDeviceCreateInfo`.
    RayTracingMotionBlurFeatures(RayTracingMotionBlurFeatures),
    /// The physical devices of a device group; extends `VkDeviceCreateInfo`.
    DeviceGroupDeviceCreateInfo(DeviceGroupDeviceCreateInfo),
    /// Limits of the KHR micromap extension; extends `VkPhysicalDeviceProperties2`.
    OpacityMicromapProperties(OpacityMicromapProperties),
    /// Limits of the EXT micromap extension; extends `VkPhysicalDeviceProperties2`.
    OpacityMicromapPropertiesExt(OpacityMicromapPropertiesExt),
    /// Limits of acceleration structures; extends `VkPhysicalDeviceProperties2`.
    AccelerationStructureProperties(AccelerationStructureProperties),
    /// A structure that this model does not describe, of which only the type is known.
    Unknown(StructureType),
}

impl ChainStructure {
    /// The structure type that the structure claims to have.
    pub fn s_type(&self) -> StructureType {
        match self {
            Self::GeometryMicromapData(structure) => structure.s_type,
            Self::TrianglesOpacityMicromap(structure) => structure.s_type,
            Self::TrianglesOpacityMicromapExt(structure) => structure.s_type,
            Self::GeometryMotionTrianglesData(structure) => structure.s_type,
            Self::AccelerationStructureMotionInfo(structure) => structure.s_type,
            Self::MemoryAllocateFlagsInfo(structure) => structure.s_type,
            Self::WriteDescriptorSetAccelerationStructure(structure) => structure.s_type,
            Self::OpacityMicromapFeatures(structure) => structure.s_type,
            Self::OpacityMicromapFeaturesExt(structure) => structure.s_type,
            Self::AccelerationStructureFeatures(structure) => structure.s_type,
            Self::RayTracingMotionBlurFeatures(structure) => structure.s_type,
            Self::DeviceGroupDeviceCreateInfo(structure) => structure.s_type,
            Self::OpacityMicromapProperties(structure) => structure.s_type,
            Self::OpacityMicromapPropertiesExt(structure) => structure.s_type,
            Self::AccelerationStructureProperties(structure) => structure.s_type,
            Self::Unknown(s_type) => *s_type,
        }
    }
}

/// Lets a structure be put into a chain with `into()`.
macro_rules! into_chain {
    ($($structure:ident),* $(,)?) => {$(
        impl From<$structure> for ChainStructure {
            fn from(structure: $structure) -> Self {
                Self::$structure(structure)
            }
        }
    )*};
}

into_chain! {
    GeometryMicromapData,
    TrianglesOpacityMicromap,
    TrianglesOpacityMicromapExt,
    GeometryMotionTrianglesData,
    AccelerationStructureMotionInfo,
    MemoryAllocateFlagsInfo,
    WriteDescriptorSetAccelerationStructure,
    OpacityMicromapFeatures,
    OpacityMicromapFeaturesExt,
    AccelerationStructureFeatures,
    RayTracingMotionBlurFeatures,
    DeviceGroupDeviceCreateInfo,
    OpacityMicromapProperties,
    OpacityMicromapPropertiesExt,
    AccelerationStructureProperties,
}

/// Declares a structure that begins with `sType` and `pNext`.
///
/// The name behind the structure's is its [`StructureType`] constant; `Default` fills that in and leaves all else zero.
macro_rules! extensible {
    (
        $(#[$meta:meta])*
        pub struct $structure:ident: $s_type:ident {
            $( $(#[$field_meta:meta])* pub $field:ident: $type:ty, )*
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
        pub struct $structure {
            /// The type that the structure claims to have; right is [`Self::S_TYPE`].
            #[doc(alias = "sType")]
            pub s_type: $crate::vk::StructureType,
            /// The structures that extend this one.
            #[doc(alias = "pNext")]
            pub next: $crate::vk::Chain,
            $( $(#[$field_meta])* pub $field: $type, )*
        }

        impl $structure {
            /// The structure type that a structure of this kind has to carry.
            pub const S_TYPE: $crate::vk::StructureType = $crate::vk::StructureType::$s_type;
        }

        impl Default for $structure {
            fn default() -> Self {
                Self {
                    s_type: Self::S_TYPE,
                    next: $crate::vk::Chain::new(),
                    $( $field: Default::default(), )*
                }
            }
        }
    };
}

pub(super) use extensible;
