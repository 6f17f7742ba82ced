//! Rules of builds of micromap objects on the contents of memory.

use omm_model::vk;
use omm_validate::RuleId::*;

use crate::ext_build_world::*;
use crate::ext_copy_world::{BASE, HOST_BASE, World};

/// Writes level and format of a triangle that the device builds.
fn entry(world: &mut World, triangle: u64, level: u16, format: u16) {
    world.put(BASE + 8 * triangle + 4, &[level.to_le_bytes(), format.to_le_bytes()].concat());
}

/// Level 3 is the highest, in either format.
fn to_level_3(world: &mut World) {
    world.profile.limits.max_opacity2_state_subdivision_level = 3;
    world.profile.limits.max_opacity4_state_subdivision_level = 3;
}

/// The device builds a displacement micromap, which is attached to nothing.
fn displacement(world: &mut World) {
    create(world).ty = vk::MicromapType::DISPLACEMENT_MICROMAP;
    build(world).ty = vk::MicromapType::DISPLACEMENT_MICROMAP;
    world.remove("vkCmdBuildAccelerationStructuresKHR");
}

pub(crate) fn cases() -> Vec<BuildCase> {
    [triangle_cases(), host_cases()].concat()
}

fn triangle_cases() -> Vec<BuildCase> {
    vec![
        breaks(
            |world| {
                entry(world, 1, 1, 0);
                entry(world, 2, 1, 3);
            },
            &[(TriangleFormat11657, "pInfos[0].triangleArray[1].format")],
        ),
        breaks(
            |world| world.put_on_host(HOST_BASE + 6, &[3]),
            &[(TriangleFormat11657, "pInfos[0].triangleArray[0].format")],
        ),
        keeps(TriangleFormat11657, |world| entry(world, 1, 1, 1)),
        // The fourth entry is not part of the micromap.
        keeps(TriangleFormat11657, |world| entry(world, 3, 1, 7)),
        breaks(
            |world| {
                displacement(world);
                entry(world, 0, 1, 4);
            },
            &[(DisplacementTriangleFormat11658, "pInfos[0].triangleArray[0].format")],
        ),
        keeps(DisplacementTriangleFormat11658, |world| {
            displacement(world);
            entry(world, 0, 1, 3);
        }),
        breaks(
            |world| {
                to_level_3(world);
                entry(world, 2, 4, 1);
            },
            &[(TriangleTwoStateLevel11659, "pInfos[0].triangleArray[2].subdivisionLevel")],
        ),
        keeps(TriangleTwoStateLevel11659, |world| {
            to_level_3(world);
            entry(world, 2, 3, 1);
        }),
        breaks(
            |world| {
                to_level_3(world);
                entry(world, 0, 4, 2);
            },
            &[(TriangleFourStateLevel11660, "pInfos[0].triangleArray[0].subdivisionLevel")],
        ),
        keeps(TriangleFourStateLevel11660, |world| {
            to_level_3(world);
            entry(world, 0, 3, 2);
        }),
        breaks(
            |world| {
                displacement(world);
                entry(world, 1, 6, 1);
            },
            &[(DisplacementTriangleLevel11661, "pInfos[0].triangleArray[1].subdivisionLevel")],
        ),
        keeps(DisplacementTriangleLevel11661, |world| {
            displacement(world);
            entry(world, 1, 5, 1);
        }),
    ]
}

fn host_cases() -> Vec<BuildCase> {
    vec![
        breaks(
            |world| host_build(world).data = vk::DeviceAddress(BASE + 0x100).into(),
            &[(HostData07553, "pInfos[0].data")],
        ),
        breaks(|world| host_build(world).data = vk::HostAddress::NULL.into(), &[(HostData07553, "pInfos[0].data")]),
        // The last triangle's data are bytes 2 and 3.
        breaks(
            |world| host_build(world).data = vk::HostAddress(HOST_BASE + HOST_SIZE - 3).into(),
            &[(HostData07553, "pInfos[0].data")],
        ),
        keeps(HostData07553, |world| host_build(world).data = vk::HostAddress(HOST_BASE + HOST_SIZE - 4).into()),
        breaks(
            |world| host_build(world).triangle_array = vk::DeviceAddress(BASE).into(),
            &[(HostTriangleArray07554, "pInfos[0].triangleArray")],
        ),
        breaks(
            |world| host_build(world).triangle_array_stride = (HOST_SIZE - 8) / 2 + 1,
            &[(HostTriangleArray07554, "pInfos[0].triangleArray")],
        ),
        breaks(
            |world| host_build(world).triangle_array_stride = u64::MAX,
            &[(HostTriangleArray07554, "pInfos[0].triangleArray")],
        ),
        keeps(HostTriangleArray07554, |world| {
            let last = (HOST_SIZE - 8) / 2;
            host_build(world).triangle_array_stride = last;
            for at in [last, 2 * last] {
                world.put_on_host(HOST_BASE + at, &[0, 0, 0, 0, 0, 0, 1, 0]);
            }
        }),
        // No triangles, no array.
        keeps(HostTriangleArray07554, |world| {
            let info = host_build(world);
            info.usage_counts = None;
            (info.triangle_array, info.data) = (vk::HostAddress::NULL.into(), vk::HostAddress::NULL.into());
        }),
    ]
}

#[test]
fn cases_hold() {
    run(&cases());
}
