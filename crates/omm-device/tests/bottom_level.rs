//! Bottom-level builds in all their variants.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::{bottom_level, bytes, device, floats, micromap, stopped, triangles_geometry, vertices};
use omm_device::app::{App, AppError, Structure};
use omm_layout::object::{BlasObject, StoredTriangle};
use omm_layout::transform;
use omm_model::special_index::{OpacityMicromapSpecialIndex as Special, TriangleMap};
use omm_model::vk;

/// Builds one geometry and gives its active triangles.
fn build_one(
    app: &mut App<'_>,
    data: &vk::GeometryTrianglesData,
    range: vk::BuildRangeInfo,
) -> Result<Vec<StoredTriangle>, AppError> {
    let structure = build(app, data, range)?;
    let bytes = bytes(app, &structure);
    let object = BlasObject::read(&bytes).unwrap();
    assert_eq!(object.geometry(0).unwrap().primitive_count(), range.primitive_count);
    Ok(object.geometry(0).unwrap().triangles().collect())
}

fn build(
    app: &mut App<'_>,
    data: &vk::GeometryTrianglesData,
    range: vk::BuildRangeInfo,
) -> Result<Structure, AppError> {
    app.build(bottom_level(vec![triangles_geometry(data.clone())]), Some(vec![range]))
}

fn range(primitive_count: u32) -> vk::BuildRangeInfo {
    vk::BuildRangeInfo { primitive_count, ..Default::default() }
}

/// The x of each vertex of each triangle.
fn xs(triangles: &[StoredTriangle]) -> Vec<[f32; 3]> {
    triangles.iter().map(|triangle| triangle.vertices.map(|[x, ..]| x)).collect()
}

/// Vertex i is (i, 10 i, 100 i).
fn numbered(count: u16) -> Vec<f32> {
    (0..count).map(f32::from).flat_map(|x| [x, 10.0 * x, 100.0 * x]).collect()
}

#[test]
fn vertices_in_order() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let data = vertices(&mut app, &numbered(9));
    let found = build_one(&mut app, &data, range(3)).unwrap();
    assert_eq!(xs(&found), [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0], [6.0, 7.0, 8.0]]);
    assert_eq!(found[1].vertices[2], [5.0, 50.0, 500.0]);
    assert_eq!((found[2].primitive_index, found[2].map), (2, None));
    let later = vk::BuildRangeInfo { first_vertex: 2, primitive_offset: 12, ..range(2) };
    assert_eq!(xs(&build_one(&mut app, &data, later).unwrap()), [[3.0, 4.0, 5.0], [6.0, 7.0, 8.0]]);
    let beyond = vk::BuildRangeInfo { first_vertex: 1, ..range(3) };
    let why = stopped(build(&mut app, &data, beyond));
    assert!(why.contains("pInfos[0].pGeometries[0].geometry.triangles.vertexData[9]: 12 bytes from"), "{why}");
    // One vertex for all, which a stride of 0 means.
    let data = vk::GeometryTrianglesData { vertex_stride: 0, ..data };
    assert_eq!(xs(&build_one(&mut app, &data, range(20)).unwrap())[19], [0.0; 3]);
    assert_eq!(build_one(&mut app, &data, range(0)).unwrap(), []);
}

#[test]
fn vertices_by_index() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let data = vertices(&mut app, &numbered(9));
    let indices: Vec<u8> = [7_u16, 0, 1, 5, 4, 3, 2].into_iter().flat_map(u16::to_le_bytes).collect();
    let index_data = app.upload_input(&indices).unwrap().address.into();
    let short = vk::GeometryTrianglesData { index_type: vk::IndexType::UINT16, index_data, ..data.clone() };
    let from = vk::BuildRangeInfo { first_vertex: 3, primitive_offset: 2, ..range(2) };
    assert_eq!(xs(&build_one(&mut app, &short, from).unwrap()), [[3.0, 4.0, 8.0], [7.0, 6.0, 5.0]]);
    let indices: Vec<u8> = [8_u32, 8, 0, 9, 1, 2].into_iter().flat_map(u32::to_le_bytes).collect();
    let index_data = app.upload_input(&indices).unwrap().address.into();
    let long = vk::GeometryTrianglesData { index_type: vk::IndexType::UINT32, index_data, ..data };
    assert_eq!(xs(&build_one(&mut app, &long, range(1)).unwrap()), [[8.0, 8.0, 0.0]]);
    let why = stopped(build(&mut app, &long, range(2)));
    assert!(why.contains("geometry.triangles.vertexData[9]"), "{why}");
    let why = stopped(build(&mut app, &long, range(3)));
    assert!(why.contains("geometry.triangles.indexData[6]"), "{why}");
}

#[test]
fn transformed_and_two_dimensional() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let matrix = [[2.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 5.0]];
    let mut bytes = vec![0xff; 16];
    bytes.extend(transform::encode(&vk::TransformMatrix { matrix }));
    let transform_data = app.upload_input(&bytes).unwrap().address.into();
    let data = vertices(&mut app, &numbered(3));
    let data = vk::GeometryTrianglesData { vertex_format: vk::Format::R32G32_SFLOAT, transform_data, ..data };
    let at = vk::BuildRangeInfo { transform_offset: 16, ..range(1) };
    let found = build_one(&mut app, &data, at).unwrap();
    assert_eq!(found[0].vertices, [[1.0, 0.0, 5.0], [3.0, 10.0, 5.0], [5.0, 20.0, 5.0]]);
    let beyond = vk::BuildRangeInfo { transform_offset: 17, ..range(1) };
    assert!(stopped(build(&mut app, &data, beyond)).contains("triangles.transformData: 48 bytes from"));
}

#[test]
fn inactive_triangles_keep_their_place() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let mut positions = numbered(9);
    positions[3 * 4] = f32::from_bits(0xffc0_1234);
    let data = vertices(&mut app, &positions);
    let found = build_one(&mut app, &data, range(3)).unwrap();
    assert_eq!(found.iter().map(|triangle| triangle.primitive_index).collect::<Vec<_>>(), [0, 2]);
    positions[3 * 6 + 2] = f32::NAN;
    let data = vertices(&mut app, &positions);
    let why = stopped(build(&mut app, &data, range(3)));
    assert!(why.ends_with("vertexData[6]: component 2 is not a number though the first component is"), "{why}");
}

#[test]
fn boxes() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let mut numbers = vec![9.0; 2];
    for x in [1.0, f32::NAN, 3.0] {
        numbers.extend([x, 0.0, 0.0, x + 1.0, 1.0, 1.0, 7.0, 7.0]);
    }
    let address = app.upload_input(&floats(&numbers)).unwrap().address;
    let aabbs = vk::GeometryAabbsData { data: address.into(), stride: 32, ..Default::default() };
    let geometry = vk::Geometry {
        geometry_type: vk::GeometryType::AABBS,
        geometry: vk::GeometryData::Aabbs(aabbs),
        flags: vk::GeometryFlags::OPAQUE,
        ..Default::default()
    };
    let range = vk::BuildRangeInfo { primitive_offset: 8, ..range(3) };
    let structure = app.build(bottom_level(vec![geometry.clone(), geometry]), Some(vec![range; 2])).unwrap();
    let bytes = bytes(&app, &structure);
    let object = BlasObject::read(&bytes).unwrap();
    assert_eq!(object.geometry_count(), 2);
    for geometry in object.geometries() {
        assert_eq!((geometry.flags(), geometry.primitive_count()), (vk::GeometryFlags::OPAQUE, 3));
        let found: Vec<_> = geometry.aabbs().map(|aabb| (aabb.primitive_index, aabb.positions.min_x)).collect();
        assert_eq!(found, [(0, 1.0), (2, 3.0)]);
    }
}

/// Builds three triangles with a micromap attached.
fn maps(app: &mut App<'_>, attached: vk::TrianglesOpacityMicromap) -> Result<Vec<Option<TriangleMap>>, AppError> {
    let data = vertices(app, &numbered(9));
    let data = vk::GeometryTrianglesData { next: vec![attached.into()], ..data };
    Ok(build_one(app, &data, range(3))?.into_iter().map(|triangle| triangle.map).collect())
}

#[test]
fn micromap_indices_of_every_type() {
    use TriangleMap::{SpecialIndex, Triangle};
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let micromap = micromap(&mut app).handle;
    let attached = |index_type, index_buffer, index_stride| vk::TrianglesOpacityMicromap {
        index_type,
        index_buffer,
        index_stride,
        micromap,
        ..Default::default()
    };
    let none = attached(vk::IndexType::NONE, vk::DeviceAddress::NULL, 0);
    assert_eq!(maps(&mut app, none.clone()).unwrap(), [0, 1, 2].map(|index| Some(Triangle(index))));
    let from_one = vk::TrianglesOpacityMicromap { base_triangle: 1, ..none.clone() };
    assert_eq!(maps(&mut app, from_one).unwrap(), [1, 2, 3].map(|index| Some(Triangle(index))));

    let opaque = Some(SpecialIndex(Special::FullyOpaque));
    let unknown = Some(SpecialIndex(Special::FullyUnknownOpaque));
    let wide = [2, u32::MAX - 1, u32::MAX - 3];
    let types = [(vk::IndexType::UINT8, 1), (vk::IndexType::UINT16, 2), (vk::IndexType::UINT32, 4)];
    for (index_type, size) in types {
        for gap in [0, size] {
            let entry = |value: u32| [value.to_le_bytes()[..size].to_vec(), vec![0x55; gap]].concat();
            let bytes: Vec<u8> = wide.into_iter().flat_map(entry).collect();
            // Cut behind the last index: what lies between indices is not needed there.
            let buffer = app.upload_input(&bytes[..bytes.len() - gap]).unwrap();
            let attached = vk::TrianglesOpacityMicromap {
                base_triangle: 1,
                ..attached(index_type, buffer.address, (size + gap) as u64)
            };
            assert_eq!(maps(&mut app, attached.clone()).unwrap(), [Some(Triangle(3)), opaque, unknown]);
            let same = vk::TrianglesOpacityMicromap { index_stride: 0, ..attached.clone() };
            assert_eq!(maps(&mut app, same).unwrap(), [Some(Triangle(3)); 3]);
            let beyond = vk::TrianglesOpacityMicromap { base_triangle: 2, ..attached.clone() };
            let why = stopped_maps(maps(&mut app, beyond));
            let at = "triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapKHR>.indexBuffer[0]";
            assert!(
                why.ends_with(&format!("{at}: 2 plus baseTriangle 2 is beyond the micromap's 4 triangles")),
                "{why}"
            );
            let null = vk::TrianglesOpacityMicromap { micromap: vk::AccelerationStructure::NULL, ..attached };
            let why = stopped_maps(maps(&mut app, null));
            assert!(why.contains("indexBuffer[0]: 2 is no special index, and there is no micromap"), "{why}");
        }
    }
}

fn stopped_maps(result: Result<Vec<Option<TriangleMap>>, AppError>) -> String {
    match result.unwrap_err() {
        AppError::Undefined(undefined) => undefined.to_string(),
        other => panic!("{other}"),
    }
}

#[test]
fn a_null_micromap_has_special_indices_only() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let buffer = app.upload_input(&[255, 253, 254]).unwrap();
    let attached = vk::TrianglesOpacityMicromap {
        index_type: vk::IndexType::UINT8,
        index_buffer: buffer.address,
        index_stride: 1,
        base_triangle: 77,
        ..Default::default()
    };
    let found = [Special::FullyTransparent, Special::FullyUnknownTransparent, Special::FullyOpaque];
    assert_eq!(maps(&mut app, attached.clone()).unwrap(), found.map(|index| Some(TriangleMap::SpecialIndex(index))));
    app.destroy(buffer).unwrap();
    // -5 is special to nobody.
    let buffer = app.upload_input(&[255, 251, 254]).unwrap();
    let attached = vk::TrianglesOpacityMicromap { index_buffer: buffer.address, ..attached };
    let why = stopped_maps(maps(&mut app, attached));
    assert!(why.contains("indexBuffer[1]: 251 is no special index"), "{why}");
}
