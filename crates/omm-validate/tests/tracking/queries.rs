//! Query pools, and the sizes that programs are told.

use omm_model::call::{Call, Output, Timeline};
use omm_model::vk;
use omm_validate::state::QueryStatus;
use proptest::prelude::*;

use crate::{BUFFER, COMMAND_BUFFER, DEVICE, Program, micromap_build};

const POOL: vk::QueryPool = vk::QueryPool(0x30);
const MICROMAP: vk::Micromap = vk::Micromap(0x20);

fn pool(query_count: u32) -> Call {
    let query_type = vk::QueryType::MICROMAP_SERIALIZATION_SIZE;
    let create_info = vk::QueryPoolCreateInfo { query_type, query_count, ..Default::default() };
    Call::CreateQueryPool { device: DEVICE, create_info, query_pool: POOL }
}

fn reset(first_query: u32, query_count: u32) -> Call {
    Call::ResetQueryPool { device: DEVICE, query_pool: POOL, first_query, query_count }
}

fn write(first_query: u32) -> Call {
    Call::CmdWriteMicromapsProperties {
        command_buffer: COMMAND_BUFFER,
        micromaps: vec![MICROMAP],
        query_type: vk::QueryType::MICROMAP_SERIALIZATION_SIZE,
        query_pool: POOL,
        first_query,
    }
}

fn read(first_query: u32, flags: vk::QueryResultFlags) -> Call {
    Call::GetQueryPoolResults {
        device: DEVICE,
        query_pool: POOL,
        first_query,
        query_count: 1,
        data_size: 16,
        stride: 16,
        flags,
    }
}

fn size(program: &Program) -> Option<u64> {
    program.state().micromap(MICROMAP).unwrap().serialization_size()
}

#[test]
fn a_query_is_reset_then_written_then_read() {
    let mut program = Program::new();
    program.buffer(BUFFER, 0x1000, vk::BufferCreateFlags::empty()).micromap(MICROMAP, 0).calls(pool(4));
    let status = |program: &Program, query| program.state().query_pool(POOL).unwrap().status(query);
    assert_eq!((status(&program, 0), status(&program, 4)), (Some(QueryStatus::NeverReset), None));
    program.calls(reset(1, u32::MAX));
    assert_eq!(status(&program, 3), Some(QueryStatus::Unavailable));
    let build = Call::CmdBuildMicromaps { command_buffer: COMMAND_BUFFER, infos: vec![micromap_build(MICROMAP, 2)] };
    program.begin(COMMAND_BUFFER).calls(build.clone()).calls(write(2));
    assert_eq!(status(&program, 2), Some(QueryStatus::Unavailable), "not submitted yet");
    program.submit();
    assert_eq!(status(&program, 2), Some(QueryStatus::Available));
    let pool = program.state().query_pool(POOL).unwrap();
    assert_eq!(pool.first_not_unavailable(1, 1), None);
    assert_eq!(pool.first_not_unavailable(1, 3), Some((2, QueryStatus::Available)));
    assert_eq!(pool.first_not_unavailable(0, u32::MAX), Some((0, QueryStatus::NeverReset)));

    let with_availability = vk::QueryResultFlags::WITH_AVAILABILITY;
    program.returns(read(2, with_availability), Output::QueryResults(vec![7, 0]));
    assert_eq!(size(&program), None, "not available");
    program.returns(read(2, with_availability), Output::QueryResults(vec![99, 1]));
    assert_eq!(size(&program), Some(99));
    // Built again: what was measured is gone, and reading it once more does not bring it back.
    program.begin(COMMAND_BUFFER).calls(build).submit();
    assert_eq!(size(&program), None);
    program.returns(read(2, vk::QueryResultFlags::empty()), Output::QueryResults(vec![99]));
    assert_eq!(size(&program), None);
    program.returns(read(u32::MAX, vk::QueryResultFlags::empty()), Output::QueryResults(vec![1, 2, 3]));
}

#[test]
fn a_host_command_tells_sizes_too() {
    let mut program = Program::new();
    program.buffer(BUFFER, 0x1000, vk::BufferCreateFlags::empty()).micromap(MICROMAP, 0);
    let deferred_operation = vk::DeferredOperation::NULL;
    program.calls(Call::BuildMicromaps {
        device: DEVICE,
        deferred_operation,
        infos: vec![micromap_build(MICROMAP, 2)],
    });
    let query_type = vk::QueryType::MICROMAP_SERIALIZATION_SIZE;
    let micromaps = vec![MICROMAP];
    let call = Call::WriteMicromapsProperties { device: DEVICE, micromaps, query_type, data_size: 8, stride: 8 };
    program.returns(call, Output::Properties(vec![123]));
    assert_eq!(size(&program), Some(123));
}

#[test]
fn build_sizes_are_those_of_the_same_type_flags_usages_and_timeline() {
    let mut program = Program::new();
    let info = micromap_build(MICROMAP, 2);
    let found = |program: &Program, info: &vk::MicromapBuildInfo, timeline| {
        program.state().micromap_build_sizes(info, timeline).map(|sizes| sizes.micromap_size)
    };
    let mut ask = |build_type, micromap_size| {
        let call = Call::GetMicromapBuildSizes { device: DEVICE, build_type, build_info: info.clone() };
        let sizes = vk::MicromapBuildSizesInfo { micromap_size, ..Default::default() };
        program.returns(call, Output::MicromapBuildSizes(sizes));
    };
    ask(vk::AccelerationStructureBuildType::DEVICE, 10);
    ask(vk::AccelerationStructureBuildType::DEVICE, 11);
    assert_eq!(found(&program, &info, Timeline::Device), Some(11));
    assert_eq!(found(&program, &info, Timeline::Host), None);
    let elsewhere =
        vk::MicromapBuildInfo { dst_micromap: vk::Micromap(9), data: vk::HostAddress(5).into(), ..info.clone() };
    assert_eq!(found(&program, &elsewhere, Timeline::Device), Some(11));
    for other in [
        micromap_build(MICROMAP, 3),
        vk::MicromapBuildInfo { flags: vk::BuildMicromapFlags::ALLOW_COMPACTION, ..info.clone() },
        vk::MicromapBuildInfo { ty: vk::MicromapType::DISPLACEMENT_MICROMAP, ..info.clone() },
    ] {
        assert_eq!(found(&program, &other, Timeline::Device), None);
    }
    let call = Call::GetMicromapBuildSizes {
        device: DEVICE,
        build_type: vk::AccelerationStructureBuildType::HOST_OR_DEVICE,
        build_info: info.clone(),
    };
    let sizes = vk::MicromapBuildSizesInfo { micromap_size: 12, ..Default::default() };
    program.returns(call, Output::MicromapBuildSizes(sizes));
    assert_eq!(found(&program, &info, Timeline::Host), Some(12));
    assert_eq!(found(&program, &info, Timeline::Device), Some(12), "the last answer");
}

proptest! {
    /// The ranges of a pool against an account of each query.
    #[test]
    fn a_pool_knows_each_of_its_queries(
        actions in prop::collection::vec((any::<bool>(), 0_u32..12, 0_u32..12), 0..10),
    ) {
        let mut program = Program::new();
        program.buffer(BUFFER, 0x1000, vk::BufferCreateFlags::empty()).micromap(MICROMAP, 0).calls(pool(10));
        let mut queries = [QueryStatus::NeverReset; 10];
        for (is_reset, first, count) in actions {
            if is_reset {
                program.calls(reset(first, count));
                queries.iter_mut().skip(first as usize).take(count as usize).for_each(|it| *it = QueryStatus::Unavailable);
            } else {
                program.begin(COMMAND_BUFFER).calls(write(first)).submit();
                queries.iter_mut().skip(first as usize).take(1).for_each(|it| *it = QueryStatus::Available);
            }
        }
        let pool = program.state().query_pool(POOL).unwrap();
        for (query, expected) in (0..).zip(queries) {
            prop_assert_eq!(pool.status(query), Some(expected));
        }
        let first = queries.iter().position(|it| *it != QueryStatus::Unavailable);
        prop_assert_eq!(pool.first_not_unavailable(0, 10), first.map(|at| (at as u32, queries[at])));
    }
}
