//! Laws of built objects: what is written reads back, what is compacted stays the same, and no bytes bring a reader down.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use omm_layout::object::*;
use omm_layout::{instance, motion_instance, packed};
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;
use omm_model::special_index::{OpacityMicromapSpecialIndex, TriangleMap};
use omm_model::vk;
use proptest::prelude::*;

/// A micromap triangle that owns its elements.
#[derive(Clone, Debug)]
struct Owned {
    level: SubdivisionLevel,
    format: OpacityMicromapFormat,
    data: Vec<u8>,
}

fn contents(flags: u32, triangles: &[Owned]) -> MicromapContents<'_> {
    let triangles = triangles
        .iter()
        .map(|t| MicromapTriangleData { subdivision_level: t.level, format: t.format, data: &t.data })
        .collect();
    MicromapContents { flags, triangles }
}

fn any_triangle() -> impl Strategy<Value = Owned> {
    (0..=4_u32, 0..2_usize, any::<u64>()).prop_map(|(level, format, seed)| {
        let (level, format) = (SubdivisionLevel::new(level).unwrap(), OpacityMicromapFormat::ALL[format]);
        // Few distinct patterns, so that some triangles are identical.
        let states: Vec<_> = (0..level.microtriangles())
            .map(|index| OpacityState::from_value((seed >> (index % 2)) as u8 & ((1 << format.bits()) - 1)).unwrap())
            .collect();
        Owned { level, format, data: packed::pack(format, &states).unwrap() }
    })
}

fn any_vertices() -> impl Strategy<Value = TriangleVertices> {
    // Finite, so that equality is reflexive.
    prop::array::uniform3(prop::array::uniform3(-1e6_f32..1e6))
}

fn any_map() -> impl Strategy<Value = TriangleMap> {
    let special = (0..4_usize).prop_map(|at| TriangleMap::SpecialIndex(OpacityMicromapSpecialIndex::ALL[at]));
    prop_oneof![special, (0..=i32::MAX as u32).prop_map(TriangleMap::Triangle)]
}

fn any_geometry() -> impl Strategy<Value = BlasGeometry> {
    let triangles = prop::collection::vec(prop::option::of(any_vertices()), 0..6).prop_map(BlasPrimitives::Triangles);
    let mapped = (any_vertices(), any_map()).prop_map(|(vertices, map)| MappedTriangle { vertices, map });
    let mapped = (prop_oneof![Just(0), any::<u64>()], prop::collection::vec(prop::option::of(mapped), 0..6))
        .prop_map(|(micromap, triangles)| BlasPrimitives::MicromapTriangles { micromap, triangles });
    let vertices = || [any_vertices(), any_vertices()];
    let moving = prop::collection::vec(prop::option::of(vertices()), 0..6).prop_map(BlasPrimitives::MovingTriangles);
    let moving_mapped = (vertices(), any_map()).prop_map(|(vertices, map)| MovingMappedTriangle { vertices, map });
    let moving_mapped =
        (prop_oneof![Just(0), any::<u64>()], prop::collection::vec(prop::option::of(moving_mapped), 0..6))
            .prop_map(|(micromap, triangles)| BlasPrimitives::MovingMicromapTriangles { micromap, triangles });
    let aabb = prop::array::uniform6(-1e6_f32..1e6).prop_map(|[min_x, min_y, min_z, max_x, max_y, max_z]| {
        vk::AabbPositions { min_x, min_y, min_z, max_x, max_y, max_z }
    });
    let aabbs = prop::collection::vec(prop::option::of(aabb), 0..6).prop_map(BlasPrimitives::Aabbs);
    (any::<u32>(), prop_oneof![triangles, mapped, moving, moving_mapped, aabbs])
        .prop_map(|(flags, primitives)| BlasGeometry { flags: vk::GeometryFlags::from_bits_retain(flags), primitives })
}

fn any_blas() -> impl Strategy<Value = BlasContents> {
    (any::<u32>(), prop::collection::vec(any_geometry(), 0..5))
        .prop_map(|(flags, geometries)| BlasContents { flags, geometries })
}

fn any_instance() -> impl Strategy<Value = vk::Instance> {
    let matrix = prop::array::uniform3(prop::array::uniform4(-1e6_f32..1e6));
    (matrix, 0..1_u32 << 24, any::<u8>(), 0..1_u32 << 24, any::<u8>(), 0..4_u64).prop_map(
        |(matrix, instance_custom_index, mask, offset, flags, reference)| vk::Instance {
            transform: vk::TransformMatrix { matrix },
            instance_custom_index,
            mask,
            instance_shader_binding_table_record_offset: offset,
            flags: vk::GeometryInstanceFlags::from_bits_retain(flags.into()),
            acceleration_structure_reference: reference * 0x1_0000_0100,
        },
    )
}

fn any_tlas() -> impl Strategy<Value = TlasContents> {
    (any::<u32>(), prop::collection::vec(any_instance(), 0..8))
        .prop_map(|(flags, instances)| TlasContents { flags, instances })
}

fn any_motion_tlas() -> impl Strategy<Value = MotionTlasContents> {
    let numbers = prop::array::uniform32(-1e6_f32..1e6);
    let moving = (0..3_i32, any_instance(), numbers).prop_map(|(ty, instance, numbers)| {
        // The transformations come first in each structure, in whatever parts.
        let numbers = numbers.iter().flat_map(|number| number.to_le_bytes());
        let tail = instance::encode(&instance).unwrap()[48..].to_vec();
        let ty = vk::MotionInstanceType(ty);
        let size = motion_instance::data_size(ty).unwrap();
        let bytes: Vec<u8> = numbers.take(size - 16).chain(tail).collect();
        motion_instance::read_data(ty, &bytes).unwrap()
    });
    (any::<u32>(), prop::collection::vec(moving, 0..6)).prop_map(|(flags, instances)| {
        let motion = vk::BuildAccelerationStructureFlags::MOTION.bits();
        MotionTlasContents { flags: flags | motion, instances }
    })
}

/// The primitives of a geometry as a build would collect them.
fn primitives(view: &GeometryView<'_>) -> BlasPrimitives {
    let all = 0..view.primitive_count();
    match (view.kind(), view.micromap()) {
        (GeometryKind::Aabbs, _) => BlasPrimitives::Aabbs(all.map(|at| Some(view.aabb(at)?.positions)).collect()),
        (GeometryKind::Triangles, None) if view.has_motion() => {
            let moving = |at| view.triangle(at).map(|triangle| [triangle.vertices, triangle.vertices_t1.unwrap()]);
            BlasPrimitives::MovingTriangles(all.map(moving).collect())
        }
        (GeometryKind::Triangles, Some(micromap)) if view.has_motion() => {
            let moving = |at| {
                let triangle = view.triangle(at)?;
                let vertices = [triangle.vertices, triangle.vertices_t1.unwrap()];
                Some(MovingMappedTriangle { vertices, map: triangle.map.unwrap() })
            };
            BlasPrimitives::MovingMicromapTriangles { micromap, triangles: all.map(moving).collect() }
        }
        (GeometryKind::Triangles, None) => {
            BlasPrimitives::Triangles(all.map(|at| Some(view.triangle(at)?.vertices)).collect())
        }
        (GeometryKind::Triangles, Some(micromap)) => {
            let mapped = |at| {
                let triangle = view.triangle(at)?;
                Some(MappedTriangle { vertices: triangle.vertices, map: triangle.map.unwrap() })
            };
            BlasPrimitives::MicromapTriangles { micromap, triangles: all.map(mapped).collect() }
        }
    }
}

fn blas_contents(object: &BlasObject<'_>) -> BlasContents {
    let geometry = |view: GeometryView<'_>| BlasGeometry { flags: view.flags(), primitives: primitives(&view) };
    BlasContents { flags: object.header().flags, geometries: object.geometries().map(geometry).collect() }
}

fn sizes(contents: &BlasContents) -> Vec<BlasGeometrySize> {
    let triangles =
        |count: usize, micromap, motion| BlasGeometrySize::Triangles { count: count as u32, micromap, motion };
    let size = |geometry: &BlasGeometry| match &geometry.primitives {
        BlasPrimitives::Triangles(list) => triangles(list.len(), false, false),
        BlasPrimitives::MicromapTriangles { triangles: list, .. } => triangles(list.len(), true, false),
        BlasPrimitives::MovingTriangles(list) => triangles(list.len(), false, true),
        BlasPrimitives::MovingMicromapTriangles { triangles: list, .. } => triangles(list.len(), true, true),
        BlasPrimitives::Aabbs(aabbs) => BlasGeometrySize::Aabbs { count: aabbs.len() as u32 },
    };
    contents.geometries.iter().map(size).collect()
}

/// What holds for every built object and its compacted form.
fn check_sizes(built: &[u8], compacted: &[u8]) -> Result<(), TestCaseError> {
    let header = ObjectHeader::read(built).unwrap();
    prop_assert_eq!((header.form, header.size), (ObjectForm::Built, built.len() as u64));
    prop_assert_eq!(header.compacted_size, compacted.len() as u64);
    prop_assert!(compacted.len() <= built.len());
    let header = ObjectHeader::read(compacted).unwrap();
    prop_assert_eq!((header.form, header.size), (ObjectForm::Compacted, compacted.len() as u64));
    prop_assert_eq!(compact(compacted).unwrap(), compacted);
    // Bytes behind the object are not looked at.
    let longer = [built, &[0xff; 9]].concat();
    prop_assert_eq!(Object::read(&longer).unwrap().as_bytes(), built);
    for object in [built, compacted] {
        let mut next = 0;
        Object::read(object).unwrap().describe(&mut |field| {
            assert_eq!(field.offset, next, "{field:?}");
            assert!(field.size > 0, "{field:?}");
            next += field.size;
        });
        prop_assert_eq!(next, object.len() as u64);
    }
    for end in [0, 1, 63, 64.min(built.len() - 1), built.len() - 1] {
        let error = Object::read(&built[..end]).unwrap_err();
        prop_assert!(error.is_truncated(), "{}", error);
    }
    Ok(())
}

fn check_tlas(built: &[u8], flags: u32, instances: Vec<vk::MotionInstanceData>) -> Result<(), TestCaseError> {
    let object = TlasObject::read(built).unwrap();
    prop_assert_eq!(object.instances().collect::<Vec<_>>(), instances.clone());
    let flags = vk::BuildAccelerationStructureFlags::from_bits_retain(flags);
    prop_assert_eq!((object.header().flags, object.instance_count()), (flags.bits(), instances.len() as u32));
    prop_assert_eq!(tlas_size(instances.len() as u32, flags), built.len() as u64);
    let compacted = object.compact();
    let object = TlasObject::read(&compacted).unwrap();
    prop_assert_eq!(object.instances().collect::<Vec<_>>(), instances);
    let references: Vec<_> = object.references().collect();
    let mut unique = references.clone();
    unique.sort_unstable();
    unique.dedup();
    prop_assert_eq!(unique.len(), references.len());
    check_sizes(built, &compacted)
}

/// Reads everything that a view offers.
fn exhaust(object: &Object<'_>) -> usize {
    match object {
        Object::Micromap(object) => {
            let states = (0..object.triangle_count()).filter_map(|at| object.state(at, 0)).count();
            assert_eq!(states, object.triangle_count() as usize);
            object.triangles().map(|triangle| triangle.data.len()).sum::<usize>() + object.usage().len()
        }
        Object::BottomLevel(object) => object
            .geometries()
            .map(|view| {
                view.triangles().filter(|t| view.triangle(t.primitive_index).is_some()).count() + view.aabbs().count()
            })
            .sum(),
        Object::TopLevel(object) => object.instances().count(),
    }
}

proptest! {
    #[test]
    fn micromaps_round_trip(flags: u32, triangles in prop::collection::vec(any_triangle(), 0..12)) {
        let contents = contents(flags, &triangles);
        let built = contents.encode().unwrap();
        let object = MicromapObject::read(&built).unwrap();
        prop_assert_eq!(object.contents(), contents.clone());
        prop_assert_eq!(micromap_size(&object.usage()), Some(built.len() as u64));
        let compacted = object.compact();
        let object = MicromapObject::read(&compacted).unwrap();
        prop_assert_eq!(object.contents(), contents);
        check_sizes(&built, &compacted)?;
    }

    #[test]
    fn bottom_level_structures_round_trip(contents in any_blas()) {
        let built = contents.encode().unwrap();
        let object = BlasObject::read(&built).unwrap();
        prop_assert_eq!(blas_contents(&object), contents.clone());
        prop_assert_eq!(blas_size(sizes(&contents)), Some(built.len() as u64));
        let compacted = object.compact();
        let object = BlasObject::read(&compacted).unwrap();
        prop_assert_eq!(blas_contents(&object), contents);
        check_sizes(&built, &compacted)?;
    }

    #[test]
    fn top_level_structures_round_trip(contents in any_tlas(), moving in any_motion_tlas()) {
        let built = contents.encode().unwrap();
        let instances = contents.instances.into_iter().map(vk::MotionInstanceData::StaticInstance).collect();
        check_tlas(&built, contents.flags, instances)?;
        check_tlas(&moving.encode().unwrap(), moving.flags, moving.instances)?;
    }

    #[test]
    fn references_are_replaced_in_place(contents in any_tlas(), addend: u64) {
        let mut bytes = contents.encode().unwrap();
        let before: Vec<_> = references(&bytes).unwrap().collect();
        let count = replace_references(&mut bytes, |address| address.wrapping_add(addend)).unwrap();
        prop_assert_eq!(count, before.len());
        let after: Vec<_> = references(&bytes).unwrap().collect();
        prop_assert_eq!(after, before.iter().map(|address| address.wrapping_add(addend)).collect::<Vec<_>>());
        replace_references(&mut bytes, |address| address.wrapping_sub(addend)).unwrap();
        prop_assert_eq!(bytes, contents.encode().unwrap());
    }

    #[test]
    fn arbitrary_bytes_are_read_or_refused(kind in 1..4_u8, form in 0..2_u8, tail: Vec<u8>) {
        let mut bytes = ObjectHeader {
            kind: ObjectKind::Micromap,
            form: ObjectForm::Built,
            size: 64 + tail.len() as u64,
            compacted_size: 64 + tail.len() as u64,
            flags: 0,
            reference_count: 0,
            primitive_count: tail.first().copied().unwrap_or(0).into(),
            geometry_count: 0,
        }.to_bytes().to_vec();
        (bytes[8], bytes[12]) = (kind, form);
        bytes.extend_from_slice(&tail);
        if let Ok(object) = Object::read(&bytes) {
            exhaust(&object);
            prop_assert!(object.compact().len() <= bytes.len());
        }
        let _ = Object::read(&tail);
    }

    #[test]
    fn mutated_objects_are_read_or_refused(
        triangles in prop::collection::vec(any_triangle(), 0..4),
        blas in any_blas(),
        tlas in any_tlas(),
        which in 0..6_usize,
        edits in prop::collection::vec((any::<prop::sample::Index>(), prop_oneof![any::<u8>(), Just(0), Just(0xff), Just(1)]), 1..4),
    ) {
        let built = match which % 3 {
            0 => contents(1, &triangles).encode().unwrap(),
            1 => blas.encode().unwrap(),
            _ => tlas.encode().unwrap(),
        };
        let mut bytes = if which < 3 { built } else { compact(&built).unwrap() };
        for (at, value) in edits {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        match Object::read(&bytes) {
            Ok(object) => {
                exhaust(&object);
                let compacted = object.compact();
                prop_assert!(compacted.len() <= bytes.len());
                // What one reader accepts in one form, it accepts in the other.
                Object::read(&compacted).unwrap();
            }
            Err(error) => prop_assert!(error.offset <= bytes.len() as u64, "{}", error),
        }
    }
}

#[test]
fn unused_bits_are_cleared_and_identical_blocks_merge() {
    let level = SubdivisionLevel::ZERO;
    let triangle =
        |data| MicromapTriangleData { subdivision_level: level, format: OpacityMicromapFormat::TwoState, data };
    let contents = MicromapContents { flags: 0, triangles: vec![triangle(&[0xff]), triangle(&[0x01])] };
    let built = contents.encode().unwrap();
    let object = MicromapObject::read(&built).unwrap();
    assert_eq!(object.triangle(0), object.triangle(1));
    assert_eq!(object.state(0, 0), Some(OpacityState::Opaque));
    assert_eq!((object.state(0, 1), object.state(2, 0)), (None, None));
    assert_eq!(object.compact().len(), 64 + 2 * 16 + 1);
}

#[test]
fn contents_that_do_not_fit_are_named() {
    let format = OpacityMicromapFormat::FourState;
    let triangle = MicromapTriangleData { subdivision_level: SubdivisionLevel::MAX, format, data: &[0; 3] };
    let error = MicromapContents { flags: 0, triangles: vec![triangle] }.encode().unwrap_err();
    assert_eq!(error.to_string(), "triangles[0].data: found 3, required 4194304");

    let map = TriangleMap::Triangle(1 << 31);
    let triangles = vec![None, Some(MappedTriangle { vertices: [[0.0; 3]; 3], map })];
    let primitives = BlasPrimitives::MicromapTriangles { micromap: 0, triangles };
    let geometry = BlasGeometry { flags: vk::GeometryFlags::default(), primitives };
    let error = BlasContents { flags: 0, geometries: vec![geometry] }.encode().unwrap_err();
    assert_eq!(error.to_string(), "geometries[0].triangles[1].map: found 2147483648, room for at most 2147483647");

    let instance = vk::Instance { instance_custom_index: u32::MAX, ..vk::Instance::default() };
    let error = TlasContents { flags: 0, instances: vec![instance] }.encode().unwrap_err();
    assert_eq!(error.to_string(), "instances[0].instance_custom_index: found 4294967295, room for at most 16777215");
}

#[test]
fn sizes_are_checked() {
    let usage = |count| omm_model::usage::MicromapUsage {
        count,
        subdivision_level: SubdivisionLevel::MAX,
        format: OpacityMicromapFormat::FourState,
    };
    assert_eq!(micromap_size(&[usage(u32::MAX)]), Some(64 + (16 + (1 << 22)) * u64::from(u32::MAX)));
    assert_eq!(micromap_size(&vec![usage(u32::MAX); 1025]), None);
    assert_eq!(blas_size([]), Some(64));
    assert_eq!(blas_size([BlasGeometrySize::Aabbs { count: u32::MAX }]), Some(96 + 28 * u64::from(u32::MAX)));
    let flags = vk::BuildAccelerationStructureFlags::MOTION;
    assert_eq!(tlas_size(u32::MAX, !flags), 64 + 72 * u64::from(u32::MAX));
    assert_eq!(tlas_size(u32::MAX, flags), 64 + 160 * u64::from(u32::MAX));
}
