//! Transformation matrices: 48 bytes, three rows of four.

use omm_model::vk;

use crate::bytes::{Reader, f32s};
use crate::error::ReadError;

/// Bytes of a matrix.
pub const SIZE: usize = 48;

/// The matrix that 48 bytes hold. Any bytes hold one.
#[must_use]
pub fn decode(bytes: &[u8; SIZE]) -> vk::TransformMatrix {
    leading(bytes)
}

/// The matrix that the first 48 bytes hold.
pub(crate) fn leading(bytes: &[u8]) -> vk::TransformMatrix {
    let mut matrix = [[0.0; 4]; 3];
    for (row, bytes) in matrix.iter_mut().zip(bytes.as_chunks::<16>().0) {
        *row = f32s(bytes);
    }
    vk::TransformMatrix { matrix }
}

/// Reads the matrix at the start of `bytes`.
///
/// # Errors
/// Fewer than 48 bytes.
pub fn read(bytes: &[u8]) -> Result<vk::TransformMatrix, ReadError> {
    Reader::new(bytes).array("matrix").map(decode)
}

/// The 48 bytes of a matrix.
#[must_use]
pub fn encode(transform: &vk::TransformMatrix) -> [u8; SIZE] {
    let mut bytes = [0; SIZE];
    let numbers = transform.matrix.as_flattened();
    for (bytes, number) in bytes.as_chunks_mut().0.iter_mut().zip(numbers) {
        *bytes = number.to_le_bytes();
    }
    bytes
}

/// The point that the affine transformation makes of `point`, in `f32` and in this order: each row is
/// `((m0 * x + m1 * y) + m2 * z) + m3`.
#[must_use]
pub fn apply(transform: &vk::TransformMatrix, [x, y, z]: [f32; 3]) -> [f32; 3] {
    transform.matrix.map(|[m0, m1, m2, m3]| ((m0 * x + m1 * y) + m2 * z) + m3)
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
    fn rows_come_first_and_the_last_column_translates() {
        let numbers: Vec<u8> = (1..=12_u8).flat_map(|n| f32::from(n).to_le_bytes()).collect();
        let transform = read(&numbers).unwrap();
        assert_eq!(transform.matrix[1], [5.0, 6.0, 7.0, 8.0]);
        assert_eq!(apply(&transform, [0.0; 3]), [4.0, 8.0, 12.0]);
        assert_eq!(apply(&transform, [1.0, 10.0, 100.0]), [325.0, 773.0, 1221.0]);
        assert_eq!(apply(&vk::TransformMatrix::IDENTITY, [1.5, -2.0, 0.1]), [1.5, -2.0, 0.1]);
        let error = read(&numbers[..47]).unwrap_err();
        assert_eq!(error.to_string(), "matrix at byte 0: 48 bytes are needed, 47 are there");
    }
}
