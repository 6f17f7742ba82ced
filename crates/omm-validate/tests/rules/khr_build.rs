//! Builds of the KHR extension on every command: parameters, features and the micromaps they refer to.

use omm_model::call::Call;
use omm_model::vk;
use omm_validate::RuleId::*;
use vk::BuildAccelerationStructureFlags as BuildFlags;

use crate::scene::*;

/// The path of a member of the micromap attached to the first geometry.
macro_rules! attached {
    ($name:literal) => {
        concat!(
            "pInfos[0].pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapKHR>.",
            $name
        )
    };
}

/// The same for a micromap object.
macro_rules! attached_ext {
    ($name:literal) => {
        concat!(
            "pInfos[0].pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapEXT>.",
            $name
        )
    };
}

/// The path of a member of the micromap data.
macro_rules! data {
    ($name:literal) => {
        concat!("pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.", $name)
    };
}

/// No feature of either extension.
pub(crate) fn without_features(scene: &mut Scene) {
    scene.restart(|profile| (profile.features.micromap, profile.features.micromap_ext) = (false, false));
}

/// The same build with ranges in device memory.
pub(crate) fn indirect(mut scene: Scene) -> Scene {
    let mut range = [0; 16];
    if let Some(ranges) = scene.ranges() {
        range[..4].copy_from_slice(&ranges[0].primitive_count.to_le_bytes());
    }
    scene.write(RANGES, &range);
    scene.call = Call::CmdBuildAccelerationStructuresIndirect {
        command_buffer: COMMAND_BUFFER,
        infos: vec![scene.info().clone()],
        indirect_device_addresses: vec![vk::DeviceAddress(RANGES)],
        indirect_strides: vec![16],
        max_primitive_counts: vec![Some(vec![PRIMITIVES])],
    };
    scene
}

/// The same build on the host.
pub(crate) fn on_host(mut scene: Scene) -> Scene {
    scene.call = Call::BuildAccelerationStructures {
        device: DEVICE,
        deferred_operation: vk::DeferredOperation::NULL,
        infos: vec![scene.info().clone()],
        build_range_infos: vec![scene.ranges().clone()],
    };
    scene
}

/// A mesh without any micromap.
pub(crate) fn plain() -> Scene {
    let mut scene = Scene::bottom_level();
    scene.triangles().next.clear();
    scene
}

/// A mesh with special indices from a micromap object of the other extension.
fn ext() -> Scene {
    let mut scene = Scene::bottom_level_without_micromap();
    let attached = vk::TrianglesOpacityMicromapExt {
        index_type: vk::IndexType::UINT16,
        index_buffer: vk::DeviceAddress(INDICES).into(),
        index_stride: 2,
        ..Default::default()
    };
    scene.triangles().next = vec![attached.into()];
    scene
}

fn ext_attached(scene: &mut Scene) -> &mut vk::TrianglesOpacityMicromapExt {
    let Some(vk::ChainStructure::TrianglesOpacityMicromapExt(attached)) = scene.triangles().next.first_mut() else {
        panic!("no micromap object")
    };
    attached
}

fn ext_without_type(scene: &mut Scene) {
    ext_attached(scene).index_type = vk::IndexType::NONE;
}

/// A size query's counts.
fn counts(scene: &mut Scene) -> &mut Option<Vec<u32>> {
    match &mut scene.call {
        Call::GetAccelerationStructureBuildSizes { max_primitive_counts, .. } => max_primitive_counts,
        other => panic!("{}", other.command()),
    }
}

fn on_any(scene: &mut Scene) {
    let Call::GetAccelerationStructureBuildSizes { build_type, .. } = &mut scene.call else { panic!() };
    *build_type = vk::AccelerationStructureBuildType::HOST_OR_DEVICE;
}

fn sizes(scene: Scene) -> Scene {
    scene.into_sizes()
}

fn info_cases() -> Vec<Case> {
    vec![
        fails(
            || sizes(plain()),
            |scene| {
                scene.restart(|profile| profile.features.micromap_ext = false);
                scene.info().flags = BuildFlags::ALLOW_OPACITY_MICROMAP_DATA_UPDATE;
            },
            &[(Flags11709, "pBuildInfo->flags")],
        ),
        passes(
            Flags11709,
            || sizes(plain()),
            |scene| {
                scene.info().flags = BuildFlags::ALLOW_OPACITY_MICROMAP_DATA_UPDATE;
            },
        ),
        fails(
            || sizes(plain()),
            |scene| {
                without_features(scene);
                scene.info().flags = BuildFlags::ALLOW_OPACITY_MICROMAP_UPDATE;
            },
            &[(Flags11710, "pBuildInfo->flags")],
        ),
        passes(
            Flags11710,
            || sizes(plain()),
            |scene| {
                scene.restart(|profile| profile.features.micromap_ext = false);
                scene.info().flags = BuildFlags::ALLOW_OPACITY_MICROMAP_UPDATE;
            },
        ),
        fails(
            || indirect(plain()),
            |scene| {
                without_features(scene);
                scene.info().flags = BuildFlags::ALLOW_DISABLE_OPACITY_MICROMAPS;
            },
            &[(Flags11711, "pInfos[0].flags")],
        ),
        passes(
            Flags11711,
            || on_host(plain()),
            |scene| {
                scene.restart(|profile| profile.features.micromap = false);
                scene.info().flags = BuildFlags::ALLOW_DISABLE_OPACITY_MICROMAPS;
            },
        ),
        fails(
            || sizes(Scene::micromap()),
            |scene| scene.restart(|profile| profile.features.micromap = false),
            &[(Feature11559, "pBuildInfo->type")],
        ),
        passes(Feature11559, || sizes(Scene::micromap()), |_| {}),
        fails(
            || sizes(Scene::micromap()),
            |scene| {
                scene.info().ty = vk::AccelerationStructureType::BOTTOM_LEVEL;
                *counts(scene) = Some(vec![1]);
            },
            &[(GeometryType11707, "pBuildInfo->pGeometries[0].geometryType")],
        ),
        passes(GeometryType11707, || sizes(Scene::micromap()), |_| {}),
        fails(
            || sizes(Scene::micromap()),
            |scene| scene.info().flags = BuildFlags::MICROMAP_LOSSY,
            &[(
                LossyFormat11712,
                "pBuildInfo->pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.pUsageCounts[1].format",
            )],
        ),
        passes(
            LossyFormat11712,
            || sizes(Scene::micromap()),
            |scene| {
                scene.info().flags = BuildFlags::MICROMAP_LOSSY;
                scene.usages()[1].format = vk::OpacityMicromapFormat::FOUR_STATE;
            },
        ),
        fails(
            || sizes(Scene::bottom_level()),
            |scene| *counts(scene) = None,
            &[(MaxPrimitiveCounts11612, "pMaxPrimitiveCounts")],
        ),
        fails(
            || sizes(Scene::bottom_level()),
            |scene| *counts(scene) = Some(vec![1, 2]),
            &[(MaxPrimitiveCounts11612, "pMaxPrimitiveCounts")],
        ),
        passes(MaxPrimitiveCounts11612, || sizes(Scene::bottom_level()), |scene| *counts(scene) = Some(vec![1])),
        fails(
            || sizes(Scene::micromap()),
            |scene| *counts(scene) = Some(vec![1]),
            &[(MaxPrimitiveCounts11613, "pMaxPrimitiveCounts")],
        ),
        passes(MaxPrimitiveCounts11613, || sizes(Scene::micromap()), |scene| *counts(scene) = None),
        fails(|| sizes(Scene::micromap()), on_any, &[(BuildType11614, "buildType")]),
        passes(BuildType11614, || sizes(Scene::bottom_level()), on_any),
    ]
}

fn command_cases() -> Vec<Case> {
    vec![
        fails(
            Scene::bottom_level,
            |scene| {
                let again = scene.geometry().clone();
                scene.info().geometries.as_mut().unwrap().push(again);
            },
            &[(BuildRangeInfos11543, "ppBuildRangeInfos[0]")],
        ),
        fails(Scene::bottom_level, |scene| *scene.ranges() = None, &[(BuildRangeInfos11543, "ppBuildRangeInfos[0]")]),
        passes(BuildRangeInfos11543, Scene::bottom_level, |scene| {
            let again = scene.geometry().clone();
            scene.info().geometries.as_mut().unwrap().push(again);
            let range = *scene.range();
            scene.ranges().as_mut().unwrap().push(range);
        }),
        fails(
            Scene::bottom_level,
            |scene| {
                let (info, ranges) = (scene.info().clone(), scene.ranges().clone());
                scene.call = build(vec![micromap_build(MICROMAP), info], vec![None, ranges]);
            },
            &[(DstAccelerationStructure11548, "pInfos[0].dstAccelerationStructure")],
        ),
        passes(DstAccelerationStructure11548, Scene::bottom_level, |_| {}),
        fails(
            Scene::bottom_level,
            |scene| scene.track_structure_at(TARGET, vk::AccelerationStructureType::BOTTOM_LEVEL, MICROMAP_AT + 0x80),
            &[(DstAccelerationStructure11549, "pInfos[0].dstAccelerationStructure")],
        ),
        passes(DstAccelerationStructure11549, Scene::bottom_level, |scene| {
            scene.track_structure_at(TARGET, vk::AccelerationStructureType::BOTTOM_LEVEL, MICROMAP_AT + 0x100);
        }),
        fails(
            Scene::micromap,
            |scene| scene.micromap_data().data = vk::DeviceAddress::NULL,
            &[(MicromapData11550, data!("data"))],
        ),
        passes(MicromapData11550, Scene::micromap, |_| {}),
        fails(
            Scene::micromap,
            |scene| {
                let address = other_buffer(scene, vk::BufferUsageFlags::STORAGE_BUFFER);
                scene.micromap_data().data = vk::DeviceAddress(address);
            },
            &[(MicromapData11551, data!("data"))],
        ),
        passes(MicromapData11551, Scene::micromap, |scene| {
            let usage = vk::BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY;
            scene.micromap_data().data = vk::DeviceAddress(other_buffer(scene, usage));
        }),
        fails(
            Scene::bottom_level,
            |scene| scene.attached().index_buffer = vk::DeviceAddress(BASE + BUFFER_SIZE - 6),
            &[(IndexRange11577, attached!("indexBuffer"))],
        ),
        passes(IndexRange11577, Scene::bottom_level, |scene| {
            scene.attached().index_buffer = vk::DeviceAddress(BASE + BUFFER_SIZE - 8);
        }),
        fails(|| indirect(Scene::micromap()), |_| {}, &[(IndirectType11557, "pInfos[0].type")]),
        passes(IndirectType11557, || indirect(Scene::bottom_level()), |_| {}),
        fails(|| on_host(Scene::micromap()), |_| {}, &[(HostBuild01, "pInfos[0].type")]),
        passes(HostBuild01, || on_host(plain()), |_| {}),
        fails(|| on_host(Scene::bottom_level()), |_| {}, &[(HostMicromap11705, attached!("micromap"))]),
        passes(HostMicromap11705, || on_host(Scene::bottom_level_without_micromap()), |_| {}),
    ]
}

fn ext_cases() -> Vec<Case> {
    vec![
        fails(ext, ext_without_type, &[(ExtIndexBuffer10904, attached_ext!("indexBuffer.deviceAddress"))]),
        passes(ExtIndexBuffer10904, ext, |_| {}),
        fails(
            || indirect(ext()),
            ext_without_type,
            &[(IndirectExtIndexBuffer10904, attached_ext!("indexBuffer.deviceAddress"))],
        ),
        passes(IndirectExtIndexBuffer10904, || indirect(ext()), |_| {}),
        fails(
            || on_host(ext()),
            |scene| {
                ext_without_type(scene);
                ext_attached(scene).index_buffer = vk::HostAddress(0x10).into();
            },
            &[(ExtIndexBuffer10892, attached_ext!("indexBuffer.hostAddress"))],
        ),
        passes(
            ExtIndexBuffer10892,
            || on_host(ext()),
            |scene| {
                ext_attached(scene).index_buffer = vk::HostAddress(0x10).into();
            },
        ),
        fails(
            ext,
            |scene| ext_attached(scene).index_buffer = vk::DeviceAddress::NULL.into(),
            &[(ExtIndexBuffer10905, attached_ext!("indexBuffer.deviceAddress"))],
        ),
        fails(
            ext,
            |scene| ext_attached(scene).index_buffer = vk::DeviceAddress(BASE + BUFFER_SIZE).into(),
            &[(ExtIndexBuffer10905, attached_ext!("indexBuffer.deviceAddress"))],
        ),
        passes(ExtIndexBuffer10905, ext, |_| {}),
        fails(
            || indirect(ext()),
            |scene| ext_attached(scene).index_buffer = vk::DeviceAddress::NULL.into(),
            &[(IndirectExtIndexBuffer10905, attached_ext!("indexBuffer.deviceAddress"))],
        ),
        passes(IndirectExtIndexBuffer10905, || indirect(ext()), |_| {}),
        fails(
            || on_host(ext()),
            |scene| ext_attached(scene).index_buffer = vk::HostAddress::NULL.into(),
            &[(ExtIndexBuffer11821, attached_ext!("indexBuffer.hostAddress"))],
        ),
        passes(
            ExtIndexBuffer11821,
            || on_host(ext()),
            |scene| {
                ext_attached(scene).index_buffer = vk::HostAddress(0x10).into();
            },
        ),
    ]
}

pub(crate) fn cases() -> Vec<Case> {
    [info_cases(), command_cases(), ext_cases()].concat()
}

#[test]
fn cases_hold() {
    run(&cases());
}
