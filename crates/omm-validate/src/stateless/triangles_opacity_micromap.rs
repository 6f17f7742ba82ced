//! Rules of `VkAccelerationStructureTrianglesOpacityMicromapKHR` on its members.

use omm_model::vk;

use crate::context::{OpacityMicromapContext, Purpose};
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::ViolationKind;

pub(super) fn check(attached: &OpacityMicromapContext<'_>, report: &mut Report) {
    index_type_11570(attached, report);
    if attached.geometry.build.purpose != Purpose::Sizes {
        index_buffer_11571(attached, report);
        index_buffer_11572(attached, report);
    }
    index_stride_11573(attached, report);
    index_stride_11574(attached, report);
    micromap_11579(attached, report);
}

/// The index type is one of three widths or none.
///
/// VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexType-11570
fn index_type_11570(attached: &OpacityMicromapContext<'_>, report: &mut Report) {
    let found = attached.attached.index_type;
    let allowed =
        [vk::IndexType::UINT8, vk::IndexType::UINT16, vk::IndexType::UINT32, vk::IndexType::NONE].contains(&found);
    if !allowed {
        let allowed =
            &["VK_INDEX_TYPE_UINT8", "VK_INDEX_TYPE_UINT16", "VK_INDEX_TYPE_UINT32", "VK_INDEX_TYPE_NONE_KHR"];
        let kind = ViolationKind::UnexpectedValue { found: found.into(), allowed };
        report.push(RuleId::IndexType11570, &attached.at.field("indexType"), kind);
    }
}

/// Without an index type there is no index buffer.
///
/// VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexBuffer-11571
fn index_buffer_11571(attached: &OpacityMicromapContext<'_>, report: &mut Report) {
    let vk::TrianglesOpacityMicromap { index_type, index_buffer, .. } = attached.attached;
    if *index_type == vk::IndexType::NONE && !index_buffer.is_null() {
        let kind = ViolationKind::AddressNotNull { found: index_buffer.0 };
        report.push(RuleId::IndexBuffer11571, &attached.at.field("indexBuffer"), kind);
    }
}

/// With an index type there is an index buffer. The tracked part of the rule looks the buffer up.
///
/// VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexBuffer-11572
fn index_buffer_11572(attached: &OpacityMicromapContext<'_>, report: &mut Report) {
    let vk::TrianglesOpacityMicromap { index_type, index_buffer, .. } = attached.attached;
    if *index_type != vk::IndexType::NONE && index_buffer.is_null() {
        let kind = ViolationKind::InvalidAddress { found: index_buffer.0 };
        report.push(RuleId::IndexBuffer11572, &attached.at.field("indexBuffer"), kind);
    }
}

/// Indices are aligned to their size.
///
/// VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexStride-11573
fn index_stride_11573(attached: &OpacityMicromapContext<'_>, report: &mut Report) {
    let vk::TrianglesOpacityMicromap { index_type, index_stride, .. } = *attached.attached;
    index_stride_multiple(&attached.at, index_type, index_stride, RuleId::IndexStride11573, report);
}

/// The stride fits into 32 bits.
///
/// VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexStride-11574
fn index_stride_11574(attached: &OpacityMicromapContext<'_>, report: &mut Report) {
    let vk::TrianglesOpacityMicromap { index_type, index_stride, .. } = *attached.attached;
    index_stride_fits(&attached.at, index_type, index_stride, RuleId::IndexStride11574, report);
}

/// Without an index type there is a micromap.
///
/// VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-micromap-11579
fn micromap_11579(attached: &OpacityMicromapContext<'_>, report: &mut Report) {
    let vk::TrianglesOpacityMicromap { index_type, micromap, .. } = attached.attached;
    if *index_type == vk::IndexType::NONE && micromap.is_null() {
        report.push(RuleId::Micromap11579, &attached.at.field("micromap"), ViolationKind::HandleNull);
    }
}

/// A stride is a multiple of the size of an index.
pub(super) fn index_stride_multiple(
    at: &At<'_>,
    index_type: vk::IndexType,
    found: u64,
    rule: RuleId,
    report: &mut Report,
) {
    // An unknown type has no size, and without a type there is no stride.
    let size = index_type.size().filter(|size| *size > 0).map(u64::from);
    if let Some(of) = size.filter(|size| !found.is_multiple_of(*size)) {
        report.push(rule, &at.field("indexStride"), ViolationKind::NotMultiple { found, of });
    }
}

/// A stride fits into 32 bits.
pub(super) fn index_stride_fits(at: &At<'_>, index_type: vk::IndexType, found: u64, rule: RuleId, report: &mut Report) {
    let limit = u64::from(u32::MAX);
    if index_type != vk::IndexType::NONE && found > limit {
        let kind = ViolationKind::AboveLimit { found, limit, from: "the largest 32-bit number" };
        report.push(rule, &at.field("indexStride"), kind);
    }
}
