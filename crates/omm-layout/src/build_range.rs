//! Build ranges: 16 bytes, four u32.

use omm_model::vk;

use crate::bytes::u32_at;
use crate::error::ReadError;
use crate::strided::Strided;

/// Bytes of a build range.
pub const SIZE: usize = 16;

/// The build range that 16 bytes hold. Any bytes hold one.
#[must_use]
pub fn decode(bytes: &[u8; SIZE]) -> vk::BuildRangeInfo {
    vk::BuildRangeInfo {
        primitive_count: u32_at::<0, SIZE>(bytes),
        primitive_offset: u32_at::<4, SIZE>(bytes),
        first_vertex: u32_at::<8, SIZE>(bytes),
        transform_offset: u32_at::<12, SIZE>(bytes),
    }
}

/// Reads `count` build ranges, `stride` bytes from one to the next, at the start of `bytes`.
///
/// # Errors
/// The last one ends behind `bytes`.
pub fn read(
    bytes: &[u8],
    stride: u64,
    count: u64,
) -> Result<impl Iterator<Item = vk::BuildRangeInfo> + Clone, ReadError> {
    Ok(Strided::<SIZE>::new(bytes, stride, count, "ranges")?.iter().map(decode))
}

/// The 16 bytes of a build range.
#[must_use]
pub fn encode(range: &vk::BuildRangeInfo) -> [u8; SIZE] {
    let vk::BuildRangeInfo { primitive_count, primitive_offset, first_vertex, transform_offset } = *range;
    let mut bytes = [0; SIZE];
    let numbers = [primitive_count, primitive_offset, first_vertex, transform_offset];
    for (bytes, number) in bytes.as_chunks_mut().0.iter_mut().zip(numbers) {
        *bytes = number.to_le_bytes();
    }
    bytes
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn bytes_round_trip(bytes: [u8; SIZE]) {
            prop_assert_eq!(encode(&decode(&bytes)), bytes);
        }
    }

    #[test]
    fn ranges_are_read_with_their_stride() {
        let mut bytes = [0_u8; 36];
        for (value, byte) in (0..9).zip(bytes.iter_mut().step_by(4)) {
            *byte = value;
        }
        let ranges: Vec<_> = read(&bytes, 20, 2).unwrap().collect();
        let range = |[primitive_count, primitive_offset, first_vertex, transform_offset]: [u32; 4]| {
            vk::BuildRangeInfo { primitive_count, primitive_offset, first_vertex, transform_offset }
        };
        assert_eq!(ranges, [range([0, 1, 2, 3]), range([5, 6, 7, 8])]);
        let error = read(&bytes, 21, 2).map(|_| ()).unwrap_err();
        assert_eq!(error.to_string(), "ranges at byte 0: 37 bytes are needed, 36 are there");
        assert!(read(&bytes, u64::MAX, u64::MAX).is_err());
        assert_eq!(read(&[], u64::MAX, 0).unwrap().count(), 0);
    }
}
