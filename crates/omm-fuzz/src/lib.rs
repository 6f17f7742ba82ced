//! The bodies of fuzz targets, as plain functions that take any bytes; ordinary tests run them over seeds and mutations of seeds.
//!
//! Each is an equality or holds two readers against each other, and panics where they disagree: that is how a fuzzer is told.
//!
//! ```
//! let seeds = omm_fuzz::seeds();
//! for (name, body) in omm_fuzz::TARGETS {
//!     seeds.iter().for_each(|seed| body(seed));
//!     println!("{name}: {} seeds", seeds.len());
//! }
//! ```
// A finding is told by a panic.
#![allow(clippy::panic)]

use arbitrary::{Arbitrary, Unstructured};
use omm_layout::object::Object;
use omm_layout::packed::{self, PackedStates};
use omm_model::format::OpacityMicromapFormat;
use omm_model::opacity::OpacityState;
use omm_model::profile::Uuid;
use omm_serialize::bundle::{Bundle, Checksums};
use omm_serialize::{Blob, Block, ByteOrder, Header, References, StreamReader, serialize_object};

pub mod calls;
mod seeds;

pub use seeds::seeds;

/// A fuzz target: it returns, or panics with what is wrong.
pub type Body = fn(&[u8]);

/// Every target by name.
pub const TARGETS: [(&str, Body); 6] = [
    ("blob_identity", blob_identity),
    ("blob_incremental", blob_incremental),
    ("blob_structured", blob_structured),
    ("object_payload", object_payload),
    ("bundle_decode", bundle_decode),
    ("packed_data", packed_data),
];

/// The targets that run sequences of calls: they take more time and other bytes, which [`seeds`] are not.
pub const CALL_TARGETS: [(&str, Body); 2] = [("two_readings", two_readings), ("replay", calls::replay)];

/// Where the validator says nothing, the device does not stop.
pub fn two_readings(bytes: &[u8]) {
    calls::calls(bytes);
}

const ORDERS: [ByteOrder; 2] = [ByteOrder::Little, ByteOrder::Big];

/// What is read writes back to the same bytes, and every byte is described once.
pub fn blob_identity(bytes: &[u8]) {
    for order in ORDERS {
        let Ok(blob) = Blob::read(bytes, order) else { continue };
        assert_eq!(blob.header().write(order, blob.payload()), bytes, "{order}");
        let mut end = 0;
        blob.describe(&mut |field| {
            assert_eq!(field.offset, end, "{field:?}");
            end += field.size;
        });
        assert_eq!(end, bytes.len() as u64, "described to the end");
    }
}

/// Data that comes in pieces, whose sizes the first byte decides, reads as data that comes at once, errors included.
pub fn blob_incremental(bytes: &[u8]) {
    let Some((&size, bytes)) = bytes.split_first() else { return };
    for order in ORDERS {
        let whole = Blob::read(bytes, order).map(|blob| (blob.header(), blob.payload().to_vec()));
        let (mut reader, mut payload) = (StreamReader::new(order), Vec::new());
        let mut pieces = bytes.chunks(usize::from(size) + 1);
        let pushed = pieces.try_for_each(|piece| reader.push(piece).map(|piece| payload.extend_from_slice(piece)));
        let pieces = pushed.and_then(|()| reader.finish().map(|head| (head.to_header(), payload)));
        assert_eq!(pieces, whole, "{order}, pieces of {}", u32::from(size) + 1);
    }
}

/// A header and payload that are right.
#[derive(Debug, Arbitrary)]
struct Structured {
    big: bool,
    driver_uuid: [u8; 16],
    compatibility_uuid: [u8; 16],
    deserialized_size: u64,
    handles: Option<Vec<u64>>,
    blocks: Vec<(u32, u32, Vec<u64>)>,
    payload: Vec<u8>,
}

/// What is written reads back, whatever it is.
pub fn blob_structured(bytes: &[u8]) {
    let Ok(made) = Structured::arbitrary(&mut Unstructured::new(bytes)) else { return };
    let Structured { big, driver_uuid, compatibility_uuid, deserialized_size, handles, blocks, payload } = made;
    let order = if big { ByteOrder::Big } else { ByteOrder::Little };
    let block = |(block_type, reserved, addresses)| Block { block_type, reserved, addresses };
    let references = match handles {
        Some(handles) => References::Handles(handles),
        None => References::Blocks(blocks.into_iter().map(block).collect()),
    };
    let size = payload.len() as u64;
    let header = Header::for_payload(Uuid(driver_uuid), Uuid(compatibility_uuid), deserialized_size, references, size);
    let written = header.write(order, &payload);
    match Blob::read(&written, order) {
        Ok(blob) => assert_eq!((blob.header(), blob.payload()), (header, &payload[..])),
        Err(error) => panic!("{header:?} was written and refused: {error}"),
    }
}

/// A payload that is taken for ours serializes to the same bytes again, but for the reserved word of its block.
pub fn object_payload(bytes: &[u8]) {
    let Ok(blob) = Blob::read(bytes, ByteOrder::Little) else { return };
    let Ok(object) = blob.to_object() else { return };
    let prefix = blob.prefix();
    let again = serialize_object(&object, prefix.driver_uuid, prefix.compatibility_uuid);
    let mut header = blob.header();
    if let References::Blocks(blocks) = &mut header.references {
        blocks.iter_mut().for_each(|block| block.reserved = 0);
    }
    assert_eq!(again, Ok(header.write(ByteOrder::Little, blob.payload())));
    // Compaction keeps the object readable and is done after one step.
    let compacted = match Object::read(&object) {
        Ok(object) => object.compact(),
        Err(error) => panic!("deserialized and refused: {error}"),
    };
    match Object::read(&compacted) {
        Ok(object) => assert_eq!(object.compact(), compacted),
        Err(error) => panic!("compacted and refused: {error}"),
    }
}

/// What is read as a bundle writes back to a bundle of the same contents; with right checksums, to the same bytes.
pub fn bundle_decode(bytes: &[u8]) {
    let Ok(bundle) = Bundle::read(bytes, Checksums::Skip) else { return };
    let again = bundle.to_data().write();
    match Bundle::read(&again, Checksums::Verify) {
        Ok(read) => assert_eq!(read.to_data(), bundle.to_data()),
        Err(error) => panic!("written and refused: {error}"),
    }
    if Bundle::read(bytes, Checksums::Verify).is_ok() {
        assert_eq!(again, bytes, "one content, one encoding");
    }
}

/// Packed elements unpack and pack to the same bytes, and are those that arithmetic on the bytes finds.
pub fn packed_data(bytes: &[u8]) {
    for format in OpacityMicromapFormat::ALL {
        let per_byte = 8 / format.bits();
        let count = bytes.len() as u64 * u64::from(per_byte);
        let Ok(states) = PackedStates::with_count(bytes, format, count) else {
            panic!("{count} elements do not fit into {} bytes", bytes.len());
        };
        let states: Vec<_> = states.iter().collect();
        let expected = bytes.iter().flat_map(|byte| {
            let element = move |at| byte >> (at * format.bits()) & ((1 << format.bits()) - 1);
            (0..per_byte).map(element).map(OpacityState::from_value)
        });
        assert!(expected.eq(states.iter().copied().map(Some)), "{format:?}");
        assert_eq!(packed::pack(format, &states).as_deref(), Ok(bytes), "{format:?}");
    }
}
