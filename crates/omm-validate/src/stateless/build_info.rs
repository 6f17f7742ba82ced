//! Rules of `VkAccelerationStructureBuildGeometryInfoKHR`.

use omm_model::vk;
use vk::BuildAccelerationStructureFlags as BuildFlags;

use super::{MICROMAP_ANY, MICROMAP_EXT, micromap_feature};
use crate::context::{BuildContext, GeometryContext};
use crate::report::Report;
use crate::rule::RuleId;
use crate::value::Found;
use crate::violation::ViolationKind;

pub(super) fn check(build: &BuildContext<'_>, report: &mut Report) {
    type_03654(build, report);
    flags_03796(build, report);
    flags_11558(build, report);
    flags_11709(build, report);
    flags_11710(build, report);
    flags_11711(build, report);
    feature_11559(build, report);
    geometry_count_11560(build, report);
    flags_11562(build, report);
    type_11563(build, report);
    build.each_geometry(|geometry| {
        geometry_type_11561(geometry, report);
        geometry_type_11707(geometry, report);
        lossy_format_11712(geometry, report);
        four_state_level_11564(geometry, report);
        lossy_level_11565(geometry, report);
    });
}

/// The type built must not be left open.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-type-03654
fn type_03654(build: &BuildContext<'_>, report: &mut Report) {
    if build.info.ty == vk::AccelerationStructureType::GENERIC {
        let kind = ViolationKind::ForbiddenValue { found: build.info.ty.into() };
        report.push(RuleId::Type03654, &build.at.field("type"), kind);
    }
}

/// Fast tracing and fast building cannot both be preferred.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-flags-03796
fn flags_03796(build: &BuildContext<'_>, report: &mut Report) {
    let both = BuildFlags::PREFER_FAST_TRACE.union(BuildFlags::PREFER_FAST_BUILD);
    forbid_flags(build, both, BuildFlags::PREFER_FAST_BUILD, RuleId::Flags03796, report);
}

/// Updates either change micromaps or their data.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-flags-11558
fn flags_11558(build: &BuildContext<'_>, report: &mut Report) {
    let data_update = BuildFlags::ALLOW_OPACITY_MICROMAP_DATA_UPDATE;
    let both = BuildFlags::ALLOW_OPACITY_MICROMAP_UPDATE.union(data_update);
    forbid_flags(build, both, data_update, RuleId::Flags11558, report);
}

/// Updates of micromap data belong to the EXT extension.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-flags-11709
fn flags_11709(build: &BuildContext<'_>, report: &mut Report) {
    if !build.features.micromap_ext {
        feature_of_flag(
            build,
            BuildFlags::ALLOW_OPACITY_MICROMAP_DATA_UPDATE,
            &[MICROMAP_EXT],
            RuleId::Flags11709,
            report,
        );
    }
}

/// Updates of micromaps belong to the micromap extensions.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-flags-11710
fn flags_11710(build: &BuildContext<'_>, report: &mut Report) {
    if !build.has_micromaps() {
        feature_of_flag(build, BuildFlags::ALLOW_OPACITY_MICROMAP_UPDATE, MICROMAP_ANY, RuleId::Flags11710, report);
    }
}

/// Disabling micromaps belongs to the micromap extensions.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-flags-11711
fn flags_11711(build: &BuildContext<'_>, report: &mut Report) {
    if !build.has_micromaps() {
        feature_of_flag(build, BuildFlags::ALLOW_DISABLE_OPACITY_MICROMAPS, MICROMAP_ANY, RuleId::Flags11711, report);
    }
}

/// Micromaps are built on devices that have them.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-micromap-11559
fn feature_11559(build: &BuildContext<'_>, report: &mut Report) {
    micromap_feature(build.info.ty, build.features, &build.at.field("type"), RuleId::Feature11559, report);
}

/// A micromap is built from one geometry.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-geometryCount-11560
fn geometry_count_11560(build: &BuildContext<'_>, report: &mut Report) {
    let found = build.info.geometries_iter().count() as u64;
    if build.is_micromap() && found != 1 {
        let kind = ViolationKind::WrongCount { found, required: 1 };
        report.push(RuleId::GeometryCount11560, &build.at.field("geometryCount"), kind);
    }
}

/// A micromap is built from geometry of type micromap.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-geometryType-11561
fn geometry_type_11561(geometry: &GeometryContext<'_>, report: &mut Report) {
    let found = geometry.geometry.geometry_type;
    if geometry.build.is_micromap() && found != vk::GeometryType::MICROMAP {
        let kind = ViolationKind::UnexpectedValue { found: found.into(), allowed: &["VK_GEOMETRY_TYPE_MICROMAP_KHR"] };
        report.push(RuleId::GeometryType11561, &geometry.at.field("geometryType"), kind);
    }
}

/// Geometry of type micromap makes micromaps only.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-geometryType-11707
fn geometry_type_11707(geometry: &GeometryContext<'_>, report: &mut Report) {
    let found = geometry.geometry.geometry_type;
    if !geometry.build.is_micromap() && found == vk::GeometryType::MICROMAP {
        let kind = ViolationKind::ForbiddenValue { found: found.into() };
        report.push(RuleId::GeometryType11707, &geometry.at.field("geometryType"), kind);
    }
}

/// Only 4-state triangles are stored lossily.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-format-11712
fn lossy_format_11712(geometry: &GeometryContext<'_>, report: &mut Report) {
    if !geometry.build.is_lossy() {
        return;
    }
    geometry.each_micromap_data(|data| {
        data.each_usage(|at, usage| {
            if usage.format != vk::OpacityMicromapFormat::FOUR_STATE {
                let allowed = &["VK_OPACITY_MICROMAP_FORMAT_4_STATE_KHR"];
                let kind = ViolationKind::UnexpectedValue { found: usage.format.into(), allowed };
                report.push(RuleId::LossyFormat11712, &at.field("format"), kind);
            }
        });
    });
}

/// A micromap build takes four flags only.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-flags-11562
fn flags_11562(build: &BuildContext<'_>, report: &mut Report) {
    let allowed = BuildFlags::ALLOW_COMPACTION
        .union(BuildFlags::PREFER_FAST_TRACE)
        .union(BuildFlags::PREFER_FAST_BUILD)
        .union(BuildFlags::MICROMAP_LOSSY);
    let forbidden = build.info.flags.difference(allowed);
    if build.is_micromap() && !forbidden.is_empty() {
        let kind = ViolationKind::ForbiddenFlags { found: build.info.flags.into(), forbidden: forbidden.into() };
        report.push(RuleId::Flags11562, &build.at.field("flags"), kind);
    }
}

/// Only micromaps are stored lossily.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-type-11563
fn type_11563(build: &BuildContext<'_>, report: &mut Report) {
    if build.is_lossy() && !build.is_micromap() {
        let allowed = &["VK_ACCELERATION_STRUCTURE_TYPE_OPACITY_MICROMAP_KHR"];
        let kind = ViolationKind::UnexpectedValue { found: build.info.ty.into(), allowed };
        report.push(RuleId::Type11563, &build.at.field("type"), kind);
    }
}

/// Usages of 4-state triangles stay within the limit for exact storage.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-subdivisionLevel-11564
fn four_state_level_11564(geometry: &GeometryContext<'_>, report: &mut Report) {
    if geometry.build.is_lossy() {
        return;
    }
    let limit = geometry.build.limits.max_opacity4_state_subdivision_level;
    geometry.each_micromap_data(|data| {
        data.each_usage(|at, usage| {
            if usage.format == vk::OpacityMicromapFormat::FOUR_STATE && usage.subdivision_level > limit {
                let (found, limit) = (usage.subdivision_level.into(), limit.into());
                let kind = ViolationKind::AboveLimit { found, limit, from: "maxOpacity4StateSubdivisionLevel" };
                report.push(RuleId::FourStateLevel11564, &at.field("subdivisionLevel"), kind);
            }
        });
    });
}

/// Usages of any format stay within the limit for lossy storage.
///
/// VUID-VkAccelerationStructureBuildGeometryInfoKHR-subdivisionLevel-11565
fn lossy_level_11565(geometry: &GeometryContext<'_>, report: &mut Report) {
    if !geometry.build.is_lossy() {
        return;
    }
    let limit = geometry.build.limits.max_opacity_lossy4_state_subdivision_level;
    geometry.each_micromap_data(|data| {
        data.each_usage(|at, usage| {
            if usage.subdivision_level > limit {
                let (found, limit) = (usage.subdivision_level.into(), limit.into());
                let kind = ViolationKind::AboveLimit { found, limit, from: "maxOpacityLossy4StateSubdivisionLevel" };
                report.push(RuleId::LossyLevel11565, &at.field("subdivisionLevel"), kind);
            }
        });
    });
}

/// Reports `forbidden` where the build has all the flags of `together`.
fn forbid_flags(
    build: &BuildContext<'_>,
    together: BuildFlags,
    forbidden: BuildFlags,
    rule: RuleId,
    report: &mut Report,
) {
    if build.info.flags.contains(together) {
        let kind = ViolationKind::ForbiddenFlags { found: build.info.flags.into(), forbidden: forbidden.into() };
        report.push(rule, &build.at.field("flags"), kind);
    }
}

/// Reports `flag` as one that needs one of `features`.
fn feature_of_flag(
    build: &BuildContext<'_>,
    flag: BuildFlags,
    features: &'static [&'static str],
    rule: RuleId,
    report: &mut Report,
) {
    if build.info.flags.contains(flag) {
        let kind = ViolationKind::NeedsFeature { found: Some(Found::Flags(build.info.flags.into())), features };
        report.push(rule, &build.at.field("flags"), kind);
    }
}
