//! A bounding volume hierarchy: which of many boxes can a ray meet?
//!
//! The tree's shape comes from `obvhs` (PLOC with reinsertion and collapsed leaves); boxes, nodes and the walk are
//! ours, because the walk must never lose a box that the ray meets. Nodes have four children, which are tested at once.
//! What is guaranteed, for any finite ray and boxes:
//!
//! - a box that the real ray meets with `t` in range is visited. Boxes are stored in a unit that makes the largest
//!   coordinate less than 2, rounded outwards and grown by 2<sup>-40</sup> of that unit; the ray's origin counts as
//!   a box of its own, grown by 2<sup>-24</sup> of its largest coordinate; both ends of every interval of `t` leave
//!   room for every rounding on the way to them;
//! - a component of the direction less than 2<sup>-20</sup> of the longest one (zero included) gives no interval of
//!   `t` at all. The ray then is a band of 2<sup>-16</sup> of the scene's size across that axis, so a ray in the
//!   plane of a box's face meets it;
//! - the two margins above are wider than the rounding in the triangle test, so they also keep whatever that test
//!   would hit.

use std::ops::Range;

use glam::Vec4;

mod build;
mod cut;
mod slab;

pub(crate) use build::{Bounds, unit};
pub(crate) use cut::Part;
pub(crate) use slab::BoxRay;

/// What a walk through one tree can have to remember at most; the builder keeps to it.
const MAX_OPEN: usize = 64;

/// The room of a walk: for two trees, and such that three nodes have room where one has.
const ROOM: usize = 2 * MAX_OPEN + 2;

/// A tree over boxes, which lie in its leaves in the order of [`Bvh::in_order`]. Their
/// positions there are slots.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bvh {
    /// Stored coordinates are those of the boxes times this power of two.
    scale: f64,
    root: Option<Node>,
    quads: Vec<Quad>,
    /// The first slot of each leaf. Where leaves have room for one box, a leaf's number is its slot.
    leaves: Vec<u32>,
    /// For each slot the index of the box it was built from.
    items: Vec<u32>,
}

/// A leaf or a quad, by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Node(u32);

/// Four boxes in the unit of a tree: for each axis the lower ends, then the upper ends.
pub(crate) type Planes = [[Vec4; 2]; 3];

/// Up to four nodes and their boxes.
#[derive(Clone, Copy, Debug)]
struct Quad {
    planes: Planes,
    nodes: [Node; 4],
    /// A bit for each node that there is.
    present: u32,
}

/// What is still to be visited, of one tree and then of another that was begun before the first was done.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walk {
    /// Nodes, and where the ray enters each.
    open: [(Node, f32); ROOM],
    depth: usize,
}

impl Node {
    /// Stands where no node is.
    const NONE: Self = Self::leaf((1 << 31) - 1);

    /// The leaf of a number below 2^31.
    const fn leaf(number: u32) -> Self {
        Self(number << 1 | 1)
    }

    /// The quad of a number below 2^31.
    const fn quad(number: u32) -> Self {
        Self(number << 1)
    }

    /// The number of a leaf.
    pub(crate) const fn as_leaf(self) -> Option<usize> {
        if self.0 & 1 == 1 { Some((self.0 >> 1) as usize) } else { None }
    }
}

impl Bvh {
    /// What the tree was built over in the order of its slots.
    pub(crate) fn in_order<T: Copy>(&self, items: &[T]) -> Vec<T> {
        self.items.iter().filter_map(|&item| items.get(item as usize)).copied().collect()
    }

    /// The slots of each leaf.
    pub(crate) fn leaves(&self) -> impl Iterator<Item = Range<usize>> {
        (0..self.leaves.len()).map(|leaf| self.slots(leaf))
    }

    /// The slots of a leaf; none if there is no such leaf.
    pub(crate) fn slots(&self, leaf: usize) -> Range<usize> {
        let Some(&first) = self.leaves.get(leaf) else { return 0..0 };
        let end = self.leaves.get(leaf + 1).map_or(self.items.len(), |&next| next as usize);
        first as usize..end
    }
}

impl Walk {
    /// A walk that is over.
    pub(crate) const fn new() -> Self {
        Self { open: [(Node::NONE, 0.0); ROOM], depth: 0 }
    }

    /// How much is open: what [`next`](Self::next) leaves alone if it is told so.
    pub(crate) const fn depth(&self) -> usize {
        self.depth
    }

    /// Adds all of a tree.
    pub(crate) fn begin(&mut self, bvh: &Bvh) {
        if let Some(root) = bvh.root {
            self.begin_at(root);
        }
    }

    /// Adds a part of a tree.
    pub(crate) fn begin_at(&mut self, node: Node) {
        // There is room for two trees.
        if let Some(entry) = self.open.get_mut(self.depth) {
            *entry = (node, f32::NEG_INFINITY);
            self.depth += 1;
        }
    }

    /// The next leaf whose box the ray can meet with a `t` of at most `limit`, nearer ones first by and large; `None`
    /// once no more than `floor` is open. What is open above that belongs to `bvh`.
    // It is called for the scene and, seldom, for instances: in line it would crowd out the test of triangles there.
    #[inline(never)]
    pub(crate) fn next(&mut self, bvh: &Bvh, ray: &BoxRay, limit: f32, floor: usize) -> Option<usize> {
        let bound = ray.bound(limit);
        let mut depth = self.depth;
        let leaf = 'walk: loop {
            let Some(last) = depth.checked_sub(1).filter(|&last| last >= floor) else { break None };
            depth = last;
            let Some(&(mut node, at)) = self.open.get(depth) else { break None };
            if at > bound {
                continue;
            }
            loop {
                if let Some(leaf) = node.as_leaf() {
                    break 'walk Some(leaf);
                }
                let Some(quad) = bvh.quads.get(node.0 as usize >> 1) else { continue 'walk };
                let (met, near) = ray.enter(&quad.planes, bound);
                let met = met & quad.present;
                if met == 0 {
                    continue 'walk;
                }
                let others = met & (met - 1);
                node = if others == 0 { quad.node(met) } else { self.descend(&mut depth, quad, met, near) };
            }
        };
        self.depth = depth;
        leaf
    }

    /// The nearest of several nodes that are met. The others are opened, so that the next nearest comes first.
    #[inline(always)]
    fn descend(&mut self, depth: &mut usize, quad: &Quad, met: u32, near: Vec4) -> Node {
        let near = near.to_array();
        let entry = |met: u32| (quad.node(met), near[met.trailing_zeros() as usize & 3]);
        let mut left = met & met.wrapping_sub(1);
        let (mut nearest, mut other) = (entry(met), entry(left));
        // The builder's limit leaves room for all of them.
        let Some(open) = self.open.get_mut(*depth..).and_then(|open| open.first_chunk_mut::<3>()) else {
            return nearest.0;
        };
        let mut count = 0;
        loop {
            if other.1 < nearest.1 {
                std::mem::swap(&mut other, &mut nearest);
            }
            let mut at = count;
            while at > 0 && open[at - 1].1 < other.1 {
                open[at] = open[at - 1];
                at -= 1;
            }
            open[at] = other;
            count += 1;
            left &= left.wrapping_sub(1);
            if left == 0 || count == 3 {
                break;
            }
            other = entry(left);
        }
        *depth += count;
        nearest.0
    }
}

impl Quad {
    /// The node of the lowest bit.
    #[inline(always)]
    const fn node(&self, met: u32) -> Node {
        self.nodes[met.trailing_zeros() as usize & 3]
    }
}

#[cfg(test)]
mod tests;
