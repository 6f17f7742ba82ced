//! Rules of `VkAccelerationStructureGeometryMicromapDataKHR`.

use omm_model::vk;

use crate::context::MicromapDataContext;
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::ViolationKind;

/// Bytes of an entry of the triangle array.
const TRIANGLE_SIZE: u64 = 8;
/// Bytes that entries of the triangle array are aligned to.
const TRIANGLE_ALIGNMENT: u64 = 4;

pub(super) fn check(data: &MicromapDataContext<'_>, report: &mut Report) {
    usage_counts_11642(data, report);
    total_count_11643(data, report);
    two_state_level_11645(data, report);
    triangle_array_stride_11646(data, report);
    triangle_array_stride_11647(data, report);
}

/// Usage counts come through one of the two pointers.
///
/// VUID-VkAccelerationStructureGeometryMicromapDataKHR-pUsageCounts-11642
fn usage_counts_11642(data: &MicromapDataContext<'_>, report: &mut Report) {
    if data.data.usage_counts.is_some() && data.data.usage_count_pointers.is_some() {
        let kind = ViolationKind::BothPointers { members: ["pUsageCounts", "ppUsageCounts"] };
        report.push(RuleId::UsageCounts11642, &data.at.field("pUsageCounts"), kind);
    }
}

/// The usage counts may not describe more triangles than the device can hold.
///
/// VUID-VkAccelerationStructureGeometryMicromapDataKHR-count-11643
fn total_count_11643(data: &MicromapDataContext<'_>, report: &mut Report) {
    let mut found = 0_u64;
    data.each_usage(|_, usage| found = found.saturating_add(usage.count.into()));
    let limit = data.build.limits.max_micromap_triangles;
    if found > limit {
        let kind = ViolationKind::AboveLimit { found, limit, from: "maxMicromapTriangles" };
        report.push(RuleId::TotalCount11643, &data.usages_at(), kind);
    }
}

/// Usages of 2-state triangles stay within the limit.
///
/// VUID-VkAccelerationStructureGeometryMicromapDataKHR-subdivisionLevel-11645
fn two_state_level_11645(data: &MicromapDataContext<'_>, report: &mut Report) {
    let limit = data.build.limits.max_opacity2_state_subdivision_level;
    data.each_usage(|at, usage| {
        if usage.format == vk::OpacityMicromapFormat::TWO_STATE && usage.subdivision_level > limit {
            let (found, limit) = (usage.subdivision_level.into(), limit.into());
            let kind = ViolationKind::AboveLimit { found, limit, from: "maxOpacity2StateSubdivisionLevel" };
            report.push(RuleId::TwoStateLevel11645, &at.field("subdivisionLevel"), kind);
        }
    });
}

/// Entries of the triangle array do not overlap.
///
/// VUID-VkAccelerationStructureGeometryMicromapDataKHR-triangleArrayStride-11646
fn triangle_array_stride_11646(data: &MicromapDataContext<'_>, report: &mut Report) {
    let found = data.data.triangle_array_stride;
    if found < TRIANGLE_SIZE {
        let kind = ViolationKind::BelowLimit { found, limit: TRIANGLE_SIZE };
        report.push(RuleId::TriangleArrayStride11646, &data.at.field("triangleArrayStride"), kind);
    }
}

/// Entries of the triangle array are aligned.
///
/// VUID-VkAccelerationStructureGeometryMicromapDataKHR-triangleArrayStride-11647
fn triangle_array_stride_11647(data: &MicromapDataContext<'_>, report: &mut Report) {
    let found = data.data.triangle_array_stride;
    if !found.is_multiple_of(TRIANGLE_ALIGNMENT) {
        let kind = ViolationKind::NotMultiple { found, of: TRIANGLE_ALIGNMENT };
        report.push(RuleId::TriangleArrayStride11647, &data.at.field("triangleArrayStride"), kind);
    }
}
