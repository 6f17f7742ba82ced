//! The three edges of a microtriangle at a time, in `f32`; the proof is with [`tile`](super::tile).
//!
//! Written in steps for all edges: so the compiler makes vectors of them.

use super::cell::{Cell, greater, lesser};
use super::grid::{EDGES, Spot};
use super::tile::UNIT;

/// 2^-13 texel.
const WIDEN: f32 = 1.0 / 8192.0;

/// A number for each edge; a fourth fills the vector.
type Lanes = [f32; 4];

#[inline(always)]
fn lanes(of: impl Fn(usize) -> f32) -> Lanes {
    [of(0), of(1), of(2), of(3)]
}

/// The edges of a microtriangle of each half along an axis.
#[derive(Clone, Copy, Debug, Default)]
struct Axis {
    /// Where they start, in fixed-point coordinates from the anchor.
    start: [i32; 4],
    /// By how much the coordinate changes, in texels.
    by: Lanes,
    /// 1 / `by`; finite, as 0 times infinity is not a number.
    inverse: Lanes,
}

/// The edges of microtriangles of a grid, by half and axis.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Edges([[Axis; 2]; 2]);

impl Edges {
    /// Takes the steps of a grid.
    pub(super) fn set(&mut self, steps: [[i64; 2]; 2]) {
        for (half, axes) in self.0.iter_mut().enumerate() {
            for (axis, edges) in axes.iter_mut().enumerate() {
                // A step is at most 64 texels.
                let [a, b] = [steps[0][axis] as i32, steps[1][axis] as i32];
                for k in 0..4 {
                    let ([p, q], direction) = EDGES[half][k % 3];
                    edges.start[k] = p as i32 * a + q as i32 * b;
                    edges.by[k] = [a, b, b - a][direction] as f32 * UNIT;
                    edges.inverse[k] = lesser(greater(1.0 / edges.by[k], f32::MIN), f32::MAX);
                }
            }
        }
    }

    /// Those of the microtriangle `spot`, in texels from `base` on, which is in fixed-point coordinates.
    #[inline(always)]
    pub(super) fn at(&self, spot: Spot, base: [i32; 2]) -> PlacedEdges {
        let (anchor, axes) = (spot.coordinates(), self.0[spot.half()]);
        let start = [0, 1].map(|axis| lanes(|k| (anchor[axis] - base[axis] + axes[axis].start[k]) as f32 * UNIT));
        PlacedEdges { start, axes }
    }
}

/// The edges of one microtriangle.
pub(super) struct PlacedEdges {
    start: [Lanes; 2],
    axes: [Axis; 2],
}

impl PlacedEdges {
    /// The least value, or of the negated ones if not `above`, on the parts of the edges that are in a cell or closer to it than 2^-13;
    /// infinite if there are none.
    #[inline(never)]
    pub(super) fn least(&self, cell: &Cell<f32>, above: bool) -> f32 {
        let (mut from, mut to) = ([0.0; 4], [1.0; 4]);
        for (axis, corner) in [cell.x, cell.y].into_iter().enumerate() {
            let (start, inverse) = (self.start[axis], self.axes[axis].inverse);
            let (lower, upper) = (corner - WIDEN, corner + 1.0 + WIDEN);
            let lower = lanes(|k| (lower - start[k]) * inverse[k]);
            let upper = lanes(|k| (upper - start[k]) * inverse[k]);
            from = lanes(|k| greater(from[k], lesser(lower[k], upper[k])));
            to = lanes(|k| lesser(to[k], greater(lower[k], upper[k])));
        }
        let position = |t: Lanes, axis: usize, corner: f32| {
            let (start, by) = (self.start[axis], self.axes[axis].by);
            lanes(|k| start[k] - corner + t[k] * by[k])
        };
        let (x0, y0) = (position(from, 0, cell.x), position(from, 1, cell.y));
        let (x1, y1) = (position(to, 0, cell.x), position(to, 1, cell.y));
        let [d00, d10, d01, d11] = if above { cell.values } else { cell.values.map(|value| -value) };
        let (rise_x, rise_y, twist) = (d10 - d00, d01 - d00, (d11 - d10) - (d01 - d00));
        let value = |x: Lanes, y: Lanes| lanes(|k| d00 + x[k] * rise_x + y[k] * (rise_y + x[k] * twist));
        let (a, b) = (value(x0, y0), value(x1, y1));
        let bend = lanes(|k| twist * (x1[k] - x0[k]) * (y1[k] - y0[k]));
        let rise = lanes(|k| b[k] - a[k]);
        let extreme = lanes(|k| (a[k] + b[k]) * 0.5 - bend[k] * 0.25 - rise[k] * rise[k] / (4.0 * bend[k]));
        let end = lanes(|k| lesser(a[k], b[k]));
        let least = lanes(|k| if rise[k].abs() < bend[k] { lesser(end[k], extreme[k]) } else { end[k] });
        let least = lanes(|k| if from[k] > to[k] { f32::INFINITY } else { least[k] });
        lesser(lesser(least[0], least[1]), lesser(least[2], least[3]))
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
