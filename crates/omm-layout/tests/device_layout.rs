//! The worked examples of `docs/device-layout.md` are what the encoders write.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use omm_layout::object::*;
use omm_layout::packed;
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::special_index::{OpacityMicromapSpecialIndex, TriangleMap};
use omm_model::vk;

/// The bytes of the example `name`: `offset: bytes | comment`, a line each.
fn example(name: &str) -> Vec<u8> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/device-layout.md");
    let page = std::fs::read_to_string(path).unwrap();
    let fence = format!("```hex {name}\n");
    let (_, block) = page.split_once(&fence).expect("the example is on the page");
    let (block, _) = block.split_once("```").unwrap();
    let mut bytes = Vec::new();
    for line in block.lines() {
        let (offset, rest) = line.split_once(": ").unwrap();
        assert_eq!(usize::from_str_radix(offset, 16), Ok(bytes.len()), "{name}: {line}");
        let digits = rest.split('|').next().unwrap().split_whitespace();
        bytes.extend(digits.map(|byte| u8::from_str_radix(byte, 16).unwrap()));
    }
    bytes
}

#[test]
fn micromap() {
    let data = |format, letters| packed::pack(format, &packed::states(letters).unwrap()).unwrap();
    let (two, four) = (OpacityMicromapFormat::TwoState, OpacityMicromapFormat::FourState);
    let (first, second) = (data(four, "TOUu"), data(two, "O"));
    let triangle = |level, format, data| MicromapTriangleData {
        subdivision_level: SubdivisionLevel::new(level).unwrap(),
        format,
        data,
    };
    let triangles = vec![triangle(1, four, &first), triangle(0, two, &second), triangle(1, four, &first)];
    let built = MicromapContents { flags: 2, triangles }.encode().unwrap();
    assert_eq!(built, example("micromap"));
    assert_eq!(compact(&built).unwrap(), example("micromap-compacted"));
}

#[test]
fn bottom_level() {
    let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let map = TriangleMap::SpecialIndex(OpacityMicromapSpecialIndex::FullyOpaque);
    let triangles = vec![None, Some(MappedTriangle { vertices, map })];
    let aabb = vk::AabbPositions { min_x: -1.0, min_y: -1.0, min_z: -1.0, max_x: 1.0, max_y: 1.0, max_z: 1.0 };
    let geometries = vec![
        BlasGeometry {
            flags: vk::GeometryFlags::OPAQUE,
            primitives: BlasPrimitives::MicromapTriangles { micromap: 0x1_0000, triangles },
        },
        BlasGeometry { flags: vk::GeometryFlags::empty(), primitives: BlasPrimitives::Aabbs(vec![Some(aabb)]) },
    ];
    let built = BlasContents { flags: 0, geometries }.encode().unwrap();
    assert_eq!(built, example("blas"));
    assert!(BlasObject::read(&built).is_ok());
}

#[test]
fn top_level() {
    let active = vk::Instance {
        transform: vk::TransformMatrix::IDENTITY,
        instance_custom_index: 7,
        mask: 0xff,
        instance_shader_binding_table_record_offset: 3,
        flags: vk::GeometryInstanceFlags::TRIANGLE_FACING_CULL_DISABLE,
        acceleration_structure_reference: 0x2_0000,
    };
    let instances = vec![active, vk::Instance::default()];
    let built = TlasContents { flags: 0, instances }.encode().unwrap();
    assert_eq!(built, example("tlas"));
    assert!(TlasObject::read(&built).is_ok());
}

#[test]
fn top_level_with_motion() {
    let mut transform_t1 = vk::TransformMatrix::IDENTITY;
    transform_t1.matrix[0][3] = 4.0;
    let moving = vk::MatrixMotionInstance {
        transform_t0: vk::TransformMatrix::IDENTITY,
        transform_t1,
        instance_custom_index: 7,
        mask: 0xff,
        instance_shader_binding_table_record_offset: 3,
        flags: vk::GeometryInstanceFlags::empty(),
        acceleration_structure_reference: 0x2_0000,
    };
    let instances = vec![vk::MotionInstanceData::MatrixMotionInstance(moving)];
    let built = MotionTlasContents { flags: 0, instances }.encode().unwrap();
    assert_eq!(built, example("tlas-motion"));
    assert!(TlasObject::read(&built).is_ok());
}
