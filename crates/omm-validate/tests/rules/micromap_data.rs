//! `VkAccelerationStructureGeometryMicromapDataKHR`.

use omm_model::vk;
use omm_validate::RuleId::*;

use crate::scene::*;

pub(crate) fn cases() -> Vec<Case> {
    vec![
        fails(
            Scene::micromap,
            |scene| {
                let data = scene.micromap_data();
                data.usage_count_pointers = Some(vec![]);
            },
            &[(
                UsageCounts11642,
                "pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.pUsageCounts",
            )],
        ),
        passes(UsageCounts11642, Scene::micromap, |scene| {
            let data = scene.micromap_data();
            data.usage_count_pointers = data.usage_counts.take();
        }),
        passes(UsageCounts11642, Scene::micromap, |scene| scene.micromap_data().usage_counts = None),
        fails(
            || Scene::micromap().into_sizes(),
            |scene| {
                let data = scene.micromap_data();
                data.usage_count_pointers = data.usage_counts.take();
                scene.usages()[0].count = 1 << 29;
            },
            &[(
                TotalCount11643,
                "pBuildInfo->pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.ppUsageCounts",
            )],
        ),
        // The counts together are too many, none of them alone is.
        fails(
            Scene::micromap,
            |scene| scene.with_limits(|limits| limits.max_micromap_triangles = 2),
            &[(
                TotalCount11643,
                "pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.pUsageCounts",
            )],
        ),
        passes(TotalCount11643, Scene::micromap, |scene| {
            scene.with_limits(|limits| limits.max_micromap_triangles = MICROMAP_TRIANGLES.into());
        }),
        fails(
            Scene::micromap,
            |scene| scene.usages()[1].subdivision_level = 4,
            &[(
                TwoStateLevel11645,
                "pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.pUsageCounts[1]\
                 .subdivisionLevel",
            )],
        ),
        passes(TwoStateLevel11645, Scene::micromap, |scene| scene.usages()[1].subdivision_level = 3),
        fails(
            Scene::micromap,
            |scene| scene.micromap_data().triangle_array_stride = 4,
            &[(
                TriangleArrayStride11646,
                "pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.triangleArrayStride",
            )],
        ),
        passes(TriangleArrayStride11646, Scene::micromap, |scene| {
            scene.micromap_data().triangle_array_stride = 8;
        }),
        fails(
            || Scene::micromap().into_sizes(),
            |scene| scene.micromap_data().triangle_array_stride = 10,
            &[(
                TriangleArrayStride11647,
                "pBuildInfo->pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.triangleArrayStride",
            )],
        ),
        passes(TriangleArrayStride11647, Scene::micromap, |scene| {
            scene.micromap_data().triangle_array_stride = 12;
            for index in 1..3 {
                scene.write(TRIANGLE_ARRAY + 12 * index, &[0, 0, 0, 0, 1, 0, 2, 0]);
            }
        }),
        // Usages of an unknown format are another rule's business.
        fails(
            Scene::micromap,
            |scene| {
                scene.usages()[1] =
                    vk::MicromapUsage { count: 1, subdivision_level: 9, format: vk::OpacityMicromapFormat(3) };
            },
            &[(
                MicromapUsageFormatParameter,
                "pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.pUsageCounts[1].format",
            )],
        ),
    ]
}

#[test]
fn cases_hold() {
    run(&cases());
}
