//! The pipeline stages and kinds of access that work on acceleration structures and micromaps goes by.

use super::enumerant::open_flags;

open_flags! {
    /// A stage that work goes through:
    /// [`VkPipelineStageFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkPipelineStageFlagBits.html).
    ///
    /// The constants are the stages of builds, copies and their inputs.
    #[doc(alias = "VkPipelineStageFlagBits")]
    #[doc(alias = "VkPipelineStageFlags")]
    pub struct PipelineStageFlags: u32 {
        /// Compute shaders, which may trace rays by query.
        COMPUTE_SHADER = 1 << 11, "VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT";
        /// Transfers.
        TRANSFER = 1 << 12, "VK_PIPELINE_STAGE_TRANSFER_BIT";
        /// The host reading or writing mapped memory.
        HOST = 1 << 14, "VK_PIPELINE_STAGE_HOST_BIT";
        /// Everything.
        ALL_COMMANDS = 1 << 16, "VK_PIPELINE_STAGE_ALL_COMMANDS_BIT";
        /// Ray tracing shaders.
        RAY_TRACING_SHADER = 1 << 21, "VK_PIPELINE_STAGE_RAY_TRACING_SHADER_BIT_KHR";
        /// Building and copying acceleration structures.
        ACCELERATION_STRUCTURE_BUILD = 1 << 25, "VK_PIPELINE_STAGE_ACCELERATION_STRUCTURE_BUILD_BIT_KHR";
    }
}

open_flags! {
    /// The 64-bit form of [`PipelineStageFlags`]:
    /// [`VkPipelineStageFlagBits2`](https://docs.vulkan.org/refpages/latest/refpages/source/VkPipelineStageFlagBits2.html).
    #[doc(alias = "VkPipelineStageFlagBits2")]
    #[doc(alias = "VkPipelineStageFlags2")]
    pub struct PipelineStageFlags2: u64 {
        /// Compute shaders, which may trace rays by query.
        COMPUTE_SHADER = 1 << 11, "VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT";
        /// Transfers of every kind.
        ALL_TRANSFER = 1 << 12, "VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT", "VK_PIPELINE_STAGE_2_TRANSFER_BIT";
        /// The host reading or writing mapped memory.
        HOST = 1 << 14, "VK_PIPELINE_STAGE_2_HOST_BIT";
        /// Everything.
        ALL_COMMANDS = 1 << 16, "VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT";
        /// Ray tracing shaders.
        RAY_TRACING_SHADER = 1 << 21, "VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR";
        /// Building acceleration structures, and copying them.
        ACCELERATION_STRUCTURE_BUILD = 1 << 25, "VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR";
        /// Copying acceleration structures, and asking for their sizes.
        ACCELERATION_STRUCTURE_COPY = 1 << 28, "VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_COPY_BIT_KHR";
        /// Building and copying micromap objects.
        MICROMAP_BUILD = 1 << 30, "VK_PIPELINE_STAGE_2_MICROMAP_BUILD_BIT_EXT";
        /// Copies.
        COPY = 1 << 32, "VK_PIPELINE_STAGE_2_COPY_BIT";
    }
}

open_flags! {
    /// A kind of access to memory:
    /// [`VkAccessFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccessFlagBits.html).
    ///
    /// The constants are the kinds of access of builds, copies and their inputs.
    #[doc(alias = "VkAccessFlagBits")]
    #[doc(alias = "VkAccessFlags")]
    pub struct AccessFlags: u32 {
        /// Reading parameters of indirect commands.
        INDIRECT_COMMAND_READ = 1 << 0, "VK_ACCESS_INDIRECT_COMMAND_READ_BIT";
        /// Reading by shaders, and reading the input of builds.
        SHADER_READ = 1 << 5, "VK_ACCESS_SHADER_READ_BIT";
        /// Writing by shaders.
        SHADER_WRITE = 1 << 6, "VK_ACCESS_SHADER_WRITE_BIT";
        /// Reading by transfers.
        TRANSFER_READ = 1 << 11, "VK_ACCESS_TRANSFER_READ_BIT";
        /// Writing by transfers.
        TRANSFER_WRITE = 1 << 12, "VK_ACCESS_TRANSFER_WRITE_BIT";
        /// Reading by the host.
        HOST_READ = 1 << 13, "VK_ACCESS_HOST_READ_BIT";
        /// Writing by the host.
        HOST_WRITE = 1 << 14, "VK_ACCESS_HOST_WRITE_BIT";
        /// Every kind of reading.
        MEMORY_READ = 1 << 15, "VK_ACCESS_MEMORY_READ_BIT";
        /// Every kind of writing.
        MEMORY_WRITE = 1 << 16, "VK_ACCESS_MEMORY_WRITE_BIT";
        /// Reading acceleration structures and scratch memory.
        ACCELERATION_STRUCTURE_READ = 1 << 21, "VK_ACCESS_ACCELERATION_STRUCTURE_READ_BIT_KHR";
        /// Writing acceleration structures and scratch memory.
        ACCELERATION_STRUCTURE_WRITE = 1 << 22, "VK_ACCESS_ACCELERATION_STRUCTURE_WRITE_BIT_KHR";
    }
}

open_flags! {
    /// The 64-bit form of [`AccessFlags`]:
    /// [`VkAccessFlagBits2`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccessFlagBits2.html).
    #[doc(alias = "VkAccessFlagBits2")]
    #[doc(alias = "VkAccessFlags2")]
    pub struct AccessFlags2: u64 {
        /// Reading parameters of indirect commands.
        INDIRECT_COMMAND_READ = 1 << 0, "VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT";
        /// Reading by shaders, and reading the input of builds.
        SHADER_READ = 1 << 5, "VK_ACCESS_2_SHADER_READ_BIT";
        /// Writing by shaders.
        SHADER_WRITE = 1 << 6, "VK_ACCESS_2_SHADER_WRITE_BIT";
        /// Reading by transfers.
        TRANSFER_READ = 1 << 11, "VK_ACCESS_2_TRANSFER_READ_BIT";
        /// Writing by transfers.
        TRANSFER_WRITE = 1 << 12, "VK_ACCESS_2_TRANSFER_WRITE_BIT";
        /// Reading by the host.
        HOST_READ = 1 << 13, "VK_ACCESS_2_HOST_READ_BIT";
        /// Writing by the host.
        HOST_WRITE = 1 << 14, "VK_ACCESS_2_HOST_WRITE_BIT";
        /// Every kind of reading.
        MEMORY_READ = 1 << 15, "VK_ACCESS_2_MEMORY_READ_BIT";
        /// Every kind of writing.
        MEMORY_WRITE = 1 << 16, "VK_ACCESS_2_MEMORY_WRITE_BIT";
        /// Reading acceleration structures and scratch memory.
        ACCELERATION_STRUCTURE_READ = 1 << 21, "VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR";
        /// Writing acceleration structures and scratch memory.
        ACCELERATION_STRUCTURE_WRITE = 1 << 22, "VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR";
        /// Reading micromap objects and their scratch memory.
        MICROMAP_READ = 1 << 44, "VK_ACCESS_2_MICROMAP_READ_BIT_EXT";
        /// Writing micromap objects and their scratch memory.
        MICROMAP_WRITE = 1 << 45, "VK_ACCESS_2_MICROMAP_WRITE_BIT_EXT";
    }
}
