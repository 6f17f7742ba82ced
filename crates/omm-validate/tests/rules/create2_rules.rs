//! `vkCreateAccelerationStructure2KHR` and `vkCreateAccelerationStructureKHR`.

use omm_model::call::{Call, DeviceCreateInfo, DeviceQueueCreateInfo, Output};
use omm_model::vk;
use omm_validate::RuleId::*;
use vk::{
    AccelerationStructureCreateFlags as CreateFlags, AccelerationStructureType as Type,
    AddressCommandFlags as AddressFlags, BufferCreateFlags, BufferUsageFlags,
};

use crate::khr_build::plain;
use crate::scene::*;

const NEW: vk::AccelerationStructure = vk::AccelerationStructure(0x60);
const OTHER: vk::Buffer = vk::Buffer(0x61);
const OTHER_BASE: u64 = 0x10_0000;
const ADDRESS: &str = "pCreateInfo->addressRange.address";
const RANGE: &str = "pCreateInfo->addressRange";
const CREATE_FLAGS: &str = "pCreateInfo->createFlags";
const ADDRESS_FLAGS: &str = "pCreateInfo->addressFlags";
const STORAGE: BufferUsageFlags = BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE;

/// A valid creation of a micromap.
fn creation() -> Scene {
    of_type(Type::OPACITY_MICROMAP)
}

fn of_type(ty: Type) -> Scene {
    let mut scene = Scene::micromap();
    let range = vk::DeviceAddressRange { address: vk::DeviceAddress(BASE + 0xa00), size: 0x100 };
    let create_info = vk::AccelerationStructureCreateInfo2 { ty, address_range: range, ..Default::default() };
    scene.call = Call::CreateAccelerationStructure2 { device: DEVICE, create_info, acceleration_structure: NEW };
    scene
}

fn info(scene: &mut Scene) -> &mut vk::AccelerationStructureCreateInfo2 {
    match &mut scene.call {
        Call::CreateAccelerationStructure2 { create_info, .. } => create_info,
        other => panic!("{}", other.command()),
    }
}

/// A creation in another buffer of those flags and that usage.
fn other(flags: BufferCreateFlags, usage: BufferUsageFlags) -> Scene {
    let mut scene = creation();
    let create_info = vk::BufferCreateInfo { flags, size: 0x2000, usage, ..Default::default() };
    scene.track(&Call::CreateBuffer { device: DEVICE, create_info, buffer: OTHER });
    if !flags.intersects(BufferCreateFlags::SPARSE_BINDING) {
        let (memory, memory_offset) = (vk::DeviceMemory(0x62), 0);
        let allocate_info = vk::MemoryAllocateInfo { allocation_size: 0x2000, ..Default::default() };
        scene.track(&Call::AllocateMemory { device: DEVICE, allocate_info, memory });
        scene.track(&Call::BindBufferMemory { device: DEVICE, buffer: OTHER, memory, memory_offset });
    }
    let ask = vk::BufferDeviceAddressInfo { buffer: OTHER, ..Default::default() };
    let address = Output::DeviceAddress(vk::DeviceAddress(OTHER_BASE));
    scene.validator.track(&Call::GetBufferDeviceAddress { device: DEVICE, info: ask }, &address);
    info(&mut scene).address_range.address = vk::DeviceAddress(OTHER_BASE);
    scene
}

fn captured() -> Scene {
    let mut scene = other(BufferCreateFlags::DEVICE_ADDRESS_CAPTURE_REPLAY, STORAGE);
    info(&mut scene).create_flags = CreateFlags::DEVICE_ADDRESS_CAPTURE_REPLAY;
    scene
}

fn protected() -> Scene {
    other(BufferCreateFlags::PROTECTED, STORAGE)
}

fn stored() -> Scene {
    other(BufferCreateFlags::empty(), STORAGE | BufferUsageFlags::STORAGE_BUFFER)
}

fn fed_back() -> Scene {
    other(BufferCreateFlags::empty(), STORAGE | BufferUsageFlags::TRANSFORM_FEEDBACK_BUFFER)
}

fn ordinary() -> Scene {
    other(BufferCreateFlags::empty(), STORAGE)
}

fn with_flags(mut scene: Scene, flags: CreateFlags) -> Scene {
    info(&mut scene).create_flags = flags;
    scene
}

/// The captured creation on a device of that many physical devices.
fn on_devices(count: u64) -> Scene {
    let mut scene = captured();
    let physical_devices = (1..=count).map(vk::PhysicalDevice).collect();
    let group = vk::DeviceGroupDeviceCreateInfo { physical_devices, ..Default::default() };
    let mut features = omm_model::profile::Features::ALL;
    features.buffer_device_address_multi_device = false;
    let queue_create_infos = vec![DeviceQueueCreateInfo { queue_family_index: 0, queue_count: 1 }];
    let create_info =
        DeviceCreateInfo { next: vec![group.into()], queue_create_infos, enabled_features: Some(features) };
    let physical_device = vk::PhysicalDevice(1);
    scene.track(&Call::CreateDevice { physical_device, create_info, device: DEVICE });
    scene
}

/// A mesh with motion, built into a new object.
fn moving(flags: CreateFlags) -> Scene {
    let mut scene = plain();
    let mut create = with_flags(of_type(Type::BOTTOM_LEVEL), flags);
    scene.track_create(NEW, info(&mut create).clone());
    scene.triangles().next = vec![vk::GeometryMotionTrianglesData::default().into()];
    scene.info().flags = vk::BuildAccelerationStructureFlags::MOTION;
    scene.info().dst_acceleration_structure = NEW;
    scene
}

/// A build submitted into an object in a sparse buffer that is bound so far.
fn sparse(bound: u64) -> Scene {
    let mut scene = other(BufferCreateFlags::SPARSE_BINDING, STORAGE);
    let bind = vk::SparseMemoryBind { size: bound, memory: MEMORY, ..Default::default() };
    let buffer_binds = vec![vk::SparseBufferMemoryBindInfo { buffer: OTHER, binds: vec![bind] }];
    scene.track(&Call::QueueBindSparse { queue: QUEUE, buffer_binds });
    let create = info(&mut scene);
    create.address_flags = AddressFlags::FULLY_BOUND;
    create.address_range.size = 0x2000;
    scene.track(&scene.call.clone());
    scene.track(&build(vec![micromap_build(NEW)], vec![None]));
    scene.track(&Call::EndCommandBuffer { command_buffer: COMMAND_BUFFER });
    scene.call = Call::QueueSubmit { queue: QUEUE, command_buffers: vec![COMMAND_BUFFER] };
    scene
}

fn older(ty: Type) -> Scene {
    let mut scene = Scene::micromap();
    let create_info =
        vk::AccelerationStructureCreateInfo { ty, buffer: BUFFER, offset: 0xa00, size: 0x100, ..Default::default() };
    scene.call = Call::CreateAccelerationStructure { device: DEVICE, create_info, acceleration_structure: NEW };
    scene
}

fn feature_cases() -> Vec<Case> {
    vec![
        fails(
            || of_type(Type::BOTTOM_LEVEL),
            |scene| scene.restart(|profile| profile.features.acceleration_structure = false),
            &[(Feature03611, "")],
        ),
        passes(Feature03611, || of_type(Type::BOTTOM_LEVEL), |_| {}),
        fails(
            creation,
            |scene| scene.restart(|profile| profile.features.device_address_commands = false),
            &[(Feature13086, "")],
        ),
        passes(Feature13086, creation, |_| {}),
        fails(
            creation,
            |scene| scene.restart(|profile| profile.features.micromap = false),
            &[(Feature11609, "pCreateInfo->type")],
        ),
        passes(Feature11609, creation, |_| {}),
        fails(
            || {
                let mut scene = captured();
                scene.restart(|profile| profile.features.acceleration_structure_capture_replay = false);
                info(&mut scene).address_range.address = vk::DeviceAddress(BASE + 0xa00);
                scene
            },
            |_| {},
            &[(Feature03613, CREATE_FLAGS), (CaptureReplay11607, CREATE_FLAGS)],
        ),
        passes(Feature03613, captured, |_| {}),
        fails(|| on_devices(2), |_| {}, &[(Feature11673, CREATE_FLAGS)]),
        passes(Feature11673, || on_devices(1), |_| {}),
        fails(
            || with_flags(of_type(Type::BOTTOM_LEVEL), CreateFlags::DESCRIPTOR_BUFFER_CAPTURE_REPLAY),
            |scene| scene.restart(|profile| profile.features.descriptor_buffer_capture_replay = false),
            &[(Feature08108, CREATE_FLAGS)],
        ),
        passes(
            Feature08108,
            || with_flags(of_type(Type::BOTTOM_LEVEL), CreateFlags::DESCRIPTOR_BUFFER_CAPTURE_REPLAY),
            |_| {},
        ),
    ]
}

fn member_cases() -> Vec<Case> {
    let opaque = |scene: &mut Scene| {
        info(scene).next.push(vk::ChainStructure::Unknown(vk::StructureType(1_000_316_010)));
    };
    vec![
        fails(|| older(Type::OPACITY_MICROMAP), |_| {}, &[(Type11600, "pCreateInfo->type")]),
        passes(Type11600, || older(Type::GENERIC), |_| {}),
        fails(
            creation,
            |scene| info(scene).address_range.address = vk::DeviceAddress::NULL,
            &[(AddressRange11602, ADDRESS)],
        ),
        fails(
            creation,
            |scene| info(scene).address_range.address = vk::DeviceAddress(BASE + BUFFER_SIZE),
            &[(AddressRange11602, ADDRESS)],
        ),
        passes(AddressRange11602, creation, |_| {}),
        fails(
            creation,
            |scene| info(scene).address_range.address = vk::DeviceAddress(BASE + 0xa80),
            &[(AddressRange11605, ADDRESS)],
        ),
        passes(AddressRange11605, creation, |scene| {
            info(scene).address_range.address = vk::DeviceAddress(BASE + 0xb00);
        }),
        fails(
            creation,
            |scene| info(scene).address_range.size = 0,
            &[(AddressRange11608, "pCreateInfo->addressRange.size")],
        ),
        passes(AddressRange11608, creation, |scene| info(scene).address_range.size = 1),
        fails(
            || with_flags(creation(), CreateFlags::DESCRIPTOR_BUFFER_CAPTURE_REPLAY),
            |_| {},
            &[(CreateFlags11610, CREATE_FLAGS)],
        ),
        passes(
            CreateFlags11610,
            || with_flags(of_type(Type::BOTTOM_LEVEL), CreateFlags::DESCRIPTOR_BUFFER_CAPTURE_REPLAY),
            |_| {},
        ),
        fails(|| with_flags(creation(), CreateFlags::MOTION), |_| {}, &[(CreateFlags11611, CREATE_FLAGS)]),
        passes(CreateFlags11611, || with_flags(of_type(Type::BOTTOM_LEVEL), CreateFlags::MOTION), |_| {}),
        fails(
            || with_flags(of_type(Type::TOP_LEVEL), CreateFlags::MOTION),
            |_| {},
            &[(MotionInfo04954, "pCreateInfo->pNext")],
        ),
        passes(
            MotionInfo04954,
            || with_flags(of_type(Type::TOP_LEVEL), CreateFlags::MOTION),
            |scene| {
                info(scene).next.push(vk::AccelerationStructureMotionInfo::default().into());
            },
        ),
        fails(|| of_type(Type::BOTTOM_LEVEL), opaque, &[(OpaqueCapture08109, CREATE_FLAGS)]),
        passes(
            OpaqueCapture08109,
            || with_flags(of_type(Type::BOTTOM_LEVEL), CreateFlags::DESCRIPTOR_BUFFER_CAPTURE_REPLAY),
            opaque,
        ),
        fails(
            || moving(CreateFlags::empty()),
            |_| {},
            &[(
                MotionTriangles04955,
                "pInfos[0].pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureGeometryMotionTrianglesDataNV>",
            )],
        ),
        passes(MotionTriangles04955, || moving(CreateFlags::MOTION), |_| {}),
    ]
}

fn memory_cases() -> Vec<Case> {
    vec![
        fails(
            || other(BufferCreateFlags::empty(), BufferUsageFlags::STORAGE_BUFFER),
            |scene| {
                info(scene).address_flags = AddressFlags::STORAGE_BUFFER_USAGE;
            },
            &[(AddressRange11603, RANGE)],
        ),
        fails(creation, |scene| info(scene).address_range.size = BUFFER_SIZE, &[(AddressRange11603, RANGE)]),
        passes(AddressRange11603, ordinary, |_| {}),
        fails(
            || other(BufferCreateFlags::SPARSE_BINDING | BufferCreateFlags::SPARSE_RESIDENCY, STORAGE),
            |_| {},
            &[(AddressRange11604, RANGE)],
        ),
        passes(AddressRange11604, || other(BufferCreateFlags::SPARSE_BINDING, STORAGE), |_| {}),
        fails(captured, |scene| info(scene).create_flags = CreateFlags::empty(), &[(CaptureReplay11606, CREATE_FLAGS)]),
        passes(CaptureReplay11606, captured, |_| {}),
        fails(
            ordinary,
            |scene| info(scene).create_flags = CreateFlags::DEVICE_ADDRESS_CAPTURE_REPLAY,
            &[(CaptureReplay11607, CREATE_FLAGS)],
        ),
        passes(CaptureReplay11607, ordinary, |_| {}),
        fails(protected, |_| {}, &[(Protected13098, ADDRESS_FLAGS)]),
        passes(Protected13098, protected, |scene| info(scene).address_flags = AddressFlags::PROTECTED),
        fails(
            ordinary,
            |scene| info(scene).address_flags = AddressFlags::PROTECTED,
            &[(Protected13099, ADDRESS_FLAGS)],
        ),
        passes(Protected13099, ordinary, |_| {}),
        fails(
            stored,
            |scene| {
                info(scene).address_flags =
                    AddressFlags::STORAGE_BUFFER_USAGE | AddressFlags::UNKNOWN_STORAGE_BUFFER_USAGE;
            },
            &[(StorageUsage13100, ADDRESS_FLAGS)],
        ),
        passes(StorageUsage13100, stored, |scene| info(scene).address_flags = AddressFlags::STORAGE_BUFFER_USAGE),
        fails(
            fed_back,
            |scene| {
                info(scene).address_flags = AddressFlags::TRANSFORM_FEEDBACK_BUFFER_USAGE
                    | AddressFlags::UNKNOWN_TRANSFORM_FEEDBACK_BUFFER_USAGE;
            },
            &[(TransformFeedbackUsage13101, ADDRESS_FLAGS)],
        ),
        passes(TransformFeedbackUsage13101, fed_back, |scene| {
            info(scene).address_flags = AddressFlags::TRANSFORM_FEEDBACK_BUFFER_USAGE;
        }),
        fails(stored, |_| {}, &[(StorageUsage13122, ADDRESS_FLAGS)]),
        passes(StorageUsage13122, stored, |scene| {
            info(scene).address_flags = AddressFlags::UNKNOWN_STORAGE_BUFFER_USAGE;
        }),
        fails(
            ordinary,
            |scene| info(scene).address_flags = AddressFlags::STORAGE_BUFFER_USAGE,
            &[(StorageUsage13123, ADDRESS_FLAGS)],
        ),
        passes(StorageUsage13123, ordinary, |scene| {
            info(scene).address_flags = AddressFlags::UNKNOWN_STORAGE_BUFFER_USAGE;
        }),
        fails(fed_back, |_| {}, &[(TransformFeedbackUsage13124, ADDRESS_FLAGS)]),
        passes(TransformFeedbackUsage13124, fed_back, |scene| {
            info(scene).address_flags = AddressFlags::TRANSFORM_FEEDBACK_BUFFER_USAGE;
        }),
        fails(
            ordinary,
            |scene| info(scene).address_flags = AddressFlags::TRANSFORM_FEEDBACK_BUFFER_USAGE,
            &[(TransformFeedbackUsage13125, ADDRESS_FLAGS)],
        ),
        passes(TransformFeedbackUsage13125, ordinary, |scene| {
            info(scene).address_flags = AddressFlags::UNKNOWN_TRANSFORM_FEEDBACK_BUFFER_USAGE;
        }),
        fails(|| sparse(0x1000), |_| {}, &[(FullyBound13097, "pInfos[0].dstAccelerationStructure")]),
        passes(FullyBound13097, || sparse(0x2000), |_| {}),
    ]
}

pub(crate) fn cases() -> Vec<Case> {
    [feature_cases(), member_cases(), memory_cases()].concat()
}

#[test]
fn cases_hold() {
    run(&cases());
}
