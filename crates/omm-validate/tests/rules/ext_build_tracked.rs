//! Rules of builds of micromap objects on objects and addresses.

use omm_model::call::{Call, Output};
use omm_model::vk;
use omm_validate::RuleId::*;

use crate::ext_build_world::*;
use crate::ext_copy_world::{BASE, DEVICE, HOST_BASE, World};

const SIZES: &str = "vkGetMicromapBuildSizesEXT";

fn at(address: u64) -> vk::DeviceOrHostAddress {
    vk::DeviceAddress(address).into()
}

fn host_at(address: u64) -> vk::DeviceOrHostAddress {
    vk::HostAddress(address).into()
}

/// Without the buffer from the build on.
fn destroy(world: &mut World, buffer: vk::Buffer) {
    world.insert("vkCmdBuildMicromapsEXT", Call::DestroyBuffer { device: DEVICE, buffer });
}

/// Without the call that binds the storage of the micromaps.
fn unbind_storage(world: &mut World) {
    world.calls.retain(|(call, _)| !matches!(call, Call::BindBufferMemory { buffer: STORAGE, .. }));
}

/// Both micromaps are built by the host, the device builds nothing.
fn only_host(world: &mut World) {
    world.remove("vkCmdBuildMicromapsEXT");
    world.remove("vkCmdBuildAccelerationStructuresKHR");
}

/// The device builds both micromaps at once, the host none, and nothing is attached.
fn both_on_device(world: &mut World, scratch: u64) {
    world.remove("vkCmdBuildAccelerationStructuresKHR");
    world.remove("vkBuildMicromapsEXT");
    builds(world).push(vk::MicromapBuildInfo { scratch_data: at(scratch), ..build_info(HOST_BUILT) });
}

/// The host builds both micromaps at once, and the device none.
fn both_on_host(world: &mut World, scratch: u64) {
    only_host(world);
    let first = vk::MicromapBuildInfo { dst_micromap: BUILT, scratch_data: host_at(scratch), ..host_build_info() };
    host_builds(world).push(first);
}

/// What holds the micromaps is also for storage, and the device's micromap begins at its byte 0x100.
fn scratch_in_storage(world: &mut World) {
    create_storage(world).usage |= vk::BufferUsageFlags::STORAGE_BUFFER;
    create(world).offset = 0x400;
}

/// Removes the answer of the size query.
fn without_sizes(world: &mut World) {
    world.remove(SIZES);
}

pub(crate) fn cases() -> Vec<BuildCase> {
    [object_cases(), address_cases(), host_cases(), overlap_cases(), create_cases()].concat()
}

fn object_cases() -> Vec<BuildCase> {
    vec![
        breaks(|world| create(world).size = MICROMAP_SIZE - 1, &[(DstMicromapSize07461, "pInfos[0].dstMicromap")]),
        keeps(DstMicromapSize07461, |world| create(world).size = MICROMAP_SIZE),
        keeps(DstMicromapSize07461, |world| {
            without_sizes(world);
            create(world).size = 1;
        }),
        breaks(
            |world| {
                create(world).ty = vk::MicromapType::DISPLACEMENT_MICROMAP;
                world.remove("vkCmdBuildAccelerationStructuresKHR");
            },
            &[(Type07464, "pInfos[0].type")],
        ),
        keeps(Type07464, |world| create(world).ty = vk::MicromapType::OPACITY_MICROMAP),
        breaks(
            |world| {
                world.remove("vkCmdBuildAccelerationStructuresKHR");
                world.insert("vkCmdBuildMicromapsEXT", Call::DestroyMicromap { device: DEVICE, micromap: BUILT });
            },
            &[(DstMicromap07463, "pInfos[0].dstMicromap")],
        ),
        keeps(DstMicromap07463, |world| world.push(Call::DestroyMicromap { device: DEVICE, micromap: BUILT })),
        breaks(
            |world| {
                unbind_storage(world);
                world.remove("vkBuildMicromapsEXT");
            },
            &[(DstMicromapMemory07508, "pInfos[0].dstMicromap")],
        ),
        keeps(DstMicromapMemory07508, |world| {
            world.remove("vkBuildMicromapsEXT");
        }),
        breaks(
            |world| {
                let two = |found: &(Call, Output)| found.0.command() == SIZES;
                world.on_two_devices();
                world.calls.retain(|found| two(found) || found.0.command() == "vkCreateDevice");
                world.profile.features.buffer_device_address_multi_device = false;
            },
            &[(MultiDeviceSizes07440, "device")],
        ),
        keeps(MultiDeviceSizes07440, World::on_two_devices),
        keeps(MultiDeviceSizes07440, |world| world.profile.features.buffer_device_address_multi_device = false),
    ]
}

fn address_cases() -> Vec<BuildCase> {
    const END: u64 = SIZE - SCRATCH_SIZE;
    vec![
        breaks(
            |world| build(world).scratch_data = at(address_of(SCRATCH) + END + 0x80),
            &[(ScratchRange07509, "pInfos[0].scratchData")],
        ),
        keeps(ScratchRange07509, |world| build(world).scratch_data = at(address_of(SCRATCH) + END)),
        breaks(
            |world| {
                create_buffer_info(world, INPUT).usage = vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
                world.remove("vkCmdBuildAccelerationStructuresKHR");
            },
            &[(InputUsage07510, "pInfos[0].data"), (InputUsage07510, "pInfos[0].triangleArray")],
        ),
        keeps(InputUsage07510, |world| {
            let usage = vk::BufferUsageFlags::MICROMAP_BUILD_INPUT_READ_ONLY;
            create_buffer_info(world, INPUT).usage = usage;
            world.remove("vkCmdBuildAccelerationStructuresKHR");
        }),
        breaks(
            |world| {
                create_buffer_info(world, SCRATCH).usage = vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
                world.remove("vkCmdBuildAccelerationStructuresKHR");
            },
            &[(ScratchUsage07511, "pInfos[0].scratchData")],
        ),
        keeps(ScratchUsage07511, |world| {
            create_buffer_info(world, SCRATCH).usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        }),
        breaks(|world| build(world).scratch_data = at(0), &[(ScratchAddress07512, "pInfos[0].scratchData")]),
        breaks(
            |world| build(world).scratch_data = host_at(address_of(SCRATCH)),
            &[(ScratchAddress07512, "pInfos[0].scratchData")],
        ),
        breaks(
            |world| build(world).scratch_data = at(BASE + 0x10_0000),
            &[(ScratchAddress07512, "pInfos[0].scratchData")],
        ),
        keeps(ScratchAddress07512, |world| build(world).scratch_data = at(address_of(SCRATCH))),
        keeps(ScratchAddress07512, |world| {
            without_sizes(world);
            build(world).scratch_data = at(0);
        }),
        breaks(|world| build(world).data = at(0), &[(DataAddress10896, "pInfos[0].data")]),
        breaks(|world| build(world).data = at(BASE + 0x10_0000), &[(DataAddress10896, "pInfos[0].data")]),
        breaks(|world| build(world).data = host_at(HOST_BASE), &[(DataAddress10896, "pInfos[0].data")]),
        keeps(DataAddress10896, |world| build(world).data = at(address_of(INPUT) + 0x300)),
        breaks(|world| build(world).triangle_array = at(0), &[(TriangleArrayAddress10897, "pInfos[0].triangleArray")]),
        breaks(
            |world| {
                world.remove("vkCmdBuildAccelerationStructuresKHR");
                destroy(world, INPUT);
            },
            &[(DataAddress10896, "pInfos[0].data"), (TriangleArrayAddress10897, "pInfos[0].triangleArray")],
        ),
        keeps(TriangleArrayAddress10897, |world| {
            build(world).triangle_array = at(address_of(INPUT));
        }),
    ]
}

fn host_cases() -> Vec<BuildCase> {
    vec![
        breaks(
            |world| {
                only_host(world);
                host_build(world).dst_micromap = BUILT;
                create(world).size = MICROMAP_SIZE - 1;
            },
            &[(HostDstMicromapSize07461, "pInfos[0].dstMicromap")],
        ),
        keeps(HostDstMicromapSize07461, only_host),
        breaks(
            |world| {
                only_host(world);
                host_build(world).dst_micromap = BUILT;
                create(world).ty = vk::MicromapType::DISPLACEMENT_MICROMAP;
            },
            &[(HostType07464, "pInfos[0].type")],
        ),
        breaks(
            |world| host_build(world).dst_micromap = vk::Micromap::NULL,
            &[(HostDstMicromap07463, "pInfos[0].dstMicromap")],
        ),
        keeps(HostDstMicromap07463, |world| world.push(Call::DestroyMicromap { device: DEVICE, micromap: HOST_BUILT })),
        keeps(HostType07464, |world| {
            only_host(world);
            create(world).ty = vk::MicromapType::DISPLACEMENT_MICROMAP;
        }),
        breaks(
            |world| allocate(world, STORAGE).memory_type_index = 0,
            &[(HostDstMicromapMemory07552, "pInfos[0].dstMicromap")],
        ),
        breaks(
            |world| {
                only_host(world);
                unbind_storage(world);
            },
            &[(HostDstMicromapMemory07552, "pInfos[0].dstMicromap")],
        ),
        keeps(HostDstMicromapMemory07552, |world| allocate(world, STORAGE).memory_type_index = 1),
        breaks(
            |world| {
                world.on_two_devices();
                allocate(world, STORAGE).next.clear();
            },
            &[(HostDstMicromapInstances07557, "pInfos[0].dstMicromap")],
        ),
        keeps(HostDstMicromapInstances07557, World::on_two_devices),
        breaks(|world| host_build(world).scratch_data = host_at(0), &[(HostScratch07556, "pInfos[0].scratchData")]),
        breaks(
            |world| host_build(world).scratch_data = at(address_of(SCRATCH)),
            &[(HostScratch07556, "pInfos[0].scratchData")],
        ),
        breaks(
            |world| host_build(world).scratch_data = host_at(HOST_BASE + HOST_SIZE - SCRATCH_SIZE + 1),
            &[(HostScratch07556, "pInfos[0].scratchData")],
        ),
        keeps(HostScratch07556, |world| {
            host_build(world).scratch_data = host_at(HOST_BASE + HOST_SIZE - SCRATCH_SIZE);
        }),
        keeps(HostScratch07556, |world| {
            without_sizes(world);
            host_build(world).scratch_data = host_at(0);
        }),
    ]
}

fn overlap_cases() -> Vec<BuildCase> {
    vec![
        breaks(
            |world| {
                both_on_device(world, address_of(SCRATCH) + SCRATCH_SIZE);
                builds(world)[1].dst_micromap = BUILT;
            },
            &[(DstMicromapOverlap11649, "pInfos[1].dstMicromap")],
        ),
        keeps(DstMicromapOverlap11649, |world| both_on_device(world, address_of(SCRATCH) + SCRATCH_SIZE)),
        breaks(
            |world| {
                scratch_in_storage(world);
                build(world).scratch_data = at(address_of(STORAGE) + 0x380);
            },
            &[(DstMicromapScratchOverlap11650, "pInfos[0].dstMicromap")],
        ),
        keeps(DstMicromapScratchOverlap11650, |world| {
            scratch_in_storage(world);
            build(world).scratch_data = at(address_of(STORAGE) + 0x300);
        }),
        breaks(
            |world| both_on_device(world, address_of(SCRATCH) + SCRATCH_SIZE - 0x80),
            &[(ScratchOverlap11651, "pInfos[1].scratchData")],
        ),
        keeps(ScratchOverlap11651, |world| both_on_device(world, address_of(SCRATCH) + SCRATCH_SIZE)),
        breaks(
            |world| {
                both_on_host(world, HOST_SCRATCH + SCRATCH_SIZE);
                host_builds(world)[1].dst_micromap = HOST_BUILT;
            },
            &[(HostDstMicromapOverlap11667, "pInfos[1].dstMicromap")],
        ),
        keeps(HostDstMicromapOverlap11667, |world| both_on_host(world, HOST_SCRATCH + SCRATCH_SIZE)),
        breaks(
            |world| both_on_host(world, HOST_SCRATCH + SCRATCH_SIZE - 1),
            &[(HostScratchOverlap11669, "pInfos[1].scratchData")],
        ),
        keeps(HostScratchOverlap11669, |world| both_on_host(world, HOST_SCRATCH - SCRATCH_SIZE)),
    ]
}

fn create_cases() -> Vec<BuildCase> {
    vec![
        breaks(
            |world| {
                world.calls.retain(|(call, _)| matches!(call, Call::CreateBuffer { .. }) || is_first_create(call));
                create_storage(world).usage = vk::BufferUsageFlags::STORAGE_BUFFER;
            },
            &[(BufferUsage07435, "pCreateInfo->buffer")],
        ),
        keeps(BufferUsage07435, |world| create_storage(world).usage |= vk::BufferUsageFlags::STORAGE_BUFFER),
        breaks(
            |world| {
                world.calls.retain(|(call, _)| matches!(call, Call::CreateBuffer { .. }) || is_first_create(call));
                create_storage(world).flags =
                    vk::BufferCreateFlags::SPARSE_BINDING | vk::BufferCreateFlags::SPARSE_RESIDENCY;
            },
            &[(SparseBuffer07436, "pCreateInfo->buffer")],
        ),
        keeps(SparseBuffer07436, |world| create_storage(world).flags = vk::BufferCreateFlags::SPARSE_BINDING),
        breaks(|world| create(world).size = SIZE + 1, &[(Range07437, "pCreateInfo->size")]),
        breaks(
            |world| {
                world.calls.retain(|(call, _)| matches!(call, Call::CreateBuffer { .. }) || is_first_create(call));
                create(world).offset = u64::MAX - 0xff;
            },
            &[(Range07437, "pCreateInfo->size")],
        ),
        keeps(Range07437, |world| create(world).size = SIZE),
        breaks(
            |world| {
                replay_on_two(world);
                world.profile.features.buffer_device_address_multi_device = false;
            },
            &[(MultiDeviceReplay11617, "pCreateInfo->createFlags")],
        ),
        keeps(MultiDeviceReplay11617, replay_on_two),
    ]
}

fn is_first_create(call: &Call) -> bool {
    matches!(call, Call::CreateMicromap { micromap: BUILT, .. })
}

/// A micromap whose address is replayed, on two physical devices; nothing else.
fn replay_on_two(world: &mut World) {
    create(world).create_flags = vk::MicromapCreateFlags::DEVICE_ADDRESS_CAPTURE_REPLAY;
    world.on_two_devices();
    world.calls.retain(|(call, _)| matches!(call, Call::CreateDevice { .. }) || is_first_create(call));
}

#[test]
fn cases_hold() {
    run(&cases());
}
