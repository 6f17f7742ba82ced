//! Builds with motion: vertices at time 1, and instances that move.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::{bottom_level, bytes, device, floats, micromap, stopped, triangles_geometry, vertices};
use omm_device::app::{App, AppError, Structure};
use omm_layout::motion_instance;
use omm_layout::object::{BlasObject, TlasObject};
use omm_model::special_index::TriangleMap;
use omm_model::vk::{self, MotionInstanceData};

/// Triangles that end `shift` further along every axis than they begin.
fn moving(app: &mut App<'_>, numbers: &[f32], shift: f32) -> vk::GeometryTrianglesData {
    let data = vertices(app, numbers);
    let ends: Vec<f32> = numbers.iter().map(|number| number + shift).collect();
    let vertex_data = app.upload_input(&floats(&ends)).unwrap().address.into();
    let motion = vk::GeometryMotionTrianglesData { vertex_data, ..Default::default() };
    vk::GeometryTrianglesData { next: vec![motion.into()], ..data }
}

fn build(app: &mut App<'_>, data: vk::GeometryTrianglesData, count: u32) -> Result<Structure, AppError> {
    let range = vk::BuildRangeInfo { primitive_count: count, ..Default::default() };
    app.build(bottom_level(vec![triangles_geometry(data)]), Some(vec![range]))
}

/// A micromap of which each triangle has that of its own number.
fn attached(micromap: vk::AccelerationStructure) -> vk::TrianglesOpacityMicromap {
    vk::TrianglesOpacityMicromap { index_type: vk::IndexType::NONE, micromap, ..Default::default() }
}

#[test]
fn vertices_at_both_times_are_stored() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let leaf = micromap(&mut app);
    let mut numbers: Vec<f32> = (0..27_u8).map(f32::from).collect();
    // The second triangle is inactive at time 1 as well as at time 0: NaN plus anything is NaN.
    numbers[9] = f32::NAN;
    let mut data = moving(&mut app, &numbers, 100.0);
    let transform = [[2.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    data.transform_data = app.upload_input(&floats(transform.as_flattened())).unwrap().address.into();
    for mapped in [false, true] {
        if mapped {
            let micromap = leaf.handle;
            data.next.push(attached(micromap).into());
        }
        let structure = build(&mut app, data.clone(), 3).unwrap();
        let bytes = bytes(&app, &structure);
        let object = BlasObject::read(&bytes).unwrap();
        let geometry = object.geometry(0).unwrap();
        assert!(geometry.has_motion());
        assert_eq!(geometry.micromap().is_some(), mapped);
        let found: Vec<_> = geometry.triangles().collect();
        assert_eq!(found.iter().map(|triangle| triangle.primitive_index).collect::<Vec<_>>(), [0, 2]);
        assert_eq!(found[0].vertices, [[1.0, 1.0, 2.0], [7.0, 4.0, 5.0], [13.0, 7.0, 8.0]]);
        let end = [[201.0, 101.0, 102.0], [207.0, 104.0, 105.0], [213.0, 107.0, 108.0]];
        assert_eq!(found[0].vertices_t1, Some(end));
        assert_eq!(found[1].map, mapped.then_some(TriangleMap::Triangle(2)));
    }
}

#[test]
fn what_ends_nowhere_stops_the_device() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let mut data = moving(&mut app, &[0.0; 9], 1.0);
    data.next = vec![vk::GeometryMotionTrianglesData::default().into()];
    let text = stopped(build(&mut app, data, 1));
    assert!(text.contains("pNext<VkAccelerationStructureGeometryMotionTrianglesDataNV>.vertexData"), "{text}");
}

fn top_level(
    app: &mut App<'_>,
    flags: vk::BuildAccelerationStructureFlags,
    bytes: &[u8],
    by_pointer: bool,
    count: u32,
) -> Result<Structure, AppError> {
    let data = app.upload_input(bytes).unwrap().address.into();
    let data = vk::GeometryInstancesData { array_of_pointers: by_pointer.into(), data, ..Default::default() };
    let geometry = vk::Geometry {
        geometry_type: vk::GeometryType::INSTANCES,
        geometry: vk::GeometryData::Instances(data),
        ..Default::default()
    };
    let info = vk::BuildGeometryInfo {
        ty: vk::AccelerationStructureType::TOP_LEVEL,
        flags,
        geometries: Some(vec![geometry]),
        ..Default::default()
    };
    app.build(info, Some(vec![vk::BuildRangeInfo { primitive_count: count, ..Default::default() }]))
}

#[test]
fn instances_of_all_types_are_stored() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let data = moving(&mut app, &[0.0; 9], 1.0);
    let blas = build(&mut app, data, 1).unwrap().address.0;
    let transform_t1 = vk::TransformMatrix { matrix: [[3.0; 4]; 3] };
    let srt = vk::SrtData { sx: 1.0, qw: 1.0, tz: 5.0, ..Default::default() };
    let instances = [
        MotionInstanceData::StaticInstance(vk::Instance {
            mask: 7,
            acceleration_structure_reference: blas,
            ..Default::default()
        }),
        MotionInstanceData::MatrixMotionInstance(vk::MatrixMotionInstance {
            transform_t1,
            acceleration_structure_reference: blas,
            ..Default::default()
        }),
        MotionInstanceData::SrtMotionInstance(vk::SrtMotionInstance { transform_t1: srt, ..Default::default() }),
    ];
    let motion = vk::BuildAccelerationStructureFlags::MOTION;
    let mut array = Vec::new();
    for instance in &instances {
        array.extend(motion_instance::encode(instance).unwrap());
        array.extend([0xff; 8]);
    }
    let structure = top_level(&mut app, motion, &array, false, 3).unwrap();
    assert_eq!(structure.size, 64 + 3 * 160);
    let found = bytes(&app, &structure);
    assert!(TlasObject::read(&found).unwrap().instances().eq(instances));

    // The same by pointers, whose lowest bits are the type.
    let mut pointers = Vec::new();
    for instance in &instances {
        let address = app.upload_input(&motion_instance::encode_data(instance).unwrap()).unwrap().address.0;
        assert_eq!(address % 16, 0);
        pointers.extend((address | instance.ty().0 as u64).to_le_bytes());
    }
    let by_pointer = top_level(&mut app, motion, &pointers, true, 3).unwrap();
    assert_eq!(bytes(&app, &by_pointer), found);

    let text = stopped(top_level(&mut app, motion, &[9; 160], false, 1));
    assert!(text.contains("geometry.instances.data[0].type"), "{text}");
    let text = stopped(top_level(&mut app, motion, &[0x13, 0, 0, 0, 0, 0, 0, 0], true, 1));
    assert!(text.contains("geometry.instances.data[0].type"), "{text}");
}
