//! The array under construction: blocks in order, the same bytes only once.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hasher};

use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::triangle::MicromapTriangle;

use crate::error::BakeError;

/// The most bytes that an array can have: each block must start at an offset of 32 bits, and so must the end of the last.
pub(crate) const MAX_ARRAY_BYTES: u64 = u32::MAX as u64;

/// The array under construction.
///
/// Blocks are added in the order in which they are to lie there, so nothing is moved later and the array exists only once.
#[derive(Debug)]
pub(crate) struct ArrayBuilder {
    merge: bool,
    bytes: Vec<u8>,
    triangles: Vec<MicromapTriangle>,
    /// Triangles by a hash of their level and bytes; the bytes decide.
    by_hash: HashMap<u64, Vec<u32>>,
}

impl ArrayBuilder {
    pub(crate) fn new(merge: bool) -> Self {
        Self { merge, bytes: Vec::new(), triangles: Vec::new(), by_hash: HashMap::new() }
    }

    /// The index of the micromap triangle with this level, format and data, and whether it is new.
    pub(crate) fn add(
        &mut self,
        subdivision_level: SubdivisionLevel,
        format: OpacityMicromapFormat,
        data: &[u8],
    ) -> Result<(u32, bool), BakeError> {
        let hash = hash(subdivision_level, format, data);
        if self.merge
            && let Some(same) = self.by_hash.get(&hash).and_then(|candidates| {
                candidates.iter().find(|&&candidate| self.is(candidate, subdivision_level, format, data))
            })
        {
            return Ok((*same, false));
        }
        let required = self.bytes.len() as u64 + data.len() as u64;
        if required > MAX_ARRAY_BYTES {
            return Err(BakeError::ArrayTooLarge { required, limit: MAX_ARRAY_BYTES });
        }
        self.bytes.try_reserve(data.len()).map_err(|_| BakeError::OutOfMemory { required })?;
        // Below 2^32 by the check above. Every triangle has at least a byte, so their number is, too.
        let (data_offset, index) = (self.bytes.len() as u32, self.triangles.len() as u32);
        self.bytes.extend_from_slice(data);
        self.triangles.push(MicromapTriangle { data_offset, subdivision_level, format });
        if self.merge {
            self.by_hash.entry(hash).or_default().push(index);
        }
        Ok((index, true))
    }

    fn is(&self, index: u32, level: SubdivisionLevel, format: OpacityMicromapFormat, data: &[u8]) -> bool {
        self.triangles.get(index as usize).is_some_and(|triangle| {
            let start = triangle.data_offset as usize;
            (triangle.subdivision_level, triangle.format) == (level, format)
                && self.bytes.get(start..start + data.len()) == Some(data)
        })
    }

    /// The array's bytes and the triangles that read them.
    pub(crate) fn finish(mut self) -> (Vec<u8>, Vec<MicromapTriangle>) {
        self.bytes.shrink_to_fit();
        (self.bytes, self.triangles)
    }
}

/// A hash that is the same in every run.
fn hash(level: SubdivisionLevel, format: OpacityMicromapFormat, data: &[u8]) -> u64 {
    let mut hasher = DefaultHasher::new();
    hasher.write_u32(level.get());
    hasher.write_u16(format.value());
    hasher.write(data);
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_bytes_are_stored_once() {
        let level = |level| SubdivisionLevel::new(level).unwrap();
        let (two, four) = (OpacityMicromapFormat::TwoState, OpacityMicromapFormat::FourState);
        for (merge, expected) in [(true, vec![0, 1, 0, 2, 3]), (false, vec![0, 1, 2, 3, 4])] {
            let mut builder = ArrayBuilder::new(merge);
            let blocks: [(_, _, &[u8]); 5] = [
                (level(2), four, &[1, 2, 3, 4]),
                (level(2), four, &[1, 2, 3, 5]),
                (level(2), four, &[1, 2, 3, 4]),
                (level(1), four, &[5]),
                // The same byte means something else at another level or in another format.
                (level(1), two, &[5]),
            ];
            let indices = blocks.map(|(level, format, data)| builder.add(level, format, data).unwrap().0);
            assert_eq!(indices, expected[..]);
            let (bytes, triangles) = builder.finish();
            assert_eq!(bytes.len(), if merge { 10 } else { 14 });
            let mut end = 0;
            for triangle in triangles {
                assert_eq!(triangle.data_range().start, end);
                end = triangle.data_range().end;
            }
        }
    }
}
