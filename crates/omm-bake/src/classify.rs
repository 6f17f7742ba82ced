//! What holds on all of a microtriangle: the conservative decision, exact to the last tie.
//!
//! A microtriangle is the closed triangle that real arithmetic gives from the `f32` texture coordinates. It is [`Opaque`] if alpha is
//! above the cutoff on all of it, [`Transparent`] if alpha is above the cutoff nowhere on it, and [`Mixed`] otherwise.
//!
//! [`Opaque`]: Classification::Opaque
//! [`Transparent`]: Classification::Transparent
//! [`Mixed`]: Classification::Mixed
//!
//! The way to the answer has three steps, each of which decides only what is certain:
//!
//! 1. **Texels.** Every value of the surface over a box lies between the least and greatest texel that the box can see. If all texels
//!    around the microtriangle's bounding box, widened by the rounding of its corners, are on one side, so is the microtriangle.
//! 2. **Scan.** The cells that the microtriangle can touch are visited row by row. For a nearest filter this step is done in integers
//!    and exact. For a linear filter it evaluates the extremes in `f64`, and accepts a sign only outside of an error bound; the
//!    proof is in [`filter`].
//! 3. **Integers.** Cells of which the `f64` scan could not decide are evaluated in integers without rounding.
//!
//! # Bounds on the work
//!
//! No loop is as long as a texture coordinate is large. Beyond a texture that does not repeat, all cells in one direction count
//! as one. A microtriangle that contains a whole period of a texture that repeats sees every texel. What is left are long, thin
//! microtriangles over many periods, and microtriangles over very many texels. They are given up after [`cell_budget`] cells, or
//! [`EXACT_BUDGET`] cells in integers, and are [`Undecided`](Classification::Undecided).

mod exact;
pub mod filter;
mod linear;
mod nearest;

use std::ops::RangeInclusive;

use omm_model::curve::{Corner, MicroTriangle};
use omm_model::level::SubdivisionLevel;

use crate::planes::Planes;
use crate::sampler::{Axis, Filter};
use crate::surface::{Surface, floor};
use crate::texel_triangle::{Corners, TexelTriangle};
use crate::texture::Texture;

/// Cells and rows that the scan of one microtriangle visits at most: 16 times the texels of the texture, but no fewer than 2^20 and no
/// more than 2^26.
#[must_use]
pub fn cell_budget(texture: &Texture) -> u64 {
    (16 * u64::from(texture.width()) * u64::from(texture.height())).clamp(1 << 20, 1 << 26)
}

/// Cells that are evaluated in integers for one microtriangle at most: 2^18.
pub const EXACT_BUDGET: u64 = 1 << 18;

/// Boxes of more texels than this are scanned at once.
const BOX_LIMIT: i64 = 1 << 12;

/// What holds on all of a microtriangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Classification {
    /// Alpha is at most the cutoff on all of it.
    Transparent,
    /// Alpha is above the cutoff on all of it.
    Opaque,
    /// Alpha is above the cutoff at one of its points and not at another.
    Mixed,
    /// One of the others, but it took more than the budget to say which.
    Undecided,
}

impl Classification {
    pub(crate) const fn of_side(above: bool) -> Self {
        if above { Self::Opaque } else { Self::Transparent }
    }
}

/// What holds on all of `microtriangle` of `triangle`, which was made for the texture of `surface`.
#[must_use]
pub fn classify(surface: &Surface<'_>, triangle: &TexelTriangle, microtriangle: MicroTriangle) -> Classification {
    let node = Node { weights: microtriangle.corners(), level: microtriangle.level() };
    node.quick(surface, triangle).unwrap_or_else(|| node.scan(surface, triangle))
}

/// A microtriangle, or one that contains several, by its corners in units of 2^-`level`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) weights: [Corner; 3],
    pub(crate) level: SubdivisionLevel,
}

impl Node {
    /// The answer if the texels around the bounding box have one. It then holds for everything within the node, too.
    pub(crate) fn quick(self, surface: &Surface<'_>, triangle: &TexelTriangle) -> Option<Classification> {
        if let Some(above) = surface.uniform() {
            return Some(Classification::of_side(above));
        }
        let corners = triangle.corners(self.weights, self.level, surface.shift());
        let [columns, rows] = [(surface.columns(), corners.x), (surface.rows(), corners.y)]
            .map(|(axis, coordinates)| cells(axis, coordinates, corners.epsilon));
        // A linear filter also sees the texel after the last cell.
        let after = i64::from(surface.filter() == Filter::Linear);
        let span = |range: &RangeInclusive<i64>| range.end() - range.start() + 1 + after;
        if span(&columns) > BOX_LIMIT || span(&rows) > BOX_LIMIT || span(&columns) * span(&rows) > BOX_LIMIT {
            return None;
        }
        let with_after = |range: RangeInclusive<i64>| *range.start()..=range.end() + after;
        surface.side(with_after(columns), with_after(rows)).map(Classification::of_side)
    }

    /// [`quick`](Self::quick) for boxes of any size within the texture, by bits.
    pub(crate) fn uniform(
        self,
        surface: &Surface<'_>,
        planes: &Planes,
        triangle: &TexelTriangle,
    ) -> Option<Classification> {
        if let Some(above) = surface.uniform() {
            return Some(Classification::of_side(above));
        }
        let corners = triangle.corners(self.weights, self.level, surface.shift());
        let after = i64::from(surface.filter() == Filter::Linear);
        let texels = |axis: &Axis, coordinates: [f64; 3]| {
            let cells = cells(axis, coordinates, corners.epsilon);
            let (first, last) = (*cells.start(), cells.end() + after);
            (first >= 0 && last < axis.size().into()).then_some([first as u32, last as u32])
        };
        match (texels(surface.columns(), corners.x), texels(surface.rows(), corners.y)) {
            (Some(columns), Some(rows)) => planes.side(columns, rows).map(Classification::of_side),
            _ => self.quick(surface, triangle),
        }
    }

    /// The answer by a scan of the cells.
    pub(crate) fn scan(self, surface: &Surface<'_>, triangle: &TexelTriangle) -> Classification {
        if let Some(above) = surface.uniform() {
            return Classification::of_side(above);
        }
        let corners = triangle.corners(self.weights, self.level, surface.shift());
        if contains_period(surface, &corners) {
            // Every texel is on it, and the texels are not all on one side.
            return Classification::Mixed;
        }
        match surface.filter() {
            Filter::Nearest => nearest::scan(surface, triangle, self),
            Filter::Linear => linear::scan(surface, triangle, self, &corners),
        }
    }
}

/// The cells along an axis that coordinates between the least and greatest of `coordinates`, each off by `margin`, can touch.
fn cells(axis: &Axis, coordinates: [f64; 3], margin: f64) -> RangeInclusive<i64> {
    let [a, b, c] = coordinates;
    let (least, most) = (a.min(b).min(c) - margin, a.max(b).max(c) + margin);
    // Coordinates are below 2^30 and a bit.
    axis.cell(floor(least))..=axis.cell(floor(most))
}

/// Whether the triangle certainly contains a square that is one period and one texel wide and high, around its centroid.
fn contains_period(surface: &Surface<'_>, corners: &Corners) -> bool {
    let (Some(width), Some(height)) = (surface.columns().period(), surface.rows().period()) else { return false };
    let centre = |of: [f64; 3]| (of[0] + of[1] + of[2]) / 3.0;
    let (x, y) = (centre(corners.x), centre(corners.y));
    let (dx, dy) = ((width + 1) as f64 / 2.0, (height + 1) as f64 / 2.0);
    let interior = filter::Interior::new(corners);
    [(-dx, -dy), (dx, -dy), (-dx, dy), (dx, dy)]
        .iter()
        .all(|(dx, dy)| interior.contains(x + dx, y + dy) == filter::Certainty::Yes)
}

/// Which sides of the cutoff have been found on a microtriangle.
#[derive(Clone, Copy, Debug, Default)]
struct Sides<T> {
    above: T,
    below: T,
}

/// The budget was spent.
#[derive(Clone, Copy, Debug)]
struct OverBudget;

/// Counts down what may still be visited.
#[derive(Debug)]
struct Budget(u64);

impl Budget {
    fn spend(&mut self) -> Result<(), OverBudget> {
        self.0 = self.0.checked_sub(1).ok_or(OverBudget)?;
        Ok(())
    }
}
