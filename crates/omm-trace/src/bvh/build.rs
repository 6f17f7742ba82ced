//! Building a tree: the shape from `obvhs`, the boxes from us.

use glam::Vec4;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::slab::{power_below, round_down, round_up};
use super::{Bvh, MAX_OPEN, Node, Planes, Quad};

/// A closed box of finite coordinates; `low <= high` on every axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: [f64; 3],
    pub(crate) high: [f64; 3],
}

impl Bounds {
    /// The smallest box around some points, if there is one and they are finite.
    pub(crate) fn around(points: impl IntoIterator<Item = [f64; 3]>) -> Option<Self> {
        let boxes = points.into_iter().map(|point| Self { low: point, high: point });
        boxes.reduce(Self::union).filter(Self::is_finite)
    }

    /// The smallest box around both.
    pub(crate) fn union(self, other: Self) -> Self {
        // NaN is kept, so that it is found later.
        let pick = |a: [f64; 3], b: [f64; 3], first: fn(f64, f64) -> bool| {
            std::array::from_fn(|axis| if first(a[axis], b[axis]) || a[axis].is_nan() { a[axis] } else { b[axis] })
        };
        Self { low: pick(self.low, other.low, |a, b| a < b), high: pick(self.high, other.high, |a, b| a > b) }
    }

    fn is_finite(&self) -> bool {
        self.low.iter().chain(&self.high).all(|x| x.is_finite())
    }

    /// The largest coordinate without its sign.
    pub(crate) fn largest(&self) -> f64 {
        self.low.iter().chain(&self.high).fold(0.0, |largest, x| largest.max(x.abs()))
    }

    fn centre(&self) -> [f64; 3] {
        std::array::from_fn(|axis| 0.5 * self.low[axis] + 0.5 * self.high[axis])
    }
}

/// How much every box is grown, in the tree's unit.
const MARGIN: f64 = 1.0 / (1_u64 << 40) as f64;
/// How much dearer a step down the tree is than a primitive, for the collapse of leaves: four triangles are tested at once.
const STEP_COST: f32 = 3.0;

/// How many nodes look for a better place in each of several passes. It costs several times what the rest of the build does
/// and saves rays a fourth of their steps, so it is all of them unless there are very many.
const REINSERTED: f32 = (1_u32 << 18) as f32;

/// A tree by its nodes, the first of which is the root.
struct Shape {
    nodes: Vec<Branch>,
    order: Vec<u32>,
}

/// A node of a binary tree. An inner node's children are `first` and `first + 1`; a leaf's `count` items begin at `first`
/// of `order`.
#[derive(Clone, Copy, Default)]
struct Branch {
    first: u32,
    /// 0 for an inner node.
    count: u32,
    /// Among nodes of the same quad the heaviest is replaced by its children.
    weight: f32,
}

/// The inverse of a power of two that makes all coordinates of these boxes less than 2.
pub(crate) fn unit<'a>(boxes: impl IntoIterator<Item = &'a Bounds>) -> f64 {
    let largest = boxes.into_iter().fold(0.0, |largest: f64, bounds| largest.max(bounds.largest()));
    if largest > 0.0 { 1.0 / power_below(largest) } else { 1.0 }
}

impl Bvh {
    /// A tree over `boxes` with at most `leaf` of them in a leaf; its items are their indices. `scale` is
    /// the [`unit()`] of these boxes, or of more. `None` if there are 2^30 boxes or more.
    pub(crate) fn build(boxes: &[Bounds], leaf: u32, scale: f64) -> Option<Self> {
        Self::build_within(boxes, leaf.max(1), scale, MAX_OPEN)
    }

    pub(super) fn build_within(boxes: &[Bounds], leaf: u32, scale: f64, max_open: usize) -> Option<Self> {
        if boxes.len() >= 1 << 30 {
            return None;
        }
        let empty = Self { scale, ..Self::default() };
        let Some(all) = boxes.iter().copied().reduce(Bounds::union) else { return Some(empty) };
        let assemble = |shape: &Shape| empty.clone().assemble(shape, boxes, max_open);
        assemble(&by_ploc(boxes, &all, leaf)).or_else(|| assemble(&by_halves(boxes, leaf as usize)))
    }

    /// A box in the unit of this tree, four times: for [`BoxRay::meets`](super::BoxRay::meets).
    pub(crate) fn planes_of(&self, bounds: &Bounds) -> Planes {
        planes(self.scale, [Some(*bounds); 4])
    }

    /// The tree of that shape with the boxes of what lies below each node; `None` if a walk through it has to remember
    /// too much or it is no tree over all of them.
    fn assemble(mut self, shape: &Shape, boxes: &[Bounds], max_open: usize) -> Option<Self> {
        let (root, _) = self.place(shape, *shape.nodes.first()?, boxes, max_open.checked_sub(1)?)?;
        self.root = Some(root);
        let mut seen = vec![false; boxes.len()];
        for &item in &self.items {
            *seen.get_mut(item as usize)? = true;
        }
        (self.items.len() == boxes.len() && !seen.contains(&false)).then_some(self)
    }

    /// Places a branch and all below it, and says where and how large it is. Walks may have `room` nodes open beside it.
    fn place(&mut self, shape: &Shape, branch: Branch, boxes: &[Bounds], room: usize) -> Option<(Node, Bounds)> {
        if branch.count > 0 {
            let first = branch.first as usize;
            let members = shape.order.get(first..first.checked_add(branch.count as usize)?)?;
            let (leaf, slot) = (u32::try_from(self.leaves.len()).ok()?, u32::try_from(self.items.len()).ok()?);
            // A shape that lists an item twice would never end to grow.
            (self.items.len() + members.len() <= boxes.len()).then_some(())?;
            self.leaves.push(slot);
            self.items.extend_from_slice(members);
            let bounds = members.iter().filter_map(|&item| boxes.get(item as usize)).copied().reduce(Bounds::union)?;
            return Some((Node::leaf(leaf), bounds));
        }
        let below = shape.below(branch)?;
        let room = room.checked_sub(below.len().saturating_sub(1))?;
        let index = self.quads.len();
        (index < boxes.len()).then_some(())?;
        let present = (1 << below.len()) - 1;
        let mut quad = Quad { planes: [[Vec4::ZERO; 2]; 3], nodes: [Node::NONE; 4], present };
        let mut bounds = [None; 4];
        self.quads.push(quad);
        for ((branch, node), bounds) in below.into_iter().zip(&mut quad.nodes).zip(&mut bounds) {
            let (placed, around) = self.place(shape, branch, boxes, room)?;
            (*node, *bounds) = (placed, Some(around));
        }
        quad.planes = planes(self.scale, bounds);
        *self.quads.get_mut(index)? = quad;
        Some((Node::quad(u32::try_from(index).ok()?), bounds.into_iter().flatten().reduce(Bounds::union)?))
    }
}

impl Shape {
    /// The two to four branches that a quad has in place of an inner one.
    fn below(&self, branch: Branch) -> Option<Vec<Branch>> {
        let children = |of: Branch| self.nodes.get(of.first as usize..)?.get(..2);
        let mut below = children(branch)?.to_vec();
        while below.len() < 4 {
            let inner = below.iter().enumerate().filter(|(_, branch)| branch.count == 0);
            let heaviest = inner.max_by(|(_, a), (_, b)| a.weight.total_cmp(&b.weight)).map(|(at, _)| at);
            let Some(at) = heaviest else { break };
            let heaviest = below.remove(at);
            below.extend_from_slice(children(heaviest)?);
        }
        Some(below)
    }
}

/// Four boxes in a tree's unit, grown and rounded outwards; those that are missing are nowhere.
fn planes(scale: f64, boxes: [Option<Bounds>; 4]) -> Planes {
    std::array::from_fn(|axis| {
        let low = |bounds: Bounds| round_down(bounds.low[axis] * scale - MARGIN);
        let high = |bounds: Bounds| round_up(bounds.high[axis] * scale + MARGIN);
        let low = boxes.map(|bounds| bounds.map_or(f32::MAX, low));
        let high = boxes.map(|bounds| bounds.map_or(f32::MIN, high));
        [Vec4::from_array(low), Vec4::from_array(high)]
    })
}

/// The shape that `obvhs` finds.
///
/// It sees the boxes in the unit cube and each a little displaced: with equal boxes, or boxes in a row, every
/// neighbour is as good as any other, and then it pairs only two in each pass over all.
fn by_ploc(boxes: &[Bounds], all: &Bounds, leaf: u32) -> Shape {
    let unit = |axis: usize| {
        let size = 0.5 * all.high[axis] - 0.5 * all.low[axis];
        if size > 0.0 { 0.5 / size } else { 0.0 }
    };
    // One unit for all axes, or areas would be distorted.
    let unit = (0..3).map(unit).filter(|&unit| unit > 0.0 && unit.is_finite()).fold(f64::INFINITY, f64::min);
    let unit = if unit.is_finite() { unit } else { 0.0 };
    let mut noise = Noise(0x9e37_79b9_7f4a_7c15);
    let boxes: Vec<Aabb> = boxes
        .iter()
        .map(|bounds| {
            let mut corner = |at: [f64; 3], sign: f64| {
                let place = |axis: usize| (at[axis] - all.low[axis]) * unit;
                [0, 1, 2].map(|axis| (place(axis) + sign * noise.next() / 65536.0) as f32)
            };
            let (low, high) = (corner(bounds.low, -1.0), corner(bounds.high, 1.0));
            Aabb::new(low.into(), high.into())
        })
        .collect();

    let order = (0..boxes.len() as u32).collect();
    let mut bvh: Bvh2 =
        PlocBuilder::with_capacity(boxes.len()).build(PlocSearchDistance::Medium, &boxes, order, SortPrecision::U64, 2);
    let mut optimizer = ReinsertionOptimizer::default();
    // Its stack is fixed for trees of this depth.
    let shallow = bvh.max_depth <= obvhs::bvh2::DEFAULT_MAX_STACK_DEPTH;
    if shallow {
        let ratio = (REINSERTED / bvh.nodes.len() as f32).min(1.0);
        optimizer.run(&mut bvh, ratio, None);
    }
    collapse(&mut bvh, leaf, STEP_COST);
    let branch =
        |node: &Bvh2Node| Branch { first: node.first_index, count: node.prim_count, weight: node.aabb().half_area() };
    Shape { nodes: bvh.nodes.iter().map(branch).collect(), order: bvh.primitive_indices }
}

/// Small reproducible numbers.
struct Noise(u64);

impl Noise {
    /// The next number in 0.0..1.0.
    fn next(&mut self) -> f64 {
        // xorshift64
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A shape of halves, whose depth is bounded: along the longest axis of the centres.
fn by_halves(boxes: &[Bounds], leaf: usize) -> Shape {
    let mut shape = Shape { nodes: vec![Branch::default()], order: (0..boxes.len() as u32).collect() };
    let mut open = vec![(0_usize, 0..boxes.len())];
    while let Some((at, range)) = open.pop() {
        let (first, count) = (range.start, range.len());
        if count <= leaf {
            shape.nodes[at] = Branch { first: first as u32, count: count as u32, weight: 0.0 };
            continue;
        }
        let members = &mut shape.order[range];
        let centre = |item: u32| boxes[item as usize].centre();
        let centres = Bounds::around(members.iter().map(|&item| centre(item)));
        let axis = centres.map_or(0, |centres| {
            let extent = |axis: usize| 0.5 * centres.high[axis] - 0.5 * centres.low[axis];
            (1..3).fold(0, |longest, axis| if extent(axis) > extent(longest) { axis } else { longest })
        });
        members.select_nth_unstable_by(count / 2, |&a, &b| centre(a)[axis].total_cmp(&centre(b)[axis]).then(a.cmp(&b)));
        let children = shape.nodes.len();
        // Halves become quarters in each quad.
        shape.nodes[at] = Branch { first: children as u32, count: 0, weight: count as f32 };
        shape.nodes.extend([Branch::default(); 2]);
        open.push((children, first..first + count / 2));
        open.push((children + 1, first + count / 2..first + count));
    }
    shape
}
