//! Laws of headers: reading and writing undo each other, and no bytes bring the reader down.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use omm_model::profile::Uuid;
use omm_serialize::header::BLOCK_TYPE_OPACITY_MICROMAP;
use omm_serialize::{
    Blob, Block, ByteOrder, Claims, DetectedOrder, Header, ReadErrorKind, References, byte_order, replace_references,
};
use proptest::prelude::*;

const ORDERS: [ByteOrder; 2] = [ByteOrder::Little, ByteOrder::Big];

fn any_order() -> impl Strategy<Value = ByteOrder> {
    (0..2_usize).prop_map(|at| ORDERS[at])
}

fn any_references() -> impl Strategy<Value = References> {
    let addresses = || prop::collection::vec(any::<u64>(), 0..5);
    let block = (prop_oneof![Just(0), any::<u32>()], any::<u32>(), addresses())
        .prop_map(|(block_type, reserved, addresses)| Block { block_type, reserved, addresses });
    prop_oneof![
        addresses().prop_map(References::Handles),
        prop::collection::vec(block, 0..4).prop_map(References::Blocks),
    ]
}

prop_compose! {
    fn any_header()(
        driver: [u8; 16],
        compatibility: [u8; 16],
        deserialized: u64,
        references in any_references(),
        payload: Vec<u8>,
    ) -> (Header, Vec<u8>) {
        let size = payload.len() as u64;
        (Header::for_payload(Uuid(driver), Uuid(compatibility), deserialized, references, size), payload)
    }
}

proptest! {
    #[test]
    fn what_is_written_reads_back((header, payload) in any_header(), order in any_order()) {
        let bytes = header.write(order, &payload);
        prop_assert_eq!(header.serialized_size, bytes.len() as u64);
        let blob = Blob::read(&bytes, order).unwrap();
        prop_assert_eq!(blob.header(), header.clone());
        prop_assert_eq!(blob.payload(), payload);
        prop_assert_eq!(blob.header_size(), header.size());
        prop_assert_eq!(byte_order::detect(&bytes), Ok(DetectedOrder::Certain(order)));
        for end in 0..bytes.len() {
            let error = Blob::read(&bytes[..end], order).unwrap_err();
            prop_assert!(error.is_truncated(), "{}", error);
        }
        let longer = [&bytes[..], &[0]].concat();
        let found = header.serialized_size;
        let error = Blob::read(&longer, order).unwrap_err();
        prop_assert_eq!((error.offset, error.kind), (32, ReadErrorKind::NotEqual { found, required: found + 1 }));
    }

    #[test]
    fn what_is_read_writes_back((header, payload) in any_header(), order in any_order(), edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..4)) {
        let mut bytes = header.write(order, &payload);
        for (at, value) in edits {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        for order in ORDERS {
            if let Ok(blob) = Blob::read(&bytes, order) {
                prop_assert_eq!(blob.header().write(order, blob.payload()), bytes.clone());
                let json = serde_json::to_string(&blob.summary()).unwrap();
                prop_assert!(!json.is_empty());
            }
        }
    }

    #[test]
    fn arbitrary_bytes_are_read_or_refused(bytes: Vec<u8>, order in any_order()) {
        if let Err(error) = Blob::read(&bytes, order) {
            prop_assert!(error.offset <= bytes.len() as u64, "{}", error);
        }
        let _ = Blob::read_detected(&bytes);
    }

    #[test]
    fn relocation_touches_references_only((header, payload) in any_header(), order in any_order(), addend: u64) {
        let mut bytes = header.write(order, &payload);
        let count = replace_references(&mut bytes, order, |address| address.wrapping_add(addend)).unwrap();
        let mut expected = header.clone();
        let mut replaced = 0;
        let mut replace = |addresses: &mut Vec<u64>| for address in addresses {
            *address = address.wrapping_add(addend);
            replaced += 1;
        };
        match &mut expected.references {
            References::Handles(handles) => replace(handles),
            References::Blocks(blocks) => blocks
                .iter_mut()
                .filter(|block| block.block_type == BLOCK_TYPE_OPACITY_MICROMAP)
                .for_each(|block| replace(&mut block.addresses)),
        }
        prop_assert_eq!(bytes, expected.write(order, &payload));
        prop_assert_eq!(count, replaced);
    }
}

/// A header in little-endian with these numbers behind the UUIDs, and zeros up to `length` bytes.
fn raw(numbers: &[u64], length: usize) -> Vec<u8> {
    let mut bytes = vec![0; 32];
    numbers.iter().for_each(|number| bytes.extend_from_slice(&number.to_le_bytes()));
    bytes.resize(length, 0);
    bytes
}

#[test]
fn claims_are_refused_by_name_and_offset() {
    let text = |numbers: &[u64], length| Blob::read(&raw(numbers, length), ByteOrder::Little).unwrap_err().to_string();
    let blocks = |count: u64| 0xffff_ffff << 32 | count;
    assert_eq!(text(&[], 31), "compatibility_uuid at byte 16: 16 bytes are needed, 15 are there");
    assert_eq!(text(&[56], 47), "deserialized_size at byte 40: 8 bytes are needed, 7 are there");
    assert_eq!(text(&[55, 0, 0], 56), "serialized_size at byte 32: found 55, required at least 56");
    assert_eq!(text(&[56, 0, 0], 57), "serialized_size at byte 32: found 56, required 57");
    assert_eq!(text(&[u64::MAX, 0, 0], 99), "payload at byte 56: 18446744073709551559 bytes are needed, 43 are there");
    assert_eq!(text(&[64, 0, 2], 64), "handle_count at byte 48: found 2, required at most 1");
    assert_eq!(text(&[72, 0, 2], 64), "handles at byte 56: 16 bytes are needed, 8 are there");
    assert_eq!(text(&[71, 0, blocks(1)], 71), "block_count at byte 48: found 1, required at most 0");
    assert_eq!(
        text(&[u64::MAX, 0, blocks(0xffff_ffff)], 56),
        "blocks[0].type at byte 56: 4 bytes are needed, 0 are there"
    );
    assert_eq!(text(&[88, 0, blocks(2), 0, 2], 88), "blocks[1].type at byte 88: 4 bytes are needed, 0 are there");
    assert_eq!(text(&[80, 0, blocks(1), 0, 2], 80), "blocks[0].count at byte 64: found 2, required at most 1");
    assert_eq!(
        text(&[u64::MAX, 0, blocks(1), 0, u64::MAX / 8 - 9], 80),
        "blocks[0].addresses at byte 72: 18446744073709551536 bytes are needed, 8 are there"
    );
}

#[test]
fn wrong_counts_can_be_written() {
    for order in ORDERS {
        let block = |addresses: &[u64]| Block { block_type: 0, reserved: 0, addresses: addresses.to_vec() };
        let references = References::Blocks(vec![block(&[1, 2]), block(&[3])]);
        let header = Header::for_payload(Uuid::default(), Uuid::default(), 0, references, 4);
        let error = |claims: Claims| {
            let bytes = header.write_claiming(&claims, order, b"body");
            Blob::read(&bytes, order).unwrap_err().to_string()
        };
        assert_eq!(header.write_claiming(&Claims::default(), order, b"body"), header.write(order, b"body"));
        let addresses = vec![None, Some(9)];
        assert_eq!(
            error(Claims { addresses, ..Claims::default() }),
            "blocks[1].count at byte 96: found 9, required at most 1"
        );
        let count = Some(0xffff_ffff_ffff_ffff);
        assert_eq!(
            error(Claims { count, ..Claims::default() }),
            "block_count at byte 48: found 4294967295, required at most 3"
        );
        let count = Some(8);
        assert_eq!(
            error(Claims { count, ..Claims::default() }),
            "handle_count at byte 48: found 8, required at most 7"
        );
    }
}

#[test]
fn unknown_block_types_are_kept() {
    let references = References::Blocks(vec![
        Block { block_type: 7, reserved: 9, addresses: vec![1, 2] },
        Block { block_type: 0, reserved: 0, addresses: vec![3] },
        Block { block_type: u32::MAX, reserved: 0, addresses: vec![] },
    ]);
    let header = Header::for_payload(Uuid::default(), Uuid::default(), 0, references, 0);
    let bytes = header.write(ByteOrder::Big, &[]);
    let blob = Blob::read(&bytes, ByteOrder::Big).unwrap();
    assert_eq!(blob.blocks().map(|block| block.block_type).collect::<Vec<_>>(), [7, 0, u32::MAX]);
    assert_eq!(blob.micromaps().collect::<Vec<_>>(), [3]);
    assert_eq!(blob.handles().count(), 0);
    let summary = serde_json::to_value(blob.summary()).unwrap();
    assert_eq!(summary["blocks"][0]["type"], 7);
    assert_eq!(summary["blocks"][0]["addresses"][1], "0x0000000000000002");
    assert_eq!(summary["byte_order"], "big");
    assert_eq!(
        (summary["kind"]["name"].as_str(), summary["kind"]["certainty"].as_str()),
        (Some("blas"), Some("certain"))
    );
}

#[test]
fn byte_orders_are_told_apart_by_size() {
    let detect = |serialized: u64, deserialized: u64, length| {
        byte_order::detect(&raw(&[serialized, deserialized], length)).unwrap()
    };
    assert_eq!(detect(80, 0, 80), DetectedOrder::Certain(ByteOrder::Little));
    assert_eq!(detect(80_u64.swap_bytes(), 0, 80), DetectedOrder::Certain(ByteOrder::Big));
    assert_eq!(detect(81, 90, 80), DetectedOrder::Likely(ByteOrder::Little));
    assert_eq!(detect(81_u64.swap_bytes(), 90_u64.swap_bytes(), 80), DetectedOrder::Likely(ByteOrder::Big));
    assert_eq!(detect(0, 0, 80), DetectedOrder::Ambiguous);
    assert_eq!(detect(0x0100_0000_0000_0001, 0, 80), DetectedOrder::Ambiguous);
    assert_eq!(DetectedOrder::Ambiguous.order(), ByteOrder::Little);
    let error = byte_order::detect(&[0; 40]).unwrap_err();
    assert_eq!(error.to_string(), "deserialized_size at byte 40: 8 bytes are needed, 0 are there");
}
