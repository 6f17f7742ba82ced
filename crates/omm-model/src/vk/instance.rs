//! Instances, the entries of a top-level acceleration structure.

use serde::{Deserialize, Serialize};

use super::enumerant::open_flags;

/// A row-major affine transformation, three rows of four:
/// [`VkTransformMatrixKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkTransformMatrixKHR.html).
///
/// The default is all zeros, as a structure that the application cleared; see [`IDENTITY`](Self::IDENTITY).
#[doc(alias = "VkTransformMatrixKHR")]
#[doc(alias = "VkTransformMatrixNV")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TransformMatrix {
    /// The rows; the last column is the translation.
    pub matrix: [[f32; 4]; 3],
}

impl TransformMatrix {
    /// The transformation that changes nothing.
    pub const IDENTITY: Self = Self { matrix: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]] };
}

open_flags! {
    /// How an instance changes what the geometry inside it says:
    /// [`VkGeometryInstanceFlagBitsKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkGeometryInstanceFlagBitsKHR.html).
    ///
    /// In memory an instance has room for the low eight bits only.
    #[doc(alias = "VkGeometryInstanceFlagBitsKHR")]
    #[doc(alias = "VkGeometryInstanceFlagBitsNV")]
    #[doc(alias = "VkGeometryInstanceFlagsKHR")]
    #[doc(alias = "VkGeometryInstanceFlagsNV")]
    pub struct GeometryInstanceFlags: u32 {
        /// No triangle of the instance is culled because of the side it shows.
        TRIANGLE_FACING_CULL_DISABLE = 1 << 0, "VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR";
        /// Front and back of every triangle of the instance change places.
        TRIANGLE_FLIP_FACING = 1 << 1,
            "VK_GEOMETRY_INSTANCE_TRIANGLE_FLIP_FACING_BIT_KHR",
            "VK_GEOMETRY_INSTANCE_TRIANGLE_FRONT_COUNTERCLOCKWISE_BIT_KHR";
        /// All geometry of the instance counts as opaque, unless the ray says non-opaque.
        FORCE_OPAQUE = 1 << 2, "VK_GEOMETRY_INSTANCE_FORCE_OPAQUE_BIT_KHR";
        /// All geometry of the instance counts as non-opaque, unless the ray says opaque.
        FORCE_NO_OPAQUE = 1 << 3, "VK_GEOMETRY_INSTANCE_FORCE_NO_OPAQUE_BIT_KHR";
        /// The unknown states of micromaps are read as the known state they lean to.
        FORCE_OPACITY_MICROMAP_2_STATE = 1 << 4,
            "VK_GEOMETRY_INSTANCE_FORCE_OPACITY_MICROMAP_2_STATE_BIT_KHR",
            "VK_GEOMETRY_INSTANCE_FORCE_OPACITY_MICROMAP_2_STATE_BIT_EXT",
            "VK_GEOMETRY_INSTANCE_FORCE_OPACITY_MICROMAP_2_STATE_EXT";
        /// Micromaps of the instance are not looked at; the geometry's opaque flag decides.
        DISABLE_OPACITY_MICROMAPS = 1 << 5,
            "VK_GEOMETRY_INSTANCE_DISABLE_OPACITY_MICROMAPS_BIT_KHR",
            "VK_GEOMETRY_INSTANCE_DISABLE_OPACITY_MICROMAPS_BIT_EXT",
            "VK_GEOMETRY_INSTANCE_DISABLE_OPACITY_MICROMAPS_EXT";
    }
}

/// One instance of a bottom-level acceleration structure, 64 bytes in memory:
/// [`VkAccelerationStructureInstanceKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureInstanceKHR.html).
#[doc(alias = "VkAccelerationStructureInstanceKHR")]
#[doc(alias = "VkAccelerationStructureInstanceNV")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Instance {
    /// From the space of the bottom-level structure to the space of the top-level one.
    pub transform: TransformMatrix,
    /// A number that shaders can read; memory holds the low 24 bits.
    pub instance_custom_index: u32,
    /// A ray can only hit the instance if its cull mask and this have a bit in common.
    pub mask: u8,
    /// What the instance adds to the index of the hit group; memory holds the low 24 bits.
    pub instance_shader_binding_table_record_offset: u32,
    /// How the instance changes its geometry; memory holds the low 8 bits.
    pub flags: GeometryInstanceFlags,
    /// The bottom-level structure: its device address in a device build, its handle in a host build, 0 for an inactive instance.
    pub acceleration_structure_reference: u64,
}
