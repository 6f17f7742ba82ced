//! Host commands, deferred operations, and commands that only the extended vocabulary has.

use omm_layout::index::IndexType;
use omm_layout::{build_range, object::ObjectHeader};
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::special_index::{OpacityMicromapSpecialIndex, TriangleMap};
use omm_model::triangle::MicromapTriangle;

use super::*;
use crate::app::{MicromapBinding, MicromapInput, TriangleInput};

pub(super) fn host(scene: &mut Scene<'_>) {
    let triangle = MicromapTriangle {
        data_offset: 0,
        subdivision_level: SubdivisionLevel::new(1).unwrap(),
        format: OpacityMicromapFormat::FourState,
    };
    let input = MicromapInput { data: &[0b11_10_01_00], triangles: &[triangle], flags: Default::default() };
    let (info, _) = scene.app.host_micromap_info(&input).unwrap();
    let operation = vk::DeferredOperation(scene.handle());
    scene.app.call(&Call::CreateDeferredOperation { device: DEVICE, deferred_operation: operation }).unwrap();
    let build =
        |deferred_operation, info| Call::BuildMicromaps { device: DEVICE, deferred_operation, infos: vec![info] };
    let null = vk::DeferredOperation::NULL;
    let wrong = vk::MicromapBuildInfo { data: vk::DeviceAddress(4).into(), ..info.clone() };
    scene.stops(&build(null, wrong), "pInfos[0].data", "DeviceAddress");
    let wrong = vk::MicromapBuildInfo { ty: vk::MicromapType::DISPLACEMENT_MICROMAP, ..info.clone() };
    scene.stops(&build(null, wrong), "pInfos[0].type", "Unsupported");
    assert_eq!(
        scene.app.call(&build(operation, info.clone())).unwrap(),
        Output::Result(vk::Result::OPERATION_DEFERRED)
    );
    scene.stops(&build(operation, info), "deferredOperation", "OperationPending");
    let destroy = Call::DestroyDeferredOperation { device: DEVICE, operation };
    scene.stops(&destroy, "operation", "OperationPending");

    // The structures that the application makes by default lie in memory that the host cannot map.
    let acceleration_structures = vec![scene.bottom.handle];
    let query_type = vk::QueryType::ACCELERATION_STRUCTURE_SIZE;
    let write = |data_size| Call::WriteAccelerationStructuresProperties {
        device: DEVICE,
        acceleration_structures: acceleration_structures.clone(),
        query_type,
        data_size,
        stride: 8,
    };
    scene.stops(&write(8), "pAccelerationStructures[0]", "NotHostVisible");
    scene.stops(&write(7), "dataSize", "TooSmall");
    let (infos, build_range_infos) = (vec![micromap_build(scene)], vec![None]);
    let call = Call::BuildAccelerationStructures { device: DEVICE, deferred_operation: null, infos, build_range_infos };
    scene.stops(&call, "pInfos[0].type", "WrongCommand");
}

fn micromap_build(scene: &mut Scene<'_>) -> vk::BuildGeometryInfo {
    let (info, _) = micromap(&mut scene.app, 0, 2, (1, 0));
    vk::BuildGeometryInfo { dst_acceleration_structure: scene.micromap.handle, ..info }
}

pub(super) fn recorded(scene: &mut Scene<'_>) {
    let info = micromap_build(scene);
    let indirect = |info, address, counts| {
        move |command_buffer| Call::CmdBuildAccelerationStructuresIndirect {
            command_buffer,
            infos: vec![info],
            indirect_device_addresses: vec![address],
            indirect_strides: vec![0],
            max_primitive_counts: vec![counts],
        }
    };
    scene.submission_stops("pInfos[0].type", "WrongCommand", indirect(info, vk::DeviceAddress(0), None));
    let (info, ranges) = scene.build();
    let bytes = build_range::encode(&ranges.unwrap()[0]);
    let address = scene.app.upload_input(&bytes).unwrap().address;
    let at = "pIndirectDeviceAddresses[0][0].primitiveCount";
    scene.submission_stops(at, "TooManyPrimitives", indirect(info, address, Some(vec![0])));

    let command_pool = vk::CommandPool(scene.handle());
    let create_info = Default::default();
    scene.app.call(&Call::CreateCommandPool { device: DEVICE, create_info, command_pool }).unwrap();
    let secondary = vk::CommandBuffer(command_pool.0 + 1);
    let level = vk::CommandBufferLevel::SECONDARY;
    let command_buffer_count = 1;
    let allocate_info =
        vk::CommandBufferAllocateInfo { command_pool, level, command_buffer_count, ..Default::default() };
    let command_buffers = vec![secondary];
    scene.app.call(&Call::AllocateCommandBuffers { device: DEVICE, allocate_info, command_buffers }).unwrap();
    let submit = Call::QueueSubmit { queue: vk::Queue(1), command_buffers: vec![secondary] };
    scene.stops(&submit, "pCommandBuffers[0]", "CommandBufferLevel");

    let map = |triangle| match triangle {
        0 => TriangleMap::Triangle(0),
        _ => TriangleMap::SpecialIndex(OpacityMicromapSpecialIndex::FullyOpaque),
    };
    let maps = [map(0), map(1)];
    let binding =
        MicromapBinding { micromap: Some(&scene.micromap.clone()), maps: &maps, index_type: IndexType::Uint16 };
    let input =
        TriangleInput { positions: &[[0.0; 3]], indices: &[0; 6], flags: Default::default(), micromap: Some(binding) };
    let bottom = scene.app.build_triangles(&[input], Default::default()).unwrap();
    let instance = vk::Instance { acceleration_structure_reference: bottom.address.0, ..Default::default() };
    let top = scene.app.build_instances(&[instance], Default::default()).unwrap();
    let pipeline = vk::Pipeline(scene.handle());
    let flags = vk::PipelineCreateFlags2::OPACITY_MICROMAP_DISALLOW_MIXED_SPECIAL_INDEX;
    let create_infos = vec![omm_model::call::RayTracingPipelineCreateInfo { flags }];
    scene
        .app
        .call(&Call::CreateRayTracingPipelines { device: DEVICE, create_infos, pipelines: vec![pipeline] })
        .unwrap();
    let trace = |top_level| move |command_buffer| Call::CmdTraceRays { command_buffer, pipeline, top_level };
    scene.submission_stops("topLevel", "MixedSpecialIndices", trace(top.address));
    scene.submission_stops("topLevel", "WrongKind", trace(bottom.address));
    // Nothing is left of the structure but its address.
    scene.app.write(bottom.address, &vec![0; ObjectHeader::SIZE as usize]).unwrap();
    scene.submission_stops("topLevel", "Read", trace(top.address));
}
