//! Rules of deferred operations on what was deferred on them.

use omm_model::call::Call;

use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::violation::ViolationKind;

pub(super) fn check(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    if let Call::DestroyDeferredOperation { operation, .. } = call {
        let pending = state.deferred_operation(*operation).and_then(|operation| operation.pending.as_deref());
        if let Some(deferred) = pending {
            operation_03436(&command.field("operation"), deferred, report);
        }
    }
}

/// An operation is complete before it is destroyed.
///
/// VUID-vkDestroyDeferredOperationKHR-operation-03436
fn operation_03436(at: &At<'_>, deferred: &Call, report: &mut Report) {
    report.push(RuleId::Operation03436, at, ViolationKind::Pending { command: deferred.command() });
}
