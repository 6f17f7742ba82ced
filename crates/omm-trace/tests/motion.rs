//! Motion: instances and vertices at the time of a ray.
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use omm_layout::object::{BlasGeometry, BlasPrimitives, MovingMappedTriangle, MovingVertices};
use omm_model::opacity::OpacityState;
use omm_model::special_index::{OpacityMicromapSpecialIndex, TriangleMap};
use omm_model::vk::{
    GeometryFlags, MatrixMotionInstance, MotionInstanceData, SrtData, SrtMotionInstance, TransformMatrix,
};
use omm_trace::{AnyHit, Candidate, Counters, HitKind, Ray, Scene, TraceOptions};
use proptest::prelude::*;
use support::*;

const AT_REST: SrtData = SrtData {
    sx: 1.0,
    a: 0.0,
    b: 0.0,
    pvx: 0.0,
    sy: 1.0,
    c: 0.0,
    pvy: 0.0,
    sz: 1.0,
    pvz: 0.0,
    qx: 0.0,
    qy: 0.0,
    qz: 0.0,
    qw: 1.0,
    tx: 0.0,
    ty: 0.0,
    tz: 0.0,
};

fn matrix_motion(blas: u64, [start, end]: [[[f32; 4]; 3]; 2]) -> MotionInstanceData {
    MotionInstanceData::MatrixMotionInstance(MatrixMotionInstance {
        transform_t0: TransformMatrix { matrix: start },
        transform_t1: TransformMatrix { matrix: end },
        mask: 0xff,
        acceleration_structure_reference: blas,
        ..Default::default()
    })
}

fn srt_motion(blas: u64, [transform_t0, transform_t1]: [SrtData; 2]) -> MotionInstanceData {
    MotionInstanceData::SrtMotionInstance(SrtMotionInstance {
        transform_t0,
        transform_t1,
        mask: 0xff,
        acceleration_structure_reference: blas,
        ..Default::default()
    })
}

fn moving(list: impl IntoIterator<Item = MovingVertices>) -> BlasGeometry {
    let triangles = list.into_iter().map(Some).collect();
    BlasGeometry { flags: GeometryFlags::empty(), primitives: BlasPrimitives::MovingTriangles(triangles) }
}

/// The unit triangle in one moving instance.
fn one(instance: impl Fn(u64) -> MotionInstanceData) -> Scene {
    let mut memory = Memory::default();
    let blas = memory.blas(vec![triangles(GeometryFlags::empty(), [unit_triangle(0.0)])]);
    memory.motion_scene(vec![instance(blas)])
}

fn at(x: f32, y: f32, time: f32) -> Ray {
    down(x, y).at_time(time).unwrap()
}

/// `objectToWorld` of the only instance.
fn matrix_at(scene: &Scene, time: f32) -> [[f32; 4]; 3] {
    scene.object_space(0, &at(0.0, 0.0, time)).unwrap().object_to_world
}

#[test]
fn matrices_are_interpolated_element_by_element() {
    let start = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    let end = [[2.0, 0.0, 0.0, 10.0], [0.0, 1.0, 0.5, 0.0], [0.0, 0.0, 1.0, 0.0]];
    let scene = one(|blas| matrix_motion(blas, [start, end]));
    assert_eq!(matrix_at(&scene, 0.0), start);
    assert_eq!(matrix_at(&scene, 1.0), end);
    assert_eq!(matrix_at(&scene, 0.25), [[1.25, 0.0, 0.0, 2.5], [0.0, 1.0, 0.125, 0.0], [0.0, 0.0, 1.0, 0.0]]);
    assert_eq!(closest(&scene, &at(0.25, 0.25, 0.0)).unwrap().barycentrics, [0.25, 0.25]);
    assert_eq!(closest(&scene, &at(0.25, 0.25, 0.5)), None);
    // Half way the scale is 1.5 and the shift 5.
    assert_eq!(closest(&scene, &at(5.375, 0.25, 0.5)).unwrap().barycentrics, [0.25, 0.25]);
    let space = scene.object_space(0, &at(5.375, 0.25, 0.5)).unwrap();
    // y is sheared by a quarter of z by then.
    assert_eq!((space.origin, space.direction), ([0.25, 0.0, 1.0], [0.0, 0.25, -1.0]));
}

#[test]
fn scale_comes_before_rotation_and_rotation_before_translation() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    // Twice as long in x and one less, a quarter turn about z, then ten to the right.
    let data = SrtData { sx: 2.0, pvx: -1.0, qz: half, qw: half, tx: 10.0, ..AT_REST };
    let scene = one(|blas| srt_motion(blas, [data; 2]));
    let expected = [[0.0, -1.0, 0.0, 10.0], [2.0, 0.0, 0.0, -1.0], [0.0, 0.0, 1.0, 0.0]];
    for (found, expected) in matrix_at(&scene, 0.5).as_flattened().iter().zip(expected.as_flattened()) {
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    }
    // The shear: a is what y adds to x, b what z adds to x, c what z adds to y.
    let data = SrtData { a: 3.0, b: 5.0, c: 7.0, pvx: 2.0, pvy: 4.0, pvz: 6.0, ty: 1.0, ..AT_REST };
    let scene = one(|blas| srt_motion(blas, [data; 2]));
    let expected = [[1.0, 3.0, 5.0, 2.0], [0.0, 1.0, 7.0, 5.0], [0.0, 0.0, 1.0, 6.0]];
    assert_eq!(matrix_at(&scene, 0.75), expected);
}

#[test]
fn quaternions_are_interpolated_and_then_normalised() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let quarter = SrtData { qz: half, qw: half, ..AT_REST };
    let scene = one(|blas| srt_motion(blas, [AT_REST, quarter]));
    // Half way between no turn and a quarter turn: an eighth, without any shrinking.
    let [[cos, minus_sin, ..], [sin, other_cos, ..], _] = matrix_at(&scene, 0.5);
    for found in [cos, -minus_sin, sin, other_cos] {
        assert!((found - half).abs() < 1e-6, "{found}");
    }
    // At a quarter of the time the angle is not a quarter: the chord is divided evenly, not the arc.
    let [[_, _, ..], [sin, ..], _] = matrix_at(&scene, 0.25);
    let chord = f64::from(half).mul_add(0.25, 0.75);
    let angle = 2.0 * (0.25 * f64::from(half)).atan2(chord);
    assert!((f64::from(sin) - angle.sin()).abs() < 1e-6, "{sin}");
    // Length does not matter, and a quaternion of none turns nothing into anything.
    let long = SrtData { qw: 8.0, ..AT_REST };
    assert_eq!(matrix_at(&one(|blas| srt_motion(blas, [long; 2])), 0.5), matrix_at(&scene, 0.0));
    let opposite = SrtData { qw: -1.0, ..AT_REST };
    let scene = one(|blas| srt_motion(blas, [AT_REST, opposite]));
    assert!(closest(&scene, &at(0.25, 0.25, 0.25)).is_some() && closest(&scene, &at(0.25, 0.25, 0.75)).is_some());
    assert_eq!((closest(&scene, &at(0.25, 0.25, 0.5)), scene.object_space(0, &at(0.0, 0.0, 0.5))), (None, None));
}

#[test]
fn vertices_move_along_lines_and_keep_their_micromap() {
    let map = |state| TriangleMap::SpecialIndex(OpacityMicromapSpecialIndex::of_state(state));
    let triangle = |start, end, state| {
        Some(MovingMappedTriangle { vertices: [unit_triangle(start), unit_triangle(end)], map: map(state) })
    };
    let primitives = BlasPrimitives::MovingMicromapTriangles {
        micromap: 0,
        triangles: vec![
            triangle(0.0, -4.0, OpacityState::Opaque),
            None,
            triangle(-4.0, 0.0, OpacityState::Transparent),
            triangle(-8.0, 0.5, OpacityState::UnknownOpaque),
        ],
    };
    let scene = scene_of(BlasGeometry { flags: GeometryFlags::empty(), primitives });
    let hit = |time| closest(&scene, &at(0.25, 0.25, time)).map(|hit| (hit.t, hit.primitive_id, hit.opaque));
    assert_eq!(hit(0.0), Some((1.0, 0, true)));
    assert_eq!(hit(0.5), Some((3.0, 0, true)));
    assert_eq!(hit(1.0), Some((0.5, 3, false)));
    assert_eq!(scene.triangle_vertices(0, 0, 0, 0.25), Some(unit_triangle(-1.0)));
    assert_eq!(scene.triangle_vertices(0, 0, 1, 0.25), None);
    let [low, high] = scene.bounds().unwrap();
    assert!(low[2] < -7.9 && high[2] > 0.4);
}

#[test]
fn what_is_squashed_at_a_time_is_not_hit_then() {
    let flat = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]];
    let tall = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    let scene = one(|blas| matrix_motion(blas, [flat, tall]));
    assert_eq!(scene.bounds(), None);
    assert_eq!(closest(&scene, &at(0.25, 0.25, 0.0)), None);
    assert_eq!(closest(&scene, &at(0.25, 0.25, 1e-6)).map(|hit| hit.t), Some(1.0));
    // Turned inside out on the way, it shows its front all the time: facing is judged in its own space.
    let mirrored = [[-1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    let scene = one(|blas| matrix_motion(blas, [tall, mirrored]));
    for time in [0.0, 1.0] {
        assert_eq!(closest(&scene, &at(0.5, 0.25, time)).unwrap().kind, HitKind::FrontFacingTriangle);
    }
    assert_eq!(closest(&scene, &at(0.5, 0.25, 0.5)), None);
}

fn number() -> impl Strategy<Value = f32> {
    prop_oneof![3 => (-3_i8..=3).prop_map(f32::from), 2 => -3.0_f32..3.0]
}

fn vertices() -> impl Strategy<Value = Vertices> {
    let point = || [number(), number(), number()];
    [point(), point(), point()]
}

fn srt() -> impl Strategy<Value = SrtData> {
    prop::collection::vec(number(), 16).prop_map(|n| SrtData {
        sx: n[0],
        a: n[1] * 0.25,
        b: n[2] * 0.25,
        pvx: n[3],
        sy: n[4],
        c: n[5] * 0.25,
        pvy: n[6],
        sz: n[7],
        pvz: n[8],
        qx: n[9],
        qy: n[10],
        qz: n[11],
        qw: n[12],
        tx: n[13],
        ty: n[14],
        tz: n[15],
    })
}

/// An instance of the structure at 0: how it moves is kept, the structure is set later.
fn any_motion() -> impl Strategy<Value = MotionInstanceData> {
    let matrix = || prop::array::uniform3([number(), number(), number(), number()]);
    let still = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    let shifted = [number(), number(), number()].prop_map(move |shift| {
        let end = std::array::from_fn(|row: usize| [still[row][0], still[row][1], still[row][2], shift[row]]);
        matrix_motion(0, [still, end])
    });
    let near = (srt(), 0.9_f32..1.1).prop_map(|(start, factor)| {
        let end = SrtData { sx: start.sx * factor, tx: start.tx + 1.0, qw: start.qw + 1.0, ..start };
        srt_motion(0, [start, end])
    });
    prop_oneof![
        [matrix(), matrix()].prop_map(|ends| matrix_motion(0, ends)),
        shifted,
        [srt(), srt()].prop_map(|ends| srt_motion(0, ends)),
        near,
    ]
}

/// Everything that the ray meets, in order.
fn everything(scene: &Scene, ray: &Ray) -> Vec<(u32, u32, u32)> {
    let mut seen = Vec::new();
    let mut shader = |candidate: &Candidate| {
        seen.push((candidate.t.to_bits(), candidate.instance_id, candidate.primitive_id));
        AnyHit::Ignore
    };
    scene.trace(ray, &TraceOptions::default(), &mut shader, &mut Counters::default());
    seen.sort_unstable();
    seen
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// A scene of one instance of one triangle is traced without any box, so the union of such scenes is the scene
    /// without a hierarchy.
    #[test]
    fn the_hierarchy_loses_nothing_at_any_time(
        mesh in prop::collection::vec([vertices(), vertices()], 1..5),
        instances in prop::collection::vec(any_motion(), 1..6),
        rays in prop::collection::vec(([number(), number(), number()], any::<prop::sample::Index>(), 0.0_f32..=1.0), 24),
    ) {
        let build = |instance: Option<usize>, primitive: Option<usize>| {
            let list = mesh.iter().enumerate().map(|(at, vertices)| primitive.is_none_or(|it| it == at).then_some(*vertices));
            let primitives = BlasPrimitives::MovingTriangles(list.collect());
            let mut memory = Memory::default();
            let blas = memory.blas(vec![BlasGeometry { flags: GeometryFlags::empty(), primitives }]);
            let chosen = instances.iter().enumerate().map(|(at, data)| {
                data.with_reference(if instance.is_none_or(|it| it == at) { blas } else { 0 })
            });
            memory.motion_scene(chosen.collect())
        };
        let scene = build(None, None);
        let mut pieces = Vec::new();
        for instance in 0..instances.len() {
            pieces.extend((0..mesh.len()).map(|primitive| build(Some(instance), Some(primitive))));
        }
        for (origin, aim, time) in rays {
            // At the middle of a triangle of an instance, where it is then.
            let at = aim.index(pieces.len());
            let (instance, primitive) = ((at / mesh.len()) as u32, (at % mesh.len()) as u32);
            let probe = Ray::unbounded([0.0; 3], [1.0; 3]).unwrap().at_time(time).unwrap();
            let Some(space) = scene.object_space(instance, &probe) else { continue };
            let [a, b, c] = scene.triangle_vertices(instance, 0, primitive, time).unwrap();
            let [x, y, z]: [f32; 3] = std::array::from_fn(|i| (a[i] + b[i] + c[i]) / 3.0);
            let target = space.object_to_world.map(|[p, q, r, s]| p * x + q * y + r * z + s);
            let direction = std::array::from_fn(|i| target[i] - origin[i]);
            let Ok(ray) = Ray::unbounded(origin, direction).and_then(|ray| ray.at_time(time)) else { continue };
            let mut expected: Vec<_> = pieces.iter().flat_map(|piece| everything(piece, &ray)).collect();
            expected.sort_unstable();
            prop_assert_eq!(everything(&scene, &ray), expected);
        }
    }

    /// Neighbours that move agree on their edge at every time.
    #[test]
    fn a_moving_sheet_has_no_gaps(
        heights in prop::collection::vec((-1.0_f32..1.0, -1.0_f32..1.0), 25),
        time in 0.0_f32..=1.0,
        places in prop::collection::vec([2_u8..=14, 2_u8..=14], 24),
    ) {
        let vertex = |x: usize, y: usize, end: bool| {
            let (start, stop) = heights[5 * y + x];
            [x as f32, y as f32, if end { stop } else { start }]
        };
        let cells = (0..16).flat_map(|cell| {
            let (x, y) = (cell % 4, cell / 4);
            let corners = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)];
            [[0, 1, 2], [0, 2, 3]].map(|triangle| {
                [false, true].map(|end| triangle.map(|at: usize| vertex(corners[at].0, corners[at].1, end)))
            })
        });
        let scene = scene_of(moving(cells));
        for [x, y] in places {
            let ray = Ray::unbounded([f32::from(x) * 0.25, f32::from(y) * 0.25, 3.0], [0.0, 0.0, -1.0]).unwrap();
            prop_assert_eq!(everything(&scene, &ray.at_time(time).unwrap()).len(), 1);
        }
    }
}
