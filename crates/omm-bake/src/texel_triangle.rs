//! A mesh triangle in texel coordinates, and the corners of its microtriangles: rounded with a bound, and exact.

use num_bigint::BigInt;
use omm_model::curve::Corner;
use omm_model::level::SubdivisionLevel;

use crate::exact::{ExactTriangle, Integer};
use crate::texture::Texture;

/// No texel coordinate (u times the width, v times the height) of a triangle that can be baked is further from 0: 2^30.
///
/// Coordinates so large name no texel reliably in any shader, and integers stay within 64 bits below it.
pub const MAX_COORDINATE: f64 = 1_073_741_824.0;

/// The texture coordinates of a mesh triangle, scaled to the texels of a texture.
///
/// The three points may lie on a line or in one place: then so do all microtriangles, and their states are those of the line or
/// point.
#[derive(Clone, Debug)]
pub struct TexelTriangle {
    /// u * width of each vertex: exact, a product of 24 and 17 bits.
    x: [f64; 3],
    /// v * height of each vertex.
    y: [f64; 3],
    /// Bound on the rounding of a microtriangle's coordinates; see [`Corners::epsilon`].
    epsilon: f64,
    /// What the points are made of, for integers.
    uvs: [[f32; 2]; 3],
    size: [u32; 2],
}

/// Why a triangle cannot be baked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TexelTriangleError {
    /// A texture coordinate is NaN or infinite.
    #[error("a texture coordinate is not a finite number")]
    NotFinite,
    /// A texel coordinate is further from 0 than [`MAX_COORDINATE`].
    #[error("a texture coordinate is more than {MAX_COORDINATE} texels from the origin")]
    OutOfRange,
}

/// The corners of a microtriangle in texel coordinates, rounded.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corners {
    pub(crate) x: [f64; 3],
    pub(crate) y: [f64; 3],
    /// The unit of all error bounds: 2^-49 times a number M that no texel coordinate of the triangle plus one exceeds.
    /// Each coordinate is off by less than a fifth of it.
    pub(crate) epsilon: f64,
}

enum Fixed {
    /// Everything that a microtriangle's corners need fits in 127 bits.
    Narrow(FixedTriangle<i128>),
    Wide(FixedTriangle<BigInt>),
}

/// Texel coordinates in units of 2^-`fraction_bits`.
struct FixedTriangle<T> {
    x: [T; 3],
    y: [T; 3],
    fraction_bits: u32,
}

impl TexelTriangle {
    /// The triangle with texture coordinates `uvs`, over `texture`.
    ///
    /// # Errors
    /// [`TexelTriangleError`] if a coordinate is not finite, or too far out to name a texel.
    pub fn new(uvs: [[f32; 2]; 3], texture: &Texture) -> Result<Self, TexelTriangleError> {
        if !uvs.iter().flatten().all(|coordinate| coordinate.is_finite()) {
            return Err(TexelTriangleError::NotFinite);
        }
        let (width, height) = (texture.width(), texture.height());
        let x = uvs.map(|[u, _]| f64::from(u) * f64::from(width));
        let y = uvs.map(|[_, v]| f64::from(v) * f64::from(height));
        let farthest = x.iter().chain(&y).fold(0.0_f64, |most, coordinate| most.max(coordinate.abs()));
        if farthest > MAX_COORDINATE {
            return Err(TexelTriangleError::OutOfRange);
        }
        // 2^-49, and the sum may round down by less than the factor makes up.
        let epsilon = (farthest + 1.0) * (1.0 + f64::EPSILON) / 562_949_953_421_312.0;
        Ok(Self { x, y, epsilon, uvs, size: [width, height] })
    }

    /// The area in texels, rounded.
    #[must_use]
    pub fn area(&self) -> f64 {
        let [[x0, x1, x2], [y0, y1, y2]] = [self.x, self.y];
        ((x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0)).abs() / 2.0
    }

    /// The microtriangle with corners `weights`, which are in units of 2^-`level`; `shift` is subtracted from each coordinate.
    ///
    /// The weights of a level are integers of at most 12 significant bits, and `x` has 41, so the products are exact; two
    /// additions and the subtraction of the shift round, by no more than 2^-53 M each plus lower order: 3.1 * 2^-53 M in all,
    /// less than a fifth of epsilon.
    pub(crate) fn corners(&self, weights: [Corner; 3], level: SubdivisionLevel, shift: f64) -> Corners {
        let segments = level.segments();
        let unit = 1.0 / f64::from(segments);
        let point = |of: &[f64; 3], corner: Corner| {
            let first = f64::from(segments - corner.u - corner.v) * of[0];
            (first + f64::from(corner.u) * of[1] + f64::from(corner.v) * of[2]) * unit - shift
        };
        let [a, b, c] = weights;
        let x = [point(&self.x, a), point(&self.x, b), point(&self.x, c)];
        let y = [point(&self.y, a), point(&self.y, b), point(&self.y, c)];
        Corners { x, y, epsilon: self.epsilon }
    }

    /// By how much x and y change from a corner with weights (u, v) to those with (u + 1, v) and (u, v + 1), in units of
    /// 2^-`level`. Each is off by a rounding of a number of at most 2 M, divided by the segments.
    pub(crate) fn steps(&self, level: SubdivisionLevel) -> [[f64; 2]; 2] {
        let unit = 1.0 / f64::from(level.segments());
        [1, 2].map(|vertex| [(self.x[vertex] - self.x[0]) * unit, (self.y[vertex] - self.y[0]) * unit])
    }

    /// The same corners without rounding. `half` subtracts one half from each coordinate.
    pub(crate) fn exact_corners(&self, weights: [Corner; 3], level: SubdivisionLevel, half: bool) -> Exact {
        let [width, height] = self.size;
        match Fixed::new(self.uvs, width, height) {
            Fixed::Narrow(fixed) => Exact::Narrow(fixed.corners(weights, level, half)),
            Fixed::Wide(fixed) => Exact::Wide(fixed.corners(weights, level, half)),
        }
    }
}

/// An exact triangle in the integers that hold it.
#[derive(Clone, Debug)]
pub(crate) enum Exact {
    Narrow(ExactTriangle<i128>),
    Wide(ExactTriangle<BigInt>),
}

/// A finite `f32` as mantissa times 2^exponent; the mantissa is odd or 0.
fn decode(value: f32) -> (i64, i32) {
    let bits = value.to_bits();
    let (biased, fraction) = (bits >> 23 & 0xff, i64::from(bits & 0x007f_ffff));
    let (mantissa, exponent) = if biased == 0 { (fraction, -149) } else { (fraction | 1 << 23, biased as i32 - 150) };
    if mantissa == 0 {
        return (0, 0);
    }
    let zeros = mantissa.trailing_zeros();
    let magnitude = mantissa >> zeros;
    (if bits >> 31 == 1 { -magnitude } else { magnitude }, exponent + zeros as i32)
}

impl Fixed {
    fn new(uvs: [[f32; 2]; 3], width: u32, height: u32) -> Self {
        let parts = uvs.map(|uv| uv.map(decode));
        let least = parts.iter().flatten().map(|&(_, exponent)| exponent).min().unwrap_or(0).min(0);
        let fraction_bits = least.unsigned_abs();
        // A coordinate below 2^30 takes 30 + fraction_bits, a corner 12 (the level) and 2 (the half and the sign) more.
        if fraction_bits <= 80 {
            Self::Narrow(FixedTriangle::new(parts, fraction_bits, width, height))
        } else {
            Self::Wide(FixedTriangle::new(parts, fraction_bits, width, height))
        }
    }
}

impl<T: Integer> FixedTriangle<T> {
    fn new(parts: [[(i64, i32); 2]; 3], fraction_bits: u32, width: u32, height: u32) -> Self {
        // The exponent is at least -fraction_bits; that of a number below 2^30 is below 30.
        let fixed = |(mantissa, exponent): (i64, i32), size: u32| {
            T::from(mantissa * i64::from(size)) << (exponent + fraction_bits as i32) as u32
        };
        Self { x: parts.map(|[u, _]| fixed(u, width)), y: parts.map(|[_, v]| fixed(v, height)), fraction_bits }
    }

    fn corners(&self, weights: [Corner; 3], level: SubdivisionLevel, half: bool) -> ExactTriangle<T> {
        let segments = level.segments();
        let bits = self.fraction_bits + level.get();
        let point = |of: &[T; 3], corner: Corner| {
            let term = |weight: u32, value: &T| T::from(i64::from(weight)) * value.clone();
            let sum = term(segments - corner.u - corner.v, &of[0]) + term(corner.u, &of[1]) + term(corner.v, &of[2]);
            if half { (sum << 1) - (T::one() << bits) } else { sum }
        };
        let x = weights.map(|corner| point(&self.x, corner));
        let y = weights.map(|corner| point(&self.y, corner));
        ExactTriangle::new(x, y, if half { bits + 1 } else { bits })
    }
}

#[cfg(test)]
mod tests {
    use omm_model::curve::MicroTriangle;

    use super::*;

    #[test]
    fn floats_decode_to_odd_mantissas() {
        assert_eq!(decode(0.0), (0, 0));
        assert_eq!(decode(-0.0), (0, 0));
        assert_eq!(decode(-1.5), (-3, -1));
        assert_eq!(decode(1_048_576.0), (1, 20));
        assert_eq!(decode(f32::from_bits(1)), (1, -149));
        assert_eq!(decode(-f32::MIN_POSITIVE), (-1, -126));
    }

    #[test]
    fn what_cannot_be_baked() {
        let texture = Texture::unorm8(1024, 1, vec![0; 1024]).unwrap();
        let new = |u, v| TexelTriangle::new([[0.0; 2], [u, v], [0.5; 2]], &texture).err();
        assert_eq!(new(f32::NAN, 0.0), Some(TexelTriangleError::NotFinite));
        assert_eq!(new(f32::MAX, f32::INFINITY), Some(TexelTriangleError::NotFinite));
        assert_eq!(new(1_048_576.0, -1_073_741_824.0), None);
        assert_eq!(new(1_048_577.0, 0.0), Some(TexelTriangleError::OutOfRange));
        assert_eq!(new(0.0, -f32::MAX), Some(TexelTriangleError::OutOfRange));
    }

    /// Rounded and exact corners agree within the bound, also for coordinates of very different size.
    #[test]
    fn rounded_corners_are_within_the_bound() {
        let texture = Texture::unorm8(61, 37, vec![0; 61 * 37]).unwrap();
        let shapes = [
            [[0.1_f32, 0.2], [0.93, 0.31], [0.55, 0.77]],
            [[1e-20, -3.0], [1e-3, 1000.1], [-17.3, 1e-40]],
            [[1e7, 1e7], [1e7 + 1.0, 1e7], [1e7, 1e-6]],
        ];
        for uvs in shapes {
            let triangle = TexelTriangle::new(uvs, &texture).unwrap();
            for level in SubdivisionLevel::all() {
                for index in [0, level.microtriangles() / 3, level.microtriangles() - 1] {
                    let weights = MicroTriangle::new(level, index).unwrap().corners();
                    for half in [false, true] {
                        let found = triangle.corners(weights, level, if half { 0.5 } else { 0.0 });
                        let (x, y) = match triangle.exact_corners(weights, level, half) {
                            Exact::Narrow(exact) => exact.to_f64(),
                            Exact::Wide(exact) => exact.to_f64(),
                        };
                        for (found, exact) in found.x.iter().chain(&found.y).zip(x.iter().chain(&y)) {
                            // The expected value is itself rounded by the conversion.
                            assert!((found - exact).abs() <= triangle.epsilon / 4.0, "{found} {exact}");
                        }
                    }
                }
            }
        }
    }
}
