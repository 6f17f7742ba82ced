//! Rules of the KHR extension on the contents of memory: instances, lossy formats, data ranges, positions.

use omm_layout::instance;
use omm_model::vk;
use omm_validate::RuleId::*;
use vk::{BuildAccelerationStructureFlags as BuildFlags, GeometryInstanceFlags as InstanceFlags};

use crate::khr_build::{indirect, on_host, plain, without_features};
use crate::scene::*;

const INSTANCES: u64 = BASE + 0xd00;
const VERTICES: u64 = BASE + 0xe00;
const MESH: vk::AccelerationStructure = vk::AccelerationStructure(0x22);
const INSTANCE_FLAGS: &str = "pInfos[0].pGeometries[0].geometry.instances.data[0].flags";

/// Micromap data of the first geometry.
macro_rules! data {
    ($name:literal) => {
        concat!("pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.", $name)
    };
}

/// One instance with those flags of a mesh that was built with those.
fn instances(flags: InstanceFlags, built: BuildFlags) -> Scene {
    let mut scene = Scene::top_level();
    scene.track_structure(MESH, vk::AccelerationStructureType::BOTTOM_LEVEL);
    let mut mesh = plain();
    mesh.info().dst_acceleration_structure = MESH;
    mesh.info().flags = built;
    scene.track(&mesh.call);
    let info = vk::AccelerationStructureDeviceAddressInfo { acceleration_structure: MESH, ..Default::default() };
    let call = omm_model::call::Call::GetAccelerationStructureDeviceAddress { device: DEVICE, info };
    scene.validator.track(&call, &omm_model::call::Output::DeviceAddress(vk::DeviceAddress(0xabc00)));
    let instance = vk::Instance { flags, acceleration_structure_reference: 0xabc00, ..Default::default() };
    scene.write(INSTANCES, &instance::encode(&instance).unwrap());
    let data = vk::GeometryInstancesData { data: vk::DeviceAddress(INSTANCES).into(), ..Default::default() };
    scene.geometry().geometry = vk::GeometryData::Instances(data);
    scene
}

fn forced() -> Scene {
    let mut scene = instances(InstanceFlags::FORCE_OPACITY_MICROMAP_2_STATE, BuildFlags::empty());
    scene.validator = Scene::top_level().validator;
    scene
}

fn disabled() -> Scene {
    instances(InstanceFlags::DISABLE_OPACITY_MICROMAPS, BuildFlags::empty())
}

fn disabled_where_allowed() -> Scene {
    instances(InstanceFlags::DISABLE_OPACITY_MICROMAPS, BuildFlags::ALLOW_DISABLE_OPACITY_MICROMAPS)
}

/// The same through a pointer.
fn by_pointer(mut scene: Scene) -> Scene {
    scene.write(INSTANCES + 0x80, &INSTANCES.to_le_bytes());
    let data = vk::DeviceAddress(INSTANCES + 0x80).into();
    let data = vk::GeometryInstancesData { data, array_of_pointers: vk::Bool32::TRUE, ..Default::default() };
    scene.geometry().geometry = vk::GeometryData::Instances(data);
    scene
}

/// Triangles with positions.
fn positions(y: f32, x: f32) -> Scene {
    let mut scene = plain();
    scene.range().primitive_count = 2;
    let triangles = scene.triangles();
    triangles.vertex_format = vk::Format::R32G32B32_SFLOAT;
    triangles.vertex_data = vk::DeviceAddress(VERTICES).into();
    scene.write(VERTICES + 4 * 12, &[x, y].map(f32::to_le_bytes).concat());
    scene
}

/// Two boxes.
fn boxes(min_x: f32, max_z: f32) -> Scene {
    let mut scene = plain();
    scene.range().primitive_count = 2;
    let data = vk::GeometryAabbsData { data: vk::DeviceAddress(VERTICES).into(), stride: 32, ..Default::default() };
    scene.geometry().geometry_type = vk::GeometryType::AABBS;
    scene.geometry().geometry = vk::GeometryData::Aabbs(data);
    scene.write(VERTICES + 32, &[min_x, 0.0, 0.0, 1.0, 1.0, max_z].map(f32::to_le_bytes).concat());
    scene
}

/// A lossy build of usages that say 4-state.
fn lossy() -> Scene {
    let mut scene = Scene::micromap();
    scene.info().flags = BuildFlags::MICROMAP_LOSSY;
    scene.usages()[1].format = vk::OpacityMicromapFormat::FOUR_STATE;
    scene
}

/// Data of which the last entry's two bytes begin `before` bytes before the end of the buffer.
fn data_at_end(before: u64) -> Scene {
    let mut scene = Scene::micromap();
    scene.write(TRIANGLE_ARRAY + 16, &(BASE + BUFFER_SIZE - before - DATA).to_le_bytes()[..4]);
    scene
}

pub(crate) fn cases() -> Vec<Case> {
    vec![
        fails(forced, without_features, &[(InstanceFlags11580, INSTANCE_FLAGS)]),
        fails(|| by_pointer(forced()), without_features, &[(InstanceFlags11580, INSTANCE_FLAGS)]),
        passes(InstanceFlags11580, forced, |scene| scene.restart(|profile| profile.features.micromap_ext = false)),
        fails(disabled, |_| {}, &[(InstanceFlags11581, INSTANCE_FLAGS), (InstanceFlags10607, INSTANCE_FLAGS)]),
        passes(InstanceFlags11581, disabled_where_allowed, |_| {}),
        passes(InstanceFlags10607, || by_pointer(disabled_where_allowed()), |_| {}),
        Case {
            rule: InstanceFlags10607,
            ..fails(
                || by_pointer(disabled()),
                |_| {},
                &[(InstanceFlags11581, INSTANCE_FLAGS), (InstanceFlags10607, INSTANCE_FLAGS)],
            )
        },
        Case {
            rule: IndirectInstanceFlags10607,
            ..fails(
                || indirect(disabled()),
                |_| {},
                &[(InstanceFlags11581, INSTANCE_FLAGS), (IndirectInstanceFlags10607, INSTANCE_FLAGS)],
            )
        },
        passes(IndirectInstanceFlags10607, || indirect(disabled_where_allowed()), |_| {}),
        // No instance at all.
        passes(IndirectInstanceFlags10607, || indirect(disabled()), |scene| scene.write(RANGES, &[0; 4])),
        passes(InstanceFlags11581, || on_host(disabled()), |_| {}),
        fails(lossy, |_| {}, &[(LossyFormat11713, data!("triangleArray[2].format"))]),
        passes(LossyFormat11713, lossy, |scene| scene.write(TRIANGLE_ARRAY + 16 + 6, &2_u16.to_le_bytes())),
        fails(|| data_at_end(1), |_| {}, &[(DataRange11553, data!("triangleArray[2].dataOffset"))]),
        passes(DataRange11553, || data_at_end(2), |_| {}),
        fails(
            || positions(f32::NAN, 0.0),
            |_| {},
            &[(PartlyNan01, "pInfos[0].pGeometries[0].geometry.triangles.vertexData[4]")],
        ),
        passes(PartlyNan01, || positions(f32::NAN, f32::NAN), |_| {}),
        fails(|| boxes(0.0, f32::NAN), |_| {}, &[(PartlyNan01, "pInfos[0].pGeometries[0].geometry.aabbs.data[1]")]),
        passes(PartlyNan01, || boxes(f32::NAN, f32::NAN), |_| {}),
    ]
}

#[test]
fn cases_hold() {
    run(&cases());
}
