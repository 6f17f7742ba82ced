//! Serialized acceleration structures.

use arbitrary::{Arbitrary, Unstructured};
use omm_layout::object::Object;
use omm_model::profile::Uuid;
use omm_serialize::{Blob, Block, ByteOrder, Header, References, StreamReader, serialize_object};

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
