//! Rules of `vkCmdBuildAccelerationStructuresKHR` and `vkGetAccelerationStructureBuildSizesKHR` on their parameters.

use omm_model::call::Call;
use omm_model::vk;

use crate::context::{BuildContext, MicromapDataContext, Purpose};
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::ViolationKind;

/// What the build reads in blocks has to begin on a multiple of this.
const MICROMAP_INPUT_ALIGNMENT: u64 = 128;

/// `VK_GEOMETRY_TYPE_DENSE_GEOMETRY_FORMAT_TRIANGLES_AMDX`, which builds without ranges and is no part of the vocabulary.
const DENSE_GEOMETRY_FORMAT: vk::GeometryType = vk::GeometryType(1_000_478_000);

pub(super) fn check(build: &BuildContext<'_>, report: &mut Report) {
    if !matches!(build.purpose, Purpose::Build { .. }) {
        return;
    }
    build_range_infos_11543(build, report);
    build_range_infos_11544(build, report);
    mode_11545(build, report);
    src_acceleration_structure_11546(build, report);
    dst_acceleration_structure_11548(build, report);
    build.each_geometry(|geometry| {
        geometry.each_micromap_data(|data| {
            micromap_data_11550(data, report);
            alignment_11552(data, report);
        });
    });
}

/// Checks the parameters of `vkGetAccelerationStructureBuildSizesKHR` that a build does not have.
pub(super) fn check_sizes(call: &Call, command: &At<'_>, report: &mut Report) {
    let Call::GetAccelerationStructureBuildSizes { build_type, build_info, max_primitive_counts, .. } = call else {
        return;
    };
    let counts = max_primitive_counts.as_ref().map(|counts| counts.len() as u64);
    build_type_11614(&command.field("buildType"), *build_type, build_info, report);
    max_primitive_counts_11612(&command.field("pMaxPrimitiveCounts"), counts, build_info, report);
    max_primitive_counts_11613(&command.field("pMaxPrimitiveCounts"), counts, build_info, report);
}

/// Sizes of a micromap are those of a device build.
///
/// VUID-vkGetAccelerationStructureBuildSizesKHR-buildType-11614
fn build_type_11614(
    at: &At<'_>,
    found: vk::AccelerationStructureBuildType,
    info: &vk::BuildGeometryInfo,
    report: &mut Report,
) {
    let is_micromap = info.ty == vk::AccelerationStructureType::OPACITY_MICROMAP;
    if is_micromap && found != vk::AccelerationStructureBuildType::DEVICE {
        let allowed = &["VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR"];
        report.push(RuleId::BuildType11614, at, ViolationKind::UnexpectedValue { found: found.into(), allowed });
    }
}

/// Sizes are asked for with a count for each geometry.
///
/// VUID-vkGetAccelerationStructureBuildSizesKHR-pMaxPrimitiveCounts-11612
fn max_primitive_counts_11612(at: &At<'_>, counts: Option<u64>, info: &vk::BuildGeometryInfo, report: &mut Report) {
    each_geometry_counted(at, counts, info, RuleId::MaxPrimitiveCounts11612, report);
}

/// Sizes of a micromap are asked for without counts.
///
/// VUID-vkGetAccelerationStructureBuildSizesKHR-pMaxPrimitiveCounts-11613
fn max_primitive_counts_11613(at: &At<'_>, counts: Option<u64>, info: &vk::BuildGeometryInfo, report: &mut Report) {
    if info.ty == vk::AccelerationStructureType::OPACITY_MICROMAP && counts.is_some() {
        report.push(RuleId::MaxPrimitiveCounts11613, at, ViolationKind::PointerNotNull);
    }
}

/// Reports an array that has not one element for each geometry, unless the geometry is a micromap.
fn each_geometry_counted(
    at: &At<'_>,
    found: Option<u64>,
    info: &vk::BuildGeometryInfo,
    rule: RuleId,
    report: &mut Report,
) {
    let required = info.geometries_iter().count() as u64;
    if info.ty == vk::AccelerationStructureType::OPACITY_MICROMAP || required == 0 || found == Some(required) {
        return;
    }
    let kind = match found {
        Some(found) => ViolationKind::WrongCount { found, required },
        None => ViolationKind::ArrayNull { required },
    };
    report.push(rule, at, kind);
}

/// Builds have a range for each geometry.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-ppBuildRangeInfos-11543
fn build_range_infos_11543(build: &BuildContext<'_>, report: &mut Report) {
    let is_dense = |geometry: &vk::Geometry| geometry.geometry_type == DENSE_GEOMETRY_FORMAT;
    let Some((at, ranges)) = build.ranges.filter(|_| !build.info.geometries_iter().any(is_dense)) else { return };
    let found = ranges.map(|ranges| ranges.len() as u64);
    each_geometry_counted(&at, found, build.info, RuleId::BuildRangeInfos11543, report);
}

/// What a command writes is not a micromap that it reads.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-dstAccelerationStructure-11548
fn dst_acceleration_structure_11548(build: &BuildContext<'_>, report: &mut Report) {
    let found = build.info.dst_acceleration_structure;
    let refers = |info: &vk::BuildGeometryInfo| attached_micromaps(info).any(|micromap| micromap == found);
    if let Some(element) = build.infos.iter().position(refers).filter(|_| !found.is_null()) {
        let at = build.at.field("dstAccelerationStructure");
        let kind = ViolationKind::Referenced { found: found.0, element: element as u64 };
        report.push(RuleId::DstAccelerationStructure11548, &at, kind);
    }
}

/// The handles of the micromaps that a build attaches to triangles, null ones included.
pub(crate) fn attached_micromaps(info: &vk::BuildGeometryInfo) -> impl Iterator<Item = vk::AccelerationStructure> {
    info.geometries_iter().filter_map(|geometry| match &geometry.geometry {
        vk::GeometryData::Triangles(triangles) if geometry.geometry_type == vk::GeometryType::TRIANGLES => {
            triangles.opacity_micromap().map(|attached| attached.micromap)
        }
        _ => None,
    })
}

/// Opacity data and triangle array have addresses. The tracked part of the rule looks their buffers up.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11550
fn micromap_data_11550(data: &MicromapDataContext<'_>, report: &mut Report) {
    for (name, address) in [("data", data.data.data), ("triangleArray", data.data.triangle_array)] {
        if address.is_null() {
            let kind = ViolationKind::InvalidAddress { found: 0 };
            report.push(RuleId::MicromapData11550, &data.at.field(name), kind);
        }
    }
}

/// Builds from micromap geometry have no ranges.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-ppBuildRangeInfos-11544
fn build_range_infos_11544(build: &BuildContext<'_>, report: &mut Report) {
    let is_micromap = |geometry: &vk::Geometry| geometry.geometry_type == vk::GeometryType::MICROMAP;
    let arrays = [&build.info.geometries, &build.info.geometry_pointers];
    if let Some((at, Some(_))) = &build.ranges
        && arrays.into_iter().flatten().flatten().any(is_micromap)
    {
        report.push(RuleId::BuildRangeInfos11544, at, ViolationKind::PointerNotNull);
    }
}

/// Micromaps are built, never updated.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-mode-11545
fn mode_11545(build: &BuildContext<'_>, report: &mut Report) {
    let found = build.info.mode;
    if build.is_micromap() && found != vk::BuildAccelerationStructureMode::BUILD {
        let allowed = &["VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR"];
        let kind = ViolationKind::UnexpectedValue { found: found.into(), allowed };
        report.push(RuleId::Mode11545, &build.at.field("mode"), kind);
    }
}

/// A micromap build has no source.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-srcAccelerationStructure-11546
fn src_acceleration_structure_11546(build: &BuildContext<'_>, report: &mut Report) {
    let found = build.info.src_acceleration_structure;
    if build.is_micromap() && !found.is_null() {
        let at = build.at.field("srcAccelerationStructure").about(found);
        report.push(RuleId::SrcAccelerationStructure11546, &at, ViolationKind::HandleNotNull { found: found.0 });
    }
}

/// Opacity data and triangle array are aligned.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11552
fn alignment_11552(data: &MicromapDataContext<'_>, report: &mut Report) {
    for (name, address) in [("data", data.data.data), ("triangleArray", data.data.triangle_array)] {
        if !address.is_aligned_to(MICROMAP_INPUT_ALIGNMENT) {
            let kind = ViolationKind::Misaligned { found: address.0, alignment: MICROMAP_INPUT_ALIGNMENT };
            report.push(RuleId::Alignment11552, &data.at.field(name), kind);
        }
    }
}
