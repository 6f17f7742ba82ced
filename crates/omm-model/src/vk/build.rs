//! Builds: what to build from what, and how much memory that takes.

use serde::{Deserialize, Serialize};

use super::chain::extensible;
use super::enumerant::{open_enum, open_flags};
use super::micromap::either;
use super::*;

open_enum! {
    /// Where a build that sizes are asked for will run:
    /// [`VkAccelerationStructureBuildTypeKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureBuildTypeKHR.html).
    #[doc(alias = "VkAccelerationStructureBuildTypeKHR")]
    pub struct AccelerationStructureBuildType {
        /// By host commands.
        HOST = 0, "VK_ACCELERATION_STRUCTURE_BUILD_TYPE_HOST_KHR";
        /// By device commands.
        DEVICE = 1, "VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR";
        /// By either.
        HOST_OR_DEVICE = 2, "VK_ACCELERATION_STRUCTURE_BUILD_TYPE_HOST_OR_DEVICE_KHR";
    }
}

open_enum! {
    /// Whether a build starts afresh:
    /// [`VkBuildAccelerationStructureModeKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkBuildAccelerationStructureModeKHR.html).
    #[doc(alias = "VkBuildAccelerationStructureModeKHR")]
    pub struct BuildAccelerationStructureMode {
        /// From the geometry alone.
        BUILD = 0, "VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR";
        /// From a source structure and changed geometry of the same shape.
        UPDATE = 1, "VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR";
    }
}

open_flags! {
    /// What a build allows and prefers:
    /// [`VkBuildAccelerationStructureFlagBitsKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkBuildAccelerationStructureFlagBitsKHR.html).
    #[doc(alias = "VkBuildAccelerationStructureFlagBitsKHR")]
    #[doc(alias = "VkBuildAccelerationStructureFlagBitsNV")]
    #[doc(alias = "VkBuildAccelerationStructureFlagsKHR")]
    #[doc(alias = "VkBuildAccelerationStructureFlagsNV")]
    pub struct BuildAccelerationStructureFlags: u32 {
        /// The structure can be updated later.
        ALLOW_UPDATE = 1 << 0, "VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR";
        /// The structure can be the source of a compacting copy.
        ALLOW_COMPACTION = 1 << 1, "VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR";
        /// Fast tracing matters more than a fast build.
        PREFER_FAST_TRACE = 1 << 2, "VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR";
        /// A fast build matters more than fast tracing.
        PREFER_FAST_BUILD = 1 << 3, "VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_BUILD_BIT_KHR";
        /// Little scratch memory and a small result matter more than speed.
        LOW_MEMORY = 1 << 4, "VK_BUILD_ACCELERATION_STRUCTURE_LOW_MEMORY_BIT_KHR";
        /// The structure holds motion.
        MOTION = 1 << 5, "VK_BUILD_ACCELERATION_STRUCTURE_MOTION_BIT_NV";
        /// An update may attach other micromaps.
        ALLOW_OPACITY_MICROMAP_UPDATE = 1 << 6,
            "VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_OPACITY_MICROMAP_UPDATE_BIT_KHR",
            "VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_OPACITY_MICROMAP_UPDATE_BIT_EXT",
            "VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_OPACITY_MICROMAP_UPDATE_EXT";
        /// An instance of the structure may disable its micromaps.
        ALLOW_DISABLE_OPACITY_MICROMAPS = 1 << 7,
            "VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_DISABLE_OPACITY_MICROMAPS_BIT_KHR",
            "VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_DISABLE_OPACITY_MICROMAPS_BIT_EXT",
            "VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_DISABLE_OPACITY_MICROMAPS_EXT";
        /// An update may change the opacity values of the attached micromaps, and nothing else about them.
        ALLOW_OPACITY_MICROMAP_DATA_UPDATE = 1 << 8,
            "VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_OPACITY_MICROMAP_DATA_UPDATE_BIT_EXT",
            "VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_OPACITY_MICROMAP_DATA_UPDATE_EXT";
        /// The micromap may be stored with known states replaced by unknown ones.
        MICROMAP_LOSSY = 1 << 10, "VK_BUILD_ACCELERATION_STRUCTURE_MICROMAP_LOSSY_BIT_KHR";
    }
}

extensible! {
    /// One build:
    /// [`VkAccelerationStructureBuildGeometryInfoKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureBuildGeometryInfoKHR.html).
    #[doc(alias = "VkAccelerationStructureBuildGeometryInfoKHR")]
    pub struct BuildGeometryInfo: ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO {
        /// What is built.
        #[doc(alias = "type")]
        pub ty: AccelerationStructureType,
        /// What the build allows and prefers.
        pub flags: BuildAccelerationStructureFlags,
        /// Whether this is a build or an update.
        pub mode: BuildAccelerationStructureMode,
        /// The structure that an update starts from.
        pub src_acceleration_structure: AccelerationStructure,
        /// The structure that is written.
        pub dst_acceleration_structure: AccelerationStructure,
        /// `pGeometries`: the geometries in order; `None` is a null pointer.
        #[doc(alias = "pGeometries")]
        pub geometries: Option<Vec<Geometry>>,
        /// `ppGeometries`: the same through an array of pointers; `None` is a null pointer.
        #[doc(alias = "ppGeometries")]
        pub geometry_pointers: Option<Vec<Geometry>>,
        /// Memory that the build may use while it runs.
        pub scratch_data: DeviceOrHostAddress,
    }
}

impl BuildGeometryInfo {
    /// The geometries, from whichever of the two arrays is there, the direct one first.
    pub fn geometries_iter(&self) -> impl Iterator<Item = &Geometry> {
        either(self.geometries.as_ref(), self.geometry_pointers.as_ref())
    }
}

/// Which part of a geometry's data a build uses, 16 bytes in memory:
/// [`VkAccelerationStructureBuildRangeInfoKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureBuildRangeInfoKHR.html).
#[doc(alias = "VkAccelerationStructureBuildRangeInfoKHR")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct BuildRangeInfo {
    /// Triangles, boxes or instances to build.
    pub primitive_count: u32,
    /// Bytes from the start of the primitive data (indices where there are any, otherwise vertices) to the first one used.
    pub primitive_offset: u32,
    /// What is added to each index, or the first vertex where there are no indices.
    pub first_vertex: u32,
    /// Bytes from the transform address to the matrix.
    pub transform_offset: u32,
}

extensible! {
    /// How much memory a build takes:
    /// [`VkAccelerationStructureBuildSizesInfoKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureBuildSizesInfoKHR.html).
    #[doc(alias = "VkAccelerationStructureBuildSizesInfoKHR")]
    pub struct BuildSizesInfo: ACCELERATION_STRUCTURE_BUILD_SIZES_INFO {
        /// Bytes for the structure itself.
        pub acceleration_structure_size: DeviceSize,
        /// Bytes of scratch memory for an update; 0 where updates are not possible.
        pub update_scratch_size: DeviceSize,
        /// Bytes of scratch memory for a build.
        pub build_scratch_size: DeviceSize,
    }
}
