//! Nearest filter: which texels does a closed triangle touch? In integers, so that an edge on a texel boundary is exactly there.
//!
//! Texel (i, j) is the half-open square from (i, j) to (i + 1, j + 1). The part of the triangle in one row of texels is convex, so it
//! touches all texels between its leftmost and its rightmost point. Those are on the edges: at corners within the row, where an edge
//! enters at the row's lower bound, or where one leaves towards the upper bound. The upper bound itself does not belong to the row,
//! so an end there is *open*: points come as close as they like to it. If the leftmost point is an open end, points just right
//! of it are on the triangle, hence in texel floor(x) all the same; if the rightmost one is, then points just left of it are, in texel
//! ceil(x) - 1. (An edge that approaches its open end from the other side has a corner or a lower end further out.)

use super::{Budget, Classification, Node, OverBudget, Sides, cell_budget};
use crate::exact::{ExactTriangle, Integer};
use crate::surface::Surface;
use crate::texel_triangle::{Exact, TexelTriangle};

/// With corners of this many bits every product below fits in an `i128`: the largest is a sum of two products of a coordinate and
/// a difference of coordinates.
const NARROW_BITS: u64 = 60;

/// The classification of `node`, exactly.
pub(super) fn scan(surface: &Surface<'_>, triangle: &TexelTriangle, node: Node) -> Classification {
    let seen = match triangle.exact_corners(node.weights, node.level, false) {
        Exact::Narrow(narrow) if narrow.bits() <= NARROW_BITS => scan_rows(surface, &narrow),
        Exact::Narrow(narrow) => scan_rows(surface, &narrow.widen()),
        Exact::Wide(wide) => scan_rows(surface, &wide),
    };
    match seen {
        Err(OverBudget) => Classification::Undecided,
        Ok(Sides { above: true, below: true }) => Classification::Mixed,
        Ok(Sides { above, below: _ }) => Classification::of_side(above),
    }
}

/// The sides of all texels that the triangle touches, up to the first pair that differs.
fn scan_rows<T: Integer>(surface: &Surface<'_>, triangle: &ExactTriangle<T>) -> Result<Sides<bool>, OverBudget> {
    let mut seen = Sides::default();
    let mut budget = Budget(cell_budget(surface.texture()));
    let (columns, rows) = (surface.columns(), surface.rows());
    let [first, last] = [triangle.y.iter().min(), triangle.y.iter().max()]
        .map(|y| rows.cell(y.map_or(0, |y| floor(y, &triangle.scale)) + triangle.base[1]));
    for row in first..=last {
        budget.spend()?;
        let Some([left, right]) = row_extent(triangle, rows.lower(row), rows.upper(row)) else { continue };
        let [left, right] = [left, right].map(|x| columns.cell(x + triangle.base[0]));
        // Beyond one period the same texels come again.
        let right = columns.period().map_or(right, |period| right.min(left + period - 1));
        for column in left..=right {
            budget.spend()?;
            if surface.is_above(column, row) {
                seen.above = true;
            } else {
                seen.below = true;
            }
            if seen.above && seen.below {
                return Ok(seen);
            }
        }
    }
    Ok(seen)
}

/// floor(value / by); `by` is positive. The quotient is a texel relative to the triangle's base, within 2^32.
fn floor<T: Integer>(value: &T, by: &T) -> i64 {
    value.div_euclid(by).to_i64().unwrap_or(0)
}

/// The first and the last texel that the triangle touches in the row from `lower` (which belongs to it) to `upper` (which does
/// not), relative to its base.
fn row_extent<T: Integer>(triangle: &ExactTriangle<T>, lower: Option<i64>, upper: Option<i64>) -> Option<[i64; 2]> {
    let [lower, upper] = [lower, upper].map(|bound| bound.map(|bound| triangle.bound(1, bound)));
    let scale = &triangle.scale;
    let mut extent: Option<[i64; 2]> = None;
    let mut add = |least: i64, most: i64| {
        extent = Some(extent.map_or([least, most], |[left, right]| [left.min(least), right.max(most)]));
    };
    for edge in 0..3 {
        let [mut a, mut b] = triangle.edge(edge);
        if a.1 > b.1 {
            std::mem::swap(&mut a, &mut b);
        }
        let (from, to) = (a.1, b.1);
        let ends_below = lower.as_ref().is_some_and(|lower| to < lower);
        let starts_above = upper.as_ref().is_some_and(|upper| from >= upper);
        if ends_below || starts_above {
            continue;
        }
        // x * (to - from) where the edge is at height y, and what to divide it by.
        let height = to.clone() - from.clone();
        let numerator = |y: &T| a.0.clone() * height.clone() + (y.clone() - from.clone()) * (b.0.clone() - a.0.clone());
        let divisor = || height.clone() * scale.clone();
        match &lower {
            Some(lower) if from < lower => {
                let x = floor(&numerator(lower), &divisor());
                add(x, x);
            }
            _ => {
                let x = floor(a.0, scale);
                add(x, x);
            }
        }
        match &upper {
            Some(upper) if to >= upper => {
                let (x, by) = (numerator(upper), divisor());
                // ceil(x) - 1 is floor((x - 1) / by) in integers.
                add(floor(&x, &by), floor(&(x - T::one()), &by));
            }
            _ => {
                let x = floor(b.0, scale);
                add(x, x);
            }
        }
    }
    extent
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The texels that a triangle touches in each row, corners in quarters of a texel.
    fn touched(corners: [[i128; 2]; 3]) -> Vec<(i64, i64, i64)> {
        let triangle = ExactTriangle::<i128>::new(corners.map(|c| c[0]), corners.map(|c| c[1]), 2);
        let wide = triangle.widen();
        (-3..6)
            .filter_map(|row| {
                let extent = row_extent(&triangle, Some(row), Some(row + 1));
                assert_eq!(extent, row_extent(&wide, Some(row), Some(row + 1)));
                extent.map(|[left, right]| (row, left + triangle.base[0], right + triangle.base[0]))
            })
            .collect()
    }

    #[test]
    fn upper_bounds_do_not_belong_to_a_texel() {
        // The lower left half of texel (0, 0): its corners at (1, 0) and (0, 1) are in the next texels.
        assert_eq!(touched([[0, 0], [4, 0], [0, 4]]), [(0, 0, 1), (1, 0, 0)]);
        // The upper right half: the side at x = 1 is in texel column 1.
        assert_eq!(touched([[4, 0], [4, 4], [0, 4]]), [(0, 0, 1), (1, 0, 1)]);
        // A corner that points down to (1, 1) touches only texel (1, 1) there; the row above is wider.
        assert_eq!(touched([[4, 4], [2, 6], [6, 6]]), [(1, 0, 1)]);
        // The left edge reaches (1, 1) from below: open there, and closed at (2, 0).
        assert_eq!(touched([[8, 0], [4, 4], [8, 4]]), [(0, 1, 2), (1, 1, 2)]);
        // The right edge reaches (1, 1) from below: no point of row 0 is at x = 1.
        assert_eq!(touched([[0, 0], [4, 4], [0, 4]]), [(0, 0, 0), (1, 0, 1)]);
    }

    #[test]
    fn points_and_lines() {
        assert_eq!(touched([[4, 4]; 3]), [(1, 1, 1)]);
        assert_eq!(touched([[-1, 7]; 3]), [(1, -1, -1)]);
        assert_eq!(touched([[-4, 4], [8, 4], [0, 4]]), [(1, -1, 2)]);
        assert_eq!(touched([[4, -4], [4, 4], [4, 0]]), [(-1, 1, 1), (0, 1, 1), (1, 1, 1)]);
        assert_eq!(touched([[0, 0], [8, 8], [4, 4]]), [(0, 0, 0), (1, 1, 1), (2, 2, 2)]);
        assert_eq!(touched([[8, 0], [0, 8], [4, 4]]), [(0, 1, 2), (1, 0, 1), (2, 0, 0)]);
    }

    #[test]
    fn rows_without_end() {
        let triangle = ExactTriangle::<i128>::new([0, 4, 40], [-400, -400, 400], 2);
        assert_eq!(row_extent(&triangle, None, Some(0)), Some([0, 5]));
        assert_eq!(row_extent(&triangle, Some(0), None), Some([5, 10]));
        assert_eq!(row_extent(&triangle, None, Some(-100)), None);
    }
}
