//! Types of indices.

use super::enumerant::open_enum;

open_enum! {
    /// How an index is stored, of vertices or of micromap triangles:
    /// [`VkIndexType`](https://docs.vulkan.org/refpages/latest/refpages/source/VkIndexType.html).
    #[doc(alias = "VkIndexType")]
    pub struct IndexType {
        /// In 16 bits.
        UINT16 = 0, "VK_INDEX_TYPE_UINT16";
        /// In 32 bits.
        UINT32 = 1, "VK_INDEX_TYPE_UINT32";
        /// There are no indices; elements are taken in order.
        NONE = 1_000_165_000, "VK_INDEX_TYPE_NONE_KHR";
        /// In 8 bits.
        UINT8 = 1_000_265_000, "VK_INDEX_TYPE_UINT8", "VK_INDEX_TYPE_UINT8_KHR", "VK_INDEX_TYPE_UINT8_EXT";
    }
}

impl IndexType {
    /// Bytes of one index: 1, 2 or 4, 0 for [`NONE`](Self::NONE), or `None` for a value without a meaning.
    pub const fn size(self) -> Option<u32> {
        match self {
            Self::NONE => Some(0),
            Self::UINT8 => Some(1),
            Self::UINT16 => Some(2),
            Self::UINT32 => Some(4),
            _ => None,
        }
    }
}
