//! Secondary command buffers, indirect builds, sparse buffers, and what the device says about itself.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::{bottom_level, bytes, device, micromap, triangles_geometry, vertices};
use omm_device::app::{App, Structure};
use omm_device::{CommandBufferState, Device, Reason};
use omm_layout::build_range;
use omm_model::call::{Call, Output, PhysicalDeviceFeatures2, PhysicalDeviceProperties2};
use omm_model::memory::MemoryView;
use omm_model::profile::DeviceProfile;
use omm_model::vk;

const DEVICE: vk::Device = vk::Device(1);

/// A pool with a primary and a secondary command buffer.
fn pool(device: &mut Device) -> (vk::CommandPool, vk::CommandBuffer, vk::CommandBuffer) {
    let command_pool = vk::CommandPool(device.unused_handle());
    let create_info = vk::CommandPoolCreateInfo::default();
    device.execute(&Call::CreateCommandPool { device: DEVICE, create_info, command_pool }).unwrap();
    let mut new = |level| {
        let buffer = vk::CommandBuffer(device.unused_handle());
        let allocate_info =
            vk::CommandBufferAllocateInfo { command_pool, level, command_buffer_count: 1, ..Default::default() };
        let command_buffers = vec![buffer];
        device.execute(&Call::AllocateCommandBuffers { device: DEVICE, allocate_info, command_buffers }).unwrap();
        buffer
    };
    let primary = new(vk::CommandBufferLevel::PRIMARY);
    (command_pool, primary, new(vk::CommandBufferLevel::SECONDARY))
}

/// Records commands.
fn record(device: &mut Device, command_buffer: vk::CommandBuffer, flags: vk::CommandBufferUsageFlags, call: Call) {
    let begin_info = vk::CommandBufferBeginInfo { flags, ..Default::default() };
    device.execute(&Call::BeginCommandBuffer { command_buffer, begin_info }).unwrap();
    device.execute(&call).unwrap();
    device.execute(&Call::EndCommandBuffer { command_buffer }).unwrap();
}

fn submit(device: &mut Device, buffer: vk::CommandBuffer) -> Result<Output, Reason> {
    let call = Call::QueueSubmit { queue: vk::Queue(1), command_buffers: vec![buffer] };
    device.execute(&call).map_err(|undefined| undefined.why)
}

fn invalid(buffer: vk::CommandBuffer) -> Reason {
    let (found, required) = (CommandBufferState::Invalid, CommandBufferState::Executable);
    Reason::CommandBufferState { command_buffer: buffer.0, found, required }
}

/// A built micromap, a copy of it that holds nothing yet, and a command that fills it.
fn copy(device: &mut Device) -> (Structure, Structure, impl Fn(vk::CommandBuffer) -> Call + use<>) {
    let mut observer = ();
    let mut app = App::new(device, &mut observer);
    let source = micromap(&mut app);
    let target = app.create(source.ty, source.size).unwrap();
    let info = vk::CopyAccelerationStructureInfo { src: source.handle, dst: target.handle, ..Default::default() };
    (source, target, move |command_buffer| Call::CmdCopyAccelerationStructure { command_buffer, info: info.clone() })
}

#[test]
fn a_secondary_command_buffer_does_its_work_in_a_primary_one() {
    let mut device = device();
    let (source, target, copy) = copy(&mut device);
    let (_, primary, secondary) = pool(&mut device);
    let none = vk::CommandBufferUsageFlags::empty();
    let execute = || Call::CmdExecuteCommands { command_buffer: primary, command_buffers: vec![secondary, secondary] };
    record(&mut device, secondary, none, copy(secondary));
    record(&mut device, primary, none, execute());
    assert_eq!(submit(&mut device, primary), Ok(Output::None));
    let read =
        |device: &Device, structure: &Structure| device.read(structure.address, structure.size).unwrap().to_vec();
    assert_eq!(read(&device, &target), read(&device, &source));

    // What changes it makes those invalid that would execute it.
    device.execute(&Call::ResetCommandBuffer { command_buffer: secondary, flags: Default::default() }).unwrap();
    assert_eq!(submit(&mut device, primary), Err(invalid(primary)));
    let once = vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT;
    record(&mut device, secondary, once, copy(secondary));
    record(&mut device, primary, none, execute());
    assert_eq!(submit(&mut device, primary), Err(invalid(secondary)));
    let execute = || Call::CmdExecuteCommands { command_buffer: primary, command_buffers: vec![secondary] };
    record(&mut device, primary, none, execute());
    assert_eq!(submit(&mut device, primary), Ok(Output::None));
    assert_eq!(submit(&mut device, primary), Err(invalid(primary)));
    record(&mut device, secondary, none, copy(secondary));
    record(&mut device, primary, none, execute());
    device
        .execute(&Call::DestroyAccelerationStructure { device: DEVICE, acceleration_structure: target.handle })
        .unwrap();
    assert_eq!(submit(&mut device, primary), Err(invalid(primary)));
}

#[test]
fn command_buffers_are_freed_all_or_none() {
    let mut device = device();
    let (command_pool, primary, secondary) = pool(&mut device);
    let (other, ..) = pool(&mut device);
    let free =
        |command_pool, command_buffers| Call::FreeCommandBuffers { device: DEVICE, command_pool, command_buffers };
    for (pool, buffers, at) in [
        (other, vec![primary], "pCommandBuffers[0]"),
        (command_pool, vec![primary, primary], "pCommandBuffers[1]"),
        (command_pool, vec![vk::CommandBuffer::NULL, vk::CommandBuffer(999)], "pCommandBuffers[1]"),
    ] {
        assert_eq!(device.execute(&free(pool, buffers)).unwrap_err().at, at);
    }
    device.execute(&free(command_pool, vec![primary, vk::CommandBuffer::NULL, secondary])).unwrap();
    let reset = Call::ResetCommandBuffer { command_buffer: primary, flags: Default::default() };
    assert_eq!(device.execute(&reset).unwrap_err().at, "commandBuffer");
}

#[test]
fn an_indirect_build_finds_its_ranges_in_memory() {
    let (mut device, mut observer) = (device(), ());
    let mut app = App::new(&mut device, &mut observer);
    let triangles = vertices(&mut app, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
    let geometries = vec![triangles_geometry(triangles.clone()), triangles_geometry(triangles)];
    let mut info = bottom_level(geometries);
    let range = |first_vertex| vk::BuildRangeInfo { primitive_count: 1, first_vertex, ..Default::default() };
    let direct = app.build(info.clone(), Some(vec![range(0), range(1)])).unwrap();
    let uploaded = [range(0), range(7), range(1)].map(|range| build_range::encode(&range)).concat();
    let address = app.upload_input(&uploaded).unwrap().address;
    let indirect = app.create(direct.ty, direct.size).unwrap();
    info.dst_acceleration_structure = indirect.handle;
    info.scratch_data = app.buffer(256, vk::BufferUsageFlags::STORAGE_BUFFER).unwrap().address.into();
    app.submit(|command_buffer| {
        vec![Call::CmdBuildAccelerationStructuresIndirect {
            command_buffer,
            infos: vec![info],
            indirect_device_addresses: vec![address],
            indirect_strides: vec![32],
            max_primitive_counts: vec![Some(vec![1, 1])],
        }]
    })
    .unwrap();
    assert_eq!(bytes(&app, &indirect), bytes(&app, &direct));
}

#[test]
fn a_sparse_buffer_is_bound_on_a_queue() {
    let mut device = device();
    let (buffer, memory) = (vk::Buffer(1), vk::DeviceMemory(2));
    let create_info =
        vk::BufferCreateInfo { size: 256, flags: vk::BufferCreateFlags::SPARSE_BINDING, ..Default::default() };
    device.execute(&Call::CreateBuffer { device: DEVICE, create_info, buffer }).unwrap();
    let info = vk::BufferDeviceAddressInfo { buffer, ..Default::default() };
    let address = device.execute(&Call::GetBufferDeviceAddress { device: DEVICE, info }).unwrap();
    let Output::DeviceAddress(address) = address else { panic!("{address:?}") };
    let allocate_info = vk::MemoryAllocateInfo { allocation_size: 512, ..Default::default() };
    device.execute(&Call::AllocateMemory { device: DEVICE, allocate_info, memory }).unwrap();
    assert!(device.write(address, &[1]).is_err());
    let bind = |resource_offset, size, memory_offset| {
        let bind = vk::SparseMemoryBind { resource_offset, size, memory, memory_offset, ..Default::default() };
        let buffer_binds = vec![vk::SparseBufferMemoryBindInfo { buffer, binds: vec![bind] }];
        Call::QueueBindSparse { queue: vk::Queue(1), buffer_binds }
    };
    device.execute(&bind(0, 128, 64)).unwrap();
    device.execute(&bind(128, 128, 192)).unwrap();
    device.write(address, &[7; 256]).unwrap();
    for (call, at) in [
        (bind(0, 257, 0), "pBindInfo[0].pBufferBinds[0].pBinds[0].resourceOffset"),
        (bind(0, 256, 257), "pBindInfo[0].pBufferBinds[0].pBinds[0].memoryOffset"),
        (bind(0, 128, 0), "pBindInfo[0].pBufferBinds[0].pBinds[0]"),
    ] {
        assert_eq!(device.execute(&call).unwrap_err().at, at);
        assert_eq!(device.read(address, 256), Ok(&[7; 256][..]));
    }
    let flags = vk::BufferCreateFlags::SPARSE_BINDING | vk::BufferCreateFlags::SPARSE_RESIDENCY;
    let create_info = vk::BufferCreateInfo { size: 256, flags, ..Default::default() };
    let create = Call::CreateBuffer { device: DEVICE, create_info, buffer: vk::Buffer(9) };
    assert!(device.execute(&create).unwrap_err().is_unsupported());
}

#[test]
fn the_device_says_what_its_profile_says() {
    let mut device = Device::new(DeviceProfile::minimum());
    let physical_device = vk::PhysicalDevice(1);
    let next = vec![vk::OpacityMicromapFeatures::default().into(), vk::OpacityMicromapFeaturesExt::default().into()];
    let features = PhysicalDeviceFeatures2 { next };
    let found = device.execute(&Call::GetPhysicalDeviceFeatures2 { physical_device, features }).unwrap();
    let micromap = vk::OpacityMicromapFeatures { micromap: vk::Bool32::TRUE, ..Default::default() };
    assert_eq!(found, Output::Structures(vec![micromap.into(), vk::OpacityMicromapFeaturesExt::default().into()]));
    let properties = PhysicalDeviceProperties2 { next: vec![vk::OpacityMicromapProperties::default().into()] };
    let found = device.execute(&Call::GetPhysicalDeviceProperties2 { physical_device, properties }).unwrap();
    let limits = vk::OpacityMicromapProperties {
        max_opacity2_state_subdivision_level: 3,
        max_opacity4_state_subdivision_level: 3,
        max_opacity_lossy4_state_subdivision_level: 3,
        max_micromap_triangles: (1 << 29) - 1,
        ..Default::default()
    };
    assert_eq!(found, Output::Structures(vec![limits.into()]));
}
