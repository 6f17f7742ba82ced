//! Serialized data of the simulated device: its packed objects, with the reference table moved into the header.

use omm_layout::object::{Object, ObjectHeader, ObjectKind};
use omm_model::profile::Uuid;

use crate::blob::{COUNT_AT, Count};
use crate::header::{BLOCK_SIZE, BLOCK_TYPE_OPACITY_MICROMAP, Block, FIXED_SIZE, Header, References};
use crate::{Blob, ByteOrder, ReadError, ReadErrorKind};

/// The device's byte order, whatever machine simulates it.
const ORDER: ByteOrder = ByteOrder::Little;

/// Bytes of an object's serialized data: what the serialization-size query answers.
#[must_use]
pub fn serialized_size(header: &ObjectHeader) -> u64 {
    // The table moves into the header; what is new are the fixed fields and the head of the block that holds micromaps.
    let blocks = header.kind == ObjectKind::BottomLevel && header.reference_count > 0;
    (FIXED_SIZE + if blocks { BLOCK_SIZE } else { 0 }).saturating_add(header.size)
}

/// The serialized data of the built object at the start of `object`.
///
/// Bottom-level structures that a top-level one refers to become handles, micromaps that a bottom-level one refers to a block of
/// their type; the payload is the object without its reference table, and the deserialized size is the object's.
///
/// # Errors
/// The first field of the object that is not as it should be; offsets are counted from the start of `object`.
pub fn serialize_object(object: &[u8], driver_uuid: Uuid, compatibility_uuid: Uuid) -> Result<Vec<u8>, ReadError> {
    let object = Object::read(object)?;
    let header = object.header();
    let addresses: Vec<_> = object.references().collect();
    let references = if header.kind == ObjectKind::BottomLevel && !addresses.is_empty() {
        let block_type = BLOCK_TYPE_OPACITY_MICROMAP;
        References::Blocks(vec![Block { block_type, reserved: 0, addresses }])
    } else {
        References::Handles(addresses)
    };
    let (head, body) = parts(object.as_bytes(), header.body_offset());
    let serialized_size = serialized_size(header);
    let header =
        Header { driver_uuid, compatibility_uuid, serialized_size, deserialized_size: header.size, references };
    // An object's size was proved to be that of a slice.
    let mut bytes = Vec::with_capacity(serialized_size as usize);
    header.write_into(ORDER, &mut bytes);
    bytes.extend_from_slice(head);
    bytes.extend_from_slice(body);
    Ok(bytes)
}

/// The object's header, and what begins at `body`.
fn parts(object: &[u8], body: u64) -> (&[u8], &[u8]) {
    let head = object.get(..ObjectHeader::SIZE as usize).unwrap_or_default();
    let body = usize::try_from(body).ok().and_then(|body| object.get(body..)).unwrap_or_default();
    (head, body)
}

/// The built object that [`serialize_object`] was given, with the references that the header of `blob` names now.
///
/// The UUIDs are not compared: see [`compatibility`](crate::compatibility).
///
/// # Errors
/// The first field of header or payload that is not as it should be; offsets are counted from the start of `blob`.
pub fn deserialize_object(blob: &[u8]) -> Result<Vec<u8>, ReadError> {
    let read = Blob::read(blob, ORDER).map_err(|error| match Blob::read_detected(blob) {
        Ok((other, _)) if other.order() != ORDER => other_order(),
        _ => error,
    });
    object_of(&read?)
}

/// Data that is right, but from a host of the other byte order.
fn other_order() -> ReadError {
    ReadError { field: "serialized_size".into(), offset: 32, kind: ReadErrorKind::BigEndian }
}

impl Blob<'_> {
    /// As [`deserialize_object`]; data that was read as big-endian is not ours.
    ///
    /// # Errors
    /// As [`deserialize_object`].
    pub fn to_object(&self) -> Result<Vec<u8>, ReadError> {
        object_of(self)
    }
}

fn object_of(blob: &Blob<'_>) -> Result<Vec<u8>, ReadError> {
    if blob.order() != ORDER {
        return Err(other_order());
    }
    let start = blob.header_size();
    let payload = blob.payload();
    let in_payload = |error: ReadError| error.within("payload").moved_by(start);
    let header = ObjectHeader::read(payload).map_err(in_payload)?;

    let references = references(blob, &header)?;
    let error = |field: &'static str, offset, found, required| {
        let kind = ReadErrorKind::NotEqual { found, required };
        Err(ReadError { field: field.into(), offset, kind })
    };
    let size = (payload.len() + 8 * references.len()) as u64;
    if header.size != size {
        return error("payload.size", start + 16, header.size, size);
    }
    let deserialized_size = blob.prefix().deserialized_size;
    if deserialized_size != size {
        return error("deserialized_size", 40, deserialized_size, size);
    }

    let (head, body) = parts(payload, ObjectHeader::SIZE);
    // As long as the blob at most.
    let mut object = Vec::with_capacity(payload.len() + 8 * references.len());
    object.extend_from_slice(head);
    references.iter().for_each(|address| object.extend_from_slice(&address.to_le_bytes()));
    object.extend_from_slice(body);
    let moved_table = 8 * references.len() as u64;
    Object::read(&object).map_err(|error| {
        // Nothing in the table can be wrong, so the field lies in the head or behind the table.
        let in_body = error.offset >= header.body_offset();
        let offset = error.offset - if in_body { moved_table } else { 0 };
        in_payload(ReadError { offset, ..error })
    })?;
    Ok(object)
}

/// The addresses in the header, which must be as many as the object of that kind has.
fn references(blob: &Blob<'_>, header: &ObjectHeader) -> Result<Vec<u64>, ReadError> {
    let error = |field: &'static str, offset, kind| ReadError { field: field.into(), offset, kind };
    let required = u64::from(header.reference_count);
    let blocks = header.kind == ObjectKind::BottomLevel && required > 0;
    match blob.prefix().count {
        Count::Handles(found) if blocks => {
            let kind = ReadErrorKind::Unknown {
                found: found.cast_signed(),
                required: "a count of blocks, its high half all ones",
            };
            Err(error("handle_count", COUNT_AT, kind))
        }
        Count::Handles(found) if found != required => {
            Err(error("handle_count", COUNT_AT, ReadErrorKind::NotEqual { found, required }))
        }
        Count::Handles(_) => Ok(blob.handles().collect()),
        // Written with a count of handles, which is 0 here: no blocks at all would not be the same bytes.
        Count::Blocks(found) if !blocks => {
            let kind = ReadErrorKind::Unknown { found: found.into(), required: "a count of handles" };
            Err(error("block_count", COUNT_AT, kind))
        }
        Count::Blocks(found) if found != 1 => {
            Err(error("block_count", COUNT_AT, ReadErrorKind::NotEqual { found: found.into(), required: 1 }))
        }
        Count::Blocks(_) => {
            if let Some(block) = blob.blocks().find(|block| block.block_type != BLOCK_TYPE_OPACITY_MICROMAP) {
                let kind = ReadErrorKind::Unknown { found: block.block_type.into(), required: "0 (opacity micromaps)" };
                return Err(error("blocks[0].type", FIXED_SIZE, kind));
            }
            let micromaps: Vec<_> = blob.micromaps().collect();
            let found = micromaps.len() as u64;
            if found != required {
                let kind = ReadErrorKind::NotEqual { found, required };
                return Err(error("blocks[0].count", FIXED_SIZE + 8, kind));
            }
            Ok(micromaps)
        }
    }
}
