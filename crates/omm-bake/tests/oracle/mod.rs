//! What a microtriangle is, by brute force in rational numbers: the triangle is clipped against every cell, and the bilinear surface is
//! evaluated at the clipped polygon's corners and where it turns along its sides. Nothing is shared with the baker.

#![allow(dead_code, unreachable_pub)]

use std::ops::RangeInclusive;

use num_bigint::BigInt;
use num_rational::{BigRational, Ratio};
use num_traits::{Num, ToPrimitive};
use omm_bake::{AddressMode, Classification, Filter};

/// Rational numbers, with and without a limit on their size.
pub trait Rational: Num + Clone + PartialOrd {
    fn integer(value: i64) -> Self;
    fn exact(value: f64) -> Self;
    fn floor_to_i64(&self) -> i64;
}

impl Rational for BigRational {
    fn integer(value: i64) -> Self {
        Self::from(BigInt::from(value))
    }
    fn exact(value: f64) -> Self {
        Self::from_float(value).unwrap()
    }
    fn floor_to_i64(&self) -> i64 {
        self.floor().to_integer().to_i64().unwrap()
    }
}

/// For coordinates and values of few bits; overflow panics.
impl Rational for Ratio<i128> {
    fn integer(value: i64) -> Self {
        Self::from(i128::from(value))
    }
    fn exact(value: f64) -> Self {
        let big = BigRational::from_float(value).unwrap();
        Self::new(big.numer().to_i128().unwrap(), big.denom().to_i128().unwrap())
    }
    fn floor_to_i64(&self) -> i64 {
        self.floor().to_integer().to_i64().unwrap()
    }
}

/// A texture with sampler and cutoff.
pub struct Scene<'a> {
    pub width: i64,
    pub height: i64,
    /// Alpha is `values[y * width + x] / unit`.
    pub values: &'a [f64],
    pub unit: f64,
    /// Along u and v.
    pub address_modes: [AddressMode; 2],
    pub filter: Filter,
    pub border: f32,
    pub cutoff: f32,
}

type Point<R> = (R, R);

impl Scene<'_> {
    /// The corners of a microtriangle, from the weights of vertices 1 and 2 in units of 2^-level.
    pub fn corners<R: Rational>(uvs: [[f32; 2]; 3], weights: [(u32, u32); 3], level: u32) -> [Point<R>; 3] {
        let n = R::integer(1 << level);
        let coordinate = |axis: usize, (a, b): (u32, u32)| {
            let [v0, v1, v2] = uvs.map(|uv| R::exact(uv[axis].into()));
            let (a, b) = (R::integer(a.into()) / n.clone(), R::integer(b.into()) / n.clone());
            v0 * (R::one() - a.clone() - b.clone()) + v1 * a + v2 * b
        };
        weights.map(|weights| (coordinate(0, weights), coordinate(1, weights)))
    }

    /// The classification of the closed triangle with these texture coordinates.
    pub fn classify<R: Rational>(&self, uvs: [Point<R>; 3]) -> Classification {
        let half = R::one() / R::integer(2);
        let shift = if self.filter == Filter::Linear { half } else { R::zero() };
        let triangle: Vec<Point<R>> = uvs
            .into_iter()
            .map(|(u, v)| (u * R::integer(self.width) - shift.clone(), v * R::integer(self.height) - shift.clone()))
            .collect();
        let (mut above, mut below) = (false, false);
        for j in range(&triangle, |p| &p.1) {
            for i in range(&triangle, |p| &p.0) {
                let (a, b) = match self.filter {
                    Filter::Nearest => self.texel_sides(&triangle, i, j),
                    Filter::Linear => self.cell_sides(&triangle, i, j, (above, below)),
                };
                above |= a;
                below |= b;
                if above && below {
                    return Classification::Mixed;
                }
            }
        }
        assert!(above || below, "a triangle has points");
        if above { Classification::Opaque } else { Classification::Transparent }
    }

    /// Alpha less the cutoff at integer texel coordinates, rounded; its sign is exact.
    pub fn rounded_difference(&self, x: i64, y: i64) -> f64 {
        let value = match (self.texel(0, x, self.width), self.texel(1, y, self.height)) {
            (Some(x), Some(y)) => self.values[(y * self.width + x) as usize],
            _ => f64::from(self.border) * self.unit,
        };
        // A product of a byte and an `f32` is exact.
        (value - f64::from(self.cutoff) * self.unit) / self.unit
    }

    /// Alpha less the cutoff at a point in texels, rounded; 0 if a nearest filter is within `margin` of another texel.
    pub fn rounded_value(&self, (x, y): (f64, f64), margin: f64) -> f64 {
        let (i, j) = (x.floor(), y.floor());
        let (a, b) = (x - i, y - j);
        let at = |p: i64, q: i64| self.rounded_difference(i as i64 + p, j as i64 + q);
        match self.filter {
            Filter::Nearest if [a, 1.0 - a, b, 1.0 - b].into_iter().any(|distance| distance < margin) => 0.0,
            Filter::Nearest => at(0, 0),
            Filter::Linear => {
                at(0, 0) * (1.0 - a) * (1.0 - b)
                    + at(1, 0) * a * (1.0 - b)
                    + at(0, 1) * (1.0 - a) * b
                    + at(1, 1) * a * b
            }
        }
    }

    /// Alpha less the cutoff at integer texel coordinates.
    fn difference<R: Rational>(&self, x: i64, y: i64) -> R {
        let alpha = match (self.texel(0, x, self.width), self.texel(1, y, self.height)) {
            (Some(x), Some(y)) => R::exact(self.values[(y * self.width + x) as usize]) / R::exact(self.unit),
            _ => R::exact(self.border.into()),
        };
        alpha - R::exact(self.cutoff.into())
    }

    fn texel(&self, axis: usize, k: i64, n: i64) -> Option<i64> {
        let once = if k < 0 { -k - 1 } else { k };
        match self.address_modes[axis] {
            AddressMode::Wrap => Some(((k % n) + n) % n),
            AddressMode::Mirror => Some(if (once / n) % 2 == 0 { once % n } else { n - 1 - once % n }),
            AddressMode::Clamp => Some(k.max(0).min(n - 1)),
            AddressMode::Border => (0 <= k && k < n).then_some(k),
            AddressMode::MirrorOnce => Some(once.min(n - 1)),
        }
    }

    /// Whether texel (i, j), a half-open square, is touched: the closed square is, at a point left of its right side and at one
    /// below its upper side. Between two such points lies one that is both.
    fn texel_sides<R: Rational>(&self, triangle: &[Point<R>], i: i64, j: i64) -> (bool, bool) {
        let clipped = clip(triangle, i, j);
        let (right, upper) = (R::integer(i + 1), R::integer(j + 1));
        if !(clipped.iter().any(|p| p.0 < right) && clipped.iter().any(|p| p.1 < upper)) {
            return (false, false);
        }
        let above = self.difference::<R>(i, j) > R::zero();
        (above, !above)
    }

    fn cell_sides<R: Rational>(&self, triangle: &[Point<R>], i: i64, j: i64, found: (bool, bool)) -> (bool, bool) {
        let d: [R; 4] = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| self.difference(i + x, j + y));
        let is_above = |value: &R| *value > R::zero();
        // A cell that can only show what has been found need not be looked at.
        if (found.0 || !d.iter().any(is_above)) && (found.1 || d.iter().all(is_above)) {
            return (false, false);
        }
        let value = |p: &Point<R>| {
            let (x, y) = (p.0.clone() - R::integer(i), p.1.clone() - R::integer(j));
            let lerp = |a: &R, b: &R, t: &R| a.clone() * (R::one() - t.clone()) + b.clone() * t.clone();
            lerp(&lerp(&d[0], &d[1], &x), &lerp(&d[2], &d[3], &x), &y)
        };
        let clipped = clip(triangle, i, j);
        let mut values: Vec<R> = clipped.iter().map(value).collect();
        let two = R::integer(2);
        for (k, a) in clipped.iter().enumerate() {
            let b = &clipped[(k + 1) % clipped.len()];
            let at = |t: R| {
                let along = |a: &R, b: &R| a.clone() + t.clone() * (b.clone() - a.clone());
                value(&(along(&a.0, &b.0), along(&a.1, &b.1)))
            };
            let (q0, q1, middle) = (at(R::zero()), at(R::one()), at(R::one() / two.clone()));
            let bend = two.clone() * (q0.clone() + q1.clone() - two.clone() * middle);
            if !bend.is_zero() {
                let turn = (bend.clone() - q1 + q0) / (two.clone() * bend);
                if turn > R::zero() && turn < R::one() {
                    values.push(at(turn));
                }
            }
        }
        (values.iter().any(is_above), !values.iter().all(is_above))
    }
}

/// The cells between the least and the greatest coordinate.
fn range<R: Rational>(triangle: &[Point<R>], of: impl Fn(&Point<R>) -> &R) -> RangeInclusive<i64> {
    let floors = || triangle.iter().map(|p| of(p).floor_to_i64());
    floors().min().unwrap()..=floors().max().unwrap()
}

/// The part of a polygon, which may be a line or a point, in the closed unit square at (i, j).
fn clip<R: Rational>(polygon: &[Point<R>], i: i64, j: i64) -> Vec<Point<R>> {
    // How far inside of a side of the square a point is.
    let distance = |side: usize, p: &Point<R>| match side {
        0 => p.0.clone() - R::integer(i),
        1 => R::integer(i + 1) - p.0.clone(),
        2 => p.1.clone() - R::integer(j),
        _ => R::integer(j + 1) - p.1.clone(),
    };
    let mut polygon = polygon.to_vec();
    for side in 0..4 {
        let mut kept = Vec::new();
        for (k, a) in polygon.iter().enumerate() {
            let b = &polygon[(k + 1) % polygon.len()];
            let (da, db) = (distance(side, a), distance(side, b));
            if da >= R::zero() {
                kept.push(a.clone());
            }
            if (da > R::zero() && db < R::zero()) || (da < R::zero() && db > R::zero()) {
                let t = da.clone() / (da - db);
                let along = |a: &R, b: &R| a.clone() + t.clone() * (b.clone() - a.clone());
                kept.push((along(&a.0, &b.0), along(&a.1, &b.1)));
            }
        }
        polygon = kept;
    }
    polygon
}
