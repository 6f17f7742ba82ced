//! One cell without rounding: the sides of the cutoff that the surface has on the part of a triangle in a cell.
//!
//! A bilinear surface has no extreme inside a polygon (it is a saddle or flat), so the extremes over the closed triangle's part in a
//! closed cell are at the cell's corners within the triangle, or on the triangle's edges within the cell: at the ends of that
//! part of an edge, or where the surface along it, a quadratic in t, turns. (Along the cell's own bounds the surface is linear.)
//!
//! All numbers are integers: coordinates in units of 1/S, the parameter t as a fraction n/D, values in a common unit. Signs of
//! values at t = n/D are those of the value times (S D)^2; the sign at the turning point of A t^2 + B t + C is that of
//! (4 A C - B^2) A.

use std::cell::OnceCell;
use std::cmp::Ordering;

use num_bigint::BigInt;

use super::{Node, Sides};
use crate::exact::{CommonIntegers, ExactTriangle, Integer};
use crate::sampler::Axis;
use crate::surface::Surface;
use crate::texel_triangle::{Exact, TexelTriangle};

/// The exact corners of one microtriangle under a linear filter, in as many widths as were needed.
pub(super) struct ExactScan<'a> {
    surface: &'a Surface<'a>,
    exact: Exact,
    wide: OnceCell<ExactTriangle<BigInt>>,
}

impl<'a> ExactScan<'a> {
    pub(super) fn new(surface: &'a Surface<'a>, triangle: &TexelTriangle, node: Node) -> Self {
        Self { surface, exact: triangle.exact_corners(node.weights, node.level, true), wide: OnceCell::new() }
    }

    /// The sides on the closed triangle's part in cell (`column`, `row`), whose corner texels have the stored `values`. No side at
    /// all if it has no part there.
    pub(super) fn cell(&self, column: i64, row: i64, values: [f64; 4]) -> Sides<bool> {
        let bounds = |axis: &Axis, k| [axis.lower(k), axis.upper(k)];
        let bounds = [bounds(self.surface.columns(), column), bounds(self.surface.rows(), row)];
        let [d00, d10, d01, d11] = values;
        match (CommonIntegers::new([d00, d10, d01, d11, self.surface.threshold()]), &self.exact) {
            (CommonIntegers::Narrow(values), Exact::Narrow(triangle)) => {
                let above = above_threshold(values);
                // 4AC and B^2 are the largest numbers; see the module's documentation. Each value has at most `value` bits, each
                // coordinate `bits` and one for the difference; sums of up to four such terms take the remaining bits.
                let value = above.iter().map(Integer::magnitude_bits).max().unwrap_or(0) + 2;
                let bits = triangle.bits() + 1;
                if 2 * value + 4 * bits + 8 <= 126 {
                    sides(triangle, bounds, &above)
                } else {
                    sides(self.wide(), bounds, &above.map(BigInt::from))
                }
            }
            (CommonIntegers::Narrow(values), Exact::Wide(triangle)) => {
                sides(triangle, bounds, &above_threshold(values).map(BigInt::from))
            }
            (CommonIntegers::Wide(values), _) => sides(self.wide(), bounds, &above_threshold(values)),
        }
    }

    fn wide(&self) -> &ExactTriangle<BigInt> {
        match &self.exact {
            Exact::Narrow(narrow) => self.wide.get_or_init(|| narrow.widen()),
            Exact::Wide(wide) => wide,
        }
    }
}

/// The first four values less the fifth.
fn above_threshold<T: Integer>([d00, d10, d01, d11, threshold]: [T; 5]) -> [T; 4] {
    [d00, d10, d01, d11].map(|value| value - threshold.clone())
}

impl Sides<bool> {
    /// Adds the side of a value less the threshold: at the threshold it is not above.
    fn add(&mut self, above: bool) {
        if above {
            self.above = true;
        } else {
            self.below = true;
        }
    }
}

/// The sides on the closed triangle's part in the closed cell between `bounds` (x, then y), of which `values` are those at the corners
/// less the threshold.
fn sides<T: Integer>(triangle: &ExactTriangle<T>, bounds: [[Option<i64>; 2]; 2], values: &[T; 4]) -> Sides<bool> {
    let scaled = |axis: usize| bounds[axis].map(|bound| bound.map(|bound| triangle.bound(axis, bound)));
    let [x, y] = [scaled(0), scaled(1)];
    let mut seen = Sides::default();
    let area = triangle.doubled_area();
    // A triangle without area is its edges.
    if !area.is_zero() {
        for (corner, value) in values.iter().enumerate() {
            let (Some(x), Some(y)) = (&x[corner % 2], &y[corner / 2]) else { continue };
            let within = |edge| !(triangle.orient(edge, x, y) * area.signum()).is_negative();
            if (0..3).all(within) {
                seen.add(value.is_positive());
            }
        }
    }
    for edge in 0..3 {
        if seen.above && seen.below {
            break;
        }
        edge_sides(triangle, edge, [&x, &y], values, &mut seen);
    }
    seen
}

/// A fraction with a positive denominator.
#[derive(Clone, Debug)]
struct Fraction<T> {
    numerator: T,
    denominator: T,
}

impl<T: Integer> Fraction<T> {
    fn new(numerator: T, denominator: T) -> Self {
        if denominator.is_negative() {
            Self { numerator: -numerator, denominator: -denominator }
        } else {
            Self { numerator, denominator }
        }
    }

    fn compare(&self, other: &Self) -> Ordering {
        (self.numerator.clone() * other.denominator.clone()).cmp(&(other.numerator.clone() * self.denominator.clone()))
    }
}

/// One coordinate along an edge, relative to the cell: `start + t * rise`. Both are 0 across an end cell.
struct Coordinate<T> {
    start: T,
    rise: T,
}

/// Adds the sides on the part of edge `edge` in the cell.
fn edge_sides<T: Integer>(
    triangle: &ExactTriangle<T>,
    edge: usize,
    bounds: [&[Option<T>; 2]; 2],
    values: &[T; 4],
    seen: &mut Sides<bool>,
) {
    let [from, to] = triangle.edge(edge);
    let mut span = [
        Fraction { numerator: T::zero(), denominator: T::one() },
        Fraction { numerator: T::one(), denominator: T::one() },
    ];
    let ends = [[from.0, to.0], [from.1, to.1]];
    for (ends, bounds) in ends.into_iter().zip(bounds) {
        if !shorten(&mut span, ends, bounds) {
            return;
        }
    }
    let [x, y] = [0, 1].map(|axis| match bounds[axis] {
        [Some(lower), Some(_)] => Coordinate {
            start: ends[axis][0].clone() - lower.clone(),
            rise: ends[axis][1].clone() - ends[axis][0].clone(),
        },
        _ => Coordinate { start: T::zero(), rise: T::zero() },
    });
    // The surface along the edge, times S^2: a t^2 + b t + c.
    let [d00, d10, d01, d11] = values.clone();
    let scale = triangle.scale.clone();
    let (gx, gy) = (d10.clone() - d00.clone(), d01 - d00.clone());
    let g = d11 - d10 - gy.clone();
    let a = g.clone() * x.rise.clone() * y.rise.clone();
    let b = scale.clone() * (gx.clone() * x.rise.clone() + gy.clone() * y.rise.clone())
        + g.clone() * (x.start.clone() * y.rise + y.start.clone() * x.rise);
    let c = scale.clone() * (scale * d00 + gx * x.start.clone() + gy * y.start.clone()) + g * x.start * y.start;

    for t in &span {
        let Fraction { numerator: n, denominator: d } = t.clone();
        let value = (a.clone() * n.clone() + b.clone() * d.clone()) * n + c.clone() * d.clone() * d;
        seen.add(value.is_positive());
    }
    if !a.is_zero() {
        let turn = Fraction::new(-b.clone(), a.clone() + a.clone());
        if span[0].compare(&turn).is_lt() && turn.compare(&span[1]).is_lt() {
            let four = T::from(4_i64);
            let value = (four * a.clone() * c - b.clone() * b) * a.signum();
            seen.add(value.is_positive());
        }
    }
}

/// Takes from `span` what is outside the bounds on a coordinate that goes from the first to the second of `ends`; `false` if
/// nothing is left.
fn shorten<T: Integer>(span: &mut [Fraction<T>; 2], ends: [&T; 2], bounds: &[Option<T>; 2]) -> bool {
    let [from, to] = ends;
    let rise = to.clone() - from.clone();
    for (which, bound) in bounds.iter().enumerate() {
        let Some(bound) = bound else { continue };
        let lower = which == 0;
        if rise.is_zero() {
            let outside = if lower { from < bound } else { from > bound };
            if outside {
                return false;
            }
            continue;
        }
        let t = Fraction::new(bound.clone() - from.clone(), rise.clone());
        if lower == rise.is_positive() {
            // The edge enters the cell here.
            if span[0].compare(&t).is_lt() {
                span[0] = t;
            }
        } else if span[1].compare(&t).is_gt() {
            span[1] = t;
        }
    }
    span[0].compare(&span[1]).is_le()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sides on the cell from (0, 0) to (1, 1) of a triangle with corners in eighths, in both widths.
    fn unit_cell(corners: [[i128; 2]; 3], values: [i128; 4]) -> (bool, bool) {
        let triangle = ExactTriangle::<i128>::new(corners.map(|c| c[0]), corners.map(|c| c[1]), 3);
        let bounds = [[Some(0), Some(1)]; 2];
        let Sides { above, below } = sides(&triangle, bounds, &values);
        let wide = sides(&triangle.widen(), bounds, &values.map(BigInt::from));
        assert_eq!((above, below), (wide.above, wide.below));
        (above, below)
    }

    const ALL_OF_IT: [[i128; 2]; 3] = [[-9, -9], [40, -9], [-9, 40]];

    #[test]
    fn corners_of_the_cell() {
        // No edge is in the cell.
        assert_eq!(unit_cell(ALL_OF_IT, [1, 1, 1, -1]), (true, true));
        assert_eq!(unit_cell(ALL_OF_IT, [1, 1, 1, 2]), (true, false));
        assert_eq!(unit_cell(ALL_OF_IT, [0, 0, 0, -1]), (false, true));
        assert_eq!(unit_cell(ALL_OF_IT, [0, 0, 0, 1]), (true, true));
        let [a, b, c] = ALL_OF_IT;
        assert_eq!(unit_cell([a, c, b], [1, 1, 1, -1]), (true, true));
        // Elsewhere: no part, no side.
        assert_eq!(unit_cell([[9, 0], [20, 0], [9, 8]], [1, -1, 1, -1]), (false, false));
    }

    #[test]
    fn turns_along_an_edge() {
        // In the middle of the diagonal is the mean of all four.
        let diagonal = [[0, 0], [8, 8], [4, 4]];
        assert_eq!(unit_cell(diagonal, [9, -8, -8, 9]), (true, false));
        assert_eq!(unit_cell(diagonal, [9, -9, -9, 9]), (true, true));
        // The turn is at the middle, which this part does not reach.
        assert_eq!(unit_cell([[0, 0], [3, 3], [1, 1]], [9, -9, -9, 9]), (true, false));
    }

    #[test]
    fn points_and_touches() {
        // A single point with the value 0, and one beside it.
        assert_eq!(unit_cell([[4, 0]; 3], [1, -1, 5, 5]), (false, true));
        assert_eq!(unit_cell([[3, 0]; 3], [1, -1, 5, 5]), (true, false));
        // Only the corner (1, 1) is touched.
        assert_eq!(unit_cell([[8, 8], [20, 8], [8, 20]], [-1, -1, -1, 1]), (true, false));
        assert_eq!(unit_cell([[0, 16], [16, 0], [16, 16]], [-1, -1, -1, 0]), (false, true));
    }
}
