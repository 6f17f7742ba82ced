//! Cutting a tree into parts that can be placed one by one.

use std::ops::Range;

use super::{Bvh, Node, Planes};

/// A node and all that lies below it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Part {
    pub(crate) node: Node,
    pub(crate) slots: Range<usize>,
}

impl Bvh {
    /// At most `count` nodes that have everything below them, the root alone if `count` is less than 4; the largest
    /// ones are taken apart first. Nothing if the tree is empty.
    pub(crate) fn cut(&self, count: usize) -> Vec<Part> {
        let mut nodes: Vec<(Node, f32)> = self.root.into_iter().map(|root| (root, f32::INFINITY)).collect();
        // Taking one apart adds three at most.
        while nodes.len() + 3 <= count {
            let quads = nodes.iter().enumerate().filter(|(_, (node, _))| node.as_leaf().is_none());
            let largest = quads.max_by(|(_, (_, a)), (_, (_, b))| a.total_cmp(b)).map(|(at, _)| at);
            let Some(at) = largest else { break };
            let (node, _) = nodes.swap_remove(at);
            nodes.extend(self.children(node).map(|(child, side, planes)| (child, half_area(planes, side))));
        }
        nodes.into_iter().map(|(node, _)| Part { node, slots: self.first_slot(node)..self.end_slot(node) }).collect()
    }

    /// The nodes below a node, and where their boxes are.
    fn children(&self, node: Node) -> impl DoubleEndedIterator<Item = (Node, usize, &Planes)> {
        let quad = if node.as_leaf().is_none() { self.quads.get(node.0 as usize >> 1) } else { None };
        let children =
            quad.into_iter().flat_map(|quad| quad.nodes.into_iter().enumerate().map(|at| (at, &quad.planes)));
        children.filter(|((_, child), _)| *child != Node::NONE).map(|((side, child), planes)| (child, side, planes))
    }

    /// The first slot below a node: slots were given out from the first child to the last.
    fn first_slot(&self, node: Node) -> usize {
        match (node.as_leaf(), self.children(node).next()) {
            (Some(leaf), _) => self.slots(leaf).start,
            (None, Some((first, ..))) => self.first_slot(first),
            (None, None) => 0,
        }
    }

    /// The slot behind all that is below a node.
    fn end_slot(&self, node: Node) -> usize {
        match (node.as_leaf(), self.children(node).next_back()) {
            (Some(leaf), _) => self.slots(leaf).end,
            (None, Some((last, ..))) => self.end_slot(last),
            (None, None) => 0,
        }
    }
}

/// Half the surface of one of four boxes.
fn half_area(planes: &Planes, side: usize) -> f32 {
    let [x, y, z] = planes.map(|[low, high]| high[side] - low[side]);
    x * y + y * z + z * x
}
