//! Device memory.

use serde::{Deserialize, Serialize};

use super::chain::extensible;
use super::enumerant::open_flags;
use super::*;

extensible! {
    /// A new memory allocation:
    /// [`VkMemoryAllocateInfo`](https://docs.vulkan.org/refpages/latest/refpages/source/VkMemoryAllocateInfo.html).
    #[doc(alias = "VkMemoryAllocateInfo")]
    pub struct MemoryAllocateInfo: MEMORY_ALLOCATE_INFO {
        /// Bytes to allocate.
        pub allocation_size: DeviceSize,
        /// Which of the device's memory types to take.
        pub memory_type_index: u32,
    }
}

impl MemoryAllocateInfo {
    /// The chained flags, if any.
    pub fn allocate_flags(&self) -> Option<&MemoryAllocateFlagsInfo> {
        self.next.iter().find_map(|structure| match structure {
            ChainStructure::MemoryAllocateFlagsInfo(found) => Some(found),
            _ => None,
        })
    }
}

open_flags! {
    /// How memory is allocated:
    /// [`VkMemoryAllocateFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkMemoryAllocateFlagBits.html).
    #[doc(alias = "VkMemoryAllocateFlagBits")]
    #[doc(alias = "VkMemoryAllocateFlagBitsKHR")]
    #[doc(alias = "VkMemoryAllocateFlags")]
    pub struct MemoryAllocateFlags: u32 {
        /// Only on the physical devices of `device_mask`.
        DEVICE_MASK = 1 << 0, "VK_MEMORY_ALLOCATE_DEVICE_MASK_BIT";
        /// Buffers in the memory can have device addresses.
        DEVICE_ADDRESS = 1 << 1, "VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT";
        /// The memory's device address can be saved and asked for again in a later run.
        DEVICE_ADDRESS_CAPTURE_REPLAY = 1 << 2, "VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_CAPTURE_REPLAY_BIT";
    }
}

extensible! {
    /// Flags of an allocation, chained to a [`MemoryAllocateInfo`]:
    /// [`VkMemoryAllocateFlagsInfo`](https://docs.vulkan.org/refpages/latest/refpages/source/VkMemoryAllocateFlagsInfo.html).
    #[doc(alias = "VkMemoryAllocateFlagsInfo")]
    pub struct MemoryAllocateFlagsInfo: MEMORY_ALLOCATE_FLAGS_INFO {
        /// How the memory is allocated.
        pub flags: MemoryAllocateFlags,
        /// On which physical devices of a group, one bit each.
        pub device_mask: u32,
    }
}

open_flags! {
    /// What memory of a type can do:
    /// [`VkMemoryPropertyFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkMemoryPropertyFlagBits.html).
    #[doc(alias = "VkMemoryPropertyFlagBits")]
    #[doc(alias = "VkMemoryPropertyFlags")]
    pub struct MemoryPropertyFlags: u32 {
        /// It is near the device.
        DEVICE_LOCAL = 1 << 0, "VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT";
        /// The host can map it, which host commands on objects in it need.
        HOST_VISIBLE = 1 << 1, "VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT";
        /// Host and device see each other's writes without flushing.
        HOST_COHERENT = 1 << 2, "VK_MEMORY_PROPERTY_HOST_COHERENT_BIT";
        /// The host reads it through a cache.
        HOST_CACHED = 1 << 3, "VK_MEMORY_PROPERTY_HOST_CACHED_BIT";
        /// It may be allocated only when it is used.
        LAZILY_ALLOCATED = 1 << 4, "VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT";
        /// It is protected memory.
        PROTECTED = 1 << 5, "VK_MEMORY_PROPERTY_PROTECTED_BIT";
    }
}

open_flags! {
    /// What a heap of memory is:
    /// [`VkMemoryHeapFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkMemoryHeapFlagBits.html).
    #[doc(alias = "VkMemoryHeapFlagBits")]
    #[doc(alias = "VkMemoryHeapFlags")]
    pub struct MemoryHeapFlags: u32 {
        /// It is near the device.
        DEVICE_LOCAL = 1 << 0, "VK_MEMORY_HEAP_DEVICE_LOCAL_BIT";
        /// On a device made from several physical devices, an allocation has an instance on each unless a device mask says
        /// otherwise.
        MULTI_INSTANCE = 1 << 1, "VK_MEMORY_HEAP_MULTI_INSTANCE_BIT";
    }
}

/// A type of memory:
/// [`VkMemoryType`](https://docs.vulkan.org/refpages/latest/refpages/source/VkMemoryType.html).
#[doc(alias = "VkMemoryType")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct MemoryType {
    /// What the memory can do.
    pub property_flags: MemoryPropertyFlags,
    /// The heap that it is taken from.
    pub heap_index: u32,
}

/// A heap of memory:
/// [`VkMemoryHeap`](https://docs.vulkan.org/refpages/latest/refpages/source/VkMemoryHeap.html).
#[doc(alias = "VkMemoryHeap")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct MemoryHeap {
    /// Bytes in it.
    pub size: DeviceSize,
    /// What it is.
    pub flags: MemoryHeapFlags,
}
