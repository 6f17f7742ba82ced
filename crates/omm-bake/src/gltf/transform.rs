//! `KHR_texture_transform`: scale, then rotation, then offset of texture coordinates.

use gltf::json::extensions::texture::TextureTransform;

/// A transform of texture coordinates.
///
/// The coefficients are `f64`, made of + - * alone so that every machine computes the same, and each transformed coordinate is
/// rounded once more, to `f32`. A shader that transforms in `f32` may differ in the last place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Transform {
    /// u' = row 0 · (u, v, 1), v' = row 1 · (u, v, 1).
    rows: [[f64; 3]; 2],
}

impl Transform {
    /// `None` if a number is not finite or the rotation so many turns that `f32` no longer knows its angle.
    ///
    /// Rotation is counter-clockwise as seen with *v* pointing down: the first example of the extension's own text, its prose
    /// and the viewers agree on that. (Its GLSL listing, read column by column, would turn the other way.)
    pub(super) fn new(transform: &TextureTransform) -> Option<Self> {
        let [offset_u, offset_v] = transform.offset.0.map(f64::from);
        let [scale_u, scale_v] = transform.scale.0.map(f64::from);
        let rotation = f64::from(transform.rotation.0);
        let finite = [offset_u, offset_v, scale_u, scale_v].into_iter().all(f64::is_finite);
        if !finite || rotation.is_nan() || rotation.abs() > MOST_ROTATION {
            return None;
        }
        let (sin, cos) = sin_cos(rotation);
        Some(Self { rows: [[cos * scale_u, sin * scale_v, offset_u], [-sin * scale_u, cos * scale_v, offset_v]] })
    }

    pub(super) fn apply(self, [u, v]: [f32; 2]) -> [f32; 2] {
        let (u, v) = (f64::from(u), f64::from(v));
        self.rows.map(|[a, b, c]| (a * u + b * v + c) as f32)
    }
}

/// Beyond this many radians an `f32` is coarser than a sixteenth of a radian.
const MOST_ROTATION: f64 = 1_048_576.0;

/// Sine and cosine of `angle`, at most [`MOST_ROTATION`], to within a few units in the last place.
///
/// The standard library's differ between machines, and these numbers end up in the baked bytes.
fn sin_cos(angle: f64) -> (f64, f64) {
    // Half of pi in two parts: the high one has 33 bits, so its products with quarters (below 2^20) are exact.
    const HIGH: f64 = 1.570_796_326_734_125_6;
    const LOW: f64 = 6.077_100_506_506_192e-11;
    let quarters = (angle * std::f64::consts::FRAC_2_PI).round();
    let rest = (angle - quarters * HIGH) - quarters * LOW;
    let square = rest * rest;
    // Taylor series on -pi/4..=pi/4: the first terms left out are below 2^-60.
    let series = |first: i32| {
        let term = |sum: f64, n: i32| 1.0 - sum * square / f64::from(n * (n + 1));
        (0..9).rev().map(|k| first + 2 * k).fold(1.0, term)
    };
    let (sin, cos) = (rest * series(2), series(1));
    match quarters.rem_euclid(4.0) as u8 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gltf::json::extensions::texture::{TextureTransformOffset, TextureTransformRotation, TextureTransformScale};

    fn transform(offset: [f32; 2], rotation: f32, scale: [f32; 2]) -> Option<Transform> {
        Transform::new(&TextureTransform {
            offset: TextureTransformOffset(offset),
            rotation: TextureTransformRotation(rotation),
            scale: TextureTransformScale(scale),
            ..TextureTransform::default()
        })
    }

    #[test]
    fn sines_and_cosines() {
        let (mut worst, mut angle) = (0.0_f64, -40.0_f64);
        while angle < 40.0 {
            let (sin, cos) = sin_cos(angle);
            worst = worst.max((sin - angle.sin()).abs()).max((cos - angle.cos()).abs());
            angle += 0.003;
        }
        let (sin, cos) = sin_cos(1_000_000.0);
        worst = worst.max((sin - 1_000_000_f64.sin()).abs()).max((cos - 1_000_000_f64.cos()).abs());
        assert!(worst < 1e-15, "{worst:e}");
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
    }

    /// The example of the extension's text: "the lower left quadrant of the source image".
    #[test]
    fn rotation_turns_as_in_the_extension_s_example() {
        let quadrant = transform([0.0, 1.0], std::f32::consts::FRAC_PI_2, [0.5, 0.5]).unwrap();
        let near = |uv, [u, v]: [f32; 2]| {
            let [found_u, found_v] = quadrant.apply(uv);
            assert!((found_u - u).abs() < 1e-6 && (found_v - v).abs() < 1e-6, "{uv:?}: {found_u}, {found_v}");
        };
        near([0.0, 0.0], [0.0, 1.0]);
        near([1.0, 0.0], [0.0, 0.5]);
        near([0.0, 1.0], [0.5, 1.0]);
        near([1.0, 1.0], [0.5, 0.5]);
    }

    #[test]
    fn scale_comes_before_rotation_and_offset_last() {
        let flip = transform([0.0, 1.0], 0.0, [1.0, -1.0]).unwrap();
        assert_eq!(flip.apply([0.25, 0.125]), [0.25, 0.875]);
        let [u, v] = transform([10.0, 20.0], std::f32::consts::FRAC_PI_2, [2.0, 3.0]).unwrap().apply([1.0, 1.0]);
        assert!((u - 13.0).abs() < 1e-5 && (v - 18.0).abs() < 1e-5, "{u}, {v}");
    }

    #[test]
    fn numbers_without_meaning_are_refused() {
        assert_eq!(transform([f32::INFINITY, 0.0], 0.0, [1.0; 2]), None);
        assert_eq!(transform([0.0; 2], f32::NAN, [1.0; 2]), None);
        assert_eq!(transform([0.0; 2], 1e30, [1.0; 2]), None);
    }
}
