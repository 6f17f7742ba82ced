//! Devices, objects and command buffers.

use omm_model::call::{Call, DeviceCreateInfo, DeviceQueueCreateInfo, RenderingInfo};
use omm_model::profile::Features;
use omm_model::vk;
use omm_validate::state::{Liveness, RecordingState};

use crate::{BUFFER, COMMAND_BUFFER, DEVICE, Program, QUEUE};

fn create_device(device: vk::Device, physical_devices: &[u64], queue_count: u32) -> Call {
    let group = vk::DeviceGroupDeviceCreateInfo {
        physical_devices: physical_devices.iter().copied().map(vk::PhysicalDevice).collect(),
        ..Default::default()
    };
    let create_info = DeviceCreateInfo {
        next: vec![group.into()],
        queue_create_infos: vec![DeviceQueueCreateInfo { queue_family_index: 0, queue_count }],
        enabled_features: Some(Features { micromap: true, ..Features::default() }),
    };
    Call::CreateDevice { physical_device: vk::PhysicalDevice(9), create_info, device }
}

#[test]
fn a_device_has_what_it_was_created_with_and_else_what_the_profile_has() {
    let mut program = Program::new();
    assert_eq!(*program.state().features(DEVICE), Features::ALL);
    assert_eq!(program.state().physical_devices(DEVICE), 1);
    program.calls(create_device(DEVICE, &[8, 9], 0));
    let device = *program.state().device(DEVICE).unwrap();
    assert_eq!((device.physical_devices, device.has_queue), (2, false));
    assert!(device.features.micromap && !device.features.micromap_ext);
    program.calls(Call::GetDeviceQueue { device: DEVICE, queue_family_index: 2, queue_index: 0, queue: QUEUE });
    let submit = Call::QueueSubmit { queue: QUEUE, command_buffers: vec![] };
    assert_eq!(program.state().device_of(&submit), Some(DEVICE));
    assert!(!program.state().features_for(&submit).micromap_ext);
    assert_eq!(program.state().family_of_queue(QUEUE), Some(2));
}

#[test]
fn a_handle_is_judged_once_one_of_its_kind_was_created() {
    let mut program = Program::new();
    let liveness = |program: &Program, handle| program.state().liveness((vk::Buffer::OBJECT_TYPE, handle));
    assert_eq!(liveness(&program, 3), Liveness::Unknown);
    program.buffer(BUFFER, 16, vk::BufferCreateFlags::empty());
    assert_eq!((liveness(&program, 3), liveness(&program, 4)), (Liveness::Live, Liveness::NeverCreated));
    assert_eq!(program.state().parent((vk::Buffer::OBJECT_TYPE, 3)), Some(DEVICE));
    program.calls(Call::DestroyBuffer { device: DEVICE, buffer: BUFFER });
    assert_eq!(liveness(&program, 3), Liveness::Destroyed);
    assert_eq!(program.state().parent((vk::Buffer::OBJECT_TYPE, 3)), None);
    // The driver gives the handle out again.
    program.buffer(BUFFER, 16, vk::BufferCreateFlags::empty());
    assert_eq!(liveness(&program, 3), Liveness::Live);
}

#[test]
fn a_command_buffer_knows_its_queues_and_dies_with_its_pool() {
    let mut program = Program::new();
    let command_pool = vk::CommandPool(5);
    let create_info = vk::CommandPoolCreateInfo { queue_family_index: 2, ..Default::default() };
    program.calls(Call::CreateCommandPool { device: DEVICE, create_info, command_pool });
    let allocate_info = vk::CommandBufferAllocateInfo { command_pool, ..Default::default() };
    let command_buffers = vec![COMMAND_BUFFER];
    program.calls(Call::AllocateCommandBuffers { device: DEVICE, allocate_info, command_buffers });
    assert_eq!(program.state().queue_flags(COMMAND_BUFFER), Some(vk::QueueFlags::TRANSFER));
    program.calls(Call::DestroyCommandPool { device: DEVICE, command_pool });
    assert!(program.state().command_buffer(COMMAND_BUFFER).is_none());
    let object = (vk::CommandBuffer::OBJECT_TYPE, COMMAND_BUFFER.0);
    assert_eq!(program.state().liveness(object), Liveness::Destroyed);
}

#[test]
fn render_pass_instances_are_open_or_suspended_where_they_are() {
    let mut program = Program::new();
    let scope = |program: &Program| {
        let state = program.state().command_buffer(COMMAND_BUFFER).unwrap();
        (state.in_render_pass, state.is_suspended)
    };
    let begin =
        |flags| Call::CmdBeginRendering { command_buffer: COMMAND_BUFFER, rendering_info: RenderingInfo { flags } };
    let end = || Call::CmdEndRendering { command_buffer: COMMAND_BUFFER };
    program.calls(begin(vk::RenderingFlags::empty()));
    // Seen for the first time in the middle of its recording.
    assert_eq!(program.state().command_buffer(COMMAND_BUFFER).unwrap().recording, RecordingState::Recording);
    assert_eq!(scope(&program), (true, false));
    program.calls(end());
    assert_eq!(scope(&program), (false, false));
    program.calls(begin(vk::RenderingFlags::SUSPENDING)).calls(end());
    assert_eq!(scope(&program), (false, true));
    program.calls(begin(vk::RenderingFlags::RESUMING)).calls(end());
    assert_eq!(scope(&program), (false, false));
}

#[test]
fn a_secondary_command_buffer_may_begin_inside_a_render_pass() {
    let mut program = Program::new();
    let level = vk::CommandBufferLevel::SECONDARY;
    let allocate_info = vk::CommandBufferAllocateInfo { level, ..Default::default() };
    let command_buffers = vec![COMMAND_BUFFER];
    program.calls(Call::AllocateCommandBuffers { device: DEVICE, allocate_info, command_buffers });
    let flags = vk::CommandBufferUsageFlags::RENDER_PASS_CONTINUE;
    let begin_info = vk::CommandBufferBeginInfo { flags, ..Default::default() };
    program.calls(Call::BeginCommandBuffer { command_buffer: COMMAND_BUFFER, begin_info });
    assert!(program.state().command_buffer(COMMAND_BUFFER).unwrap().in_render_pass);
    program.begin(COMMAND_BUFFER);
    assert!(!program.state().command_buffer(COMMAND_BUFFER).unwrap().in_render_pass);
}
