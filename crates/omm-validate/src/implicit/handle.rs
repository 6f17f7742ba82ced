//! An object lives.

use omm_model::call::Call;
use omm_model::vk;

use super::table::command::Command;
use super::table::member::HANDLES;
use super::walk::deferred_operation;
use crate::location::{At, Object};
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::violation::ViolationKind;

/// A member or parameter.
pub(super) fn check(
    owner: &str,
    member: &'static str,
    at: &At<'_>,
    object: Object,
    state: &State,
    report: &mut Report,
) {
    if let Some((row, or_null)) = HANDLES.iter().find(|(row, _)| row.member == member && row.owner == owner) {
        check_one(row.rule, at, object, *or_null, state, report);
    }
}

/// The objects that a command is called on.
pub(super) fn check_command(row: &Command, call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    if let (Some(rule), Some(device)) = (row.device, call.device()) {
        let object = (vk::Device::OBJECT_TYPE, device.0);
        check_one(rule, &command.field("device"), object, false, state, report);
        let has_queue = state.device(device).is_none_or(|device| device.has_queue);
        if let Some(rule) = row.queue_count.filter(|_| !has_queue) {
            report.push(rule, &command.field("device"), ViolationKind::BelowLimit { found: 0, limit: 1 });
        }
    }
    if let (Some(rules), Some(command_buffer)) = (row.recorded, call.recorded_into()) {
        let object = (vk::CommandBuffer::OBJECT_TYPE, command_buffer.0);
        check_one(rules.handle, &command.field("commandBuffer"), object, false, state, report);
    }
    if let (Some(rules), Some(operation)) = (row.deferred, deferred_operation(call)) {
        let at = command.field("deferredOperation").about_object(operation);
        check_one(rules.handle, &at, operation, true, state, report);
    }
}

fn check_one(rule: RuleId, at: &At<'_>, object: Object, or_null: bool, state: &State, report: &mut Report) {
    let is_null = object.1 == 0;
    let liveness = state.liveness(object);
    if if is_null { !or_null } else { liveness.is_invalid() } {
        report.push(rule, at, ViolationKind::InvalidHandle { found: object.1, ty: object.0, liveness, or_null });
    }
}
