//! A part of a mesh triangle that sees no more than 64 x 64 texels, decided in a frame of its own.
//!
//! Coordinates are texels from the first of a [`Window`]. Corners of microtriangles are points of a [`grid`]. Where it can be,
//! [`sixteen`] of them are decided at a time in `f32`, with the proof of [`tile`]. What that leaves open, and larger ones, are
//! decided alone in `f64`, where what microtriangles share, the signs at their corners and along their edges, is found once and
//! kept. Whatever is decided here is certain; the rest is left to [`Node::scan`](crate::classify::Node), so the answers are those
//! of `classify`.
//!
//! # Why a decision is certain
//!
//! *h*, *M*, ε and *R* are those of [`filter`](crate::classify::filter): ε = 16 *h M* with *h* = 2^-53. Let η = ε + 2^-43, which is
//! at least 1024 *h*.
//!
//! **Corners.** A corner is o + a p + b q, with o the rounded corner of the mesh triangle's grid at the patch's origin (off by ε/5, and by
//! 128 *h* for the base taken off), p and q the steps of the grid (each off by 2 *h M* / *n* at *n* segments, and a, b ≤ 64 ≤ *n* if
//! 64 segments are in the patch, else a, b ≤ *n*: together off by at most 4 *h M*), products of at most 64 and sums of at most 192:
//! less than ε/5 + 4 *h M* + 576 *h*. The end of an edge is its start plus p, q or q - p, each off by no more than 4 *h M* + 128 *h*, and
//! rounded once more: less than ε/5 + 8 *h M* + 768 *h* ≤ η.
//!
//! **Boxes.** In units of 2^-20 texel all coordinates of a patch's grid are integers x0 + a xp + b xq, of which each term was rounded
//! once: off by less than (1 + 64 + 64) 2^-21 + η < 2^-13. A box widened by 2^-13 therefore holds the exact node or edge. Boxes of one
//! shape are translates of each other, exactly, in these integers. If all texels that a filter can reach from the box are on one
//! side, everything in it is.
//!
//! **Values.** The surface at a point is evaluated with the polynomial of a cell in or closer than 4η to which the point is, at a
//! place off by no more than 2η on each axis. As in `filter`, per unit of ηR: less than 1 for rounding, less than 9 for the place, less
//! than 40 for the cell. A value is above or below with certainty if it is further than 128 ηR from the cutoff.
//!
//! **Cells of one side.** If no texel and no border is closer to the cutoff than that, a value computed with the polynomial of a cell
//! whose texels are on one side is on that side: it need not be computed.
//!
//! **Boxes in cells.** A bilinear surface takes its extremes over a rectangle at its corners. If they are on one side with certainty
//! where the box of a microtriangle overlaps each cell that has texels of the other side, all of the box is on that side. The
//! corners are exact, and so is the cell: only the value itself is rounded.
//!
//! **Edges.** An edge is cut where it crosses the bounds of the cells of its box, from t = 0 to t = 1: two cells that share a bound
//! share the cut, so the parts cover the edge. The t of a cut is off by as much as moves the point by less than η, so each part is
//! closer than 4η to its cell. On a part with values a and b at its ends the surface is a (1 - s) + b s - G s (1 - s), as in
//! `filter`: no further towards the other side than the nearer end less max(G, 0)/4, and exactly as far as its turning point.
//!
//! **Inside.** Texel centres are integers. Orientations of points less than 64 apart, of coordinates off by η, are off by less than
//! 1024 η; beyond that their sign is certain, and nothing is decided for a triangle whose own is not.
//!
//! **Conclusion.** A bilinear surface takes its extremes over a triangle on the edges or at texel centres inside. If all three corners
//! are on one side with certainty, no edge has a point on the other, and no texel centre that is on the other side is inside, the
//! triangle is on that side. If two sides have been found, it is mixed.

mod cell;
mod edges;
mod estimate;
mod grid;
mod lanes;
mod leaves;
mod sixteen;
mod tile;

use omm_model::curve::Corner;

use self::cell::{Cell, Change};
use self::estimate::set_samples;
pub(crate) use self::grid::Spot;
use self::grid::{Cells, Grid, STRIDE};
use self::lanes::Edges;
pub(crate) use self::sixteen::Bits;
use self::sixteen::{Boxes, PlacedBoxes};
use self::tile::{Points, Tile, set_corners};
use crate::classify::{Classification, Node};
use crate::planes::Planes;
use crate::sampler::Filter;
use crate::surface::{Surface, floor};
use crate::texel_triangle::TexelTriangle;
use crate::window::{SIDE, Window};

/// 2^-13 texel.
const WIDEN: f64 = 1.0 / 8192.0;
/// Segments along an edge of a patch, at most.
pub(crate) const MAX_SEGMENTS: u32 = 64;

/// What is known of a point of the grid, in two bits.
const UNSEEN: u8 = 0;
const BELOW: u8 = 1;
const ABOVE: u8 = 2;
const UNSURE: u8 = 3;
/// Of an edge whose ends are on one side: no point is on the other.
const ONE_SIDED: u8 = 1;
const TWO_SIDED: u8 = 2;

/// A linear function of weights: origin, step for a, step for b.
#[derive(Clone, Copy, Debug, Default)]
struct Steps {
    origin: f64,
    a: f64,
    b: f64,
}

impl Steps {
    #[inline]
    fn at(self, a: f64, b: f64) -> f64 {
        self.origin + (a * self.a + b * self.b)
    }

    /// By how much it changes in each of the directions of an edge.
    fn directions(self) -> [Change; 3] {
        [self.a, self.b, self.b - self.a].map(Change::new)
    }
}

/// The part of a mesh triangle below one node.
#[derive(Debug)]
pub(crate) struct Patch {
    window: Window,
    grid: Grid,
    tile: Tile,
    boxes: Boxes,
    placed: PlacedBoxes,
    /// Corners of the sixteen microtriangles of a tile, and samples of one.
    corners: Points,
    samples: Points,
    /// Texels after a cell's own that a filter reaches.
    after: u32,
    linear: bool,
    x: Steps,
    y: Steps,
    /// Changes of x and y along the edges of microtriangles.
    directions: [[Change; 3]; 2],
    edges: Edges,
    /// Values further from the cutoff have a certain sign.
    margin: f64,
    /// Orientations further from 0 have a certain sign.
    orient_margin: f64,
    threshold: f64,
    /// Whether texels are so far from the cutoff that the side of a cell's texels is that of all values computed there.
    clear: bool,
    /// The weights that (0, 0) stands for.
    origin: Corner,
    /// For each point of the grid its side in the lowest bits, and above them what is known of the edges that start there in each
    /// direction.
    seen: Vec<u8>,
    /// Rows of `seen` that are still those of another patch.
    stale_rows: u32,
}

impl Patch {
    pub(crate) fn new() -> Self {
        Self {
            window: Window::new(),
            grid: Grid::default(),
            tile: Tile::default(),
            boxes: Boxes::default(),
            placed: PlacedBoxes::default(),
            corners: Points::default(),
            samples: Points::default(),
            after: 0,
            linear: false,
            x: Steps::default(),
            y: Steps::default(),
            directions: [[Change::default(); 3]; 2],
            edges: Edges::default(),
            margin: 0.0,
            orient_margin: 0.0,
            threshold: 0.0,
            clear: false,
            origin: Corner { u: 0, v: 0 },
            seen: vec![0; (STRIDE * (MAX_SEGMENTS + 1)) as usize],
            stale_rows: 0,
        }
    }

    /// Moves the patch to `node`, which has `segments` microtriangles along an edge; `None` if it sees too many texels.
    pub(crate) fn load(
        &mut self,
        surface: &Surface<'_>,
        planes: &Planes,
        triangle: &TexelTriangle,
        node: Node,
        segments: u32,
    ) -> Option<Spot> {
        let linear = surface.filter() == Filter::Linear;
        let corners = triangle.corners(node.weights, node.level, surface.shift());
        let (columns, rows) = (texels(corners.x, linear)?, texels(corners.y, linear)?);
        if segments > MAX_SEGMENTS {
            return None;
        }
        let base = [columns.0, rows.0];
        self.window.load(surface, planes, base, columns.1, rows.1);
        self.linear = linear;
        self.after = u32::from(linear);
        self.threshold = surface.threshold();
        let eta = corners.epsilon + 1.0 / 8_796_093_022_208.0;
        self.margin = 128.0 * eta * surface.reach();
        self.orient_margin = 1024.0 * eta;
        self.clear = surface.gap() > self.margin;

        let [a, b, c] = node.weights;
        self.origin = Corner { u: a.u.min(b.u).min(c.u), v: a.v.min(b.v).min(c.v) };
        let origin = triangle.corners([self.origin; 3], node.level, surface.shift());
        let [step_a, step_b] = triangle.steps(node.level);
        self.x = Steps { origin: origin.x[0] - base[0] as f64, a: step_a[0], b: step_b[0] };
        self.y = Steps { origin: origin.y[0] - base[1] as f64, a: step_a[1], b: step_b[1] };
        if self.grid.set(self.x, self.y) {
            self.directions = [self.x.directions(), self.y.directions()];
            self.edges.set(self.grid.steps);
            set_corners(&mut self.corners, self.grid.steps);
            self.boxes.set(self.grid.steps, &self.corners);
            set_samples(&mut self.samples, self.grid.steps);
        }
        self.stale_rows = segments + 1;
        let local = node.weights.map(|corner| [corner.u - self.origin.u, corner.v - self.origin.v]);
        Some(Grid::root(self.x.origin, self.y.origin, local, segments))
    }

    /// Part `which` of the split of `spot`, `size` levels above the finest.
    #[inline]
    pub(crate) fn part(&self, spot: Spot, size: u32, which: u32) -> Spot {
        self.grid.part(spot, size, which)
    }

    /// The answer if all texels that the node can see are on one side; it is `size` levels above the finest.
    #[inline]
    pub(crate) fn quick(&self, spot: Spot, size: u32) -> Option<Classification> {
        let Cells { left, right, top, bottom } = self.grid.cells(spot, size);
        match self.window.sides(left, right + self.after, top, bottom + self.after) {
            (true, true) => None,
            (true, false) => Some(Classification::Opaque),
            (false, _) => Some(Classification::Transparent),
        }
    }

    /// The answer for a microtriangle, if it is certain.
    pub(crate) fn leaf(&mut self, surface: &Surface<'_>, spot: Spot) -> Option<Classification> {
        if !self.linear {
            return None;
        }
        let stale = (STRIDE * std::mem::take(&mut self.stale_rows)) as usize;
        self.seen.iter_mut().take(stale).for_each(|seen| *seen = UNSEEN);
        let own = spot.at + [0, STRIDE + 1][spot.half()];
        let (p, q, r) =
            (self.side(surface, spot.at + 1), self.side(surface, spot.at + STRIDE), self.side(surface, own));
        if p == UNSURE || q == UNSURE || r == UNSURE {
            return None;
        }
        if p != q || q != r {
            return Some(Classification::Mixed);
        }
        let above = p == ABOVE;
        if self.clear && self.box_is_one_sided(surface, spot, above) {
            return Some(Classification::of_side(above));
        }
        self.leaf_by_edges(surface, spot, above)
    }

    /// Whether all of a microtriangle's box is `above` or not, by the cells that have texels of the other side.
    fn box_is_one_sided(&self, surface: &Surface<'_>, spot: Spot, above: bool) -> bool {
        let Cells { left, right, top, bottom } = self.grid.cells(spot, 0);
        let [xs, ys] = self.grid.bounds(spot);
        let towards = if above { 1.0 } else { -1.0 };
        for row in top..=bottom {
            let mut columns = self.window.cells_of(!above, above, left, right, row);
            while columns != 0 {
                let column = columns.trailing_zeros();
                columns &= columns - 1;
                let cell = Cell::new(&self.window, surface, column, row, self.threshold);
                if cell.least_within(grid::within(xs, column), grid::within(ys, row), towards) <= self.margin {
                    return false;
                }
            }
        }
        true
    }

    /// Where a point of the grid is.
    #[inline]
    fn point(&self, at: u32) -> (f64, f64) {
        let [a, b] = grid::weights(at).map(f64::from);
        (self.x.at(a, b), self.y.at(a, b))
    }

    /// The side at a point of the grid.
    #[inline(always)]
    fn side(&mut self, surface: &Surface<'_>, at: u32) -> u8 {
        let seen = self.seen.get(at as usize).map_or(UNSEEN, |seen| seen & 3);
        if seen != UNSEEN {
            return seen;
        }
        self.find_side(surface, at)
    }

    #[inline(never)]
    fn find_side(&mut self, surface: &Surface<'_>, at: u32) -> u8 {
        let (x, y) = self.point(at);
        let (column, row) = (x as u32, y as u32);
        let side = match self.window.cell_sides(column, row) {
            (true, false) if self.clear => ABOVE,
            (false, true) if self.clear => BELOW,
            _ => {
                let value = Cell::new(&self.window, surface, column, row, self.threshold).value(x, y);
                if value > self.margin {
                    ABOVE
                } else if value < -self.margin {
                    BELOW
                } else {
                    UNSURE
                }
            }
        };
        if let Some(seen) = self.seen.get_mut(at as usize) {
            *seen |= side;
        }
        side
    }

    /// The weights of a microtriangle's corners in the whole triangle.
    pub(crate) fn weights(&self, spot: Spot) -> [Corner; 3] {
        spot.weights().map(|[a, b]| Corner { u: self.origin.u + a, v: self.origin.v + b })
    }
}

/// The first texel and the number of texels that coordinates can reach along an axis, if a window holds so many.
fn texels(coordinates: [f64; 3], linear: bool) -> Option<(i64, u32)> {
    let [a, b, c] = coordinates;
    let first = floor(a.min(b).min(c) - 2.0 * WIDEN);
    let last = floor(a.max(b).max(c) + 2.0 * WIDEN) + i64::from(linear);
    let count = last - first + 1;
    (count <= SIDE.into()).then_some((first, count as u32))
}
