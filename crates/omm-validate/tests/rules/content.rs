//! Rules on the contents of memory.

use omm_model::memory::NoMemory;
use omm_model::vk;
use omm_validate::RuleId::*;

use crate::scene::*;

/// The path of a member of an entry of the triangle array.
macro_rules! entry {
    ($index_and_name:literal) => {
        concat!(
            "pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.triangleArray",
            $index_and_name
        )
    };
}

/// The path of an index.
macro_rules! index {
    ($place:literal) => {
        concat!(
            "pInfos[0].pGeometries[0].geometry.triangles",
            ".pNext<VkAccelerationStructureTrianglesOpacityMicromapKHR>.indexBuffer",
            $place
        )
    };
}

fn write_level(scene: &mut Scene, triangle: u64, level: u16) {
    scene.write(TRIANGLE_ARRAY + 8 * triangle + 4, &level.to_le_bytes());
}

fn write_format(scene: &mut Scene, triangle: u64, format: u16) {
    scene.write(TRIANGLE_ARRAY + 8 * triangle + 6, &format.to_le_bytes());
}

fn lossy(scene: &mut Scene) {
    scene.info().flags = vk::BuildAccelerationStructureFlags::MICROMAP_LOSSY;
    scene.usages()[1].format = vk::OpacityMicromapFormat::FOUR_STATE;
    write_format(scene, 2, 2);
    scene.with_limits(|limits| limits.max_opacity_lossy4_state_subdivision_level = 2);
}

pub(crate) fn cases() -> Vec<Case> {
    vec![
        fails(
            Scene::micromap,
            |scene| {
                write_format(scene, 1, 3);
                write_format(scene, 2, 0);
            },
            &[(TriangleFormat11555, entry!("[1].format"))],
        ),
        passes(TriangleFormat11555, Scene::micromap, |scene| write_format(scene, 1, 1)),
        // The fourth entry is not part of the micromap.
        passes(TriangleFormat11555, Scene::micromap, |scene| write_format(scene, 3, 0xffff)),
        passes(TriangleFormat11555, || Scene::micromap().into_sizes(), |scene| write_format(scene, 1, 3)),
        fails(
            Scene::micromap,
            |scene| write_level(scene, 2, 4),
            &[(TwoStateLevel11556, entry!("[2].subdivisionLevel"))],
        ),
        passes(TwoStateLevel11556, Scene::micromap, |scene| write_level(scene, 2, 3)),
        fails(
            Scene::micromap,
            |scene| write_level(scene, 1, 0xffff),
            &[
                (FourStateLevel11566, entry!("[1].subdivisionLevel")),
                // As many bytes as there are numbers for.
                (DataRange11553, entry!("[1].dataOffset")),
            ],
        ),
        passes(FourStateLevel11566, Scene::micromap, |scene| write_level(scene, 1, 3)),
        fails(
            Scene::micromap,
            |scene| {
                lossy(scene);
                write_level(scene, 0, 3);
            },
            &[(LossyLevel11567, entry!("[0].subdivisionLevel"))],
        ),
        passes(LossyLevel11567, Scene::micromap, lossy),
        fails(
            Scene::bottom_level,
            |scene| scene.write(INDICES + 6, &3_u16.to_le_bytes()),
            &[(Index11575, index!("[3]"))],
        ),
        fails(Scene::bottom_level, |scene| scene.attached().base_triangle = 1, &[(Index11575, index!("[1]"))]),
        // Index 0 counts too.
        fails(Scene::bottom_level, |scene| scene.attached().base_triangle = 3, &[(Index11575, index!("[0]"))]),
        // -5 is not special.
        fails(
            Scene::bottom_level,
            |scene| scene.write(INDICES + 4, &(-5_i16).to_le_bytes()),
            &[(Index11575, index!("[2]"))],
        ),
        passes(Index11575, Scene::bottom_level, |scene| {
            scene.attached().base_triangle = 2;
            scene.write(INDICES, &[0_i16, -1, -2, -3].map(i16::to_le_bytes).concat());
        }),
        // Indices behind those of the geometry are not read.
        passes(Index11575, Scene::bottom_level, |scene| scene.write(INDICES + 8, &3_u16.to_le_bytes())),
        // What cannot be read is passed over.
        fails(
            Scene::bottom_level,
            |scene| {
                scene.range().primitive_count = u32::MAX;
                scene.write(INDICES, &9_u16.to_le_bytes());
            },
            &[(IndexRange11577, index!(""))],
        ),
        // The same index four billion times.
        passes(Index11575, Scene::bottom_level, |scene| {
            scene.range().primitive_count = u32::MAX;
            scene.attached().index_stride = 0;
        }),
        fails(
            Scene::bottom_level_without_micromap,
            |scene| scene.write(INDICES + 4, &0_u16.to_le_bytes()),
            &[(SpecialIndex11578, index!("[2]"))],
        ),
        fails(
            Scene::bottom_level_without_micromap,
            |scene| {
                scene.attached().index_type = vk::IndexType::UINT32;
                scene.attached().index_stride = 4;
                scene.write(INDICES, &[-1_i32, -4, -5, -2].map(i32::to_le_bytes).concat());
            },
            &[(SpecialIndex11578, index!("[2]"))],
        ),
        passes(SpecialIndex11578, Scene::bottom_level_without_micromap, |scene| {
            scene.attached().index_type = vk::IndexType::UINT8;
            scene.attached().index_stride = 1;
            scene.write(INDICES, &[255, 254, 253, 252, 251]);
        }),
    ]
}

#[test]
fn cases_hold() {
    run(&cases());
}

#[test]
fn without_memory_contents_are_not_judged() {
    let mut scene = Scene::micromap();
    write_format(&mut scene, 1, 3);
    assert_eq!(scene.check().len(), 1);
    assert!(scene.validator.check(&scene.call, &NoMemory).is_empty());
}
