//! A part of a mesh triangle that sees no more than 64 x 64 texels, decided in a frame of its own.
//!
//! Coordinates are texels from the first of a [`Window`]; corners of microtriangles are addressed by integer weights (a, b), so that
//! what microtriangles share, the signs at their corners and along their edges, is found once and kept. Whatever is decided here is
//! certain; the rest is left to [`Node::scan`](crate::classify::Node), so the answers are those of `classify`.
//!
//! # Why a decision is certain
//!
//! *h*, *M*, ε and *R* are those of [`filter`](crate::classify::filter): ε = 16 *h M* with *h* = 2^-53. Let η = ε + 2^-44, which is
//! at least 512 *h*.
//!
//! **Corners.** A corner is o + a p + b q, with o the rounded corner of the mesh triangle's grid at the patch's origin (off by ε/5, and by
//! 128 *h* for the base taken off), p and q the steps of the grid (each off by 2 *h M* / *n* at *n* segments, and a, b ≤ 64 ≤ *n* if
//! 64 segments are in the patch, else a, b ≤ *n*: together off by at most 4 *h M*), products of at most 64 and sums of at most 192:
//! less than ε/5 + 4 *h M* + 512 *h* ≤ η.
//!
//! **Boxes.** In units of 2^-20 texel all coordinates of a patch's grid are integers x0 + a xp + b xq, of which each term was rounded
//! once: off by less than (1 + 64 + 64) 2^-21 + η < 2^-13. A box widened by 2^-13 therefore holds the exact microtriangle. Midpoints of
//! the grid's corners are exact in these integers. If all texels that a filter can reach from the box are on one side,
//! everything in it is.
//!
//! **Values.** The surface at a point is evaluated with the polynomial of a cell in or closer than 4η to which the point is, at a
//! place off by no more than 2η on each axis. As in `filter`, per unit of ηR: less than 1 for rounding, less than 9 for the place, less
//! than 40 for the cell. A value is above or below with certainty if it is further than 128 ηR from the cutoff.
//!
//! **Cells of one side.** If no texel and no border is closer to the cutoff than that, a value computed with the polynomial of a cell
//! whose texels are on one side is on that side: it need not be computed.
//!
//! **Edges.** An edge is followed from t = 0 to t = 1 through the cells between whose bounds its ends are. The t of a
//! crossing is off by as much as moves the point by less than η, so each piece is closer than 4η to its cell, and the pieces
//! cover the edge. On a piece with values a and b at its ends the surface is a (1 - s) + b s - G s (1 - s), as in
//! `filter`: no further towards the other side than the nearer end less max(G, 0)/4, and exactly as far as its turning point.
//!
//! **Inside.** Texel centres are integers. Orientations of points less than 64 apart, of coordinates off by η, are off by less than
//! 1024 η; beyond that their sign is certain, and nothing is decided for a triangle whose own is not.
//!
//! **Conclusion.** A bilinear surface takes its extremes over a triangle on the edges or at texel centres inside. If all three corners
//! are on one side with certainty, no edge has a point on the other, and no texel centre that is on the other side is inside, the
//! triangle is on that side. If two sides have been found, it is mixed.

mod cell;

use omm_model::curve::Corner;

use self::cell::{Cell, Walk, greater, lesser};
use crate::classify::{Classification, Node};
use crate::planes::Planes;
use crate::sampler::Filter;
use crate::surface::Surface;
use crate::texel_triangle::TexelTriangle;
use crate::window::{SIDE, Window};

/// Bits of the fraction of a box's coordinates.
const FRACTION: u32 = 20;
/// 2^-13 texel in these units.
const WIDEN: u32 = 1 << (FRACTION - 13);
/// The same for coordinates in texels.
const WIDEN_TEXELS: f64 = 1.0 / 8192.0;
/// Segments along an edge of a patch, at most.
pub(crate) const MAX_SEGMENTS: u32 = 64;

/// Corners of a node within a patch: fixed-point coordinates, x in the low half, and weights (a, b), a in the low half.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corners {
    pub(crate) points: [u64; 3],
    pub(crate) weights: [u32; 3],
}

impl Corners {
    /// Part `which` of the split, in the order of the curve. The halves of a sum of two corners do not carry into each other: all
    /// sums of corners above the finest level are even.
    #[inline]
    pub(crate) fn part(self, which: u32) -> Self {
        let [p, q, r] = self.points;
        let (pq, qr, rp) = ((p + q) >> 1, (q + r) >> 1, (r + p) >> 1);
        let [a, b, c] = self.weights;
        let (ab, bc, ca) = ((a + b) >> 1, (b + c) >> 1, (c + a) >> 1);
        let (points, weights) = match which {
            0 => ([p, pq, rp], [a, ab, ca]),
            1 => ([rp, qr, pq], [ca, bc, ab]),
            2 => ([pq, q, qr], [ab, b, bc]),
            _ => ([qr, rp, r], [bc, ca, c]),
        };
        Self { points, weights }
    }
}

/// Cells: the first and last column and row.
#[derive(Clone, Copy, Debug)]
struct Cells {
    left: u32,
    right: u32,
    top: u32,
    bottom: u32,
}

/// What is known of a point or an edge.
const UNSEEN: u8 = 0;
const BELOW: u8 = 1;
const ABOVE: u8 = 2;
const UNSURE: u8 = 4;
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
    fn at(self, a: f64, b: f64) -> f64 {
        self.origin + (a * self.a + b * self.b)
    }
}

/// The part of a mesh triangle below one node.
#[derive(Debug)]
pub(crate) struct Patch {
    window: Window,
    /// Texels after a cell's own that a filter reaches.
    after: u32,
    linear: bool,
    x: Steps,
    y: Steps,
    /// Values further from the cutoff have a certain sign.
    margin: f64,
    /// Orientations further from 0 have a certain sign.
    orient_margin: f64,
    threshold: f64,
    /// Whether texels are so far from the cutoff that the side of a cell's texels is that of all values computed there.
    clear: bool,
    base: [i64; 2],
    /// The weights that (0, 0) stands for.
    origin: Corner,
    stride: usize,
    /// Signs at the grid's points, and along the edges that start there in direction a, b, and from (a + 1, b) to (a, b + 1).
    points: Vec<u8>,
    edges: Vec<[u8; 3]>,
}

impl Patch {
    pub(crate) fn new() -> Self {
        Self {
            window: Window::new(),
            after: 0,
            linear: false,
            x: Steps::default(),
            y: Steps::default(),
            margin: 0.0,
            orient_margin: 0.0,
            threshold: 0.0,
            clear: false,
            base: [0; 2],
            origin: Corner { u: 0, v: 0 },
            stride: 0,
            points: Vec::new(),
            edges: Vec::new(),
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
    ) -> Option<Corners> {
        let linear = surface.filter() == Filter::Linear;
        let corners = triangle.corners(node.weights, node.level, surface.shift());
        let (columns, rows) = (texels(corners.x, linear)?, texels(corners.y, linear)?);
        if segments > MAX_SEGMENTS {
            return None;
        }
        self.base = [columns.0, rows.0];
        self.window.load(surface, planes, self.base, columns.1, rows.1);
        self.linear = linear;
        self.after = u32::from(linear);
        self.threshold = surface.threshold();
        let eta = corners.epsilon + 1.0 / 17_592_186_044_416.0;
        self.margin = 128.0 * eta * surface.reach();
        self.orient_margin = 1024.0 * eta;
        self.clear = surface.gap() > self.margin;

        let [a, b, c] = node.weights;
        self.origin = Corner { u: a.u.min(b.u).min(c.u), v: a.v.min(b.v).min(c.v) };
        let origin = triangle.corners([self.origin; 3], node.level, surface.shift());
        let [step_a, step_b] = triangle.steps(node.level);
        self.x = Steps { origin: origin.x[0] - self.base[0] as f64, a: step_a[0], b: step_b[0] };
        self.y = Steps { origin: origin.y[0] - self.base[1] as f64, a: step_a[1], b: step_b[1] };
        self.stride = segments as usize + 1;
        self.points.clear();
        self.points.resize(self.stride * self.stride, UNSEEN);
        self.edges.clear();
        self.edges.resize(self.stride * self.stride, [UNSEEN; 3]);

        let fixed = |steps: Steps| {
            let round = |value: f64| (value * f64::from(1_u32 << FRACTION)).round() as i64;
            [round(steps.origin), round(steps.a), round(steps.b)]
        };
        let (x, y) = (fixed(self.x), fixed(self.y));
        let local = node.weights.map(|corner| [corner.u - self.origin.u, corner.v - self.origin.v]);
        let at = |steps: [i64; 3], [a, b]: [u32; 2]| steps[0] + i64::from(a) * steps[1] + i64::from(b) * steps[2];
        Some(Corners {
            // Between 0 and 64 texels by the choice of the base, so each fits its half.
            points: local.map(|weights| at(x, weights) as u64 | (at(y, weights) as u64) << 32),
            weights: local.map(|[a, b]| a | b << 16),
        })
    }

    /// The answer if all texels that the node can see are on one side; else the cells it can touch.
    fn cells(corners: Corners) -> Cells {
        let [p, q, r] = corners.points;
        let (px, qx, rx) = (p as u32, q as u32, r as u32);
        let (py, qy, ry) = ((p >> 32) as u32, (q >> 32) as u32, (r >> 32) as u32);
        let low = |a: u32, b: u32, c: u32| a.min(b).min(c).saturating_sub(WIDEN) >> FRACTION;
        let high = |a: u32, b: u32, c: u32| (a.max(b).max(c) + WIDEN) >> FRACTION;
        Cells { left: low(px, qx, rx), right: high(px, qx, rx), top: low(py, qy, ry), bottom: high(py, qy, ry) }
    }

    /// The answer if all texels that the node can see are on one side.
    pub(crate) fn quick(&self, corners: Corners) -> Option<Classification> {
        let Cells { left, right, top, bottom } = Self::cells(corners);
        match self.window.sides(left, right + self.after, top, bottom + self.after) {
            (true, true) => None,
            (true, false) => Some(Classification::Opaque),
            (false, _) => Some(Classification::Transparent),
        }
    }

    /// The answer for a microtriangle, if it is certain.
    pub(crate) fn leaf(&mut self, surface: &Surface<'_>, corners: Corners) -> Option<Classification> {
        if !self.linear {
            return None;
        }
        let (mut weights, mut points) = ([(0, 0); 3], [(0.0, 0.0); 3]);
        let mut seen = 0;
        for ((&packed, weights), point) in corners.weights.iter().zip(&mut weights).zip(&mut points) {
            *weights = (packed & 0xffff, packed >> 16);
            let (a, b) = (f64::from(weights.0), f64::from(weights.1));
            *point = (self.x.at(a, b), self.y.at(a, b));
            seen |= self.sign(surface, *weights, *point);
        }
        if seen & (ABOVE | BELOW) == ABOVE | BELOW {
            return Some(Classification::Mixed);
        }
        if seen & UNSURE != 0 {
            return None;
        }
        let above = seen & ABOVE != 0;
        let mut unsure = false;
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            let kind = self.edge_sign(surface, [weights[from], weights[to]], [points[from], points[to]], above);
            if kind == TWO_SIDED {
                return Some(Classification::Mixed);
            }
            unsure |= kind == UNSURE;
        }
        match self.contains_other(points, Self::cells(corners), above) {
            Some(true) => Some(Classification::Mixed),
            Some(false) if !unsure => Some(if above { Classification::Opaque } else { Classification::Transparent }),
            _ => None,
        }
    }

    /// The side at the grid's point `weights`.
    fn sign(&mut self, surface: &Surface<'_>, (a, b): (u32, u32), (x, y): (f64, f64)) -> u8 {
        let at = b as usize * self.stride + a as usize;
        if let Some(&seen) = self.points.get(at)
            && seen != UNSEEN
        {
            return seen;
        }
        let sign = match self.window.cell_sides(x as u32, y as u32) {
            (true, false) if self.clear => ABOVE,
            (false, true) if self.clear => BELOW,
            _ => {
                let value = Cell::new(&self.window, surface, x as u32, y as u32, self.threshold).value(x, y);
                if value > self.margin {
                    ABOVE
                } else if value < -self.margin {
                    BELOW
                } else {
                    UNSURE
                }
            }
        };
        if let Some(slot) = self.points.get_mut(at) {
            *slot = sign;
        }
        sign
    }

    /// Whether an edge whose ends are `above` or not has points on the other side.
    fn edge_sign(
        &mut self,
        surface: &Surface<'_>,
        [(a0, b0), (a1, b1)]: [(u32, u32); 2],
        [p, q]: [(f64, f64); 2],
        above: bool,
    ) -> u8 {
        let at = b0.min(b1) as usize * self.stride + a0.min(a1) as usize;
        let direction = if b0 == b1 {
            0
        } else if a0 == a1 {
            1
        } else {
            2
        };
        if let Some(seen) = self.edges.get(at)
            && seen[direction] != UNSEEN
        {
            return seen[direction];
        }
        let sign = self.follow(surface, p, q, above);
        if let Some(slot) = self.edges.get_mut(at) {
            slot[direction] = sign;
        }
        sign
    }

    /// Follows an edge through its cells.
    fn follow(&self, surface: &Surface<'_>, (x0, y0): (f64, f64), (x1, y1): (f64, f64), above: bool) -> u8 {
        let low = |a: f64, b: f64| (lesser(a, b) - WIDEN_TEXELS) as u32;
        let high = |a: f64, b: f64| (greater(a, b) + WIDEN_TEXELS) as u32 + 1;
        let sides = self.window.sides(low(x0, x1), high(x0, x1), low(y0, y1), high(y0, y1));
        if if above { !sides.1 } else { !sides.0 } {
            return ONE_SIDED;
        }
        let towards = if above { 1.0 } else { -1.0 };
        let mut x = Walk::new(x0, x1);
        let mut y = Walk::new(y0, y1);
        let (mut t, mut from) = (0.0, (x0, y0));
        let mut unsure = false;
        loop {
            let by_x = x.t <= y.t;
            let next = lesser(greater(lesser(x.t, y.t), t), 1.0);
            let to = (x0 + next * (x1 - x0), y0 + next * (y1 - y0));
            let sides = self.window.cell_sides(x.cell, y.cell);
            let has_other = if above { sides.1 } else { sides.0 };
            if has_other || !self.clear {
                let cell = Cell::new(&self.window, surface, x.cell, y.cell, self.threshold);
                let least = cell.least(from, to, towards, self.margin);
                if least < -self.margin {
                    return TWO_SIDED;
                }
                unsure |= least <= self.margin;
            }
            if x.left == 0 && y.left == 0 {
                return if unsure { UNSURE } else { ONE_SIDED };
            }
            if by_x {
                x.step();
            } else {
                y.step();
            }
            (t, from) = (next, to);
        }
    }

    /// Whether the triangle contains a texel centre that is on the other side; `None` if rounding decides.
    fn contains_other(&self, points: [(f64, f64); 3], cells: Cells, above: bool) -> Option<bool> {
        let [p, q, r] = points;
        let orient = |p: (f64, f64), q: (f64, f64), x: f64, y: f64| (q.0 - p.0) * (y - p.1) - (q.1 - p.1) * (x - p.0);
        let area = orient(p, q, r.0, r.1);
        let turn = if area < 0.0 { -1.0 } else { 1.0 };
        let mut unsure = false;
        // A cell's own texel is its lower corner: that of the first column and row is outside of the box.
        for row in cells.top + 1..=cells.bottom {
            let mut columns = if cells.left < cells.right {
                self.window.columns_of(!above, cells.left + 1, cells.right, row)
            } else {
                0
            };
            while columns != 0 {
                let (x, y) = (f64::from(columns.trailing_zeros()), f64::from(row));
                columns &= columns - 1;
                let least =
                    lesser(lesser(turn * orient(p, q, x, y), turn * orient(q, r, x, y)), turn * orient(r, p, x, y));
                if least > self.orient_margin && area.abs() > self.orient_margin {
                    return Some(true);
                }
                unsure |= least >= -self.orient_margin || area.abs() <= self.orient_margin;
            }
        }
        (!unsure).then_some(false)
    }

    /// The weights of a microtriangle's corners in the whole triangle.
    pub(crate) fn weights(&self, corners: Corners) -> [Corner; 3] {
        corners
            .weights
            .map(|weights| Corner { u: self.origin.u + (weights & 0xffff), v: self.origin.v + (weights >> 16) })
    }

    /// [`Surface::is_above_near`] for a point within the patch.
    #[inline]
    pub(crate) fn is_above_near(&self, surface: &Surface<'_>, x: f64, y: f64) -> bool {
        let column = crate::surface::floor(x);
        let row = crate::surface::floor(y);
        let (i, j) = (column - self.base[0], row - self.base[1]);
        if !self.linear || !(0..i64::from(SIDE)).contains(&i) || !(0..i64::from(SIDE)).contains(&j) {
            return surface.is_above_near(x, y);
        }
        match self.window.cell_sides(i as u32, j as u32) {
            (above, below) if self.clear && above != below => return above,
            _ => {}
        }
        let values = self.window.values(surface, i as u32, j as u32);
        crate::surface::bilinear(values, x - column as f64, y - row as f64) > self.threshold
    }
}

/// The first texel and the number of texels that coordinates can reach along an axis, if a window holds so many.
fn texels(coordinates: [f64; 3], linear: bool) -> Option<(i64, u32)> {
    let [a, b, c] = coordinates;
    let first = (a.min(b).min(c) - 2.0 * WIDEN_TEXELS).floor() as i64;
    let last = (a.max(b).max(c) + 2.0 * WIDEN_TEXELS).floor() as i64 + i64::from(linear);
    let count = last - first + 1;
    (count <= SIDE.into()).then_some((first, count as u32))
}
