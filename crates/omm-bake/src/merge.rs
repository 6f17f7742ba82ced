//! The array under construction: blocks in order, the same bytes only once.

use std::hash::{BuildHasher, Hasher};

use hashbrown::{DefaultHashBuilder, HashTable};
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
    /// Every block starts at a multiple of it, in bytes.
    alignment: u32,
    bytes: Vec<u8>,
    triangles: Vec<MicromapTriangle>,
    hasher: DefaultHashBuilder,
    /// Triangles by a hash of their level, format and bytes, which comes first.
    by_content: HashTable<(u64, u32)>,
}

impl ArrayBuilder {
    pub(crate) fn new(merge: bool, alignment: u32) -> Self {
        Self {
            merge,
            alignment,
            bytes: Vec::new(),
            triangles: Vec::new(),
            hasher: DefaultHashBuilder::default(),
            by_content: HashTable::new(),
        }
    }

    /// Bytes so far.
    pub(crate) fn len(&self) -> u64 {
        self.bytes.len() as u64
    }

    /// The index of the micromap triangle with this level, format and data.
    pub(crate) fn add(
        &mut self,
        subdivision_level: SubdivisionLevel,
        format: OpacityMicromapFormat,
        data: &[u8],
    ) -> Result<u32, BakeError> {
        let hash = if self.merge { hash(self.hasher.build_hasher(), subdivision_level, format, data) } else { 0 };
        let Self { bytes, triangles, .. } = self;
        let content = |index: u32| {
            let triangle = triangles.get(index as usize)?;
            let start = triangle.data_offset as usize;
            let data = bytes.get(start..start + triangle.data_size() as usize)?;
            Some((triangle.subdivision_level, triangle.format, data))
        };
        let same =
            |&(other, index): &(u64, u32)| other == hash && content(index) == Some((subdivision_level, format, data));
        if let Some(&(_, same)) = self.by_content.find(hash, same) {
            return Ok(same);
        }
        let start = self.len().next_multiple_of(self.alignment.into());
        let required = start + data.len() as u64;
        if required > MAX_ARRAY_BYTES {
            return Err(BakeError::ArrayTooLarge { required, limit: MAX_ARRAY_BYTES });
        }
        let additional = (required - self.len()) as usize;
        self.bytes.try_reserve(additional).map_err(|_| BakeError::OutOfMemory { required })?;
        // Below 2^32 by the check above. Every triangle has at least a byte, so their number is, too.
        let (data_offset, index) = (start as u32, self.triangles.len() as u32);
        self.bytes.resize(start as usize, 0);
        self.bytes.extend_from_slice(data);
        self.triangles.push(MicromapTriangle { data_offset, subdivision_level, format });
        if self.merge {
            self.by_content.insert_unique(hash, (hash, index), |&(hash, _)| hash);
        }
        Ok(index)
    }

    /// The array's bytes and the triangles that read them.
    pub(crate) fn finish(mut self) -> (Vec<u8>, Vec<MicromapTriangle>) {
        self.bytes.shrink_to_fit();
        (self.bytes, self.triangles)
    }
}

/// A hash of a block.
pub(crate) fn hash(
    mut hasher: impl Hasher,
    level: SubdivisionLevel,
    format: OpacityMicromapFormat,
    data: &[u8],
) -> u64 {
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
            let mut builder = ArrayBuilder::new(merge, 1);
            let blocks: [(_, _, &[u8]); 5] = [
                (level(2), four, &[1, 2, 3, 4]),
                (level(2), four, &[1, 2, 3, 5]),
                (level(2), four, &[1, 2, 3, 4]),
                (level(1), four, &[5]),
                // The same byte means something else at another level or in another format.
                (level(1), two, &[5]),
            ];
            let indices = blocks.map(|(level, format, data)| builder.add(level, format, data).unwrap());
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

    #[test]
    fn blocks_are_moved_to_the_next_multiple() {
        let mut builder = ArrayBuilder::new(true, 4);
        for byte in 1..=3 {
            builder.add(SubdivisionLevel::ZERO, OpacityMicromapFormat::FourState, &[byte]).unwrap();
        }
        assert_eq!(builder.finish().0, [1, 0, 0, 0, 2, 0, 0, 0, 3]);
    }
}
