//! Rules of the build commands on objects and addresses.

use omm_model::vk;

use super::copy_acceleration_structure::{check_bound, share_memory};
use crate::context::{BuildContext, MicromapDataContext, Purpose};
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::stateless::build_command::attached_micromaps;
use crate::violation::ViolationKind;

pub(super) fn check(build: &BuildContext<'_>, state: &State, report: &mut Report) {
    if !matches!(build.purpose, Purpose::Build { .. }) {
        return;
    }
    dst_acceleration_structure_11547(build, state, report);
    dst_acceleration_structure_11549(build, state, report);
    build.each_geometry(|geometry| {
        geometry.each_micromap_data(|data| {
            micromap_data_11550(data, state, report);
            micromap_data_11551(data, state, report);
            triangle_array_range_11554(data, state, report);
        });
    });
}

/// Checks what a command finds when it executes: the memory of the objects that it reads and writes.
pub(super) fn check_executed(build: &BuildContext<'_>, state: &State, report: &mut Report) {
    if build.purpose == Purpose::Sizes {
        return;
    }
    let info = build.info;
    if info.mode == vk::BuildAccelerationStructureMode::UPDATE {
        let src = info.src_acceleration_structure;
        check_bound(&build.at.field("srcAccelerationStructure").about(src), src, state, report);
    }
    check_bound(&build.at.field("dstAccelerationStructure"), info.dst_acceleration_structure, state, report);
    build.each_geometry(|geometry| {
        geometry.each_opacity_micromap(|attached| {
            check_bound(&attached.at.field("micromap"), attached.attached.micromap, state, report);
        });
    });
}

/// A micromap is built into an object created for it.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-dstAccelerationStructure-11547
fn dst_acceleration_structure_11547(build: &BuildContext<'_>, state: &State, report: &mut Report) {
    let Some(object) = state.acceleration_structure(build.info.dst_acceleration_structure) else {
        return;
    };
    let allowed = [vk::AccelerationStructureType::OPACITY_MICROMAP, vk::AccelerationStructureType::GENERIC];
    if build.is_micromap() && !allowed.contains(&object.ty) {
        let allowed =
            &["VK_ACCELERATION_STRUCTURE_TYPE_OPACITY_MICROMAP_KHR", "VK_ACCELERATION_STRUCTURE_TYPE_GENERIC_KHR"];
        let kind = ViolationKind::UnexpectedValue { found: object.ty.into(), allowed };
        report.push(RuleId::DstAccelerationStructure11547, &build.at.field("dstAccelerationStructure"), kind);
    }
}

/// What a command writes shares no memory with a micromap that it reads.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-dstAccelerationStructure-11549
fn dst_acceleration_structure_11549(build: &BuildContext<'_>, state: &State, report: &mut Report) {
    let dst = build.info.dst_acceleration_structure;
    if state.acceleration_structure(dst).is_none() {
        return;
    }
    // The geometries of a mesh mostly share a micromap, which is compared once.
    let mut last = dst;
    let is_other = |micromap: &vk::AccelerationStructure| std::mem::replace(&mut last, *micromap) != *micromap;
    let mut micromaps =
        build.infos.iter().flat_map(attached_micromaps).filter(is_other).filter(|micromap| *micromap != dst);
    if let Some(micromap) = micromaps.find(|micromap| share_memory(dst, *micromap, state)) {
        let vk::DeviceAddressRange { address, size } = state.address_range(dst).unwrap_or_default();
        let kind = ViolationKind::OverlapsObject { start: address.0, size, other: micromap.0 };
        report.push(RuleId::DstAccelerationStructure11549, &build.at.field("dstAccelerationStructure"), kind);
    }
}

/// Opacity data and triangle array begin in buffers. The stateless part of the rule looks for address 0.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11550
fn micromap_data_11550(data: &MicromapDataContext<'_>, state: &State, report: &mut Report) {
    for (name, address) in [("data", data.data.data), ("triangleArray", data.data.triangle_array)] {
        if !address.is_null() && state.knows_addresses() && state.bytes_from(address).is_none() {
            let kind = ViolationKind::InvalidAddress { found: address.0 };
            report.push(RuleId::MicromapData11550, &data.at.field(name), kind);
        }
    }
}

/// Opacity data and triangle array lie in buffers that builds may read.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11551
fn micromap_data_11551(data: &MicromapDataContext<'_>, state: &State, report: &mut Report) {
    let required = vk::BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY;
    for (name, address) in [("data", data.data.data), ("triangleArray", data.data.triangle_array)] {
        let usages = || state.buffers_at(address).map(|(_, buffer, _, _)| buffer.usage);
        if let Some(found) = usages().next().filter(|_| !usages().any(|usage| usage.contains(required))) {
            let kind = ViolationKind::MissingFlags { found: found.into(), required: required.into() };
            report.push(RuleId::MicromapData11551, &data.at.field(name), kind);
        }
    }
}

/// The triangle array ends before its buffer does.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11554
fn triangle_array_range_11554(data: &MicromapDataContext<'_>, state: &State, report: &mut Report) {
    let start = data.data.triangle_array;
    // No buffer there: another rule's business.
    let Some(available) = state.bytes_from(start) else { return };
    let size = u128::from(data.data.triangle_array_stride) * u128::from(data.triangle_count());
    if size > available.into() {
        let kind = ViolationKind::BeyondBuffer { start: start.0, size, available };
        report.push(RuleId::TriangleArrayRange11554, &data.at.field("triangleArray"), kind);
    }
}
