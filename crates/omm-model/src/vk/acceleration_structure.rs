//! Acceleration structure objects: types, creation, addresses.

use super::chain::extensible;
use super::enumerant::{open_enum, open_flags};
use super::*;

open_enum! {
    /// What an acceleration structure is for:
    /// [`VkAccelerationStructureTypeKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureTypeKHR.html).
    #[doc(alias = "VkAccelerationStructureTypeKHR")]
    #[doc(alias = "VkAccelerationStructureTypeNV")]
    pub struct AccelerationStructureType {
        /// Holds instances; rays start here.
        TOP_LEVEL = 0, "VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR";
        /// Holds triangles or boxes.
        BOTTOM_LEVEL = 1, "VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR";
        /// Left open at creation; the build decides.
        GENERIC = 2, "VK_ACCELERATION_STRUCTURE_TYPE_GENERIC_KHR";
        /// Holds an opacity micromap.
        OPACITY_MICROMAP = 1_000_623_000, "VK_ACCELERATION_STRUCTURE_TYPE_OPACITY_MICROMAP_KHR";
    }
}

open_flags! {
    /// How an acceleration structure object is made:
    /// [`VkAccelerationStructureCreateFlagBitsKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureCreateFlagBitsKHR.html).
    #[doc(alias = "VkAccelerationStructureCreateFlagBitsKHR")]
    #[doc(alias = "VkAccelerationStructureCreateFlagsKHR")]
    pub struct AccelerationStructureCreateFlags: u32 {
        /// The object's device address can be saved and asked for again in a later run.
        DEVICE_ADDRESS_CAPTURE_REPLAY = 1 << 0, "VK_ACCELERATION_STRUCTURE_CREATE_DEVICE_ADDRESS_CAPTURE_REPLAY_BIT_KHR";
        /// The object can hold motion, and an [`AccelerationStructureMotionInfo`] is chained.
        MOTION = 1 << 2, "VK_ACCELERATION_STRUCTURE_CREATE_MOTION_BIT_NV";
        /// Descriptors of the object can be saved and asked for again in a later run.
        DESCRIPTOR_BUFFER_CAPTURE_REPLAY = 1 << 3,
            "VK_ACCELERATION_STRUCTURE_CREATE_DESCRIPTOR_BUFFER_CAPTURE_REPLAY_BIT_EXT";
    }
}

extensible! {
    /// A new acceleration structure in a range of a buffer:
    /// [`VkAccelerationStructureCreateInfoKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureCreateInfoKHR.html).
    ///
    /// Cannot make micromaps; [`AccelerationStructureCreateInfo2`] can.
    #[doc(alias = "VkAccelerationStructureCreateInfoKHR")]
    pub struct AccelerationStructureCreateInfo: ACCELERATION_STRUCTURE_CREATE_INFO {
        /// How the object is made.
        pub create_flags: AccelerationStructureCreateFlags,
        /// The buffer that holds the structure.
        pub buffer: Buffer,
        /// Bytes from the start of the buffer to the structure.
        pub offset: DeviceSize,
        /// Bytes that the structure may use.
        pub size: DeviceSize,
        /// What the structure is for.
        #[doc(alias = "type")]
        pub ty: AccelerationStructureType,
        /// The device address wished for when replaying, otherwise null.
        pub device_address: DeviceAddress,
    }
}

impl AccelerationStructureCreateInfo {
    /// The chained size of a structure with motion, if any.
    pub fn motion_info(&self) -> Option<&AccelerationStructureMotionInfo> {
        self.next.iter().find_map(|structure| match structure {
            ChainStructure::AccelerationStructureMotionInfo(found) => Some(found),
            _ => None,
        })
    }
}

extensible! {
    /// A new acceleration structure in a range of device memory:
    /// [`VkAccelerationStructureCreateInfo2KHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureCreateInfo2KHR.html).
    #[doc(alias = "VkAccelerationStructureCreateInfo2KHR")]
    pub struct AccelerationStructureCreateInfo2: ACCELERATION_STRUCTURE_CREATE_INFO_2 {
        /// How the object is made.
        pub create_flags: AccelerationStructureCreateFlags,
        /// The memory that holds the structure.
        pub address_range: DeviceAddressRange,
        /// What may be assumed about that memory.
        pub address_flags: AddressCommandFlags,
        /// What the structure is for.
        #[doc(alias = "type")]
        pub ty: AccelerationStructureType,
    }
}

extensible! {
    /// Which acceleration structure's device address is asked for:
    /// [`VkAccelerationStructureDeviceAddressInfoKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureDeviceAddressInfoKHR.html).
    #[doc(alias = "VkAccelerationStructureDeviceAddressInfoKHR")]
    pub struct AccelerationStructureDeviceAddressInfo: ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO {
        /// The structure whose address is asked for.
        pub acceleration_structure: AccelerationStructure,
    }
}

open_enum! {
    /// The kind of a descriptor, as far as acceleration structures are concerned:
    /// [`VkDescriptorType`](https://docs.vulkan.org/refpages/latest/refpages/source/VkDescriptorType.html).
    #[doc(alias = "VkDescriptorType")]
    pub struct DescriptorType {
        /// An acceleration structure that shaders trace rays against.
        ACCELERATION_STRUCTURE = 1_000_150_000, "VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR";
    }
}

extensible! {
    /// The acceleration structures that an update writes to descriptors:
    /// [`VkWriteDescriptorSetAccelerationStructureKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkWriteDescriptorSetAccelerationStructureKHR.html).
    #[doc(alias = "VkWriteDescriptorSetAccelerationStructureKHR")]
    pub struct WriteDescriptorSetAccelerationStructure: WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE {
        /// The structures, one for each descriptor.
        pub acceleration_structures: Vec<AccelerationStructure>,
    }
}
