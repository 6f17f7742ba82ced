//! What commands do when they execute: contents, their origin, and the order of things.

use omm_model::call::{Call, Output};
use omm_model::vk;
use omm_validate::state::Attachment;

use crate::{BUFFER, COMMAND_BUFFER, DEVICE, Program, QUEUE, micromap_build};

const SOURCE: vk::Micromap = vk::Micromap(0x20);
const TARGET: vk::Micromap = vk::Micromap(0x21);
const OPERATION: vk::DeferredOperation = vk::DeferredOperation(0x40);
const SERIALIZED: vk::DeviceOrHostAddress = vk::DeviceOrHostAddress::DeviceAddress(vk::DeviceAddress(0x5000));

fn program() -> Program {
    let mut program = Program::new();
    program.buffer(BUFFER, 0x1000, vk::BufferCreateFlags::empty()).micromap(SOURCE, 0).micromap(TARGET, 0x100);
    program
}

fn triangles(program: &Program, handle: vk::Micromap) -> Option<u64> {
    program.state().micromap(handle)?.built().map(omm_validate::state::MicromapBuilt::triangles)
}

fn build(handle: vk::Micromap, count: u32) -> Call {
    Call::CmdBuildMicromaps { command_buffer: COMMAND_BUFFER, infos: vec![micromap_build(handle, count)] }
}

fn copy() -> Call {
    let info = vk::CopyMicromapInfo { src: SOURCE, dst: TARGET, ..Default::default() };
    Call::CmdCopyMicromap { command_buffer: COMMAND_BUFFER, info }
}

#[test]
fn recorded_commands_act_in_order_at_each_submission() {
    let mut program = program();
    program.begin(COMMAND_BUFFER).calls(copy()).calls(build(SOURCE, 2));
    assert!(!program.state().micromap(SOURCE).unwrap().is_constructed());
    program.submit();
    // The copy came first and found nothing.
    assert_eq!((triangles(&program, SOURCE), triangles(&program, TARGET)), (Some(2), None));
    assert!(!program.state().micromap(TARGET).unwrap().is_constructed());
    program.calls(Call::QueueSubmit { queue: QUEUE, command_buffers: vec![COMMAND_BUFFER] });
    assert_eq!(triangles(&program, TARGET), Some(2));
    program.calls(Call::ResetCommandBuffer {
        command_buffer: COMMAND_BUFFER,
        flags: vk::CommandBufferResetFlags::empty(),
    });
    program.calls(Call::DestroyMicromap { device: DEVICE, micromap: SOURCE }).micromap(SOURCE, 0);
    program.calls(Call::QueueSubmit { queue: QUEUE, command_buffers: vec![COMMAND_BUFFER] });
    assert_eq!(triangles(&program, SOURCE), None, "nothing is recorded any more");
}

#[test]
fn secondary_command_buffers_act_where_they_are_executed() {
    let mut program = program();
    let secondary = vk::CommandBuffer(0x77);
    let Call::CmdBuildMicromaps { infos, .. } = build(SOURCE, 5) else { panic!() };
    program.begin(secondary).calls(Call::CmdBuildMicromaps { command_buffer: secondary, infos });
    // One that claims to execute itself is passed over.
    let command_buffers = vec![secondary];
    program.calls(Call::CmdExecuteCommands { command_buffer: secondary, command_buffers: command_buffers.clone() });
    program.begin(COMMAND_BUFFER).calls(Call::CmdExecuteCommands { command_buffer: COMMAND_BUFFER, command_buffers });
    program.calls(copy()).submit();
    assert_eq!((triangles(&program, SOURCE), triangles(&program, TARGET)), (Some(5), Some(5)));
}

#[test]
fn a_deferred_command_acts_when_it_is_complete() {
    let mut program = program();
    let create = Call::CreateDeferredOperation { device: DEVICE, deferred_operation: OPERATION };
    let infos = vec![micromap_build(SOURCE, 3)];
    let host = Call::BuildMicromaps { device: DEVICE, deferred_operation: OPERATION, infos };
    let join = Call::DeferredOperationJoin { device: DEVICE, operation: OPERATION };
    let ask = Call::GetDeferredOperationResult { device: DEVICE, operation: OPERATION };
    let result = Output::Result;
    program.calls(create).returns(host.clone(), result(vk::Result::OPERATION_DEFERRED));
    for (call, running) in
        [(&join, vk::Result::THREAD_IDLE), (&join, vk::Result::THREAD_DONE), (&ask, vk::Result::NOT_READY)]
    {
        program.returns(call.clone(), result(running));
        assert!(program.state().is_pending(OPERATION));
        assert_eq!(triangles(&program, SOURCE), None);
    }
    program.calls(join);
    assert!(!program.state().is_pending(OPERATION));
    assert_eq!(triangles(&program, SOURCE), Some(3));
    // A command that failed did nothing; one that was not deferred is done.
    program.calls(Call::DestroyMicromap { device: DEVICE, micromap: SOURCE }).micromap(SOURCE, 0);
    program.returns(host.clone(), result(vk::Result::OPERATION_DEFERRED));
    program.returns(ask, result(vk::Result::ERROR_OUT_OF_HOST_MEMORY));
    assert_eq!((program.state().is_pending(OPERATION), triangles(&program, SOURCE)), (false, None));
    program.returns(host, result(vk::Result::OPERATION_NOT_DEFERRED));
    assert_eq!((program.state().is_pending(OPERATION), triangles(&program, SOURCE)), (false, Some(3)));
}

#[test]
fn deserialized_data_remembers_whose_it_was_while_it_lies_where_it_was_written() {
    let mut program = program();
    let save = vk::CopyMicromapToMemoryInfo { src: SOURCE, dst: SERIALIZED, ..Default::default() };
    let load = |src| vk::CopyMemoryToMicromapInfo { src, dst: TARGET, ..Default::default() };
    let load_call = |src| Call::CmdCopyMemoryToMicromap { command_buffer: COMMAND_BUFFER, info: load(src) };
    program.begin(COMMAND_BUFFER).calls(build(SOURCE, 4));
    program.calls(Call::CmdCopyMicromapToMemory { command_buffer: COMMAND_BUFFER, info: save });
    program.calls(load_call(SERIALIZED)).submit();
    let contents = program.state().micromap(TARGET).unwrap().contents.clone().unwrap();
    assert_eq!(contents.deserialized.map(|it| it.origin), Some(Some(SOURCE.0)));
    assert_eq!(contents.built.unwrap().triangles(), 4);
    // The program moved the data, or the same number is an address of the host.
    program.begin(COMMAND_BUFFER).calls(load_call(vk::HostAddress(0x5000).into())).submit();
    let contents = program.state().micromap(TARGET).unwrap().contents.clone().unwrap();
    assert_eq!((contents.deserialized.map(|it| it.origin), contents.built), (Some(None), None));
}

#[test]
fn an_update_keeps_the_original_build_and_changes_what_is_attached() {
    let (structure, updated) = (vk::AccelerationStructure(0x50), vk::AccelerationStructure(0x51));
    let (old, new) = (vk::AccelerationStructure(0x60), vk::AccelerationStructure(0x61));
    let mut program = Program::new();
    program.structure(structure).structure(updated);
    let info = |mode, src_acceleration_structure, dst_acceleration_structure, micromap| {
        let attached = vk::TrianglesOpacityMicromap { micromap, ..Default::default() };
        let triangles = vk::GeometryTrianglesData { next: vec![attached.into()], ..Default::default() };
        let geometry = vk::Geometry {
            geometry_type: vk::GeometryType::TRIANGLES,
            geometry: vk::GeometryData::Triangles(triangles),
            ..Default::default()
        };
        vk::BuildGeometryInfo {
            ty: vk::AccelerationStructureType::BOTTOM_LEVEL,
            flags: vk::BuildAccelerationStructureFlags::ALLOW_UPDATE,
            mode,
            src_acceleration_structure,
            dst_acceleration_structure,
            geometries: Some(vec![geometry]),
            ..Default::default()
        }
    };
    let call = |info| Call::CmdBuildAccelerationStructures {
        command_buffer: COMMAND_BUFFER,
        infos: vec![info],
        build_range_infos: vec![Some(vec![vk::BuildRangeInfo { primitive_count: 6, ..Default::default() }])],
    };
    let (build, update) = (vk::BuildAccelerationStructureMode::BUILD, vk::BuildAccelerationStructureMode::UPDATE);
    program.begin(COMMAND_BUFFER).calls(call(info(build, vk::AccelerationStructure::NULL, structure, old)));
    program.calls(call(info(update, structure, updated, new)));
    let recorded = program.state().built(COMMAND_BUFFER, updated).unwrap();
    assert_eq!(recorded.geometries[0].attachment, Attachment::Khr(old));
    program.submit();
    let contents = program.state().acceleration_structure(updated).unwrap().contents.clone().unwrap();
    let original = contents.built.unwrap();
    assert_eq!(original.geometries[0].attachment, Attachment::Khr(old));
    assert_eq!(original.primitive_counts, [6]);
    assert_eq!((&*contents.attachments, contents.updated), (&[Attachment::Khr(new)][..], true));
    let contents = program.state().acceleration_structure(structure).unwrap().contents.clone().unwrap();
    assert_eq!((&*contents.attachments, contents.updated), (&[Attachment::Khr(old)][..], false));
}
