//! A command is deferred on an operation that has no other to complete.

use omm_model::call::Call;

use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::violation::ViolationKind;

/// OMM-deferred_operation-01
pub(super) fn check(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    let operation = call.deferred_operation().and_then(|operation| state.deferred_operation(operation));
    if let Some(pending) = operation.and_then(|operation| operation.pending.as_deref()) {
        let kind = ViolationKind::Pending { command: pending.command() };
        report.push(RuleId::DeferredOperation01, &command.field("deferredOperation"), kind);
    }
}
