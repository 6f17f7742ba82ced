//! Sixteen microtriangles at a time: those two levels below a node, decided together in `f32`.
//!
//! # Why a decision is certain
//!
//! **Places.** Fixed-point coordinates of points of the grid are off by less than 2^-13 texel, as boxes are (see
//! [`Patch`](super::Patch)), and a sample of [`estimate`](super::estimate) by 2^-20 more for its own rounding. From a tile's
//! first cell on they have no more than 24 bits, so `f32` holds them exactly.
//!
//! **Values.** Texels are taken less the cutoff and divided by the surface's *reach*, so all values are within -1..=1, the
//! surface is continuous, and it changes by no more than 2 for a texel along an axis: a value is off by less than 2^-11 + 2^-18
//! for its place. The cutoff of bytes is below 2^8 and its `f32` off by no more than 2^-17; where bytes are on both sides of it
//! the reach is at least a half: a texel is off by less than 2^-15. The polynomial makes some ten roundings of numbers up to 4,
//! of at most 2^-22 each. Together that is less than 2^-10. A value further from 0 than [`MARGIN`] = 2^-10 has the sign that it
//! has in real arithmetic.
//!
//! **Cells of one side.** Whether a texel is above the cutoff is known exactly, and a cell's values lie between those of its
//! texels. So a cell all of whose texels are on one side is on that side: only the others that a microtriangle's box overlaps are
//! looked at.
//!
//! **Boxes in cells.** As for a [`Patch`](super::Patch): a bilinear surface takes its extremes over the part of a box that is in
//! a cell at its corners, of which only the value is rounded. What has all of these on one side with certainty is on that side.
//!
//! **Edges.** Where a box is not, the cell is looked at once more, along the edges. An edge is cut where it is 2^-13 outside of
//! the cell, as far as an edge in real arithmetic that is in the cell can be away from the one at hand. The t of a cut is off by
//! less than 2^-22, which moves the point by less than 2^-18, as does its own rounding. There the cell's polynomial differs by
//! less than 2^-11 from what it is at the point in real arithmetic; the turning point of a part is off by no more than its ends,
//! and by a quarter of what its bend is off by, which is less than 2^-15. So a value above [`MARGIN`] is above in real
//! arithmetic. On the other side the cell's polynomial is not the surface outside of the cell: from the point at hand to the cell
//! it changes by less than 2^-10.9, and the surface from there to the point in real arithmetic by less than 2^-10.3. So what is
//! below -2 [`MARGIN`] is below.
//!
//! **Conclusion.** If all three corners are on one side, no edge has points on the other in a cell whose part of the box has, and
//! no texel centre that is on the other side is inside (see [`Patch`](super::Patch)), the microtriangle is on that side: a
//! bilinear surface takes its extremes over the part of a triangle in a cell on the edges or at texel centres.

use super::cell::Cell;
use super::grid::{Cells, FRACTION, Spot};
use super::leaves::CORNERS;
use crate::surface::Surface;
use crate::window::Window;

/// Values further from 0 have a certain sign.
pub(super) const MARGIN: f32 = 1.0 / 1024.0;
/// Columns and rows of texels of a tile.
pub(super) const SIDE: usize = 16;

/// Sixteen points of a node of each half, in fixed-point coordinates from its anchor.
#[derive(Clone, Debug, Default)]
pub(super) struct Points {
    pub(super) x: [[i32; 16]; 2],
    pub(super) y: [[i32; 16]; 2],
}

impl Points {
    /// Takes the steps of a grid. `weights`, in units of a step divided by `parts`, are those of the half at the anchor of a node of
    /// `segments`; the other half is the first turned round the middle of both.
    #[inline(always)]
    pub(super) fn set(&mut self, steps: [[i64; 2]; 2], weights: &[[i32; 2]; 16], parts: i32, segments: i32) {
        for (axis, [lower, upper]) in [&mut self.x, &mut self.y].into_iter().enumerate() {
            // A node of a patch is no larger than 64 texels.
            let [a, b] = [steps[0][axis] as i32, steps[1][axis] as i32];
            for k in 0..16 {
                let [p, q] = weights[k];
                lower[k] = (a * p + b * q) / parts;
                upper[k] = (a + b) * segments - lower[k];
            }
        }
    }
}

/// The corners of the sixteen microtriangles.
pub(super) fn set_corners(points: &mut Points, steps: [[i64; 2]; 2]) {
    points.set(steps, &CORNERS, 1, 4);
}

/// The texels around a node.
#[derive(Clone, Debug, Default)]
pub(super) struct Tile {
    /// The first column and row, in fixed-point coordinates.
    pub(super) base: [i32; 2],
    /// Two rows more for the compiler: indices into them are in range by their bits.
    texels: [[f32; SIDE]; SIDE + 2],
}

impl Tile {
    /// Moves the tile to the texels of `cells`; `false` if they are too many.
    pub(super) fn load(&mut self, surface: &Surface<'_>, window: &Window, cells: Cells) -> bool {
        let Cells { left, right, top, bottom } = cells;
        let (columns, rows) = (right - left + 2, bottom - top + 2);
        if columns.max(rows) > SIDE as u32 {
            return false;
        }
        window.differences(surface, [left, top], [columns, rows], &mut self.texels);
        self.base = [left, top].map(|cell| (cell << FRACTION) as i32);
        true
    }

    /// The values at sixteen points of `spot`. Loops over all of them with an index each, by itself: so the compiler makes vectors of
    /// them.
    #[allow(clippy::needless_range_loop)]
    #[inline(always)]
    fn values(&self, spot: Spot, points: &Points) -> [f32; 16] {
        let texels = self.texels.as_flattened();
        let Some(texels) = texels.first_chunk::<{ SIDE * (SIDE + 2) }>() else { return [0.0; 16] };
        let ([x, y], half) = (spot.coordinates(), spot.half());
        let (x, y, from_x, from_y) = (x - self.base[0], y - self.base[1], &points.x[half], &points.y[half]);
        let (mut xs, mut ys) = ([0; 16], [0; 16]);
        for k in 0..16 {
            xs[k] = x + from_x[k];
            ys[k] = y + from_y[k];
        }
        let at = places(&xs, &ys);
        let (mut lower, mut upper) = ([[0.0; 2]; 16], [[0.0; 2]; 16]);
        for k in 0..16 {
            let at = (at[k] & 0xff) as usize;
            lower[k] = [texels[at], texels[at + 1]];
            upper[k] = [texels[at + SIDE], texels[at + SIDE + 1]];
        }
        let mut values = [0.0; 16];
        for k in 0..16 {
            let (x, y) = (fraction(xs[k]), fraction(ys[k]));
            let ([d00, d10], [d01, d11]) = (lower[k], upper[k]);
            let (lower, upper) = (d00 + x * (d10 - d00), d01 + x * (d11 - d01));
            values[k] = lower + y * (upper - lower);
        }
        values
    }

    /// How many of sixteen points are above and below with certainty.
    #[inline(never)]
    pub(super) fn count(&self, spot: Spot, points: &Points) -> [i32; 2] {
        let values = self.values(spot, points);
        let count = |is: fn(f32) -> bool| values.iter().map(|&value| i32::from(is(value))).sum();
        [count(|value| value > MARGIN), count(|value| value < -MARGIN)]
    }

    /// A bit for each of sixteen points: which are above, and which below, with certainty.
    #[inline(never)]
    pub(super) fn sides(&self, spot: Spot, points: &Points) -> [u16; 2] {
        let values = self.values(spot, points);
        let bits =
            |is: fn(f32) -> bool| (0..).zip(&values).fold(0, |bits, (k, &value)| bits | i32::from(is(value)) << k);
        [bits(|value| value > MARGIN) as u16, bits(|value| value < -MARGIN) as u16]
    }

    /// The first column and row, of the window.
    pub(super) fn frame(&self) -> [u32; 2] {
        self.base.map(|base| base as u32 >> FRACTION)
    }

    /// The cell at a column and row of the window, which the tile has.
    #[inline(always)]
    pub(super) fn cell(&self, column: u32, row: u32) -> Cell<f32> {
        let frame = self.frame();
        let (x, y) = ((column - frame[0]) as usize % SIDE, (row - frame[1]) as usize % SIDE);
        let (texels, at) = (self.texels.as_flattened(), y * SIDE + x);
        let values = [texels[at], texels[at + 1], texels[at + SIDE], texels[at + SIDE + 1]];
        Cell { x: f32::from(x as u8), y: f32::from(y as u8), values }
    }
}

/// The texels of the cells in which points are: the row in the upper four bits, the column in the lower. A function for itself: inlined, it
/// would be taken apart before it is a vector.
#[inline(never)]
fn places(x: &[i32; 16], y: &[i32; 16]) -> [i32; 16] {
    let mut places = [0; 16];
    for k in 0..16 {
        places[k] = (y[k] >> FRACTION) * SIDE as i32 + (x[k] >> FRACTION);
    }
    places
}

/// A unit of fixed-point coordinates in texels.
pub(super) const UNIT: f32 = 1.0 / (1_u32 << FRACTION) as f32;

/// The position within a cell.
fn fraction(coordinate: i32) -> f32 {
    (coordinate & ((1 << FRACTION) - 1)) as f32 * UNIT
}
