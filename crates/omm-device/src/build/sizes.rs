//! Build sizes, which follow from counts alone.

use omm_layout::object::{BlasGeometrySize, ObjectKind, blas_size, micromap_size, tlas_size};
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::profile::Limits;
use omm_model::usage::MicromapUsage;
use omm_model::vk;

use super::geometry::{self, Body};
use super::lossy;
use crate::acceleration_structure::kind_of;
use crate::micromap::check_type;
use crate::undefined::{At, Reason, Stop};

/// `vkGetAccelerationStructureBuildSizesKHR`. Where a build will run makes no difference.
pub(crate) fn query(
    limits: &Limits,
    build_type: vk::AccelerationStructureBuildType,
    info: &vk::BuildGeometryInfo,
    max_primitive_counts: Option<&[u32]>,
) -> Result<vk::BuildSizesInfo, Stop> {
    if build_type.name().is_none() {
        return Err(Reason::UnknownValue { found: build_type.0.into() }).at("buildType");
    }
    let kind = kind_of(info.ty).ok_or(Reason::UnknownValue { found: info.ty.0.into() }).at("pBuildInfo->type")?;
    let required = if kind == ObjectKind::Micromap { 0 } else { info.geometries_iter().count() as u64 };
    let counts = match max_primitive_counts {
        Some(counts) => counts,
        None if required == 0 => &[],
        None => {
            return Err(Reason::Missing { what: "the array of primitive counts" }).at("pMaxPrimitiveCounts");
        }
    };
    if kind != ObjectKind::Micromap && counts.len() as u64 != required {
        return Err(Reason::CountMismatch { found: counts.len() as u64, required }).at("pMaxPrimitiveCounts");
    }
    let size = structure_size(limits, info, kind, counts).at("pBuildInfo->")?;
    Ok(vk::BuildSizesInfo {
        acceleration_structure_size: size,
        update_scratch_size: update_scratch_size(info, size),
        build_scratch_size: build_scratch_size(size),
        ..Default::default()
    })
}

/// Bytes of scratch memory for a build of a structure of so many bytes: an eighth of them, in steps of 256.
///
/// The device needs none. It asks for some all the same, because a real one does and an application has to provide it.
pub(crate) const fn build_scratch_size(structure_size: u64) -> u64 {
    // An eighth of any number leaves room for a step more.
    (structure_size / 8 / 256 + 1) * 256
}

/// Bytes of scratch memory for an update: 256, or 0 where updates are not allowed.
pub(crate) const fn update_scratch_size(info: &vk::BuildGeometryInfo, _structure_size: u64) -> u64 {
    if info.flags.contains(vk::BuildAccelerationStructureFlags::ALLOW_UPDATE) { 256 } else { 0 }
}

/// Bytes of the structure that a build writes if its geometries have so many primitives. `counts` has an element for every
/// geometry; a micromap's are its usage counts instead.
pub(crate) fn structure_size(
    limits: &Limits,
    info: &vk::BuildGeometryInfo,
    kind: ObjectKind,
    counts: &[u32],
) -> Result<u64, Stop> {
    match kind {
        ObjectKind::Micromap => {
            let (geometry, at) = geometry::only(info)?;
            let mut usages = usages(geometry).at(at)?;
            if info.flags.contains(vk::BuildAccelerationStructureFlags::MICROMAP_LOSSY) {
                for usage in &mut usages {
                    usage.subdivision_level = lossy::stored_level(limits, usage.format, usage.subdivision_level);
                }
            }
            micromap_size(&usages).ok_or_else(overflow)
        }
        ObjectKind::BottomLevel => {
            let array = geometry::array_name(info);
            let mut sizes = Vec::with_capacity(counts.len());
            for (index, (geometry, &count)) in info.geometries_iter().zip(counts).enumerate() {
                sizes.push(geometry_size(geometry, count).at(format_args!("{array}[{index}]"))?);
            }
            blas_size(sizes).ok_or_else(overflow)
        }
        ObjectKind::TopLevel => {
            let (geometry, at) = geometry::only(info)?;
            match geometry::body(geometry).at(&at)? {
                Body::Instances(_) => Ok(tlas_size(counts.first().copied().unwrap_or_default(), info.flags)),
                _ => Err(Reason::GeometryType { found: geometry.geometry_type }).at("geometryType").at(at),
            }
        }
    }
}

fn geometry_size(geometry: &vk::Geometry, count: u32) -> Result<BlasGeometrySize, Stop> {
    match geometry::body(geometry)? {
        Body::Triangles(triangles) => {
            let (micromap, motion) = (super::attached::is_attached(triangles), triangles.motion_data().is_some());
            Ok(BlasGeometrySize::Triangles { count, micromap, motion })
        }
        Body::Aabbs(_) => Ok(BlasGeometrySize::Aabbs { count }),
        _ => Err(Reason::GeometryType { found: geometry.geometry_type }).at("geometryType"),
    }
}

/// `vkGetMicromapBuildSizesEXT`.
///
/// A bottom-level structure keeps a reference to its micromaps, so they are never discardable.
pub(crate) fn query_micromap(
    build_type: vk::AccelerationStructureBuildType,
    info: &vk::MicromapBuildInfo,
) -> Result<vk::MicromapBuildSizesInfo, Stop> {
    if build_type.name().is_none() {
        return Err(Reason::UnknownValue { found: build_type.0.into() }).at("buildType");
    }
    check_type(info.ty).at("pBuildInfo->type")?;
    let size = micromap_object_size(info).at("pBuildInfo->")?;
    Ok(vk::MicromapBuildSizesInfo {
        micromap_size: size,
        build_scratch_size: build_scratch_size(size),
        discardable: vk::Bool32::FALSE,
        ..Default::default()
    })
}

/// Bytes of the micromap that a build of the EXT extension writes.
pub(crate) fn micromap_object_size(info: &vk::MicromapBuildInfo) -> Result<u64, Stop> {
    let array = if info.usage_counts.is_some() { "pUsageCounts" } else { "ppUsageCounts" };
    let usages = info.usages().enumerate().map(|(index, raw)| {
        let &vk::MicromapUsageExt { count, subdivision_level, format } = raw;
        usage(count, subdivision_level, format.into()).at(format_args!("{array}[{index}]"))
    });
    micromap_size(&usages.collect::<Result<Vec<_>, _>>()?).ok_or_else(overflow)
}

fn overflow() -> Stop {
    Reason::TooSmall { required: u64::MAX, available: 1 << 32 }.into()
}

/// The usage counts of a micromap.
fn usages(geometry: &vk::Geometry) -> Result<Vec<MicromapUsage>, Stop> {
    let Body::Micromap(data) = geometry::body(geometry)? else {
        return Err(Reason::GeometryType { found: geometry.geometry_type }).at("geometryType");
    };
    let array = if data.usage_counts.is_some() { "pUsageCounts" } else { "ppUsageCounts" };
    let usages = data.usages().enumerate().map(|(index, raw)| {
        let &vk::MicromapUsage { count, subdivision_level, format } = raw;
        usage(count, subdivision_level, format.0.into()).at(format_args!("{}.{array}[{index}]", super::micromap::DATA))
    });
    usages.collect()
}

/// One usage count.
fn usage(count: u32, subdivision_level: u32, found: i64) -> Result<MicromapUsage, Stop> {
    let format = u32::try_from(found).ok().and_then(OpacityMicromapFormat::from_value);
    let format = format.ok_or(Reason::UnknownValue { found }).at("format")?;
    let subdivision_level = SubdivisionLevel::new(subdivision_level).at("subdivisionLevel")?;
    Ok(MicromapUsage { count, subdivision_level, format })
}
