//! Rules of `vkCmdBuildAccelerationStructuresIndirectKHR` on its parameters.

use crate::context::BuildContext;
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::ViolationKind;

pub(super) fn check(build: &BuildContext<'_>, report: &mut Report) {
    type_11557(build, report);
}

/// Micromaps are not built with ranges from device memory.
///
/// VUID-vkCmdBuildAccelerationStructuresIndirectKHR-type-11557
fn type_11557(build: &BuildContext<'_>, report: &mut Report) {
    if build.is_micromap() {
        let kind = ViolationKind::ForbiddenValue { found: build.info.ty.into() };
        report.push(RuleId::IndirectType11557, &build.at.field("type"), kind);
    }
}
