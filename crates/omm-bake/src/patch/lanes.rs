//! The three edges of a microtriangle at a time, in `f32`; the proof is with [`tile`](super::tile).
//!
//! Vectors have a number for each edge; a fourth fills them.

use glam::Vec4;

use super::cell::Cell;
use super::grid::{EDGES, Spot};
use super::tile::UNIT;

/// 2^-13 texel.
const WIDEN: f32 = 1.0 / 8192.0;

/// The edges of a microtriangle along an axis.
#[derive(Clone, Copy, Debug, Default)]
struct Axis {
    /// Where they start, from the anchor, in texels.
    start: Vec4,
    /// By how much the coordinate changes.
    by: Vec4,
    /// 1 / `by`; finite, as 0 times infinity is not a number.
    inverse: Vec4,
}

/// The edges of microtriangles of a grid, by half and axis.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Edges([[Axis; 2]; 2]);

impl Edges {
    /// Takes the steps of a grid.
    pub(super) fn set(&mut self, steps: [[i64; 2]; 2]) {
        for (half, axes) in self.0.iter_mut().enumerate() {
            for (axis, edges) in axes.iter_mut().enumerate() {
                // A step is at most 64 texels: where `f32` does not hold it exactly no tile is as large.
                let [a, b] = [steps[0][axis] as i32, steps[1][axis] as i32];
                let vector = |of: &dyn Fn([u32; 2], usize) -> i32| {
                    Vec4::from([0, 1, 2, 0].map(|k| of(EDGES[half][k].0, EDGES[half][k].1) as f32 * UNIT))
                };
                edges.start = vector(&|[p, q], _| p as i32 * a + q as i32 * b);
                edges.by = vector(&|_, direction| [a, b, b - a][direction]);
                edges.inverse = edges.by.recip().clamp(Vec4::MIN, Vec4::MAX);
            }
        }
    }

    /// Those of the microtriangle `spot`, in texels from `base` on, which is in fixed-point coordinates.
    #[inline(always)]
    pub(super) fn at(&self, spot: Spot, base: [i32; 2]) -> PlacedEdges<'_> {
        let (anchor, axes) = (spot.coordinates(), &self.0[spot.half()]);
        let start = |axis: usize| Vec4::splat((anchor[axis] - base[axis]) as f32 * UNIT) + axes[axis].start;
        PlacedEdges { start: [start(0), start(1)], axes }
    }
}

/// The edges of one microtriangle.
pub(super) struct PlacedEdges<'a> {
    start: [Vec4; 2],
    axes: &'a [Axis; 2],
}

impl PlacedEdges<'_> {
    /// The least value, or of the negated ones if not `above`, on the parts of the edges that are in a cell or closer to it than 2^-13;
    /// infinite if there are none.
    pub(super) fn least(&self, cell: &Cell<f32>, above: bool) -> f32 {
        let corner = [cell.x, cell.y].map(Vec4::splat);
        let start = [self.start[0] - corner[0], self.start[1] - corner[1]];
        let (mut from, mut to) = (Vec4::ZERO, Vec4::ONE);
        for (start, axis) in start.into_iter().zip(self.axes) {
            let lower = (Vec4::splat(-WIDEN) - start) * axis.inverse;
            let upper = (Vec4::splat(1.0 + WIDEN) - start) * axis.inverse;
            from = from.max(lower.min(upper));
            to = to.min(lower.max(upper));
        }
        let position = |t: Vec4, axis: usize| start[axis] + t * self.axes[axis].by;
        let (x0, y0, x1, y1) = (position(from, 0), position(from, 1), position(to, 0), position(to, 1));
        let sign = if above { 1.0 } else { -1.0 };
        let [d00, d10, d01, d11] = cell.values.map(|value| sign * value);
        let [d, x, y, twist] = [d00, d10 - d00, d01 - d00, (d11 - d10) - (d01 - d00)].map(Vec4::splat);
        let value = |px: Vec4, py: Vec4| d + px * x + py * (y + px * twist);
        let (a, b) = (value(x0, y0), value(x1, y1));
        let (bend, rise, end) = (twist * (x1 - x0) * (y1 - y0), b - a, a.min(b));
        let extreme = (a + b) * 0.5 - bend * 0.25 - rise * rise / (bend * 4.0);
        let least = Vec4::select(rise.abs().cmplt(bend), end.min(extreme), end);
        Vec4::select(from.cmple(to), least, Vec4::INFINITY).min_element()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For cells around a microtriangle of each half, the least of many samples of the edges.
    #[test]
    fn the_least_value_on_edges() {
        let steps = [[1_600_000, 300_000], [-200_000, 1_300_000]];
        let mut edges = Edges::default();
        edges.set(steps);
        let root = [[2, 0], [2, 2]].map(|[p, q]| [p << 20, q << 20]);
        for (half, start) in root.into_iter().enumerate() {
            let spot = Spot { point: start[0] | start[1] << 32, at: 0, order: 6 * half as u8 };
            let placed = edges.at(spot, [1 << 20, 0]);
            for values in [[1.0, 0.0, 0.0, 1.0], [0.5, 0.1, 0.2, -0.3], [-0.1, 0.4, 0.4, -0.1]] {
                for (x, y) in (0..5_u8).flat_map(|x| (0..5_u8).map(move |y| (f32::from(x), f32::from(y)))) {
                    let cell = Cell { x, y, values };
                    let mut expected = f32::INFINITY;
                    for ([p, q], direction) in EDGES[half] {
                        let to = [[p + 1, q], [p, q + 1], [p.wrapping_sub(1), q + 1]][direction];
                        for t in (0..=4000).map(|t| t as f32 / 4000.0) {
                            let weight = |k: usize| [p, q][k] as f32 + t * (to[k] as f32 - [p, q][k] as f32);
                            let at = |axis: usize| {
                                let [a, b] = [steps[0][axis] as f32, steps[1][axis] as f32];
                                (start[axis] as f32 + weight(0) * a + weight(1) * b) * UNIT - [1.0, 0.0][axis]
                            };
                            let (px, py) = (at(0), at(1));
                            let near = |at: f32, start: f32| (start - WIDEN..=start + 1.0 + WIDEN).contains(&at);
                            if near(px, x) && near(py, y) {
                                expected = expected.min(cell.value(px, py));
                            }
                        }
                    }
                    let found = placed.least(&cell, true);
                    assert!(found == expected || (found - expected).abs() < 2e-3, "{found} {expected} {x} {y}");
                }
            }
        }
    }
}
