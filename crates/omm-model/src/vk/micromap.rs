//! Opacity micromaps of the KHR extension.

use serde::{Deserialize, Serialize};

use super::chain::extensible;
use super::enumerant::open_enum;
use super::*;

open_enum! {
    /// How the opacity of a microtriangle is encoded:
    /// [`VkOpacityMicromapFormatKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkOpacityMicromapFormatKHR.html).
    #[doc(alias = "VkOpacityMicromapFormatKHR")]
    #[doc(alias = "VkOpacityMicromapFormatEXT")]
    pub struct OpacityMicromapFormat {
        /// One bit: transparent or opaque.
        TWO_STATE = 1, "VK_OPACITY_MICROMAP_FORMAT_2_STATE_KHR", "VK_OPACITY_MICROMAP_FORMAT_2_STATE_EXT";
        /// Two bits: transparent, opaque, unknown transparent or unknown opaque.
        FOUR_STATE = 2, "VK_OPACITY_MICROMAP_FORMAT_4_STATE_KHR", "VK_OPACITY_MICROMAP_FORMAT_4_STATE_EXT";
    }
}

open_enum! {
    /// An entry of a micromap index buffer that gives a whole triangle one state:
    /// [`VkOpacityMicromapSpecialIndexKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkOpacityMicromapSpecialIndexKHR.html).
    ///
    /// An entry is one of these if it equals the value cast to the unsigned type of the index buffer.
    #[doc(alias = "VkOpacityMicromapSpecialIndexKHR")]
    #[doc(alias = "VkOpacityMicromapSpecialIndexEXT")]
    pub struct OpacityMicromapSpecialIndex {
        /// All of the triangle is transparent.
        FULLY_TRANSPARENT = -1,
            "VK_OPACITY_MICROMAP_SPECIAL_INDEX_FULLY_TRANSPARENT_KHR",
            "VK_OPACITY_MICROMAP_SPECIAL_INDEX_FULLY_TRANSPARENT_EXT";
        /// All of the triangle is opaque.
        FULLY_OPAQUE = -2,
            "VK_OPACITY_MICROMAP_SPECIAL_INDEX_FULLY_OPAQUE_KHR",
            "VK_OPACITY_MICROMAP_SPECIAL_INDEX_FULLY_OPAQUE_EXT";
        /// All of the triangle is unknown, and transparent where two states are forced.
        FULLY_UNKNOWN_TRANSPARENT = -3,
            "VK_OPACITY_MICROMAP_SPECIAL_INDEX_FULLY_UNKNOWN_TRANSPARENT_KHR",
            "VK_OPACITY_MICROMAP_SPECIAL_INDEX_FULLY_UNKNOWN_TRANSPARENT_EXT";
        /// All of the triangle is unknown, and opaque where two states are forced.
        FULLY_UNKNOWN_OPAQUE = -4,
            "VK_OPACITY_MICROMAP_SPECIAL_INDEX_FULLY_UNKNOWN_OPAQUE_KHR",
            "VK_OPACITY_MICROMAP_SPECIAL_INDEX_FULLY_UNKNOWN_OPAQUE_EXT";
    }
}

/// How many micromap triangles there are of one level and format:
/// [`VkMicromapUsageKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkMicromapUsageKHR.html).
#[doc(alias = "VkMicromapUsageKHR")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct MicromapUsage {
    /// Triangles of this level and format.
    pub count: u32,
    /// How often each triangle is divided; a triangle of level n has 4ⁿ microtriangles.
    pub subdivision_level: u32,
    /// How their opacity is encoded.
    pub format: OpacityMicromapFormat,
}

/// One entry of the triangle array of a micromap, 8 bytes in memory:
/// [`VkMicromapTriangleKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkMicromapTriangleKHR.html).
#[doc(alias = "VkMicromapTriangleKHR")]
#[doc(alias = "VkMicromapTriangleEXT")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct MicromapTriangle {
    /// Bytes from the start of the micromap data to this triangle's opacity.
    pub data_offset: u32,
    /// How often the triangle is divided.
    pub subdivision_level: u16,
    /// How its opacity is encoded, a value of [`OpacityMicromapFormat`].
    pub format: u16,
}

extensible! {
    /// The input of a micromap build, chained to a [`Geometry`] of type [`GeometryType::MICROMAP`]:
    /// [`VkAccelerationStructureGeometryMicromapDataKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureGeometryMicromapDataKHR.html).
    #[doc(alias = "VkAccelerationStructureGeometryMicromapDataKHR")]
    pub struct GeometryMicromapData: ACCELERATION_STRUCTURE_GEOMETRY_MICROMAP_DATA {
        /// `pUsageCounts`: how many triangles of which level and format; `None` is a null pointer.
        #[doc(alias = "pUsageCounts")]
        pub usage_counts: Option<Vec<MicromapUsage>>,
        /// `ppUsageCounts`: the same through an array of pointers; `None` is a null pointer.
        #[doc(alias = "ppUsageCounts")]
        pub usage_count_pointers: Option<Vec<MicromapUsage>>,
        /// Where the opacity of the microtriangles begins.
        pub data: DeviceAddress,
        /// Where the [`MicromapTriangle`] entries begin.
        pub triangle_array: DeviceAddress,
        /// Bytes from one entry to the next.
        pub triangle_array_stride: DeviceSize,
    }
}

impl GeometryMicromapData {
    /// The usages, from whichever of the two arrays is there, the direct one first.
    pub fn usages(&self) -> impl Iterator<Item = &MicromapUsage> {
        either(self.usage_counts.as_ref(), self.usage_count_pointers.as_ref())
    }
}

extensible! {
    /// A micromap attached to triangles, chained to a [`GeometryTrianglesData`]:
    /// [`VkAccelerationStructureTrianglesOpacityMicromapKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureTrianglesOpacityMicromapKHR.html).
    #[doc(alias = "VkAccelerationStructureTrianglesOpacityMicromapKHR")]
    pub struct TrianglesOpacityMicromap: ACCELERATION_STRUCTURE_TRIANGLES_OPACITY_MICROMAP {
        /// How an index is stored; [`IndexType::NONE`] where triangle i of the geometry uses micromap triangle `base_triangle` + i.
        pub index_type: IndexType,
        /// Where the indices begin.
        pub index_buffer: DeviceAddress,
        /// Bytes from one index to the next.
        pub index_stride: DeviceSize,
        /// What is added to every index that is not a special one.
        pub base_triangle: u32,
        /// The micromap; null where every index is special.
        pub micromap: AccelerationStructure,
    }
}

/// The elements of the array that is there, the first one where both are.
pub(super) fn either<'a, T>(array: Option<&'a Vec<T>>, pointers: Option<&'a Vec<T>>) -> impl Iterator<Item = &'a T> {
    array.or(pointers).into_iter().flatten()
}
