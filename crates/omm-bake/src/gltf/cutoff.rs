//! From glTF's `alpha * factor >= cutoff` to the baker's `alpha > cutoff`.

/// The texture's alpha above which the surface is opaque, for an `alphaCutoff` and an alpha factor in `0.0..=1.0`.
///
/// The quotient is rounded to `f32`. The least alpha that glTF calls opaque is the quotient itself, the baker's is just above it;
/// where a texel of 8 or 16 bits has exactly that alpha, whole texels depend on it, and the result is the next `f32` below.
/// Elsewhere only points on a curve through a bilinear cell have it, which rounding in a shader does not resolve either.
pub(super) fn above(cutoff: f32, factor: f32) -> f32 {
    if cutoff <= 0.0 {
        // No alpha is below it: everything is opaque.
        return (-1.0_f32).min(cutoff.next_down());
    }
    if factor == 0.0 {
        // Alpha is 0 everywhere, which is below it: everything is transparent.
        return f32::MAX;
    }
    // Both are exact in f64, as are their products with 16-bit numbers.
    let (cutoff, factor) = (f64::from(cutoff), f64::from(factor));
    let quotient = (cutoff / factor).min(f64::from(f32::MAX)) as f32;
    let is_texel = |most: u32| {
        let texel = (f64::from(quotient) * f64::from(most)).round();
        texel <= f64::from(most) && texel * factor == cutoff * f64::from(most)
    };
    if is_texel(255) || is_texel(65_535) { quotient.next_down() } else { quotient }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_factor_the_cutoff_stays() {
        for cutoff in [0.5, 0.2, 0.9, 0.1, 1e-9, 1.5, 0.25] {
            assert_eq!(above(cutoff, 1.0), cutoff);
        }
    }

    #[test]
    fn texels_at_the_cutoff_are_opaque() {
        // All of an opaque texture at a cutoff of 1, and of any texture at a cutoff of 0.
        assert!(above(1.0, 1.0) < 1.0);
        assert!(above(0.0, 1.0) < 0.0);
        assert!(above(-3.0, 1.0) < -3.0);
        // Alpha 1 times one half is the cutoff of one half.
        assert_eq!(above(0.5, 0.5), 1.0_f32.next_down());
        // 51 / 255 is a fifth, but no f32 is: the two texel values around the cutoff stay apart.
        let fifth = above(0.2, 1.0);
        assert_eq!(fifth, 0.2);
    }

    #[test]
    fn the_factor_divides_the_cutoff() {
        assert_eq!(above(0.25, 0.5), 0.5);
        assert_eq!(above(0.3, 0.6), 0.3_f32 / 0.6);
        assert_eq!(above(0.5, 0.0), f32::MAX);
        assert_eq!(above(0.0, 0.0), -1.0);
        assert_eq!(above(f32::MAX, 1e-30), f32::MAX);
    }
}
