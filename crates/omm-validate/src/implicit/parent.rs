//! Objects that are used together are of one device.

use omm_model::call::Call;
use omm_model::vk;

use super::table::command::Command;
use super::table::member::{PARENTS, find};
use super::walk::deferred_operation;
use crate::location::{At, Object};
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::violation::ViolationKind;

/// A member or parameter, of the device that the command is called on.
pub(super) fn check(
    owner: &str,
    member: &'static str,
    at: &At<'_>,
    object: Object,
    call: &Call,
    state: &State,
    report: &mut Report,
) {
    if let Some(rule) = find(PARENTS, owner, member) {
        check_one(rule, at, object, call, state, report);
    }
}

/// The operation that a command is deferred on.
pub(super) fn check_command(row: &Command, call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    if let (Some(rules), Some(operation)) = (row.deferred, deferred_operation(call)) {
        let at = command.field("deferredOperation").about_object(operation);
        check_one(rules.parent, &at, operation, call, state, report);
    }
}

fn check_one(rule: RuleId, at: &At<'_>, object: Object, call: &Call, state: &State, report: &mut Report) {
    let (Some(found), Some(required)) = (state.parent(object), call.device()) else { return };
    // A device that is none is another rule's business.
    if !required.is_null() && !state.liveness((vk::Device::OBJECT_TYPE, required.0)).is_invalid() {
        compare(rule, at, found, required, report);
    }
}

fn compare(rule: RuleId, at: &At<'_>, found: vk::Device, required: vk::Device, report: &mut Report) {
    if found != required {
        report.push(rule, at, ViolationKind::WrongParent { found: found.0, required: required.0 });
    }
}

/// Objects that have to be of one device, whichever that is.
pub(super) fn check_common(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    let parent_of_micromap = |micromap: vk::Micromap| state.parent((vk::Micromap::OBJECT_TYPE, micromap.0));
    match call {
        Call::CmdCopyMicromap { info, .. } | Call::CopyMicromap { info, .. } => {
            let (Some(required), Some(found)) = (parent_of_micromap(info.src), parent_of_micromap(info.dst)) else {
                return;
            };
            let at = command.pointer("pInfo");
            compare(
                RuleId::CopyMicromapInfoCommonParent,
                &at.field("dst").about_micromap(info.dst),
                found,
                required,
                report,
            );
        }
        Call::CmdWriteMicromapsProperties { command_buffer, micromaps, query_pool, .. } => {
            let rule = RuleId::CmdWriteMicromapsPropertiesCommonParent;
            let pool = state.parent((vk::QueryPool::OBJECT_TYPE, query_pool.0));
            // The first of which the device is known sets the measure.
            let mut measure = state.parent((vk::CommandBuffer::OBJECT_TYPE, command_buffer.0));
            let mut judge = |at: &At<'_>, found: Option<vk::Device>| match (found, measure) {
                (Some(found), Some(required)) => compare(rule, at, found, required, report),
                (found, None) => measure = found,
                (None, Some(_)) => {}
            };
            judge(&command.field("queryPool").about_object((vk::QueryPool::OBJECT_TYPE, query_pool.0)), pool);
            for (index, micromap) in micromaps.iter().enumerate() {
                let at = command.element("pMicromaps", index).about_micromap(*micromap);
                judge(&at, parent_of_micromap(*micromap));
            }
        }
        _ => {}
    }
}
