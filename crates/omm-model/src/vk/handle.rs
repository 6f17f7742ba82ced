//! Object handles. A handle is only a number here: it may name an object that was destroyed or never created.

use super::ObjectType;

/// Declares handle types with the object type that each stands for.
macro_rules! handles {
    ($( $(#[$meta:meta])* $handle:ident: $object_type:ident; )*) => {$(
        $(#[$meta])*
        #[derive(
            Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
        )]
        pub struct $handle(pub u64);

        impl $handle {
            /// `VK_NULL_HANDLE`: no object.
            pub const NULL: Self = Self(0);

            /// The kind of object that this handle names.
            pub const OBJECT_TYPE: ObjectType = ObjectType::$object_type;

            /// Whether this names no object.
            pub const fn is_null(self) -> bool {
                self.0 == 0
            }
        }
    )*};
}

handles! {
    /// A physical device, which a group of devices or a query of features names:
    /// [`VkPhysicalDevice`](https://docs.vulkan.org/refpages/latest/refpages/source/VkPhysicalDevice.html).
    #[doc(alias = "VkPhysicalDevice")]
    PhysicalDevice: PHYSICAL_DEVICE;
    /// A logical device: [`VkDevice`](https://docs.vulkan.org/refpages/latest/refpages/source/VkDevice.html).
    #[doc(alias = "VkDevice")]
    Device: DEVICE;
    /// A queue of a device: [`VkQueue`](https://docs.vulkan.org/refpages/latest/refpages/source/VkQueue.html).
    #[doc(alias = "VkQueue")]
    Queue: QUEUE;
    /// A buffer, a range of bytes with declared uses:
    /// [`VkBuffer`](https://docs.vulkan.org/refpages/latest/refpages/source/VkBuffer.html).
    #[doc(alias = "VkBuffer")]
    Buffer: BUFFER;
    /// A memory allocation that buffers are bound to:
    /// [`VkDeviceMemory`](https://docs.vulkan.org/refpages/latest/refpages/source/VkDeviceMemory.html).
    #[doc(alias = "VkDeviceMemory")]
    DeviceMemory: DEVICE_MEMORY;
    /// A pool that command buffers are allocated from:
    /// [`VkCommandPool`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCommandPool.html).
    #[doc(alias = "VkCommandPool")]
    CommandPool: COMMAND_POOL;
    /// A list of recorded commands:
    /// [`VkCommandBuffer`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCommandBuffer.html).
    #[doc(alias = "VkCommandBuffer")]
    CommandBuffer: COMMAND_BUFFER;
    /// A pool of queries, each of which holds one result:
    /// [`VkQueryPool`](https://docs.vulkan.org/refpages/latest/refpages/source/VkQueryPool.html).
    #[doc(alias = "VkQueryPool")]
    QueryPool: QUERY_POOL;
    /// A pipeline that traces rays:
    /// [`VkPipeline`](https://docs.vulkan.org/refpages/latest/refpages/source/VkPipeline.html).
    #[doc(alias = "VkPipeline")]
    Pipeline: PIPELINE;
    /// A shader object whose ray queries trace rays:
    /// [`VkShaderEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkShaderEXT.html).
    #[doc(alias = "VkShaderEXT")]
    Shader: SHADER;
    /// A render pass, which only a secondary command buffer's inheritance names:
    /// [`VkRenderPass`](https://docs.vulkan.org/refpages/latest/refpages/source/VkRenderPass.html).
    #[doc(alias = "VkRenderPass")]
    RenderPass: RENDER_PASS;
    /// A framebuffer, which only a secondary command buffer's inheritance names:
    /// [`VkFramebuffer`](https://docs.vulkan.org/refpages/latest/refpages/source/VkFramebuffer.html).
    #[doc(alias = "VkFramebuffer")]
    Framebuffer: FRAMEBUFFER;
    /// An acceleration structure of any type, a KHR micromap included:
    /// [`VkAccelerationStructureKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureKHR.html).
    #[doc(alias = "VkAccelerationStructureKHR")]
    AccelerationStructure: ACCELERATION_STRUCTURE;
    /// A micromap object of the EXT extension:
    /// [`VkMicromapEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkMicromapEXT.html).
    #[doc(alias = "VkMicromapEXT")]
    Micromap: MICROMAP;
    /// A host command whose work the application's own threads do later:
    /// [`VkDeferredOperationKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkDeferredOperationKHR.html).
    #[doc(alias = "VkDeferredOperationKHR")]
    DeferredOperation: DEFERRED_OPERATION;
}
