//! What builds find when they execute, and updates.

use omm_model::call::Call;
use omm_model::vk;
use omm_validate::RuleId::*;
use vk::BuildAccelerationStructureFlags as BuildFlags;

use crate::khr_build::{indirect, plain};
use crate::scene::*;

/// The path of a member of the micromap attached to the first geometry.
macro_rules! attached {
    ($name:literal) => {
        concat!(
            "pInfos[0].pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapKHR>",
            $name
        )
    };
}

const EXT_MICROMAP: &str =
    "pInfos[0].pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapEXT>.micromap";

pub(crate) const OTHER: vk::AccelerationStructure = vk::AccelerationStructure(0x22);
pub(crate) const COPY: vk::AccelerationStructure = vk::AccelerationStructure(0x23);
const OBJECT: vk::Micromap = vk::Micromap(0x44);
pub(crate) const MICROMAP_TYPE: vk::AccelerationStructureType = vk::AccelerationStructureType::OPACITY_MICROMAP;
pub(crate) const BLOB: u64 = BASE + 0xc00;

/// The build recorded, and the submission the next call.
pub(crate) fn submitted(mut scene: Scene) -> Scene {
    scene.track(&scene.call.clone());
    scene.track(&Call::EndCommandBuffer { command_buffer: COMMAND_BUFFER });
    scene.call = Call::QueueSubmit { queue: QUEUE, command_buffers: vec![COMMAND_BUFFER] };
    scene
}

/// A second micromap that is not built.
fn with_unbuilt() -> Scene {
    let mut scene = Scene::bottom_level();
    scene.track_structure(OTHER, MICROMAP_TYPE);
    scene.attached().micromap = OTHER;
    scene
}

fn with_built_before() -> Scene {
    let mut scene = with_unbuilt();
    scene.track(&build(vec![micromap_build(OTHER)], vec![None]));
    scene
}

/// A mesh with a micromap object that is not built.
fn with_object() -> Scene {
    let mut scene = Scene::bottom_level();
    let create_info = vk::MicromapCreateInfo { buffer: BUFFER, offset: 0xd00, size: 0x100, ..Default::default() };
    scene.track(&Call::CreateMicromap { device: DEVICE, create_info, micromap: OBJECT });
    let usage = vk::MicromapUsageExt { count: 3, subdivision_level: 1, format: 2 };
    let attached = vk::TrianglesOpacityMicromapExt {
        index_type: vk::IndexType::UINT16,
        index_buffer: vk::DeviceAddress(INDICES).into(),
        index_stride: 2,
        usage_counts: Some(vec![usage]),
        micromap: OBJECT,
        ..Default::default()
    };
    scene.triangles().next = vec![attached.into()];
    scene
}

fn with_object_built() -> Scene {
    let mut scene = with_object();
    let info = vk::MicromapBuildInfo { dst_micromap: OBJECT, ..Default::default() };
    scene.track(&Call::CmdBuildMicromaps { command_buffer: COMMAND_BUFFER, infos: vec![info] });
    scene
}

/// The structure built and submitted with those flags, and an update of it the next call.
fn update_of(mut scene: Scene, flags: BuildFlags) -> Scene {
    scene.info().flags = flags | BuildFlags::ALLOW_UPDATE;
    scene.track(&scene.call.clone());
    scene.submit();
    scene.begin();
    scene.info().mode = vk::BuildAccelerationStructureMode::UPDATE;
    scene.info().src_acceleration_structure = TARGET;
    scene
}

fn update() -> Scene {
    update_of(Scene::bottom_level(), BuildFlags::ALLOW_OPACITY_MICROMAP_UPDATE)
}

/// An update that attaches another micromap of the same shape.
fn other_micromap(flags: BuildFlags) -> Scene {
    let mut scene = update_of(Scene::bottom_level(), flags);
    scene.track_structure(OTHER, MICROMAP_TYPE);
    scene.track(&build(vec![micromap_build(OTHER)], vec![None]));
    scene.attached().micromap = OTHER;
    scene
}

/// Structure and micromap serialized, then deserialized into [`COPY`] and [`OTHER`]; the structure updated.
fn update_of_deserialized(from_data: bool) -> Scene {
    let mut scene = update_of(Scene::bottom_level(), BuildFlags::empty());
    scene.track_structure(OTHER, MICROMAP_TYPE);
    scene.track_structure(COPY, vk::AccelerationStructureType::BOTTOM_LEVEL);
    for (src, dst, at) in [(TARGET, COPY, BLOB), (MICROMAP, OTHER, BLOB + 0x100)] {
        serialize(&mut scene, src, at);
        deserialize(&mut scene, at, dst);
    }
    if !from_data {
        scene.track(&build(vec![micromap_build(OTHER)], vec![None]));
    }
    scene.submit();
    scene.begin();
    scene.info().src_acceleration_structure = COPY;
    scene.info().dst_acceleration_structure = COPY;
    scene.attached().micromap = OTHER;
    scene
}

pub(crate) fn serialize(scene: &mut Scene, src: vk::AccelerationStructure, at: u64) {
    let mode = vk::CopyAccelerationStructureMode::SERIALIZE;
    let dst = vk::DeviceAddress(at).into();
    let info = vk::CopyAccelerationStructureToMemoryInfo { src, dst, mode, ..Default::default() };
    scene.track(&Call::CmdCopyAccelerationStructureToMemory { command_buffer: COMMAND_BUFFER, info });
}

pub(crate) fn deserialize(scene: &mut Scene, at: u64, dst: vk::AccelerationStructure) {
    let mode = vk::CopyAccelerationStructureMode::DESERIALIZE;
    let src = vk::DeviceAddress(at).into();
    let info = vk::CopyMemoryToAccelerationStructureInfo { src, dst, mode, ..Default::default() };
    scene.track(&Call::CmdCopyMemoryToAccelerationStructure { command_buffer: COMMAND_BUFFER, info });
}

/// An update of a mesh without micromaps.
fn update_plain() -> Scene {
    update_of(plain(), BuildFlags::empty())
}

fn update_special() -> Scene {
    update_of(Scene::bottom_level_without_micromap(), BuildFlags::empty())
}

fn detach(scene: &mut Scene) {
    scene.triangles().next.clear();
}

fn attach(scene: &mut Scene) {
    scene.attached().micromap = MICROMAP;
}

fn add(scene: &mut Scene) {
    let special = Scene::bottom_level_without_micromap().attached().clone();
    scene.triangles().next = vec![special.into()];
    scene.write(INDICES, &[0xff; 8]);
}

fn executed_cases() -> Vec<Case> {
    vec![
        fails(|| submitted(with_unbuilt()), |_| {}, &[(Micromap11701, attached!(".micromap"))]),
        passes(Micromap11701, || submitted(with_built_before()), |_| {}),
        fails(|| submitted(indirect(with_unbuilt())), |_| {}, &[(IndirectMicromap11701, attached!(".micromap"))]),
        passes(IndirectMicromap11701, || submitted(indirect(with_built_before())), |_| {}),
        fails(|| submitted(with_object()), |_| {}, &[(ExtMicromap11632, EXT_MICROMAP)]),
        passes(ExtMicromap11632, || submitted(with_object_built()), |_| {}),
        fails(|| submitted(indirect(with_object())), |_| {}, &[(IndirectExtMicromap11632, EXT_MICROMAP)]),
        passes(IndirectExtMicromap11632, || submitted(indirect(with_object_built())), |_| {}),
        fails(|| with_mesh_as_micromap(Scene::bottom_level()), |_| {}, &[(MicromapType11624, attached!(".micromap"))]),
        passes(MicromapType11624, Scene::bottom_level, |_| {}),
        fails(
            || indirect(with_mesh_as_micromap(Scene::bottom_level())),
            |_| {},
            &[(IndirectMicromapType11624, attached!(".micromap"))],
        ),
        passes(IndirectMicromapType11624, || indirect(Scene::bottom_level()), |_| {}),
    ]
}

/// Another bottom-level structure in the place of the micromap.
fn with_mesh_as_micromap(mut scene: Scene) -> Scene {
    scene.track_structure(OTHER, vk::AccelerationStructureType::BOTTOM_LEVEL);
    let mut mesh = plain();
    mesh.info().dst_acceleration_structure = OTHER;
    scene.track(&mesh.call);
    scene.attached().micromap = OTHER;
    scene
}

fn update_cases() -> Vec<Case> {
    vec![
        fails(update, detach, &[(UpdateMicromap11625, "pInfos[0].pGeometries[0].geometry.triangles.pNext")]),
        passes(UpdateMicromap11625, update, |_| {}),
        fails(
            || indirect(update()),
            detach,
            &[(IndirectUpdateMicromap11625, "pInfos[0].pGeometries[0].geometry.triangles.pNext")],
        ),
        passes(IndirectUpdateMicromap11625, || indirect(update()), |_| {}),
        fails(
            update_special,
            |scene| {
                attach(scene);
            },
            &[(UpdateNullMicromap11626, attached!(".micromap"))],
        ),
        passes(UpdateNullMicromap11626, update_special, |_| {}),
        fails(|| indirect(update_special()), attach, &[(IndirectUpdateNullMicromap11626, attached!(".micromap"))]),
        passes(IndirectUpdateNullMicromap11626, || indirect(update_special()), |_| {}),
        fails(update_plain, add, &[(UpdateNewMicromap11627, attached!(""))]),
        passes(UpdateNewMicromap11627, update_plain, |_| {}),
        fails(|| indirect(update_plain()), add, &[(IndirectUpdateNewMicromap11627, attached!(""))]),
        passes(IndirectUpdateNewMicromap11627, || indirect(update_plain()), |_| {}),
        fails(|| submitted(update_of_deserialized(false)), |_| {}, &[(UpdateOrigin11628, attached!(".micromap"))]),
        passes(UpdateOrigin11628, || submitted(update_of_deserialized(true)), |_| {}),
        fails(
            || submitted(indirect(update_of_deserialized(false))),
            |_| {},
            &[(IndirectUpdateOrigin11628, attached!(".micromap"))],
        ),
        passes(IndirectUpdateOrigin11628, || submitted(indirect(update_of_deserialized(true))), |_| {}),
        fails(
            || submitted(other_micromap(BuildFlags::empty())),
            |_| {},
            &[(UpdateSameMicromap11629, attached!(".micromap"))],
        ),
        passes(
            UpdateSameMicromap11629,
            || submitted(other_micromap(BuildFlags::ALLOW_OPACITY_MICROMAP_UPDATE)),
            |_| {},
        ),
        fails(
            || submitted(indirect(other_micromap(BuildFlags::empty()))),
            |_| {},
            &[(IndirectUpdateSameMicromap11629, attached!(".micromap"))],
        ),
        passes(
            IndirectUpdateSameMicromap11629,
            || submitted(indirect(other_micromap(BuildFlags::ALLOW_OPACITY_MICROMAP_DATA_UPDATE))),
            |_| {},
        ),
    ]
}

pub(crate) fn cases() -> Vec<Case> {
    [executed_cases(), update_cases()].concat()
}

#[test]
fn cases_hold() {
    run(&cases());
}
