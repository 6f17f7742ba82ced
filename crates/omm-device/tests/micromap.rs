//! Micromap and top-level builds, and build sizes.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::{bytes, device, stopped, triangle};
use omm_device::Device;
use omm_device::app::{App, MicromapInput};
use omm_layout::instance;
use omm_layout::object::{MicromapObject, TlasObject};
use omm_model::format::OpacityMicromapFormat::{FourState, TwoState};
use omm_model::profile::DeviceProfile;
use omm_model::vk;

/// The input of a micromap build.
fn micromap_info(
    usages: &[(u32, u32, vk::OpacityMicromapFormat)],
    data: vk::DeviceAddress,
    triangle_array: vk::DeviceAddress,
    triangle_array_stride: u64,
) -> vk::BuildGeometryInfo {
    let usage = |&(count, subdivision_level, format)| vk::MicromapUsage { count, subdivision_level, format };
    let usage_count_pointers = Some(usages.iter().map(usage).collect());
    let data = vk::GeometryMicromapData {
        usage_count_pointers,
        data,
        triangle_array,
        triangle_array_stride,
        ..Default::default()
    };
    let geometry_type = vk::GeometryType::MICROMAP;
    let geometry = vk::Geometry { next: vec![data.into()], geometry_type, ..Default::default() };
    vk::BuildGeometryInfo {
        ty: vk::AccelerationStructureType::OPACITY_MICROMAP,
        geometry_pointers: Some(vec![geometry]),
        ..Default::default()
    }
}

#[test]
fn triangles_are_read_where_the_array_says() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let data = app.upload_input(&[0xff, 0x12, 0x34, 0x56, 0x78]).unwrap().address;
    let mut array = Vec::new();
    for entry in [triangle(1, 2, FourState), triangle(0, 1, TwoState), triangle(2, 2, TwoState)] {
        array.extend(omm_layout::triangle::encode(&entry.into()));
        array.extend([0xee; 4]);
    }
    array.truncate(array.len() - 4);
    let array = app.upload_input(&array).unwrap().address;
    let (two, four) = (vk::OpacityMicromapFormat::TWO_STATE, vk::OpacityMicromapFormat::FOUR_STATE);
    let usages = [(1, 2, four), (1, 2, two), (1, 1, two)];
    let structure = app.build(micromap_info(&usages, data, array, 12), None).unwrap();
    let found = bytes(&app, &structure);
    let object = MicromapObject::read(&found).unwrap();
    let found: Vec<_> =
        object.triangles().map(|found| (found.subdivision_level.get(), found.format, found.data)).collect();
    let data = [&[0x12, 0x34, 0x56, 0x78][..], &[0x0f], &[0x34, 0x56]];
    assert_eq!(found, [(2, FourState, data[0]), (1, TwoState, data[1]), (2, TwoState, data[2])]);
    // The array has no fourth entry.
    let address = vk::DeviceAddress(0x1_0000_0000);
    let why = stopped(app.build(micromap_info(&[(4, 2, four)], address, array, 12), None));
    let at = "pInfos[0].ppGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.triangleArray";
    assert!(why.contains(&format!("{at}[3]: 8 bytes from address")), "{why}");
}

#[test]
fn levels_and_formats_have_limits() {
    let mut device = Device::new(DeviceProfile::minimum());
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let data = app.upload_input(&[0; 64]).unwrap().address;
    let (two, four) = (vk::OpacityMicromapFormat::TWO_STATE, vk::OpacityMicromapFormat::FOUR_STATE);
    let mut build = |level, format, usages: &[_]| {
        let entry = vk::MicromapTriangle { data_offset: 0, subdivision_level: level, format };
        let array = app.upload_input(&omm_layout::triangle::encode(&entry)).unwrap().address;
        let result = app.build(micromap_info(usages, data, array, 8), None);
        result.map_err(|error| error.to_string())
    };
    assert!(build(3, 1, &[(1, 3, two)]).is_ok());
    let ends = |error: Result<_, String>, end: &str| assert!(error.as_ref().unwrap_err().ends_with(end), "{error:?}");
    ends(build(4, 2, &[(1, 4, four)]), "subdivisionLevel: subdivision level 4 is beyond the device's limit of 3");
    ends(build(13, 2, &[(1, 4, four)]), "triangleArray[0]: subdivisionLevel: subdivision level 13 is above 12");
    ends(build(0, 0, &[(1, 0, four)]), "triangleArray[0]: format: 0 is neither 1 (2-state) nor 2 (4-state)");
    ends(build(0, 2, &[(1, 13, four)]), "ppUsageCounts[0].subdivisionLevel: subdivision level 13 is above 12");
    let seven = vk::OpacityMicromapFormat(7);
    ends(build(0, 2, &[(1, 0, seven)]), "ppUsageCounts[0].format: the value 7 has no meaning here");
    // The triangles need more than their usage counts promised.
    ends(build(3, 2, &[(1, 0, two)]), "triangleArray: 96 bytes are needed, 88 are there");
}

#[test]
fn nothing_is_made_that_has_no_room() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    // A thousand triangles that all claim the same four mebibytes.
    let data = vec![0; 1 << 22];
    let triangles = vec![triangle(0, 12, FourState); 1000];
    let input = MicromapInput { data: &data, triangles: &triangles, flags: Default::default() };
    assert_eq!(
        app.build_micromap(&input).unwrap_err().to_string(),
        "vkCreateBuffer returned ERROR_OUT_OF_DEVICE_MEMORY"
    );
    let data = app.upload_input(&data).unwrap().address;
    let array = omm_layout::triangle::encode(&triangle(0, 12, FourState).into());
    let array = app.upload_input(&array).unwrap().address;
    let usages = [(1000, 0, vk::OpacityMicromapFormat::TWO_STATE)];
    let why = stopped(app.build(micromap_info(&usages, data, array, 0), None));
    assert!(why.ends_with("triangleArray[0]: 4194304 bytes are needed, 24064 are there"), "{why}");
}

#[test]
fn an_empty_micromap() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let structure = app.build(micromap_info(&[], vk::DeviceAddress::NULL, vk::DeviceAddress::NULL, 0), None).unwrap();
    assert_eq!(MicromapObject::read(&bytes(&app, &structure)).unwrap().triangle_count(), 0);
}

#[test]
fn instances_in_an_array_or_behind_pointers() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let bottom = app.build_triangles(&[], Default::default()).unwrap();
    let instances = [(1, bottom.address.0), (2, 0), (3, bottom.address.0)].map(|(custom, reference)| vk::Instance {
        instance_custom_index: custom,
        mask: 0x0f,
        flags: vk::GeometryInstanceFlags::from_bits_retain(0xa5),
        acceleration_structure_reference: reference,
        ..Default::default()
    });
    let structure = app.build_instances(&instances, Default::default()).unwrap();
    let found = bytes(&app, &structure);
    assert!(TlasObject::read(&found).unwrap().instances().eq(instances.map(vk::MotionInstanceData::StaticInstance)));

    let mut pointers = vec![0xff; 8];
    for instance in instances {
        let buffer = app.upload_input(&instance::encode(&instance).unwrap()).unwrap();
        pointers.extend(buffer.address.0.to_le_bytes());
    }
    pointers.extend(7_u64.to_le_bytes());
    let data = app.upload_input(&pointers).unwrap().address.into();
    let data = vk::GeometryInstancesData { array_of_pointers: true.into(), data, ..Default::default() };
    let geometry = vk::Geometry {
        geometry_type: vk::GeometryType::INSTANCES,
        geometry: vk::GeometryData::Instances(data),
        ..Default::default()
    };
    let info = vk::BuildGeometryInfo {
        ty: vk::AccelerationStructureType::TOP_LEVEL,
        geometries: Some(vec![geometry]),
        ..Default::default()
    };
    let range = vk::BuildRangeInfo { primitive_count: 3, primitive_offset: 8, ..Default::default() };
    let by_pointers = app.build(info.clone(), Some(vec![range])).unwrap();
    assert_eq!(bytes(&app, &by_pointers), found);
    let range = vk::BuildRangeInfo { primitive_count: 4, ..range };
    let why = stopped(app.build(info, Some(vec![range])));
    assert!(why.contains("geometry.instances.data[3]: 64 bytes from address 0x7"), "{why}");
}

#[test]
fn sizes_follow_from_counts_alone() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let wrong = vk::DeviceAddress(u64::MAX);
    let usages = [(3, 12, vk::OpacityMicromapFormat::FOUR_STATE), (u32::MAX, 0, vk::OpacityMicromapFormat::TWO_STATE)];
    let info = micromap_info(&usages, wrong, wrong, u64::MAX);
    let sizes = app.build_sizes(&info, None).unwrap();
    assert_eq!(sizes.acceleration_structure_size, 64 + 3 * (16 + (1 << 22)) + 24 * u64::from(u32::MAX));
    assert_eq!(sizes.update_scratch_size, 0);
    assert!(sizes.build_scratch_size > 0);
}
