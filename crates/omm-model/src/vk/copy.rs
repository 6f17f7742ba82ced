//! Copies: clone, compact, serialize, deserialize, and whether serialized bytes can be read.

use super::chain::extensible;
use super::enumerant::open_enum;
use super::*;

/// Bytes in a driver or compatibility UUID: `VK_UUID_SIZE`.
#[doc(alias = "VK_UUID_SIZE")]
pub const UUID_SIZE: usize = 16;

open_enum! {
    /// What a copy of an acceleration structure does:
    /// [`VkCopyAccelerationStructureModeKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCopyAccelerationStructureModeKHR.html).
    #[doc(alias = "VkCopyAccelerationStructureModeKHR")]
    #[doc(alias = "VkCopyAccelerationStructureModeNV")]
    pub struct CopyAccelerationStructureMode {
        /// Makes a structure with the same content.
        CLONE = 0, "VK_COPY_ACCELERATION_STRUCTURE_MODE_CLONE_KHR";
        /// Makes a smaller structure with the same content.
        COMPACT = 1, "VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR";
        /// Writes the structure to memory in a form that outlives the device.
        SERIALIZE = 2, "VK_COPY_ACCELERATION_STRUCTURE_MODE_SERIALIZE_KHR";
        /// Reads a structure from that form.
        DESERIALIZE = 3, "VK_COPY_ACCELERATION_STRUCTURE_MODE_DESERIALIZE_KHR";
    }
}

open_enum! {
    /// Whether a device can read a serialized acceleration structure or micromap:
    /// [`VkAccelerationStructureCompatibilityKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureCompatibilityKHR.html).
    #[doc(alias = "VkAccelerationStructureCompatibilityKHR")]
    pub struct AccelerationStructureCompatibility {
        /// It can.
        COMPATIBLE = 0, "VK_ACCELERATION_STRUCTURE_COMPATIBILITY_COMPATIBLE_KHR";
        /// It cannot.
        INCOMPATIBLE = 1, "VK_ACCELERATION_STRUCTURE_COMPATIBILITY_INCOMPATIBLE_KHR";
    }
}

open_enum! {
    /// What a block behind the header of a serialized bottom-level structure holds:
    /// [`VkAccelerationStructureSerializedBlockTypeKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureSerializedBlockTypeKHR.html).
    #[doc(alias = "VkAccelerationStructureSerializedBlockTypeKHR")]
    pub struct AccelerationStructureSerializedBlockType {
        /// Device addresses of the micromaps that the structure refers to.
        OPACITY_MICROMAP = 0, "VK_ACCELERATION_STRUCTURE_SERIALIZED_BLOCK_TYPE_OPACITY_MICROMAP_KHR";
    }
}

extensible! {
    /// A copy from structure to structure:
    /// [`VkCopyAccelerationStructureInfoKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCopyAccelerationStructureInfoKHR.html).
    #[doc(alias = "VkCopyAccelerationStructureInfoKHR")]
    pub struct CopyAccelerationStructureInfo: COPY_ACCELERATION_STRUCTURE_INFO {
        /// The structure that is read.
        pub src: AccelerationStructure,
        /// The structure that is written.
        pub dst: AccelerationStructure,
        /// Whether to clone or to compact.
        pub mode: CopyAccelerationStructureMode,
    }
}

extensible! {
    /// A copy from a structure to memory:
    /// [`VkCopyAccelerationStructureToMemoryInfoKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCopyAccelerationStructureToMemoryInfoKHR.html).
    #[doc(alias = "VkCopyAccelerationStructureToMemoryInfoKHR")]
    pub struct CopyAccelerationStructureToMemoryInfo: COPY_ACCELERATION_STRUCTURE_TO_MEMORY_INFO {
        /// The structure that is read.
        pub src: AccelerationStructure,
        /// Where the serialized bytes go.
        pub dst: DeviceOrHostAddress,
        /// Has to say serialize.
        pub mode: CopyAccelerationStructureMode,
    }
}

extensible! {
    /// A copy from memory to a structure:
    /// [`VkCopyMemoryToAccelerationStructureInfoKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCopyMemoryToAccelerationStructureInfoKHR.html).
    #[doc(alias = "VkCopyMemoryToAccelerationStructureInfoKHR")]
    pub struct CopyMemoryToAccelerationStructureInfo: COPY_MEMORY_TO_ACCELERATION_STRUCTURE_INFO {
        /// Where the serialized bytes are.
        pub src: DeviceOrHostAddress,
        /// The structure that is written.
        pub dst: AccelerationStructure,
        /// Has to say deserialize.
        pub mode: CopyAccelerationStructureMode,
    }
}

extensible! {
    /// The first bytes of a serialized acceleration structure, to be compared with a device:
    /// [`VkAccelerationStructureVersionInfoKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureVersionInfoKHR.html).
    #[doc(alias = "VkAccelerationStructureVersionInfoKHR")]
    pub struct AccelerationStructureVersionInfo: ACCELERATION_STRUCTURE_VERSION_INFO {
        /// Driver UUID and compatibility UUID, twice [`UUID_SIZE`] bytes.
        #[doc(alias = "pVersionData")]
        pub version_data: Vec<u8>,
    }
}
