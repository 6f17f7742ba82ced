//! BC3 alpha, BC4 and BC5 as an NVIDIA device decodes them, which is not the specification's fractions.
//!
//! Measured on an H200 (driver 580.159.04) through CUDA's texture fetches without a filter: all 65,536 pairs of ends with all 8 codes,
//! for BC3 alpha and for unsigned BC4, and 1,048,576 texels of random blocks for BC3 and for the second channel of BC5. These
//! formulas give every one of those values to the last bit. The weights are near sevenths and fifths, off by up to 0.025 of the
//! distance between the ends.

use super::{codes, little_endian};

/// BC4 and either channel of BC5, in 65535ths: blends in 257ths.
pub(super) fn bc4(block: &[u8]) -> [i32; 16] {
    let [a, b] = *block.first_chunk().unwrap_or(&[0; 2]);
    let blend = |of_b: i32| (257 - of_b) * i32::from(a) + of_b * i32::from(b);
    let values = if a > b {
        [0, 257, 36, 72, 113, 144, 185, 221].map(blend)
    } else {
        let [first, second, c, d, e, f] = [0, 257, 48, 96, 161, 209].map(blend);
        [first, second, c, d, e, f, 0, 65_535]
    };
    texels(block, values)
}

/// BC3 alpha, in 255ths: so far from one of the ends, rounded to 8 bits.
pub(super) fn bc3(block: &[u8]) -> [i32; 16] {
    let [a, b] = block.first_chunk().unwrap_or(&[0; 2]).map(i32::from);
    let distance = (a - b).abs();
    let away = |weight: i32| (distance * weight + (1 << 10)) >> 11;
    let values = if a > b {
        let [seventh, two, four] = [289, 578, 1156].map(away);
        [a, b, a - seventh, a - two, b + four, a - four, b + two, b + seventh]
    } else {
        let [fifth, two] = [385, 770].map(away);
        [a, b, a + fifth, a + two, b - two, b - fifth, 0, 255]
    };
    texels(block, values)
}

fn texels(block: &[u8], values: [i32; 8]) -> [i32; 16] {
    codes(little_endian(block, 2, 6), 3).map(|code| values.get(code).copied().unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::super::tests::all_codes;
    use super::*;

    /// Values that the device answered, of ends that tell neighbouring formulas apart.
    #[test]
    fn values_of_the_device() {
        let first_8 = |texels: [i32; 16]| -> [i32; 8] { std::array::from_fn(|texel| texels[texel]) };
        for (a, b, expected) in [
            (255, 0, [65_535, 0, 56_355, 47_175, 36_720, 28_815, 18_360, 9_180]),
            (0, 1, [0, 257, 48, 96, 161, 209, 0, 65_535]),
            (200, 100, [51_400, 25_700, 47_800, 44_200, 40_100, 37_000, 32_900, 29_300]),
        ] {
            assert_eq!(first_8(bc4(&all_codes(a, b))), expected, "{a} {b}");
        }
        for (a, b, expected) in [
            (255, 0, [255, 0, 219, 183, 144, 111, 72, 36]),
            (0, 255, [0, 255, 48, 96, 159, 207, 0, 255]),
            (1, 0, [1, 0, 1, 1, 1, 0, 0, 0]),
            (200, 100, [200, 100, 186, 172, 156, 144, 128, 114]),
            (100, 200, [100, 200, 119, 138, 162, 181, 0, 255]),
        ] {
            assert_eq!(first_8(bc3(&all_codes(a, b))), expected, "{a} {b}");
        }
        let away = [(0, 129, 3, 49), (0, 131, 3, 49), (39, 0, 7, 6), (8, 0, 4, 5), (0, 12, 4, 7)];
        for (a, b, code, expected) in away {
            assert_eq!(bc3(&all_codes(a, b))[code], expected, "{a} {b} {code}");
        }
    }

    /// Never further from the specification than a 255th and 3 % of the distance between the ends.
    #[test]
    fn close_to_the_specification() {
        for (a, b) in (0..=255_u8).flat_map(|a| (0..=255_u8).map(move |b| (a, b))) {
            let block = all_codes(a, b);
            let exact =
                super::super::interpolated(&block, super::super::unsigned_ends).map(|value| f64::from(value) / 35.0);
            let allowed = 1.0 + 0.03 * f64::from(a.abs_diff(b));
            let near = |(found, exact): (f64, &f64)| (found - exact).abs() <= allowed;
            assert!(bc4(&block).map(|value| f64::from(value) / 257.0).into_iter().zip(&exact).all(near), "{a} {b}");
            assert!(bc3(&block).map(f64::from).into_iter().zip(&exact).all(near), "{a} {b}");
        }
    }
}
