//! Geometry, the input of a build.

use serde::{Deserialize, Serialize};

use super::chain::extensible;
use super::enumerant::{open_enum, open_flags};
use super::*;

open_enum! {
    /// What a geometry consists of:
    /// [`VkGeometryTypeKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkGeometryTypeKHR.html).
    #[doc(alias = "VkGeometryTypeKHR")]
    #[doc(alias = "VkGeometryTypeNV")]
    pub struct GeometryType {
        /// Triangles.
        TRIANGLES = 0, "VK_GEOMETRY_TYPE_TRIANGLES_KHR";
        /// Axis-aligned boxes.
        AABBS = 1, "VK_GEOMETRY_TYPE_AABBS_KHR";
        /// Instances of bottom-level acceleration structures.
        INSTANCES = 2, "VK_GEOMETRY_TYPE_INSTANCES_KHR";
        /// A micromap, described by a chained [`GeometryMicromapData`].
        MICROMAP = 1_000_623_000, "VK_GEOMETRY_TYPE_MICROMAP_KHR";
    }
}

open_flags! {
    /// How a geometry is built:
    /// [`VkGeometryFlagBitsKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkGeometryFlagBitsKHR.html).
    #[doc(alias = "VkGeometryFlagBitsKHR")]
    #[doc(alias = "VkGeometryFlagBitsNV")]
    #[doc(alias = "VkGeometryFlagsKHR")]
    #[doc(alias = "VkGeometryFlagsNV")]
    pub struct GeometryFlags: u32 {
        /// Hits do not call the any-hit shader, unless the instance, the ray or a micromap says otherwise.
        OPAQUE = 1 << 0, "VK_GEOMETRY_OPAQUE_BIT_KHR";
        /// The any-hit shader is called at most once for each primitive that a ray meets.
        NO_DUPLICATE_ANY_HIT_INVOCATION = 1 << 1, "VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR";
    }
}

extensible! {
    /// Triangles as input of a build:
    /// [`VkAccelerationStructureGeometryTrianglesDataKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureGeometryTrianglesDataKHR.html).
    #[doc(alias = "VkAccelerationStructureGeometryTrianglesDataKHR")]
    pub struct GeometryTrianglesData: ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA {
        /// How a vertex position is stored.
        pub vertex_format: Format,
        /// Where the vertices begin.
        pub vertex_data: DeviceOrHostAddress,
        /// Bytes from one vertex to the next.
        pub vertex_stride: DeviceSize,
        /// The highest index of a vertex that the build reads.
        pub max_vertex: u32,
        /// How an index is stored; [`IndexType::NONE`] where vertices are taken in order.
        pub index_type: IndexType,
        /// Where the indices begin.
        pub index_data: DeviceOrHostAddress,
        /// Where a [`TransformMatrix`] for the vertices lies; null for none.
        pub transform_data: DeviceOrHostAddress,
    }
}

impl GeometryTrianglesData {
    /// The chained KHR micromap, if any.
    pub fn opacity_micromap(&self) -> Option<&TrianglesOpacityMicromap> {
        self.next.iter().find_map(|structure| match structure {
            ChainStructure::TrianglesOpacityMicromap(found) => Some(found),
            _ => None,
        })
    }

    /// The chained EXT micromap, if any.
    pub fn opacity_micromap_ext(&self) -> Option<&TrianglesOpacityMicromapExt> {
        self.next.iter().find_map(|structure| match structure {
            ChainStructure::TrianglesOpacityMicromapExt(found) => Some(found),
            _ => None,
        })
    }

    /// The chained vertices at the end of the motion, if any.
    pub fn motion_data(&self) -> Option<&GeometryMotionTrianglesData> {
        self.next.iter().find_map(|structure| match structure {
            ChainStructure::GeometryMotionTrianglesData(found) => Some(found),
            _ => None,
        })
    }
}

/// One axis-aligned box, 24 bytes in memory:
/// [`VkAabbPositionsKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAabbPositionsKHR.html).
#[doc(alias = "VkAabbPositionsKHR")]
#[doc(alias = "VkAabbPositionsNV")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AabbPositions {
    /// Lowest x; NaN makes the box inactive.
    pub min_x: f32,
    /// Lowest y.
    pub min_y: f32,
    /// Lowest z.
    pub min_z: f32,
    /// Highest x.
    pub max_x: f32,
    /// Highest y.
    pub max_y: f32,
    /// Highest z.
    pub max_z: f32,
}

extensible! {
    /// Axis-aligned boxes as input of a build:
    /// [`VkAccelerationStructureGeometryAabbsDataKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureGeometryAabbsDataKHR.html).
    #[doc(alias = "VkAccelerationStructureGeometryAabbsDataKHR")]
    pub struct GeometryAabbsData: ACCELERATION_STRUCTURE_GEOMETRY_AABBS_DATA {
        /// Where the [`AabbPositions`] begin.
        pub data: DeviceOrHostAddress,
        /// Bytes from one box to the next.
        pub stride: DeviceSize,
    }
}

extensible! {
    /// Instances as input of a build:
    /// [`VkAccelerationStructureGeometryInstancesDataKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureGeometryInstancesDataKHR.html).
    #[doc(alias = "VkAccelerationStructureGeometryInstancesDataKHR")]
    pub struct GeometryInstancesData: ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA {
        /// Whether `data` holds addresses of instances instead of instances.
        pub array_of_pointers: Bool32,
        /// Where the instances, or their addresses, begin.
        pub data: DeviceOrHostAddress,
    }
}

/// The body of a geometry:
/// [`VkAccelerationStructureGeometryDataKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureGeometryDataKHR.html).
///
/// The API's union does not tell which member it holds; the variant does, and may disagree with [`Geometry::geometry_type`].
#[doc(alias = "VkAccelerationStructureGeometryDataKHR")]
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum GeometryData {
    /// Nothing was written to the union, as for a micromap, whose data is chained.
    #[default]
    None,
    /// Triangles.
    Triangles(GeometryTrianglesData),
    /// Axis-aligned boxes.
    Aabbs(GeometryAabbsData),
    /// Instances.
    Instances(GeometryInstancesData),
}

extensible! {
    /// One geometry of a build:
    /// [`VkAccelerationStructureGeometryKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureGeometryKHR.html).
    #[doc(alias = "VkAccelerationStructureGeometryKHR")]
    pub struct Geometry: ACCELERATION_STRUCTURE_GEOMETRY {
        /// Which member of `geometry` is meant, or that a micromap is chained.
        pub geometry_type: GeometryType,
        /// The body.
        pub geometry: GeometryData,
        /// How the geometry is built.
        pub flags: GeometryFlags,
    }
}

impl Geometry {
    /// The chained micromap input, if any.
    pub fn micromap_data(&self) -> Option<&GeometryMicromapData> {
        self.next.iter().find_map(|structure| match structure {
            ChainStructure::GeometryMicromapData(found) => Some(found),
            _ => None,
        })
    }
}
