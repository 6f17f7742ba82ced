//! What queues can do.

use super::enumerant::open_flags;

open_flags! {
    /// What the queues of a family can do:
    /// [`VkQueueFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkQueueFlagBits.html).
    #[doc(alias = "VkQueueFlagBits")]
    #[doc(alias = "VkQueueFlags")]
    pub struct QueueFlags: u32 {
        /// Draw.
        GRAPHICS = 1 << 0, "VK_QUEUE_GRAPHICS_BIT";
        /// Compute, which builds and copies of acceleration structures and micromaps need.
        COMPUTE = 1 << 1, "VK_QUEUE_COMPUTE_BIT";
        /// Transfer.
        TRANSFER = 1 << 2, "VK_QUEUE_TRANSFER_BIT";
        /// Bind memory to sparse buffers.
        SPARSE_BINDING = 1 << 3, "VK_QUEUE_SPARSE_BINDING_BIT";
        /// Work on protected memory.
        PROTECTED = 1 << 4, "VK_QUEUE_PROTECTED_BIT";
    }
}
