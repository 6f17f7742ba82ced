//! Axis-aligned bounding boxes: 24 bytes, the lower corner and the upper one.

use omm_model::vk;

use crate::bytes::{Reader, f32s};
use crate::error::ReadError;

/// Bytes of a box.
pub const SIZE: usize = 24;

/// The box that 24 bytes hold. Any bytes hold one.
#[must_use]
pub fn decode(bytes: &[u8; SIZE]) -> vk::AabbPositions {
    let [min_x, min_y, min_z, max_x, max_y, max_z] = f32s(bytes);
    vk::AabbPositions { min_x, min_y, min_z, max_x, max_y, max_z }
}

/// Reads the box at the start of `bytes`.
///
/// # Errors
/// Fewer than 24 bytes.
pub fn read(bytes: &[u8]) -> Result<vk::AabbPositions, ReadError> {
    Reader::new(bytes).array("aabb").map(decode)
}

/// The 24 bytes of a box.
#[must_use]
pub fn encode(aabb: &vk::AabbPositions) -> [u8; SIZE] {
    let vk::AabbPositions { min_x, min_y, min_z, max_x, max_y, max_z } = *aabb;
    let mut bytes = [0; SIZE];
    let numbers = [min_x, min_y, min_z, max_x, max_y, max_z];
    for (bytes, number) in bytes.as_chunks_mut().0.iter_mut().zip(numbers) {
        *bytes = number.to_le_bytes();
    }
    bytes
}

/// Whether the box is active: its lowest x is a number.
#[must_use]
pub const fn is_active(aabb: &vk::AabbPositions) -> bool {
    !aabb.min_x.is_nan()
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
    fn the_lower_corner_comes_first() {
        let numbers = [1.0_f32, 2.0, 3.0, 4.0, 5.0, 6.0];
        let bytes: Vec<u8> = numbers.into_iter().flat_map(f32::to_le_bytes).collect();
        let aabb = read(&bytes).unwrap();
        assert_eq!((aabb.min_x, aabb.min_z, aabb.max_x, aabb.max_z), (1.0, 3.0, 4.0, 6.0));
        assert!(is_active(&aabb));
        assert!(!is_active(&vk::AabbPositions { min_x: f32::NAN, ..aabb }));
        let error = read(&bytes[1..]).unwrap_err();
        assert_eq!(error.to_string(), "aabb at byte 0: 24 bytes are needed, 23 are there");
    }
}
