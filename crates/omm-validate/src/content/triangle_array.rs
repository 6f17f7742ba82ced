//! One pass over a triangle array that tells whether all is well.
//!
//! Nearly every array is well, and then this pass is all that is done. Rules look for the first entry that breaks them only in an
//! array that fails here.

use omm_layout::triangle::TriangleArray;
use omm_model::format::OpacityMicromapFormat;

/// Levels and formats that the table has room for; all others are wrong.
const LEVELS: usize = 16;
const FORMATS: usize = 4;
/// The bits of an entry's second word that a level and a format within the table have.
const TABLE_BITS: u32 = (LEVELS as u32 - 1) | (FORMATS as u32 - 1) << 16;
/// Entries that are looked at before asking whether one was wrong.
const BLOCK: usize = 256;

/// What is allowed of an entry, whatever its place.
pub(super) struct Allowed {
    /// By format and level: below which offset the entry's data has to begin.
    end: [u64; LEVELS * FORMATS],
}

impl Allowed {
    /// Allows the levels up to `limit` of each format, if the format is allowed, and data within `available` bytes.
    pub(super) fn new(limit: impl Fn(OpacityMicromapFormat) -> Option<u32>, available: Option<u64>) -> Self {
        let mut end = [0; LEVELS * FORMATS];
        for format in [OpacityMicromapFormat::TwoState, OpacityMicromapFormat::FourState] {
            let Some(limit) = limit(format) else { continue };
            for level in 0..LEVELS as u16 {
                let room = available.unwrap_or(u64::MAX).checked_sub(data_size(format, level));
                let slot = end.get_mut(usize::from(format.value()) * LEVELS + usize::from(level));
                if let (Some(slot), Some(room)) = (slot, room.filter(|_| u32::from(level) <= limit)) {
                    *slot = room.saturating_add(1);
                }
            }
        }
        Self { end }
    }

    /// Whether every entry is allowed.
    pub(super) fn allows(&self, triangles: &TriangleArray<'_>) -> bool {
        match triangles.packed() {
            Some(entries) => entries.chunks(BLOCK).all(|block| self.wrong(block.iter()) == 0),
            None => triangles.iter_bytes().all(|entry| self.wrong(std::iter::once(entry)) == 0),
        }
    }

    /// Not 0 if an entry is wrong. Without branches, so that the entries of a block are looked at side by side.
    fn wrong<'e>(&self, entries: impl Iterator<Item = &'e [u8; 8]>) -> u32 {
        entries.fold(0, |wrong, entry| {
            let word = u64::from_le_bytes(*entry);
            let (offset, high) = (word & u64::from(u32::MAX), (word >> 32) as u32);
            // The mask keeps the slot within the table.
            let slot = (high >> 12 & 0x30 | high & 0xf) as usize;
            let end = self.end[slot % (LEVELS * FORMATS)];
            wrong | high & !TABLE_BITS | u32::from(offset >= end)
        })
    }
}

/// Bytes of the data of a triangle, as many as there are numbers for.
pub(super) fn data_size(format: OpacityMicromapFormat, level: u16) -> u64 {
    let bits = u64::from(format.value());
    // A byte has the 2-state values of 8 microtriangles, of which there are 4 to the power of the level.
    match level {
        0..=30 => (bits << (2 * u32::from(level))).div_ceil(8),
        _ => u64::MAX,
    }
}

#[cfg(test)]
mod tests {
    use omm_layout::triangle;
    use omm_model::vk;
    use proptest::prelude::*;

    use super::*;

    fn entry() -> impl Strategy<Value = vk::MicromapTriangle> {
        let offset = prop_oneof![0..100_u32, any::<u32>()];
        (offset, prop_oneof![0..6_u16, any::<u16>()], prop_oneof![1..3_u16, any::<u16>()]).prop_map(
            |(data_offset, subdivision_level, format)| vk::MicromapTriangle { data_offset, subdivision_level, format },
        )
    }

    proptest! {
        /// The pass agrees with the plain reading of the rules.
        #[test]
        fn all_is_well_where_every_entry_is(
            entries in prop::collection::vec(entry(), 0..4),
            stride in prop_oneof![Just(8_u64), Just(12)],
            limits: [Option<u8>; 2],
            available in prop_oneof![Just(None), (0..120_u64).prop_map(Some), any::<Option<u64>>()],
        ) {
            let limit = |format: OpacityMicromapFormat| {
                // Levels are checked against limits of devices, and no device has one that the table does not reach.
                limits[usize::from(format.value() - 1)].map(|limit| u32::from(limit % 16))
            };
            let is_well = |it: &vk::MicromapTriangle| {
                let Some(format) = OpacityMicromapFormat::from_value(it.format.into()) else { return false };
                let end = u64::from(it.data_offset).saturating_add(data_size(format, it.subdivision_level));
                limit(format).is_some_and(|limit| u32::from(it.subdivision_level) <= limit)
                    && available.is_none_or(|available| end <= available)
            };
            let bytes = triangle::write(&entries, stride).unwrap();
            let array = TriangleArray::new(&bytes, stride, entries.len() as u64).unwrap();
            prop_assert_eq!(Allowed::new(limit, available).allows(&array), entries.iter().all(is_well));
        }
    }

    #[test]
    fn data_is_as_large_as_its_states() {
        let size =
            |level| [OpacityMicromapFormat::TwoState, OpacityMicromapFormat::FourState].map(|f| data_size(f, level));
        assert_eq!(size(0), [1, 1]);
        assert_eq!(size(1), [1, 1]);
        assert_eq!(size(2), [2, 4]);
        assert_eq!(size(12), [1 << 21, 1 << 22]);
        assert_eq!(size(30), [1 << 57, 1 << 58]);
        assert_eq!(size(u16::MAX), [u64::MAX; 2]);
    }
}
