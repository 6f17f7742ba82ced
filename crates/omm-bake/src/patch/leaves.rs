//! The sixteen microtriangles two levels below a node.

use super::grid::{Grid, Order, PARTS, Part, Spot};

/// One of the 16 microtriangles below a node of four segments.
#[derive(Clone, Copy)]
pub(super) struct Leaf {
    /// Its anchor, from that of the node.
    anchor: [u8; 2],
    order: Order,
}

/// The points of a node of four segments at the anchor, row by row, the last one twice. Those of the other half are these turned round
/// the middle of both.
pub(super) const CORNERS: [[i32; 2]; 16] = {
    let mut points = [[0, 4]; 16];
    let (mut b, mut at) = (0, 0);
    while b < 4 {
        let mut a = 0;
        while a + b <= 4 {
            points[at] = [a, b];
            (a, at) = (a + 1, at + 1);
        }
        b += 1;
    }
    points
};

/// The microtriangles two levels below a node of each order, in the order of the curve.
pub(super) const LEAVES: [[Leaf; 16]; 12] = {
    let mut leaves = [[Leaf { anchor: [0; 2], order: 0 }; 16]; 12];
    let mut k = 0;
    while k < 12 * 16 {
        let first = PARTS[k / 16][k / 4 % 4];
        let Part { anchor, order } = PARTS[first.order as usize][k % 4];
        let anchor = [2 * (first.anchor % 2) + anchor % 2, 2 * (first.anchor / 2) + anchor / 2];
        leaves[k / 16][k % 16] = Leaf { anchor, order };
        k += 1;
    }
    leaves
};

impl Leaf {
    /// Its number: in the half at the anchor those at their own anchors come first, row by row, then the others. In the other half a
    /// microtriangle has the number of the one that it becomes there if the node is turned.
    const fn number(self, half: usize) -> usize {
        let [a, b] = [self.anchor[0] as usize, self.anchor[1] as usize];
        let (a, b) = if half == 0 { (a, b) } else { (3 - a, 3 - b) };
        if (self.order < 6) == (half == 0) {
            4 * b + a - b * b.saturating_sub(1) / 2
        } else {
            10 + 3 * b + a - b * b.saturating_sub(1) / 2
        }
    }
}

/// For each order, the numbers in the order of the curve.
pub(super) const PLACES: [[u8; 16]; 12] = {
    let mut places = [[0; 16]; 12];
    let mut k = 0;
    while k < 12 * 16 {
        places[k / 16][k % 16] = LEAVES[k / 16][k % 16].number(k / 96) as u8;
        k += 1;
    }
    places
};

/// A bit for the number of each microtriangle of which all corners have a bit among `points`, those of [`CORNERS`].
#[inline]
pub(super) fn all_corners(points: u16) -> u16 {
    let points = spaced(points);
    numbered(points & points >> 1 & points >> 5, points >> 1 & points >> 5 & points >> 6)
}

/// The same for those of which any corner has.
#[inline]
pub(super) fn any_corner(points: u16) -> u16 {
    let points = spaced(points);
    numbered(points | points >> 1 | points >> 5, points >> 1 | points >> 5 | points >> 6)
}

/// Five bits for each row, whose points are fewer and fewer.
#[inline]
fn spaced(points: u16) -> u32 {
    let points = u32::from(points);
    points & 0x1ff | points << 1 & 0x1c00 | points << 3 & 0x1_8000 | points << 6 & 0x10_0000
}

/// What is given by anchors, five bits for each row, by numbers: for those at their anchors and the others.
#[inline]
fn numbered(at_anchors: u32, others: u32) -> u16 {
    let at_anchors = at_anchors & 0xf | at_anchors >> 1 & 0x70 | at_anchors >> 3 & 0x180 | at_anchors >> 6 & 0x200;
    let others = others & 0x7 | others >> 2 & 0x18 | others >> 5 & 0x20;
    (at_anchors | others << 10) as u16
}

/// The other way round: the place on the curve of each number.
pub(super) const NUMBERS: [[u8; 16]; 12] = {
    let mut numbers = [[0; 16]; 12];
    let mut k = 0;
    while k < 12 * 16 {
        numbers[k / 16][PLACES[k / 16][k % 16] as usize] = (k % 16) as u8;
        k += 1;
    }
    numbers
};

impl Spot {
    /// The microtriangles two levels below.
    #[inline]
    pub(super) fn leaves(self) -> &'static [Leaf; 16] {
        &LEAVES[usize::from(self.order) % 12]
    }
}

impl Grid {
    /// One of the microtriangles two levels below `spot`.
    #[inline]
    pub(super) fn leaf(&self, spot: Spot, leaf: Leaf) -> Spot {
        let [a, b] = leaf.anchor;
        let [(_, _), (step_a, index_a), (step_b, index_b), _] = self.parts[0];
        let point = u64::from(a).wrapping_mul(step_a).wrapping_add(u64::from(b).wrapping_mul(step_b));
        let at = u32::from(a) * index_a + u32::from(b) * index_b;
        Spot { point: spot.point.wrapping_add(point), at: spot.at + at, order: leaf.order }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::Steps;
    use crate::patch::grid::{ORDERS, weights};

    /// They are the parts of the parts, and their corners have the numbers that they say, for nodes of all orders.
    #[test]
    fn sixteen_parts_of_parts() {
        let mut grid = Grid::default();
        grid.set(Steps { origin: 40.25, a: -1.5, b: 0.25 }, Steps { origin: 9.5, a: 0.75, b: 1.25 });
        for order in ORDERS {
            let root = Grid::root(40.25, 9.5, order.map(|corner| corner.map(|weight| weight * 16)), 16);
            let node = grid.part(grid.part(root, 3, 1), 2, 2);
            for (which, &leaf) in (0..16).zip(node.leaves()) {
                let (found, expected) = (grid.leaf(node, leaf), grid.part(grid.part(node, 1, which / 4), 0, which % 4));
                assert_eq!((found.point, found.at, found.order), (expected.point, expected.at, expected.order));
                // Points of the node, turned if need be.
                let [a, b] = weights(node.at);
                let turned = |[p, q]: [u32; 2]| [[p - a, q - b], [a + 4 - p, b + 4 - q]][node.half()].map(|k| k as i32);
                let corners = found.weights().map(|point| CORNERS.iter().position(|&c| c == turned(point)).unwrap());
                let points = corners.into_iter().fold(0, |bits, corner| bits | 1 << corner);
                let number = 1 << leaf.number(node.half());
                assert_eq!(all_corners(points), number);
                for corner in corners {
                    assert_eq!(all_corners(points & !(1 << corner)), 0);
                    assert_eq!(any_corner(1 << corner) & number, number);
                }
                assert_eq!(any_corner(!points & 0x7fff) & number, 0);
            }
        }
    }
}
