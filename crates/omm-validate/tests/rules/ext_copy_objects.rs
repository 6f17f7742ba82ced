//! Rules of copies of micromap objects on objects and addresses.

use omm_model::call::{Call, Output};
use omm_model::vk;
use omm_validate::RuleId::*;

use crate::ext_copy_world::*;

pub(crate) fn cases() -> Vec<WorldCase> {
    [bound(), host_visible(), instances(), operations(), addresses(), constructed(), compaction(), room()].concat()
}

fn unbound(world: &mut World, change: fn(&mut World)) {
    world.only_record();
    world.another_micromap(None);
    change(world);
}

fn bound_late(world: &mut World, change: fn(&mut World)) {
    world.only_record();
    world.another_micromap(Some(memory_of_type(0)));
    change(world);
}

/// On a sparse buffer with memory under that many bytes of it.
fn sparse(world: &mut World, size: u64, change: fn(&mut World)) {
    world.another_micromap(None);
    let Call::CreateBuffer { create_info, buffer, .. } = world.another_buffer() else { panic!("no buffer") };
    create_info.flags = vk::BufferCreateFlags::SPARSE_BINDING;
    let buffer = *buffer;
    let bind = vk::SparseMemoryBind { size, memory: MEMORY, ..Default::default() };
    let buffer_binds = vec![vk::SparseBufferMemoryBindInfo { buffer, binds: vec![bind] }];
    world.insert("vkBeginCommandBuffer", Call::QueueBindSparse { queue: QUEUE, buffer_binds });
    world.only_record();
    change(world);
}

fn bound() -> Vec<WorldCase> {
    vec![
        breaks(|world| unbound(world, |world| world.copy().src = ANOTHER), &[(CopySrcMemory07529, "pInfo->src")]),
        keeps(CopySrcMemory07529, |world| bound_late(world, |world| world.copy().src = ANOTHER)),
        breaks(|world| unbound(world, |world| world.copy().dst = ANOTHER), &[(CopyDstMemory07530, "pInfo->dst")]),
        breaks(
            |world| sparse(world, MICROMAP_SIZE - 256, |world| world.copy().dst = ANOTHER),
            &[(CopyDstMemory07530, "pInfo->dst")],
        ),
        keeps(CopyDstMemory07530, |world| sparse(world, MICROMAP_SIZE, |world| world.copy().dst = ANOTHER)),
        breaks(
            |world| unbound(world, |world| world.serialize().src = ANOTHER),
            &[(SerializeSrcMemory07539, "pInfo->src")],
        ),
        keeps(SerializeSrcMemory07539, |world| bound_late(world, |world| world.serialize().src = ANOTHER)),
        breaks(
            |world| unbound(world, |world| world.deserialize().dst = ANOTHER),
            &[(DeserializeDstMemory07546, "pInfo->dst")],
        ),
        keeps(DeserializeDstMemory07546, |world| bound_late(world, |world| world.deserialize().dst = ANOTHER)),
    ]
}

fn in_memory(world: &mut World, memory_type: u32, change: fn(&mut World)) {
    world.another_micromap(Some(memory_of_type(memory_type)));
    change(world);
}

fn host_visible() -> Vec<WorldCase> {
    vec![
        breaks(
            |world| in_memory(world, 0, |world| world.host_copy().src = ANOTHER),
            &[(HostCopySrcMemory07558, "pInfo->src")],
        ),
        keeps(HostCopySrcMemory07558, |world| in_memory(world, 1, |world| world.host_copy().src = ANOTHER)),
        breaks(
            |world| in_memory(world, 0, |world| world.host_copy().dst = ANOTHER),
            &[(HostCopyDstMemory07559, "pInfo->dst")],
        ),
        breaks(
            |world| {
                world.another_micromap(None);
                world.host_copy().dst = ANOTHER;
            },
            &[(HostCopyDstMemory07559, "pInfo->dst")],
        ),
        keeps(HostCopyDstMemory07559, |world| in_memory(world, 1, |world| world.host_copy().dst = ANOTHER)),
        breaks(
            |world| in_memory(world, 0, |world| world.host_serialize().src = ANOTHER),
            &[(HostSerializeSrcMemory07568, "pInfo->src")],
        ),
        keeps(HostSerializeSrcMemory07568, |world| in_memory(world, 1, |world| world.host_serialize().src = ANOTHER)),
        breaks(
            |world| in_memory(world, 0, |world| world.host_deserialize().dst = ANOTHER),
            &[(HostDeserializeDstMemory07565, "pInfo->dst")],
        ),
        keeps(HostDeserializeDstMemory07565, |world| {
            in_memory(world, 1, |world| world.host_deserialize().dst = ANOTHER);
        }),
    ]
}

/// On a device of two physical ones, each with an instance of the memory.
fn on_both(world: &mut World, change: fn(&mut World)) {
    world.on_two_devices();
    in_memory(world, 2, change);
}

/// On a device of two physical ones, with memory on the first.
fn on_first(world: &mut World, change: fn(&mut World)) {
    world.on_two_devices();
    world.another_micromap(Some(on_first_device(2)));
    change(world);
}

fn instances() -> Vec<WorldCase> {
    vec![
        breaks(
            |world| on_both(world, |world| world.host_copy().src = ANOTHER),
            &[(HostCopySrcInstances07561, "pInfo->src")],
        ),
        keeps(HostCopySrcInstances07561, |world| on_first(world, |world| world.host_copy().src = ANOTHER)),
        breaks(
            |world| on_both(world, |world| world.host_copy().dst = ANOTHER),
            &[(HostCopyDstInstances07562, "pInfo->dst")],
        ),
        keeps(HostCopyDstInstances07562, |world| on_first(world, |world| world.host_copy().dst = ANOTHER)),
        // Memory of the host has one instance however many devices use it.
        keeps(HostCopyDstInstances07562, |world| {
            world.on_two_devices();
            in_memory(world, 1, |world| world.host_copy().dst = ANOTHER);
        }),
        breaks(
            |world| on_both(world, |world| world.host_serialize().src = ANOTHER),
            &[(HostSerializeSrcInstances07572, "pInfo->src")],
        ),
        keeps(HostSerializeSrcInstances07572, |world| on_first(world, |world| world.host_serialize().src = ANOTHER)),
        breaks(
            |world| on_both(world, |world| world.host_deserialize().dst = ANOTHER),
            &[(HostDeserializeDstInstances07567, "pInfo->dst")],
        ),
        keeps(HostDeserializeDstInstances07567, |world| {
            on_first(world, |world| world.host_deserialize().dst = ANOTHER);
        }),
    ]
}

/// Defers that command on an operation on which another was deferred before.
fn deferred_twice(world: &mut World, command: &str) {
    let info = vk::CopyMicromapInfo { src: SOURCE, dst: COPY, ..Default::default() };
    let first = Call::CopyMicromap { device: DEVICE, deferred_operation: OPERATION, info };
    let at = world.position(command);
    world.defer(at);
    world.calls.insert(at, (first, Output::Result(vk::Result::OPERATION_DEFERRED)));
}

/// The same with a join between the two, which returned that.
fn joined(world: &mut World, command: &str, output: Output) {
    deferred_twice(world, command);
    let join = Call::DeferredOperationJoin { device: DEVICE, operation: OPERATION };
    let at = world.calls.iter().position(|(call, _)| call.deferred_operation().is_some()).unwrap();
    world.calls.insert(at + 1, (join, output));
}

fn operations() -> Vec<WorldCase> {
    const PATH: &str = "deferredOperation";
    vec![
        breaks(|world| deferred_twice(world, "vkCopyMicromapEXT"), &[(CopyDeferredOperation03678, PATH)]),
        breaks(
            |world| joined(world, "vkCopyMicromapEXT", Output::Result(vk::Result::THREAD_DONE)),
            &[(CopyDeferredOperation03678, PATH)],
        ),
        keeps(CopyDeferredOperation03678, |world| joined(world, "vkCopyMicromapEXT", Output::None)),
        breaks(|world| deferred_twice(world, "vkCopyMicromapToMemoryEXT"), &[(SerializeDeferredOperation03678, PATH)]),
        keeps(SerializeDeferredOperation03678, |world| joined(world, "vkCopyMicromapToMemoryEXT", Output::None)),
        breaks(
            |world| deferred_twice(world, "vkCopyMemoryToMicromapEXT"),
            &[(DeserializeDeferredOperation03678, PATH)],
        ),
        keeps(DeserializeDeferredOperation03678, |world| joined(world, "vkCopyMemoryToMicromapEXT", Output::None)),
    ]
}

fn addresses() -> Vec<WorldCase> {
    vec![
        breaks(
            |world| world.serialize().dst = vk::DeviceAddress::NULL.into(),
            &[(SerializeAddress07536, "pInfo->dst")],
        ),
        breaks(
            |world| world.serialize().dst = vk::DeviceAddress(BASE + BUFFER_SIZE).into(),
            &[(SerializeAddress07536, "pInfo->dst")],
        ),
        breaks(
            |world| world.serialize().dst = vk::HostAddress(HOST_SERIALIZED).into(),
            &[(SerializeAddress07536, "pInfo->dst")],
        ),
        keeps(SerializeAddress07536, |world| {
            world.serialize().dst = vk::DeviceAddress(BASE + BUFFER_SIZE - 256).into();
        }),
        breaks(
            |world| world.deserialize().src = vk::DeviceAddress::NULL.into(),
            &[(DeserializeAddress07543, "pInfo->src")],
        ),
        breaks(
            |world| world.deserialize().src = vk::DeviceAddress(BASE + BUFFER_SIZE).into(),
            &[(DeserializeAddress07543, "pInfo->src")],
        ),
        breaks(
            |world| world.deserialize().src = vk::HostAddress(HOST_BLOB).into(),
            &[(DeserializeAddress07543, "pInfo->src")],
        ),
        keeps(DeserializeAddress07543, |world| {
            let blob = serialized(&world.profile);
            world.put(BLOB + 256, &blob);
            world.deserialize().src = vk::DeviceAddress(BLOB + 256).into();
        }),
    ]
}

/// The program builds that too, before it copies.
fn built(world: &mut World, micromap: vk::Micromap) {
    let mut info = world.build_info().clone();
    info.dst_micromap = micromap;
    let command_buffer = COMMAND_BUFFER;
    world.insert("vkCmdCopyMicromapEXT", Call::CmdBuildMicromaps { command_buffer, infos: vec![info] });
}

fn constructed() -> Vec<WorldCase> {
    vec![
        breaks(
            |world| {
                world.only_on_host("");
                world.copy().src = EMPTY;
            },
            &[(CopySource07532, "pInfo->src")],
        ),
        keeps(CopySource07532, |world| {
            world.copy().src = EMPTY;
            built(world, EMPTY);
        }),
        // Recorded, and not executed.
        keeps(CopySource07532, |world| {
            world.only_record();
            world.copy().src = EMPTY;
        }),
        breaks(|world| world.host_copy().src = EMPTY, &[(HostCopySource11670, "pInfo->src")]),
        keeps(HostCopySource11670, |world| {
            world.host_copy().src = EMPTY;
            built(world, EMPTY);
        }),
        breaks(|world| world.serialize().src = EMPTY, &[(SerializeSource07540, "pInfo->src")]),
        breaks(|world| world.host_serialize().src = EMPTY, &[(SerializeSource07540, "pInfo->src")]),
        // Deserialized in the same command buffer.
        keeps(SerializeSource07540, |world| world.host_serialize().src = LOADED),
        keeps(SerializeSource07540, |world| {
            world.serialize().src = EMPTY;
            built(world, EMPTY);
        }),
    ]
}

/// What is built does not allow compaction, and nobody asks for its compacted size.
fn not_compactable(world: &mut World) {
    world.build_info().flags = vk::BuildMicromapFlags::PREFER_FAST_TRACE;
    world.remove("vkCmdWriteMicromapsPropertiesEXT");
}

fn compaction() -> Vec<WorldCase> {
    vec![
        breaks(
            |world| {
                not_compactable(world);
                world.copy().mode = vk::CopyMicromapMode::COMPACT;
            },
            &[(CompactionFlag07533, "pInfo->src")],
        ),
        breaks(
            |world| {
                not_compactable(world);
                world.host_copy().mode = vk::CopyMicromapMode::COMPACT;
            },
            &[(CompactionFlag07533, "pInfo->src")],
        ),
        keeps(CompactionFlag07533, |world| world.copy().mode = vk::CopyMicromapMode::COMPACT),
        keeps(CompactionFlag07533, not_compactable),
        // Nobody knows how deserialized data was built.
        keeps(CompactionFlag07533, |world| {
            not_compactable(world);
            let copy = world.host_copy();
            (copy.src, copy.mode) = (LOADED, vk::CopyMicromapMode::COMPACT);
        }),
    ]
}

/// The device serializes once more, when the size is known, to that address.
fn serialize_again(world: &mut World, address: u64) {
    let command_buffer = COMMAND_BUFFER;
    world.push(Call::BeginCommandBuffer { command_buffer, begin_info: vk::CommandBufferBeginInfo::default() });
    let mut info = world.serialize().clone();
    info.dst = vk::DeviceAddress(address).into();
    world.push(Call::CmdCopyMicromapToMemory { command_buffer, info });
    world.push(Call::EndCommandBuffer { command_buffer });
}

fn room() -> Vec<WorldCase> {
    vec![
        breaks(
            |world| world.host_serialize().dst = vk::HostAddress(HOST_BASE + HOST_SIZE - SERIALIZED_SIZE + 16).into(),
            &[(SerializeRoom07541, "pInfo->dst")],
        ),
        keeps(SerializeRoom07541, |world| {
            world.host_serialize().dst = vk::HostAddress(HOST_BASE + HOST_SIZE - SERIALIZED_SIZE).into();
        }),
        // How much it takes is not known before the question.
        keeps(SerializeRoom07541, |world| {
            world.remove("vkWriteMicromapsPropertiesEXT");
            world.host_serialize().dst = vk::HostAddress(HOST_BASE + HOST_SIZE - 16).into();
        }),
        breaks(
            |world| {
                world.said_to_take(SERIALIZED_SIZE + 1);
                serialize_again(world, BASE + BUFFER_SIZE - SERIALIZED_SIZE);
            },
            &[(SerializeRoom07541, "pInfo->dst")],
        ),
        keeps(SerializeRoom07541, |world| serialize_again(world, BASE + BUFFER_SIZE - SERIALIZED_SIZE)),
    ]
}

#[test]
fn cases_hold() {
    run_cases(&cases());
}
