//! A structure says what it is.

use omm_model::vk;

use super::table::structure::Structure;
use crate::location::At;
use crate::report::Report;
use crate::violation::ViolationKind;

pub(super) fn check(
    row: &Structure,
    at: &At<'_>,
    found: vk::StructureType,
    required: vk::StructureType,
    report: &mut Report,
) {
    if let Some(rule) = row.s_type
        && found != required
    {
        let kind = ViolationKind::WrongValue { found: found.into(), required: required.into() };
        report.push(rule, &at.field("sType"), kind);
    }
}
