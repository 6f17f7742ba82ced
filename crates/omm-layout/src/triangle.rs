//! Micromap triangle arrays: entries of 8 bytes — u32 offset, u16 level, u16 format — with a stride.

use omm_model::level::SubdivisionLevel;
use omm_model::triangle::{MicromapTriangle, MicromapTriangleError};
use omm_model::vk;

use crate::bytes::{u16_at, u32_at};
use crate::error::{ReadError, ReadErrorKind, WriteError, WriteErrorKind};
use crate::strided::Strided;

/// Bytes of an entry, and the smallest stride at which entries do not overlap.
pub const SIZE: usize = 8;

/// The entry that 8 bytes hold. Any bytes hold one.
#[must_use]
pub fn decode(bytes: &[u8; SIZE]) -> vk::MicromapTriangle {
    vk::MicromapTriangle {
        data_offset: u32_at::<0, SIZE>(bytes),
        subdivision_level: u16_at::<4, SIZE>(bytes),
        format: u16_at::<6, SIZE>(bytes),
    }
}

/// The 8 bytes of an entry.
#[must_use]
pub fn encode(triangle: &vk::MicromapTriangle) -> [u8; SIZE] {
    let vk::MicromapTriangle { data_offset, subdivision_level, format } = *triangle;
    let mut bytes = [0; SIZE];
    bytes[0..4].copy_from_slice(&data_offset.to_le_bytes());
    bytes[4..6].copy_from_slice(&subdivision_level.to_le_bytes());
    bytes[6..8].copy_from_slice(&format.to_le_bytes());
    bytes
}

/// A triangle array read in place.
#[derive(Clone, Copy, Debug)]
pub struct TriangleArray<'a> {
    entries: Strided<'a, SIZE>,
}

impl<'a> TriangleArray<'a> {
    /// `count` entries, `stride` bytes from one to the next, at the start of `bytes`.
    ///
    /// Any stride is taken, as the bytes decide what can be read; whether it is valid is not asked here.
    ///
    /// # Errors
    /// The last entry ends behind `bytes`.
    pub fn new(bytes: &'a [u8], stride: u64, count: u64) -> Result<Self, ReadError> {
        Ok(Self { entries: Strided::new(bytes, stride, count, "triangles")? })
    }

    /// Number of entries.
    #[must_use]
    pub const fn len(&self) -> u64 {
        self.entries.len()
    }

    /// Whether there are no entries.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Entry `index` as it is stored, if there are so many.
    #[must_use]
    pub fn get(&self, index: u64) -> Option<vk::MicromapTriangle> {
        self.entries.get(index).map(decode)
    }

    /// The entries' bytes as one slice, if nothing lies between them: the fast way through an array of the usual stride.
    #[must_use]
    pub fn packed(&self) -> Option<&'a [[u8; SIZE]]> {
        self.entries.packed()
    }

    /// The entries' bytes.
    pub fn iter_bytes(&self) -> impl Iterator<Item = &'a [u8; SIZE]> + Clone + use<'a> {
        self.entries.iter()
    }

    /// The entries as they are stored.
    pub fn iter(&self) -> impl Iterator<Item = vk::MicromapTriangle> + Clone + use<'a> {
        self.entries.iter().map(decode)
    }

    /// The entries with a meaning; the first without one is an error that names its field.
    pub fn checked(&self) -> impl Iterator<Item = Result<MicromapTriangle, ReadError>> + Clone + use<'a> {
        let entries = self.entries;
        self.iter().zip(0_u64..).map(move |(raw, index)| {
            MicromapTriangle::try_from(raw).map_err(|error| {
                read_error(error).moved_by(entries.offset(index)).within(format_args!("triangles[{index}]"))
            })
        })
    }
}

/// The error of a single entry, its offset counted from the entry's start.
fn read_error(error: MicromapTriangleError) -> ReadError {
    match error {
        MicromapTriangleError::SubdivisionLevel(error) => {
            let limit = SubdivisionLevel::MAX.get().into();
            ReadError::new("subdivision_level", 4, ReadErrorKind::Above { found: error.found.into(), limit })
        }
        MicromapTriangleError::Format { found } => {
            let kind = ReadErrorKind::Unknown { found: found.into(), required: "1 (2-state) or 2 (4-state)" };
            ReadError::new("format", 6, kind)
        }
    }
}

/// A triangle array with `stride` bytes from one entry to the next; what lies between entries, and behind the last, is 0.
///
/// # Errors
/// A stride below 8, or an array beyond the address space.
pub fn write(triangles: &[vk::MicromapTriangle], stride: u64) -> Result<Vec<u8>, WriteError> {
    let limit = isize::MAX as u64;
    if stride < SIZE as u64 {
        return Err(WriteError::new("stride", WriteErrorKind::Below { found: stride, least: SIZE as u64 }));
    }
    crate::error::fits("stride", stride, limit / (triangles.len() as u64).max(1))?;
    let mut bytes = vec![0; triangles.len() * stride as usize];
    for (entry, triangle) in bytes.chunks_exact_mut(stride as usize).zip(triangles) {
        entry[..SIZE].copy_from_slice(&encode(triangle));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn raw(data_offset: u32, subdivision_level: u16, format: u16) -> vk::MicromapTriangle {
        vk::MicromapTriangle { data_offset, subdivision_level, format }
    }

    proptest! {
        #[test]
        fn bytes_round_trip(bytes: [u8; SIZE]) {
            prop_assert_eq!(encode(&decode(&bytes)), bytes);
        }

        #[test]
        fn arrays_round_trip_at_any_stride(entries: Vec<(u32, u16, u16)>, stride in 8..40_u64) {
            let entries: Vec<_> = entries.into_iter().map(|(o, l, f)| raw(o, l, f)).collect();
            let bytes = write(&entries, stride).unwrap();
            let array = TriangleArray::new(&bytes, stride, entries.len() as u64).unwrap();
            prop_assert_eq!(array.iter().collect::<Vec<_>>(), entries.clone());
            prop_assert_eq!(array.len(), entries.len() as u64);
            for (index, entry) in entries.iter().enumerate() {
                prop_assert_eq!(array.get(index as u64), Some(*entry));
            }
            prop_assert_eq!(array.get(array.len()), None);
            let packed = array.packed().map(|all| all.iter().map(decode).collect::<Vec<_>>());
            prop_assert_eq!(packed, (stride == SIZE as u64).then_some(entries.clone()));
            prop_assert_eq!(array.iter_bytes().map(decode).collect::<Vec<_>>(), entries.clone());
            if let Some(last) = entries.len().checked_sub(1) {
                let end = last * stride as usize + SIZE;
                let count = entries.len() as u64;
                prop_assert!(TriangleArray::new(&bytes[..end], stride, count).is_ok());
                let error = TriangleArray::new(&bytes[..end - 1], stride, count).unwrap_err();
                prop_assert!(error.is_truncated());
            }
        }
    }

    #[test]
    fn entries_without_a_meaning_are_named() {
        let bytes = write(&[raw(7, 12, 1), raw(0, 13, 1), raw(0, 1, 3)], 12).unwrap();
        let array = TriangleArray::new(&bytes, 12, 3).unwrap();
        let checked: Vec<_> = array.checked().map(|entry| entry.map_err(|e| e.to_string())).collect();
        assert_eq!(checked[0].as_ref().unwrap().data_offset, 7);
        assert_eq!(checked[1], Err("triangles[1].subdivision_level at byte 16: found 13, required at most 12".into()));
        assert_eq!(
            checked[2],
            Err("triangles[2].format at byte 30: found 3, required 1 (2-state) or 2 (4-state)".into())
        );
    }

    #[test]
    fn strides_that_cannot_be_written_are_refused() {
        let text = |stride| write(&[raw(0, 0, 1); 2], stride).unwrap_err().to_string();
        assert_eq!(text(7), "stride: found 7, required at least 8");
        assert_eq!(text(u64::MAX), format!("stride: found {}, room for at most {}", u64::MAX, u64::MAX / 4));
        assert!(TriangleArray::new(&[0; 8], u64::MAX, u64::MAX).is_err());
        let one = TriangleArray::new(&[1, 0, 0, 0, 0, 0, 1, 0], 0, 3).unwrap();
        assert_eq!(one.iter().collect::<Vec<_>>(), [raw(1, 0, 1); 3]);
    }
}
