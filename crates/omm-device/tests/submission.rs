//! Recording and submitting: nothing happens before, and all or nothing then.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::{bottom_level, bytes, device, floats, micromap, triangles_geometry, vertices};
use omm_device::app::{App, AppError};
use omm_device::{CommandBufferState, Reason, Submitted, Undefined};
use omm_layout::object::BlasObject;
use omm_model::call::{Call, Output};
use omm_model::memory::MemoryView;
use omm_model::vk;

const DEVICE: vk::Device = vk::Device(1);
const CLONE: vk::CopyAccelerationStructureMode = vk::CopyAccelerationStructureMode::CLONE;

fn undefined<T: std::fmt::Debug>(result: Result<T, AppError>) -> Undefined {
    match result.unwrap_err() {
        AppError::Undefined(undefined) => undefined,
        other => panic!("{other}"),
    }
}

/// A command buffer that is being recorded.
fn recording(app: &mut App<'_>, flags: vk::CommandBufferUsageFlags) -> vk::CommandBuffer {
    let command_pool = vk::CommandPool(app.device().unused_handle());
    app.call(&Call::CreateCommandPool { device: DEVICE, create_info: Default::default(), command_pool }).unwrap();
    let command_buffer = vk::CommandBuffer(command_pool.0 + 1);
    let allocate_info = vk::CommandBufferAllocateInfo { command_pool, command_buffer_count: 1, ..Default::default() };
    let command_buffers = vec![command_buffer];
    app.call(&Call::AllocateCommandBuffers { device: DEVICE, allocate_info, command_buffers }).unwrap();
    let begin_info = vk::CommandBufferBeginInfo { flags, ..Default::default() };
    app.call(&Call::BeginCommandBuffer { command_buffer, begin_info }).unwrap();
    command_buffer
}

fn submit(app: &mut App<'_>, command_buffers: &[vk::CommandBuffer]) -> Result<Output, AppError> {
    app.call(&Call::QueueSubmit { queue: vk::Queue(1), command_buffers: command_buffers.to_vec() })
}

fn copy(command_buffer: vk::CommandBuffer, src: vk::AccelerationStructure, dst: vk::AccelerationStructure) -> Call {
    let info = vk::CopyAccelerationStructureInfo { src, dst, mode: CLONE, ..Default::default() };
    Call::CmdCopyAccelerationStructure { command_buffer, info }
}

#[test]
fn a_submission_happens_whole_or_not_at_all() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let source = micromap(&mut app);
    let [first, second, empty] = [1, 2, 3].map(|_| app.create(source.ty, source.size).unwrap());
    let query_pool = vk::QueryPool(app.device().unused_handle());
    let query_type = vk::QueryType::ACCELERATION_STRUCTURE_SIZE;
    let create_info = vk::QueryPoolCreateInfo { query_type, query_count: 1, ..Default::default() };
    app.call(&Call::CreateQueryPool { device: DEVICE, create_info, query_pool }).unwrap();
    let (first_query, query_count) = (0, 1);
    app.call(&Call::ResetQueryPool { device: DEVICE, query_pool, first_query, query_count }).unwrap();

    let a = recording(&mut app, Default::default());
    app.call(&copy(a, source.handle, first.handle)).unwrap();
    let acceleration_structures = vec![source.handle];
    let write = Call::CmdWriteAccelerationStructuresProperties {
        command_buffer: a,
        acceleration_structures,
        query_type,
        query_pool,
        first_query,
    };
    app.call(&write).unwrap();
    app.call(&Call::EndCommandBuffer { command_buffer: a }).unwrap();
    let b = recording(&mut app, Default::default());
    app.call(&copy(b, first.handle, second.handle)).unwrap();
    app.call(&copy(b, empty.handle, second.handle)).unwrap();
    app.call(&Call::EndCommandBuffer { command_buffer: b }).unwrap();
    let all = |app: &App<'_>| {
        let bytes = [first, second].map(|found| app.device().read(found.address, found.size).unwrap().to_vec());
        bytes.concat()
    };
    let before = all(&app);
    assert_eq!(before, vec![0; before.len()]);

    let stopped = undefined(submit(&mut app, &[a, b]));
    assert_eq!(stopped.submitted, Some(Submitted { command_buffer: 1, command: 1 }));
    assert_eq!((stopped.command, stopped.at.as_str()), ("vkCmdCopyAccelerationStructureKHR", "pInfo->src"));
    assert_eq!(all(&app), before);
    let (data_size, stride, flags) = (8, 8, vk::QueryResultFlags::RESULT_64);
    let results =
        Call::GetQueryPoolResults { device: DEVICE, query_pool, first_query, query_count, data_size, stride, flags };
    assert_eq!(app.call(&results).unwrap(), Output::Result(vk::Result::NOT_READY));

    submit(&mut app, &[a]).unwrap();
    assert_eq!(bytes(&app, &first), bytes(&app, &source));
    assert_eq!(app.call(&results).unwrap(), Output::QueryResults(vec![source.size]));
}

#[test]
fn a_command_buffer_goes_through_its_states() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let found = |stopped: Undefined| match stopped.why {
        Reason::CommandBufferState { found, .. } => found,
        other => panic!("{other}"),
    };
    let once = recording(&mut app, vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
    assert_eq!(found(undefined(submit(&mut app, &[once]))), CommandBufferState::Recording);
    let begin = Call::BeginCommandBuffer { command_buffer: once, begin_info: Default::default() };
    assert_eq!(found(undefined(app.call(&begin))), CommandBufferState::Recording);
    app.call(&Call::EndCommandBuffer { command_buffer: once }).unwrap();
    let stopped = undefined(submit(&mut app, &[once, once]));
    assert_eq!((stopped.at.as_str(), stopped.submitted), ("pCommandBuffers[1]", None));
    assert_eq!(found(stopped), CommandBufferState::Invalid);
    submit(&mut app, &[once]).unwrap();
    assert_eq!(found(undefined(submit(&mut app, &[once]))), CommandBufferState::Invalid);
    app.call(&begin).unwrap();
    app.call(&Call::EndCommandBuffer { command_buffer: once }).unwrap();
    submit(&mut app, &[once, once]).unwrap();
}

#[test]
fn what_is_destroyed_takes_the_commands_with_it() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let source = micromap(&mut app);
    let target = app.create(source.ty, source.size).unwrap();
    let command_buffer = recording(&mut app, Default::default());
    let stopped = undefined(app.call(&copy(command_buffer, source.handle, vk::AccelerationStructure(999))));
    assert_eq!(stopped.why, Reason::UnknownHandle { object: "acceleration structure", handle: 999 });
    app.call(&copy(command_buffer, source.handle, target.handle)).unwrap();
    app.call(&Call::EndCommandBuffer { command_buffer }).unwrap();
    let address = target.address;
    app.destroy_structure(target).unwrap();
    let (found, required) = (CommandBufferState::Invalid, CommandBufferState::Executable);
    let why = Reason::CommandBufferState { command_buffer: command_buffer.0, found, required };
    assert_eq!(undefined(submit(&mut app, &[command_buffer])).why, why);
    assert!(app.device().read(address, 1).is_err());
}

#[test]
fn an_update_moves_vertices_and_nothing_else() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let data = vertices(&mut app, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let address = data.vertex_data.device_address().unwrap();
    let mut info = bottom_level(vec![triangles_geometry(data)]);
    info.flags = vk::BuildAccelerationStructureFlags::ALLOW_UPDATE;
    let range = vk::BuildRangeInfo { primitive_count: 1, ..Default::default() };
    let sizes = app.build_sizes(&info, Some(vec![1])).unwrap();
    let structure = app.build(info.clone(), Some(vec![range])).unwrap();
    assert_eq!((sizes.acceleration_structure_size, sizes.update_scratch_size), (structure.size, 256));
    let scratch = app.buffer(sizes.update_scratch_size, vk::BufferUsageFlags::STORAGE_BUFFER).unwrap();
    info.mode = vk::BuildAccelerationStructureMode::UPDATE;
    info.src_acceleration_structure = structure.handle;
    info.scratch_data = scratch.address.into();
    let other = app.create(structure.ty, structure.size).unwrap();
    let mut update = |x: f32, change: &dyn Fn(&mut vk::BuildGeometryInfo), dst: &omm_device::app::Structure| {
        let mut info = vk::BuildGeometryInfo { dst_acceleration_structure: dst.handle, ..info.clone() };
        change(&mut info);
        let vertices = app.upload_input(&floats(&[x, 0.0, 0.0])).unwrap();
        let bytes = app.download(&vertices).unwrap();
        app.write(address, &bytes).unwrap();
        app.submit(|command_buffer| {
            vec![Call::CmdBuildAccelerationStructures {
                command_buffer,
                infos: vec![info],
                build_range_infos: vec![Some(vec![range])],
            }]
        })?;
        let found = bytes_of(&app, dst);
        let object = BlasObject::read(&found).unwrap();
        Ok(object.geometry(0).unwrap().triangle(0).unwrap().vertices[0][0])
    };
    assert_eq!(update(5.0, &|_| (), &structure).unwrap(), 5.0);
    assert_eq!(update(6.0, &|_| (), &other).unwrap(), 6.0);
    let why = |result: Result<f32, AppError>| undefined(result).to_string();
    let flags = why(update(7.0, &|info| info.flags |= vk::BuildAccelerationStructureFlags::LOW_MEMORY, &other));
    assert!(flags.ends_with("the update's source was built with flags 0x1, the update needs 0x11"), "{flags}");
    let opaque = |info: &mut vk::BuildGeometryInfo| {
        info.geometries.as_mut().unwrap()[0].flags = vk::GeometryFlags::OPAQUE;
    };
    let flags = why(update(7.0, &opaque, &other));
    assert!(flags.ends_with("was built with geometry flags 0x0, the update needs 0x1"), "{flags}");
    let inactive = why(update(f32::NAN, &|_| (), &other));
    assert!(inactive.ends_with("was built with active primitives 1, the update needs 0"), "{inactive}");
}

fn bytes_of(app: &App<'_>, structure: &omm_device::app::Structure) -> Vec<u8> {
    bytes(app, structure)
}
