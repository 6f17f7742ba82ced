//! An enumerant has a value that the API names.

use super::table::member::{ENUMERANTS, OTHER_QUERY_TYPES, find};
use crate::location::At;
use crate::report::Report;
use crate::value::Constant;
use crate::violation::ViolationKind;

pub(super) fn check(owner: &str, member: &'static str, at: &At<'_>, found: Constant, report: &mut Report) {
    let is_other_query = found.type_name == "VkQueryType" && OTHER_QUERY_TYPES.contains(&found.value);
    if found.name.is_none()
        && !is_other_query
        && let Some(rule) = find(ENUMERANTS, owner, member)
    {
        report.push(rule, at, ViolationKind::UnknownEnumerant { found });
    }
}
