use super::*;

const POOL: vk::QueryPool = vk::QueryPool(1);
const SIZE: vk::QueryType = vk::QueryType::ACCELERATION_STRUCTURE_SIZE;
const RESULT_64: vk::QueryResultFlags = vk::QueryResultFlags::RESULT_64;

fn pools(query_count: u32) -> QueryPools {
    let mut pools = QueryPools::default();
    let info = vk::QueryPoolCreateInfo { query_type: SIZE, query_count, ..Default::default() };
    assert_eq!(pools.create(&info, POOL), Ok(Output::None));
    pools
}

fn results(
    pools: &QueryPools,
    first_query: u32,
    query_count: u32,
    flags: vk::QueryResultFlags,
) -> Result<Output, Reason> {
    let (data_size, stride) = (1024, 16);
    let request = Results { query_pool: POOL, first_query, query_count, data_size, stride, flags };
    pools.results(&request).map_err(|stop| stop.why)
}

#[test]
fn a_query_is_reset_written_and_read() {
    let mut pools = pools(10);
    let never = Reason::QueryState { query: 2, found: "was never reset" };
    assert_eq!(pools.write(POOL, SIZE, 2, &[1]).unwrap_err().why, never);
    assert_eq!(results(&pools, 2, 1, RESULT_64).unwrap_err(), never);
    pools.reset(POOL, 2, 4).unwrap();
    pools.write(POOL, SIZE, 3, &[1 << 40 | 7, 8]).unwrap();
    assert_eq!(results(&pools, 3, 2, RESULT_64), Ok(Output::QueryResults(vec![1 << 40 | 7, 8])));
    assert_eq!(results(&pools, 3, 2, vk::QueryResultFlags::empty()), Ok(Output::QueryResults(vec![7, 8])));
    let again = Reason::QueryState { query: 3, found: "was written and not reset since" };
    assert_eq!(pools.write(POOL, SIZE, 2, &[1, 2]).unwrap_err().why, again);
    assert_eq!(results(&pools, 2, 2, RESULT_64), Ok(Output::Result(vk::Result::NOT_READY)));
    let flags = RESULT_64 | vk::QueryResultFlags::WITH_AVAILABILITY;
    assert_eq!(results(&pools, 4, 2, flags), Ok(Output::QueryResults(vec![8, 1, 0, 0])));
    let flags = RESULT_64 | vk::QueryResultFlags::PARTIAL;
    assert_eq!(results(&pools, 4, 2, flags), Ok(Output::QueryResults(vec![8, 0])));
    let flags = RESULT_64 | vk::QueryResultFlags::WAIT;
    assert_eq!(results(&pools, 4, 2, flags), Err(Reason::WaitsForever { query: 5 }));
    pools.reset(POOL, 0, 10).unwrap();
    assert_eq!(results(&pools, 3, 1, RESULT_64), Ok(Output::Result(vk::Result::NOT_READY)));
}

#[test]
fn ranges_and_sizes_are_checked() {
    let mut pools = pools(4);
    assert_eq!(pools.reset(POOL, 0, 4), Ok(Output::None));
    let outside = |first, count| Reason::OutsideQueryPool { first, count, limit: 4 };
    assert_eq!(pools.reset(POOL, 1, 4).unwrap_err().why, outside(1, 4));
    assert_eq!(pools.reset(POOL, u32::MAX, u32::MAX).unwrap_err().why, outside(u32::MAX, u32::MAX.into()));
    assert_eq!(pools.write(POOL, SIZE, 3, &[1, 2]).unwrap_err().why, outside(3, 2));
    let other = vk::QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE;
    let types = Reason::QueryType { found: SIZE, required: other };
    assert_eq!(pools.write(POOL, other, 0, &[1]).unwrap_err().why, types);
    let request = |data_size, stride, query_count| Results {
        query_pool: POOL,
        first_query: 0,
        query_count,
        data_size,
        stride,
        flags: RESULT_64 | vk::QueryResultFlags::PARTIAL,
    };
    assert_eq!(pools.results(&request(0, 0, 0)), Ok(Output::QueryResults(vec![])));
    assert_eq!(pools.results(&request(8, 0, 1)), Ok(Output::QueryResults(vec![0])));
    let small = pools.results(&request(23, 16, 2)).unwrap_err();
    assert_eq!((small.at.as_str(), small.why), ("dataSize", Reason::TooSmall { required: 24, available: 23 }));
    let small = pools.results(&request(1024, 7, 2)).unwrap_err();
    assert_eq!((small.at.as_str(), small.why), ("stride", Reason::TooSmall { required: 8, available: 7 }));
    assert!(pools.results(&request(u64::MAX, u64::MAX, 4)).is_err());
}

#[test]
fn a_large_pool_costs_nothing() {
    let mut pools = pools(MAX_QUERIES);
    for _ in 0..1000 {
        pools.reset(POOL, 0, MAX_QUERIES).unwrap();
    }
    assert!(pools.pools[&POOL].states.len() <= 2);
    let info = vk::QueryPoolCreateInfo { query_count: MAX_QUERIES + 1, ..Default::default() };
    let out = Ok(Output::Result(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY));
    assert_eq!(pools.create(&info, vk::QueryPool(2)), out);
}

#[test]
fn a_pool_may_be_reset_from_the_start() {
    let mut pools = QueryPools::default();
    let flags = vk::QueryPoolCreateFlags::RESET;
    let info = vk::QueryPoolCreateInfo { flags, query_type: SIZE, query_count: 2, ..Default::default() };
    pools.create(&info, POOL).unwrap();
    pools.write(POOL, SIZE, 0, &[5, 6]).unwrap();
    assert_eq!(results(&pools, 0, 2, RESULT_64), Ok(Output::QueryResults(vec![5, 6])));
}

#[test]
fn a_submission_can_be_taken_back() {
    let mut pools = pools(2);
    pools.reset(POOL, 0, 2).unwrap();
    pools.begin();
    pools.write(POOL, SIZE, 0, &[5, 6]).unwrap();
    pools.reset(POOL, 1, 1).unwrap();
    pools.roll_back();
    assert_eq!(results(&pools, 0, 2, RESULT_64), Ok(Output::Result(vk::Result::NOT_READY)));
    pools.begin();
    pools.write(POOL, SIZE, 0, &[5, 6]).unwrap();
    pools.commit();
    pools.roll_back();
    assert_eq!(results(&pools, 0, 2, RESULT_64), Ok(Output::QueryResults(vec![5, 6])));
}
