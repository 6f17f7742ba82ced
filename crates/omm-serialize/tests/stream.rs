//! Data read piece by piece comes out as data read at once: header, payload, and errors to the last letter.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use omm_model::profile::Uuid;
use omm_serialize::{Blob, Block, ByteOrder, Header, References, StreamError, StreamReader};
use proptest::prelude::*;

/// Reads `bytes` in pieces of these sizes, over and over.
fn in_pieces(bytes: &[u8], sizes: &[usize], order: ByteOrder) -> Result<(Header, Vec<u8>), String> {
    let (mut reader, mut payload, mut rest) = (StreamReader::new(order), Vec::new(), bytes);
    for &size in sizes.iter().cycle() {
        if rest.is_empty() {
            break;
        }
        let (piece, after) = rest.split_at(size.min(rest.len()));
        match reader.push(piece) {
            Ok(piece) => payload.extend_from_slice(piece),
            Err(error) => {
                assert_eq!(reader.push(after).unwrap_err(), error, "the error stays");
                assert_eq!(reader.finish().unwrap_err(), error, "the error stays");
                return Err(error.to_string());
            }
        }
        rest = after;
    }
    let header = reader.finish().map_err(|error| error.to_string())?.to_header();
    assert_eq!(reader.head().unwrap().to_header(), header);
    Ok((header, payload))
}

fn whole(bytes: &[u8], order: ByteOrder) -> Result<(Header, Vec<u8>), String> {
    let blob = Blob::read(bytes, order).map_err(|error| error.to_string())?;
    Ok((blob.header(), blob.payload().to_vec()))
}

fn any_bytes() -> impl Strategy<Value = Vec<u8>> {
    let addresses = || prop::collection::vec(any::<u64>(), 0..5);
    let block = (prop_oneof![Just(0), any::<u32>()], any::<u32>(), addresses())
        .prop_map(|(block_type, reserved, addresses)| Block { block_type, reserved, addresses });
    let references = prop_oneof![
        addresses().prop_map(References::Handles),
        prop::collection::vec(block, 0..4).prop_map(References::Blocks),
    ];
    let edits = prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..3);
    // Mostly the whole data; also cut off and too long.
    let length = prop_oneof![Just(None), any::<prop::sample::Index>().prop_map(Some)];
    (references, any::<Vec<u8>>(), any::<bool>(), edits, length).prop_map(
        |(references, payload, big, edits, length)| {
            let order = if big { ByteOrder::Big } else { ByteOrder::Little };
            let header = Header::for_payload(Uuid([1; 16]), Uuid([2; 16]), 99, references, payload.len() as u64);
            let mut bytes = header.write(order, &payload);
            for (at, value) in edits {
                let at = at.index(bytes.len());
                bytes[at] = value;
            }
            if let Some(length) = length {
                let length = length.index(bytes.len() + 9);
                bytes.resize(length, 0x55);
            }
            bytes
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn pieces_do_not_matter(
        bytes in prop_oneof![4 => any_bytes(), 1 => any::<Vec<u8>>()],
        sizes in prop::collection::vec(1..40_usize, 1..8),
        big: bool,
    ) {
        let order = if big { ByteOrder::Big } else { ByteOrder::Little };
        let expected = whole(&bytes, order);
        prop_assert_eq!(in_pieces(&bytes, &sizes, order), expected.clone());
        prop_assert_eq!(in_pieces(&bytes, &[1], order), expected.clone());
        prop_assert_eq!(in_pieces(&bytes, &[bytes.len().max(1)], order), expected.clone());
        // And through the interface of files.
        let (mut reader, mut payload) = (StreamReader::new(order), Vec::new());
        let read = reader.read_from(&bytes[..], |piece| { payload.extend_from_slice(piece); Ok(()) });
        let found = read.map(|head| head.to_header()).map_err(|error| error.to_string());
        prop_assert_eq!(found.map(|header| (header, payload)), expected);
    }
}

#[test]
fn a_malformed_field_is_refused_when_it_arrives() {
    let mut bytes = [vec![0; 32], 56_u64.to_le_bytes().to_vec()].concat();
    bytes.extend([0; 8]);
    bytes.extend(9_u64.to_le_bytes());
    let mut reader = StreamReader::new(ByteOrder::Little);
    assert_eq!(reader.push(&bytes[..55]).unwrap(), []);
    assert!(reader.head().is_none());
    let error = reader.push(&bytes[55..]).unwrap_err();
    assert_eq!(error.to_string(), "handle_count at byte 48: found 9, required at most 0");
}

#[test]
fn a_stream_that_fails_says_how_far_it_came() {
    struct Broken;
    impl std::io::Read for Broken {
        fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
            Err(std::io::Error::other("no more"))
        }
    }
    let mut reader = StreamReader::new(ByteOrder::Little);
    let input = std::io::Read::chain(&[0_u8; 20][..], Broken);
    let error = reader.read_from(input, |_| Ok(())).unwrap_err();
    assert!(matches!(error, StreamError::Io { read: 20, .. }), "{error}");
    assert_eq!(error.to_string(), "the stream ends after 20 bytes: no more");
}
