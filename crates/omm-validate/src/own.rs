//! Rules that the specification states in words alone, or under identifiers that are outside the catalog's scope, and without
//! which silence would promise nothing: each is general, and holds for all commands.
//!
//! They are of last resort. They run behind all others and only where those have nothing to say of the call, so that a mistake is
//! told once, by the rule that is closest to it. What a command needs when it executes is looked at when it executes: a recorded
//! command at its submission, a deferred one when it is joined too.

mod buffer;
mod build;
mod command_buffer;
mod contents;
mod deferred_operation;
pub(crate) mod finding;
mod instance;
mod memory;
mod micromap_build;
pub(crate) mod named;
mod object;
mod overlap;
mod query_pool;
mod serialized;
mod update;
mod value;

use omm_model::call::Call;
use omm_model::memory::MemoryView;

use crate::context::micromap_ext::each_micromap_build;
use crate::context::{Purpose, command_at, each_build};
use crate::report::Report;
use crate::state::State;
use memory::Executed;

/// Checks a call, whether it acts at once or is recorded.
pub(crate) fn check(call: &Call, state: &State, report: &mut Report) {
    let command = command_at(call);
    object::check(call, &command, state, report);
    command_buffer::check(call, &command, state, report);
    deferred_operation::check(call, &command, state, report);
    buffer::check(call, &command, state, report);
    value::check(call, &command, report);
    query_pool::check(call, &command, state, report);
    each_build(call, &state.profile().limits, state.features_for(call), |build| {
        value::check_build(build, build.purpose == Purpose::Sizes, report);
    });
}

/// Checks a command that executes, with the state and the memory that it finds.
pub(crate) fn check_executed(call: &Call, state: &State, memory: &dyn MemoryView, report: &mut Report) {
    let (command, executed) = (command_at(call), Executed { state, memory, timeline: call.timeline() });
    object::check(call, &command, state, report);
    if !report.is_empty() {
        return;
    }
    contents::check_executed(call, &command, &executed, report);
    serialized::check(call, &command, &executed, report);
    query_pool::check_executed(call, &command, state, report);
    each_build(call, &state.profile().limits, state.features_for(call), |build| {
        if build.purpose != Purpose::Sizes && report.is_empty() {
            build::check(build, &executed, report);
            update::check(build, &executed, report);
        }
    });
    each_micromap_build(call, &state.profile().limits, |build| {
        if build.timeline().is_some() && report.is_empty() {
            micromap_build::check(build, &executed, report);
        }
    });
    if report.is_empty() {
        overlap::check(call, &command, &executed, report);
    }
}
