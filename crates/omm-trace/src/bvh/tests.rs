//! Trees against lists of boxes.

use proptest::prelude::*;

use super::build::Bounds;
use super::*;

fn boxed(a: [f64; 3], b: [f64; 3]) -> Bounds {
    Bounds::around([a, b]).unwrap()
}

/// The boxes that a ray visits, in order of their index.
fn visited(bvh: &Bvh, origin: [f64; 3], direction: [f64; 3], range: Range<f32>) -> Vec<u32> {
    let ray = BoxRay::new(bvh, origin, direction, range.start);
    let mut found = Vec::new();
    let mut walk = Walk::new();
    walk.begin(bvh);
    while let Some(leaf) = walk.next(bvh, &ray, range.end, 0) {
        found.extend_from_slice(&bvh.items[bvh.slots(leaf)]);
    }
    assert_eq!(walk.next(bvh, &ray, range.end, 0), None);
    found.sort_unstable();
    found
}

/// How much a walk through all below a node can have open at most.
fn most_open(bvh: &Bvh, node: Node) -> usize {
    if node.as_leaf().is_some() {
        return 1;
    }
    let nodes = bvh.quads[node.0 as usize >> 1].nodes.into_iter().filter(|node| *node != Node::NONE);
    nodes.clone().count() - 1 + nodes.map(|node| most_open(bvh, node)).max().unwrap()
}

/// A tree over boxes of any size.
fn build(boxes: &[Bounds], leaf: u32) -> Bvh {
    Bvh::build(boxes, leaf, unit(boxes)).unwrap()
}

fn all(bvh: &Bvh) -> Vec<u32> {
    let mut items = bvh.items.clone();
    items.sort_unstable();
    items
}

#[test]
fn nothing_and_one() {
    let empty = build(&[], 2);
    assert_eq!(visited(&empty, [0.0; 3], [1.0, 0.0, 0.0], 0.0..1.0), []);
    let one = build(&[boxed([0.0; 3], [0.0; 3])], 2);
    assert_eq!(visited(&one, [0.0; 3], [1.0, 0.0, 0.0], 0.0..1.0), [0]);
}

#[test]
fn a_row_is_pruned() {
    let boxes: Vec<_> = (0..64).map(|i| boxed([f64::from(i), 0.0, 0.0], [f64::from(i) + 0.5, 1.0, 1.0])).collect();
    let bvh = build(&boxes, 2);
    assert_eq!(all(&bvh), (0..64).collect::<Vec<_>>());
    let down = visited(&bvh, [10.25, 0.5, 5.0], [0.0, 0.0, -1.0], 0.0..f32::INFINITY);
    assert!(down.contains(&10) && down.len() <= 4, "{down:?}");
    assert_eq!(visited(&bvh, [10.25, 0.5, 5.0], [0.0, 0.0, 1.0], 0.0..f32::INFINITY), []);
    assert_eq!(visited(&bvh, [10.25, 0.5, 5.0], [0.0, 0.0, -1.0], 0.0..3.0), []);
    assert_eq!(visited(&bvh, [-1.0, 0.5, 0.5], [1.0, 0.0, 0.0], 0.0..f32::INFINITY).len(), 64);
}

#[test]
fn a_lower_limit_prunes_what_is_left() {
    let boxes: Vec<_> = (0..64).map(|i| boxed([f64::from(i), 0.0, 0.0], [f64::from(i) + 0.5, 1.0, 1.0])).collect();
    let bvh = build(&boxes, 2);
    let ray = BoxRay::new(&bvh, [-1.0, 0.5, 0.5], [1.0, 0.0, 0.0], 0.0);
    let mut walk = Walk::new();
    assert_eq!(walk.next(&bvh, &ray, f32::INFINITY, 0), None);
    walk.begin(&bvh);
    assert!(walk.next(&bvh, &ray, f32::INFINITY, 0).is_some());
    assert_eq!(walk.next(&bvh, &ray, 0.5, 0), None);
    walk.begin(&bvh);
    assert!(walk.next(&bvh, &ray, 1.5, 0).is_some());
}

#[test]
fn equal_and_even_boxes_make_shallow_trees() {
    let equal = vec![boxed([1.0; 3], [2.0; 3]); 20_000];
    let row: Vec<_> = (0..20_000).map(|i| boxed([f64::from(i), 0.0, 0.0], [f64::from(i) + 1.0, 1.0, 0.0])).collect();
    let points = vec![boxed([0.0; 3], [0.0; 3]); 5_000];
    let nested: Vec<_> = (-140..127).map(|i| boxed([0.0; 3], [2.0_f64.powi(i); 3])).collect();
    for boxes in [equal, row, points, nested] {
        let bvh = build(&boxes, 2);
        assert!(most_open(&bvh, bvh.root.unwrap()) <= 48, "{} boxes", boxes.len());
        assert_eq!(all(&bvh).len(), boxes.len());
    }
}

#[test]
fn a_limit_to_what_is_open_is_kept() {
    let boxes: Vec<_> = (0..100).map(|i| boxed([f64::from(i * i), 0.0, 0.0], [f64::from(i * i), 1.0, 1.0])).collect();
    let build = |max_open| Bvh::build_within(&boxes, 4, unit(&boxes), max_open);
    assert!(most_open(&build(MAX_OPEN).unwrap(), build(MAX_OPEN).unwrap().root.unwrap()) > 8);
    let halves = build(8).unwrap();
    assert!(most_open(&halves, halves.root.unwrap()) <= 8);
    assert_eq!(all(&halves), (0..100).collect::<Vec<_>>());
    assert!(build(7).is_none());
}

#[test]
fn parts_have_everything_once() {
    let boxes: Vec<_> = (0..100).map(|i| boxed([f64::from(i * i), 0.0, 0.0], [f64::from(i * i), 1.0, 1.0])).collect();
    let bvh = build(&boxes, 4);
    for count in 0..40 {
        let mut parts = bvh.cut(count);
        assert!(parts.len() <= count.max(1) && parts.len() + 3 > count.min(25), "{count}: {}", parts.len());
        parts.sort_unstable_by_key(|part| part.slots.start);
        let slots: Vec<_> = parts.into_iter().flat_map(|part| part.slots).collect();
        assert_eq!(slots, (0..100).collect::<Vec<_>>());
    }
    assert_eq!(build(&[], 4).cut(9), []);
    assert_eq!(build(&boxes[..1], 4).cut(9).len(), 1);
}

#[test]
fn huge_and_tiny_numbers_lose_nothing() {
    let (max, tiny) = (f64::from(f32::MAX), f64::from(f32::from_bits(1)));
    for unit in [max, 1.0, tiny] {
        let boxes: Vec<_> = [-1.0, -0.5, 0.0, 0.5]
            .map(|x| boxed([x * unit, -unit, -unit], [x * unit + 0.25 * unit, unit, unit]))
            .into();
        let bvh = build(&boxes, 4);
        for direction in [tiny, 1.0, max] {
            let found = visited(&bvh, [-2.0 * unit, unit, 0.0], [direction, 0.0, 0.0], 0.0..f32::INFINITY);
            assert_eq!(found, [0, 1, 2, 3], "unit {unit:e} direction {direction:e}");
        }
        // Further away than the numbers of the tree reach every box is met, and no other.
        let beyond = visited(&bvh, [-1e30 * unit, 1e36, 0.0], [1.0, 0.0, 0.0], 0.0..f32::INFINITY);
        assert!(beyond == [0, 1, 2, 3] || unit > 1e-3, "unit {unit:e}: {beyond:?}");
        let far = visited(&bvh, [-1e30 * unit, 0.0, 0.0], [1.0, 0.0, 0.0], 0.0..f32::INFINITY);
        assert_eq!(far, [0, 1, 2, 3]);
        // Beyond the numbers everything may be met.
        let absurd = visited(&bvh, [f64::MAX, f64::MIN, 0.0], [f64::MAX, 1.0, 0.0], 0.0..1.0);
        assert!(absurd.len() <= 4);
    }
}

fn corner() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3((-8_i32..=8).prop_map(f64::from))
}

proptest! {
    /// A ray that passes exactly through a point of a closed box visits it: boxes, point, direction and t are small
    /// integers, so origin = point - t * direction is exact. Boxes may be flat, points on faces and corners,
    /// directions parallel to axes.
    #[test]
    fn no_box_on_the_way_is_lost(
        corners in prop::collection::vec((corner(), corner()), 1..40),
        which in any::<prop::sample::Index>(),
        within in [0_u8..=2, 0_u8..=2, 0_u8..=2],
        direction in corner(),
        t in 0_u8..=20,
        exponent in -30_i32..=30,
        max_open in prop_oneof![Just(MAX_OPEN), Just(8)],
    ) {
        prop_assume!(direction != [0.0; 3]);
        let unit = 2.0_f64.powi(exponent);
        let boxes: Vec<_> = corners.iter().map(|(a, b)| boxed(a.map(|x| x * unit), b.map(|x| x * unit))).collect();
        let chosen = which.index(boxes.len());
        let point: [f64; 3] = std::array::from_fn(|axis| {
            let Bounds { low, high } = boxes[chosen];
            low[axis] + (high[axis] - low[axis]) * f64::from(within[axis]) * 0.5
        });
        let origin: [f64; 3] = std::array::from_fn(|axis| point[axis] - f64::from(t) * direction[axis] * unit);
        let direction = direction.map(|x| x * unit);
        let bvh = Bvh::build_within(&boxes, 4, super::unit(&boxes), max_open).unwrap();
        let t = f32::from(t);
        for range in [t..t, 0.0..t, t..f32::INFINITY] {
            prop_assert!(visited(&bvh, origin, direction, range).contains(&(chosen as u32)));
        }
    }
}
