//! Rules that need what earlier calls created, bound or recorded. They run after the stateless ones.

mod build_command;
mod build_micromaps;
mod build_micromaps_memory;
mod copy_acceleration_structure;
mod copy_memory_to_micromap;
mod copy_micromap;
mod copy_micromap_to_memory;
mod create_info_2;
mod deferred_operation;
mod micromap_create_info;
mod micromap_properties;
mod triangles_data;
mod triangles_opacity_micromap;
mod triangles_opacity_micromap_ext;
mod update;

use omm_model::call::Call;

use crate::context::micromap_ext::MicromapBuildContext;
use crate::context::{BuildContext, Purpose, command_at, each_build};
use crate::location::At;
use crate::report::Report;
use crate::state::State;

/// Checks a command that executes, with the state that it finds: a host command when it is called, a recorded one when it is
/// submitted. Paths are those of the command itself.
pub(crate) fn check_executed(call: &Call, state: &State, report: &mut Report) {
    let command = &command_at(call);
    copy_micromap::check_executed(call, command, state, report);
    copy_micromap_to_memory::check_executed(call, command, state, report);
    micromap_properties::check_executed(call, command, state, report);
    each_build(call, &state.profile().limits, state.features_for(call), |build| {
        build_command::check_executed(build, state, report);
        build.each_geometry(|geometry| {
            update::check_executed(geometry, state, report);
            triangles_data::check_executed(geometry, state, report);
            geometry.each_opacity_micromap(|attached| {
                triangles_opacity_micromap::check_executed(attached, state, report);
            });
        });
    });
    copy_acceleration_structure::check_executed(call, command, state, report);
}

/// Checks one build structure and all that hangs on it. A query of build sizes ignores objects and addresses, but
/// for micromap objects.
pub(crate) fn check_build(build: &BuildContext<'_>, state: &State, report: &mut Report) {
    build.each_geometry(|geometry| {
        geometry.each_opacity_micromap_ext(|attached| triangles_opacity_micromap_ext::check(attached, state, report));
    });
    if build.purpose == Purpose::Sizes {
        return;
    }
    build_command::check(build, state, report);
    update::check(build, state, report);
    build.each_geometry(|geometry| {
        triangles_data::check(geometry, state, report);
        geometry.each_opacity_micromap(|attached| {
            triangles_opacity_micromap::check(attached, state, report);
        });
    });
}

/// Checks one build structure of a micromap object.
pub(crate) fn check_micromap_build(build: &MicromapBuildContext<'_>, state: &State, report: &mut Report) {
    build_micromaps::check(build, state, report);
}

/// Checks a command as a whole.
pub(crate) fn check_call(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    create_info_2::check(call, command, state, report);
    copy_acceleration_structure::check(call, command, state, report);
    deferred_operation::check(call, command, state, report);
    micromap_create_info::check(call, command, state, report);
    build_micromaps::check_command(call, command, state, report);
    copy_micromap::check(call, command, state, report);
    copy_micromap_to_memory::check(call, command, state, report);
    copy_memory_to_micromap::check(call, command, state, report);
    micromap_properties::check(call, command, state, report);
}
