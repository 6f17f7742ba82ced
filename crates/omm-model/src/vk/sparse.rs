//! Binding parts of sparse buffers.

use serde::{Deserialize, Serialize};

use super::enumerant::open_flags;
use super::*;

open_flags! {
    /// What a sparse binding binds:
    /// [`VkSparseMemoryBindFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkSparseMemoryBindFlagBits.html).
    #[doc(alias = "VkSparseMemoryBindFlagBits")]
    #[doc(alias = "VkSparseMemoryBindFlags")]
    pub struct SparseMemoryBindFlags: u32 {
        /// Metadata of an image.
        METADATA = 1 << 0, "VK_SPARSE_MEMORY_BIND_METADATA_BIT";
    }
}

/// One range of a sparse buffer and the memory behind it:
/// [`VkSparseMemoryBind`](https://docs.vulkan.org/refpages/latest/refpages/source/VkSparseMemoryBind.html).
#[doc(alias = "VkSparseMemoryBind")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct SparseMemoryBind {
    /// Bytes from the start of the buffer to the range.
    pub resource_offset: DeviceSize,
    /// Bytes in the range.
    pub size: DeviceSize,
    /// The memory; null unbinds the range.
    pub memory: DeviceMemory,
    /// Bytes from the start of the memory to what is bound.
    pub memory_offset: DeviceSize,
    /// What is bound.
    pub flags: SparseMemoryBindFlags,
}

/// Ranges of one sparse buffer to bind:
/// [`VkSparseBufferMemoryBindInfo`](https://docs.vulkan.org/refpages/latest/refpages/source/VkSparseBufferMemoryBindInfo.html).
#[doc(alias = "VkSparseBufferMemoryBindInfo")]
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct SparseBufferMemoryBindInfo {
    /// The buffer.
    pub buffer: Buffer,
    /// Its ranges.
    pub binds: Vec<SparseMemoryBind>,
}
