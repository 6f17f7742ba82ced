//! Every field of every structure is refused by name and offset when it is wrong.

use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::special_index::TriangleMap;
use omm_model::vk;

use super::*;

fn micromap() -> Vec<u8> {
    let triangle = |level, data| MicromapTriangleData {
        subdivision_level: SubdivisionLevel::new(level).unwrap(),
        format: OpacityMicromapFormat::TwoState,
        data,
    };
    MicromapContents { flags: 0, triangles: vec![triangle(1, &[7]), triangle(3, &[9; 8]), triangle(1, &[7])] }
        .encode()
        .unwrap()
}

fn blas() -> Vec<u8> {
    let triangle = MappedTriangle { vertices: [[0.0; 3]; 3], map: TriangleMap::Triangle(3) };
    let triangles = vec![None, Some(triangle), Some(triangle)];
    let primitives = BlasPrimitives::MicromapTriangles { micromap: 0x100, triangles };
    let boxes = BlasPrimitives::Aabbs(vec![None]);
    let geometry = |primitives| BlasGeometry { flags: vk::GeometryFlags::default(), primitives };
    BlasContents { flags: 0, geometries: vec![geometry(primitives), geometry(boxes)] }.encode().unwrap()
}

fn tlas() -> Vec<u8> {
    let instance =
        |acceleration_structure_reference| vk::Instance { acceleration_structure_reference, ..vk::Instance::default() };
    TlasContents { flags: 0, instances: vec![instance(0x100), instance(0), instance(0x100)] }.encode().unwrap()
}

/// The error of an object whose byte at `at` was replaced.
fn error(mut bytes: Vec<u8>, at: usize, value: u8) -> String {
    bytes[at] = value;
    match Object::read(&bytes) {
        Ok(_) => panic!("byte {at} = {value} was not noticed"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn headers() {
    let error = |at, value| error(micromap(), at, value);
    assert_eq!(error(7, b'1'), r#"magic at byte 0: found "ommobj01", required "ommobj02""#);
    assert_eq!(error(8, 4), "kind at byte 8: found 4, required 1, 2 or 3");
    assert_eq!(error(12, 2), "form at byte 12: found 2, required 0 (built) or 1 (compacted)");
    assert_eq!(error(12, 1), "compacted_size at byte 24: found 121, required 136");
    assert_eq!(error(16, 63), "size at byte 16: found 63, required at least 64");
    assert_eq!(error(17, 1), "object at byte 0: 392 bytes are needed, 136 are there");
    assert_eq!(error(24, 137), "compacted_size at byte 24: found 137, required at most 136");
    assert_eq!(error(36, 1), "reference_count at byte 36: found 1, required 0");
    assert_eq!(error(43, 1), "primitive_count at byte 40: found 16777219, required at most 4");
    assert_eq!(error(48, 1), "geometry_count at byte 48: found 1, required 0");
    assert_eq!(error(52, 1), "reserved0 at byte 52: found 1, required 0");
    assert_eq!(error(63, 1), "reserved1 at byte 56: found 72057594037927936, required 0");
    assert_eq!(error(16, 123), "triangles[1].data_end at byte 80: found 16, required at most 11");
    let other = BlasObject::read(&micromap()).unwrap_err();
    assert_eq!(other.to_string(), "kind at byte 8: found 1, required 2");
}

#[test]
fn micromaps() {
    let error = |at, value| error(micromap(), at, value);
    assert_eq!(error(64, 8), "triangles[0].data_offset at byte 64: found 8, required 0");
    assert_eq!(error(80, 0), "triangles[1].data_offset at byte 80: found 0, required 8");
    assert_eq!(error(72, 13), "triangles[0].subdivision_level at byte 72: found 13, required at most 12");
    assert_eq!(error(90, 0), "triangles[1].format at byte 90: found 0, required 1 (2-state) or 2 (4-state)");
    assert_eq!(error(108, 1), "triangles[2].reserved at byte 108: found 1, required 0");
    assert_eq!(error(88, 12), "triangles[1].data_end at byte 80: found 2097160, required at most 24");
    assert_eq!(error(112, 0x17), "triangles[0].unused_bits at byte 112: found 16, required 0");
    assert_eq!(error(119, 1), "triangles[0].data_padding at byte 119: found 1, required 0");
    let compacted = compact(&micromap()).unwrap();
    assert_eq!(compacted.len(), 64 + 48 + 9);
    let error = |at, value| super::tests::error(compacted.clone(), at, value);
    assert_eq!(error(96, 9), "triangles[2].data_end at byte 96: found 10, required at most 9");
    assert_eq!(error(80, 2), "triangles[1].data_offset at byte 80: found 2, required 1");
    assert_eq!(error(104, 4), "triangles[2].data_end at byte 96: found 32, required at most 9");
}

#[test]
fn bottom_level_structures() {
    let error = |at, value| error(blas(), at, value);
    assert_eq!(error(72, 2), "geometries[0].type at byte 72: found 2, required 0 (triangles) or 1 (boxes)");
    assert_eq!(
        error(72, 1),
        "geometries[0].micromap at byte 88: found 0, required no micromap (4294967295), these being boxes"
    );
    assert_eq!(error(84, 2), "geometries[0].stored_count at byte 84: found 2, required 3");
    assert_eq!(error(88, 1), "geometries[0].micromap at byte 88: found 1, required at most 0");
    assert_eq!(error(92, 2), "geometries[0].motion at byte 92: found 2, required 0 (none) or 1 (vertices at time 1)");
    assert_eq!(error(92, 1), "geometries[0].data_end at byte 96: found 240, required at most 160");
    assert_eq!(error(124, 1), "geometries[1].motion at byte 124: found 1, required 0 (none), these being boxes");
    assert_eq!(error(96, 4), "geometries[0].data_offset at byte 96: found 4, required 0");
    assert_eq!(error(48, 9), "geometry_count at byte 48: found 9, required at most 7");
    assert_eq!(error(40, 5), "primitive_count at byte 40: found 5, required 4");
    assert_eq!(error(136, 1), "geometries[0].primitives[0].index at byte 136: found 4294967041, required 0");
    assert_eq!(error(141, 1), "geometries[0].primitives[0].payload at byte 141: found 1, required 0");
    assert_eq!(error(180, 2), "geometries[0].primitives[1].index at byte 180: found 2, required 1");
    assert_eq!(
        error(223, 0xff),
        "geometries[0].primitives[1].map at byte 220: found -16777213, required -4 to -1 or an index"
    );
    let compacted = compact(&blas()).unwrap();
    assert_eq!(compacted.len(), 64 + 8 + 64 + 88);
    let error = |at, value| super::tests::error(compacted.clone(), at, value);
    assert_eq!(error(136, 2), "geometries[0].primitives[1].index at byte 180: found 2, required at least 3");
    assert_eq!(error(180, 3), "geometries[0].primitives[1].index at byte 180: found 3, required at most 2");
    assert_eq!(error(84, 4), "geometries[0].stored_count at byte 84: found 4, required at most 3");
    assert_eq!(error(84, 3), "geometries[0].data_end at byte 96: found 132, required at most 88");
}

#[test]
fn top_level_structures() {
    let bytes = tlas();
    assert_eq!(references(&bytes).unwrap().collect::<Vec<_>>(), [0x100, 0x100]);
    let error = |at, value| error(bytes.clone(), at, value);
    assert_eq!(error(136, 2), "instances[0].reference at byte 136: found 2, required at most 1");
    assert_eq!(error(140, 2), "instances[0].active at byte 140: found 2, required 0 (inactive) or 1 (active)");
    assert_eq!(error(200, 1), "instances[1].reference at byte 200: found 1, required 0");
    assert_eq!(error(279, 1), "padding at byte 279: found 1, required 0");
    assert_eq!(error(40, 4), "primitive_count at byte 40: found 4, required at most 3");
    assert_eq!(error(32, 32), "primitive_count at byte 40: found 3, required at most 1");
    let compacted = compact(&bytes).unwrap();
    assert_eq!(references(&compacted).unwrap().collect::<Vec<_>>(), [0x100]);
    let error = super::tests::error(compacted, 40, 2);
    assert_eq!(error, "size at byte 16: found 264, required at most 200");
}

#[test]
fn top_level_structures_with_motion() {
    let moving = vk::MatrixMotionInstance { acceleration_structure_reference: 0x100, ..Default::default() };
    let instances = vec![vk::MotionInstanceData::MatrixMotionInstance(moving), vk::MotionInstanceData::default()];
    let bytes = MotionTlasContents { flags: 0, instances }.encode().unwrap();
    assert_eq!(ObjectHeader::read(&bytes).unwrap().flags, vk::BuildAccelerationStructureFlags::MOTION.bits());
    let error = |at, value| error(bytes.clone(), at, value);
    let found = error(72, 3);
    assert_eq!(
        found,
        "instances[0].type at byte 72: found 3, required 0 (static), 1 (matrix motion) or 2 (SRT motion)"
    );
    assert_eq!(error(76, 1), "instances[0].flags at byte 76: found 1, required 0");
    assert_eq!(error(184, 1), "instances[0].reference at byte 184: found 1, required at most 0");
    assert_eq!(error(188, 2), "instances[0].active at byte 188: found 2, required 0 (inactive) or 1 (active)");
    assert_eq!(error(192, 1), "instances[0].reserved at byte 192: found 1, required 0");
    assert_eq!(error(300, 1), "instances[1].reserved at byte 300: found 1, required 0");
    assert_eq!(error(40, 3), "primitive_count at byte 40: found 3, required at most 2");
}
