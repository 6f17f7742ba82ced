//! Query pools.

use std::collections::BTreeMap;
use std::ops::Range;

use omm_model::vk;

use super::State;
use crate::location::Object;

/// What a query is good for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum QueryStatus {
    /// It was not reset since the pool was created.
    NeverReset,
    /// It was reset and can be written.
    Unavailable,
    /// It holds a result.
    Available,
}

/// A query pool.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct QueryPoolState {
    /// What its queries measure.
    pub query_type: vk::QueryType,
    /// How many queries it has.
    pub query_count: u32,
    /// Ranges of queries, not overlapping, with what was last done to them.
    spans: Vec<(Range<u32>, QueryStatus)>,
    /// Which contents a query measured.
    measured: BTreeMap<u32, (Object, u64)>,
}

impl QueryPoolState {
    pub(super) fn new(create_info: &vk::QueryPoolCreateInfo) -> Self {
        let vk::QueryPoolCreateInfo { flags, query_type, query_count, .. } = *create_info;
        let mut new = Self { query_type, query_count, spans: Vec::new(), measured: BTreeMap::new() };
        if flags.contains(vk::QueryPoolCreateFlags::RESET) {
            new.set(0..query_count, QueryStatus::Unavailable);
        }
        new
    }

    /// What a query is good for; `None` if the pool has no such query.
    #[must_use]
    pub fn status(&self, query: u32) -> Option<QueryStatus> {
        let span = self.spans.iter().find(|(queries, _)| queries.contains(&query));
        (query < self.query_count).then(|| span.map_or(QueryStatus::NeverReset, |(_, status)| *status))
    }

    /// The first of some queries that is not ready to be written, and what it is instead. Those that the pool does not have are
    /// passed over.
    #[must_use]
    pub fn first_not_unavailable(&self, first_query: u32, query_count: u32) -> Option<(u32, QueryStatus)> {
        let mut query = first_query;
        let end = first_query.saturating_add(query_count).min(self.query_count);
        while query < end {
            let span = self.spans.iter().find(|(queries, _)| queries.contains(&query));
            match span {
                Some((queries, QueryStatus::Unavailable)) => query = queries.end,
                Some((_, status)) => return Some((query, *status)),
                None => return Some((query, QueryStatus::NeverReset)),
            }
        }
        None
    }

    /// Those of some queries that the pool has.
    fn clipped(&self, first_query: u32, query_count: u32) -> Range<u32> {
        let end = first_query.saturating_add(query_count).min(self.query_count);
        first_query.min(end)..end
    }

    fn set(&mut self, queries: Range<u32>, status: QueryStatus) {
        if queries.is_empty() {
            return;
        }
        let mut spans = Vec::with_capacity(self.spans.len().saturating_add(1));
        for (span, old) in self.spans.drain(..) {
            let (before, after) = (span.start..span.end.min(queries.start), span.start.max(queries.end)..span.end);
            spans.extend([before, after].into_iter().filter(|part| !part.is_empty()).map(|part| (part, old)));
        }
        spans.push((queries, status));
        self.spans = spans;
    }
}

impl State {
    pub(super) fn reset_queries(&mut self, pool: vk::QueryPool, first_query: u32, query_count: u32) {
        if let Some(pool) = self.query_pools.get_mut(&pool) {
            pool.set(pool.clipped(first_query, query_count), QueryStatus::Unavailable);
        }
    }

    /// Queries were written, one for each object.
    pub(super) fn write_queries(
        &mut self,
        pool: vk::QueryPool,
        first_query: u32,
        objects: impl ExactSizeIterator<Item = Object>,
    ) {
        let count = u32::try_from(objects.len()).unwrap_or(u32::MAX);
        let measured: Vec<_> = objects.map(|object| (object, self.contents_number(object))).collect();
        if let Some(pool) = self.query_pools.get_mut(&pool) {
            let queries = pool.clipped(first_query, count);
            pool.measured.extend(
                queries.clone().zip(measured).filter_map(|(query, (object, number))| Some((query, (object, number?)))),
            );
            pool.set(queries, QueryStatus::Available);
        }
    }

    /// The program read queries.
    pub(super) fn read_queries(
        &mut self,
        pool: vk::QueryPool,
        first_query: u32,
        flags: vk::QueryResultFlags,
        values: &[u64],
    ) {
        let Some(pool) = self.query_pools.get(&pool) else { return };
        let query_type = pool.query_type;
        let with_availability = flags.contains(vk::QueryResultFlags::WITH_AVAILABILITY);
        let mut found = Vec::new();
        for (query, value) in (first_query..=u32::MAX).zip(values.chunks(if with_availability { 2 } else { 1 })) {
            let available = !with_availability || value.get(1).is_some_and(|available| *available != 0);
            if let (Some(value), Some((object, number)), true) = (value.first(), pool.measured.get(&query), available) {
                found.push((*object, *number, *value));
            }
        }
        for (object, number, value) in found {
            if self.contents_number(object) == Some(number) {
                self.learn_size(object, query_type, value);
            }
        }
    }

    /// The program was told a size of an object.
    pub(super) fn learn_size(&mut self, object: Object, query_type: vk::QueryType, value: u64) {
        let micromap = self.micromaps.get_mut(&vk::Micromap(object.1)).filter(|_| object.0 == vk::ObjectType::MICROMAP);
        if let Some(contents) = micromap.and_then(|micromap| micromap.contents.as_mut()) {
            match query_type {
                vk::QueryType::MICROMAP_SERIALIZATION_SIZE => contents.serialization_size = Some(value),
                vk::QueryType::MICROMAP_COMPACTED_SIZE => contents.compacted_size = Some(value),
                _ => {}
            }
        }
        let structure = self.acceleration_structures.get_mut(&vk::AccelerationStructure(object.1));
        let structure = structure.filter(|_| object.0 == vk::ObjectType::ACCELERATION_STRUCTURE);
        if let Some(contents) = structure.and_then(|structure| structure.contents.as_mut()) {
            match query_type {
                vk::QueryType::ACCELERATION_STRUCTURE_SERIALIZATION_SIZE => contents.serialization_size = Some(value),
                vk::QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE => contents.compacted_size = Some(value),
                _ => {}
            }
        }
    }

    /// The number of what an object holds at present.
    fn contents_number(&self, object: Object) -> Option<u64> {
        match object.0 {
            vk::ObjectType::MICROMAP => Some(self.micromap(vk::Micromap(object.1))?.contents.as_ref()?.number),
            vk::ObjectType::ACCELERATION_STRUCTURE => {
                Some(self.acceleration_structure(vk::AccelerationStructure(object.1))?.contents.as_ref()?.number)
            }
            _ => None,
        }
    }
}
