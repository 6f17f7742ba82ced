//! Copies of acceleration structures, and deferred operations.

use omm_model::call::{Call, Output};
use omm_model::vk;
use omm_validate::RuleId::*;

use crate::khr_build::plain;
use crate::khr_executed::{BLOB, COPY, MICROMAP_TYPE, OTHER, deserialize, serialize, submitted};
use crate::scene::*;

/// A copy the next call.
fn copy(mut scene: Scene, src: vk::AccelerationStructure, dst: vk::AccelerationStructure) -> Scene {
    let info = vk::CopyAccelerationStructureInfo { src, dst, ..Default::default() };
    scene.call = Call::CmdCopyAccelerationStructure { command_buffer: COMMAND_BUFFER, info };
    scene
}

fn second_micromap() -> Scene {
    let mut scene = Scene::micromap();
    scene.track_structure(OTHER, MICROMAP_TYPE);
    scene
}

/// A serialized structure of one block of that type with these addresses, and an empty payload, at [`BLOB`].
fn write_blob(scene: &mut Scene, addresses: &[u64]) {
    let mut bytes = vec![0; 32];
    let size = 56 + 16 + 8 * addresses.len() as u64;
    bytes.extend([size, 0x100, 0xffff_ffff_0000_0001].map(u64::to_le_bytes).concat());
    bytes.extend([0, addresses.len() as u64].map(u64::to_le_bytes).concat());
    bytes.extend(addresses.iter().flat_map(|address| address.to_le_bytes()));
    scene.write(BLOB, &bytes);
}

/// The address of a structure asked for.
fn ask_address(scene: &mut Scene, handle: vk::AccelerationStructure) -> u64 {
    let address = scene.validator.state().address_range(handle).unwrap().address;
    let info = vk::AccelerationStructureDeviceAddressInfo { acceleration_structure: handle, ..Default::default() };
    let call = Call::GetAccelerationStructureDeviceAddress { device: DEVICE, info };
    scene.validator.track(&call, &Output::DeviceAddress(address));
    address.0
}

/// A structure deserialized from data that names [`OTHER`], and a copy of it submitted.
fn copy_of_deserialized(from_data: bool, to_memory: bool) -> Scene {
    let mut scene = Scene::bottom_level();
    scene.track_structure(OTHER, MICROMAP_TYPE);
    scene.track_structure(COPY, vk::AccelerationStructureType::BOTTOM_LEVEL);
    let address = ask_address(&mut scene, OTHER);
    scene.track(&scene.call.clone());
    serialize(&mut scene, TARGET, BLOB);
    serialize(&mut scene, MICROMAP, BLOB + 0x100);
    write_blob(&mut scene, &[address]);
    if from_data {
        deserialize(&mut scene, BLOB + 0x100, OTHER);
    } else {
        scene.track(&build(vec![micromap_build(OTHER)], vec![None]));
    }
    deserialize(&mut scene, BLOB, COPY);
    if to_memory {
        let dst = vk::DeviceAddress(BLOB + 0x200).into();
        let mode = vk::CopyAccelerationStructureMode::SERIALIZE;
        let info = vk::CopyAccelerationStructureToMemoryInfo { src: COPY, dst, mode, ..Default::default() };
        scene.call = Call::CmdCopyAccelerationStructureToMemory { command_buffer: COMMAND_BUFFER, info };
        return submitted(scene);
    }
    submitted(copy(scene, COPY, TARGET))
}

/// The same, the copy on the host.
fn host_copy_of_deserialized(from_data: bool) -> Scene {
    let mut scene = copy_of_deserialized(from_data, false);
    scene.track(&scene.call.clone());
    let info = vk::CopyAccelerationStructureInfo { src: COPY, dst: TARGET, ..Default::default() };
    let deferred_operation = vk::DeferredOperation::NULL;
    scene.call = Call::CopyAccelerationStructure { device: DEVICE, deferred_operation, info };
    scene
}

/// A deserialization the next call.
fn deserialization(at: u64, dst: vk::AccelerationStructure) -> Call {
    let mode = vk::CopyAccelerationStructureMode::DESERIALIZE;
    let info = vk::CopyMemoryToAccelerationStructureInfo {
        src: vk::DeviceAddress(at).into(),
        dst,
        mode,
        ..Default::default()
    };
    Call::CmdCopyMemoryToAccelerationStructure { command_buffer: COMMAND_BUFFER, info }
}

/// A deserialization of data that names a micromap.
fn deserialization_of(address: fn(&mut Scene) -> u64) -> Scene {
    let mut scene = Scene::bottom_level();
    let address = address(&mut scene);
    write_blob(&mut scene, &[address]);
    scene.call = deserialization(BLOB, TARGET);
    submitted(scene)
}

fn serialization_of_micromap(at: u64) -> Scene {
    let mut scene = Scene::micromap();
    let (mode, dst) = (vk::CopyAccelerationStructureMode::SERIALIZE, vk::DeviceAddress(at).into());
    let info = vk::CopyAccelerationStructureToMemoryInfo { src: MICROMAP, dst, mode, ..Default::default() };
    scene.call = Call::CmdCopyAccelerationStructureToMemory { command_buffer: COMMAND_BUFFER, info };
    scene
}

fn deserialization_of_micromap(at: u64) -> Scene {
    let mut scene = Scene::micromap();
    scene.call = deserialization(at, TARGET);
    scene
}

fn copy_cases() -> Vec<Case> {
    vec![
        fails(
            || copy(second_micromap(), MICROMAP, OTHER),
            |scene| scene.track_structure_sized(OTHER, MICROMAP_TYPE, 0x80),
            &[(CopySize01, "pInfo->dst")],
        ),
        passes(CopySize01, || copy(second_micromap(), MICROMAP, OTHER), |_| {}),
        fails(
            || copy(second_micromap(), MICROMAP, OTHER),
            |scene| scene.track_structure_at(OTHER, MICROMAP_TYPE, MICROMAP_AT + 0x80),
            &[(CopyOverlap02, "pInfo->dst")],
        ),
        passes(CopyOverlap02, || copy(second_micromap(), MICROMAP, OTHER), |_| {}),
        fails(
            || copy(second_micromap(), MICROMAP, OTHER),
            |scene| scene.track_structure(OTHER, vk::AccelerationStructureType::TOP_LEVEL),
            &[(CopyType03, "pInfo->dst")],
        ),
        passes(
            CopyType03,
            || copy(second_micromap(), MICROMAP, OTHER),
            |scene| {
                scene.track_structure(OTHER, vk::AccelerationStructureType::GENERIC);
            },
        ),
        fails(|| copy_of_deserialized(false, false), |_| {}, &[(SrcMicromaps11634, "pInfo->src")]),
        passes(SrcMicromaps11634, || copy_of_deserialized(true, false), |_| {}),
        fails(|| copy_of_deserialized(false, true), |_| {}, &[(SrcMicromaps11582, "pInfo->src")]),
        passes(SrcMicromaps11582, || copy_of_deserialized(true, true), |_| {}),
        fails(|| host_copy_of_deserialized(false), |_| {}, &[(SrcMicromaps11587, "pInfo->src")]),
        passes(SrcMicromaps11587, || host_copy_of_deserialized(true), |_| {}),
        fails(|| deserialization_of(|_| 0x1234_5600), |_| {}, &[(BlockAddress11585, "pInfo->src")]),
        passes(BlockAddress11585, || deserialization_of(|scene| ask_address(scene, MICROMAP)), |_| {}),
        fails(
            Scene::bottom_level,
            |scene| {
                scene.restart(|profile| profile.features.micromap = false);
                write_blob(scene, &[]);
                scene.call = deserialization(BLOB, TARGET);
            },
            &[(BlockFeature11584, "pInfo->src")],
        ),
        passes(BlockFeature11584, Scene::bottom_level, |scene| {
            write_blob(scene, &[]);
            scene.call = deserialization(BLOB, TARGET);
        }),
        fails(|| serialization_of_micromap(BLOB + 64), |_| {}, &[(DstAddress11699, "pInfo->dst.deviceAddress")]),
        passes(DstAddress11699, || serialization_of_micromap(BLOB), |_| {}),
        fails(|| deserialization_of_micromap(BLOB + 64), |_| {}, &[(SrcAddress11700, "pInfo->src.deviceAddress")]),
        passes(SrcAddress11700, || deserialization_of_micromap(BLOB), |_| {}),
    ]
}

/// A deferred host build, and the destruction of its operation the next call.
fn deferred(joined: bool) -> Scene {
    let mut scene = plain();
    let operation = vk::DeferredOperation(0x77);
    scene.track(&Call::CreateDeferredOperation { device: DEVICE, deferred_operation: operation });
    let build = Call::BuildAccelerationStructures {
        device: DEVICE,
        deferred_operation: operation,
        infos: vec![scene.info().clone()],
        build_range_infos: vec![scene.ranges().clone()],
    };
    scene.validator.track(&build, &Output::Result(vk::Result::OPERATION_DEFERRED));
    if joined {
        let join = Call::DeferredOperationJoin { device: DEVICE, operation };
        scene.validator.track(&join, &Output::Result(vk::Result::SUCCESS));
    }
    scene.call = Call::DestroyDeferredOperation { device: DEVICE, operation };
    scene
}

fn deferred_cases() -> Vec<Case> {
    vec![
        fails(|| deferred(false), |_| {}, &[(Operation03436, "operation")]),
        passes(Operation03436, || deferred(true), |_| {}),
    ]
}

pub(crate) fn cases() -> Vec<Case> {
    [copy_cases(), deferred_cases()].concat()
}

#[test]
fn cases_hold() {
    run(&cases());
}
