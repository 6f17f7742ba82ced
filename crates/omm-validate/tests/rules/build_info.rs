//! `VkAccelerationStructureBuildGeometryInfoKHR`, in builds and in queries of build sizes.

use omm_model::vk;
use omm_validate::RuleId::*;
use vk::BuildAccelerationStructureFlags as BuildFlags;

use crate::scene::*;

fn lossy(scene: &mut Scene) {
    scene.info().flags |= BuildFlags::MICROMAP_LOSSY;
    four_state(scene);
    // Below the limit for exact storage, so that the limit for lossy storage is the one that decides.
    scene.with_limits(|limits| limits.max_opacity_lossy4_state_subdivision_level = 2);
}

/// Only 4-state triangles are stored lossily.
fn four_state(scene: &mut Scene) {
    scene.usages()[1].format = vk::OpacityMicromapFormat::FOUR_STATE;
    scene.write(TRIANGLE_ARRAY + 16 + 6, &2_u16.to_le_bytes());
}

pub(crate) fn cases() -> Vec<Case> {
    vec![
        fails(
            Scene::top_level,
            |scene| scene.info().ty = vk::AccelerationStructureType::GENERIC,
            &[(Type03654, "pInfos[0].type")],
        ),
        fails(
            || Scene::top_level().into_sizes(),
            |scene| scene.info().ty = vk::AccelerationStructureType::GENERIC,
            &[(Type03654, "pBuildInfo->type")],
        ),
        passes(Type03654, Scene::top_level, |_| {}),
        fails(
            Scene::bottom_level,
            |scene| scene.info().flags = BuildFlags::PREFER_FAST_TRACE | BuildFlags::PREFER_FAST_BUILD,
            &[(Flags03796, "pInfos[0].flags")],
        ),
        passes(Flags03796, Scene::bottom_level, |scene| scene.info().flags = BuildFlags::PREFER_FAST_BUILD),
        fails(
            Scene::bottom_level,
            |scene| {
                scene.info().flags =
                    BuildFlags::ALLOW_OPACITY_MICROMAP_UPDATE | BuildFlags::ALLOW_OPACITY_MICROMAP_DATA_UPDATE;
            },
            &[(Flags11558, "pInfos[0].flags")],
        ),
        // The rule has no condition on the type.
        fails(
            Scene::top_level,
            |scene| {
                scene.info().flags =
                    BuildFlags::ALLOW_OPACITY_MICROMAP_UPDATE | BuildFlags::ALLOW_OPACITY_MICROMAP_DATA_UPDATE;
            },
            &[(Flags11558, "pInfos[0].flags")],
        ),
        passes(Flags11558, Scene::bottom_level, |scene| {
            scene.info().flags = BuildFlags::ALLOW_OPACITY_MICROMAP_UPDATE;
        }),
        fails(
            Scene::micromap,
            |scene| scene.info().geometries = None,
            &[(GeometryCount11560, "pInfos[0].geometryCount")],
        ),
        fails(
            || Scene::micromap().into_sizes(),
            |scene| {
                let geometry = scene.geometry().clone();
                scene.info().geometries = None;
                scene.info().geometry_pointers = Some(vec![geometry.clone(), geometry]);
            },
            &[(GeometryCount11560, "pBuildInfo->geometryCount")],
        ),
        passes(GeometryCount11560, Scene::micromap, |scene| {
            let info = scene.info();
            info.geometry_pointers = info.geometries.take();
        }),
        fails(
            Scene::micromap,
            |scene| scene.geometry().geometry_type = vk::GeometryType(77),
            &[(GeometryType11561, "pInfos[0].pGeometries[0].geometryType")],
        ),
        fails(
            Scene::micromap,
            |scene| {
                let info = scene.info();
                info.geometry_pointers = info.geometries.take();
                scene.geometry().geometry_type = vk::GeometryType::TRIANGLES;
            },
            &[(GeometryType11561, "pInfos[0].ppGeometries[0]->geometryType")],
        ),
        passes(GeometryType11561, Scene::bottom_level, |_| {}),
        fails(
            Scene::micromap,
            |scene| scene.info().flags = BuildFlags::LOW_MEMORY | BuildFlags::ALLOW_COMPACTION,
            &[(Flags11562, "pInfos[0].flags")],
        ),
        fails(
            Scene::micromap,
            |scene| scene.info().flags = BuildFlags::from_bits_retain(1 << 31),
            &[(Flags11562, "pInfos[0].flags")],
        ),
        passes(Flags11562, Scene::micromap, |scene| {
            four_state(scene);
            scene.info().flags =
                BuildFlags::ALLOW_COMPACTION | BuildFlags::PREFER_FAST_TRACE | BuildFlags::MICROMAP_LOSSY;
        }),
        fails(
            Scene::bottom_level,
            |scene| scene.info().flags |= BuildFlags::MICROMAP_LOSSY,
            &[(Type11563, "pInfos[0].type")],
        ),
        passes(Type11563, Scene::micromap, |scene| {
            scene.info().flags |= BuildFlags::MICROMAP_LOSSY;
            four_state(scene);
        }),
        fails(
            Scene::micromap,
            |scene| scene.usages()[0].subdivision_level = 4,
            &[(
                FourStateLevel11564,
                "pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.pUsageCounts[0]\
                 .subdivisionLevel",
            )],
        ),
        fails(
            || Scene::micromap().into_sizes(),
            |scene| {
                let data = scene.micromap_data();
                data.usage_count_pointers = data.usage_counts.take();
                scene.usages()[0].subdivision_level = u32::MAX;
            },
            &[(
                FourStateLevel11564,
                "pBuildInfo->pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.ppUsageCounts[0]\
                 ->subdivisionLevel",
            )],
        ),
        passes(FourStateLevel11564, Scene::micromap, |scene| scene.usages()[0].subdivision_level = 3),
        fails(
            Scene::micromap,
            |scene| {
                lossy(scene);
                scene.usages()[1].subdivision_level = 3;
            },
            &[(
                LossyLevel11565,
                "pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.pUsageCounts[1]\
                 .subdivisionLevel",
            )],
        ),
        passes(LossyLevel11565, Scene::micromap, lossy),
    ]
}

#[test]
fn cases_hold() {
    run(&cases());
}
