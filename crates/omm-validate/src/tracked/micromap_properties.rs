//! Rules of `vkCmdWriteMicromapsPropertiesEXT` and `vkWriteMicromapsPropertiesEXT` on objects.

use omm_model::call::Call;
use omm_model::vk;
use vk::QueryType;

use super::copy_micromap::{
    bound_memory, compaction_allowed, constructed, host_visible_memory, single_instance_memory,
};
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::{QueryStatus, State};
use crate::violation::ViolationKind;

/// Queries that a command writes.
#[derive(Clone, Copy)]
struct Queries {
    query_type: QueryType,
    query_pool: vk::QueryPool,
    first_query: u32,
    count: usize,
}

impl Queries {
    /// What a device command writes.
    fn of(call: &Call) -> Option<Self> {
        let Call::CmdWriteMicromapsProperties { micromaps, query_type, query_pool, first_query, .. } = call else {
            return None;
        };
        let (query_type, query_pool, first_query) = (*query_type, *query_pool, *first_query);
        Some(Self { query_type, query_pool, first_query, count: micromaps.len() })
    }
}

pub(super) fn check(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    if let Some(queries) = Queries::of(call) {
        query_pool_type_07525(command, queries, state, report);
        query_range_07528(command, queries, state, report);
    }
    match call {
        Call::CmdWriteMicromapsProperties { micromaps, .. } => {
            each(command, micromaps, |at, micromap| {
                bound_memory(at, micromap, state, RuleId::PropertiesMemory07527, report);
            });
        }
        Call::WriteMicromapsProperties { micromaps, .. } => {
            each(command, micromaps, |at, micromap| {
                host_visible_memory(at, micromap, state, RuleId::HostPropertiesMemory07577, report);
                single_instance_memory(at, micromap, state, RuleId::HostPropertiesInstances07579, report);
            });
        }
        _ => {}
    }
}

/// Checks what the command finds when it executes.
pub(super) fn check_executed(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    if let Some(queries) = Queries::of(call) {
        queries_unavailable_12417(command, queries, state, report);
    }
    let (micromaps, query_type, source_rule, flag_rule) = match call {
        Call::CmdWriteMicromapsProperties { micromaps, query_type, .. } => {
            (micromaps, query_type, RuleId::PropertiesSource11662, RuleId::CompactedSizeFlag07502)
        }
        Call::WriteMicromapsProperties { micromaps, query_type, .. } => {
            (micromaps, query_type, RuleId::HostPropertiesSource11671, RuleId::HostCompactedSizeFlag07502)
        }
        _ => return,
    };
    each(command, micromaps, |at, micromap| {
        constructed(at, micromap, state, source_rule, report);
        if *query_type == QueryType::MICROMAP_COMPACTED_SIZE {
            compaction_allowed(at, micromap, state, flag_rule, report);
        }
    });
}

/// Visits every micromap of the command.
fn each(command: &At<'_>, micromaps: &[vk::Micromap], mut visit: impl FnMut(&At<'_>, vk::Micromap)) {
    for (index, micromap) in micromaps.iter().enumerate() {
        visit(&command.element("pMicromaps", index), *micromap);
    }
}

/// The pool's queries take what is asked for. A type that is none of the two breaks another rule.
///
/// VUID-vkCmdWriteMicromapsPropertiesEXT-queryPool-07525
fn query_pool_type_07525(command: &At<'_>, queries: Queries, state: &State, report: &mut Report) {
    let allowed = match queries.query_type {
        QueryType::MICROMAP_COMPACTED_SIZE => &["VK_QUERY_TYPE_MICROMAP_COMPACTED_SIZE_EXT"],
        QueryType::MICROMAP_SERIALIZATION_SIZE => &["VK_QUERY_TYPE_MICROMAP_SERIALIZATION_SIZE_EXT"],
        _ => return,
    };
    let pool = state.query_pool(queries.query_pool).filter(|pool| pool.query_type != queries.query_type);
    if let Some(pool) = pool {
        let kind = ViolationKind::UnexpectedValue { found: pool.query_type.into(), allowed };
        report.push(RuleId::QueryPoolType07525, &command.field("queryPool"), kind);
    }
}

/// The pool has a query for each micromap.
///
/// VUID-vkCmdWriteMicromapsPropertiesEXT-query-07528
fn query_range_07528(command: &At<'_>, queries: Queries, state: &State, report: &mut Report) {
    let Some(pool) = state.query_pool(queries.query_pool) else { return };
    let (found, limit) = (u64::from(queries.first_query).saturating_add(queries.count as u64), pool.query_count.into());
    if found > limit {
        let kind = ViolationKind::AboveLimit { found, limit, from: "the queries of the pool" };
        report.push(RuleId::QueryRange07528, &command.field("firstQuery"), kind);
    }
}

/// Queries are reset before they are written.
///
/// VUID-vkCmdWriteMicromapsPropertiesEXT-None-12417
fn queries_unavailable_12417(command: &At<'_>, queries: Queries, state: &State, report: &mut Report) {
    let Some(pool) = state.query_pool(queries.query_pool) else { return };
    let count = u32::try_from(queries.count).unwrap_or(u32::MAX);
    if let Some((query, status)) = pool.first_not_unavailable(queries.first_query, count) {
        let kind = ViolationKind::QueryState { query, available: status == QueryStatus::Available };
        report.push(RuleId::QueriesUnavailable12417, &command.field("firstQuery"), kind);
    }
}
