//! Rules of `VkAccelerationStructureTrianglesOpacityMicromapEXT` on its members.

use omm_model::vk;

use super::micromap_usage_ext;
use super::triangles_opacity_micromap::{index_stride_fits, index_stride_multiple};
use crate::context::micromap_ext::OpacityMicromapExtContext;
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::ViolationKind;

pub(super) fn check(attached: &OpacityMicromapExtContext<'_>, report: &mut Report) {
    attached_usage_counts_07335(attached, report);
    attached_index_type_10719(attached, report);
    attached_index_stride_10722(attached, report);
    attached_index_stride_10723(attached, report);
}

/// Usage counts come through one of the two pointers.
///
/// VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-pUsageCounts-07335
fn attached_usage_counts_07335(attached: &OpacityMicromapExtContext<'_>, report: &mut Report) {
    micromap_usage_ext::both_pointers(attached.usages(), RuleId::AttachedUsageCounts07335, report);
}

/// The index type is one of two widths or none. Numbers that are no index type at all break another rule.
///
/// VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-indexType-10719
fn attached_index_type_10719(attached: &OpacityMicromapExtContext<'_>, report: &mut Report) {
    let found = attached.attached.index_type;
    let allowed = [vk::IndexType::UINT16, vk::IndexType::UINT32, vk::IndexType::NONE].contains(&found);
    if !allowed && found.name().is_some() {
        let allowed = &["VK_INDEX_TYPE_UINT16", "VK_INDEX_TYPE_UINT32", "VK_INDEX_TYPE_NONE_KHR"];
        let kind = ViolationKind::UnexpectedValue { found: found.into(), allowed };
        report.push(RuleId::AttachedIndexType10719, &attached.at.field("indexType"), kind);
    }
}

/// Indices are aligned to their size.
///
/// VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-indexType-10722
fn attached_index_stride_10722(attached: &OpacityMicromapExtContext<'_>, report: &mut Report) {
    let vk::TrianglesOpacityMicromapExt { index_type, index_stride, .. } = *attached.attached;
    index_stride_multiple(&attached.at, index_type, index_stride, RuleId::AttachedIndexStride10722, report);
}

/// The stride fits into 32 bits.
///
/// VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-indexType-10723
fn attached_index_stride_10723(attached: &OpacityMicromapExtContext<'_>, report: &mut Report) {
    let vk::TrianglesOpacityMicromapExt { index_type, index_stride, .. } = *attached.attached;
    index_stride_fits(&attached.at, index_type, index_stride, RuleId::AttachedIndexStride10723, report);
}
