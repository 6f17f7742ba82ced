//! `vkCmdBuildAccelerationStructuresKHR`: parameters and tracked objects.

use omm_model::call::Call;
use omm_model::vk;
use omm_validate::RuleId::*;

use crate::scene::*;

/// Spreads the triangle array over the buffer.
fn write_spread(scene: &mut Scene, stride: u64) {
    scene.micromap_data().triangle_array_stride = stride;
    for index in 1..3 {
        scene.write(TRIANGLE_ARRAY + stride * index, &[0, 0, 0, 0, 1, 0, 2, 0]);
    }
}

pub(crate) fn cases() -> Vec<Case> {
    let ranges = |scene: &mut Scene| *scene.ranges() = Some(vec![]);
    vec![
        fails(Scene::micromap, ranges, &[(BuildRangeInfos11544, "ppBuildRangeInfos[0]")]),
        passes(BuildRangeInfos11544, Scene::micromap, |scene| *scene.ranges() = None),
        passes(BuildRangeInfos11544, Scene::micromap, |scene| {
            let Call::CmdBuildAccelerationStructures { build_range_infos, .. } = &mut scene.call else { panic!() };
            build_range_infos.clear();
        }),
        fails(
            Scene::micromap,
            |scene| scene.info().mode = vk::BuildAccelerationStructureMode::UPDATE,
            &[(Mode11545, "pInfos[0].mode")],
        ),
        passes(Mode11545, Scene::top_level, |scene| {
            scene.info().mode = vk::BuildAccelerationStructureMode::UPDATE;
            scene.info().src_acceleration_structure = TARGET;
        }),
        fails(
            Scene::micromap,
            |scene| scene.info().src_acceleration_structure = MICROMAP,
            &[(SrcAccelerationStructure11546, "pInfos[0].srcAccelerationStructure")],
        ),
        passes(SrcAccelerationStructure11546, Scene::bottom_level, |scene| {
            scene.info().src_acceleration_structure = TARGET;
        }),
        // A query of sizes ignores mode and source.
        passes(
            Mode11545,
            || Scene::micromap().into_sizes(),
            |scene| {
                scene.info().mode = vk::BuildAccelerationStructureMode::UPDATE;
                scene.info().src_acceleration_structure = MICROMAP;
            },
        ),
        fails(
            Scene::micromap,
            |scene| scene.track_structure(TARGET, vk::AccelerationStructureType::BOTTOM_LEVEL),
            &[(DstAccelerationStructure11547, "pInfos[0].dstAccelerationStructure")],
        ),
        passes(DstAccelerationStructure11547, Scene::micromap, |scene| {
            scene.track_structure(TARGET, vk::AccelerationStructureType::GENERIC);
        }),
        // An object that nobody saw created may be of any type.
        passes(DstAccelerationStructure11547, Scene::micromap, |scene| {
            scene.info().dst_acceleration_structure = vk::AccelerationStructure(0x99);
        }),
        fails(
            Scene::micromap,
            |scene| {
                scene.micromap_data().data.0 += 64;
                scene.micromap_data().triangle_array.0 += 8;
                // The entries move along.
                let memory = scene.memory.clone();
                scene.memory[8..32].copy_from_slice(&memory[..24]);
            },
            &[
                (Alignment11552, "pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.data"),
                (
                    Alignment11552,
                    "pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.triangleArray",
                ),
            ],
        ),
        passes(Alignment11552, Scene::micromap, |scene| scene.micromap_data().data.0 += 128),
        // A query of sizes ignores addresses.
        passes(Alignment11552, || Scene::micromap().into_sizes(), |scene| scene.micromap_data().data.0 += 1),
        fails(
            Scene::micromap,
            |scene| write_spread(scene, 1368),
            &[(
                TriangleArrayRange11554,
                "pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.triangleArray",
            )],
        ),
        fails(
            Scene::micromap,
            |scene| scene.micromap_data().triangle_array_stride = 1 << 63,
            &[(
                TriangleArrayRange11554,
                "pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.triangleArray",
            )],
        ),
        // 3 * 1364 bytes are four short of the buffer.
        passes(TriangleArrayRange11554, Scene::micromap, |scene| write_spread(scene, 1364)),
        // Outside any buffer there is nothing to compare with.
        fails(
            Scene::micromap,
            |scene| scene.micromap_data().triangle_array = vk::DeviceAddress(BASE + BUFFER_SIZE),
            &[(
                MicromapData11550,
                "pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.triangleArray",
            )],
        ),
    ]
}

#[test]
fn cases_hold() {
    run(&cases());
}

#[test]
fn each_build_of_a_command_is_checked() {
    let mut scene = Scene::micromap();
    let mut wrong = scene.info().clone();
    wrong.src_acceleration_structure = MICROMAP;
    scene.call = build(vec![micromap_build(TARGET), wrong], vec![None, Some(vec![])]);
    let report = scene.check();
    let found: Vec<_> = report.iter().map(|it| (it.rule, it.location.as_str())).collect();
    let expected = [
        (BuildRangeInfos11544, "ppBuildRangeInfos[1]"),
        (SrcAccelerationStructure11546, "pInfos[1].srcAccelerationStructure"),
    ];
    assert_eq!(found, expected);
}
