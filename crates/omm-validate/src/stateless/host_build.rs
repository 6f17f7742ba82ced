//! Rules of `vkBuildAccelerationStructuresKHR` on its parameters.

use crate::context::{BuildContext, OpacityMicromapContext};
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::ViolationKind;

pub(super) fn check(build: &BuildContext<'_>, report: &mut Report) {
    type_01(build, report);
    build.each_geometry(|geometry| {
        geometry.each_opacity_micromap(|attached| micromap_11705(attached, report));
    });
}

/// Host builds attach no micromap of the KHR extension, which lives on the device alone.
///
/// VUID-vkBuildAccelerationStructuresKHR-pInfos-11705
fn micromap_11705(attached: &OpacityMicromapContext<'_>, report: &mut Report) {
    let micromap = attached.attached.micromap;
    if !micromap.is_null() {
        let kind = ViolationKind::HandleNotNull { found: micromap.0 };
        report.push(RuleId::HostMicromap11705, &attached.at.field("micromap"), kind);
    }
}

/// Micromaps of the KHR extension are not built on the host.
///
/// OMM-host_build-01
fn type_01(build: &BuildContext<'_>, report: &mut Report) {
    if build.is_micromap() {
        let kind = ViolationKind::ForbiddenValue { found: build.info.ty.into() };
        report.push(RuleId::HostBuild01, &build.at.field("type"), kind);
    }
}
