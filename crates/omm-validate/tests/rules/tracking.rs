//! What calls leave behind.

use omm_model::call::{Call, Output};
use omm_model::vk;
use omm_validate::RuleId;
use omm_validate::state::RecordingState;

use crate::scene::*;

/// What a command recorded next finds in a structure: the micromap triangles that it was built with.
fn triangles(scene: &Scene, handle: vk::AccelerationStructure) -> Option<u64> {
    scene.validator.state().built(COMMAND_BUFFER, handle)?.micromap_triangles()
}

#[test]
fn objects_come_and_go() {
    let mut scene = Scene::micromap();
    let buffer = scene.validator.state().buffer(BUFFER).unwrap();
    assert_eq!(buffer.size, BUFFER_SIZE);
    assert_eq!(buffer.memory, Some((MEMORY, 0)));
    assert_eq!(buffer.address, Some(vk::DeviceAddress(BASE)));
    assert_eq!(scene.validator.state().memory_size(MEMORY), Some(BUFFER_SIZE));
    assert_eq!(scene.validator.state().bytes_from(vk::DeviceAddress(BASE + 1)), Some(BUFFER_SIZE - 1));
    assert_eq!(scene.validator.state().bytes_from(vk::DeviceAddress(BASE - 1)), None);

    scene.track(&Call::DestroyBuffer { device: DEVICE, buffer: BUFFER });
    scene.track(&Call::FreeMemory { device: DEVICE, memory: MEMORY });
    scene.track(&Call::DestroyAccelerationStructure { device: DEVICE, acceleration_structure: TARGET });
    let state = scene.validator.state();
    assert!(state.buffer(BUFFER).is_none() && state.acceleration_structure(TARGET).is_none());
    assert_eq!(state.memory_size(MEMORY), None);
    assert_eq!(state.bytes_from(vk::DeviceAddress(BASE)), None);
}

#[test]
fn a_structure_in_a_buffer_has_the_addresses_of_its_range() {
    let mut scene = Scene::micromap();
    let create_info = vk::AccelerationStructureCreateInfo {
        buffer: BUFFER,
        offset: 0x700,
        size: 0x80,
        ty: vk::AccelerationStructureType::TOP_LEVEL,
        ..Default::default()
    };
    let acceleration_structure = vk::AccelerationStructure(0x30);
    scene.track(&Call::CreateAccelerationStructure { device: DEVICE, create_info, acceleration_structure });
    let range = scene.validator.state().address_range(acceleration_structure).unwrap();
    assert_eq!(range, vk::DeviceAddressRange { address: vk::DeviceAddress(BASE + 0x700), size: 0x80 });
    let info = vk::AccelerationStructureDeviceAddressInfo { acceleration_structure, ..Default::default() };
    let call = Call::GetAccelerationStructureDeviceAddress { device: DEVICE, info };
    scene.validator.track(&call, &Output::DeviceAddress(vk::DeviceAddress(0xabc)));
    let object = scene.validator.state().acceleration_structure(acceleration_structure).unwrap();
    assert_eq!(object.address, Some(vk::DeviceAddress(0xabc)));
}

#[test]
fn a_command_that_failed_did_nothing() {
    let mut scene = Scene::micromap();
    let create_info = vk::BufferCreateInfo { size: 1, ..Default::default() };
    let call = Call::CreateBuffer { device: DEVICE, create_info, buffer: vk::Buffer(0x40) };
    scene.validator.track(&call, &Output::Result(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY));
    assert!(scene.validator.state().buffer(vk::Buffer(0x40)).is_none());
}

#[test]
fn builds_take_effect_when_submitted_and_before_for_what_follows_them() {
    let mut scene = Scene::micromap();
    assert_eq!(triangles(&scene, TARGET), None);
    let report = scene.validator.check_and_track(&scene.call.clone(), &Output::None, &scene.clone());
    assert!(report.is_empty());
    assert_eq!(triangles(&scene, TARGET), Some(3));
    assert!(scene.validator.state().acceleration_structure(TARGET).unwrap().contents.is_none());
    // Recorded anew: the build is forgotten.
    scene.begin();
    assert_eq!(triangles(&scene, TARGET), None);
    scene.track(&scene.call.clone());
    scene.submit();
    scene.begin();
    assert_eq!(triangles(&scene, TARGET), Some(3));
    let built = scene.validator.state().acceleration_structure(TARGET).unwrap().built().cloned().unwrap();
    assert_eq!(built.ty, vk::AccelerationStructureType::OPACITY_MICROMAP);
    assert_eq!(
        built.usage_counts,
        micromap_build(TARGET)
            .geometries_iter()
            .next()
            .unwrap()
            .micromap_data()
            .unwrap()
            .usages()
            .copied()
            .collect::<Vec<_>>()
    );
}

#[test]
fn copies_carry_how_the_source_was_built() {
    let (copy, second) = (vk::AccelerationStructure(0x33), vk::AccelerationStructure(0x34));
    let record = |scene: &mut Scene, src, dst| {
        let info = vk::CopyAccelerationStructureInfo { src, dst, ..Default::default() };
        scene.track(&Call::CmdCopyAccelerationStructure { command_buffer: COMMAND_BUFFER, info });
    };
    let mut scene = Scene::micromap();
    for handle in [copy, second] {
        scene.track_structure(handle, vk::AccelerationStructureType::OPACITY_MICROMAP);
    }
    // From what was submitted, and on from there.
    record(&mut scene, MICROMAP, copy);
    record(&mut scene, copy, second);
    assert_eq!(triangles(&scene, second), Some(3));
    // The copy was made before the source changed.
    let info = vk::CopyMemoryToAccelerationStructureInfo { dst: copy, ..Default::default() };
    scene.track(&Call::CmdCopyMemoryToAccelerationStructure { command_buffer: COMMAND_BUFFER, info });
    assert_eq!((triangles(&scene, copy), triangles(&scene, second)), (None, Some(3)));
    // Onto itself.
    record(&mut scene, second, second);
    assert_eq!(triangles(&scene, second), Some(3));
    scene.submit();
    scene.begin();
    assert_eq!((triangles(&scene, copy), triangles(&scene, second)), (None, Some(3)));
}

#[test]
fn rules_see_a_micromap_built_in_the_same_command_buffer() {
    let mut scene = Scene::bottom_level_without_indices();
    let mut small = micromap_build(MICROMAP);
    small.geometries.as_mut().unwrap()[0].next.clear();
    assert!(scene.check().is_empty());
    scene.track(&build(vec![small], vec![None]));
    let report = scene.check();
    assert_eq!(report.iter().map(|it| it.rule).collect::<Vec<_>>(), [RuleId::TriangleIndex11576]);
}

#[test]
fn command_buffers_live_as_recorded() {
    let mut scene = Scene::micromap();
    let state = |scene: &Scene| scene.validator.state().command_buffer(COMMAND_BUFFER).map(|it| it.recording);
    assert_eq!(state(&scene), Some(RecordingState::Recording));
    scene.submit();
    assert_eq!(state(&scene), Some(RecordingState::Executable));
    let begin_info =
        vk::CommandBufferBeginInfo { flags: vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT, ..Default::default() };
    scene.track(&Call::BeginCommandBuffer { command_buffer: COMMAND_BUFFER, begin_info });
    scene.submit();
    assert_eq!(state(&scene), Some(RecordingState::Invalid));

    let command_pool = vk::CommandPool(0x50);
    let allocate_info = vk::CommandBufferAllocateInfo { command_pool, ..Default::default() };
    let command_buffers = vec![COMMAND_BUFFER];
    scene.track(&Call::AllocateCommandBuffers { device: DEVICE, allocate_info, command_buffers });
    assert_eq!(state(&scene), Some(RecordingState::Initial));
    scene.track(&Call::DestroyCommandPool { device: DEVICE, command_pool });
    assert_eq!(state(&scene), None);
}
