//! Rules of builds of micromap objects on their parameters.

use omm_model::vk;
use omm_validate::RuleId::*;

use crate::ext_build_world::*;
use crate::ext_copy_world::World;

const SIZES: &str = "vkGetMicromapBuildSizesEXT";
const BUILD: &str = "vkCmdBuildMicromapsEXT";
const HOST_BUILD: &str = "vkBuildMicromapsEXT";

/// The micromaps of the device go to level 3.
fn to_level_3(world: &mut World) {
    let limits = &mut world.profile.limits;
    limits.max_opacity2_state_subdivision_level = 3;
    limits.max_opacity4_state_subdivision_level = 3;
}

/// A query of the sizes of a displacement micromap, with that first usage.
fn displacement(world: &mut World, subdivision_level: u32, format: u32) {
    alone(world, SIZES);
    sizes(world).ty = vk::MicromapType::DISPLACEMENT_MICROMAP;
    *usage(sizes(world)) = vk::MicromapUsageExt { count: 1, subdivision_level, format };
}

pub(crate) fn cases() -> Vec<BuildCase> {
    [usage_cases(), command_cases()].concat()
}

fn usage_cases() -> Vec<BuildCase> {
    vec![
        breaks(
            |world| build(world).usage_count_pointers = build(world).usage_counts.clone(),
            &[(UsageCounts07516, "pInfos[0].pUsageCounts")],
        ),
        breaks(
            |world| sizes(world).usage_count_pointers = sizes(world).usage_counts.clone(),
            &[(UsageCounts07516, "pBuildInfo->pUsageCounts")],
        ),
        keeps(UsageCounts07516, |world| build(world).usage_count_pointers = build(world).usage_counts.take()),
        breaks(|world| usage(build(world)).format = 3, &[(UsageFormat11652, "pInfos[0].pUsageCounts[0].format")]),
        breaks(|world| usage(host_build(world)).format = 0, &[(UsageFormat11652, "pInfos[0].pUsageCounts[0].format")]),
        breaks(
            |world| {
                usage(sizes(world)).format = u32::MAX;
                sizes(world).usage_count_pointers = sizes(world).usage_counts.take();
            },
            &[(UsageFormat11652, "pBuildInfo->ppUsageCounts[0]->format")],
        ),
        keeps(UsageFormat11652, |world| usage(build(world)).format = 1),
        breaks(
            |world| displacement(world, 5, 9),
            &[(DisplacementUsageFormat11653, "pBuildInfo->pUsageCounts[0].format")],
        ),
        keeps(DisplacementUsageFormat11653, |world| displacement(world, 5, 3)),
        breaks(
            |world| {
                to_level_3(world);
                *usage(build(world)) = vk::MicromapUsageExt { count: 1, subdivision_level: 4, format: 1 };
            },
            &[(UsageTwoStateLevel11654, "pInfos[0].pUsageCounts[0].subdivisionLevel")],
        ),
        keeps(UsageTwoStateLevel11654, |world| {
            to_level_3(world);
            *usage(build(world)) = vk::MicromapUsageExt { count: 1, subdivision_level: 3, format: 1 };
        }),
        breaks(
            |world| {
                to_level_3(world);
                usage(build(world)).subdivision_level = 4;
            },
            &[(UsageFourStateLevel11655, "pInfos[0].pUsageCounts[0].subdivisionLevel")],
        ),
        keeps(UsageFourStateLevel11655, |world| {
            to_level_3(world);
            usage(build(world)).subdivision_level = 3;
        }),
        breaks(
            |world| displacement(world, 6, 3),
            &[(DisplacementUsageLevel11656, "pBuildInfo->pUsageCounts[0].subdivisionLevel")],
        ),
        keeps(DisplacementUsageLevel11656, |world| displacement(world, 5, 1)),
    ]
}

fn command_cases() -> Vec<BuildCase> {
    vec![
        breaks(
            |world| {
                alone(world, BUILD);
                world.profile.features.micromap_ext = false;
            },
            &[(BuildFeature11648, "commandBuffer")],
        ),
        keeps(BuildFeature11648, |world| alone(world, BUILD)),
        breaks(|world| world.profile.features.micromap_host_commands = false, &[(HostBuildFeature07555, "device")]),
        keeps(HostBuildFeature07555, |world| alone(world, HOST_BUILD)),
        breaks(
            |world| {
                alone(world, SIZES);
                world.profile.features.micromap_ext = false;
            },
            &[(BuildSizesFeature11618, "device")],
        ),
        keeps(BuildSizesFeature11618, |world| alone(world, SIZES)),
        breaks(|world| build(world).mode = vk::BuildMicromapMode(1), &[(Mode07462, "pInfos[0].mode")]),
        // The size query ignores it.
        keeps(Mode07462, |world| sizes(world).mode = vk::BuildMicromapMode(1)),
        breaks(|world| host_build(world).mode = vk::BuildMicromapMode(1), &[(HostMode07462, "pInfos[0].mode")]),
        keeps(HostMode07462, |world| host_build(world).mode = vk::BuildMicromapMode::BUILD),
        breaks(
            |world| build(world).scratch_data = vk::DeviceAddress(address_of(SCRATCH) + 0x40).into(),
            &[(ScratchAlignment07514, "pInfos[0].scratchData")],
        ),
        keeps(ScratchAlignment07514, |world| {
            build(world).scratch_data = vk::DeviceAddress(address_of(SCRATCH) + 0x80).into();
        }),
        breaks(
            |world| build(world).triangle_array = vk::DeviceAddress(address_of(INPUT) + 0x480).into(),
            &[
                (InputAlignment07515, "pInfos[0].triangleArray"),
                (TriangleFormat11657, "pInfos[0].triangleArray[0].format"),
            ],
        ),
        breaks(
            |world| build(world).data = vk::DeviceAddress(address_of(INPUT) + 0x80).into(),
            &[(InputAlignment07515, "pInfos[0].data")],
        ),
        keeps(InputAlignment07515, |world| {
            build(world).data = vk::DeviceAddress(address_of(INPUT) + 0x300).into();
        }),
        // The host does not need it.
        keeps(InputAlignment07515, |world| host_build(world).data = vk::HostAddress(0x7000_0101).into()),
    ]
}

#[test]
fn cases_hold() {
    run(&cases());
}
