//! What it takes to build a bottom-level acceleration structure with a micromap attached.

use ::ash::vk as ash;

use super::micromap::usages;
use super::{CountError, EitherArray};
use crate::vk;

/// What the pointers and unions of a
/// [`VkAccelerationStructureTrianglesOpacityMicromapEXT`](ash::AccelerationStructureTrianglesOpacityMicromapEXT) hold.
#[derive(Clone, Copy, Debug)]
pub struct TrianglesOpacityMicromapPointers<'a> {
    /// Where the indices lie.
    pub index_buffer: vk::DeviceOrHostAddress,
    /// The elements of `pUsageCounts` or `ppUsageCounts`.
    pub usage_counts: &'a [ash::MicromapUsageEXT],
}

impl vk::TrianglesOpacityMicromapExt {
    /// A micromap attached to triangles, with what its pointers and unions hold. See the [module](crate::ash).
    ///
    /// # Errors
    /// The number of usage counts passed is not `usageCountsCount`.
    pub fn from_ash(
        info: &ash::AccelerationStructureTrianglesOpacityMicromapEXT<'_>,
        pointers: TrianglesOpacityMicromapPointers<'_>,
    ) -> Result<Self, CountError> {
        let &ash::AccelerationStructureTrianglesOpacityMicromapEXT {
            s_type,
            p_next: _,
            index_type,
            index_buffer: _,
            index_stride,
            base_triangle,
            usage_counts_count,
            p_usage_counts,
            pp_usage_counts,
            micromap,
            _marker,
        } = info;
        let TrianglesOpacityMicromapPointers { index_buffer, usage_counts } = pointers;
        let is_null = [p_usage_counts.is_null(), pp_usage_counts.is_null()];
        let [usage_counts, usage_count_pointers] = usages(usage_counts_count, is_null, usage_counts)?;
        Ok(Self {
            s_type: s_type.into(),
            next: vk::Chain::new(),
            index_type: index_type.into(),
            index_buffer,
            index_stride,
            base_triangle,
            usage_counts,
            usage_count_pointers,
            micromap: micromap.into(),
        })
    }
}

/// What the unions of a
/// [`VkAccelerationStructureGeometryTrianglesDataKHR`](ash::AccelerationStructureGeometryTrianglesDataKHR) hold.
#[derive(Clone, Copy, Debug, Default)]
pub struct TrianglesPointers {
    /// Where the vertices lie.
    pub vertex_data: vk::DeviceOrHostAddress,
    /// Where the vertex indices lie.
    pub index_data: vk::DeviceOrHostAddress,
    /// Where the transform lies, or null.
    pub transform_data: vk::DeviceOrHostAddress,
}

impl vk::GeometryTrianglesData {
    /// Triangles, with what the unions hold. The attached micromap is to be pushed to `next`.
    #[must_use]
    pub fn from_ash(
        data: &ash::AccelerationStructureGeometryTrianglesDataKHR<'_>,
        pointers: TrianglesPointers,
    ) -> Self {
        let &ash::AccelerationStructureGeometryTrianglesDataKHR {
            s_type,
            p_next: _,
            vertex_format,
            vertex_data: _,
            vertex_stride,
            max_vertex,
            index_type,
            index_data: _,
            transform_data: _,
            _marker,
        } = data;
        let TrianglesPointers { vertex_data, index_data, transform_data } = pointers;
        Self {
            s_type: s_type.into(),
            next: vk::Chain::new(),
            vertex_format: vertex_format.into(),
            vertex_data,
            vertex_stride,
            max_vertex,
            index_type: index_type.into(),
            index_data,
            transform_data,
        }
    }
}

impl vk::Geometry {
    /// A geometry, with what the union `geometry` holds.
    #[must_use]
    pub fn from_ash(info: &ash::AccelerationStructureGeometryKHR<'_>, geometry: vk::GeometryData) -> Self {
        let &ash::AccelerationStructureGeometryKHR { s_type, p_next: _, geometry_type, geometry: _, flags, _marker } =
            info;
        Self {
            s_type: s_type.into(),
            next: vk::Chain::new(),
            geometry_type: geometry_type.into(),
            geometry,
            flags: flags.into(),
        }
    }
}

/// What the pointers and unions of a
/// [`VkAccelerationStructureBuildGeometryInfoKHR`](ash::AccelerationStructureBuildGeometryInfoKHR) hold.
#[derive(Clone, Debug)]
pub struct BuildGeometryPointers {
    /// The elements of `pGeometries` or `ppGeometries`, [converted](vk::Geometry::from_ash).
    pub geometries: Vec<vk::Geometry>,
    /// Memory for the build.
    pub scratch_data: vk::DeviceOrHostAddress,
}

impl vk::BuildGeometryInfo {
    /// A build, with what its pointers and unions hold. See the [module](crate::ash).
    ///
    /// # Errors
    /// The number of geometries passed is not `geometryCount`.
    pub fn from_ash(
        info: &ash::AccelerationStructureBuildGeometryInfoKHR<'_>,
        pointers: BuildGeometryPointers,
    ) -> Result<Self, CountError> {
        let &ash::AccelerationStructureBuildGeometryInfoKHR {
            s_type,
            p_next: _,
            ty,
            flags,
            mode,
            src_acceleration_structure,
            dst_acceleration_structure,
            geometry_count,
            p_geometries,
            pp_geometries,
            scratch_data: _,
            _marker,
        } = info;
        let BuildGeometryPointers { geometries, scratch_data } = pointers;
        let is_null = [p_geometries.is_null(), pp_geometries.is_null()];
        let array = EitherArray { member: "geometries", count: geometry_count, is_null };
        let [geometries, geometry_pointers] = array.fill(geometries)?;
        Ok(Self {
            s_type: s_type.into(),
            next: vk::Chain::new(),
            ty: ty.into(),
            flags: flags.into(),
            mode: mode.into(),
            src_acceleration_structure: src_acceleration_structure.into(),
            dst_acceleration_structure: dst_acceleration_structure.into(),
            geometries,
            geometry_pointers,
            scratch_data,
        })
    }
}

impl From<ash::AccelerationStructureBuildRangeInfoKHR> for vk::BuildRangeInfo {
    fn from(range: ash::AccelerationStructureBuildRangeInfoKHR) -> Self {
        let ash::AccelerationStructureBuildRangeInfoKHR {
            primitive_count,
            primitive_offset,
            first_vertex,
            transform_offset,
        } = range;
        Self { primitive_count, primitive_offset, first_vertex, transform_offset }
    }
}
