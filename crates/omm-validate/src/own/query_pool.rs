//! Queries exist, are reset before they are written, written before they are waited for, and there is room for what is read.

use omm_model::call::Call;
use omm_model::vk;

use super::finding::OwnFinding;
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::{QueryPoolState, QueryStatus, State};
use crate::violation::ViolationKind;

/// What is wrong when a command is called. OMM-query_pool-01
pub(super) fn check(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    match call {
        Call::ResetQueryPool { query_pool, first_query, query_count, .. } => {
            range(command, state.query_pool(*query_pool), *first_query, (*query_count).into(), report);
        }
        Call::GetQueryPoolResults { query_pool, first_query, query_count, data_size, stride, flags, .. } => {
            let Some(pool) = state.query_pool(*query_pool) else { return };
            range(command, Some(pool), *first_query, (*query_count).into(), report);
            if report.is_empty() {
                room(command, (*query_count, *data_size, *stride), *flags, report);
                available(command, pool, (*first_query, *query_count), *flags, report);
            }
        }
        Call::WriteAccelerationStructuresProperties { acceleration_structures, data_size, stride, .. } => {
            let last = (acceleration_structures.len() as u64).checked_sub(1);
            let required = last.map_or(0, |last| last.saturating_mul(*stride).saturating_add(8));
            at_least(&command.field("dataSize"), *data_size, required, report);
        }
        _ => {}
    }
}

/// What a command finds wrong when it executes. OMM-query_pool-01
pub(super) fn check_executed(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    match call {
        Call::CmdResetQueryPool { query_pool, first_query, query_count, .. } => {
            range(command, state.query_pool(*query_pool), *first_query, (*query_count).into(), report);
        }
        Call::CmdWriteAccelerationStructuresProperties {
            acceleration_structures,
            query_type,
            query_pool,
            first_query,
            ..
        } => {
            let Some(pool) = state.query_pool(*query_pool) else { return };
            if pool.query_type != *query_type {
                let kind = ViolationKind::WrongValue { found: (*query_type).into(), required: pool.query_type.into() };
                report.push(RuleId::QueryPool01, &command.field("queryType"), kind);
            }
            let count = acceleration_structures.len() as u64;
            range(command, Some(pool), *first_query, count, report);
            let found = pool.first_not_unavailable(*first_query, u32::try_from(count).unwrap_or(u32::MAX));
            if let Some((query, status)) = found {
                let kind = ViolationKind::QueryState { query, available: status == QueryStatus::Available };
                report.push(RuleId::QueryPool01, &command.field("firstQuery"), kind);
            }
        }
        _ => {}
    }
}

fn range(command: &At<'_>, pool: Option<&QueryPoolState>, first: u32, count: u64, report: &mut Report) {
    let Some(limit) = pool.map(|pool| u64::from(pool.query_count)) else { return };
    let found = u64::from(first).saturating_add(count);
    if found > limit {
        let kind = ViolationKind::AboveLimit { found, limit, from: "the queries of the pool" };
        report.push(RuleId::QueryPool01, &command.field("firstQuery"), kind);
    }
}

fn at_least(at: &At<'_>, found: u64, limit: u64, report: &mut Report) {
    if found < limit {
        report.push(RuleId::QueryPool01, at, ViolationKind::BelowLimit { found, limit });
    }
}

/// The program's array has room for the results.
fn room(
    command: &At<'_>,
    (count, data_size, stride): (u32, u64, u64),
    flags: vk::QueryResultFlags,
    report: &mut Report,
) {
    let width = if flags.contains(vk::QueryResultFlags::RESULT_64) { 8 } else { 4 };
    let size = width * if flags.contains(vk::QueryResultFlags::WITH_AVAILABILITY) { 2 } else { 1 };
    if count > 1 {
        at_least(&command.field("stride"), stride, size, report);
    }
    let steps = u64::from(count).checked_sub(1);
    let required = steps.map_or(0, |steps| steps.saturating_mul(stride).saturating_add(size));
    at_least(&command.field("dataSize"), data_size, required, report);
}

/// Queries that are read were reset, and those that are waited for are written.
fn available(
    command: &At<'_>,
    pool: &QueryPoolState,
    (first, count): (u32, u32),
    flags: vk::QueryResultFlags,
    report: &mut Report,
) {
    let queries = || (first..).take(count as usize).filter_map(|query| Some((query, pool.status(query)?)));
    if let Some((query, _)) = queries().find(|(_, status)| *status == QueryStatus::NeverReset) {
        let kind = ViolationKind::QueryState { query, available: false };
        report.push(RuleId::QueryPool01, &command.field("firstQuery"), kind);
    } else if flags.contains(vk::QueryResultFlags::WAIT)
        && let Some((query, _)) = queries().find(|(_, status)| *status == QueryStatus::Unavailable)
    {
        let kind = ViolationKind::Own(OwnFinding::WaitsForever { query });
        report.push(RuleId::QueryPool01, &command.field("flags"), kind);
    }
}
