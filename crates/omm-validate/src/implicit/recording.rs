//! A command is recorded where it may be.

use omm_model::call::Call;
use omm_model::vk;

use super::table::command::Command;
use crate::location::At;
use crate::report::Report;
use crate::state::{RecordingState, State};
use crate::violation::ViolationKind;

pub(super) fn check(row: &Command, call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    let (Some(rules), Some(handle)) = (row.recorded, call.recorded_into()) else { return };
    let Some(command_buffer) = state.command_buffer(handle) else { return };
    let at = command.field("commandBuffer");
    if command_buffer.recording != RecordingState::Recording {
        report.push(rules.recording, &at, ViolationKind::NotRecording { found: command_buffer.recording });
    }
    let required = vk::QueueFlags::COMPUTE;
    if let Some(found) = state.queue_flags(handle)
        && !found.contains(required)
    {
        let kind = ViolationKind::MissingFlags { found: found.into(), required: required.into() };
        report.push(rules.queue, &at, kind);
    }
    if command_buffer.in_render_pass {
        report.push(rules.render_pass, &at, ViolationKind::InsideRenderPass);
    } else if command_buffer.is_suspended {
        report.push(rules.suspended, &at, ViolationKind::SuspendedRenderPass);
    }
}
