//! Our own payload: every object survives, every lie is found.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use omm_layout::object::*;
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::profile::{DeviceProfile, Uuid};
use omm_model::special_index::TriangleMap;
use omm_model::vk;
use omm_serialize::{Blob, ByteOrder, Certainty, References, deserialize_object, serialize_object, serialized_size};
use proptest::prelude::*;

const LITTLE: ByteOrder = ByteOrder::Little;

fn micromap(triangles: usize) -> Vec<u8> {
    let triangle = MicromapTriangleData {
        subdivision_level: SubdivisionLevel::new(2).unwrap(),
        format: OpacityMicromapFormat::FourState,
        data: &[1, 2, 3, 4],
    };
    MicromapContents { flags: 2, triangles: vec![triangle; triangles] }.encode().unwrap()
}

fn blas(micromaps: &[u64]) -> Vec<u8> {
    let triangle = MappedTriangle { vertices: [[0.5; 3]; 3], map: TriangleMap::Triangle(1) };
    let geometry = |&micromap: &u64| BlasGeometry {
        flags: vk::GeometryFlags::OPAQUE,
        primitives: BlasPrimitives::MicromapTriangles { micromap, triangles: vec![Some(triangle), None] },
    };
    let mut geometries: Vec<_> = micromaps.iter().map(geometry).collect();
    let primitives = BlasPrimitives::Triangles(vec![None, Some([[1.0; 3]; 3])]);
    geometries.push(BlasGeometry { flags: vk::GeometryFlags::default(), primitives });
    BlasContents { flags: 2, geometries }.encode().unwrap()
}

fn tlas(references: &[u64]) -> Vec<u8> {
    let instance = |&acceleration_structure_reference: &u64| vk::Instance {
        acceleration_structure_reference,
        ..vk::Instance::default()
    };
    TlasContents { flags: 2, instances: references.iter().map(instance).collect() }.encode().unwrap()
}

fn serialize(object: &[u8]) -> Vec<u8> {
    let device = DeviceProfile::reference();
    serialize_object(object, device.driver_uuid, device.compatibility_uuid).unwrap()
}

/// Every byte has a name, none has two, and ours are named down to the field.
fn check_description(data: &[u8]) {
    let blob = Blob::read(data, LITTLE).unwrap();
    let (mut end, mut fields) = (0, Vec::new());
    blob.describe(&mut |field| {
        assert_eq!(field.offset, end, "{field:?}");
        assert!(field.size > 0 && !field.name.is_empty() && !field.value.is_empty(), "{field:?}");
        end += field.size;
        fields.push(field);
    });
    assert_eq!(end, data.len() as u64);
    assert!(fields.iter().all(|field| field.name != "payload"), "{fields:?}");
    let mut names: Vec<_> = fields.iter().map(|field| &field.name).collect();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), fields.len(), "names are unique");
}

fn round_trip(object: &[u8]) {
    for object in [object.to_vec(), compact(object).unwrap()] {
        let header = ObjectHeader::read(&object).unwrap();
        let data = serialize(&object);
        assert_eq!(serialized_size(&header), data.len() as u64);
        let blob = Blob::read(&data, LITTLE).unwrap();
        assert_eq!(blob.prefix().deserialized_size, header.size);
        assert_eq!(blob.kind().kind(), Some(header.kind));
        assert_eq!(blob.kind().certainty, Certainty::Certain);
        assert!(omm_serialize::compatibility(&data, &DeviceProfile::reference()));
        assert!(!omm_serialize::compatibility(&data, &DeviceProfile::minimum()));
        assert_eq!(deserialize_object(&data), Ok(object.clone()));
        check_description(&data);
        // Bytes behind the object are not serialized.
        assert_eq!(serialize(&[&object[..], &[0xcc; 40]].concat()), data);
        for end in 0..data.len() {
            assert!(deserialize_object(&data[..end]).unwrap_err().is_truncated());
        }
    }
}

#[test]
fn objects_round_trip() {
    for count in 0..4 {
        round_trip(&micromap(count));
        round_trip(&blas(&[0x100, 0, 0x200, 0x100][..count]));
        round_trip(&tlas(&[0x100, 0, 0x200, 0x100][..count]));
    }
}

#[test]
fn references_move_into_the_header() {
    let header = |object: &[u8]| Blob::read(&serialize(object), LITTLE).unwrap().header();
    assert_eq!(header(&micromap(1)).references, References::Handles(vec![]));
    assert_eq!(header(&blas(&[0])).references, References::Handles(vec![]));
    assert_eq!(header(&tlas(&[7, 0, 7])).references, References::Handles(vec![7, 7]));
    let References::Blocks(blocks) = header(&blas(&[8, 0, 9])).references else { panic!("no blocks") };
    assert_eq!((blocks.len(), blocks[0].block_type, &blocks[0].addresses[..]), (1, 0, &[8, 9][..]));
}

#[test]
fn contradictions_are_named() {
    let error = |object: &[u8], at: usize, value: u8| {
        let mut data = serialize(object);
        data[at] = value;
        deserialize_object(&data).unwrap_err().to_string()
    };
    let (leaf, card, scene) = (micromap(1), blas(&[8, 9]), tlas(&[7, 0]));
    assert_eq!(error(&leaf, 40, 1), "deserialized_size at byte 40: found 1, required 88");
    assert_eq!(error(&leaf, 56, b'x'), r#"payload.magic at byte 56: found "xmmobj02", required "ommobj02""#);
    assert_eq!(error(&leaf, 56 + 16, 87), "payload.size at byte 72: found 87, required 88");
    assert_eq!(
        error(&leaf, 56 + 64 + 8, 13),
        "payload.triangles[0].subdivision_level at byte 128: found 13, required at most 12"
    );
    // The block takes 16 + 16 bytes, so the payload begins at byte 88 and its body at byte 152.
    assert_eq!(error(&card, 56, 1), "blocks[0].type at byte 56: found 1, required 0 (opacity micromaps)");
    assert_eq!(error(&card, 88 + 36, 3), "blocks[0].count at byte 64: found 2, required 3");
    assert_eq!(
        error(&card, 152, 9),
        "payload.geometries[0].type at byte 152: found 9, required 0 (triangles) or 1 (boxes)"
    );
    assert_eq!(error(&scene, 64 + 36, 0), "handle_count at byte 48: found 1, required 0");
    assert_eq!(
        error(&scene, 64 + 64 + 56, 5),
        "payload.instances[0].reference at byte 184: found 5, required at most 0"
    );
    // A bottom-level structure that has references but a header without blocks.
    let blob = serialize(&card);
    let blob = Blob::read(&blob, LITTLE).unwrap();
    let mut header = blob.header();
    header.references = References::Handles(vec![]);
    header.serialized_size -= 32;
    let data = header.write(LITTLE, blob.payload());
    let text = deserialize_object(&data).unwrap_err().to_string();
    assert_eq!(text, "handle_count at byte 48: found 0, required a count of blocks, its high half all ones");
    // And one with two blocks.
    let References::Blocks(mut blocks) = blob.header().references else { panic!("no blocks") };
    blocks.push(blocks[0].clone());
    header.references = References::Blocks(blocks);
    header.serialized_size += 64;
    let text = deserialize_object(&header.write(LITTLE, blob.payload())).unwrap_err().to_string();
    assert_eq!(text, "block_count at byte 48: found 2, required 1");
}

#[test]
fn data_of_the_other_byte_order_is_called_that() {
    let expected = "serialized_size at byte 32: the data is big-endian, required little-endian, the order of the \
                    simulated device";
    for object in [micromap(1), blas(&[8, 9]), tlas(&[7, 0])] {
        let data = serialize(&object);
        let blob = Blob::read(&data, LITTLE).unwrap();
        let swapped = blob.header().write(ByteOrder::Big, blob.payload());
        assert_eq!(deserialize_object(&swapped).unwrap_err().to_string(), expected);
        let blob = Blob::read(&swapped, ByteOrder::Big).unwrap();
        assert_eq!(blob.to_object().unwrap_err().to_string(), expected);
        // What is wrong in either order is said of ours.
        let error = deserialize_object(&swapped[..swapped.len() - 1]).unwrap_err();
        assert_ne!(error.to_string(), expected);
    }
}

#[test]
fn a_payload_that_only_looks_like_ours_is_likely_at_best() {
    let mut data = serialize(&micromap(1));
    data[56 + 12] = 9;
    let guess = Blob::read(&data, LITTLE).unwrap().kind();
    assert_eq!((guess.name(), guess.certainty), ("micromap", Certainty::Likely));
    data[56 + 8] = 9;
    let guess = Blob::read(&data, LITTLE).unwrap().kind();
    assert_eq!((guess.name(), guess.certainty, guess.candidates.len()), ("unknown", Certainty::Unknown, 3));
}

proptest! {
    #[test]
    fn mutated_data_is_taken_or_refused(which in 0..3_usize, edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4)) {
        let mut data = serialize(&[micromap(2), blas(&[8, 9]), tlas(&[7, 0, 7])][which]);
        for (at, value) in edits {
            let at = at.index(data.len());
            data[at] = value;
        }
        match deserialize_object(&data) {
            Ok(object) => {
                // Only what the payload does not repeat may differ: the UUIDs and the reserved word.
                let blob = Blob::read(&data, LITTLE).unwrap();
                let prefix = blob.prefix();
                let again = serialize_object(&object, prefix.driver_uuid, prefix.compatibility_uuid).unwrap();
                let reserved = if which == 1 { 60..64 } else { 0..0 };
                data[reserved].fill(0);
                prop_assert_eq!(again, data);
            }
            Err(error) => prop_assert!(error.offset <= data.len() as u64, "{}", error),
        }
    }

    #[test]
    fn arbitrary_payloads_are_taken_or_refused(payload: Vec<u8>, references in prop::collection::vec(any::<u64>(), 0..3)) {
        let header = omm_serialize::Header::for_payload(
            Uuid::default(),
            Uuid::default(),
            (payload.len() + 8 * references.len()) as u64,
            References::Handles(references),
            payload.len() as u64,
        );
        prop_assert!(deserialize_object(&header.write(LITTLE, &payload)).is_err());
    }
}
