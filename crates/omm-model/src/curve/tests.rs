use std::collections::HashSet;

use proptest::prelude::*;

use super::*;

fn level(level: u32) -> SubdivisionLevel {
    SubdivisionLevel::new(level).unwrap()
}

/// The curve built top down from its description: the part at vertex 0, the middle part flipped, the part at vertex 1, the part
/// at vertex 2 flipped. Corners are exact in units of the finest level; nothing is shared with the code under test.
fn recursive(segments: i64, levels: u32) -> Vec<[(i64, i64); 3]> {
    fn visit(t: [(i64, i64); 3], levels: u32, out: &mut Vec<[(i64, i64); 3]>) {
        if levels == 0 {
            out.push(t);
            return;
        }
        let mid = |a: (i64, i64), b: (i64, i64)| ((a.0 + b.0) / 2, (a.1 + b.1) / 2);
        let [vertex_0, vertex_1, vertex_2] = t;
        let (m01, m12, m20) = (mid(vertex_0, vertex_1), mid(vertex_1, vertex_2), mid(vertex_2, vertex_0));
        visit([vertex_0, m01, m20], levels - 1, out);
        visit([m20, m12, m01], levels - 1, out);
        visit([m01, vertex_1, m12], levels - 1, out);
        visit([m12, m20, vertex_2], levels - 1, out);
    }
    let mut out = Vec::new();
    visit([(0, 0), (segments, 0), (0, segments)], levels, &mut out);
    out
}

#[test]
fn equals_the_recursive_construction() {
    for level in (0..=10).map(level) {
        let expected = recursive(level.segments().into(), level.get());
        assert_eq!(expected.len(), level.microtriangles() as usize);
        let mut bulk = vec![[Corner { u: 0, v: 0 }; 3]; expected.len()];
        corners(level, &mut bulk);
        for (microtriangle, (expected, bulk)) in MicroTriangle::all(level).zip(expected.into_iter().zip(bulk)) {
            let found = microtriangle.corners();
            assert_eq!(found, bulk);
            assert_eq!(found.map(|c| (i64::from(c.u), i64::from(c.v))), expected, "{microtriangle:?}");
        }
    }
}

/// Every cell of the subdivided triangle, named by its least corner and orientation, is hit by exactly one index, and the
/// reference function maps the cell's centroid back to that index.
#[test]
fn is_a_bijection_at_every_level() {
    for level in (0..=10).map(level) {
        let mut cells = HashSet::new();
        for microtriangle in MicroTriangle::all(level) {
            let corners = microtriangle.corners();
            let least = (corners.iter().map(|c| c.u).min().unwrap(), corners.iter().map(|c| c.v).min().unwrap());
            let flipped = microtriangle.is_flipped();
            let [a, b, c] = corners.map(|corner| (i64::from(corner.u), i64::from(corner.v)));
            let doubled_area = (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0);
            assert_eq!(doubled_area.abs(), 1, "{microtriangle:?} is not of unit size");
            assert!(least.0 + least.1 + u32::from(flipped) < level.segments(), "{microtriangle:?} lies outside");
            assert!(cells.insert((least, flipped)), "{microtriangle:?} covers a cell again");
            let [u, v] = microtriangle.centroid();
            assert_eq!(index(u, v, level), microtriangle.index(), "{microtriangle:?}");
        }
        assert_eq!(cells.len(), level.microtriangles() as usize);
    }
}

#[test]
fn the_curve_enters_where_it_left() {
    for level in (1..=8).map(level) {
        for pair in MicroTriangle::all(level).collect::<Vec<_>>().windows(2) {
            assert_eq!(pair[0].corners()[2], pair[1].corners()[0], "{pair:?}");
        }
    }
}

#[test]
fn children_lie_within_their_parent() {
    for level in (0..=6).map(level) {
        for parent in MicroTriangle::all(level) {
            let children = parent.children().unwrap();
            for child in children {
                assert_eq!(child.parent(), Some(parent));
                let [u, v] = child.centroid();
                assert_eq!(MicroTriangle::at(u, v, level), parent);
            }
        }
    }
    assert_eq!(MicroTriangle::ROOT.parent(), None);
    assert_eq!(MicroTriangle::new(SubdivisionLevel::MAX, 0).unwrap().children(), None);
    assert_eq!(MicroTriangle::new(level(2), 16), None);
}

/// The finest two levels are too large to enumerate in a test; their centroids are sampled.
#[test]
fn finest_levels_round_trip_on_a_sample() {
    for level in [level(11), level(12)] {
        for index_ in (0..level.microtriangles()).step_by(61) {
            let [u, v] = MicroTriangle::new(level, index_).unwrap().centroid();
            assert_eq!(index(u, v, level), index_);
        }
    }
}

#[test]
fn odd_inputs_are_those_of_the_reference_code() {
    let nan = f32::NAN;
    for level in SubdivisionLevel::all() {
        assert_eq!(index(nan, nan, level), 0);
        assert_eq!(index(nan, 0.7, level), index(0.0, 0.7, level));
        assert_eq!(index(0.7, -nan, level), index(0.7, 0.0, level));
        assert_eq!(index(f32::INFINITY, f32::NEG_INFINITY, level), index(1.0, 0.0, level));
        assert_eq!(index(-0.0, -1.0, level), 0);
        assert_eq!(index(0.0, 1.0, level), level.microtriangles() - 1);
    }
}

#[test]
fn corner_barycentrics_are_exact() {
    for microtriangle in MicroTriangle::all(level(5)) {
        for corner in microtriangle.corners() {
            let [u, v] = corner.barycentrics(microtriangle.level());
            assert_eq!((u * 32.0, v * 32.0), (corner.u as f32, corner.v as f32));
        }
    }
}

proptest! {
    #[test]
    fn any_input_gives_an_index_in_range(u: f32, v: f32, l in 0_u32..=12) {
        let level = level(l);
        let found = index(u, v, level);
        prop_assert!(found < level.microtriangles());
        let mut bulk = [0; 1];
        indices(&[[u, v]], level, &mut bulk);
        prop_assert_eq!(bulk, [found]);
    }

    /// Inside the triangle and away from edges the coarser index is a prefix of the finer one.
    #[test]
    fn coarser_indices_are_prefixes(l in 1_u32..=12, raw: u32, du in 1_u32..5, dv in 1_u32..5) {
        let level = level(l);
        let microtriangle = MicroTriangle::new(level, raw % level.microtriangles()).unwrap();
        // An interior point with weights du, dv, 10 - du - dv of the three corners.
        let [a, b, c] = microtriangle.corners().map(|corner| (f64::from(corner.u), f64::from(corner.v)));
        let (du, dv) = (f64::from(du) / 10.0, f64::from(dv) / 10.0);
        let mix = |a: f64, b: f64, c: f64| ((a * (1.0 - du - dv) + b * du + c * dv) / f64::from(level.segments())) as f32;
        let (u, v) = (mix(a.0, b.0, c.0), mix(a.1, b.1, c.1));
        prop_assert_eq!(index(u, v, level), microtriangle.index());
        prop_assert_eq!(Some(MicroTriangle::at(u, v, level.coarser().unwrap())), microtriangle.parent());
    }
}

#[test]
fn ties_are_broken_as_they_are_named() {
    let level = SubdivisionLevel::new(2).unwrap();
    for microtriangle in MicroTriangle::all(level) {
        let [u, v] = microtriangle.centroid();
        for tie_break in [TieBreak::Reference, TieBreak::LowestIndex] {
            assert_eq!(tie_break.index(u, v, level), microtriangle.index());
        }
    }
    // The lowest of all whose corners the grid's points are.
    for u in 0..=4_u8 {
        for v in 0..=4 - u {
            let corner = Corner { u: u.into(), v: v.into() };
            let lowest = MicroTriangle::all(level).find(|it| it.corners().contains(&corner)).unwrap();
            let [u, v] = corner.barycentrics(level);
            assert_eq!(TieBreak::LowestIndex.index(u, v, level), lowest.index(), "({u}, {v})");
        }
    }
    // Between two points of f32 that lie beside the diagonal of the coarsest split.
    let coarse = SubdivisionLevel::new(1).unwrap();
    let (u, tiny) = (0.5, f32::MIN_POSITIVE);
    assert_eq!(TieBreak::LowestIndex.index(u - 0.25, 0.25, coarse), 0);
    assert_eq!(TieBreak::LowestIndex.index(u.next_down(), tiny, coarse), 0);
    assert_eq!(TieBreak::LowestIndex.index(u.next_down() - 0.25, 0.25_f32.next_up().next_up(), coarse), 1);
    // Outside of the triangle the reference decides.
    for (u, v) in [(0.75, 0.75), (f32::NAN, 2.0), (-1.0, 0.3), (f32::INFINITY, 1.0)] {
        assert_eq!(TieBreak::LowestIndex.index(u, v, level), index(u, v, level));
    }
}
