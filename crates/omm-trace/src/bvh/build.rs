//! Building a tree: the shape from `obvhs`, the boxes from us.

use glam::Vec4;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::slab::{power_below, round_down, round_up};
use super::{Bvh, MAX_DEPTH, Node, Pair, Planes};

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
/// How much dearer a step down the tree is than a primitive, for the collapse of leaves.
const STEP_COST: f32 = 1.0;

/// A tree by its nodes: node 0 is the root, an inner node's children are `first` and `first + 1`, a leaf's `count`
/// items begin at `first` of `order`.
struct Shape {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

impl Bvh {
    /// A tree over `boxes` with at most `leaf` of them in a leaf; its items are their indices. `None` if there are
    /// 2^30 boxes or more.
    pub(crate) fn build(boxes: &[Bounds], leaf: u32) -> Option<Self> {
        Self::build_within(boxes, leaf.max(1), MAX_DEPTH)
    }

    pub(super) fn build_within(boxes: &[Bounds], leaf: u32, max_depth: usize) -> Option<Self> {
        if boxes.len() >= 1 << 30 {
            return None;
        }
        let Some(all) = boxes.iter().copied().reduce(Bounds::union) else { return Some(Self::default()) };
        let largest = all.largest();
        let scale = if largest > 0.0 { 1.0 / power_below(largest) } else { 1.0 };
        let shape = by_ploc(boxes, &all, leaf);
        let bvh = Self::assemble(&shape, boxes, scale, max_depth);
        bvh.or_else(|| Self::assemble(&by_halves(boxes, leaf as usize), boxes, scale, max_depth))
    }

    /// A box in the unit of this tree, twice: for [`BoxRay::meets`](super::BoxRay::meets).
    pub(crate) fn planes_of(&self, bounds: &Bounds) -> Planes {
        planes(self.scale, [bounds, bounds])
    }

    /// The tree of that shape with the boxes of what lies below each node; `None` if it is too deep or no tree over
    /// all of them.
    fn assemble(shape: &Shape, boxes: &[Bounds], scale: f64, max_depth: usize) -> Option<Self> {
        let mut bvh = Self {
            scale,
            root: None,
            pairs: Vec::with_capacity(shape.nodes.len() / 2),
            items: Vec::with_capacity(boxes.len()),
        };
        let (root, _) = bvh.place(shape, *shape.nodes.first()?, boxes, max_depth)?;
        bvh.root = Some(root);
        let mut seen = vec![false; boxes.len()];
        for &item in &bvh.items {
            *seen.get_mut(item as usize)? = true;
        }
        (bvh.items.len() == boxes.len() && !seen.contains(&false)).then_some(bvh)
    }

    /// Places a node and all below it, at most `levels` deep, and says where and how large it is.
    fn place(&mut self, shape: &Shape, node: Node, boxes: &[Bounds], levels: usize) -> Option<(Node, Bounds)> {
        if node.count > 0 {
            let first = node.first as usize;
            let members = shape.order.get(first..first.checked_add(node.count as usize)?)?;
            let slot = u32::try_from(self.items.len()).ok()?;
            // A shape that lists an item twice would never end to grow.
            (self.items.len() + members.len() <= boxes.len()).then_some(())?;
            self.items.extend_from_slice(members);
            let bounds = members.iter().filter_map(|&item| boxes.get(item as usize)).copied().reduce(Bounds::union)?;
            return Some((Node { first: slot, count: node.count }, bounds));
        }
        let levels = levels.checked_sub(1)?;
        let index = self.pairs.len();
        (index < boxes.len()).then_some(())?;
        self.pairs.push(Pair { planes: [Vec4::ZERO; 3], nodes: [Node::default(); 2] });
        let child = |side: usize| shape.nodes.get(node.first as usize + side).copied();
        let (left, left_bounds) = self.place(shape, child(0)?, boxes, levels)?;
        let (right, right_bounds) = self.place(shape, child(1)?, boxes, levels)?;
        let pair = self.pairs.get_mut(index)?;
        *pair = Pair { planes: planes(self.scale, [&left_bounds, &right_bounds]), nodes: [left, right] };
        Some((Node { first: u32::try_from(index).ok()?, count: 0 }, left_bounds.union(right_bounds)))
    }
}

/// Two boxes in a tree's unit, grown and rounded outwards.
fn planes(scale: f64, [left, right]: [&Bounds; 2]) -> Planes {
    std::array::from_fn(|axis| {
        let low = |bounds: &Bounds| round_down(bounds.low[axis] * scale - MARGIN);
        let high = |bounds: &Bounds| round_up(bounds.high[axis] * scale + MARGIN);
        Vec4::new(low(left), low(right), high(left), high(right))
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
        optimizer.run(&mut bvh, 0.05, None);
    }
    collapse(&mut bvh, leaf, STEP_COST);
    let nodes = bvh.nodes.iter().map(|node| Node { first: node.first_index, count: node.prim_count }).collect();
    Shape { nodes, order: bvh.primitive_indices }
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

/// A shape whose depth is bounded: halves along the longest axis of the centres.
fn by_halves(boxes: &[Bounds], leaf: usize) -> Shape {
    let mut shape = Shape { nodes: vec![Node::default()], order: (0..boxes.len() as u32).collect() };
    let mut open = vec![(0_usize, 0..boxes.len())];
    while let Some((at, range)) = open.pop() {
        let (first, count) = (range.start, range.len());
        if count <= leaf {
            shape.nodes[at] = Node { first: first as u32, count: count as u32 };
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
        shape.nodes[at] = Node { first: children as u32, count: 0 };
        shape.nodes.extend([Node::default(); 2]);
        open.push((children, first..first + count / 2));
        open.push((children + 1, first + count / 2..first + count));
    }
    shape
}
