//! What pipelines and shaders have to say so that they may meet micromaps or motion.

use super::enumerant::open_flags;

open_flags! {
    /// How a pipeline is made, as far as micromaps and motion are concerned:
    /// [`VkPipelineCreateFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkPipelineCreateFlagBits.html).
    #[doc(alias = "VkPipelineCreateFlagBits")]
    #[doc(alias = "VkPipelineCreateFlags")]
    pub struct PipelineCreateFlags: u32 {
        /// Its rays may meet structures with motion.
        RAY_TRACING_ALLOW_MOTION = 1 << 20, "VK_PIPELINE_CREATE_RAY_TRACING_ALLOW_MOTION_BIT_NV";
        /// Its rays may meet structures with micromaps.
        RAY_TRACING_OPACITY_MICROMAP = 1 << 24,
            "VK_PIPELINE_CREATE_RAY_TRACING_OPACITY_MICROMAP_BIT_KHR",
            "VK_PIPELINE_CREATE_RAY_TRACING_OPACITY_MICROMAP_BIT_EXT";
    }
}

open_flags! {
    /// The 64-bit form of [`PipelineCreateFlags`]:
    /// [`VkPipelineCreateFlagBits2`](https://docs.vulkan.org/refpages/latest/refpages/source/VkPipelineCreateFlagBits2.html).
    #[doc(alias = "VkPipelineCreateFlagBits2")]
    #[doc(alias = "VkPipelineCreateFlags2")]
    pub struct PipelineCreateFlags2: u64 {
        /// Its rays may meet structures with motion.
        RAY_TRACING_ALLOW_MOTION = 1 << 20, "VK_PIPELINE_CREATE_2_RAY_TRACING_ALLOW_MOTION_BIT_NV";
        /// Its rays may meet structures with micromaps.
        RAY_TRACING_OPACITY_MICROMAP = 1 << 24,
            "VK_PIPELINE_CREATE_2_RAY_TRACING_OPACITY_MICROMAP_BIT_KHR",
            "VK_PIPELINE_CREATE_2_RAY_TRACING_OPACITY_MICROMAP_BIT_EXT";
        /// Its rays meet no geometry whose micromap index buffer has special indices beside others.
        OPACITY_MICROMAP_DISALLOW_MIXED_SPECIAL_INDEX = 1 << 41,
            "VK_PIPELINE_CREATE_2_OPACITY_MICROMAP_DISALLOW_MIXED_SPECIAL_INDEX_BIT_KHR";
    }
}

open_flags! {
    /// How a shader object is made, as far as micromaps are concerned:
    /// [`VkShaderCreateFlagBitsEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkShaderCreateFlagBitsEXT.html).
    #[doc(alias = "VkShaderCreateFlagBitsEXT")]
    #[doc(alias = "VkShaderCreateFlagsEXT")]
    pub struct ShaderCreateFlags: u32 {
        /// Its rays meet no geometry whose micromap index buffer has special indices beside others.
        OPACITY_MICROMAP_DISALLOW_MIXED_SPECIAL_INDEX = 1 << 12,
            "VK_SHADER_CREATE_OPACITY_MICROMAP_DISALLOW_MIXED_SPECIAL_INDEX_BIT_EXT";
    }
}
