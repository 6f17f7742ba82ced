//! Rules of the build commands on `VkAccelerationStructureTrianglesOpacityMicromapEXT` and motion in the chain of triangles, on
//! objects and addresses.

use omm_model::vk;

use crate::context::micromap_ext::OpacityMicromapExtContext;
use crate::context::{GeometryContext, Purpose};
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::stateless::triangles_data::{index_buffer_at, index_buffer_rules};
use crate::violation::ViolationKind;

pub(super) fn check(geometry: &GeometryContext<'_>, state: &State, report: &mut Report) {
    motion_triangles_04955(geometry, state, report);
    geometry.each_opacity_micromap_ext(|attached| index_buffer_10905(attached, state, report));
}

/// Checks what a command finds when it executes.
pub(super) fn check_executed(geometry: &GeometryContext<'_>, state: &State, report: &mut Report) {
    let rule = match geometry.build.purpose {
        Purpose::Build { .. } => RuleId::ExtMicromap11632,
        Purpose::Indirect { .. } => RuleId::IndirectExtMicromap11632,
        Purpose::Host | Purpose::Sizes => return,
    };
    geometry.each_opacity_micromap_ext(|attached| micromap_11632(attached, rule, state, report));
}

/// The index buffer begins in a buffer. The stateless part of the rule looks for address 0.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-pInfos-10905
fn index_buffer_10905(attached: &OpacityMicromapExtContext<'_>, state: &State, report: &mut Report) {
    let vk::TrianglesOpacityMicromapExt { index_type, index_buffer, .. } = attached.attached;
    let purpose = attached.geometry.build.purpose;
    let Some([_, rule]) = index_buffer_rules(purpose).filter(|_| purpose != Purpose::Host) else { return };
    let Some(address) = index_buffer.device_address().filter(|address| !address.is_null()) else { return };
    if *index_type != vk::IndexType::NONE && state.knows_addresses() && state.bytes_from(address).is_none() {
        let kind = ViolationKind::InvalidAddress { found: address.0 };
        index_buffer_at(attached, |at| report.push(rule, at, kind));
    }
}

/// Motion is built into objects created for it. Objects of the older command have a rule of their own elsewhere.
///
/// VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-04955
fn motion_triangles_04955(geometry: &GeometryContext<'_>, state: &State, report: &mut Report) {
    let required = vk::AccelerationStructureCreateFlags::MOTION;
    let dst = state.acceleration_structure(geometry.build.info.dst_acceleration_structure);
    let Some(dst) = dst.filter(|dst| dst.address_flags.is_some() && !dst.create_flags.contains(required)) else {
        return;
    };
    geometry.with_triangles(|at, triangles| {
        if triangles.motion_data().is_some() {
            let at = at.chained("VkAccelerationStructureGeometryMotionTrianglesDataNV");
            let kind = ViolationKind::MissingFlags { found: dst.create_flags.into(), required: required.into() };
            report.push(RuleId::MotionTriangles04955, &at, kind);
        }
    });
}

/// A micromap object is built before it is read.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11632
fn micromap_11632(attached: &OpacityMicromapExtContext<'_>, rule: RuleId, state: &State, report: &mut Report) {
    let micromap = attached.attached.micromap;
    if state.micromap(micromap).is_some_and(|object| object.contents.is_none()) {
        report.push(rule, &attached.at.field("micromap"), ViolationKind::NotBuilt { found: micromap.0 });
    }
}
