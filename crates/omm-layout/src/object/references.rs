//! The table of device addresses between header and body.

use super::header::ObjectHeader;
use crate::bytes::Reader;
use crate::error::{ReadError, ReadErrorKind};

/// The bytes of the object that `header` describes, and its reference table.
pub(super) fn split<'a>(header: &ObjectHeader, bytes: &'a [u8]) -> Result<(&'a [u8], &'a [[u8; 8]]), ReadError> {
    let size = usize::try_from(header.size).ok();
    let object = size.and_then(|size| bytes.get(..size)).ok_or_else(|| {
        let kind = ReadErrorKind::Truncated { available: bytes.len() as u64, required: header.size };
        ReadError::new("object", 0, kind)
    })?;
    let mut input = Reader::new(object);
    input.array::<64>("header")?;
    let table = input.items(header.reference_count.into(), "references")?;
    Ok((object, table))
}

/// The device addresses that the object at the start of `bytes` refers to, in the order of its table: micromaps for a
/// bottom-level structure, bottom-level structures for a top-level one, nothing for a micromap.
///
/// Only the header and the table are looked at.
///
/// # Errors
/// A header field that is not as it should be, or a truncated object.
pub fn references(bytes: &[u8]) -> Result<impl ExactSizeIterator<Item = u64> + Clone, ReadError> {
    let header = ObjectHeader::read(bytes)?;
    let (_, table) = split(&header, bytes)?;
    Ok(table.iter().map(|address| u64::from_le_bytes(*address)))
}

/// Puts `replace(address)` in the place of every address in the table of the object at the start of `bytes`, and says how many
/// entries there are.
///
/// # Errors
/// As [`references`]; then nothing was changed.
pub fn replace_references(bytes: &mut [u8], mut replace: impl FnMut(u64) -> u64) -> Result<usize, ReadError> {
    let count = references(bytes)?.len();
    let table = bytes.get_mut(ObjectHeader::SIZE as usize..).unwrap_or_default();
    let table = table.as_chunks_mut::<8>().0;
    for address in table.iter_mut().take(count) {
        *address = replace(u64::from_le_bytes(*address)).to_le_bytes();
    }
    Ok(count)
}
