//! Flags have bits that the API names.

use super::table::member::{FLAGS, find};
use crate::location::At;
use crate::report::Report;
use crate::value::Flags;
use crate::violation::ViolationKind;

pub(super) fn check(owner: &str, member: &'static str, at: &At<'_>, found: Flags, known: u64, report: &mut Report) {
    let unknown = found.bits() & !known;
    if unknown != 0
        && let Some(rule) = find(FLAGS, owner, member)
    {
        let forbidden = found.with_bits(unknown);
        report.push(rule, at, ViolationKind::ForbiddenFlags { found, forbidden });
    }
}
