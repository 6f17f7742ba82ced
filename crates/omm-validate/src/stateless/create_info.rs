//! Rules of `VkAccelerationStructureCreateInfoKHR`.

use omm_model::call::Call;
use omm_model::vk;

use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::ViolationKind;

pub(super) fn check(call: &Call, command: &At<'_>, report: &mut Report) {
    if let Call::CreateAccelerationStructure { create_info, .. } = call {
        type_11600(&command.pointer("pCreateInfo"), create_info, report);
    }
}

/// Micromaps are created with the newer command.
///
/// VUID-VkAccelerationStructureCreateInfoKHR-type-11600
fn type_11600(at: &At<'_>, create_info: &vk::AccelerationStructureCreateInfo, report: &mut Report) {
    if create_info.ty == vk::AccelerationStructureType::OPACITY_MICROMAP {
        let kind = ViolationKind::ForbiddenValue { found: create_info.ty.into() };
        report.push(RuleId::Type11600, &at.field("type"), kind);
    }
}
