//! Any call can be checked and tracked, however wrong: valid calls with members replaced by any values.

use omm_model::call::{Call, Output};
use omm_model::vk;
use proptest::prelude::*;

use crate::scene::*;

/// Numbers at the edges, near valid ones, and any.
fn number() -> impl Strategy<Value = u64> {
    prop_oneof![
        0_u64..16,
        Just(u64::MAX),
        Just(1 << 63),
        (0_u64..4).prop_map(|below| u64::from(u32::MAX) - below),
        BASE - 2..BASE + BUFFER_SIZE + 2,
        Just(1_000_623_000),
        Just(1_000_165_000),
        Just(1_000_265_000),
        any::<u64>(),
    ]
}

/// Puts a number into one of the members that rules look at.
fn change(scene: &mut Scene, member: u8, number: u64) {
    let (word, signed) = (number as u32, number as i32);
    match member {
        0 => scene.info().ty.0 = signed,
        1 => scene.info().flags = vk::BuildAccelerationStructureFlags::from_bits_retain(word),
        2 => scene.info().mode.0 = signed,
        3 => scene.info().src_acceleration_structure.0 = number,
        4 => scene.info().dst_acceleration_structure.0 = number,
        5 => {
            let info = scene.info();
            std::mem::swap(&mut info.geometries, &mut info.geometry_pointers);
        }
        6 => {
            let info = scene.info();
            info.geometry_pointers.clone_from(&info.geometries);
        }
        _ => {}
    }
    if let Call::CmdBuildAccelerationStructures { build_range_infos, infos, .. } = &mut scene.call {
        match member {
            7 => build_range_infos.clear(),
            8 => build_range_infos[0..].iter_mut().for_each(|ranges| *ranges = None),
            9 => build_range_infos.iter_mut().flatten().flatten().for_each(|range| range.primitive_count = word),
            10 => infos.push(infos[0].clone()),
            _ => {}
        }
    }
    let info = scene.info();
    for geometry in info.geometries.iter_mut().chain(&mut info.geometry_pointers).flatten() {
        match member {
            11 => geometry.geometry_type.0 = signed,
            12 => geometry.flags = vk::GeometryFlags::from_bits_retain(word),
            13 => geometry.next.extend(geometry.next.clone()),
            14 => geometry.next.clear(),
            _ => {}
        }
        for structure in &mut geometry.next {
            if let vk::ChainStructure::GeometryMicromapData(data) = structure {
                change_micromap_data(data, member, number);
            }
        }
        if let vk::GeometryData::Triangles(triangles) = &mut geometry.geometry {
            for structure in &mut triangles.next {
                if let vk::ChainStructure::TrianglesOpacityMicromap(attached) = structure {
                    change_attached(attached, member, number);
                }
            }
        }
    }
}

fn change_micromap_data(data: &mut vk::GeometryMicromapData, member: u8, number: u64) {
    let usages = data.usage_counts.iter_mut().chain(&mut data.usage_count_pointers).flatten();
    match member {
        15 => usages.for_each(|usage| usage.count = number as u32),
        16 => usages.for_each(|usage| usage.subdivision_level = number as u32),
        17 => usages.for_each(|usage| usage.format.0 = number as i32),
        18 => data.usage_count_pointers = data.usage_counts.clone(),
        19 => data.usage_counts = None,
        20 => data.data.0 = number,
        21 => data.triangle_array.0 = number,
        22 => data.triangle_array_stride = number,
        _ => {}
    }
}

fn change_attached(attached: &mut vk::TrianglesOpacityMicromap, member: u8, number: u64) {
    match member {
        23 => attached.index_type.0 = number as i32,
        24 => attached.index_buffer.0 = number,
        25 => attached.index_stride = number,
        26 => attached.base_triangle = number as u32,
        27 => attached.micromap.0 = number,
        _ => {}
    }
}

proptest! {
    #[test]
    fn any_call_is_judged(
        which in 0_usize..10,
        changes in prop::collection::vec((0_u8..28, number()), 0..6),
        memory in prop::collection::vec(any::<u8>(), 0x20),
    ) {
        let scenes = [
            Scene::micromap,
            Scene::bottom_level,
            Scene::bottom_level_without_indices,
            Scene::bottom_level_without_micromap,
            Scene::top_level,
        ];
        let mut scene = scenes[which % 5]();
        if which >= 5 {
            scene = scene.into_sizes();
        }
        scene.write(TRIANGLE_ARRAY, &memory);
        scene.write(INDICES, &memory);
        for (member, number) in changes {
            change(&mut scene, member, number);
        }
        let report = scene.check();
        prop_assert_eq!(&report, &scene.check(), "the same call, the same report");
        for violation in &report {
            prop_assert_eq!(violation.command, scene.call.command());
            prop_assert!(violation.to_string().contains(violation.location.as_str()));
        }
        let json: serde_json::Value = serde_json::from_str(&serde_json::to_string(&report).unwrap()).unwrap();
        prop_assert_eq!(json.as_array().unwrap().len(), report.len());

        let tracked = scene.validator.check_and_track(&scene.call.clone(), &Output::None, &scene.clone());
        prop_assert_eq!(tracked, report);
        scene.submit();
        let again = scene.check();
        prop_assert_eq!(&again, &scene.check());
    }
}
