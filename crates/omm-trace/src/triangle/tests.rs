//! One ray and one triangle, or a few around an edge or vertex.

use proptest::prelude::*;

use super::*;

const UNIT: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

fn hit(origin: [f64; 3], direction: [f64; 3], vertices: [[f32; 3]; 3]) -> Option<TriangleHit> {
    TriangleRay::new(origin, direction).intersect(&vertices)
}

#[test]
fn barycentrics_weigh_vertices_1_and_2() {
    let found = hit([0.125, 0.5, 3.0], [0.0, 0.0, -2.0], UNIT).unwrap();
    assert_eq!(found, TriangleHit { t: 1.5, barycentrics: [0.125, 0.5], front: true });
    let below = hit([0.125, 0.5, -3.0], [0.0, 0.0, 2.0], UNIT).unwrap();
    assert_eq!(below, TriangleHit { t: 1.5, barycentrics: [0.125, 0.5], front: false });
    let [a, b, c] = UNIT;
    let turned = hit([0.125, 0.5, 3.0], [0.0, 0.0, -2.0], [a, c, b]).unwrap();
    assert_eq!(turned, TriangleHit { t: 1.5, barycentrics: [0.5, 0.125], front: false });
    // Behind the origin t is negative; the caller's range decides.
    assert_eq!(hit([0.125, 0.5, 3.0], [0.0, 0.0, 2.0], UNIT).unwrap().t, -1.5);
}

#[test]
fn the_front_does_not_depend_on_the_axis() {
    // The front is where the vertices run counterclockwise in a right-handed system: against the cross product of
    // the edges.
    for axis in 0..3 {
        let turn = |[x, y, z]: [f32; 3]| [[x, y, z], [z, x, y], [y, z, x]][axis];
        let vertices = UNIT.map(turn);
        for tilt in [[0.0, 0.0], [0.3, -0.4], [-0.9, 0.8]] {
            for (height, front) in [(2.0, true), (-2.0, false)] {
                let [dx, dy]: [f32; 2] = tilt;
                let origin = turn([0.25 + dx * height, 0.25 + dy * height, height]).map(f64::from);
                let direction = turn([-dx * height, -dy * height, -height]).map(f64::from);
                assert_eq!(hit(origin, direction, vertices).unwrap().front, front, "axis {axis} tilt {tilt:?}");
            }
        }
    }
}

#[test]
fn degenerate_and_edge_on_triangles_are_missed() {
    let down = |vertices| hit([0.25, 0.25, 1.0], [0.0, 0.0, -1.0], vertices);
    assert_eq!(down([[0.25, 0.25, 0.0]; 3]), None);
    assert_eq!(down([[0.0, 0.0, 0.0], [0.5, 0.5, 0.0], [1.0, 1.0, 0.0]]), None);
    assert_eq!(down([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 1.0, 0.0]]), None);
    assert_eq!(down([[0.25, 0.0, 0.0], [0.25, 1.0, 0.0], [0.25, 0.0, -1.0]]), None);
    assert_eq!(hit([-1.0, 0.25, 0.0], [1.0, 0.0, 0.0], UNIT), None);
    // Beyond the range of f64 nothing is hit and nothing fails.
    assert_eq!(hit([1e300; 3], [0.0, 0.0, -1.0], UNIT), None);
    assert_eq!(hit([f64::MAX, -f64::MAX, 1.0], [1.0, 1.0, 1.0], UNIT), None);
    assert_eq!(hit([0.0; 3], [0.0; 3], UNIT), None);
}

#[test]
fn products_are_exact() {
    for (a, b) in [(0.1, 0.7), (1e100, 3.3e-90), (1.0 + f64::EPSILON, 1.0 - f64::EPSILON), (3.0, -7.0)] {
        let (rounded, error) = product(a, b);
        assert_eq!(rounded, a * b);
        // 2^106 has room for both mantissas: compare with integers.
        let integer = |x: f64| {
            let bits = x.to_bits();
            let mantissa = i128::from(bits & ((1 << 52) - 1) | 1 << 52);
            (if x < 0.0 { -mantissa } else { mantissa }, (bits >> 52 & 0x7ff) as i32)
        };
        let ((ma, ea), (mb, eb)) = (integer(a), integer(b));
        let exact = ma * mb;
        let (mr, er) = integer(rounded);
        let left = exact - (mr << (er + 1075 - ea - eb));
        let unit = 2.0_f64.powi((ea + eb - 2150).clamp(-1022, 1023));
        assert_eq!(left as f64 * unit, error, "{a} * {b}");
    }
}

#[test]
fn what_rounding_hides_decides() {
    // (1 + ε)² rounds to 1 + 2ε, so both products are equal though ε² is left.
    let (one, two) = (1.0 + f64::EPSILON, 1.0 + 2.0 * f64::EPSILON);
    let (p, q) = ([one, two, 0.0], [1.0, one, 0.0]);
    assert_eq!(edge(p, q), 0.0);
    assert_eq!(edge_exact(p, q), f64::EPSILON * f64::EPSILON);
    assert_eq!(edge_exact(q, p), -f64::EPSILON * f64::EPSILON);
    // On the edge itself the direction of the edge decides, and the other way round it decides the other way.
    for q in [[-2.0, -2.0, 0.0], [-2.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]] {
        let p = q.map(|x| -0.5 * x);
        assert_eq!(edge_exact(p, q), 0.0);
        assert_eq!(edge_sign(p, q, 0.0), -edge_sign(q, p, 0.0));
        assert_ne!(edge_sign(p, q, 0.0), 0);
    }
    assert_eq!(edge_sign(p, p, 0.0), 0);
}

#[test]
fn packets_pass_over_what_is_not_near() {
    let [a, b, c] = UNIT;
    let beside = UNIT.map(|[x, y, z]| [x + 0.3, y, z]);
    let packet = Packet::new(&[UNIT, beside, [a, c, b], beside.map(|[x, y, z]| [-x, y, -z])]);
    let ray = |largest| PacketRay::new([0.25, 0.25, 8.0], [0.0, 0.0, -1.0], largest);
    assert_eq!(ray(1.3).may_meet(&packet), 0b0101);
    // With numbers whose products are none nothing is passed over.
    assert_eq!(ray(1e30).may_meet(&packet), 0b1111);
}

fn small() -> impl Strategy<Value = f32> {
    prop_oneof![(-4_i8..=4).prop_map(f32::from), -4.0_f32..4.0]
}

fn point() -> impl Strategy<Value = [f32; 3]> {
    [small(), small(), small()]
}

proptest! {
    /// Around a vertex surrounded by a closed fan exactly one triangle is hit, wherever the ray passes: exactly
    /// through the vertex, exactly through an edge, or near.
    #[test]
    fn a_fan_is_hit_once(
        heights in prop::collection::vec(-1.0_f32..1.0, 7),
        spokes in 3_usize..=6,
        centre in [-0.2_f32..0.2, -0.2_f32..0.2],
        aim in prop_oneof![Just(None), (0_usize..6, 0.0_f32..0.9).prop_map(Some)],
        start in [small(), small()],
        turn in 0_usize..3,
    ) {
        const RIM: [[f32; 2]; 6] = [[4.0, 0.0], [2.0, 3.5], [-2.0, 3.5], [-4.0, 0.0], [-2.0, -3.5], [2.0, -3.5]];
        let middle = [centre[0], centre[1], heights[6]];
        let chosen: Vec<_> = (0..spokes).map(|i| {
            let at = i * 6 / spokes;
            [RIM[at][0], RIM[at][1], heights[at]]
        }).collect();
        let place = |[x, y, z]: [f32; 3]| [[x, y, z], [z, x, y], [y, z, x]][turn];
        // Whether rounding leaves the ray exactly on its target or just beside it must not matter.
        let target = match aim {
            None => middle.map(f64::from),
            Some((spoke, part)) => {
                let (from, to) = (middle.map(f64::from), chosen[spoke % spokes].map(f64::from));
                std::array::from_fn(|i| from[i] + f64::from(part) * 0.2 * (to[i] - from[i]))
            }
        };
        let origin = [f64::from(start[0]) * 0.1, f64::from(start[1]) * 0.1, 64.0];
        let direction: [f64; 3] = std::array::from_fn(|i| target[i] - origin[i]);
        let place64 = |[x, y, z]: [f64; 3]| [[x, y, z], [z, x, y], [y, z, x]][turn];
        let ray = TriangleRay::new(place64(origin), place64(direction));
        let hits = (0..spokes).filter(|&i| {
            let triangle = [middle, chosen[i], chosen[(i + 1) % spokes]].map(place);
            // The winding of one triangle does not matter to its neighbours.
            let triangle = if i % 2 == 0 { triangle } else { [triangle[1], triangle[0], triangle[2]] };
            ray.intersect(&triangle).is_some()
        }).count();
        prop_assert_eq!(hits, 1);
    }

    /// What a packet says to be missed is missed, wherever the ray passes: near an edge, near a vertex, in a plane.
    #[test]
    fn packets_lose_nothing(
        triangles in prop::collection::vec([point(), point(), point()], 1..=4),
        which in any::<prop::sample::Index>(),
        weights in (prop_oneof![Just(0.0_f32), Just(0.5), Just(1.0), 0.0_f32..1.0], 0.0_f32..1.0),
        beside in prop_oneof![2 => Just(0.0_f32), 1 => -1e-5_f32..1e-5],
        origin in point(),
        exponents in prop::array::uniform2(prop_oneof![4 => Just(0), 1 => -60_i32..=60, 1 => -149_i32..=125]),
    ) {
        let [size, far] = exponents.map(|exponent| 2.0_f64.powi(exponent));
        let triangles: Vec<_> = triangles.iter().map(|it| it.map(|p| p.map(|x| (f64::from(x) * size) as f32))).collect();
        let [a, b, c] = triangles[which.index(triangles.len())].map(|p| p.map(f64::from));
        let (u, v) = (f64::from(weights.0), f64::from(weights.1));
        let origin = origin.map(|x| f64::from(x) * far);
        let direction: [f64; 3] = std::array::from_fn(|i| {
            a[i] + u * (b[i] - a[i]) + v * (1.0 - u) * (c[i] - a[i]) + f64::from(beside) * size - origin[i]
        });
        prop_assume!(direction.iter().any(|x| *x != 0.0));
        let ray = TriangleRay::new(origin, direction);
        let largest = triangles.as_flattened().as_flattened().iter().fold(0.0, |largest: f32, x| largest.max(x.abs()));
        let met = PacketRay::new(origin, direction, largest.into()).may_meet(&Packet::new(&triangles));
        for (lane, triangle) in triangles.iter().enumerate() {
            prop_assert!(ray.intersect(triangle).is_none() || met >> lane & 1 == 1, "{triangle:?} {ray:?}");
        }
    }

    /// Renaming the vertices changes names only.
    #[test]
    fn rotation_of_vertices_changes_nothing(a in point(), b in point(), c in point(), o in point(), d in point()) {
        prop_assume!(d != [0.0; 3]);
        let ray = TriangleRay::new(o.map(f64::from), d.map(f64::from));
        let (first, second) = (ray.intersect(&[a, b, c]), ray.intersect(&[b, c, a]));
        let mirrored = ray.intersect(&[a, c, b]);
        prop_assert_eq!(first.is_some(), second.is_some());
        prop_assert_eq!(first.is_some(), mirrored.is_some());
        if let (Some(first), Some(second), Some(mirrored)) = (first, second, mirrored) {
            prop_assert_eq!(first.front, second.front);
            prop_assert_ne!(first.front, mirrored.front);
            prop_assert!((first.barycentrics[1] - second.barycentrics[0]).abs() <= 1e-6);
        }
    }
}
