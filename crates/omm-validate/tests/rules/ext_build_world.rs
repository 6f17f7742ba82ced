//! A valid program that builds micromap objects on both timelines and attaches one, and cases that change it a little.

use omm_model::call::{Call, Output};
use omm_model::profile::DeviceProfile;
use omm_model::vk;
use omm_validate::RuleId;

use crate::ext_copy_world::{BASE, DEVICE, HOST_BASE, QUEUE, World};

pub(crate) const COMMAND_BUFFER: vk::CommandBuffer = vk::CommandBuffer(4);
const COMMAND_POOL: vk::CommandPool = vk::CommandPool(3);

/// Triangle array, opacity data and micromap indices.
pub(crate) const INPUT: vk::Buffer = vk::Buffer(0x20);
/// Scratch memory.
pub(crate) const SCRATCH: vk::Buffer = vk::Buffer(0x21);
/// Holds both micromaps.
pub(crate) const STORAGE: vk::Buffer = vk::Buffer(0x22);
/// Holds the bottom-level structure.
const BOTTOM_LEVEL_STORAGE: vk::Buffer = vk::Buffer(0x23);
/// Bytes of each buffer.
pub(crate) const SIZE: u64 = 0x1000;

/// Built by the device, and attached.
pub(crate) const BUILT: vk::Micromap = vk::Micromap(0x30);
/// Built by the host.
pub(crate) const HOST_BUILT: vk::Micromap = vk::Micromap(0x31);
const BOTTOM_LEVEL: vk::AccelerationStructure = vk::AccelerationStructure(0x32);

/// Bytes of a micromap, as told by the size query.
pub(crate) const MICROMAP_SIZE: u64 = 0x200;
/// Bytes of scratch memory, as told by the size query.
pub(crate) const SCRATCH_SIZE: u64 = 0x100;

const DATA: u64 = 0x100;
const INDICES: u64 = 0x200;

/// The address of a buffer's first byte.
pub(crate) const fn address_of(buffer: vk::Buffer) -> u64 {
    BASE + SIZE * (buffer.0 - INPUT.0)
}

/// Where the host finds scratch memory.
pub(crate) const HOST_SCRATCH: u64 = HOST_BASE + 0x400;
/// Bytes of host memory.
pub(crate) const HOST_SIZE: u64 = 0x1000;

/// The program, on the reference device.
pub(crate) fn program() -> World {
    let mut input = Vec::new();
    for (offset, level, format) in [(0_u32, 1_u16, 2_u16), (1, 1, 2), (2, 2, 1)] {
        input.extend([&offset.to_le_bytes()[..], &level.to_le_bytes(), &format.to_le_bytes()].concat());
    }
    let (mut device_memory, mut host_memory) = (vec![0; SIZE as usize], vec![0; HOST_SIZE as usize]);
    for memory in [&mut device_memory, &mut host_memory] {
        memory[..input.len()].copy_from_slice(&input);
    }
    let indices = [0_u16, 1, 2, 0xffff].map(u16::to_le_bytes).concat();
    device_memory[INDICES as usize..][..indices.len()].copy_from_slice(&indices);
    let mut world = World { profile: DeviceProfile::reference(), calls: Vec::new(), device_memory, host_memory };
    create_objects(&mut world);
    record(&mut world);
    world.push(Call::BuildMicromaps {
        device: DEVICE,
        deferred_operation: vk::DeferredOperation::NULL,
        infos: vec![host_build_info()],
    });
    world
}

fn create_objects(world: &mut World) {
    use vk::BufferUsageFlags as Usage;
    let input = Usage::MICROMAP_BUILD_INPUT_READ_ONLY | Usage::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY;
    for (buffer, usage) in [
        (INPUT, input),
        (SCRATCH, Usage::STORAGE_BUFFER),
        (STORAGE, Usage::MICROMAP_STORAGE),
        (BOTTOM_LEVEL_STORAGE, Usage::ACCELERATION_STRUCTURE_STORAGE),
    ] {
        world.calls.extend(create_buffer(buffer, usage));
    }
    let sizes = vk::MicromapBuildSizesInfo {
        micromap_size: MICROMAP_SIZE,
        build_scratch_size: SCRATCH_SIZE,
        ..Default::default()
    };
    let build_type = vk::AccelerationStructureBuildType::HOST_OR_DEVICE;
    let build_info = build_info(BUILT);
    world.calls.push((
        Call::GetMicromapBuildSizes { device: DEVICE, build_type, build_info },
        Output::MicromapBuildSizes(sizes),
    ));
    for (index, micromap) in (0..).zip([BUILT, HOST_BUILT]) {
        let create_info = vk::MicromapCreateInfo {
            buffer: STORAGE,
            offset: index * MICROMAP_SIZE,
            size: MICROMAP_SIZE,
            ..Default::default()
        };
        world.push(Call::CreateMicromap { device: DEVICE, create_info, micromap });
    }
    let create_info = vk::AccelerationStructureCreateInfo {
        buffer: BOTTOM_LEVEL_STORAGE,
        size: SIZE,
        ty: vk::AccelerationStructureType::BOTTOM_LEVEL,
        ..Default::default()
    };
    let acceleration_structure = BOTTOM_LEVEL;
    world.push(Call::CreateAccelerationStructure { device: DEVICE, create_info, acceleration_structure });
    let create_info = vk::CommandPoolCreateInfo::default();
    world.push(Call::CreateCommandPool { device: DEVICE, create_info, command_pool: COMMAND_POOL });
    let allocate_info =
        vk::CommandBufferAllocateInfo { command_pool: COMMAND_POOL, command_buffer_count: 1, ..Default::default() };
    let command_buffers = vec![COMMAND_BUFFER];
    world.push(Call::AllocateCommandBuffers { device: DEVICE, allocate_info, command_buffers });
    world.push(Call::GetDeviceQueue { device: DEVICE, queue_family_index: 0, queue_index: 0, queue: QUEUE });
}

fn record(world: &mut World) {
    let command_buffer = COMMAND_BUFFER;
    world.push(Call::BeginCommandBuffer { command_buffer, begin_info: vk::CommandBufferBeginInfo::default() });
    world.push(Call::CmdBuildMicromaps { command_buffer, infos: vec![build_info(BUILT)] });
    let attached = vk::TrianglesOpacityMicromapExt {
        index_type: vk::IndexType::UINT16,
        index_buffer: vk::DeviceAddress(address_of(INPUT) + INDICES).into(),
        index_stride: 2,
        usage_counts: Some(usages()),
        micromap: BUILT,
        ..Default::default()
    };
    let triangles = vk::GeometryTrianglesData {
        next: vec![vk::ChainStructure::TrianglesOpacityMicromapExt(attached)],
        vertex_data: vk::DeviceAddress(address_of(INPUT) + 0x400).into(),
        vertex_format: vk::Format::R32G32B32_SFLOAT,
        vertex_stride: 12,
        max_vertex: 11,
        index_type: vk::IndexType::NONE,
        ..Default::default()
    };
    let geometry = vk::Geometry {
        geometry_type: vk::GeometryType::TRIANGLES,
        geometry: vk::GeometryData::Triangles(triangles),
        ..Default::default()
    };
    let info = vk::BuildGeometryInfo {
        ty: vk::AccelerationStructureType::BOTTOM_LEVEL,
        dst_acceleration_structure: BOTTOM_LEVEL,
        geometries: Some(vec![geometry]),
        scratch_data: vk::DeviceAddress(address_of(SCRATCH) + 0x800).into(),
        ..Default::default()
    };
    let ranges = vec![vk::BuildRangeInfo { primitive_count: 4, ..Default::default() }];
    world.push(Call::CmdBuildAccelerationStructures {
        command_buffer,
        infos: vec![info],
        build_range_infos: vec![Some(ranges)],
    });
    world.push(Call::EndCommandBuffer { command_buffer });
    world.push(Call::QueueSubmit { queue: QUEUE, command_buffers: vec![command_buffer] });
}

/// Creates a buffer in memory that the host can reach, binds it and asks for its address.
fn create_buffer(buffer: vk::Buffer, usage: vk::BufferUsageFlags) -> [(Call, Output); 4] {
    let usage = usage | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
    let create_info = vk::BufferCreateInfo { size: SIZE, usage, ..Default::default() };
    let memory = memory_of(buffer);
    let allocate_info = vk::MemoryAllocateInfo { allocation_size: SIZE, memory_type_index: 2, ..Default::default() };
    let info = vk::BufferDeviceAddressInfo { buffer, ..Default::default() };
    let address = vk::DeviceAddress(address_of(buffer));
    [
        (Call::CreateBuffer { device: DEVICE, create_info, buffer }, Output::None),
        (Call::AllocateMemory { device: DEVICE, allocate_info, memory }, Output::None),
        (Call::BindBufferMemory { device: DEVICE, buffer, memory, memory_offset: 0 }, Output::None),
        (Call::GetBufferDeviceAddress { device: DEVICE, info }, Output::DeviceAddress(address)),
    ]
}

/// The memory that a buffer is bound to.
pub(crate) const fn memory_of(buffer: vk::Buffer) -> vk::DeviceMemory {
    vk::DeviceMemory(buffer.0 + 0x100)
}

/// Two 4-state triangles of level 1 and a 2-state one of level 2.
fn usages() -> Vec<vk::MicromapUsageExt> {
    let usage = |count, subdivision_level, format| vk::MicromapUsageExt { count, subdivision_level, format };
    vec![usage(2, 1, 2), usage(1, 2, 1)]
}

/// A build on the device.
pub(crate) fn build_info(dst_micromap: vk::Micromap) -> vk::MicromapBuildInfo {
    vk::MicromapBuildInfo {
        dst_micromap,
        usage_counts: Some(usages()),
        data: vk::DeviceAddress(address_of(INPUT) + DATA).into(),
        scratch_data: vk::DeviceAddress(address_of(SCRATCH)).into(),
        triangle_array: vk::DeviceAddress(address_of(INPUT)).into(),
        triangle_array_stride: 8,
        ..Default::default()
    }
}

/// The build on the host.
pub(crate) fn host_build_info() -> vk::MicromapBuildInfo {
    vk::MicromapBuildInfo {
        data: vk::HostAddress(HOST_BASE + DATA).into(),
        scratch_data: vk::HostAddress(HOST_SCRATCH).into(),
        triangle_array: vk::HostAddress(HOST_BASE).into(),
        ..build_info(HOST_BUILT)
    }
}

/// The first part of a call that `part` knows.
fn find<T>(world: &mut World, part: impl Fn(&mut Call) -> Option<&mut T>) -> &mut T {
    world.calls.iter_mut().find_map(|(call, _)| part(call)).unwrap()
}

pub(crate) fn create(world: &mut World) -> &mut vk::MicromapCreateInfo {
    find(world, |call| if let Call::CreateMicromap { create_info, .. } = call { Some(create_info) } else { None })
}

pub(crate) fn create_storage(world: &mut World) -> &mut vk::BufferCreateInfo {
    create_buffer_info(world, STORAGE)
}

pub(crate) fn create_buffer_info(world: &mut World, wanted: vk::Buffer) -> &mut vk::BufferCreateInfo {
    find(world, |call| match call {
        Call::CreateBuffer { create_info, buffer, .. } if *buffer == wanted => Some(create_info),
        _ => None,
    })
}

pub(crate) fn allocate(world: &mut World, wanted: vk::Buffer) -> &mut vk::MemoryAllocateInfo {
    find(world, |call| match call {
        Call::AllocateMemory { allocate_info, memory, .. } if *memory == memory_of(wanted) => Some(allocate_info),
        _ => None,
    })
}

pub(crate) fn sizes(world: &mut World) -> &mut vk::MicromapBuildInfo {
    find(world, |call| if let Call::GetMicromapBuildSizes { build_info, .. } = call { Some(build_info) } else { None })
}

pub(crate) fn builds(world: &mut World) -> &mut Vec<vk::MicromapBuildInfo> {
    find(world, |call| if let Call::CmdBuildMicromaps { infos, .. } = call { Some(infos) } else { None })
}

pub(crate) fn host_builds(world: &mut World) -> &mut Vec<vk::MicromapBuildInfo> {
    find(world, |call| if let Call::BuildMicromaps { infos, .. } = call { Some(infos) } else { None })
}

pub(crate) fn build(world: &mut World) -> &mut vk::MicromapBuildInfo {
    &mut builds(world)[0]
}

pub(crate) fn host_build(world: &mut World) -> &mut vk::MicromapBuildInfo {
    &mut host_builds(world)[0]
}

/// The first usage of a build.
pub(crate) fn usage(info: &mut vk::MicromapBuildInfo) -> &mut vk::MicromapUsageExt {
    &mut info.usage_counts.as_mut().unwrap()[0]
}

pub(crate) fn attached(world: &mut World) -> &mut vk::TrianglesOpacityMicromapExt {
    find(world, |call| {
        let Call::CmdBuildAccelerationStructures { infos, .. } = call else { return None };
        let vk::GeometryData::Triangles(triangles) = &mut infos[0].geometries.as_mut()?[0].geometry else {
            return None;
        };
        match &mut triangles.next[0] {
            vk::ChainStructure::TrianglesOpacityMicromapExt(attached) => Some(attached),
            _ => None,
        }
    })
}

/// The first usage of the attached micromap.
pub(crate) fn attached_usage(world: &mut World) -> &mut vk::MicromapUsageExt {
    &mut attached(world).usage_counts.as_mut().unwrap()[0]
}

/// The program is one command, the first of that name.
pub(crate) fn alone(world: &mut World, command: &str) {
    world.calls = vec![world.remove(command)];
}

/// A change to the program, and every rule that it breaks, with its path; none if it almost breaks `rule`.
#[derive(Clone)]
pub(crate) struct BuildCase {
    pub(crate) rule: RuleId,
    change: fn(&mut World),
    broken: &'static [(RuleId, &'static str)],
}

impl BuildCase {
    pub(crate) fn breaks(&self) -> bool {
        !self.broken.is_empty()
    }
}

/// A change that breaks `broken[0]`.
pub(crate) fn breaks(change: fn(&mut World), broken: &'static [(RuleId, &'static str)]) -> BuildCase {
    BuildCase { rule: broken[0].0, change, broken }
}

/// A change that almost breaks `rule`.
pub(crate) fn keeps(rule: RuleId, change: fn(&mut World)) -> BuildCase {
    BuildCase { rule, change, broken: &[] }
}

pub(crate) fn run(cases: &[BuildCase]) {
    for (index, case) in cases.iter().enumerate() {
        let mut world = program();
        (case.change)(&mut world);
        let found = world.run();
        let found = found.iter().map(|(rule, path)| (*rule, path.as_str()));
        let found: Vec<_> = found.filter(|(rule, _)| !crate::is_general(*rule)).collect();
        assert_eq!(found, case.broken, "case {index}, of {:?}", case.rule);
    }
}

#[test]
fn the_program_is_valid() {
    let mut found = program().run();
    found.retain(|(rule, _)| !crate::is_general(*rule));
    assert_eq!(found, []);
}
