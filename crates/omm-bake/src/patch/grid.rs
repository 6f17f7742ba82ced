//! The nodes of a patch: translates of two shapes, split in the order of the curve.
//!
//! The corners of all microtriangles are points (a, b) of a grid. A node of *s* segments spans from its *anchor*, the least a and b of
//! its corners, to (a + s, b + s), of which it is the half at the anchor or the other one. So whatever depends on the shape alone
//! is found once for all nodes of one size.

use omm_model::curve::{Corner, part};

use super::Steps;

/// Bits of the fraction of a coordinate.
pub(super) const FRACTION: u32 = 20;
/// 2^-13 texel in these units.
pub(super) const WIDEN: i64 = 1 << (FRACTION - 13);
/// What an index of a grid point grows by with b; it grows by 1 with a.
pub(super) const STRIDE: u32 = 128;
/// Sizes of nodes: 2^0 to 2^6 segments.
const SIZES: usize = 7;

/// In which order the curve passes the corners of a node, and which half it is: an index into [`ORDERS`].
pub(super) type Order = u8;

/// The corners of a node of one segment, in the order of the curve: of the half at the anchor first, of the other then.
pub(super) const ORDERS: [[[u32; 2]; 3]; 12] = {
    let halves = [[[0, 0], [1, 0], [0, 1]], [[1, 0], [0, 1], [1, 1]]];
    let permutations = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
    let mut orders = [[[0; 2]; 3]; 12];
    let mut k = 0;
    while k < 12 {
        let (half, [p, q, r]) = (halves[k / 6], permutations[k % 6]);
        orders[k] = [half[p], half[q], half[r]];
        k += 1;
    }
    orders
};

/// Part of a node: its anchor in halves of the node, a + 2 b, and its order.
#[derive(Clone, Copy)]
pub(super) struct Part {
    pub(super) anchor: u8,
    pub(super) order: Order,
}

/// The four parts of a node of each order.
pub(super) const PARTS: [[Part; 4]; 12] = {
    let mut parts = [[Part { anchor: 0, order: 0 }; 4]; 12];
    let mut k = 0;
    while k < 48 {
        let [p, q, r] = ORDERS[k / 4];
        let twice = [double(p), double(q), double(r)];
        let [p, q, r] = part(twice, (k % 4) as u32);
        let (a, b) = (least(p.u, q.u, r.u), least(p.v, q.v, r.v));
        let order = order([[p.u - a, p.v - b], [q.u - a, q.v - b], [r.u - a, r.v - b]]);
        parts[k / 4][k % 4] = Part { anchor: (a + 2 * b) as u8, order };
        k += 1;
    }
    parts
};

const fn double([a, b]: [u32; 2]) -> Corner {
    Corner { u: 2 * a, v: 2 * b }
}

const fn least(a: u32, b: u32, c: u32) -> u32 {
    let least = if a < b { a } else { b };
    if c < least { c } else { least }
}

/// The order of these corners; 12 if there is none.
const fn order(corners: [[u32; 2]; 3]) -> Order {
    let mut order = 0;
    while order < 12 {
        let (mut same, mut k) = (true, 0);
        while k < 3 {
            same &= ORDERS[order][k][0] == corners[k][0] && ORDERS[order][k][1] == corners[k][1];
            k += 1;
        }
        if same {
            break;
        }
        order += 1;
    }
    order as Order
}

/// A node of a patch, by its anchor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot {
    /// Fixed-point coordinates of the anchor: x + 2^32 y. The anchor itself may be outside of the window, the node is not.
    pub(super) point: u64,
    /// The anchor's index in the grid.
    pub(super) at: u32,
    pub(super) order: Order,
}

impl Spot {
    /// 0 for the half at the anchor, 1 for the other.
    pub(super) fn half(self) -> usize {
        usize::from(self.order >= 6)
    }

    /// The weights (a, b) of the corners of a microtriangle, in the order of the curve.
    pub(super) fn weights(self) -> [[u32; 2]; 3] {
        let [a, b] = weights(self.at);
        ORDERS[usize::from(self.order) % 12].map(|[p, q]| [a + p, b + q])
    }

    /// Fixed-point coordinates of the anchor, negative ones too.
    pub(super) fn coordinates(self) -> [i32; 2] {
        let x = self.point as u32 as i32;
        [x, (self.point.wrapping_sub(i64::from(x) as u64) >> 32) as i32]
    }
}

/// The weights (a, b) of a point of the grid.
pub(super) fn weights(at: u32) -> [u32; 2] {
    [at % STRIDE, at / STRIDE]
}

/// Cells: the first and last column and row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cells {
    pub(super) left: u32,
    pub(super) right: u32,
    pub(super) top: u32,
    pub(super) bottom: u32,
}

/// A box, widened by 2^-13 texel: its least and greatest point less an anchor.
#[derive(Clone, Copy, Debug, Default)]
struct Extent {
    least: u64,
    most: u64,
}

impl Extent {
    /// The least and the greatest coordinates of points of the grid.
    fn bounds<const N: usize>(steps: [[i64; 2]; 2], points: [[u32; 2]; N]) -> [[i64; 2]; 2] {
        let (mut least, mut most) = ([i64::MAX; 2], [i64::MIN; 2]);
        for [a, b] in points {
            for axis in 0..2 {
                let value = i64::from(a) * steps[0][axis] + i64::from(b) * steps[1][axis];
                least[axis] = least[axis].min(value);
                most[axis] = most[axis].max(value);
            }
        }
        [least, most]
    }

    /// The box between bounds that are 2^`size` times these.
    fn widened([least, most]: [[i64; 2]; 2], size: u32) -> Self {
        let (least, most) = (least.map(|at| (at << size) - WIDEN), most.map(|at| (at << size) + WIDEN));
        Self { least: pack(least), most: pack(most) }
    }

    /// The cells that it touches from an anchor on.
    #[inline]
    fn cells(self, anchor: u64) -> Cells {
        let (least, most) = (anchor.wrapping_add(self.least), anchor.wrapping_add(self.most));
        Cells {
            left: least as u32 >> FRACTION,
            right: most as u32 >> FRACTION,
            top: (least >> (32 + FRACTION)) as u32,
            bottom: (most >> (32 + FRACTION)) as u32,
        }
    }
}

/// Coordinates in one number: sums of such numbers are those of the sums, whatever the signs in between.
fn pack([x, y]: [i64; 2]) -> u64 {
    // Sizes larger than the patch do not fit, and are not looked at.
    x.wrapping_add(y << 32) as u64
}

/// The edges of a microtriangle of each half: from where, relative to the anchor, and in which of the directions
/// (1, 0), (0, 1) and (-1, 1).
pub(super) const EDGES: [[([u32; 2], usize); 3]; 2] =
    [[([0, 0], 0), ([0, 0], 1), ([1, 0], 2)], [([0, 1], 0), ([1, 0], 1), ([1, 0], 2)]];

/// What depends on the steps of a grid alone.
#[derive(Clone, Debug, Default)]
pub(super) struct Grid {
    /// By how much a point moves with a and with b.
    pub(super) steps: [[i64; 2]; 2],
    /// From the anchor of a node of twice the size to those of its parts, by size and anchor of the part: as point and as index.
    pub(super) parts: [[(u64, u32); 4]; SIZES],
    /// Boxes of nodes, by size and half.
    nodes: [[Extent; 2]; SIZES],
}

impl Grid {
    /// Takes the steps `x` and `y`; whether they are others than before.
    pub(super) fn set(&mut self, x: Steps, y: Steps) -> bool {
        let steps = [[fixed(x.a), fixed(y.a)], [fixed(x.b), fixed(y.b)]];
        if self.steps == steps {
            return false;
        }
        self.steps = steps;
        let bounds = [0, 6].map(|order| Extent::bounds(steps, ORDERS[order]));
        for (size, (parts, nodes)) in (0_u32..).zip(self.parts.iter_mut().zip(&mut self.nodes)) {
            let sized = steps.map(|step| step.map(|coordinate| coordinate << size));
            let [a, b] = sized.map(pack);
            let ab = a.wrapping_add(b);
            *parts = [(0, 0), (a, 1 << size), (b, STRIDE << size), (ab, (STRIDE + 1) << size)];
            *nodes = bounds.map(|bounds| Extent::widened(bounds, size));
        }
        true
    }

    /// The node whose corners have these weights, which are 0 or `segments`, where (0, 0) is at (`x`, `y`).
    pub(super) fn root(x: f64, y: f64, local: [[u32; 2]; 3], segments: u32) -> Spot {
        let order = order(local.map(|weights| weights.map(|weight| weight / segments)));
        Spot { point: pack([fixed(x), fixed(y)]), at: 0, order }
    }

    /// Part `which` of the split of `spot`, `size` levels above the finest.
    #[inline]
    pub(super) fn part(&self, spot: Spot, size: u32, which: u32) -> Spot {
        let Part { anchor, order } = PARTS[usize::from(spot.order) % 12][which as usize % 4];
        let (point, at) = self.parts[size as usize % SIZES][usize::from(anchor) % 4];
        Spot { point: spot.point.wrapping_add(point), at: spot.at + at, order }
    }

    /// The cells that `spot` can touch, `size` levels above the finest.
    #[inline]
    pub(super) fn cells(&self, spot: Spot, size: u32) -> Cells {
        self.nodes[size as usize % SIZES][spot.half()].cells(spot.point)
    }

    /// The box of the microtriangle `spot`: the least and the greatest x, and y, in fixed-point coordinates.
    #[inline]
    pub(super) fn bounds(&self, spot: Spot) -> [[u32; 2]; 2] {
        let Extent { least, most } = self.nodes[0][spot.half()];
        let (least, most) = (spot.point.wrapping_add(least), spot.point.wrapping_add(most));
        [[least as u32, most as u32], [(least >> 32) as u32, (most >> 32) as u32]]
    }

    /// The cells that an edge of the microtriangle `spot` can touch.
    #[inline]
    pub(super) fn edge_cells(&self, spot: Spot, edge: usize) -> Cells {
        let ([a, b], direction) = EDGES[spot.half()][edge];
        let to = [[a + 1, b], [a, b + 1], [a.wrapping_sub(1), b + 1]][direction];
        Extent::widened(Extent::bounds(self.steps, [[a, b], to]), 0).cells(spot.point)
    }
}

/// The part of a range that is in a cell, as positions within it.
#[inline]
pub(super) fn within([least, most]: [u32; 2], cell: u32) -> [f64; 2] {
    let (start, unit) = (cell << FRACTION, 1_u32 << FRACTION);
    [least.saturating_sub(start), (most - start).min(unit)].map(|position| f64::from(position) / f64::from(unit))
}

/// The nearest fixed-point number.
fn fixed(value: f64) -> i64 {
    let scaled = value * f64::from(1_u32 << FRACTION);
    (scaled + if scaled < 0.0 { -0.5 } else { 0.5 }) as i64
}

#[cfg(test)]
mod tests {
    use omm_model::curve::MicroTriangle;
    use omm_model::level::SubdivisionLevel;

    use super::*;

    /// All nodes below roots of both halves have the corners that the curve gives them, and boxes around these alone.
    #[test]
    fn nodes_are_those_of_the_curve() {
        let level = SubdivisionLevel::new(4).unwrap();
        let x = Steps { origin: 40.25, a: -1.5, b: 0.25 };
        let y = Steps { origin: 9.5, a: 0.75, b: 1.25 };
        let mut grid = Grid::default();
        assert!(grid.set(x, y));
        assert!(!grid.set(x, y));
        for order in 0..12_u8 {
            let local = ORDERS[usize::from(order)].map(|corner| corner.map(|weight| weight * 16));
            let root = Grid::root(x.origin, y.origin, local, 16);
            assert_eq!(root.order, order);
            let mut spots = vec![root];
            for size in (0..4).rev() {
                spots = spots
                    .iter()
                    .flat_map(|&s| (0..4).map(move |which| (s, which)))
                    .map(|(s, w)| grid.part(s, size, w))
                    .collect();
            }
            for (index, spot) in (0..).zip(spots) {
                let expected = MicroTriangle::new(level, index).unwrap().corners().map(|corner| {
                    // The corner by its weights in the root.
                    let w = [16 - corner.u - corner.v, corner.u, corner.v];
                    [0, 1].map(|axis| (0..3).map(|k| w[k] * local[k][axis]).sum::<u32>() / 16)
                });
                assert_eq!(spot.weights(), expected);
                let [xs, ys] = [x, y].map(|s| expected.map(|[a, b]| s.at(f64::from(a), f64::from(b)).floor() as u32));
                let least = |of: [u32; 3]| of.into_iter().min().unwrap();
                let most = |of: [u32; 3]| of.into_iter().max().unwrap();
                let cells = grid.cells(spot, 0);
                // The coordinates are multiples of a quarter: widened, a box starts one cell earlier if it starts at a bound.
                assert!((least(xs) - 1..=least(xs)).contains(&cells.left) && cells.right == most(xs));
                assert!((least(ys) - 1..=least(ys)).contains(&cells.top) && cells.bottom == most(ys));
                for edge in 0..3 {
                    let part = grid.edge_cells(spot, edge);
                    assert!(part.left >= cells.left && part.right <= cells.right);
                    assert!(part.top >= cells.top && part.bottom <= cells.bottom);
                }
            }
        }
    }
}
