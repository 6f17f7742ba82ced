//! Micromap objects of the EXT extension, which KHR replaced by a type of acceleration structure.

use serde::{Deserialize, Serialize};

use super::chain::extensible;
use super::enumerant::{open_enum, open_flags};
use super::micromap::either;
use super::*;

open_enum! {
    /// What a micromap object is for:
    /// [`VkMicromapTypeEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkMicromapTypeEXT.html).
    #[doc(alias = "VkMicromapTypeEXT")]
    pub struct MicromapType {
        /// Opacity.
        OPACITY_MICROMAP = 0, "VK_MICROMAP_TYPE_OPACITY_MICROMAP_EXT";
        /// Displacement, an extension that this model has the rules of and nothing else.
        DISPLACEMENT_MICROMAP = 1_000_397_000, "VK_MICROMAP_TYPE_DISPLACEMENT_MICROMAP_NV";
    }
}

open_flags! {
    /// How a micromap object is made:
    /// [`VkMicromapCreateFlagBitsEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkMicromapCreateFlagBitsEXT.html).
    #[doc(alias = "VkMicromapCreateFlagBitsEXT")]
    #[doc(alias = "VkMicromapCreateFlagsEXT")]
    pub struct MicromapCreateFlags: u32 {
        /// The object's device address can be saved and asked for again in a later run.
        DEVICE_ADDRESS_CAPTURE_REPLAY = 1 << 0, "VK_MICROMAP_CREATE_DEVICE_ADDRESS_CAPTURE_REPLAY_BIT_EXT";
    }
}

extensible! {
    /// A new micromap object in a range of a buffer:
    /// [`VkMicromapCreateInfoEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkMicromapCreateInfoEXT.html).
    #[doc(alias = "VkMicromapCreateInfoEXT")]
    pub struct MicromapCreateInfo: MICROMAP_CREATE_INFO {
        /// How the object is made.
        pub create_flags: MicromapCreateFlags,
        /// The buffer that holds the micromap.
        pub buffer: Buffer,
        /// Bytes from the start of the buffer to the micromap.
        pub offset: DeviceSize,
        /// Bytes that the micromap may use.
        pub size: DeviceSize,
        /// What the micromap is for.
        #[doc(alias = "type")]
        pub ty: MicromapType,
        /// The device address wished for when replaying, otherwise null.
        pub device_address: DeviceAddress,
    }
}

open_enum! {
    /// Whether a micromap build starts afresh, which is all it can do:
    /// [`VkBuildMicromapModeEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkBuildMicromapModeEXT.html).
    #[doc(alias = "VkBuildMicromapModeEXT")]
    pub struct BuildMicromapMode {
        /// From the given data alone.
        BUILD = 0, "VK_BUILD_MICROMAP_MODE_BUILD_EXT";
    }
}

open_flags! {
    /// What a micromap build allows and prefers:
    /// [`VkBuildMicromapFlagBitsEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkBuildMicromapFlagBitsEXT.html).
    #[doc(alias = "VkBuildMicromapFlagBitsEXT")]
    #[doc(alias = "VkBuildMicromapFlagsEXT")]
    pub struct BuildMicromapFlags: u32 {
        /// Fast tracing matters more than a fast build.
        PREFER_FAST_TRACE = 1 << 0, "VK_BUILD_MICROMAP_PREFER_FAST_TRACE_BIT_EXT";
        /// A fast build matters more than fast tracing.
        PREFER_FAST_BUILD = 1 << 1, "VK_BUILD_MICROMAP_PREFER_FAST_BUILD_BIT_EXT";
        /// The micromap can be the source of a compacting copy.
        ALLOW_COMPACTION = 1 << 2, "VK_BUILD_MICROMAP_ALLOW_COMPACTION_BIT_EXT";
    }
}

/// How many micromap triangles there are of one level and format:
/// [`VkMicromapUsageEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkMicromapUsageEXT.html).
///
/// Differs from [`MicromapUsage`] in the type of `format` only.
#[doc(alias = "VkMicromapUsageEXT")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct MicromapUsageExt {
    /// Triangles of this level and format.
    pub count: u32,
    /// How often each triangle is divided; a triangle of level n has 4ⁿ microtriangles.
    pub subdivision_level: u32,
    /// How their opacity is encoded; for opacity a value of [`OpacityMicromapFormat`].
    pub format: u32,
}

extensible! {
    /// One micromap build:
    /// [`VkMicromapBuildInfoEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkMicromapBuildInfoEXT.html).
    #[doc(alias = "VkMicromapBuildInfoEXT")]
    pub struct MicromapBuildInfo: MICROMAP_BUILD_INFO {
        /// What is built.
        #[doc(alias = "type")]
        pub ty: MicromapType,
        /// What the build allows and prefers.
        pub flags: BuildMicromapFlags,
        /// Has to say build.
        pub mode: BuildMicromapMode,
        /// The micromap that is written.
        pub dst_micromap: Micromap,
        /// `pUsageCounts`: how many triangles of which level and format; `None` is a null pointer.
        #[doc(alias = "pUsageCounts")]
        pub usage_counts: Option<Vec<MicromapUsageExt>>,
        /// `ppUsageCounts`: the same through an array of pointers; `None` is a null pointer.
        #[doc(alias = "ppUsageCounts")]
        pub usage_count_pointers: Option<Vec<MicromapUsageExt>>,
        /// Where the opacity of the microtriangles begins.
        pub data: DeviceOrHostAddress,
        /// Memory that the build may use while it runs.
        pub scratch_data: DeviceOrHostAddress,
        /// Where the [`MicromapTriangle`] entries begin.
        pub triangle_array: DeviceOrHostAddress,
        /// Bytes from one entry to the next.
        pub triangle_array_stride: DeviceSize,
    }
}

impl MicromapBuildInfo {
    /// The usages, from whichever of the two arrays is there, the direct one first.
    pub fn usages(&self) -> impl Iterator<Item = &MicromapUsageExt> {
        either(self.usage_counts.as_ref(), self.usage_count_pointers.as_ref())
    }
}

extensible! {
    /// How much memory a micromap build takes:
    /// [`VkMicromapBuildSizesInfoEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkMicromapBuildSizesInfoEXT.html).
    #[doc(alias = "VkMicromapBuildSizesInfoEXT")]
    pub struct MicromapBuildSizesInfo: MICROMAP_BUILD_SIZES_INFO {
        /// Bytes for the micromap itself.
        pub micromap_size: DeviceSize,
        /// Bytes of scratch memory for the build.
        pub build_scratch_size: DeviceSize,
        /// Whether the micromap may be destroyed once the acceleration structures that use it are built.
        pub discardable: Bool32,
    }
}

extensible! {
    /// A micromap object attached to triangles, chained to a [`GeometryTrianglesData`]:
    /// [`VkAccelerationStructureTrianglesOpacityMicromapEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureTrianglesOpacityMicromapEXT.html).
    #[doc(alias = "VkAccelerationStructureTrianglesOpacityMicromapEXT")]
    pub struct TrianglesOpacityMicromapExt: ACCELERATION_STRUCTURE_TRIANGLES_OPACITY_MICROMAP_EXT {
        /// How an index is stored; [`IndexType::NONE`] where triangle i of the geometry uses micromap triangle `base_triangle` + i.
        pub index_type: IndexType,
        /// Where the indices begin.
        pub index_buffer: DeviceOrHostAddress,
        /// Bytes from one index to the next.
        pub index_stride: DeviceSize,
        /// What is added to every index that is not a special one.
        pub base_triangle: u32,
        /// `pUsageCounts`: how many triangles of the geometry use which level and format; `None` is a null pointer.
        #[doc(alias = "pUsageCounts")]
        pub usage_counts: Option<Vec<MicromapUsageExt>>,
        /// `ppUsageCounts`: the same through an array of pointers; `None` is a null pointer.
        #[doc(alias = "ppUsageCounts")]
        pub usage_count_pointers: Option<Vec<MicromapUsageExt>>,
        /// The micromap; null where every index is special.
        pub micromap: Micromap,
    }
}

impl TrianglesOpacityMicromapExt {
    /// The usages, from whichever of the two arrays is there, the direct one first.
    pub fn usages(&self) -> impl Iterator<Item = &MicromapUsageExt> {
        either(self.usage_counts.as_ref(), self.usage_count_pointers.as_ref())
    }
}

open_enum! {
    /// What a copy of a micromap object does:
    /// [`VkCopyMicromapModeEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCopyMicromapModeEXT.html).
    ///
    /// The numbers differ from those of [`CopyAccelerationStructureMode`].
    #[doc(alias = "VkCopyMicromapModeEXT")]
    pub struct CopyMicromapMode {
        /// Makes a micromap with the same content.
        CLONE = 0, "VK_COPY_MICROMAP_MODE_CLONE_EXT";
        /// Writes the micromap to memory in a form that outlives the device.
        SERIALIZE = 1, "VK_COPY_MICROMAP_MODE_SERIALIZE_EXT";
        /// Reads a micromap from that form.
        DESERIALIZE = 2, "VK_COPY_MICROMAP_MODE_DESERIALIZE_EXT";
        /// Makes a smaller micromap with the same content.
        COMPACT = 3, "VK_COPY_MICROMAP_MODE_COMPACT_EXT";
    }
}

extensible! {
    /// A copy from micromap to micromap:
    /// [`VkCopyMicromapInfoEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCopyMicromapInfoEXT.html).
    #[doc(alias = "VkCopyMicromapInfoEXT")]
    pub struct CopyMicromapInfo: COPY_MICROMAP_INFO {
        /// The micromap that is read.
        pub src: Micromap,
        /// The micromap that is written.
        pub dst: Micromap,
        /// Whether to clone or to compact.
        pub mode: CopyMicromapMode,
    }
}

extensible! {
    /// A copy from a micromap to memory:
    /// [`VkCopyMicromapToMemoryInfoEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCopyMicromapToMemoryInfoEXT.html).
    #[doc(alias = "VkCopyMicromapToMemoryInfoEXT")]
    pub struct CopyMicromapToMemoryInfo: COPY_MICROMAP_TO_MEMORY_INFO {
        /// The micromap that is read.
        pub src: Micromap,
        /// Where the serialized bytes go.
        pub dst: DeviceOrHostAddress,
        /// Has to say serialize.
        pub mode: CopyMicromapMode,
    }
}

extensible! {
    /// A copy from memory to a micromap:
    /// [`VkCopyMemoryToMicromapInfoEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkCopyMemoryToMicromapInfoEXT.html).
    #[doc(alias = "VkCopyMemoryToMicromapInfoEXT")]
    pub struct CopyMemoryToMicromapInfo: COPY_MEMORY_TO_MICROMAP_INFO {
        /// Where the serialized bytes are.
        pub src: DeviceOrHostAddress,
        /// The micromap that is written.
        pub dst: Micromap,
        /// Has to say deserialize.
        pub mode: CopyMicromapMode,
    }
}

extensible! {
    /// The first bytes of a serialized micromap, to be compared with a device:
    /// [`VkMicromapVersionInfoEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkMicromapVersionInfoEXT.html).
    #[doc(alias = "VkMicromapVersionInfoEXT")]
    pub struct MicromapVersionInfo: MICROMAP_VERSION_INFO {
        /// Driver UUID and compatibility UUID, twice [`UUID_SIZE`] bytes.
        #[doc(alias = "pVersionData")]
        pub version_data: Vec<u8>,
    }
}
