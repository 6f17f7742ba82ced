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

use std::ops::{ControlFlow, Range};

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

/// What is still to be visited; reused by all walks of a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stack {
    entries: [(Node, f32); MAX_DEPTH],
}

impl Stack {
    pub(crate) const fn new() -> Self {
        Self { entries: [(Node { first: 0, count: 0 }, 0.0); MAX_DEPTH] }
    }
}

impl Bvh {
    /// For each slot the index of the box it was built from.
    pub(crate) fn items(&self) -> &[u32] {
        &self.items
    }

    /// Visits every slot whose box the ray can meet with a `t` of at most `limit`, nearer ones first by and large.
    /// Each visit answers with the new limit, or ends the walk.
    pub(crate) fn walk<F>(&self, ray: &BoxRay, stack: &mut Stack, mut limit: f32, mut visit: F) -> ControlFlow<()>
    where
        F: FnMut(Range<usize>, f32) -> ControlFlow<(), f32>,
    {
        let Some(mut node) = self.root else { return ControlFlow::Continue(()) };
        let mut bound = ray.bound(limit);
        let mut depth = 0_usize;
        loop {
            let nearer = if node.count > 0 {
                let first = node.first as usize;
                let new_limit = visit(first..first + node.count as usize, limit)?;
                if new_limit < limit {
                    limit = new_limit;
                    bound = ray.bound(limit);
                }
                None
            } else {
                let Some(pair) = self.pairs.get(node.first as usize) else { return ControlFlow::Continue(()) };
                let [left, right] = ray.enter(&pair.planes, bound);
                match (left, right) {
                    (Some(left_at), Some(right_at)) => {
                        let [left, right] = pair.nodes;
                        let (near, far) =
                            if right_at < left_at { (right, (left, left_at)) } else { (left, (right, right_at)) };
                        // The builder's depth limit leaves room for one entry a level.
                        if let Some(entry) = stack.entries.get_mut(depth) {
                            *entry = far;
                            depth += 1;
                        }
                        Some(near)
                    }
                    (Some(_), None) => Some(pair.nodes[0]),
                    (None, Some(_)) => Some(pair.nodes[1]),
                    (None, None) => None,
                }
            };
            node = match nearer {
                Some(node) => node,
                None => loop {
                    let Some(next) = depth.checked_sub(1) else { return ControlFlow::Continue(()) };
                    depth = next;
                    match stack.entries.get(depth) {
                        Some(&(node, at)) if at <= bound => break node,
                        _ => {}
                    }
                },
            };
        }
    }
}

#[cfg(test)]
mod tests;
