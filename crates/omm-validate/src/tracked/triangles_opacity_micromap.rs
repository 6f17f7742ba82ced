//! Rules of `VkAccelerationStructureTrianglesOpacityMicromapKHR` on objects and addresses.

use omm_model::vk;

use crate::context::{OpacityMicromapContext, Purpose};
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::violation::ViolationKind;

pub(super) fn check(attached: &OpacityMicromapContext<'_>, state: &State, report: &mut Report) {
    index_buffer_11572(attached, state, report);
    triangle_index_11576(attached, state, report);
    index_range_11577(attached, state, report);
    let rule = match attached.geometry.build.purpose {
        Purpose::Build { .. } => RuleId::MicromapType11624,
        Purpose::Indirect { .. } => RuleId::IndirectMicromapType11624,
        Purpose::Host | Purpose::Sizes => return,
    };
    micromap_type_11624(attached, rule, state, report);
}

/// Checks what a command finds when it executes.
pub(super) fn check_executed(attached: &OpacityMicromapContext<'_>, state: &State, report: &mut Report) {
    let rule = match attached.geometry.build.purpose {
        Purpose::Build { .. } => RuleId::Micromap11701,
        Purpose::Indirect { .. } => RuleId::IndirectMicromap11701,
        Purpose::Host | Purpose::Sizes => return,
    };
    micromap_11701(attached, rule, state, report);
}

/// A micromap is built before it is read.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11701
fn micromap_11701(attached: &OpacityMicromapContext<'_>, rule: RuleId, state: &State, report: &mut Report) {
    let micromap = attached.attached.micromap;
    if state.acceleration_structure(micromap).is_some_and(|object| object.contents.is_none()) {
        report.push(rule, &attached.at.field("micromap"), ViolationKind::NotBuilt { found: micromap.0 });
    }
}

/// What is attached was built as a micromap; where how is not known, it was created as one.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11624
fn micromap_type_11624(attached: &OpacityMicromapContext<'_>, rule: RuleId, state: &State, report: &mut Report) {
    let micromap = attached.attached.micromap;
    let Some(object) = state.acceleration_structure(micromap) else { return };
    let command_buffer = attached.geometry.build.command_buffer();
    let built = command_buffer.and_then(|command_buffer| state.built(command_buffer, micromap));
    let found = match built {
        Some(built) => built.ty,
        None if object.contents.is_some() && object.ty != vk::AccelerationStructureType::GENERIC => object.ty,
        None => return,
    };
    if found != vk::AccelerationStructureType::OPACITY_MICROMAP {
        let allowed = &["VK_ACCELERATION_STRUCTURE_TYPE_OPACITY_MICROMAP_KHR"];
        let kind = ViolationKind::UnexpectedValue { found: found.into(), allowed };
        report.push(rule, &attached.at.field("micromap"), kind);
    }
}

/// The index buffer ends after the last index.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-indexBuffer-11577
fn index_range_11577(attached: &OpacityMicromapContext<'_>, state: &State, report: &mut Report) {
    let vk::TrianglesOpacityMicromap { index_type, index_buffer: start, index_stride, .. } = *attached.attached;
    let is_here = matches!(attached.geometry.build.purpose, Purpose::Build { .. });
    let count = attached.geometry.primitive_count.filter(|_| is_here && index_type != vk::IndexType::NONE);
    // No buffer there: another rule's business.
    let (Some(count), Some(available)) = (count, state.bytes_from(start)) else { return };
    let size = u128::from(index_stride) * u128::from(count);
    if size > available.into() {
        let kind = ViolationKind::BeyondBuffer { start: start.0, size, available };
        report.push(RuleId::IndexRange11577, &attached.at.field("indexBuffer"), kind);
    }
}

/// The index buffer begins in a buffer. The stateless part of the rule looks for address 0.
///
/// VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexBuffer-11572
fn index_buffer_11572(attached: &OpacityMicromapContext<'_>, state: &State, report: &mut Report) {
    let vk::TrianglesOpacityMicromap { index_type, index_buffer, .. } = attached.attached;
    let needed = *index_type != vk::IndexType::NONE && !index_buffer.is_null();
    if needed && state.knows_addresses() && state.bytes_from(*index_buffer).is_none() {
        let kind = ViolationKind::InvalidAddress { found: index_buffer.0 };
        report.push(RuleId::IndexBuffer11572, &attached.at.field("indexBuffer"), kind);
    }
}

/// Without indices the micromap has a triangle for each of the geometry's.
///
/// VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-geometry-11576
fn triangle_index_11576(attached: &OpacityMicromapContext<'_>, state: &State, report: &mut Report) {
    if attached.attached.index_type != vk::IndexType::NONE {
        return;
    }
    let last = attached.geometry.primitive_count.and_then(|count| count.checked_sub(1));
    let (Some(last), Some(triangles)) = (last, attached.micromap_triangles(state)) else { return };
    let (index, base_triangle) = (u64::from(last), u64::from(attached.attached.base_triangle));
    if index + base_triangle >= triangles {
        let kind = ViolationKind::TriangleOutOfRange { index, base_triangle, triangles };
        report.push(RuleId::TriangleIndex11576, &attached.at.field("baseTriangle"), kind);
    }
}
