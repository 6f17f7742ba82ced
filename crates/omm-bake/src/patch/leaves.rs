//! The sixteen microtriangles two levels below a node.

use super::grid::{Grid, ORDERS, Order, PARTS, Spot};

/// One of the 16 microtriangles below a node of four segments.
#[derive(Clone, Copy)]
pub(super) struct Leaf {
    /// Its anchor, from that of the node.
    anchor: [u8; 2],
    order: Order,
    /// A bit for each of its corners: the number of that point among [`CORNERS`] of the node's half.
    pub(super) corners: u16,
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

/// The number of a point among [`CORNERS`].
const fn corner(half: usize, [a, b]: [u32; 2]) -> u32 {
    let (a, b) = if half == 0 { (a, b) } else { (4 - a, 4 - b) };
    let (mut row, mut at) = (0, a);
    while row < b {
        (row, at) = (row + 1, at + 5 - row);
    }
    at
}

/// The microtriangles two levels below a node of each order, in the order of the curve.
pub(super) const LEAVES: [[Leaf; 16]; 12] = {
    let mut leaves = [[Leaf { anchor: [0; 2], order: 0, corners: 0 }; 16]; 12];
    let mut k = 0;
    while k < 12 * 16 {
        let first = PARTS[k / 16][k / 4 % 4];
        let second = PARTS[first.order as usize][k % 4];
        let anchor = [2 * (first.anchor % 2) + second.anchor % 2, 2 * (first.anchor / 2) + second.anchor / 2];
        let (mut corners, mut c) = (0, 0);
        while c < 3 {
            let [a, b] = ORDERS[second.order as usize][c];
            corners |= 1 << corner(k / 96, [a + anchor[0] as u32, b + anchor[1] as u32]);
            c += 1;
        }
        leaves[k / 16][k % 16] = Leaf { anchor, order: second.order, corners };
        k += 1;
    }
    leaves
};

impl Leaf {
    /// 0 for the half at the anchor, 1 for the other.
    pub(super) const fn half(self) -> usize {
        (self.order >= 6) as usize
    }

    /// The number of its anchor among [`CORNERS`], in a node at the anchor.
    pub(super) const fn anchor_corner(self) -> usize {
        let [a, b] = self.anchor;
        corner(0, [a as u32, b as u32]) as usize
    }
}

/// For each order and each of the sixteen, in the order of the curve, the number of that microtriangle in a node of order 0, or of the one
/// that it becomes there if the node is turned.
pub(super) const PLACES: [[u8; 16]; 12] = {
    let mut places = [[0; 16]; 12];
    let mut k = 0;
    while k < 12 * 16 {
        let mut place = 0;
        while LEAVES[0][place].corners != LEAVES[k / 16][k % 16].corners {
            place += 1;
        }
        places[k / 16][k % 16] = place as u8;
        k += 1;
    }
    places
};

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
    use crate::patch::grid::weights;

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
                let [a, b] = weights(node.at);
                let corners = found.weights().map(|[p, q]| corner(node.half(), [p - a, q - b]));
                assert_eq!(leaf.corners, corners.into_iter().fold(0, |bits, corner| bits | 1 << corner));
                for (corner, [p, q]) in corners.into_iter().zip(found.weights()) {
                    let [x, y] = CORNERS[corner as usize].map(|weight| weight as u32);
                    assert_eq!(if node.half() == 0 { [a + x, b + y] } else { [a + 4 - x, b + 4 - y] }, [p, q]);
                }
            }
        }
    }
}
