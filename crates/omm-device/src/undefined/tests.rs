use std::collections::BTreeSet;

use omm_model::call::{Call, Output};
use omm_model::profile::DeviceProfile;

use super::*;
use crate::Device;
use crate::app::{App, AppError, Structure};

#[test]
fn says_which_command_where_and_why() {
    let stop: Result<(), _> = Err(Reason::UnknownValue { found: -7 });
    let stop = stop.at("geometryType").at(format_args!("pGeometries[{}]", 2)).at("pInfos[0]").unwrap_err();
    let mut undefined = stop.of("vkCmdBuildAccelerationStructuresKHR");
    undefined.submitted = Some(Submitted { command_buffer: 1, command: 4 });
    assert_eq!(
        undefined.to_string(),
        "vkCmdBuildAccelerationStructuresKHR (command 4 of pCommandBuffers[1]): pInfos[0].pGeometries[2].geometryType: \
         the value -7 has no meaning here"
    );
    let undefined = Stop::from(Reason::Missing { what: "an address" }).within("pInfo->").of("vkCreateBuffer");
    assert_eq!(undefined.to_string(), "vkCreateBuffer: pInfo->: an address is missing");
}

mod host;

/// Every reason, so that a new one stops the build until it is reached below.
fn name(reason: &Reason) -> &'static str {
    match reason {
        Reason::UnknownHandle { .. } => "UnknownHandle",
        Reason::HandleTaken { .. } => "HandleTaken",
        Reason::UnknownValue { .. } => "UnknownValue",
        Reason::Missing { .. } => "Missing",
        Reason::CountMismatch { .. } => "CountMismatch",
        Reason::AlreadyBound { .. } => "AlreadyBound",
        Reason::NotBound { .. } => "NotBound",
        Reason::OutsideObject { .. } => "OutsideObject",
        Reason::Memory(_) => "Memory",
        Reason::AddressOverflow { .. } => "AddressOverflow",
        Reason::HostAddress { .. } => "HostAddress",
        Reason::DeviceAddress { .. } => "DeviceAddress",
        Reason::NotHostVisible { .. } => "NotHostVisible",
        Reason::WrongCommand { .. } => "WrongCommand",
        Reason::OperationPending { .. } => "OperationPending",
        Reason::CommandBufferLevel { .. } => "CommandBufferLevel",
        Reason::MixedSpecialIndices { .. } => "MixedSpecialIndices",
        Reason::TooManyPrimitives { .. } => "TooManyPrimitives",
        Reason::CommandBufferState { .. } => "CommandBufferState",
        Reason::OutsideQueryPool { .. } => "OutsideQueryPool",
        Reason::QueryType { .. } => "QueryType",
        Reason::QueryState { .. } => "QueryState",
        Reason::WaitsForever { .. } => "WaitsForever",
        Reason::TooSmall { .. } => "TooSmall",
        Reason::NotConstructed { .. } => "NotConstructed",
        Reason::WrongKind { .. } => "WrongKind",
        Reason::CreatedAs { .. } => "CreatedAs",
        Reason::GeometryType { .. } => "GeometryType",
        Reason::Overlap { .. } => "Overlap",
        Reason::MicromapTriangle(_) => "MicromapTriangle",
        Reason::SubdivisionLevel(_) => "SubdivisionLevel",
        Reason::LevelLimit { .. } => "LevelLimit",
        Reason::NoMicromapTriangle { .. } => "NoMicromapTriangle",
        Reason::NoMicromap { .. } => "NoMicromap",
        Reason::NotANumber { .. } => "NotANumber",
        Reason::UnknownReference { .. } => "UnknownReference",
        Reason::Read(_) => "Read",
        Reason::Incompatible { .. } => "Incompatible",
        Reason::Update { .. } => "Update",
        Reason::Unsupported { .. } => "Unsupported",
    }
}
const REASONS: usize = 40;

/// The handle of device and queue.
const DEVICE: vk::Device = vk::Device(1);

/// A device with a built bottom-level structure, a micromap of one triangle, and room for more.
struct Scene<'a> {
    app: App<'a>,
    bottom: Structure,
    micromap: Structure,
    seen: BTreeSet<&'static str>,
}

impl Scene<'_> {
    /// Requires a call to stop at `at` for the reason of that name, and what was built to stay as it is.
    fn stops(&mut self, call: &Call, at: &str, reason: &str) {
        let result = self.app.call(call).map(drop);
        self.stopped(result, at, reason);
    }

    fn stopped(&mut self, result: Result<(), AppError>, at: &str, reason: &str) {
        let Err(AppError::Undefined(undefined)) = result else { panic!("{reason}: {result:?}") };
        assert_eq!((undefined.at.as_str(), name(&undefined.why)), (at, reason), "{undefined}");
        assert_eq!(undefined.is_unsupported(), reason == "Unsupported");
        self.seen.extend([name(&undefined.why)]);
        let bottom = self.bottom;
        assert_eq!(self.app.query(&[&bottom], vk::QueryType::ACCELERATION_STRUCTURE_SIZE).unwrap().len(), 1);
    }

    /// Requires a submitted command to stop.
    fn submission_stops(&mut self, at: &str, reason: &str, command: impl FnOnce(vk::CommandBuffer) -> Call) {
        let result = self.app.submit(|command_buffer| vec![command(command_buffer)]);
        self.stopped(result, at, reason);
    }

    /// Requires a build to stop; `change` spoils it.
    fn build_stops(&mut self, at: &str, reason: &str, change: impl FnOnce(&mut vk::BuildGeometryInfo)) {
        let (mut info, ranges) = self.build();
        change(&mut info);
        self.submission_stops(at, reason, |command_buffer| Call::CmdBuildAccelerationStructures {
            command_buffer,
            infos: vec![info],
            build_range_infos: vec![ranges],
        });
    }

    /// A build of one triangle that would succeed.
    fn build(&mut self) -> (vk::BuildGeometryInfo, Option<Vec<vk::BuildRangeInfo>>) {
        let vertices = self.app.upload_input(&[0; 36]).unwrap();
        let scratch = self.app.buffer(256, vk::BufferUsageFlags::STORAGE_BUFFER).unwrap();
        let dst = self.app.create(vk::AccelerationStructureType::BOTTOM_LEVEL, 1024).unwrap();
        let triangles = vk::GeometryTrianglesData {
            vertex_format: vk::Format::R32G32B32_SFLOAT,
            vertex_data: vertices.address.into(),
            vertex_stride: 12,
            index_type: vk::IndexType::NONE,
            ..Default::default()
        };
        let geometry = vk::Geometry { geometry: vk::GeometryData::Triangles(triangles), ..Default::default() };
        let info = vk::BuildGeometryInfo {
            ty: vk::AccelerationStructureType::BOTTOM_LEVEL,
            dst_acceleration_structure: dst.handle,
            scratch_data: scratch.address.into(),
            geometries: Some(vec![geometry]),
            ..Default::default()
        };
        (info, Some(vec![vk::BuildRangeInfo { primitive_count: 1, ..Default::default() }]))
    }

    fn handle(&self) -> u64 {
        self.app.device().unused_handle()
    }
}

/// The triangles of a build.
fn triangles(info: &mut vk::BuildGeometryInfo) -> &mut vk::GeometryTrianglesData {
    match &mut info.geometries.as_mut().unwrap()[0].geometry {
        vk::GeometryData::Triangles(triangles) => triangles,
        other => panic!("{other:?}"),
    }
}

#[test]
fn every_reason_is_reached() {
    // With memory that the host cannot map, which comes first.
    let (minimum, reference) = (DeviceProfile::minimum(), DeviceProfile::reference());
    let (memory_types, memory_heaps) = (reference.memory_types, reference.memory_heaps);
    let profile = DeviceProfile { memory_types, memory_heaps, ..minimum };
    let mut device = Device::with_heap_size(profile, 1 << 24);
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let bottom = app.build_triangles(&[], Default::default()).unwrap();
    let (info, _) = micromap(&mut app, 3, 2, (1, 3));
    let micromap = app.build(info, None).unwrap();
    let mut scene = Scene { app, bottom, micromap, seen: BTreeSet::new() };
    objects(&mut scene);
    queries(&mut scene);
    builds(&mut scene);
    micromaps(&mut scene);
    copies(&mut scene);
    host::host(&mut scene);
    host::recorded(&mut scene);
    assert_eq!(scene.seen.len(), REASONS, "{:?}", scene.seen);
}

fn objects(scene: &mut Scene<'_>) {
    scene.stops(&Call::DestroyBuffer { device: DEVICE, buffer: vk::Buffer(999) }, "buffer", "UnknownHandle");
    let create = |buffer| Call::CreateBuffer { device: DEVICE, create_info: Default::default(), buffer };
    scene.stops(&create(vk::Buffer::NULL), "pBuffer", "HandleTaken");
    let bound = scene.bottom.buffer;
    scene.stops(&create(bound.buffer), "pBuffer", "HandleTaken");
    let buffer = vk::Buffer(scene.handle());
    scene.app.call(&create(buffer)).unwrap();
    let info = vk::BufferDeviceAddressInfo { buffer, ..Default::default() };
    scene.stops(&Call::GetBufferDeviceAddress { device: DEVICE, info }, "pInfo->buffer", "NotBound");
    let bind =
        |buffer, memory_offset| Call::BindBufferMemory { device: DEVICE, buffer, memory: bound.memory, memory_offset };
    scene.stops(&bind(buffer, u64::MAX), "memoryOffset", "OutsideObject");
    scene.stops(&bind(bound.buffer, 0), "buffer", "AlreadyBound");
    let acceleration_structure = vk::AccelerationStructure(scene.handle());
    let create_info =
        vk::AccelerationStructureCreateInfo { ty: vk::AccelerationStructureType(17), ..Default::default() };
    let call = Call::CreateAccelerationStructure { device: DEVICE, create_info, acceleration_structure };
    scene.stops(&call, "pCreateInfo->type", "UnknownValue");
    let call =
        Call::CreateAccelerationStructure2 { device: DEVICE, create_info: Default::default(), acceleration_structure };
    scene.stops(&call, "pCreateInfo->addressRange", "Memory");
    let command_pool = vk::CommandPool(scene.handle());
    let create_info = Default::default();
    scene.app.call(&Call::CreateCommandPool { device: DEVICE, create_info, command_pool }).unwrap();
    let allocate = |count| Call::AllocateCommandBuffers {
        device: DEVICE,
        allocate_info: vk::CommandBufferAllocateInfo {
            command_pool,
            command_buffer_count: count,
            ..Default::default()
        },
        command_buffers: vec![vk::CommandBuffer(command_pool.0 + 1)],
    };
    scene.stops(&allocate(2), "pCommandBuffers", "CountMismatch");
    scene.app.call(&allocate(1)).unwrap();
    let command_buffer = vk::CommandBuffer(command_pool.0 + 1);
    scene.stops(&Call::EndCommandBuffer { command_buffer }, "commandBuffer", "CommandBufferState");
}

fn queries(scene: &mut Scene<'_>) {
    let query_pool = vk::QueryPool(scene.handle());
    let query_type = vk::QueryType::ACCELERATION_STRUCTURE_SIZE;
    let create_info = vk::QueryPoolCreateInfo { query_type, query_count: 2, ..Default::default() };
    scene.app.call(&Call::CreateQueryPool { device: DEVICE, create_info, query_pool }).unwrap();
    let reset = |query_count| Call::ResetQueryPool { device: DEVICE, query_pool, first_query: 0, query_count };
    scene.stops(&reset(3), "firstQuery", "OutsideQueryPool");
    let flags = vk::QueryResultFlags::WAIT;
    let (first_query, query_count, data_size, stride) = (0, 1, 4, 4);
    let results =
        Call::GetQueryPoolResults { device: DEVICE, query_pool, first_query, query_count, data_size, stride, flags };
    scene.stops(&results, "queryPool", "QueryState");
    assert_eq!(scene.app.call(&reset(2)).unwrap(), Output::None);
    scene.stops(&results, "queryPool", "WaitsForever");
    let acceleration_structures = vec![scene.bottom.handle];
    scene.submission_stops("queryPool", "QueryType", |command_buffer| Call::CmdWriteAccelerationStructuresProperties {
        command_buffer,
        acceleration_structures,
        query_type: vk::QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE,
        query_pool,
        first_query,
    });
}

fn builds(scene: &mut Scene<'_>) {
    let (info, ranges) = scene.build();
    let build = |infos, build_range_infos| {
        |command_buffer| Call::CmdBuildAccelerationStructures { command_buffer, infos, build_range_infos }
    };
    scene.submission_stops("ppBuildRangeInfos[0]", "Missing", build(vec![info.clone()], vec![None]));
    let twice = build(vec![info.clone(), info], vec![ranges.clone(), ranges]);
    scene.submission_stops("pInfos[1].scratchData", "Overlap", twice);
    scene.build_stops("ppBuildRangeInfos[0]", "CountMismatch", |info| info.geometries = None);
    let at = "pInfos[0].pGeometries[0].geometryType";
    scene.build_stops(at, "GeometryType", |info| info.ty = vk::AccelerationStructureType::TOP_LEVEL);
    scene.build_stops("pInfos[0].scratchData", "HostAddress", |info| info.scratch_data = vk::HostAddress(4).into());
    let at = "pInfos[0].pGeometries[0].geometry.triangles.vertexData[1]";
    scene.build_stops(at, "AddressOverflow", |info| triangles(info).vertex_stride = u64::MAX);
    let nan = scene.app.upload_input(&[[0; 4], f32::NAN.to_le_bytes()].concat().repeat(6)).unwrap();
    let at = "pInfos[0].pGeometries[0].geometry.triangles.vertexData[0]";
    scene.build_stops(at, "NotANumber", |info| triangles(info).vertex_data = nan.address.into());

    let top = scene.app.create(vk::AccelerationStructureType::TOP_LEVEL, 1024).unwrap();
    let at = "pInfos[0].dstAccelerationStructure";
    scene.build_stops(at, "CreatedAs", |info| info.dst_acceleration_structure = top.handle);
    let small = scene.app.create(vk::AccelerationStructureType::GENERIC, 64).unwrap();
    scene.build_stops(at, "TooSmall", |info| info.dst_acceleration_structure = small.handle);
    let bottom = scene.bottom.handle;
    scene.build_stops("pInfos[0].srcAccelerationStructure", "Update", |info| {
        info.mode = vk::BuildAccelerationStructureMode::UPDATE;
        info.src_acceleration_structure = bottom;
    });
    let instance = vk::Instance { acceleration_structure_reference: 7, ..Default::default() };
    let result = scene.app.build_instances(&[instance], Default::default()).map(drop);
    let at = "pInfos[0].pGeometries[0].geometry.instances.data[0].accelerationStructureReference";
    scene.stopped(result, at, "UnknownReference");
}

/// The input of a build of one micromap triangle with that level and format, and a usage count with that count and level.
fn micromap(
    app: &mut App<'_>,
    subdivision_level: u16,
    format: u16,
    (count, level): (u32, u32),
) -> (vk::BuildGeometryInfo, Option<Vec<vk::BuildRangeInfo>>) {
    let triangle = vk::MicromapTriangle { data_offset: 0, subdivision_level, format };
    let array = app.upload_input(&omm_layout::triangle::encode(&triangle)).unwrap();
    let usage = vk::MicromapUsage { count, subdivision_level: level, format: vk::OpacityMicromapFormat::FOUR_STATE };
    let data = vk::GeometryMicromapData {
        usage_counts: Some(vec![usage]),
        data: app.upload_input(&[0; 64]).unwrap().address,
        triangle_array: array.address,
        triangle_array_stride: 8,
        ..Default::default()
    };
    let geometry_type = vk::GeometryType::MICROMAP;
    let geometry = vk::Geometry { next: vec![data.into()], geometry_type, ..Default::default() };
    let ty = vk::AccelerationStructureType::OPACITY_MICROMAP;
    (vk::BuildGeometryInfo { ty, geometries: Some(vec![geometry]), ..Default::default() }, None)
}

fn micromaps(scene: &mut Scene<'_>) {
    let data = "pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>";
    let mut build = |at: String, reason, level, format, usage| {
        let (info, ranges) = micromap(&mut scene.app, level, format, usage);
        let result = scene.app.build(info, ranges).map(drop);
        scene.stopped(result, &at, reason);
    };
    build(format!("pInfos[0].{data}.triangleArray[0]"), "MicromapTriangle", 0, 3, (1, 0));
    build(format!("pInfos[0].{data}.triangleArray[0].subdivisionLevel"), "LevelLimit", 4, 1, (1, 4));
    build(format!("pBuildInfo->{data}.pUsageCounts[0].subdivisionLevel"), "SubdivisionLevel", 0, 1, (1, 13));

    let attached = |index_type, micromap| vk::TrianglesOpacityMicromap { index_type, micromap, ..Default::default() };
    let at = "pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapKHR>";
    let (micromap, bottom) = (scene.micromap.handle, scene.bottom.handle);
    scene.build_stops(&format!("pInfos[0].{at}.indexBuffer[0]"), "NoMicromapTriangle", |info| {
        let attached = vk::TrianglesOpacityMicromap { base_triangle: 1, ..attached(vk::IndexType::NONE, micromap) };
        triangles(info).next = vec![attached.into()];
    });
    scene.build_stops(&format!("pInfos[0].{at}.indexBuffer[0]"), "NoMicromap", |info| {
        triangles(info).next = vec![attached(vk::IndexType::NONE, vk::AccelerationStructure::NULL).into()];
    });
    scene.build_stops(&format!("pInfos[0].{at}.micromap"), "WrongKind", |info| {
        triangles(info).next = vec![attached(vk::IndexType::NONE, bottom).into()];
    });
    scene.build_stops(&format!("pInfos[0].{at}.micromap"), "UnknownHandle", |info| {
        triangles(info).next = vec![attached(vk::IndexType::NONE, vk::AccelerationStructure(9999)).into()];
    });
}

fn copies(scene: &mut Scene<'_>) {
    let empty = scene.app.create(vk::AccelerationStructureType::GENERIC, 1024).unwrap();
    let info = vk::CopyAccelerationStructureInfo { src: empty.handle, dst: scene.bottom.handle, ..Default::default() };
    let copy = |command_buffer| Call::CmdCopyAccelerationStructure { command_buffer, info };
    scene.submission_stops("pInfo->src", "NotConstructed", copy);

    let blob = scene.app.serialize(&scene.micromap.clone()).unwrap();
    for (byte, reason) in [(0, "Incompatible"), (31, "Incompatible"), (32, "Read"), (56, "Read")] {
        let mut spoiled = blob.clone();
        spoiled[byte] ^= 1;
        let src = scene.app.upload(&[spoiled, vec![0; 64]].concat(), Default::default()).unwrap().address.into();
        let mode = vk::CopyAccelerationStructureMode::DESERIALIZE;
        let info = vk::CopyMemoryToAccelerationStructureInfo { src, dst: empty.handle, mode, ..Default::default() };
        let copy = |command_buffer| Call::CmdCopyMemoryToAccelerationStructure { command_buffer, info };
        scene.submission_stops("pInfo->src", reason, copy);
    }
}
