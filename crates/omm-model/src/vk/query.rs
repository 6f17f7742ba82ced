//! Queries, which give back the sizes of built structures.

use super::chain::extensible;
use super::enumerant::{open_enum, open_flags};

open_enum! {
    /// What a query measures:
    /// [`VkQueryType`](https://docs.vulkan.org/refpages/latest/refpages/source/VkQueryType.html).
    #[doc(alias = "VkQueryType")]
    pub struct QueryType {
        /// Samples that pass the depth and stencil tests.
        OCCLUSION = 0, "VK_QUERY_TYPE_OCCLUSION";
        /// Counters of pipeline stages.
        PIPELINE_STATISTICS = 1, "VK_QUERY_TYPE_PIPELINE_STATISTICS";
        /// The time.
        TIMESTAMP = 2, "VK_QUERY_TYPE_TIMESTAMP";
        /// Bytes that a compacted copy of an acceleration structure takes.
        ACCELERATION_STRUCTURE_COMPACTED_SIZE = 1_000_150_000, "VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR";
        /// Bytes that the serialized form of an acceleration structure takes.
        ACCELERATION_STRUCTURE_SERIALIZATION_SIZE = 1_000_150_001,
            "VK_QUERY_TYPE_ACCELERATION_STRUCTURE_SERIALIZATION_SIZE_KHR";
        /// Handles of bottom-level structures that the serialized form of an acceleration structure holds.
        ACCELERATION_STRUCTURE_SERIALIZATION_BOTTOM_LEVEL_POINTERS = 1_000_386_000,
            "VK_QUERY_TYPE_ACCELERATION_STRUCTURE_SERIALIZATION_BOTTOM_LEVEL_POINTERS_KHR";
        /// Bytes that an acceleration structure takes.
        ACCELERATION_STRUCTURE_SIZE = 1_000_386_001, "VK_QUERY_TYPE_ACCELERATION_STRUCTURE_SIZE_KHR";
        /// Bytes that the serialized form of a micromap object takes.
        MICROMAP_SERIALIZATION_SIZE = 1_000_396_000, "VK_QUERY_TYPE_MICROMAP_SERIALIZATION_SIZE_EXT";
        /// Bytes that a compacted copy of a micromap object takes.
        MICROMAP_COMPACTED_SIZE = 1_000_396_001, "VK_QUERY_TYPE_MICROMAP_COMPACTED_SIZE_EXT";
    }
}

open_flags! {
    /// How a query pool is made:
    /// [`VkQueryPoolCreateFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkQueryPoolCreateFlagBits.html).
    #[doc(alias = "VkQueryPoolCreateFlagBits")]
    #[doc(alias = "VkQueryPoolCreateFlags")]
    pub struct QueryPoolCreateFlags: u32 {
        /// The queries are reset from the start.
        RESET = 1 << 0, "VK_QUERY_POOL_CREATE_RESET_BIT_KHR";
    }
}

open_flags! {
    /// Which counters a query of type [`QueryType::PIPELINE_STATISTICS`] has:
    /// [`VkQueryPipelineStatisticFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkQueryPipelineStatisticFlagBits.html).
    ///
    /// No constant is given, because no query on acceleration structures or micromaps has any.
    #[doc(alias = "VkQueryPipelineStatisticFlagBits")]
    #[doc(alias = "VkQueryPipelineStatisticFlags")]
    pub struct QueryPipelineStatisticFlags: u32 {}
}

open_flags! {
    /// How the results of queries are written:
    /// [`VkQueryResultFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkQueryResultFlagBits.html).
    #[doc(alias = "VkQueryResultFlagBits")]
    #[doc(alias = "VkQueryResultFlags")]
    pub struct QueryResultFlags: u32 {
        /// Each result takes 64 bits instead of 32.
        RESULT_64 = 1 << 0, "VK_QUERY_RESULT_64_BIT";
        /// Waits until the results are there.
        WAIT = 1 << 1, "VK_QUERY_RESULT_WAIT_BIT";
        /// Writes behind each result whether it is there.
        WITH_AVAILABILITY = 1 << 2, "VK_QUERY_RESULT_WITH_AVAILABILITY_BIT";
        /// A result that is not there in full may be written in part.
        PARTIAL = 1 << 3, "VK_QUERY_RESULT_PARTIAL_BIT";
    }
}

extensible! {
    /// A new query pool:
    /// [`VkQueryPoolCreateInfo`](https://docs.vulkan.org/refpages/latest/refpages/source/VkQueryPoolCreateInfo.html).
    #[doc(alias = "VkQueryPoolCreateInfo")]
    pub struct QueryPoolCreateInfo: QUERY_POOL_CREATE_INFO {
        /// How the pool is made.
        pub flags: QueryPoolCreateFlags,
        /// What its queries measure.
        pub query_type: QueryType,
        /// How many queries it has.
        pub query_count: u32,
        /// Which counters they have, for pipeline statistics only.
        pub pipeline_statistics: QueryPipelineStatisticFlags,
    }
}
