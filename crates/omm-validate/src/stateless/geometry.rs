//! Rules of `VkAccelerationStructureGeometryKHR`.

use omm_model::vk;

use crate::context::GeometryContext;
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::ViolationKind;

pub(super) fn check(geometry: &GeometryContext<'_>, report: &mut Report) {
    if geometry.geometry.geometry_type == vk::GeometryType::MICROMAP {
        micromap_data_11568(geometry, report);
        flags_11569(geometry, report);
    }
}

/// Micromap geometry has its data in its chain, once.
///
/// VUID-VkAccelerationStructureGeometryKHR-micromap-11568
fn micromap_data_11568(geometry: &GeometryContext<'_>, report: &mut Report) {
    let is_data = |structure: &&vk::ChainStructure| matches!(structure, vk::ChainStructure::GeometryMicromapData(_));
    let found = geometry.geometry.next.iter().filter(is_data).count() as u64;
    if found != 1 {
        let at = geometry.at.chained("VkAccelerationStructureGeometryMicromapDataKHR");
        report.push(RuleId::MicromapData11568, &at, ViolationKind::WrongCount { found, required: 1 });
    }
}

/// Micromap geometry has no flags.
///
/// VUID-VkAccelerationStructureGeometryKHR-flags-11569
fn flags_11569(geometry: &GeometryContext<'_>, report: &mut Report) {
    let flags = geometry.geometry.flags;
    if !flags.is_empty() {
        let kind = ViolationKind::ForbiddenFlags { found: flags.into(), forbidden: flags.into() };
        report.push(RuleId::Flags11569, &geometry.at.field("flags"), kind);
    }
}
