//! A bounding volume hierarchy: which of many boxes can a ray meet?
//!
//! The tree's shape comes from `obvhs` (PLOC with reinsertion and collapsed leaves); boxes, nodes and the walk are
//! ours, because the walk must never lose a box that the ray meets. What is guaranteed, for any finite ray and
//! boxes:
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
mod slab;

pub(crate) use build::Bounds;
pub(crate) use slab::BoxRay;

/// The deepest tree that is walked; the builder keeps to it.
const MAX_DEPTH: usize = 64;

/// A tree over boxes. What it visits are slots: positions in the order in which [`Bvh::items`] lists what it was
/// built from.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bvh {
    /// Stored coordinates are those of the boxes times this power of two.
    scale: f64,
    root: Option<Node>,
    pairs: Vec<Pair>,
    /// For each slot the index of the box it was built from.
    items: Vec<u32>,
}

/// A run of slots, or a pair of nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Node {
    /// The first slot, or the index of a pair.
    first: u32,
    /// Slots; 0 for a pair.
    count: u32,
}

/// Two boxes in the unit of a tree: for each axis both lower ends, then both upper ends.
pub(crate) type Planes = [Vec4; 3];

/// Two nodes and their boxes.
#[derive(Clone, Copy, Debug)]
struct Pair {
    planes: Planes,
    nodes: [Node; 2],
}

/// A walk through a tree, which can be left and taken up again: what is still to be visited.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walk {
    entries: [(Node, f32); MAX_DEPTH],
    depth: usize,
}

impl Bvh {
    /// For each slot the index of the box it was built from.
    pub(crate) fn items(&self) -> &[u32] {
        &self.items
    }
}

impl Walk {
    /// A walk that is over.
    pub(crate) const fn new() -> Self {
        Self { entries: [(Node { first: 0, count: 0 }, 0.0); MAX_DEPTH], depth: 0 }
    }

    /// Begins anew, at the root of `bvh`.
    pub(crate) fn begin(&mut self, bvh: &Bvh) {
        self.depth = 0;
        if let Some((entry, root)) = self.entries.first_mut().zip(bvh.root) {
            *entry = (root, f32::NEG_INFINITY);
            self.depth = 1;
        }
    }

    /// The slots of the next leaf whose box the ray can meet with a `t` of at most `limit`, nearer ones first by and
    /// large; `None` once the walk is over.
    #[inline]
    pub(crate) fn next(&mut self, bvh: &Bvh, ray: &BoxRay, limit: f32) -> Option<Range<usize>> {
        let bound = ray.bound(limit);
        let mut depth = self.depth;
        let leaf = 'walk: loop {
            let Some(last) = depth.checked_sub(1) else { break None };
            depth = last;
            let Some(&(mut node, at)) = self.entries.get(last) else { continue };
            if at > bound {
                continue;
            }
            while node.count == 0 {
                let Some(pair) = bvh.pairs.get(node.first as usize) else { break 'walk None };
                let [left, right] = pair.nodes;
                node = match ray.enter(&pair.planes, bound).into() {
                    (Some(left_at), Some(right_at)) => {
                        let (near, far) =
                            if right_at < left_at { (right, (left, left_at)) } else { (left, (right, right_at)) };
                        // The builder's depth limit leaves room for one entry a level.
                        if let Some(entry) = self.entries.get_mut(depth) {
                            *entry = far;
                            depth += 1;
                        }
                        near
                    }
                    (Some(_), None) => left,
                    (None, Some(_)) => right,
                    (None, None) => continue 'walk,
                };
            }
            let first = node.first as usize;
            break Some(first..first + node.count as usize);
        };
        self.depth = depth;
        leaf
    }
}

#[cfg(test)]
mod tests;
