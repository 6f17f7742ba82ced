//! Rules of `VkMicromapCreateInfoEXT` and `vkCreateMicromapEXT`.

use omm_model::vk;
use omm_validate::RuleId::*;
use vk::MicromapCreateFlags as CreateFlags;

use crate::ext_build_world::*;
use crate::ext_copy_world::World;

const CREATE: &str = "vkCreateMicromapEXT";

fn replay(world: &mut World) {
    create(world).create_flags = CreateFlags::DEVICE_ADDRESS_CAPTURE_REPLAY;
}

pub(crate) fn cases() -> Vec<BuildCase> {
    vec![
        breaks(
            |world| {
                alone(world, CREATE);
                world.profile.features.micromap_ext = false;
            },
            &[(CreateFeature11615, "device")],
        ),
        keeps(CreateFeature11615, |world| alone(world, CREATE)),
        breaks(
            |world| create(world).device_address = vk::DeviceAddress(0x1_0000),
            &[(ReplayAddress07433, "pCreateInfo->deviceAddress")],
        ),
        keeps(ReplayAddress07433, |world| {
            replay(world);
            create(world).device_address = vk::DeviceAddress(0x1_0000);
        }),
        breaks(
            |world| {
                alone(world, CREATE);
                create(world).offset = 0x80;
            },
            &[(Offset07438, "pCreateInfo->offset")],
        ),
        keeps(Offset07438, |world| {
            alone(world, CREATE);
            create(world).offset = 0x100;
        }),
        breaks(
            |world| {
                replay(world);
                world.profile.features.micromap_capture_replay = false;
            },
            &[(CaptureReplay11616, "pCreateInfo->createFlags")],
        ),
        keeps(CaptureReplay11616, |world| world.profile.features.micromap_capture_replay = false),
    ]
}

#[test]
fn cases_hold() {
    run(&cases());
}
