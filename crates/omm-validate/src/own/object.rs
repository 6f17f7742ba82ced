//! Every object that a command names lives.

use omm_model::call::Call;

use super::named::each_object;
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::violation::ViolationKind;

/// OMM-object-01
pub(super) fn check(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    each_object(call, command, &mut |at, object, or_null| {
        let liveness = state.liveness(object);
        let is_wrong = if object.1 == 0 { !or_null } else { liveness.is_invalid() };
        // One is enough: it may well be named again and again.
        if is_wrong && report.is_empty() {
            let kind = ViolationKind::InvalidHandle { found: object.1, ty: object.0, liveness, or_null };
            report.push(RuleId::Object01, &at.about_object(object), kind);
        }
    });
}
