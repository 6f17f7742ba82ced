//! Ray queries: what they find is what a pipeline finds, and what a state forbids is an error.
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use omm_model::opacity::OpacityState;
use omm_model::special_index::{OpacityMicromapSpecialIndex, TriangleMap};
use omm_model::vk::{GeometryFlags, GeometryInstanceFlags, Instance, TransformMatrix};
use omm_trace::query::{
    CommittedIntersection, Intersection, QueryCandidate, QueryState, RayQuery, micromaps_in_ray_queries,
};
use omm_trace::{
    AabbCandidate, AnyHit, Candidate, Counters, Hit, QueryError, Ray, RayFlags, ReportedHit, Scene, Shaders,
    TraceOptions,
};
use proptest::prelude::*;
use support::*;

/// Shaders whose answers depend on nothing but the candidate, and a record of what they were asked.
#[derive(Default)]
struct Hashed {
    seed: u32,
    seen: Vec<(u32, u32, u32, u32)>,
}

impl Hashed {
    fn answer(&mut self, t: f32, place: (u32, u32, u32)) -> u32 {
        self.seen.push((t.to_bits(), place.0, place.1, place.2));
        let hash = [place.0, place.1, place.2]
            .iter()
            .fold(self.seed, |hash, x| (hash ^ x).wrapping_mul(0x9e37_79b1).rotate_left(13));
        hash >> 8
    }

    fn triangle(&mut self, candidate: &Candidate) -> AnyHit {
        let Candidate { t, instance_id, geometry_index, primitive_id, .. } = *candidate;
        match self.answer(t, (instance_id, geometry_index, primitive_id)) % 8 {
            0..=3 => AnyHit::Ignore,
            4..=6 => AnyHit::Accept,
            _ => AnyHit::AcceptAndEndSearch,
        }
    }

    /// Anywhere near the range, in it or not.
    fn aabb(&mut self, aabb: &AabbCandidate) -> Option<f32> {
        let place = (aabb.instance_id, aabb.geometry_index, aabb.primitive_id);
        let answer = self.answer(aabb.t_max, place);
        (!answer.is_multiple_of(4)).then_some((answer % 64) as f32 / 8.0)
    }
}

impl Shaders for Hashed {
    fn any_hit(&mut self, candidate: &Candidate) -> AnyHit {
        // Hits that a query generates are hits.
        if candidate.kind.value() == 0 { AnyHit::Accept } else { self.triangle(candidate) }
    }

    fn intersection(&mut self, aabb: &AabbCandidate) -> Option<ReportedHit> {
        self.aabb(aabb).map(|t| ReportedHit { t, kind: 0 })
    }
}

/// The same answers given to a query.
fn ask(scene: &Scene, ray: &Ray, options: &TraceOptions, shaders: &mut Hashed) -> (Option<Hit>, Counters) {
    let mut query = RayQuery::new();
    query.initialize(scene, ray, options);
    while query.proceed().unwrap() {
        match query.candidate().unwrap() {
            QueryCandidate::Triangle(triangle) => match shaders.triangle(&triangle) {
                AnyHit::Ignore => {}
                AnyHit::Accept => query.confirm().unwrap(),
                AnyHit::AcceptAndEndSearch => {
                    query.confirm().unwrap();
                    query.terminate().unwrap();
                }
            },
            QueryCandidate::Aabb(aabb) => {
                if let Some(t) = shaders.aabb(&aabb) {
                    match query.generate(t) {
                        Ok(()) => assert!((aabb.t_min..=aabb.t_max).contains(&t)),
                        Err(QueryError::HitT { found, t_min, t_max }) => assert!(!(t_min..=t_max).contains(&found)),
                        Err(error) => panic!("{error}"),
                    }
                }
            }
        }
    }
    let committed = query.committed().unwrap();
    (committed.map(|committed| *committed.hit()), query.counters())
}

fn triangle() -> impl Strategy<Value = Vertices> {
    let coordinate = || (-3_i8..=3).prop_map(f32::from);
    let point = move || [coordinate(), coordinate(), coordinate()];
    [point(), point(), point()]
}

/// A structure of triangles with special indices, triangles without, and boxes.
fn geometries() -> impl Strategy<Value = Vec<omm_layout::object::BlasGeometry>> {
    let map = prop::sample::select(OpacityState::ALL.to_vec())
        .prop_map(|state| TriangleMap::SpecialIndex(OpacityMicromapSpecialIndex::of_state(state)));
    let opaque = prop::bool::weighted(0.3)
        .prop_map(|opaque| if opaque { GeometryFlags::OPAQUE } else { GeometryFlags::empty() });
    let corner = || [-3.0_f32..1.0, -3.0_f32..1.0, -3.0_f32..1.0];
    let aabb = (corner(), corner()).prop_map(|(low, size)| [low, std::array::from_fn(|i| low[i] + size[i] + 3.0)]);
    (
        prop::collection::vec((triangle(), map), 0..12),
        prop::collection::vec(triangle(), 0..12),
        prop::collection::vec(aabb, 0..4),
        [opaque.clone(), opaque.clone(), opaque],
    )
        .prop_map(|(with_map, plain, boxes, [a, b, c])| {
            vec![mapped(a, 0, &with_map), triangles(b, plain), aabbs(c, &boxes)]
        })
}

/// Flags of an instance or a ray, rarely more than two of them.
fn flags(bits: u32) -> impl Strategy<Value = u32> {
    prop::collection::vec(0..bits, 0..3).prop_map(|bits| bits.into_iter().fold(0, |flags, bit| flags | 1 << bit))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn a_query_finds_what_a_pipeline_finds(
        geometries in geometries(),
        instances in prop::collection::vec((flags(6), -2_i8..=2, any::<bool>()), 1..5),
        origins in prop::collection::vec([-4_i8..=4, -4_i8..=4, -4_i8..=4], 4),
        targets in prop::collection::vec([-2.0_f32..2.0, -2.0_f32..2.0, -2.0_f32..2.0], 4),
        ray_flags in flags(11),
        t_max in prop_oneof![Just(f32::INFINITY), 0.5_f32..3.0],
        micromaps in any::<bool>(),
        seed: u32,
    ) {
        let mut memory = Memory::default();
        let blas = memory.blas(geometries);
        let instances = instances.into_iter().map(|(flags, shift, mirrored)| {
            let sign = if mirrored { -1.0 } else { 1.0 };
            let matrix = [[sign, 0.0, 0.0, shift.into()], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
            let flags = GeometryInstanceFlags::from_bits_retain(flags);
            Instance { transform: TransformMatrix { matrix }, ..with_flags(blas, flags) }
        });
        let scene = memory.scene(instances.collect());
        let flags = RayFlags::from_bits_retain(ray_flags);
        let options = TraceOptions { flags, micromaps, ..TraceOptions::default() };
        for (origin, target) in origins.into_iter().zip(targets) {
            let origin = origin.map(f32::from);
            let direction = std::array::from_fn(|i| target[i] - origin[i]);
            let Ok(ray) = Ray::new(origin, direction, 0.0, t_max) else { continue };
            let (mut pipeline, mut query) = (Hashed { seed, ..Hashed::default() }, Hashed { seed, ..Hashed::default() });
            let mut counters = Counters::default();
            let hit = scene.trace(&ray, &options, &mut pipeline, &mut counters);
            prop_assert_eq!((hit, counters), ask(&scene, &ray, &options, &mut query));
            prop_assert_eq!(pipeline.seen, query.seen);
        }
    }
}

/// A triangle that needs an answer at t = 1, a box from t = 2 to 3, an opaque triangle at t = 4.
fn scene() -> Scene {
    let mut memory = Memory::default();
    let blas = memory.blas(vec![
        triangles(GeometryFlags::empty(), [unit_triangle(0.0)]),
        aabbs(GeometryFlags::OPAQUE, &[[[0.0, 0.0, -2.0], [1.0, 1.0, -1.0]]]),
        triangles(GeometryFlags::OPAQUE, [unit_triangle(-3.0)]),
    ]);
    memory.scene(vec![with_transform(blas, [[1.0, 0.0, 0.0, 5.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])])
}

fn forbidden<T: std::fmt::Debug>(found: Result<T, QueryError>) -> String {
    found.unwrap_err().to_string()
}

#[test]
fn each_state_forbids_its_calls() {
    let scene = scene();
    let mut query = RayQuery::new();
    assert_eq!(query.state(), QueryState::Uninitialized);
    assert_eq!(
        forbidden(query.proceed()),
        "OpRayQueryProceedKHR: found an uninitialized query, required an initialized one"
    );
    assert!(query.ray().is_err() && query.options().is_err() && query.committed().is_err());
    assert!(query.terminate().is_err() && query.confirm().is_err() && query.candidate().is_err());

    let ray = Ray::new([5.25, 0.25, 1.0], [0.0, 0.0, -1.0], 0.5, 100.0).unwrap();
    query.initialize(&scene, &ray, &RayFlags::SKIP_CLOSEST_HIT_SHADER.into());
    assert_eq!(query.state(), QueryState::Initialized);
    assert_eq!((query.ray(), query.options().unwrap().flags), (Ok(&ray), RayFlags::SKIP_CLOSEST_HIT_SHADER));
    assert_eq!(
        forbidden(query.confirm()),
        "OpRayQueryConfirmIntersectionKHR: found a query before its first proceed, required one at a triangle"
    );
    assert_eq!(
        forbidden(query.terminate()),
        "OpRayQueryTerminateKHR: found a query before its first proceed, required one at a candidate"
    );
    assert!(query.generate(1.0).is_err() && query.candidate().is_err() && query.committed().is_err());

    let mut states = Vec::new();
    while query.proceed().unwrap() {
        states.push(query.state());
        match query.state() {
            QueryState::TriangleCandidate => {
                assert!(
                    forbidden(query.generate(1.0)).ends_with("found a query at a triangle, required one at an AABB")
                );
                let QueryCandidate::Triangle(triangle) = query.candidate().unwrap() else { panic!() };
                assert_eq!((triangle.t, triangle.geometry_index), (1.0, 0));
            }
            QueryState::AabbCandidate => {
                assert!(forbidden(query.confirm()).ends_with("found a query at an AABB, required one at a triangle"));
                let QueryCandidate::Aabb(aabb) = query.candidate().unwrap() else { panic!() };
                assert!(aabb.opaque && aabb.geometry_index == 1);
                assert_eq!(
                    forbidden(query.generate(0.25)),
                    format!("OpRayQueryGenerateIntersectionKHR: found a t of 0.25, required 0.5 to {}", aabb.t_max)
                );
                assert!(query.generate(f32::NAN).is_err());
                query.generate(2.75).unwrap();
                query.generate(2.5).unwrap();
                assert!(query.generate(2.75).is_err());
            }
            other => panic!("{other:?}"),
        }
        let space = query.object_space(Intersection::Candidate).unwrap().unwrap();
        assert_eq!((space.origin, space.object_to_world[0][3]), ([0.25, 0.25, 1.0], 5.0));
    }
    states.sort_by_key(|state| *state == QueryState::AabbCandidate);
    assert_eq!(states, [QueryState::TriangleCandidate, QueryState::AabbCandidate]);
    assert_eq!((query.state(), query.proceed()), (QueryState::Complete, Ok(false)));
    let Some(CommittedIntersection::Generated(hit)) = query.committed().unwrap() else { panic!() };
    assert_eq!((hit.t, hit.kind.value(), hit.opaque), (2.5, 0, true));
    assert_eq!(query.object_space(Intersection::Committed).unwrap().unwrap().direction, [0.0, 0.0, -1.0]);
    assert!(query.confirm().is_err() && query.terminate().is_err());
    assert!(query.object_space(Intersection::Candidate).is_err());

    // The same query serves for another ray.
    query.initialize(&scene, &Ray::unbounded([0.0; 3], [0.0, 1.0, 0.0]).unwrap(), &TraceOptions::default());
    assert_eq!((query.proceed(), query.committed()), (Ok(false), Ok(None)));
    assert_eq!(query.object_space(Intersection::Committed), Ok(None));
}

#[test]
fn a_confirmed_triangle_hides_what_is_behind_and_ends_a_shadow_ray() {
    let scene = scene();
    let ray = Ray::unbounded([5.25, 0.25, 1.0], [0.0, 0.0, -1.0]).unwrap();
    let mut query = RayQuery::new();
    query.initialize(
        &scene,
        &ray,
        &(RayFlags::TERMINATE_ON_FIRST_HIT | RayFlags::SKIP_AABBS | RayFlags::NO_OPAQUE).into(),
    );
    assert_eq!(query.proceed(), Ok(true));
    query.confirm().unwrap();
    query.confirm().unwrap();
    assert_eq!(query.proceed(), Ok(false));
    let Some(CommittedIntersection::Triangle(hit)) = query.committed().unwrap() else { panic!() };
    assert!(!hit.opaque);
    assert_eq!((query.counters().any_hit_calls, query.counters().hits), (1, 1));
}

#[test]
fn micromaps_count_if_the_mode_or_the_extension_says_so() {
    // EXT extension enabled, execution mode, micromaps count.
    let table = [
        (false, None, false),
        (false, Some(true), true),
        (false, Some(false), false),
        (true, None, true),
        (true, Some(true), true),
        (true, Some(false), false),
    ];
    let map = TriangleMap::SpecialIndex(OpacityMicromapSpecialIndex::FullyTransparent);
    let scene = scene_of(mapped(GeometryFlags::OPAQUE, 0, &[(unit_triangle(0.0), map)]));
    for (ext, mode, micromaps) in table {
        assert_eq!(micromaps_in_ray_queries(ext, mode), micromaps);
        let mut query = RayQuery::new();
        query.initialize(&scene, &down(0.25, 0.25), &TraceOptions { micromaps, ..TraceOptions::default() });
        assert_eq!(query.proceed(), Ok(false));
        assert_eq!(query.committed().unwrap().is_none(), micromaps);
    }
}
