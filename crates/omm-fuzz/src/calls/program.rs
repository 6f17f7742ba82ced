//! Programs without a mistake, each of which shows another part of the API: what sequences of calls begin as.

use std::sync::OnceLock;

use omm_device::Device;
use omm_device::app::{
    App, AppError, MicromapBinding, MicromapBindingExt, MicromapExt, MicromapInput, Structure, TriangleInput,
};
use omm_layout::index::IndexType;
use omm_model::call::{Call, DeviceCreateInfo, DeviceQueueCreateInfo, RenderingInfo};
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::profile::DeviceProfile;
use omm_model::special_index::{OpacityMicromapSpecialIndex, TriangleMap};
use omm_model::triangle::MicromapTriangle;
use omm_model::vk;

use super::recorder::{Recorder, Step};

/// Bytes that a device of these programs has.
pub(crate) const HEAP: u64 = 1 << 20;

const DEVICE: vk::Device = vk::Device(1);
const QUEUE: vk::Queue = vk::Queue(1);
const NOT_DEFERRED: vk::DeferredOperation = vk::DeferredOperation::NULL;

type Program = fn(&mut App<'_>) -> Result<(), AppError>;

const PROGRAMS: [Program; 6] = [khr, updates, copies, ext, host, recording];

/// A program, written down.
pub(crate) struct Recorded {
    /// Makes an object of every kind, so that a validator that sees this has seen them all and knows a handle that names nothing.
    pub(crate) prologue: Vec<Step>,
    pub(crate) steps: Vec<Step>,
}

/// The programs.
pub(crate) fn programs() -> &'static [Recorded] {
    static RECORDED: OnceLock<Vec<Recorded>> = OnceLock::new();
    RECORDED.get_or_init(|| PROGRAMS.iter().map(|program| record(*program)).collect())
}

fn record(program: Program) -> Recorded {
    let mut device = Device::with_heap_size(DeviceProfile::reference(), HEAP);
    let mut recorder = Recorder::default();
    let mut app = App::new(&mut device, &mut recorder);
    let failed = |error| panic!("a program without a mistake: {error}");
    prologue(&mut app).unwrap_or_else(failed);
    let prologue = std::mem::take(&mut recorder.steps);
    program(&mut App::new(&mut device, &mut recorder)).unwrap_or_else(failed);
    Recorded { prologue, steps: recorder.steps }
}

/// An object of every kind.
fn prologue(app: &mut App<'_>) -> Result<(), AppError> {
    let queue_create_infos = vec![DeviceQueueCreateInfo { queue_family_index: 0, queue_count: 1 }];
    let create_info = DeviceCreateInfo { queue_create_infos, ..Default::default() };
    app.call(&Call::CreateDevice { physical_device: vk::PhysicalDevice(1), create_info, device: DEVICE })?;
    app.call(&Call::GetDeviceQueue { device: DEVICE, queue_family_index: 0, queue_index: 0, queue: QUEUE })?;
    let structure = app.create(vk::AccelerationStructureType::GENERIC, 64)?;
    app.destroy_structure(structure)?;
    let micromap = app.create_micromap_ext(64)?;
    app.destroy_micromap_ext(micromap)?;
    let query_pool = vk::QueryPool(app.device().unused_handle());
    let query_type = vk::QueryType::ACCELERATION_STRUCTURE_SIZE;
    let create_info = vk::QueryPoolCreateInfo { query_type, query_count: 2, ..Default::default() };
    app.call(&Call::CreateQueryPool { device: DEVICE, create_info, query_pool })?;
    app.call(&Call::DestroyQueryPool { device: DEVICE, query_pool })?;
    let deferred_operation = vk::DeferredOperation(app.device().unused_handle());
    app.call(&Call::CreateDeferredOperation { device: DEVICE, deferred_operation })?;
    app.call(&Call::DestroyDeferredOperation { device: DEVICE, operation: deferred_operation })?;
    let pipelines = vec![vk::Pipeline(app.device().unused_handle())];
    app.call(&Call::CreateRayTracingPipelines { device: DEVICE, create_infos: vec![Default::default()], pipelines })?;
    let shaders = vec![vk::Shader(app.device().unused_handle())];
    app.call(&Call::CreateShaders { device: DEVICE, create_infos: vec![Default::default()], shaders })?;
    app.submit(|_| Vec::new())
}

fn triangle(data_offset: u32, level: u32, format: OpacityMicromapFormat) -> MicromapTriangle {
    let subdivision_level = SubdivisionLevel::new(level).unwrap_or(SubdivisionLevel::ZERO);
    MicromapTriangle { data_offset, subdivision_level, format }
}

/// Four triangles: levels 1, 2, 0 and 1, the last with the data of the first.
fn with_input<R>(with: impl FnOnce(&MicromapInput<'_>) -> R) -> R {
    let (two, four) = (OpacityMicromapFormat::TwoState, OpacityMicromapFormat::FourState);
    let triangles = [triangle(0, 1, two), triangle(1, 2, four), triangle(5, 0, four), triangle(0, 1, two)];
    let data = [0b0110, 0x1b, 0xe4, 0x00, 0xff, 0b01];
    let flags = vk::BuildAccelerationStructureFlags::ALLOW_COMPACTION;
    with(&MicromapInput { data: &data, triangles: &triangles, flags })
}

const POSITIONS: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [f32::NAN; 3]];
const INDICES: [u32; 9] = [0, 1, 2, 2, 1, 0, 0, 1, 3];
const PLAIN: TriangleInput<'_> =
    TriangleInput { positions: &POSITIONS, indices: &INDICES, flags: vk::GeometryFlags::OPAQUE, micromap: None };

fn maps() -> [TriangleMap; 3] {
    let special = TriangleMap::SpecialIndex(OpacityMicromapSpecialIndex::FullyUnknownOpaque);
    [TriangleMap::Triangle(1), special, TriangleMap::Triangle(0)]
}

/// Triangles with a micromap, and some without.
fn card(app: &mut App<'_>, micromap: &Structure, flags: u32) -> Result<Structure, AppError> {
    let binding = MicromapBinding { micromap: Some(micromap), maps: &maps(), index_type: IndexType::Uint8 };
    let mapped = TriangleInput { micromap: Some(binding), ..PLAIN };
    app.build_triangles(&[mapped, PLAIN], vk::BuildAccelerationStructureFlags::from_bits_retain(flags))
}

fn instance(of: u64) -> vk::Instance {
    vk::Instance { acceleration_structure_reference: of, ..Default::default() }
}

/// Micromap, bottom level, top level, rays.
fn khr(app: &mut App<'_>) -> Result<(), AppError> {
    let micromap = with_input(|input| app.build_micromap(input))?;
    let bottom = card(app, &micromap, 0)?;
    let top = app.build_instances(&[instance(bottom.address.0), instance(0)], Default::default())?;
    let pipeline = vk::Pipeline(app.device().unused_handle());
    let create_infos = vec![Default::default()];
    app.call(&Call::CreateRayTracingPipelines { device: DEVICE, create_infos, pipelines: vec![pipeline] })?;
    app.submit(|command_buffer| vec![Call::CmdTraceRays { command_buffer, pipeline, top_level: top.address }])?;
    app.destroy_structure(top)?;
    app.call(&Call::DestroyPipeline { device: DEVICE, pipeline })?;
    Ok(())
}

/// Builds `info` in update mode, in place.
fn update(
    app: &mut App<'_>,
    mut info: vk::BuildGeometryInfo,
    ranges: Vec<vk::BuildRangeInfo>,
) -> Result<Structure, AppError> {
    let structure = app.build(info.clone(), Some(ranges.clone()))?;
    let scratch = app.buffer(256, vk::BufferUsageFlags::STORAGE_BUFFER)?;
    info.mode = vk::BuildAccelerationStructureMode::UPDATE;
    info.src_acceleration_structure = structure.handle;
    info.dst_acceleration_structure = structure.handle;
    info.scratch_data = scratch.address.into();
    app.submit(|command_buffer| {
        let build_range_infos = vec![Some(ranges)];
        vec![Call::CmdBuildAccelerationStructures { command_buffer, infos: vec![info], build_range_infos }]
    })?;
    Ok(structure)
}

/// Updates of bottom levels, with micromaps of either extension and boxes.
fn updates(app: &mut App<'_>) -> Result<(), AppError> {
    let micromap = with_input(|input| app.build_micromap(input))?;
    let flags = vk::BuildAccelerationStructureFlags::ALLOW_UPDATE;
    let binding = MicromapBinding { micromap: Some(&micromap), maps: &maps(), index_type: IndexType::Uint16 };
    let mapped = TriangleInput { micromap: Some(binding), ..PLAIN };
    let (info, ranges) = app.triangles_info(&[(mapped, None), (PLAIN, None)], flags, &mut Vec::new())?;
    update(app, info, ranges)?;
    let ext = with_input(|input| app.build_micromap_ext(input))?;
    let binding =
        MicromapBindingExt { micromap: Some(&ext), maps: &maps(), index_type: IndexType::Uint32, usages: &[] };
    let flags = flags | vk::BuildAccelerationStructureFlags::ALLOW_OPACITY_MICROMAP_UPDATE;
    let (info, ranges) = app.triangles_info(&[(PLAIN, Some(binding))], flags, &mut Vec::new())?;
    update(app, info, ranges)?;
    let boxes: Vec<u8> = [0.0_f32, 0.0, 0.0, 1.0, 1.0, 1.0].iter().flat_map(|number| number.to_le_bytes()).collect();
    let data = app.upload_input(&boxes)?.address.into();
    let boxes = vk::GeometryAabbsData { data, stride: 24, ..Default::default() };
    let geometry = vk::Geometry {
        geometry_type: vk::GeometryType::AABBS,
        geometry: vk::GeometryData::Aabbs(boxes),
        ..Default::default()
    };
    let (ty, geometries) = (vk::AccelerationStructureType::BOTTOM_LEVEL, Some(vec![geometry]));
    let flags = vk::BuildAccelerationStructureFlags::ALLOW_UPDATE;
    let info = vk::BuildGeometryInfo { ty, flags, geometries, ..Default::default() };
    update(app, info, vec![vk::BuildRangeInfo { primitive_count: 1, ..Default::default() }])?;
    Ok(())
}

/// Copies of every mode.
fn copies(app: &mut App<'_>) -> Result<(), AppError> {
    let compaction = vk::BuildAccelerationStructureFlags::ALLOW_COMPACTION.bits();
    let micromap = with_input(|input| app.build_micromap(input))?;
    let bottom = card(app, &micromap, compaction)?;
    for structure in [micromap, bottom] {
        let compacted = app.copy(&structure, vk::CopyAccelerationStructureMode::COMPACT)?;
        app.copy(&structure, vk::CopyAccelerationStructureMode::CLONE)?;
        app.destroy_structure(compacted)?;
    }
    let top = app.build_instances(&[instance(bottom.address.0)], Default::default())?;
    for structure in [micromap, top] {
        let blob = app.serialize(&structure)?;
        app.deserialize(&blob, structure.ty)?;
    }
    Ok(())
}

/// Micromap objects of the EXT extension on the device.
fn ext(app: &mut App<'_>) -> Result<(), AppError> {
    let micromap = with_input(|input| app.build_micromap_ext(input))?;
    let maps = maps();
    let binding =
        MicromapBindingExt { micromap: Some(&micromap), maps: &maps, index_type: IndexType::Uint32, usages: &[] };
    app.build_triangles_ext(&[(PLAIN, Some(binding)), (PLAIN, None)], Default::default())?;
    app.micromap_property(&micromap, vk::QueryType::MICROMAP_COMPACTED_SIZE)?;
    let compacted = app.copy_micromap_ext(&micromap, vk::CopyMicromapMode::COMPACT)?;
    let blob = app.serialize_micromap_ext(&compacted)?;
    let again = app.deserialize_micromap_ext(&blob)?;
    app.destroy_micromap_ext(compacted)?;
    app.copy_micromap_ext(&again, vk::CopyMicromapMode::CLONE)?;
    Ok(())
}

/// Host commands, deferred ones among them.
fn host(app: &mut App<'_>) -> Result<(), AppError> {
    let (info, first) = with_input(|input| app.host_micromap_info(input))?;
    let (other_info, second) = with_input(|input| app.host_micromap_info(input))?;
    let deferred_operation = vk::DeferredOperation(app.device().unused_handle());
    let (device, operation) = (DEVICE, deferred_operation);
    app.call(&Call::CreateDeferredOperation { device, deferred_operation })?;
    app.call(&Call::BuildMicromaps { device, deferred_operation, infos: vec![info, other_info] })?;
    app.call(&Call::GetDeferredOperationMaxConcurrency { device, operation })?;
    app.call(&Call::GetDeferredOperationResult { device, operation })?;
    app.call(&Call::DeferredOperationJoin { device, operation })?;
    host_copies(app, [&first, &second], deferred_operation)?;
    let vertices: Vec<u8> = POSITIONS[..3].as_flattened().iter().flat_map(|number| number.to_le_bytes()).collect();
    let triangles = vk::GeometryTrianglesData {
        vertex_format: vk::Format::R32G32B32_SFLOAT,
        vertex_data: app.upload_host(&vertices)?.into(),
        vertex_stride: 12,
        max_vertex: 2,
        index_type: vk::IndexType::NONE,
        index_data: vk::HostAddress(0).into(),
        transform_data: vk::HostAddress(0).into(),
        ..Default::default()
    };
    let geometry = vk::Geometry {
        geometry_type: vk::GeometryType::TRIANGLES,
        geometry: vk::GeometryData::Triangles(triangles),
        ..Default::default()
    };
    let (ty, geometries) = (vk::AccelerationStructureType::BOTTOM_LEVEL, Some(vec![geometry]));
    let mut info = vk::BuildGeometryInfo { ty, geometries, ..Default::default() };
    let sizes = app.build_sizes(&info, Some(vec![1]))?;
    let size = sizes.acceleration_structure_size;
    let buffer = app.host_buffer(size, vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE)?.buffer;
    let acceleration_structure = vk::AccelerationStructure(app.device().unused_handle());
    let create_info = vk::AccelerationStructureCreateInfo { buffer, size, ty, ..Default::default() };
    app.call(&Call::CreateAccelerationStructure { device, create_info, acceleration_structure })?;
    info.dst_acceleration_structure = acceleration_structure;
    let size = usize::try_from(sizes.build_scratch_size).unwrap_or_default();
    info.scratch_data = app.upload_host(&vec![0; size])?.into();
    let build_range_infos = vec![Some(vec![vk::BuildRangeInfo { primitive_count: 1, ..Default::default() }])];
    app.call(&Call::BuildAccelerationStructures { device, deferred_operation, infos: vec![info], build_range_infos })?;
    app.call(&Call::DeferredOperationJoin { device, operation })?;
    let query_type = vk::QueryType::ACCELERATION_STRUCTURE_SERIALIZATION_SIZE;
    let (acceleration_structures, data_size, stride) = (vec![acceleration_structure], 8, 8);
    app.call(&Call::WriteAccelerationStructuresProperties {
        device,
        acceleration_structures,
        query_type,
        data_size,
        stride,
    })?;
    app.call(&Call::DestroyDeferredOperation { device, operation })?;
    Ok(())
}

fn host_copies(
    app: &mut App<'_>,
    [first, second]: [&MicromapExt; 2],
    deferred_operation: vk::DeferredOperation,
) -> Result<(), AppError> {
    let (device, operation) = (DEVICE, deferred_operation);
    let mode = vk::CopyMicromapMode::COMPACT;
    let info = vk::CopyMicromapInfo { src: first.handle, dst: second.handle, mode, ..Default::default() };
    app.call(&Call::CopyMicromap { device, deferred_operation, info })?;
    app.call(&Call::DeferredOperationJoin { device, operation })?;
    let size = app.micromap_property(second, vk::QueryType::MICROMAP_SERIALIZATION_SIZE)?;
    let blob = app.upload_host(&vec![0; usize::try_from(size).unwrap_or_default()])?;
    let mode = vk::CopyMicromapMode::SERIALIZE;
    let info = vk::CopyMicromapToMemoryInfo { src: second.handle, dst: blob.into(), mode, ..Default::default() };
    app.call(&Call::CopyMicromapToMemory { device, deferred_operation, info })?;
    app.call(&Call::DeferredOperationJoin { device, operation })?;
    let mode = vk::CopyMicromapMode::DESERIALIZE;
    let info = vk::CopyMemoryToMicromapInfo { src: blob.into(), dst: first.handle, mode, ..Default::default() };
    app.call(&Call::CopyMemoryToMicromap { device, deferred_operation: NOT_DEFERRED, info })?;
    Ok(())
}

/// Secondary command buffers, rendering, indirect builds, several submissions of one command buffer, rays by query.
fn recording(app: &mut App<'_>) -> Result<(), AppError> {
    let device = DEVICE;
    let (mut info, ranges) = app.triangles_info(&[(PLAIN, None)], Default::default(), &mut Vec::new())?;
    let bottom = app.build(info.clone(), Some(ranges))?;
    let range: Vec<u8> = [3_u32, 0, 0, 0].iter().flat_map(|number| number.to_le_bytes()).collect();
    let indirect = app.upload(&range, vk::BufferUsageFlags::INDIRECT_BUFFER)?;
    info.dst_acceleration_structure = bottom.handle;
    info.scratch_data = app.buffer(1 << 10, vk::BufferUsageFlags::STORAGE_BUFFER)?.address.into();
    app.submit(|command_buffer| {
        vec![Call::CmdBuildAccelerationStructuresIndirect {
            command_buffer,
            infos: vec![info],
            indirect_device_addresses: vec![indirect.address],
            indirect_strides: vec![16],
            max_primitive_counts: vec![Some(vec![3])],
        }]
    })?;
    let top = app.build_instances(&[instance(bottom.address.0)], Default::default())?;
    let twin = app.create(top.ty, top.size)?;
    let first = app.device().unused_handle();
    let (command_pool, shader) = (vk::CommandPool(first), vk::Shader(first + 3));
    let [secondary, primary] = [1, 2].map(|after| vk::CommandBuffer(first + after));
    let allocate = |level, buffer| {
        let allocate_info =
            vk::CommandBufferAllocateInfo { command_pool, level, command_buffer_count: 1, ..Default::default() };
        Call::AllocateCommandBuffers { device, allocate_info, command_buffers: vec![buffer] }
    };
    let begin = |command_buffer| Call::BeginCommandBuffer { command_buffer, begin_info: Default::default() };
    let clone = vk::CopyAccelerationStructureInfo { src: top.handle, dst: twin.handle, ..Default::default() };
    for call in [
        Call::CreateCommandPool { device, create_info: Default::default(), command_pool },
        allocate(vk::CommandBufferLevel::SECONDARY, secondary),
        allocate(vk::CommandBufferLevel::PRIMARY, primary),
        Call::CreateShaders { device, create_infos: vec![Default::default()], shaders: vec![shader] },
        begin(secondary),
        Call::CmdCopyAccelerationStructure { command_buffer: secondary, info: clone },
        Call::CmdDispatch { command_buffer: secondary, shader, top_level: top.address },
        Call::EndCommandBuffer { command_buffer: secondary },
        begin(primary),
        Call::CmdExecuteCommands { command_buffer: primary, command_buffers: vec![secondary] },
        Call::CmdBeginRendering { command_buffer: primary, rendering_info: RenderingInfo::default() },
        Call::CmdEndRendering { command_buffer: primary },
        Call::EndCommandBuffer { command_buffer: primary },
        Call::QueueSubmit { queue: QUEUE, command_buffers: vec![primary] },
        Call::QueueSubmit { queue: QUEUE, command_buffers: vec![primary] },
        Call::ResetCommandBuffer { command_buffer: primary, flags: Default::default() },
        Call::FreeCommandBuffers { device, command_pool, command_buffers: vec![secondary] },
        Call::DestroyShader { device, shader },
    ] {
        app.call(&call)?;
    }
    Ok(())
}
