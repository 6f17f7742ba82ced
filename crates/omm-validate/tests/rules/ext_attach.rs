//! Rules of `VkAccelerationStructureTrianglesOpacityMicromapEXT`.

use omm_model::call::Call;
use omm_model::vk;
use omm_validate::RuleId::*;

use crate::ext_build_world::*;
use crate::ext_copy_world::{DEVICE, World};

/// The path of a member of the structure.
macro_rules! member {
    ($name:literal) => {
        concat!(
            "pInfos[0].pGeometries[0].geometry.triangles",
            ".pNext<VkAccelerationStructureTrianglesOpacityMicromapEXT>.",
            $name
        )
    };
}

/// The same in a query of sizes.
macro_rules! of_sizes {
    ($name:literal) => {
        concat!(
            "pBuildInfo->pGeometries[0].geometry.triangles",
            ".pNext<VkAccelerationStructureTrianglesOpacityMicromapEXT>.",
            $name
        )
    };
}

/// The micromaps of the device go to level 3.
fn to_level_3(world: &mut World) {
    let limits = &mut world.profile.limits;
    limits.max_opacity2_state_subdivision_level = 3;
    limits.max_opacity4_state_subdivision_level = 3;
}

/// A query of the sizes of a structure with a displacement micromap attached, with that first usage.
fn displacement(world: &mut World, subdivision_level: u32, format: u32) {
    create(world).ty = vk::MicromapType::DISPLACEMENT_MICROMAP;
    *attached_usage(world) = vk::MicromapUsageExt { count: 1, subdivision_level, format };
    world.remove("vkCmdBuildMicromapsEXT");
    let (call, _) = world.remove("vkCmdBuildAccelerationStructuresKHR");
    let Call::CmdBuildAccelerationStructures { mut infos, .. } = call else { panic!("no build") };
    world.push(Call::GetAccelerationStructureBuildSizes {
        device: DEVICE,
        build_type: vk::AccelerationStructureBuildType::DEVICE,
        build_info: infos.remove(0),
        max_primitive_counts: Some(vec![4]),
    });
}

pub(crate) fn cases() -> Vec<BuildCase> {
    vec![
        breaks(
            |world| attached(world).usage_count_pointers = attached(world).usage_counts.clone(),
            &[(AttachedUsageCounts07335, member!("pUsageCounts"))],
        ),
        keeps(AttachedUsageCounts07335, |world| {
            attached(world).usage_count_pointers = attached(world).usage_counts.take();
        }),
        breaks(
            |world| {
                attached(world).index_type = vk::IndexType::UINT8;
                attached(world).index_stride = 1;
            },
            &[(AttachedIndexType10719, member!("indexType"))],
        ),
        keeps(AttachedIndexType10719, |world| attached(world).index_type = vk::IndexType::UINT16),
        breaks(
            |world| {
                attached(world).index_type = vk::IndexType::UINT32;
                attached(world).index_stride = 6;
            },
            &[(AttachedIndexStride10722, member!("indexStride"))],
        ),
        keeps(AttachedIndexStride10722, |world| {
            attached(world).index_type = vk::IndexType::UINT32;
            attached(world).index_stride = 8;
        }),
        breaks(|world| attached(world).index_stride = 1 << 32, &[(AttachedIndexStride10723, member!("indexStride"))]),
        keeps(AttachedIndexStride10723, |world| attached(world).index_stride = (1 << 32) - 2),
        breaks(
            |world| attached_usage(world).format = 3,
            &[(AttachedUsageFormat11679, member!("pUsageCounts[0].format"))],
        ),
        keeps(AttachedUsageFormat11679, |world| attached_usage(world).format = 1),
        breaks(
            |world| {
                to_level_3(world);
                *attached_usage(world) = vk::MicromapUsageExt { count: 1, subdivision_level: 4, format: 1 };
            },
            &[(AttachedTwoStateLevel11680, member!("pUsageCounts[0].subdivisionLevel"))],
        ),
        keeps(AttachedTwoStateLevel11680, |world| {
            to_level_3(world);
            *attached_usage(world) = vk::MicromapUsageExt { count: 1, subdivision_level: 3, format: 1 };
        }),
        breaks(
            |world| {
                to_level_3(world);
                attached_usage(world).subdivision_level = 4;
                attached(world).usage_count_pointers = attached(world).usage_counts.take();
            },
            &[(AttachedFourStateLevel11681, member!("ppUsageCounts[0]->subdivisionLevel"))],
        ),
        keeps(AttachedFourStateLevel11681, |world| {
            to_level_3(world);
            attached_usage(world).subdivision_level = 3;
        }),
        breaks(
            |world| displacement(world, 5, 4),
            &[(AttachedDisplacementFormat11682, of_sizes!("pUsageCounts[0].format"))],
        ),
        keeps(AttachedDisplacementFormat11682, |world| displacement(world, 5, 3)),
        breaks(
            |world| displacement(world, 6, 3),
            &[(AttachedDisplacementLevel11683, of_sizes!("pUsageCounts[0].subdivisionLevel"))],
        ),
        keeps(AttachedDisplacementLevel11683, |world| displacement(world, 5, 1)),
    ]
}

#[test]
fn cases_hold() {
    run(&cases());
}
