//! Signs in `f64`, accepted only outside of an error bound.
//!
//! # The error bounds
//!
//! Let *h* = 2^-53 (half a unit in the last place of 1), *M* a number that no texel coordinate of the mesh triangle plus one exceeds,
//! ε = 16 *h M* = 2^-49 *M* (`Corners::epsilon`), and *R* the largest distance of any value that the sampler can meet from the cutoff.
//! Rounded quantities carry a hat.
//!
//! **Corners.** |x̂ - x| ≤ 3.1 *h M* < ε/5 for each coordinate of a corner; see `TexelTriangle::corners`.
//!
//! **Points of an edge.** For a floating-point number t in 0..=1 let x(t) be the point of the exact edge. What is computed,
//! x̂0 + t (x̂1 - x̂0), is off by ε/5 from the corners, and three roundings of numbers that do not exceed 2*M*: less than
//! ε/5 + 5.1 *h M* < ε.
//!
//! **The part of an edge in a cell** from l to r is bounded by t = (l - 4ε - x̂0) / (x̂1 - x̂0), and likewise for r + 4ε. All numbers are
//! at most 4*M*, so rounding moves the point that belongs to the computed t by less than ε, and the line through the rounded
//! corners is less than ε away from the edge: every t whose exact point is in the cell is in the computed interval, and every
//! point of the computed interval is less than 6ε outside the cell. An edge whose rounded ends have one coordinate in common
//! is either within l - 4ε..=r + 4ε or nowhere in the cell.
//!
//! **Values.** A cell's surface is d(α, β) = d00 + α gx + β gy + α β g, where the d are values less the cutoff and
//! |d| ≤ R, |gx|, |gy| ≤ 2R, |g| ≤ 4R. Its evaluation at α, β in -6ε..=1 + 6ε makes some 12 roundings of numbers up to 9R: less
//! than 7εR. The point itself is off by less than 1.2ε on each axis, which moves the value by less than 6εR. If the point is
//! outside the cell, the true surface there is another cell's; both agree at the cell's bound less than 7ε away on
//! each axis and neither changes faster than 2.1R, so they differ by less than 59εR.
//!
//! **Extremes on an edge.** Along the segment between two points of the cell with values a and b and Δα, Δβ apart, the surface is
//! a (1 - s) + b s - G s (1 - s) with G = g Δα Δβ. Where |b - a| < |G| it has an extreme between the ends,
//! (a + b)/2 - G/4 - (b - a)²/(4G); no term exceeds 4R, and rounding adds less than 5εR to what the values
//! carry. Where rounding makes |b - a| and |G| compare wrongly, the extreme is within 5εR of an end.
//!
//! All together stay below 90εR. **A value is above or below with certainty if it is further than 128εR from the cutoff.**
//!
//! **Inside.** The orientation of three points that are at most D apart, D from 1 to 4*M*, of which each coordinate is off by
//! ε/5, is off by less than 5εD. Beyond 8εD its sign is certain. A point of the triangle has, with respect to each edge, an
//! orientation between 0 and that of the third corner.
//!
//! What is certain never depends on a tie: a value that equals the cutoff, or is closer to it than the bound, is left to integers.

use crate::texel_triangle::Corners;

/// How sure the filter is that something exists or holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Certainty {
    /// It does not.
    #[default]
    No,
    /// Rounding decides.
    Maybe,
    /// It does.
    Yes,
}

impl Certainty {
    /// Whether `value` is above `margin`, or not even above `-margin`.
    pub(super) fn above(value: f64, margin: f64) -> Self {
        if value > margin {
            Self::Yes
        } else if value < -margin {
            Self::No
        } else {
            Self::Maybe
        }
    }
}

/// One cell of the grid and the surface over it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    /// Lower and upper bounds on x and y; infinite at the outer side of an end cell.
    pub(super) bounds: [[f64; 2]; 2],
    /// Values less the cutoff at (left, lower), (right, lower), (left, upper), (right, upper). Across an end cell they are the
    /// same.
    pub(super) values: [f64; 4],
}

impl Cell {
    /// The surface's value less the cutoff at a point in or close to the cell.
    pub(super) fn value(&self, x: f64, y: f64) -> f64 {
        let [d00, d10, d01, d11] = self.values;
        let (a, b) = (local(x, self.bounds[0]), local(y, self.bounds[1]));
        d00 + a * (d10 - d00) + b * (d01 - d00) + a * b * ((d11 - d10) - (d01 - d00))
    }

    /// The least and the greatest value on edge `edge` where it is in the cell; `None` if it is certainly not in it.
    pub(super) fn extremes_on_edge(&self, corners: &Corners, edge: usize) -> Option<[f64; 2]> {
        let edge = Edge::new(corners, edge);
        let mut span = [0.0, 1.0];
        span = edge.part(span, edge.x, self.bounds[0])?;
        span = edge.part(span, edge.y, self.bounds[1])?;
        let [(xa, ya), (xb, yb)] = span.map(|t| edge.point(t));
        let (a, b) = (self.value(xa, ya), self.value(xb, yb));
        let (least, most) = (a.min(b), a.max(b));
        let [d00, d10, d01, d11] = self.values;
        let along = |from: f64, to: f64, bounds: [f64; 2]| local(to, bounds) - local(from, bounds);
        let bend = ((d11 - d10) - (d01 - d00)) * along(xa, xb, self.bounds[0]) * along(ya, yb, self.bounds[1]);
        let rise = b - a;
        if rise.abs() < bend.abs() {
            let extreme = (a + b) / 2.0 - bend / 4.0 - rise * rise / (4.0 * bend);
            Some([least.min(extreme), most.max(extreme)])
        } else {
            Some([least, most])
        }
    }
}

/// The position within a cell, 0..=1; 0 in an end cell, where the surface does not depend on it.
fn local(coordinate: f64, [lower, upper]: [f64; 2]) -> f64 {
    if lower.is_finite() && upper.is_finite() { coordinate - lower } else { 0.0 }
}

/// An edge of a triangle with rounded corners, from t = 0 to t = 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) x: [f64; 2],
    pub(super) y: [f64; 2],
    epsilon: f64,
}

impl Edge {
    pub(super) fn new(corners: &Corners, edge: usize) -> Self {
        let next = (edge + 1) % 3;
        let Corners { x, y, epsilon } = *corners;
        Self { x: [x[edge], x[next]], y: [y[edge], y[next]], epsilon }
    }

    pub(super) fn point(&self, t: f64) -> (f64, f64) {
        let along = |[from, to]: [f64; 2]| from + t * (to - from);
        (along(self.x), along(self.y))
    }

    /// The part of `span` in which the coordinate with ends `ends` is within `bounds`, and a little more.
    pub(super) fn part(&self, span: [f64; 2], ends: [f64; 2], bounds: [f64; 2]) -> Option<[f64; 2]> {
        let [lower, upper] = [bounds[0] - 4.0 * self.epsilon, bounds[1] + 4.0 * self.epsilon];
        let [from, to] = ends;
        let rise = to - from;
        if rise == 0.0 {
            return (lower <= from && from <= upper).then_some(span);
        }
        let (a, b) = ((lower - from) / rise, (upper - from) / rise);
        let [start, end] = [span[0].max(a.min(b)), span[1].min(a.max(b))];
        (start <= end).then_some([start, end])
    }
}

/// The inside of a triangle with rounded corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interior {
    corners: Corners,
    /// Twice the signed area, and how far it may be off.
    doubled_area: f64,
    area_margin: f64,
}

impl Interior {
    pub(super) fn new(corners: &Corners) -> Self {
        let (doubled_area, area_margin) = orient(corners, 0, corners.x[2], corners.y[2]);
        Self { corners: *corners, doubled_area, area_margin }
    }

    /// Whether the closed triangle contains the exact point (`x`, `y`).
    pub(super) fn contains(&self, x: f64, y: f64) -> Certainty {
        let area = self.doubled_area.abs();
        let turn_is_certain = area > self.area_margin;
        let mut contains = if turn_is_certain { Certainty::Yes } else { Certainty::Maybe };
        for edge in 0..3 {
            let (orientation, margin) = orient(&self.corners, edge, x, y);
            let inwards = orientation * self.doubled_area.signum();
            let most = area + self.area_margin + margin;
            let least = if turn_is_certain { -margin } else { -most };
            if inwards > most || inwards < least {
                return Certainty::No;
            }
            if inwards <= margin {
                contains = Certainty::Maybe;
            }
        }
        contains
    }
}

/// The orientation of a point with respect to an edge, and beyond what its sign is certain.
fn orient(corners: &Corners, edge: usize, x: f64, y: f64) -> (f64, f64) {
    let next = (edge + 1) % 3;
    let Corners { x: xs, y: ys, epsilon } = corners;
    let (ax, ay) = (xs[next] - xs[edge], ys[next] - ys[edge]);
    let (bx, by) = (x - xs[edge], y - ys[edge]);
    let apart = ax.abs().max(ay.abs()).max(bx.abs()).max(by.abs()).max(1.0);
    (ax * by - ay * bx, 8.0 * epsilon * apart)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(x: [f64; 3], y: [f64; 3]) -> Corners {
        Corners { x, y, epsilon: 1e-12 }
    }

    #[test]
    fn extremes_between_the_ends_are_found() {
        // A saddle: 1 at two opposite corners, 0 at the others; along the diagonal it dips to 1/2.
        let cell = Cell { bounds: [[0.0, 1.0]; 2], values: [1.0, 0.0, 0.0, 1.0] };
        let diagonal = corners([-1.0, 3.0, -1.0], [-1.0, 3.0, 3.0]);
        let [least, most] = cell.extremes_on_edge(&diagonal, 0).unwrap();
        assert!((least - 0.5).abs() < 1e-9 && (most - 1.0).abs() < 1e-9);
        assert_eq!(cell.extremes_on_edge(&diagonal, 1), None);
    }

    #[test]
    fn end_cells_do_not_depend_on_the_position() {
        let infinite = f64::INFINITY;
        let cell = Cell { bounds: [[5.0, infinite], [0.0, 1.0]], values: [1.0, 1.0, 3.0, 3.0] };
        assert_eq!(cell.value(1e6, 0.5), 2.0);
        let long = corners([4.0, 1e6, 4.0], [0.25, 0.25, 9.0]);
        let [least, most] = cell.extremes_on_edge(&long, 0).unwrap();
        assert_eq!((least, most), (1.5, 1.5));
    }

    #[test]
    fn inside_is_certain_only_away_from_edges() {
        for (x, y) in [([0.0, 4.0, 0.0], [0.0, 0.0, 4.0]), ([0.0, 0.0, 4.0], [0.0, 4.0, 0.0])] {
            let interior = Interior::new(&corners(x, y));
            assert_eq!(interior.contains(1.0, 1.0), Certainty::Yes);
            assert_eq!(interior.contains(2.0, 2.0), Certainty::Maybe);
            assert_eq!(interior.contains(0.0, 1.0), Certainty::Maybe);
            assert_eq!(interior.contains(2.0, 2.1), Certainty::No);
            assert_eq!(interior.contains(-0.1, 1.0), Certainty::No);
        }
        let line = Interior::new(&corners([0.0, 4.0, 2.0], [0.0, 4.0, 2.0]));
        assert_eq!(line.contains(1.0, 1.0), Certainty::Maybe);
        assert_eq!(line.contains(1.0, 1.1), Certainty::No);
        assert_eq!(line.contains(1.1, 1.0), Certainty::No);
    }
}
