//! Exact integers: the triangle that no rounding has touched.

use std::ops::Shl;

use num_bigint::BigInt;
use num_traits::{Euclid, Signed, ToPrimitive};

/// What exact arithmetic needs of an integer. `i128` where a bound on the bits has been shown, `BigInt` elsewhere.
pub(crate) trait Integer:
    Clone + Ord + Signed + Euclid + ToPrimitive + From<i64> + From<i128> + Shl<u32, Output = Self>
{
    /// Bits of the magnitude.
    fn magnitude_bits(&self) -> u64;
}

impl Integer for i128 {
    fn magnitude_bits(&self) -> u64 {
        (Self::BITS - self.unsigned_abs().leading_zeros()).into()
    }
}

impl Integer for BigInt {
    fn magnitude_bits(&self) -> u64 {
        self.bits()
    }
}

/// A triangle whose corners are `base` + (`x`, `y`) / `scale`, exactly.
#[derive(Clone, Debug)]
pub(crate) struct ExactTriangle<T> {
    pub(crate) x: [T; 3],
    pub(crate) y: [T; 3],
    /// A power of two.
    pub(crate) scale: T,
    /// Integers that were taken out so that `x` and `y` are not negative and no larger than the triangle's extent plus one.
    pub(crate) base: [i64; 2],
}

impl<T: Integer> ExactTriangle<T> {
    /// The triangle with corners (`x`, `y`) * 2^-`bits`, none of which is further than 2^31 from 0.
    pub(crate) fn new(x: [T; 3], y: [T; 3], bits: u32) -> Self {
        let scale = T::one() << bits;
        let from_base = |values: [T; 3]| {
            let least = values.iter().min().map_or_else(T::zero, |least| least.div_euclid(&scale));
            let start = least.clone() * scale.clone();
            // Within 2^31 by the bound on the corners.
            (values.map(|value| value - start.clone()), least.to_i64().unwrap_or(0))
        };
        let ((x, base_x), (y, base_y)) = (from_base(x), from_base(y));
        Self { x, y, scale, base: [base_x, base_y] }
    }

    /// Bits of the largest number in it.
    pub(crate) fn bits(&self) -> u64 {
        let all = self.x.iter().chain(&self.y).chain([&self.scale]);
        all.map(Integer::magnitude_bits).max().unwrap_or(0)
    }

    /// Twice the signed area, in units of 1 / `scale`^2.
    pub(crate) fn doubled_area(&self) -> T {
        self.orient(0, &self.x[2], &self.y[2])
    }

    /// Which side of edge `edge` (from corner `edge` to the next) the point (`x`, `y`) / `scale` is on: positive, negative, or 0 on
    /// its line.
    pub(crate) fn orient(&self, edge: usize, x: &T, y: &T) -> T {
        let [(x0, y0), (x1, y1)] = self.edge(edge);
        let difference = |a: &T, b: &T| a.clone() - b.clone();
        difference(x1, x0) * difference(y, y0) - difference(y1, y0) * difference(x, x0)
    }

    /// The end points of edge `edge`, `0..3`.
    pub(crate) fn edge(&self, edge: usize) -> [(&T, &T); 2] {
        let next = (edge + 1) % 3;
        [(&self.x[edge], &self.y[edge]), (&self.x[next], &self.y[next])]
    }

    /// A bound at integer coordinate `bound` as it stands relative to the base, along axis 0 (x) or 1 (y).
    pub(crate) fn bound(&self, axis: usize, bound: i64) -> T {
        T::from(bound - self.base[axis]) * self.scale.clone()
    }
}

impl ExactTriangle<i128> {
    /// The same triangle in integers without end.
    pub(crate) fn widen(&self) -> ExactTriangle<BigInt> {
        let Self { x, y, scale, base } = self;
        ExactTriangle { x: x.map(BigInt::from), y: y.map(BigInt::from), scale: BigInt::from(*scale), base: *base }
    }
}

/// Finite `f64`s as integers in one unit, a power of two that they share.
pub(crate) enum CommonIntegers<const N: usize> {
    /// They have at most 120 bits.
    Narrow([i128; N]),
    /// They have more.
    Wide([BigInt; N]),
}

impl<const N: usize> CommonIntegers<N> {
    /// `values` divided by the largest power of two that leaves integers.
    pub(crate) fn new(values: [f64; N]) -> Self {
        let parts = values.map(decode);
        let least = parts.iter().filter(|part| part.0 != 0).map(|part| part.1).min().unwrap_or(0);
        // Exponents of f64 differ by less than 2200; a zero has no exponent of its own.
        let shift = |(mantissa, exponent): (i64, i32)| if mantissa == 0 { 0 } else { (exponent - least) as u32 };
        let bits = |part: (i64, i32)| 64 - part.0.unsigned_abs().leading_zeros() + shift(part);
        if parts.iter().all(|&part| bits(part) <= 120) {
            Self::Narrow(parts.map(|part| i128::from(part.0) << shift(part)))
        } else {
            Self::Wide(parts.map(|part| BigInt::from(part.0) << shift(part)))
        }
    }
}

/// A finite `f64` as mantissa times 2^exponent; the mantissa is odd or 0.
fn decode(value: f64) -> (i64, i32) {
    let bits = value.to_bits();
    let (biased, fraction) = ((bits >> 52 & 0x7ff) as i32, (bits & 0x000f_ffff_ffff_ffff) as i64);
    let (mantissa, exponent) = if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
    if mantissa == 0 {
        return (0, 0);
    }
    let zeros = mantissa.trailing_zeros();
    let magnitude = mantissa >> zeros;
    (if value < 0.0 { -magnitude } else { magnitude }, exponent + zeros as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    impl<T: Integer> ExactTriangle<T> {
        /// The corners, rounded, with the base put back.
        pub(crate) fn to_f64(&self) -> ([f64; 3], [f64; 3]) {
            let scale = self.scale.to_f64().unwrap();
            let back = |values: &[T; 3], base: i64| values.clone().map(|v| v.to_f64().unwrap() / scale + base as f64);
            (back(&self.x, self.base[0]), back(&self.y, self.base[1]))
        }
    }

    #[test]
    fn common_integers_keep_ratios() {
        let CommonIntegers::Narrow(found) = CommonIntegers::new([0.0, -1.5, 255.0, 0.125]) else { panic!("narrow") };
        assert_eq!(found, [0, -12, 2040, 1]);
        let CommonIntegers::Wide(found) = CommonIntegers::new([1e20, 1e-20, 0.0]) else { panic!("wide") };
        assert_eq!(found[0].to_f64().unwrap() / found[1].to_f64().unwrap(), 1e20 / 1e-20);
        assert_eq!(found[2], BigInt::from(0));
    }

    #[test]
    fn the_base_is_taken_out() {
        let triangle = ExactTriangle::<i128>::new([-9, -1, 3], [16, 17, 40], 2);
        assert_eq!((triangle.base, triangle.x, triangle.y), ([-3, 4], [3, 11, 15], [0, 1, 24]));
        assert_eq!(triangle.bound(0, -1), 8);
        assert_eq!(triangle.doubled_area(), 8 * 24 - 12);
        assert_eq!(triangle.widen().doubled_area(), BigInt::from(180));
    }
}
