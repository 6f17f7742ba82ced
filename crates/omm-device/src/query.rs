//! Query pools: where sizes of built structures come back to the host.

use std::collections::BTreeMap;

use omm_model::call::Output;
use omm_model::vk;

use crate::undefined::{At, Reason, Stop};

/// Most queries of a pool; a larger one is answered with "out of device memory".
pub const MAX_QUERIES: u32 = 1 << 20;

/// What is known of a query.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum QueryState {
    /// Never reset since the pool was created.
    Uninitialized,
    /// Reset and not written since.
    Unavailable,
    /// Written.
    Available(u64),
}

#[derive(Clone, Debug)]
struct Pool {
    query_type: vk::QueryType,
    query_count: u32,
    /// A state holds from its key on up to the next key, so that a reset costs the same for any number of queries.
    states: BTreeMap<u32, QueryState>,
}

impl Pool {
    fn state(&self, query: u32) -> QueryState {
        self.states.range(..=query).next_back().map_or(QueryState::Uninitialized, |(_, state)| *state)
    }

    /// Requires a range to lie within the pool and gives its end.
    fn end(&self, first: u32, count: u64) -> Result<u32, Reason> {
        let end = u64::from(first).checked_add(count).and_then(|end| u32::try_from(end).ok());
        let outside = Reason::OutsideQueryPool { first, count, limit: self.query_count };
        end.filter(|&end| end <= self.query_count).ok_or(outside)
    }

    /// Puts `state` at `first..end`, which lies within the pool.
    fn set(&mut self, first: u32, end: u32, state: QueryState) {
        if first < end {
            let after = self.state(end);
            while let Some((&key, _)) = self.states.range(first..end).next() {
                self.states.remove(&key);
            }
            self.states.insert(first, state);
            self.states.insert(end, after);
        }
    }
}

/// All query pools of a device.
#[derive(Debug, Default)]
pub(crate) struct QueryPools {
    pools: BTreeMap<vk::QueryPool, Pool>,
    /// While a submission executes: the pools as they were before it, those that it changed.
    journal: Option<BTreeMap<vk::QueryPool, Pool>>,
}

impl QueryPools {
    /// `vkCreateQueryPool`.
    pub(crate) fn create(&mut self, info: &vk::QueryPoolCreateInfo, pool: vk::QueryPool) -> Result<Output, Stop> {
        if pool.is_null() || self.pools.contains_key(&pool) {
            return Err(Reason::HandleTaken { object: "query pool", handle: pool.0 }).at("pQueryPool");
        }
        if info.query_count > MAX_QUERIES {
            return Ok(Output::Result(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY));
        }
        let mut new = Pool { query_type: info.query_type, query_count: info.query_count, states: BTreeMap::new() };
        if info.flags.contains(vk::QueryPoolCreateFlags::RESET) {
            new.set(0, info.query_count, QueryState::Unavailable);
        }
        self.pools.insert(pool, new);
        Ok(Output::None)
    }

    /// `vkDestroyQueryPool`.
    pub(crate) fn destroy(&mut self, pool: vk::QueryPool) -> Result<Output, Stop> {
        if !pool.is_null() {
            self.get(pool).at("queryPool")?;
            self.pools.remove(&pool);
        }
        Ok(Output::None)
    }

    /// Stops if there is no such pool.
    pub(crate) fn check(&self, pool: vk::QueryPool) -> Result<(), Reason> {
        self.get(pool).map(drop)
    }

    fn get(&self, pool: vk::QueryPool) -> Result<&Pool, Reason> {
        self.pools.get(&pool).ok_or(Reason::UnknownHandle { object: "query pool", handle: pool.0 })
    }

    fn get_mut(&mut self, pool: vk::QueryPool) -> Result<&mut Pool, Reason> {
        let unknown = Reason::UnknownHandle { object: "query pool", handle: pool.0 };
        let found = self.pools.get_mut(&pool).ok_or(unknown)?;
        if let Some(journal) = &mut self.journal {
            journal.entry(pool).or_insert_with(|| found.clone());
        }
        Ok(found)
    }

    /// `vkResetQueryPool` and `vkCmdResetQueryPool`.
    pub(crate) fn reset(&mut self, pool: vk::QueryPool, first: u32, count: u32) -> Result<Output, Stop> {
        let pool = self.get_mut(pool).at("queryPool")?;
        let end = pool.end(first, count.into()).at("firstQuery")?;
        pool.set(first, end, QueryState::Unavailable);
        Ok(Output::None)
    }

    /// Writes consecutive queries of a pool, all of which have to be reset.
    pub(crate) fn write(
        &mut self,
        pool: vk::QueryPool,
        query_type: vk::QueryType,
        first: u32,
        values: &[u64],
    ) -> Result<(), Stop> {
        let pool = self.get_mut(pool).at("queryPool")?;
        if pool.query_type != query_type {
            return Err(Reason::QueryType { found: pool.query_type, required: query_type }).at("queryPool");
        }
        let end = pool.end(first, values.len() as u64).at("firstQuery")?;
        for query in first..end {
            let found = match pool.state(query) {
                QueryState::Unavailable => continue,
                QueryState::Uninitialized => "was never reset",
                QueryState::Available(_) => "was written and not reset since",
            };
            return Err(Reason::QueryState { query, found }).at("queryPool");
        }
        for (query, &value) in (first..end).zip(values) {
            pool.set(query, query + 1, QueryState::Available(value));
        }
        Ok(())
    }

    /// `vkGetQueryPoolResults`.
    ///
    /// With availability each value is followed by 1, or for an unavailable query by 0; without it one unavailable query makes
    /// the whole answer "not ready", unless partial results (which are 0) were asked for.
    pub(crate) fn results(&self, request: &Results) -> Result<Output, Stop> {
        let &Results { query_pool, first_query, query_count, data_size, stride, flags } = request;
        let pool = self.get(query_pool).at("queryPool")?;
        let end = pool.end(first_query, query_count.into()).at("firstQuery")?;
        let with_availability = flags.contains(vk::QueryResultFlags::WITH_AVAILABILITY);
        let width: u64 = if flags.contains(vk::QueryResultFlags::RESULT_64) { 8 } else { 4 };
        let size = width * if with_availability { 2 } else { 1 };
        if query_count > 1 && stride < size {
            return Err(Reason::TooSmall { required: size, available: stride }).at("stride");
        }
        let required = match u64::from(query_count).checked_sub(1) {
            None => Some(0),
            Some(steps) => steps.checked_mul(stride).and_then(|offset| offset.checked_add(size)),
        };
        if required.is_none_or(|required| required > data_size) {
            let required = required.unwrap_or(u64::MAX);
            return Err(Reason::TooSmall { required, available: data_size }).at("dataSize");
        }
        let states: Vec<_> = (first_query..end).map(|query| (query, pool.state(query))).collect();
        if let Some(&(query, _)) = states.iter().find(|(_, state)| *state == QueryState::Uninitialized) {
            return Err(Reason::QueryState { query, found: "was never reset" }).at("queryPool");
        }
        let unavailable = states.iter().find(|(_, state)| *state == QueryState::Unavailable);
        if let Some(&(query, _)) = unavailable {
            if flags.contains(vk::QueryResultFlags::WAIT) {
                return Err(Reason::WaitsForever { query }).at("queryPool");
            }
            if !with_availability && !flags.contains(vk::QueryResultFlags::PARTIAL) {
                return Ok(Output::Result(vk::Result::NOT_READY));
            }
        }
        let mut values = Vec::new();
        for (_, state) in states {
            let (value, available) = match state {
                QueryState::Available(value) => (value, 1),
                QueryState::Unavailable | QueryState::Uninitialized => (0, 0),
            };
            values.push(if width == 8 { value } else { value & u64::from(u32::MAX) });
            values.extend(with_availability.then_some(available));
        }
        Ok(Output::QueryResults(values))
    }

    /// From here on, remembers the pools that change.
    pub(crate) fn begin(&mut self) {
        self.journal = Some(BTreeMap::new());
    }

    /// Keeps what changed since [`QueryPools::begin`].
    pub(crate) fn commit(&mut self) {
        self.journal = None;
    }

    /// Restores what changed since [`QueryPools::begin`].
    pub(crate) fn roll_back(&mut self) {
        self.pools.extend(self.journal.take().into_iter().flatten());
    }
}

/// The parameters of `vkGetQueryPoolResults`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Results {
    pub(crate) query_pool: vk::QueryPool,
    pub(crate) first_query: u32,
    pub(crate) query_count: u32,
    pub(crate) data_size: u64,
    pub(crate) stride: u64,
    pub(crate) flags: vk::QueryResultFlags,
}

#[cfg(test)]
mod tests;
