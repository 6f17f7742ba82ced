//! Rules of `vkCmdWriteMicromapsPropertiesEXT` and `vkWriteMicromapsPropertiesEXT`.

use omm_model::call::Call;
use omm_model::vk;
use omm_validate::RuleId::*;
use vk::QueryType;

use crate::ext_copy_world::*;

/// Where the host puts the sizes.
fn results(world: &mut World, data_size: u64, stride: u64) {
    *world.host_properties().data_size = data_size;
    *world.host_properties().stride = stride;
}

pub(crate) fn cases() -> Vec<WorldCase> {
    [parameters(), objects(), availability()].concat()
}

fn parameters() -> Vec<WorldCase> {
    vec![
        breaks(
            |world| {
                *world.properties().query_type = QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE;
                world.query_pool().query_type = QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE;
            },
            &[(QueryType07503, "queryType")],
        ),
        // The command has no other rule on types that are none.
        breaks(|world| *world.properties().query_type = QueryType(-1), &[(QueryType07503, "queryType")]),
        keeps(QueryType07503, |world| {
            *world.properties().query_type = QueryType::MICROMAP_SERIALIZATION_SIZE;
            world.query_pool().query_type = QueryType::MICROMAP_SERIALIZATION_SIZE;
        }),
        breaks(
            |world| *world.host_properties().query_type = QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE,
            &[(HostQueryType07503, "queryType")],
        ),
        keeps(HostQueryType07503, |world| *world.host_properties().query_type = QueryType::MICROMAP_COMPACTED_SIZE),
        breaks(|world| results(world, 24, 12), &[(Stride10071, "stride")]),
        keeps(Stride10071, |world| results(world, 32, 16)),
        breaks(
            |world| {
                world.host_properties().micromaps.truncate(1);
                results(world, 4, 0);
            },
            &[(Data10072, "dataSize")],
        ),
        keeps(Data10072, |world| {
            world.host_properties().micromaps.truncate(1);
            results(world, 8, 8);
        }),
        breaks(|world| results(world, 15, 8), &[(DataSize07576, "dataSize")]),
        // More than there are addresses.
        breaks(|world| results(world, u64::MAX, 1 << 63), &[(DataSize07576, "dataSize")]),
        keeps(DataSize07576, |world| results(world, 17, 8)),
        breaks(
            |world| {
                world.only_on_host("vkWriteMicromapsPropertiesEXT");
                world.profile.features.micromap_host_commands = false;
            },
            &[(HostPropertiesFeature07578, "device")],
        ),
        keeps(HostPropertiesFeature07578, |world| world.only_on_host("vkWriteMicromapsPropertiesEXT")),
    ]
}

/// The program builds without allowing compaction.
fn not_compactable(world: &mut World) {
    world.build_info().flags = vk::BuildMicromapFlags::empty();
}

/// The device and its queries measure that.
fn measure(world: &mut World, query_type: QueryType) {
    *world.properties().query_type = query_type;
    world.query_pool().query_type = query_type;
}

/// Another micromap is measured too, on memory of that type if any.
fn measure_another(world: &mut World, memory_type: Option<u32>) {
    world.another_micromap(memory_type.map(memory_of_type));
    world.properties().micromaps.push(ANOTHER);
}

/// The host measures another micromap too.
fn measure_another_on_host(world: &mut World, allocate_info: Option<vk::MemoryAllocateInfo>) {
    world.another_micromap(allocate_info);
    world.host_properties().micromaps[1] = ANOTHER;
}

fn objects() -> Vec<WorldCase> {
    vec![
        breaks(
            |world| *world.properties().query_type = QueryType::MICROMAP_SERIALIZATION_SIZE,
            &[(QueryPoolType07525, "queryPool")],
        ),
        keeps(QueryPoolType07525, |world| measure(world, QueryType::MICROMAP_SERIALIZATION_SIZE)),
        breaks(|world| *world.properties().first_query = 2, &[(QueryRange07528, "firstQuery")]),
        breaks(
            |world| {
                world.query_pool().query_count = 0;
                world.remove("vkCmdResetQueryPool");
            },
            &[(QueryRange07528, "firstQuery")],
        ),
        keeps(QueryRange07528, |world| *world.properties().first_query = 1),
        breaks(
            |world| {
                measure_another(world, None);
                world.only_record();
            },
            &[(PropertiesMemory07527, "pMicromaps[1]")],
        ),
        keeps(PropertiesMemory07527, |world| measure_another(world, Some(0))),
        breaks(
            |world| {
                let micromaps = world.properties().micromaps;
                micromaps.push(EMPTY);
            },
            &[(PropertiesSource11662, "pMicromaps[1]")],
        ),
        // Copied into in the same command buffer.
        keeps(PropertiesSource11662, |world| world.properties().micromaps.push(COPY)),
        breaks(|world| world.host_properties().micromaps[1] = EMPTY, &[(HostPropertiesSource11671, "pMicromaps[1]")]),
        keeps(HostPropertiesSource11671, |world| world.host_properties().micromaps[1] = LOADED),
        breaks(not_compactable, &[(CompactedSizeFlag07502, "pMicromaps[0]")]),
        // Nobody knows how deserialized data was built.
        keeps(CompactedSizeFlag07502, |world| {
            not_compactable(world);
            world.properties().micromaps[0] = LOADED;
        }),
        keeps(CompactedSizeFlag07502, |world| {
            not_compactable(world);
            measure(world, QueryType::MICROMAP_SERIALIZATION_SIZE);
        }),
        breaks(
            |world| {
                not_compactable(world);
                measure(world, QueryType::MICROMAP_SERIALIZATION_SIZE);
                *world.host_properties().query_type = QueryType::MICROMAP_COMPACTED_SIZE;
            },
            // A clone is built as its source was.
            &[(HostCompactedSizeFlag07502, "pMicromaps[0]"), (HostCompactedSizeFlag07502, "pMicromaps[1]")],
        ),
        keeps(HostCompactedSizeFlag07502, |world| {
            *world.host_properties().query_type = QueryType::MICROMAP_COMPACTED_SIZE;
        }),
        breaks(
            |world| measure_another_on_host(world, Some(memory_of_type(0))),
            &[(HostPropertiesMemory07577, "pMicromaps[1]")],
        ),
        keeps(HostPropertiesMemory07577, |world| measure_another_on_host(world, Some(memory_of_type(1)))),
        breaks(
            |world| {
                world.on_two_devices();
                measure_another_on_host(world, Some(memory_of_type(2)));
            },
            &[(HostPropertiesInstances07579, "pMicromaps[1]")],
        ),
        keeps(HostPropertiesInstances07579, |world| {
            world.on_two_devices();
            measure_another_on_host(world, Some(on_first_device(2)));
        }),
    ]
}

/// Submits once more what was recorded.
fn submit_again(world: &mut World) {
    let submit = Call::QueueSubmit { queue: QUEUE, command_buffers: vec![COMMAND_BUFFER] };
    world.insert("vkWriteMicromapsPropertiesEXT", submit);
}

fn availability() -> Vec<WorldCase> {
    vec![
        // Never reset.
        breaks(
            |world| {
                world.remove("vkCmdResetQueryPool");
            },
            &[(QueriesUnavailable12417, "firstQuery")],
        ),
        // Reset once and written twice.
        breaks(
            |world| {
                reset_on_host(world);
                submit_again(world);
            },
            &[(QueriesUnavailable12417, "firstQuery")],
        ),
        // Another query was reset.
        breaks(
            |world| {
                let Call::CmdResetQueryPool { first_query, query_count, .. } = world.reset() else {
                    panic!("no reset")
                };
                (*first_query, *query_count) = (1, 1);
            },
            &[(QueriesUnavailable12417, "firstQuery")],
        ),
        keeps(QueriesUnavailable12417, submit_again),
        keeps(QueriesUnavailable12417, reset_on_host),
        keeps(QueriesUnavailable12417, |world| {
            world.remove("vkCmdResetQueryPool");
            world.query_pool().flags = vk::QueryPoolCreateFlags::RESET;
        }),
        // Recorded, and not executed.
        keeps(QueriesUnavailable12417, |world| {
            world.remove("vkCmdResetQueryPool");
            world.only_record();
        }),
    ]
}

/// The host resets the queries before the program records, and the device does not.
fn reset_on_host(world: &mut World) {
    world.remove("vkCmdResetQueryPool");
    let reset = Call::ResetQueryPool { device: DEVICE, query_pool: QUERY_POOL, first_query: 0, query_count: 2 };
    world.insert("vkBeginCommandBuffer", reset);
}

#[test]
fn cases_hold() {
    run_cases(&cases());
}
