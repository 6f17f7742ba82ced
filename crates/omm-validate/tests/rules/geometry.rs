//! `VkAccelerationStructureGeometryKHR`.

use omm_model::vk;
use omm_validate::RuleId::*;

use crate::scene::*;

pub(crate) fn cases() -> Vec<Case> {
    vec![
        fails(
            Scene::micromap,
            |scene| scene.geometry().next.clear(),
            &[(MicromapData11568, "pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>")],
        ),
        fails(
            || Scene::micromap().into_sizes(),
            |scene| {
                let again = scene.micromap_data().clone();
                scene.geometry().next.push(again.into());
            },
            &[(MicromapData11568, "pBuildInfo->pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>")],
        ),
        passes(MicromapData11568, Scene::micromap, |_| {}),
        fails(
            Scene::micromap,
            |scene| scene.geometry().flags = vk::GeometryFlags::OPAQUE,
            &[(Flags11569, "pInfos[0].pGeometries[0].flags")],
        ),
        passes(Flags11569, Scene::bottom_level, |scene| {
            scene.geometry().flags |= vk::GeometryFlags::NO_DUPLICATE_ANY_HIT_INVOCATION;
        }),
    ]
}

#[test]
fn cases_hold() {
    run(&cases());
}
