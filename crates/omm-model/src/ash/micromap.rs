//! Micromap objects: builds, copies, compatibility.

use ::ash::vk as ash;

use super::{CountError, EitherArray};
use crate::vk;

impl From<ash::MicromapUsageEXT> for vk::MicromapUsageExt {
    fn from(usage: ash::MicromapUsageEXT) -> Self {
        let ash::MicromapUsageEXT { count, subdivision_level, format } = usage;
        Self { count, subdivision_level, format }
    }
}

impl From<ash::MicromapTriangleEXT> for vk::MicromapTriangle {
    fn from(triangle: ash::MicromapTriangleEXT) -> Self {
        let ash::MicromapTriangleEXT { data_offset, subdivision_level, format } = triangle;
        Self { data_offset, subdivision_level, format }
    }
}

/// What the pointers and unions of a [`VkMicromapBuildInfoEXT`](ash::MicromapBuildInfoEXT) hold.
#[derive(Clone, Copy, Debug)]
pub struct MicromapBuildPointers<'a> {
    /// The elements of `pUsageCounts` or `ppUsageCounts`.
    pub usage_counts: &'a [ash::MicromapUsageEXT],
    /// Where the opacity data lies.
    pub data: vk::DeviceOrHostAddress,
    /// Memory for the build.
    pub scratch_data: vk::DeviceOrHostAddress,
    /// Where the array of micromap triangles lies.
    pub triangle_array: vk::DeviceOrHostAddress,
}

impl vk::MicromapBuildInfo {
    /// A build, with what its pointers and unions hold. See the [module](crate::ash).
    ///
    /// # Errors
    /// The number of usage counts passed is not `usageCountsCount`.
    pub fn from_ash(
        info: &ash::MicromapBuildInfoEXT<'_>,
        pointers: MicromapBuildPointers<'_>,
    ) -> Result<Self, CountError> {
        let &ash::MicromapBuildInfoEXT {
            s_type,
            p_next: _,
            ty,
            flags,
            mode,
            dst_micromap,
            usage_counts_count,
            p_usage_counts,
            pp_usage_counts,
            data: _,
            scratch_data: _,
            triangle_array: _,
            triangle_array_stride,
            _marker,
        } = info;
        let MicromapBuildPointers { usage_counts, data, scratch_data, triangle_array } = pointers;
        let is_null = [p_usage_counts.is_null(), pp_usage_counts.is_null()];
        let [usage_counts, usage_count_pointers] = usages(usage_counts_count, is_null, usage_counts)?;
        Ok(Self {
            s_type: s_type.into(),
            next: vk::Chain::new(),
            ty: ty.into(),
            flags: flags.into(),
            mode: mode.into(),
            dst_micromap: dst_micromap.into(),
            usage_counts,
            usage_count_pointers,
            data,
            scratch_data,
            triangle_array,
            triangle_array_stride,
        })
    }
}

/// The usage counts of a structure.
pub(super) fn usages(
    count: u32,
    is_null: [bool; 2],
    usages: &[ash::MicromapUsageEXT],
) -> Result<[Option<Vec<vk::MicromapUsageExt>>; 2], CountError> {
    let array = EitherArray { member: "usageCounts", count, is_null };
    array.fill(usages.iter().copied().map(Into::into).collect())
}

impl vk::CopyMicromapToMemoryInfo {
    /// A serialization, with what the union `dst` holds.
    #[must_use]
    pub fn from_ash(info: &ash::CopyMicromapToMemoryInfoEXT<'_>, dst: vk::DeviceOrHostAddress) -> Self {
        let &ash::CopyMicromapToMemoryInfoEXT { s_type, p_next: _, src, dst: _, mode, _marker } = info;
        Self { s_type: s_type.into(), next: vk::Chain::new(), src: src.into(), dst, mode: mode.into() }
    }
}

impl vk::CopyMemoryToMicromapInfo {
    /// A deserialization, with what the union `src` holds.
    #[must_use]
    pub fn from_ash(info: &ash::CopyMemoryToMicromapInfoEXT<'_>, src: vk::DeviceOrHostAddress) -> Self {
        let &ash::CopyMemoryToMicromapInfoEXT { s_type, p_next: _, src: _, dst, mode, _marker } = info;
        Self { s_type: s_type.into(), next: vk::Chain::new(), src, dst: dst.into(), mode: mode.into() }
    }
}

impl vk::MicromapVersionInfo {
    /// A question about compatibility, with the 32 bytes that `pVersionData` points to.
    ///
    /// Where that pointer is null, there are no bytes, whatever is passed.
    #[must_use]
    pub fn from_ash(info: &ash::MicromapVersionInfoEXT<'_>, version_data: &[u8; 2 * ash::UUID_SIZE]) -> Self {
        let &ash::MicromapVersionInfoEXT { s_type, p_next: _, p_version_data, _marker } = info;
        let version_data = if p_version_data.is_null() { Vec::new() } else { version_data.to_vec() };
        Self { s_type: s_type.into(), next: vk::Chain::new(), version_data }
    }
}
