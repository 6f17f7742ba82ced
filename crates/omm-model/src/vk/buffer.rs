//! Buffers.

use super::chain::extensible;
use super::enumerant::{open_enum, open_flags};
use super::*;

open_flags! {
    /// How a buffer is made:
    /// [`VkBufferCreateFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkBufferCreateFlagBits.html).
    #[doc(alias = "VkBufferCreateFlagBits")]
    #[doc(alias = "VkBufferCreateFlags")]
    pub struct BufferCreateFlags: u32 {
        /// It can be bound to several pieces of memory.
        SPARSE_BINDING = 1 << 0, "VK_BUFFER_CREATE_SPARSE_BINDING_BIT";
        /// It can be used while parts of it are not bound.
        SPARSE_RESIDENCY = 1 << 1, "VK_BUFFER_CREATE_SPARSE_RESIDENCY_BIT";
        /// Its memory can be shared with other parts of it or other buffers.
        SPARSE_ALIASED = 1 << 2, "VK_BUFFER_CREATE_SPARSE_ALIASED_BIT";
        /// It is protected.
        PROTECTED = 1 << 3, "VK_BUFFER_CREATE_PROTECTED_BIT";
        /// Its device address can be saved and asked for again in a later run.
        DEVICE_ADDRESS_CAPTURE_REPLAY = 1 << 4, "VK_BUFFER_CREATE_DEVICE_ADDRESS_CAPTURE_REPLAY_BIT";
    }
}

open_flags! {
    /// What a buffer is used for:
    /// [`VkBufferUsageFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkBufferUsageFlagBits.html).
    #[doc(alias = "VkBufferUsageFlagBits")]
    #[doc(alias = "VkBufferUsageFlags")]
    pub struct BufferUsageFlags: u32 {
        /// Transfers read it.
        TRANSFER_SRC = 1 << 0, "VK_BUFFER_USAGE_TRANSFER_SRC_BIT";
        /// Transfers write it.
        TRANSFER_DST = 1 << 1, "VK_BUFFER_USAGE_TRANSFER_DST_BIT";
        /// Uniform texel buffer.
        UNIFORM_TEXEL_BUFFER = 1 << 2, "VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT";
        /// Storage texel buffer.
        STORAGE_TEXEL_BUFFER = 1 << 3, "VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT";
        /// Uniform buffer.
        UNIFORM_BUFFER = 1 << 4, "VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT";
        /// Storage buffer, as which scratch memory of builds counts.
        STORAGE_BUFFER = 1 << 5, "VK_BUFFER_USAGE_STORAGE_BUFFER_BIT";
        /// Indices of draws.
        INDEX_BUFFER = 1 << 6, "VK_BUFFER_USAGE_INDEX_BUFFER_BIT";
        /// Vertices of draws.
        VERTEX_BUFFER = 1 << 7, "VK_BUFFER_USAGE_VERTEX_BUFFER_BIT";
        /// Parameters of indirect commands, those of indirect builds included.
        INDIRECT_BUFFER = 1 << 8, "VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT";
        /// Predicates of conditional rendering.
        CONDITIONAL_RENDERING = 1 << 9, "VK_BUFFER_USAGE_CONDITIONAL_RENDERING_BIT_EXT";
        /// Shader binding table.
        SHADER_BINDING_TABLE = 1 << 10,
            "VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR", "VK_BUFFER_USAGE_RAY_TRACING_BIT_NV";
        /// Captured vertices of transform feedback.
        TRANSFORM_FEEDBACK_BUFFER = 1 << 11, "VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_BUFFER_BIT_EXT";
        /// Counters of transform feedback.
        TRANSFORM_FEEDBACK_COUNTER_BUFFER = 1 << 12, "VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_COUNTER_BUFFER_BIT_EXT";
        /// Bit stream that video decoding reads.
        VIDEO_DECODE_SRC = 1 << 13, "VK_BUFFER_USAGE_VIDEO_DECODE_SRC_BIT_KHR";
        /// Reserved for the output of video decoding.
        VIDEO_DECODE_DST = 1 << 14, "VK_BUFFER_USAGE_VIDEO_DECODE_DST_BIT_KHR";
        /// Bit stream that video encoding writes.
        VIDEO_ENCODE_DST = 1 << 15, "VK_BUFFER_USAGE_VIDEO_ENCODE_DST_BIT_KHR";
        /// Reserved for the input of video encoding.
        VIDEO_ENCODE_SRC = 1 << 16, "VK_BUFFER_USAGE_VIDEO_ENCODE_SRC_BIT_KHR";
        /// It has a device address.
        SHADER_DEVICE_ADDRESS = 1 << 17,
            "VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT",
            "VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT_KHR",
            "VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT_EXT";
        /// Input of acceleration structure builds, KHR micromaps included.
        ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY = 1 << 19,
            "VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR";
        /// Acceleration structures, KHR micromaps included.
        ACCELERATION_STRUCTURE_STORAGE = 1 << 20, "VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR";
        /// Sampler descriptors.
        SAMPLER_DESCRIPTOR_BUFFER = 1 << 21, "VK_BUFFER_USAGE_SAMPLER_DESCRIPTOR_BUFFER_BIT_EXT";
        /// Resource descriptors.
        RESOURCE_DESCRIPTOR_BUFFER = 1 << 22, "VK_BUFFER_USAGE_RESOURCE_DESCRIPTOR_BUFFER_BIT_EXT";
        /// Input of EXT micromap builds.
        MICROMAP_BUILD_INPUT_READ_ONLY = 1 << 23, "VK_BUFFER_USAGE_MICROMAP_BUILD_INPUT_READ_ONLY_BIT_EXT";
        /// EXT micromap objects.
        MICROMAP_STORAGE = 1 << 24, "VK_BUFFER_USAGE_MICROMAP_STORAGE_BIT_EXT";
        /// Scratch memory of execution graphs.
        EXECUTION_GRAPH_SCRATCH = 1 << 25, "VK_BUFFER_USAGE_EXECUTION_GRAPH_SCRATCH_BIT_AMDX";
        /// Push descriptors of a pipeline that uses descriptor buffers.
        PUSH_DESCRIPTORS_DESCRIPTOR_BUFFER = 1 << 26, "VK_BUFFER_USAGE_PUSH_DESCRIPTORS_DESCRIPTOR_BUFFER_BIT_EXT";
        /// It can be bound to tile memory.
        TILE_MEMORY = 1 << 27, "VK_BUFFER_USAGE_TILE_MEMORY_BIT_QCOM";
        /// Descriptor heap.
        DESCRIPTOR_HEAP = 1 << 28, "VK_BUFFER_USAGE_DESCRIPTOR_HEAP_BIT_EXT";
    }
}

open_flags! {
    /// The 64-bit form of [`BufferUsageFlags`], as far as acceleration structures and micromaps are concerned:
    /// [`VkBufferUsageFlagBits2`](https://docs.vulkan.org/refpages/latest/refpages/source/VkBufferUsageFlagBits2.html).
    #[doc(alias = "VkBufferUsageFlagBits2")]
    #[doc(alias = "VkBufferUsageFlags2")]
    pub struct BufferUsageFlags2: u64 {
        /// It has a device address.
        SHADER_DEVICE_ADDRESS = 1 << 17, "VK_BUFFER_USAGE_2_SHADER_DEVICE_ADDRESS_BIT";
        /// Input of acceleration structure builds, KHR micromaps included.
        ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY = 1 << 19,
            "VK_BUFFER_USAGE_2_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR";
        /// Acceleration structures, KHR micromaps included.
        ACCELERATION_STRUCTURE_STORAGE = 1 << 20, "VK_BUFFER_USAGE_2_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR";
        /// Input of EXT micromap builds.
        MICROMAP_BUILD_INPUT_READ_ONLY = 1 << 23, "VK_BUFFER_USAGE_2_MICROMAP_BUILD_INPUT_READ_ONLY_BIT_EXT";
        /// EXT micromap objects.
        MICROMAP_STORAGE = 1 << 24, "VK_BUFFER_USAGE_2_MICROMAP_STORAGE_BIT_EXT";
    }
}

open_enum! {
    /// Whether several queue families use a buffer:
    /// [`VkSharingMode`](https://docs.vulkan.org/refpages/latest/refpages/source/VkSharingMode.html).
    #[doc(alias = "VkSharingMode")]
    pub struct SharingMode {
        /// One at a time.
        EXCLUSIVE = 0, "VK_SHARING_MODE_EXCLUSIVE";
        /// Several at once.
        CONCURRENT = 1, "VK_SHARING_MODE_CONCURRENT";
    }
}

extensible! {
    /// A new buffer:
    /// [`VkBufferCreateInfo`](https://docs.vulkan.org/refpages/latest/refpages/source/VkBufferCreateInfo.html).
    #[doc(alias = "VkBufferCreateInfo")]
    pub struct BufferCreateInfo: BUFFER_CREATE_INFO {
        /// How it is made.
        pub flags: BufferCreateFlags,
        /// Bytes in it.
        pub size: DeviceSize,
        /// What it is used for.
        pub usage: BufferUsageFlags,
        /// Whether several queue families use it.
        pub sharing_mode: SharingMode,
        /// Which ones, for [`SharingMode::CONCURRENT`].
        pub queue_family_indices: Vec<u32>,
    }
}

extensible! {
    /// Which buffer's device address is asked for:
    /// [`VkBufferDeviceAddressInfo`](https://docs.vulkan.org/refpages/latest/refpages/source/VkBufferDeviceAddressInfo.html).
    #[doc(alias = "VkBufferDeviceAddressInfo")]
    #[doc(alias = "VkBufferDeviceAddressInfoKHR")]
    #[doc(alias = "VkBufferDeviceAddressInfoEXT")]
    pub struct BufferDeviceAddressInfo: BUFFER_DEVICE_ADDRESS_INFO {
        /// The buffer whose address is asked for.
        pub buffer: Buffer,
    }
}
