//! Command buffers are where they have to be in their lives, and of the right level.

use omm_model::call::Call;
use omm_model::vk;
use vk::CommandBufferLevel as Level;

use super::finding::OwnFinding;
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::{CommandBufferState, RecordingState, State};
use crate::violation::ViolationKind;

/// OMM-command_buffer-01
pub(super) fn check(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    if let Some(handle) = call.recorded_into() {
        in_state(&command.field("commandBuffer"), state.command_buffer(handle), RecordingState::Recording, report);
    }
    match call {
        Call::BeginCommandBuffer { command_buffer, .. } => {
            let found = state.command_buffer(*command_buffer).map(|found| found.recording);
            if found == Some(RecordingState::Recording) {
                let finding = OwnFinding::RecordingState { found: RecordingState::Recording, required: None };
                push(&command.field("commandBuffer"), finding, report);
            }
        }
        Call::EndCommandBuffer { command_buffer } => {
            let found = state.command_buffer(*command_buffer);
            in_state(&command.field("commandBuffer"), found, RecordingState::Recording, report);
        }
        Call::FreeCommandBuffers { command_pool, command_buffers, .. } => {
            for (index, handle) in command_buffers.iter().enumerate() {
                let pool = state.command_buffer(*handle).and_then(|found| found.command_pool);
                let at = command.element("pCommandBuffers", index);
                if let Some(found) = pool.filter(|found| found != command_pool) {
                    let kind = ViolationKind::OtherHandle { found: found.0, required: command_pool.0 };
                    report.push(RuleId::CommandBuffer01, &at, kind);
                } else if !handle.is_null() && command_buffers.iter().take(index).any(|earlier| earlier == handle) {
                    push(&at, OwnFinding::Twice, report);
                }
            }
        }
        Call::CmdExecuteCommands { command_buffer, command_buffers } => {
            let primary = state.command_buffer(*command_buffer);
            of_level(&command.field("commandBuffer"), primary, Level::PRIMARY, report);
            for (index, handle) in command_buffers.iter().enumerate() {
                let (at, found) = (command.element("pCommandBuffers", index), state.command_buffer(*handle));
                of_level(&at, found, Level::SECONDARY, report);
                in_state(&at, found, RecordingState::Executable, report);
            }
        }
        Call::QueueSubmit { command_buffers, .. } => submission(command_buffers, command, state, report),
        _ => {}
    }
}

fn submission(command_buffers: &[vk::CommandBuffer], command: &At<'_>, state: &State, report: &mut Report) {
    let mut seen = Vec::new();
    for (index, handle) in command_buffers.iter().enumerate() {
        let (at, found) = (command.element("pCommandBuffers", index), state.command_buffer(*handle));
        of_level(&at, found, Level::PRIMARY, report);
        in_state(&at, found, RecordingState::Executable, report);
        let secondary = found.map(CommandBufferState::secondary);
        for handle in std::iter::once(*handle).chain(secondary.into_iter().flatten()) {
            let is_one_time =
                |found: &CommandBufferState| found.usage.contains(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            if state.command_buffer(handle).is_some_and(is_one_time) {
                if seen.contains(&handle) {
                    push(&at, OwnFinding::Twice, report);
                }
                seen.push(handle);
            }
        }
    }
}

fn push(at: &At<'_>, finding: OwnFinding, report: &mut Report) {
    report.push(RuleId::CommandBuffer01, at, ViolationKind::Own(finding));
}

fn in_state(at: &At<'_>, found: Option<&CommandBufferState>, required: RecordingState, report: &mut Report) {
    if let Some(found) = found.map(|found| found.recording).filter(|found| *found != required) {
        push(at, OwnFinding::RecordingState { found, required: Some(required) }, report);
    }
}

fn of_level(at: &At<'_>, found: Option<&CommandBufferState>, required: Level, report: &mut Report) {
    // Of one whose allocation was not seen the level is not known.
    let level = found.filter(|found| found.command_pool.is_some()).map(|found| found.level);
    if level.is_some_and(|level| level != required) {
        push(at, OwnFinding::CommandBufferLevel { required }, report);
    }
}
