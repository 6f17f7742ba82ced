//! An array is as long as it has to be.

use super::table::member::COUNTS;
use crate::location::At;
use crate::report::Report;
use crate::violation::ViolationKind;

pub(super) fn check(owner: &str, member: &'static str, at: &At<'_>, found: u64, report: &mut Report) {
    let row = COUNTS.iter().find(|(row, _)| row.member == member && row.owner == owner);
    if let Some((row, least)) = row
        && found < *least
    {
        report.push(row.rule, at, ViolationKind::BelowLimit { found, limit: *least });
    }
}
