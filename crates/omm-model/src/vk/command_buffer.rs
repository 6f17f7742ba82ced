//! Command buffers and the pools they come from.

use super::chain::extensible;
use super::enumerant::{open_enum, open_flags};
use super::*;

open_flags! {
    /// How the command buffers of a pool are used:
    /// [`VkCommandPoolCreateFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCommandPoolCreateFlagBits.html).
    #[doc(alias = "VkCommandPoolCreateFlagBits")]
    #[doc(alias = "VkCommandPoolCreateFlags")]
    pub struct CommandPoolCreateFlags: u32 {
        /// They do not live long.
        TRANSIENT = 1 << 0, "VK_COMMAND_POOL_CREATE_TRANSIENT_BIT";
        /// Each can be reset for itself.
        RESET_COMMAND_BUFFER = 1 << 1, "VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT";
        /// They are protected.
        PROTECTED = 1 << 2, "VK_COMMAND_POOL_CREATE_PROTECTED_BIT";
    }
}

extensible! {
    /// A new command pool:
    /// [`VkCommandPoolCreateInfo`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCommandPoolCreateInfo.html).
    #[doc(alias = "VkCommandPoolCreateInfo")]
    pub struct CommandPoolCreateInfo: COMMAND_POOL_CREATE_INFO {
        /// How its command buffers are used.
        pub flags: CommandPoolCreateFlags,
        /// The queue family that they can be submitted to.
        pub queue_family_index: u32,
    }
}

open_enum! {
    /// What a command buffer can be given to:
    /// [`VkCommandBufferLevel`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCommandBufferLevel.html).
    #[doc(alias = "VkCommandBufferLevel")]
    pub struct CommandBufferLevel {
        /// A queue.
        PRIMARY = 0, "VK_COMMAND_BUFFER_LEVEL_PRIMARY";
        /// A primary command buffer.
        SECONDARY = 1, "VK_COMMAND_BUFFER_LEVEL_SECONDARY";
    }
}

extensible! {
    /// New command buffers:
    /// [`VkCommandBufferAllocateInfo`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCommandBufferAllocateInfo.html).
    #[doc(alias = "VkCommandBufferAllocateInfo")]
    pub struct CommandBufferAllocateInfo: COMMAND_BUFFER_ALLOCATE_INFO {
        /// The pool that they come from.
        pub command_pool: CommandPool,
        /// What they can be given to.
        pub level: CommandBufferLevel,
        /// How many there are to be.
        pub command_buffer_count: u32,
    }
}

open_flags! {
    /// How a recorded command buffer is used:
    /// [`VkCommandBufferUsageFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCommandBufferUsageFlagBits.html).
    #[doc(alias = "VkCommandBufferUsageFlagBits")]
    #[doc(alias = "VkCommandBufferUsageFlags")]
    pub struct CommandBufferUsageFlags: u32 {
        /// It is submitted once and then recorded anew.
        ONE_TIME_SUBMIT = 1 << 0, "VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT";
        /// As a secondary one, it lies wholly inside a render pass.
        RENDER_PASS_CONTINUE = 1 << 1, "VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT";
        /// It can be submitted again while it is pending.
        SIMULTANEOUS_USE = 1 << 2, "VK_COMMAND_BUFFER_USAGE_SIMULTANEOUS_USE_BIT";
    }
}

open_flags! {
    /// How an occlusion query that is active in the primary command buffer counts:
    /// [`VkQueryControlFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkQueryControlFlagBits.html).
    #[doc(alias = "VkQueryControlFlagBits")]
    #[doc(alias = "VkQueryControlFlags")]
    pub struct QueryControlFlags: u32 {
        /// It counts exactly.
        PRECISE = 1 << 0, "VK_QUERY_CONTROL_PRECISE_BIT";
    }
}

extensible! {
    /// What a secondary command buffer takes over from the primary one:
    /// [`VkCommandBufferInheritanceInfo`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCommandBufferInheritanceInfo.html).
    #[doc(alias = "VkCommandBufferInheritanceInfo")]
    pub struct CommandBufferInheritanceInfo: COMMAND_BUFFER_INHERITANCE_INFO {
        /// A render pass compatible with the one it is executed in.
        pub render_pass: RenderPass,
        /// The subpass that it is executed in.
        pub subpass: u32,
        /// The framebuffer that it renders to, or null.
        pub framebuffer: Framebuffer,
        /// Whether an occlusion query may be active.
        pub occlusion_query_enable: Bool32,
        /// How that query may count.
        pub query_flags: QueryControlFlags,
        /// Which statistics an active query may count.
        pub pipeline_statistics: QueryPipelineStatisticFlags,
    }
}

extensible! {
    /// The start of a recording:
    /// [`VkCommandBufferBeginInfo`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCommandBufferBeginInfo.html).
    #[doc(alias = "VkCommandBufferBeginInfo")]
    pub struct CommandBufferBeginInfo: COMMAND_BUFFER_BEGIN_INFO {
        /// How the command buffer is used.
        pub flags: CommandBufferUsageFlags,
        /// `pInheritanceInfo`, for secondary command buffers; `None` is a null pointer.
        #[doc(alias = "pInheritanceInfo")]
        pub inheritance_info: Option<CommandBufferInheritanceInfo>,
    }
}

open_flags! {
    /// How a command buffer is reset:
    /// [`VkCommandBufferResetFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCommandBufferResetFlagBits.html).
    #[doc(alias = "VkCommandBufferResetFlagBits")]
    #[doc(alias = "VkCommandBufferResetFlags")]
    pub struct CommandBufferResetFlags: u32 {
        /// It gives its memory back to the pool.
        RELEASE_RESOURCES = 1 << 0, "VK_COMMAND_BUFFER_RESET_RELEASE_RESOURCES_BIT";
    }
}

open_flags! {
    /// How a dynamic render pass instance is recorded, as far as its extent goes:
    /// [`VkRenderingFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkRenderingFlagBits.html).
    #[doc(alias = "VkRenderingFlagBits")]
    #[doc(alias = "VkRenderingFlags")]
    pub struct RenderingFlags: u32 {
        /// Its commands are in secondary command buffers.
        CONTENTS_SECONDARY_COMMAND_BUFFERS = 1 << 0, "VK_RENDERING_CONTENTS_SECONDARY_COMMAND_BUFFERS_BIT";
        /// It goes on after its end, in a later instance that resumes it.
        SUSPENDING = 1 << 1, "VK_RENDERING_SUSPENDING_BIT";
        /// It goes on with an earlier instance that was suspended.
        RESUMING = 1 << 2, "VK_RENDERING_RESUMING_BIT";
    }
}
