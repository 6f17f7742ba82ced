//! Rules that look at the parameters and at limits of the device, at nothing else. They run first.

pub(crate) mod build_command;
mod build_info;
mod build_micromaps;
mod copy_memory_to_micromap;
mod copy_micromap;
mod copy_micromap_to_memory;
mod create_info;
mod create_info_2;
mod destroy_micromap;
mod geometry;
mod host_build;
mod indirect_build;
mod micromap_build_info;
mod micromap_compatibility;
mod micromap_create_info;
mod micromap_data;
mod micromap_properties;
pub(crate) mod micromap_usage_ext;
pub(crate) mod triangles_data;
mod triangles_opacity_micromap;
mod triangles_opacity_micromap_ext;

use omm_model::call::Call;
use omm_model::profile::Features;
use omm_model::vk;

use crate::context::micromap_ext::MicromapBuildContext;
use crate::context::{BuildContext, Purpose};
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::value::Found;
use crate::violation::ViolationKind;

/// The feature of the KHR extension.
pub(crate) const MICROMAP_KHR: &str = "VkPhysicalDeviceOpacityMicromapFeaturesKHR::micromap";
/// The feature of the EXT extension.
pub(crate) const MICROMAP_EXT: &str = "VkPhysicalDeviceOpacityMicromapFeaturesEXT::micromap";
/// Either.
pub(crate) const MICROMAP_ANY: &[&str] = &[MICROMAP_KHR, MICROMAP_EXT];

/// Checks one build structure and all that hangs on it.
pub(crate) fn check_build(build: &BuildContext<'_>, report: &mut Report) {
    build_info::check(build, report);
    build_command::check(build, report);
    match build.purpose {
        Purpose::Indirect { .. } => indirect_build::check(build, report),
        Purpose::Host => host_build::check(build, report),
        Purpose::Build { .. } | Purpose::Sizes => {}
    }
    build.each_geometry(|geometry| {
        geometry::check(geometry, report);
        geometry.each_micromap_data(|data| micromap_data::check(data, report));
        geometry.each_opacity_micromap(|attached| triangles_opacity_micromap::check(attached, report));
        geometry.each_opacity_micromap_ext(|attached| triangles_opacity_micromap_ext::check(attached, report));
        geometry.each_opacity_micromap_ext(|attached| triangles_data::check(attached, report));
    });
}

/// Checks one build structure of a micromap object.
pub(crate) fn check_micromap_build(build: &MicromapBuildContext<'_>, report: &mut Report) {
    micromap_build_info::check(build, report);
    build_micromaps::check(build, report);
}

/// Checks a command as a whole.
pub(crate) fn check_call(call: &Call, command: &At<'_>, features: &Features, report: &mut Report) {
    create_info::check(call, command, report);
    create_info_2::check(call, command, features, report);
    build_command::check_sizes(call, command, report);
    micromap_create_info::check(call, command, features, report);
    build_micromaps::check_command(call, command, features, report);
    destroy_micromap::check(call, command, features, report);
    micromap_compatibility::check(call, command, features, report);
    copy_micromap::check(call, command, features, report);
    copy_micromap_to_memory::check(call, command, features, report);
    copy_memory_to_micromap::check(call, command, features, report);
    micromap_properties::check(call, command, features, report);
}

/// Reports a micromap on a device that has none.
pub(crate) fn micromap_feature(
    ty: vk::AccelerationStructureType,
    features: &Features,
    at: &At<'_>,
    rule: RuleId,
    report: &mut Report,
) {
    if ty == vk::AccelerationStructureType::OPACITY_MICROMAP && !features.micromap {
        let kind = ViolationKind::NeedsFeature { found: Some(Found::Constant(ty.into())), features: &[MICROMAP_KHR] };
        report.push(rule, at, kind);
    }
}
