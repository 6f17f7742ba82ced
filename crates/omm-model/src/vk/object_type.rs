//! Kinds of objects.

use super::enumerant::open_enum;

open_enum! {
    /// What kind of object a handle names:
    /// [`VkObjectType`](https://docs.vulkan.org/refpages/latest/refpages/source/VkObjectType.html).
    ///
    /// The constants are those of the handles of this module.
    #[doc(alias = "VkObjectType")]
    pub struct ObjectType {
        /// Not known.
        UNKNOWN = 0, "VK_OBJECT_TYPE_UNKNOWN";
        /// [`PhysicalDevice`](super::PhysicalDevice).
        PHYSICAL_DEVICE = 2, "VK_OBJECT_TYPE_PHYSICAL_DEVICE";
        /// [`Device`](super::Device).
        DEVICE = 3, "VK_OBJECT_TYPE_DEVICE";
        /// [`Queue`](super::Queue).
        QUEUE = 4, "VK_OBJECT_TYPE_QUEUE";
        /// [`CommandBuffer`](super::CommandBuffer).
        COMMAND_BUFFER = 6, "VK_OBJECT_TYPE_COMMAND_BUFFER";
        /// [`DeviceMemory`](super::DeviceMemory).
        DEVICE_MEMORY = 8, "VK_OBJECT_TYPE_DEVICE_MEMORY";
        /// [`Buffer`](super::Buffer).
        BUFFER = 9, "VK_OBJECT_TYPE_BUFFER";
        /// [`QueryPool`](super::QueryPool).
        QUERY_POOL = 12, "VK_OBJECT_TYPE_QUERY_POOL";
        /// [`RenderPass`](super::RenderPass).
        RENDER_PASS = 18, "VK_OBJECT_TYPE_RENDER_PASS";
        /// [`Pipeline`](super::Pipeline).
        PIPELINE = 19, "VK_OBJECT_TYPE_PIPELINE";
        /// [`Framebuffer`](super::Framebuffer).
        FRAMEBUFFER = 24, "VK_OBJECT_TYPE_FRAMEBUFFER";
        /// [`CommandPool`](super::CommandPool).
        COMMAND_POOL = 25, "VK_OBJECT_TYPE_COMMAND_POOL";
        /// [`AccelerationStructure`](super::AccelerationStructure).
        ACCELERATION_STRUCTURE = 1_000_150_000, "VK_OBJECT_TYPE_ACCELERATION_STRUCTURE_KHR";
        /// [`DeferredOperation`](super::DeferredOperation).
        DEFERRED_OPERATION = 1_000_268_000, "VK_OBJECT_TYPE_DEFERRED_OPERATION_KHR";
        /// [`Micromap`](super::Micromap).
        MICROMAP = 1_000_396_000, "VK_OBJECT_TYPE_MICROMAP_EXT";
        /// [`Shader`](super::Shader).
        SHADER = 1_000_482_000, "VK_OBJECT_TYPE_SHADER_EXT";
    }
}
