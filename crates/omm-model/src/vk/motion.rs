//! Motion blur: geometry and instances that move while the shutter is open.

use serde::{Deserialize, Serialize};

use super::chain::extensible;
use super::enumerant::{open_enum, open_flags};
use super::*;

extensible! {
    /// Vertex positions at time 1, chained to a [`GeometryTrianglesData`] that has those at time 0:
    /// [`VkAccelerationStructureGeometryMotionTrianglesDataNV`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureGeometryMotionTrianglesDataNV.html).
    #[doc(alias = "VkAccelerationStructureGeometryMotionTrianglesDataNV")]
    pub struct GeometryMotionTrianglesData: ACCELERATION_STRUCTURE_GEOMETRY_MOTION_TRIANGLES_DATA {
        /// Where the vertices at time 1 begin, in the format and stride of those at time 0.
        pub vertex_data: DeviceOrHostAddress,
    }
}

open_flags! {
    /// Reserved flags of [`AccelerationStructureMotionInfo`], none defined:
    /// [`VkAccelerationStructureMotionInfoFlagsNV`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureMotionInfoFlagsNV.html).
    #[doc(alias = "VkAccelerationStructureMotionInfoFlagsNV")]
    pub struct AccelerationStructureMotionInfoFlags: u32 {}
}

extensible! {
    /// Size of a top-level structure with motion, chained to an [`AccelerationStructureCreateInfo`]:
    /// [`VkAccelerationStructureMotionInfoNV`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureMotionInfoNV.html).
    #[doc(alias = "VkAccelerationStructureMotionInfoNV")]
    pub struct AccelerationStructureMotionInfo: ACCELERATION_STRUCTURE_MOTION_INFO {
        /// The most instances that a build into the structure can have.
        pub max_instances: u32,
        /// Reserved.
        pub flags: AccelerationStructureMotionInfoFlags,
    }
}

open_enum! {
    /// How an instance moves:
    /// [`VkAccelerationStructureMotionInstanceTypeNV`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureMotionInstanceTypeNV.html).
    #[doc(alias = "VkAccelerationStructureMotionInstanceTypeNV")]
    pub struct MotionInstanceType {
        /// Not at all.
        STATIC = 0, "VK_ACCELERATION_STRUCTURE_MOTION_INSTANCE_TYPE_STATIC_NV";
        /// Between two matrices.
        MATRIX_MOTION = 1, "VK_ACCELERATION_STRUCTURE_MOTION_INSTANCE_TYPE_MATRIX_MOTION_NV";
        /// Between two sets of scale, rotation and translation.
        SRT_MOTION = 2, "VK_ACCELERATION_STRUCTURE_MOTION_INSTANCE_TYPE_SRT_MOTION_NV";
    }
}

open_flags! {
    /// Reserved flags of [`MotionInstance`], none defined:
    /// [`VkAccelerationStructureMotionInstanceFlagsNV`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureMotionInstanceFlagsNV.html).
    #[doc(alias = "VkAccelerationStructureMotionInstanceFlagsNV")]
    pub struct MotionInstanceFlags: u32 {}
}

/// An instance that moves between two matrices, 112 bytes in memory:
/// [`VkAccelerationStructureMatrixMotionInstanceNV`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureMatrixMotionInstanceNV.html).
#[doc(alias = "VkAccelerationStructureMatrixMotionInstanceNV")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MatrixMotionInstance {
    /// The transformation at time 0.
    pub transform_t0: TransformMatrix,
    /// The transformation at time 1; in between, each element is interpolated linearly.
    pub transform_t1: TransformMatrix,
    /// A number that shaders can read; memory holds the low 24 bits.
    pub instance_custom_index: u32,
    /// A ray can only hit the instance if its cull mask and this have a bit in common.
    pub mask: u8,
    /// What the instance adds to the index of the hit group; memory holds the low 24 bits.
    pub instance_shader_binding_table_record_offset: u32,
    /// How the instance changes its geometry; memory holds the low 8 bits.
    pub flags: GeometryInstanceFlags,
    /// The bottom-level structure, as in [`Instance::acceleration_structure_reference`].
    pub acceleration_structure_reference: u64,
}

/// A transformation taken apart into scale, shear, pivot, rotation and translation, 64 bytes in memory:
/// [`VkSRTDataNV`](https://docs.vulkan.org/refpages/latest/refpages/source/VkSRTDataNV.html).
///
/// The transformation is translation · rotation · (scale, shear and pivot).
#[doc(alias = "VkSRTDataNV")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SrtData {
    /// Scale along x.
    pub sx: f32,
    /// First shear component.
    pub a: f32,
    /// Second shear component.
    pub b: f32,
    /// Pivot, x.
    pub pvx: f32,
    /// Scale along y.
    pub sy: f32,
    /// Third shear component.
    pub c: f32,
    /// Pivot, y.
    pub pvy: f32,
    /// Scale along z.
    pub sz: f32,
    /// Pivot, z.
    pub pvz: f32,
    /// Rotation quaternion, x.
    pub qx: f32,
    /// Rotation quaternion, y.
    pub qy: f32,
    /// Rotation quaternion, z.
    pub qz: f32,
    /// Rotation quaternion, w.
    pub qw: f32,
    /// Translation after the rotation, x.
    pub tx: f32,
    /// Translation after the rotation, y.
    pub ty: f32,
    /// Translation after the rotation, z.
    pub tz: f32,
}

/// An instance that moves between two decomposed transformations, 144 bytes in memory:
/// [`VkAccelerationStructureSRTMotionInstanceNV`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureSRTMotionInstanceNV.html).
#[doc(alias = "VkAccelerationStructureSRTMotionInstanceNV")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SrtMotionInstance {
    /// The transformation at time 0.
    pub transform_t0: SrtData,
    /// The transformation at time 1; in between, each component is interpolated linearly.
    pub transform_t1: SrtData,
    /// A number that shaders can read; memory holds the low 24 bits.
    pub instance_custom_index: u32,
    /// A ray can only hit the instance if its cull mask and this have a bit in common.
    pub mask: u8,
    /// What the instance adds to the index of the hit group; memory holds the low 24 bits.
    pub instance_shader_binding_table_record_offset: u32,
    /// How the instance changes its geometry; memory holds the low 8 bits.
    pub flags: GeometryInstanceFlags,
    /// The bottom-level structure, as in [`Instance::acceleration_structure_reference`].
    pub acceleration_structure_reference: u64,
}

/// The body of a motion instance:
/// [`VkAccelerationStructureMotionInstanceDataNV`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureMotionInstanceDataNV.html).
///
/// The API's union does not tell which member it holds; the variant does, and may disagree with [`MotionInstance::ty`].
#[doc(alias = "VkAccelerationStructureMotionInstanceDataNV")]
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum MotionInstanceData {
    /// An instance that stands still.
    StaticInstance(Instance),
    /// An instance that moves between two matrices.
    MatrixMotionInstance(MatrixMotionInstance),
    /// An instance that moves between two decomposed transformations.
    SrtMotionInstance(SrtMotionInstance),
}

impl MotionInstanceData {
    /// Which member it is.
    #[must_use]
    pub const fn ty(&self) -> MotionInstanceType {
        match self {
            Self::StaticInstance(_) => MotionInstanceType::STATIC,
            Self::MatrixMotionInstance(_) => MotionInstanceType::MATRIX_MOTION,
            Self::SrtMotionInstance(_) => MotionInstanceType::SRT_MOTION,
        }
    }

    /// The bottom-level structure, as in [`Instance::acceleration_structure_reference`].
    #[must_use]
    pub const fn acceleration_structure_reference(&self) -> u64 {
        match self {
            Self::StaticInstance(instance) => instance.acceleration_structure_reference,
            Self::MatrixMotionInstance(instance) => instance.acceleration_structure_reference,
            Self::SrtMotionInstance(instance) => instance.acceleration_structure_reference,
        }
    }

    /// The same instance of another bottom-level structure.
    #[must_use]
    pub const fn with_reference(mut self, reference: u64) -> Self {
        *match &mut self {
            Self::StaticInstance(instance) => &mut instance.acceleration_structure_reference,
            Self::MatrixMotionInstance(instance) => &mut instance.acceleration_structure_reference,
            Self::SrtMotionInstance(instance) => &mut instance.acceleration_structure_reference,
        } = reference;
        self
    }

    /// All but the transformation and the motion, which are those of [`Instance::default`].
    #[must_use]
    pub const fn at_rest(&self) -> Instance {
        let transform = TransformMatrix { matrix: [[0.0; 4]; 3] };
        match *self {
            Self::StaticInstance(instance) => Instance { transform, ..instance },
            Self::MatrixMotionInstance(MatrixMotionInstance {
                transform_t0: _,
                transform_t1: _,
                instance_custom_index,
                mask,
                instance_shader_binding_table_record_offset,
                flags,
                acceleration_structure_reference,
            })
            | Self::SrtMotionInstance(SrtMotionInstance {
                transform_t0: _,
                transform_t1: _,
                instance_custom_index,
                mask,
                instance_shader_binding_table_record_offset,
                flags,
                acceleration_structure_reference,
            }) => Instance {
                transform,
                instance_custom_index,
                mask,
                instance_shader_binding_table_record_offset,
                flags,
                acceleration_structure_reference,
            },
        }
    }
}

impl Default for MotionInstanceData {
    fn default() -> Self {
        Self::StaticInstance(Instance::default())
    }
}

/// One instance of a top-level structure with motion, 152 bytes in memory, 160 apart in an array:
/// [`VkAccelerationStructureMotionInstanceNV`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureMotionInstanceNV.html).
#[doc(alias = "VkAccelerationStructureMotionInstanceNV")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MotionInstance {
    /// Which member of `data` is meant.
    #[doc(alias = "type")]
    pub ty: MotionInstanceType,
    /// Reserved.
    pub flags: MotionInstanceFlags,
    /// The body.
    pub data: MotionInstanceData,
}
