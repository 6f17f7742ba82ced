//! Formats of vertex positions.

use super::enumerant::{open_enum, open_flags};

open_enum! {
    /// How a vertex position is stored:
    /// [`VkFormat`](https://docs.vulkan.org/refpages/latest/refpages/source/VkFormat.html).
    ///
    /// The constants are the formats that vertex positions commonly have; a missing third component counts as zero.
    #[doc(alias = "VkFormat")]
    pub struct Format {
        /// No format.
        UNDEFINED = 0, "VK_FORMAT_UNDEFINED";
        /// Two 8-bit components, 0 to 255 meaning 0 to 1.
        R8G8_UNORM = 16, "VK_FORMAT_R8G8_UNORM";
        /// Two 8-bit components, -127 to 127 meaning -1 to 1.
        R8G8_SNORM = 17, "VK_FORMAT_R8G8_SNORM";
        /// Four 8-bit components, 0 to 255 meaning 0 to 1; the fourth is not used.
        R8G8B8A8_UNORM = 37, "VK_FORMAT_R8G8B8A8_UNORM";
        /// Four 8-bit components, -127 to 127 meaning -1 to 1; the fourth is not used.
        R8G8B8A8_SNORM = 38, "VK_FORMAT_R8G8B8A8_SNORM";
        /// A 32-bit word with three 10-bit components from the low end up, 0 to 1023 meaning 0 to 1; the top 2 bits are not used.
        A2B10G10R10_UNORM_PACK32 = 64, "VK_FORMAT_A2B10G10R10_UNORM_PACK32";
        /// Two 16-bit components, 0 to 65535 meaning 0 to 1.
        R16G16_UNORM = 77, "VK_FORMAT_R16G16_UNORM";
        /// Two 16-bit components, -32767 to 32767 meaning -1 to 1.
        R16G16_SNORM = 78, "VK_FORMAT_R16G16_SNORM";
        /// Two 16-bit floats.
        R16G16_SFLOAT = 83, "VK_FORMAT_R16G16_SFLOAT";
        /// Four 16-bit components, 0 to 65535 meaning 0 to 1; the fourth is not used.
        R16G16B16A16_UNORM = 91, "VK_FORMAT_R16G16B16A16_UNORM";
        /// Four 16-bit components, -32767 to 32767 meaning -1 to 1; the fourth is not used.
        R16G16B16A16_SNORM = 92, "VK_FORMAT_R16G16B16A16_SNORM";
        /// Four 16-bit floats; the fourth is not used.
        R16G16B16A16_SFLOAT = 97, "VK_FORMAT_R16G16B16A16_SFLOAT";
        /// Two 32-bit floats.
        R32G32_SFLOAT = 103, "VK_FORMAT_R32G32_SFLOAT";
        /// Three 32-bit floats.
        R32G32B32_SFLOAT = 106, "VK_FORMAT_R32G32B32_SFLOAT";
        /// Four 32-bit floats; the fourth is not used.
        R32G32B32A32_SFLOAT = 109, "VK_FORMAT_R32G32B32A32_SFLOAT";
    }
}

open_flags! {
    /// What a format can be used for, as far as acceleration structures are concerned:
    /// [`VkFormatFeatureFlagBits`](https://docs.vulkan.org/refpages/latest/refpages/source/VkFormatFeatureFlagBits.html).
    #[doc(alias = "VkFormatFeatureFlagBits")]
    #[doc(alias = "VkFormatFeatureFlags")]
    pub struct FormatFeatureFlags: u32 {
        /// Vertex positions of a build can have the format.
        ACCELERATION_STRUCTURE_VERTEX_BUFFER = 1 << 29, "VK_FORMAT_FEATURE_ACCELERATION_STRUCTURE_VERTEX_BUFFER_BIT_KHR";
    }
}

open_flags! {
    /// The 64-bit form of [`FormatFeatureFlags`]:
    /// [`VkFormatFeatureFlagBits2`](https://docs.vulkan.org/refpages/latest/refpages/source/VkFormatFeatureFlagBits2.html).
    #[doc(alias = "VkFormatFeatureFlagBits2")]
    #[doc(alias = "VkFormatFeatureFlags2")]
    pub struct FormatFeatureFlags2: u64 {
        /// Vertex positions of a build can have the format.
        ACCELERATION_STRUCTURE_VERTEX_BUFFER = 1 << 29, "VK_FORMAT_FEATURE_2_ACCELERATION_STRUCTURE_VERTEX_BUFFER_BIT_KHR";
    }
}
