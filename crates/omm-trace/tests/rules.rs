//! The rules of the chapter one by one: ranges, ties, culling, masks, instances, shaders, AABBs.
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use omm_model::opacity::OpacityState;
use omm_model::special_index::{OpacityMicromapSpecialIndex, TriangleMap};
use omm_model::vk::{GeometryFlags, GeometryInstanceFlags, Instance};
use omm_trace::{
    AabbCandidate, AnyHit, Candidate, Counters, HitKind, NoShaders, Ray, RayFlags, ReportedHit, Shaders, TraceOptions,
};
use support::*;

fn range(t_min: f32, t_max: f32) -> Ray {
    Ray::new([0.25, 0.25, 1.0], [0.0, 0.0, -1.0], t_min, t_max).unwrap()
}

#[test]
fn a_triangle_s_range_is_open() {
    let scene = scene_of(plain(0.0));
    for (t_min, t_max, hit) in [
        (0.0, f32::INFINITY, true),
        (1.0, 2.0, false),
        (1.0_f32.next_down(), 2.0, true),
        (0.0, 1.0, false),
        (0.0, 1.0_f32.next_up(), true),
        (1.0, 1.0, false),
        (1.5, 2.0, false),
        (0.0, 0.5, false),
    ] {
        assert_eq!(closest(&scene, &range(t_min, t_max)).is_some(), hit, "{t_min}..{t_max}");
    }
}

#[test]
fn hits_tell_where_they_are() {
    let mut memory = Memory::default();
    let geometries = vec![plain(-1.0), triangles(GeometryFlags::OPAQUE, [unit_triangle(-2.0), unit_triangle(0.5)])];
    let blas = memory.blas(geometries);
    let named = Instance {
        instance_custom_index: 0x00ab_cdef,
        instance_shader_binding_table_record_offset: 0x0012_3456,
        ..with_transform(blas, [[2.0, 0.0, 0.0, 0.0], [0.0, 2.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])
    };
    let scene = memory.scene(vec![instance(0), named]);
    assert_eq!((scene.instance_count(), scene.triangle_count()), (1, 3));
    let (hit, counters, _) = trace(&scene, &down(0.5, 0.25), RayFlags::empty());
    let candidate = Candidate {
        t: 0.5,
        barycentrics: [0.25, 0.125],
        kind: HitKind::FrontFacingTriangle,
        instance_id: 1,
        instance_custom_index: 0x00ab_cdef,
        geometry_index: 1,
        primitive_id: 1,
        sbt_record_offset: 0x0012_3456,
        micromap: None,
    };
    let hit = hit.unwrap();
    assert_eq!((hit.candidate, hit.opaque), (candidate, true));
    assert!(counters.opaque >= 1);
    let [low, high] = scene.bounds().unwrap();
    assert!((low[2] + 2.0).abs() < 1e-5 && (high[0] - 2.0).abs() < 1e-5, "{low:?} {high:?}");
}

#[test]
fn among_equals_the_lowest_wins() {
    let twice = || triangles(GeometryFlags::empty(), [unit_triangle(0.0), unit_triangle(0.0)]);
    for first_inactive in [false, true] {
        let mut memory = Memory::default();
        let blas = memory.blas(vec![twice(), twice()]);
        let instances = (0..40).map(|i| instance(if first_inactive && i < 7 { 0 } else { blas }));
        let scene = memory.scene(instances.collect());
        let hit = closest(&scene, &down(0.25, 0.25)).unwrap();
        let lowest = if first_inactive { 7 } else { 0 };
        assert_eq!((hit.instance_id, hit.geometry_index, hit.primitive_id), (lowest, 0, 0));
    }
}

#[test]
fn face_culling_table() {
    use GeometryInstanceFlags as I;
    use HitKind::{BackFacingTriangle as Back, FrontFacingTriangle as Front};
    let (none, flip, disable) = (I::empty(), I::TRIANGLE_FLIP_FACING, I::TRIANGLE_FACING_CULL_DISABLE);
    let (cull_back, cull_front) = (RayFlags::CULL_BACK_FACING_TRIANGLES, RayFlags::CULL_FRONT_FACING_TRIANGLES);
    let up = Ray::unbounded([0.25, 0.25, -1.0], [0.0, 0.0, 1.0]).unwrap();
    // Instance flags, ray flags, hit from above, hit from below.
    let table = [
        (none, RayFlags::empty(), Some(Front), Some(Back)),
        (none, cull_back, Some(Front), None),
        (none, cull_front, None, Some(Back)),
        (flip, RayFlags::empty(), Some(Back), Some(Front)),
        (flip, cull_back, None, Some(Front)),
        (flip, cull_front, Some(Back), None),
        (disable, cull_back, Some(Front), Some(Back)),
        (disable, cull_front, Some(Front), Some(Back)),
        (flip | disable, cull_back, Some(Back), Some(Front)),
    ];
    let identity = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    // Mirrored in x about 0.25, which does not change the winding: it is judged in object space.
    let mirrored = [[-1.0, 0.0, 0.0, 0.5], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    for (instance_flags, ray_flags, above, below) in table {
        for matrix in [identity, mirrored] {
            let mut memory = Memory::default();
            let blas = memory.blas(vec![plain(0.0)]);
            let scene = memory.scene(vec![Instance { flags: instance_flags, ..with_transform(blas, matrix) }]);
            for (ray, expected) in [(down(0.25, 0.25), above), (up, below)] {
                let (hit, counters, _) = trace(&scene, &ray, ray_flags);
                assert_eq!(hit.map(|hit| hit.kind), expected, "{instance_flags:?} {ray_flags:?}");
                assert_eq!(counters.culled_by_facing, u64::from(expected.is_none()));
            }
        }
    }
    assert_eq!((Front.value(), Back.value(), HitKind::Reported(5).value()), (0xfe, 0xff, 5));
}

#[test]
fn a_mirrored_half_turn_shows_the_other_side() {
    // Turned about the x axis, the triangle's back is up.
    let mut memory = Memory::default();
    let blas = memory.blas(vec![plain(0.0)]);
    let scene =
        memory.scene(vec![with_transform(blas, [[1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 1.0], [0.0, 0.0, -1.0, 0.0]])]);
    let hit = closest(&scene, &down(0.25, 0.75)).unwrap();
    assert_eq!((hit.kind, hit.barycentrics), (HitKind::BackFacingTriangle, [0.25, 0.25]));
}

#[test]
fn masks_have_eight_bits() {
    for (mask, cull_mask, hit) in [
        (0xff, 0xff, true),
        (0x01, 0xfe, false),
        (0x80, 0x180, true),
        (0x80, 0x100, false),
        (0, !0, false),
        (0xff, 0, false),
    ] {
        let mut memory = Memory::default();
        let blas = memory.blas(vec![plain(0.0)]);
        let scene = memory.scene(vec![Instance { mask, ..instance(blas) }]);
        let options = TraceOptions { cull_mask, ..TraceOptions::default() };
        let mut counters = Counters::default();
        let found = scene.trace(&down(0.25, 0.25), &options, &mut NoShaders, &mut counters);
        assert_eq!((found.is_some(), counters.candidates), (hit, hit.into()), "{mask:#x} {cull_mask:#x}");
    }
}

#[test]
fn what_is_inactive_or_squashed_is_never_hit() {
    let mut memory = Memory::default();
    let mut geometry = plain(0.0);
    let omm_layout::object::BlasPrimitives::Triangles(list) = &mut geometry.primitives else { panic!("triangles") };
    list.push(None);
    let nan_aside = unit_triangle(0.5).map(|[x, y, _]| [x, f32::NAN, y]);
    list.extend([Some(nan_aside), Some([[0.25, 0.25, 0.9]; 3]), Some(unit_triangle(-1.0))]);
    let blas = memory.blas(vec![geometry]);
    let empty = memory.blas(vec![]);
    let zero = [[0.0; 4]; 3];
    let flat = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.5]];
    let not_finite = [[1.0, 0.0, 0.0, f32::NAN], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    let squashed = [zero, flat, not_finite].map(|matrix| with_transform(blas, matrix));
    let scene = memory.scene([&[instance(0), instance(empty)], &squashed[..], &[instance(blas)]].concat());
    let mut seen = Vec::new();
    let mut shader = |candidate: &Candidate| {
        seen.push((candidate.instance_id, candidate.primitive_id));
        AnyHit::Ignore
    };
    scene.trace(&down(0.25, 0.25), &TraceOptions::default(), &mut shader, &mut Counters::default());
    seen.sort_unstable();
    assert_eq!(seen, [(5, 0), (5, 4)]);
}

#[test]
fn an_ill_conditioned_instance_is_visited_without_a_box() {
    // The columns are all but one: what is squeezed is still hit, but no box is promised around it.
    let close = 1.0 + 2.0_f32.powi(-22);
    let mut memory = Memory::default();
    let blas = memory.blas(vec![plain(0.0)]);
    let squeezed = with_transform(blas, [[1.0, 1.0, 0.0, 0.0], [1.0, close, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);
    let scene = memory.scene(vec![
        squeezed,
        with_transform(blas, [[1.0, 0.0, 0.0, 9.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]),
    ]);
    assert_eq!((scene.instance_count(), scene.bounds()), (2, None));
    // (0.25, 0.5) goes to 0.75 and just more.
    let found = closest(&scene, &down(0.75, 0.75 + 2.0_f32.powi(-23))).unwrap();
    assert_eq!((found.instance_id, found.barycentrics), (0, [0.25, 0.5]));
    assert_eq!(closest(&scene, &down(9.25, 0.25)).unwrap().instance_id, 1);
}

#[test]
fn an_empty_scene_is_missed() {
    let scene = Memory::default().scene(vec![]);
    assert_eq!(closest(&scene, &down(0.0, 0.0)), None);
    assert_eq!(scene.bounds(), None);
}

#[test]
fn shaders_decide_about_what_is_not_opaque() {
    use OpacityState::{Opaque, Transparent, UnknownOpaque, UnknownTransparent};
    let scene = stack(&[Transparent, UnknownTransparent, UnknownOpaque, Opaque, UnknownOpaque]);
    let run = |answers: &dyn Fn(u32) -> AnyHit, flags| {
        let (mut counters, mut states) = (Counters::default(), Vec::new());
        let mut shader = |candidate: &Candidate| {
            states.push(candidate.micromap.unwrap());
            answers(candidate.primitive_id)
        };
        let hit = scene.trace(&down(0.25, 0.25), &TraceOptions::from(flags), &mut shader, &mut counters);
        (hit.map(|hit| (hit.primitive_id, hit.opaque)), counters, states)
    };
    let (hit, _, _) = run(&|_| AnyHit::Accept, RayFlags::empty());
    assert_eq!(hit, Some((1, false)));
    let (hit, counters, states) = run(&|_| AnyHit::Ignore, RayFlags::empty());
    assert_eq!(hit, Some((3, true)));
    assert!(states.contains(&UnknownTransparent) && states.contains(&UnknownOpaque));
    assert_eq!((counters.any_hit_calls, counters.any_hit_ignored), (states.len() as u64, states.len() as u64));
    assert_eq!(counters.ignored, 1);
    let (hit, counters, _) = run(&|_| panic!("no shader"), RayFlags::FORCE_OPACITY_MICROMAP_2_STATE);
    assert_eq!((hit, counters.any_hit_calls), (Some((2, true)), 0));
    // Ending the search leaves whatever was accepted, nearest or not.
    let (hit, counters, states) = run(&|_| AnyHit::AcceptAndEndSearch, RayFlags::NO_OPAQUE);
    assert_eq!((states.len(), counters.any_hit_calls, counters.any_hit_ignored), (1, 1, 0));
    assert!(hit.is_some());
    let (hit, counters, _) = run(&|_| AnyHit::Accept, RayFlags::TERMINATE_ON_FIRST_HIT | RayFlags::OPAQUE);
    assert!(hit.is_some_and(|(_, opaque)| opaque));
    assert_eq!((counters.opaque, counters.any_hit_calls), (1, 0));
}

#[test]
fn flags_that_skip() {
    let scene = stack(&[OpacityState::Opaque]);
    let (hit, counters, _) = trace(&scene, &down(0.25, 0.25), RayFlags::SKIP_TRIANGLES);
    assert_eq!((hit, counters.candidates), (None, 0));
    let plain = trace(&scene, &down(0.25, 0.25), RayFlags::empty()).0;
    assert!(plain.is_some());
    for same in [RayFlags::SKIP_AABBS, RayFlags::SKIP_CLOSEST_HIT_SHADER, RayFlags::from_bits_retain(1 << 31)] {
        assert_eq!(trace(&scene, &down(0.25, 0.25), same).0, plain);
    }
}

/// Reports the entry of a ball of radius 1 about the origin, and accepts it or not.
struct Ball {
    accept: AnyHit,
    offered: Vec<AabbCandidate>,
    report: Option<f32>,
}

impl Shaders for Ball {
    fn any_hit(&mut self, candidate: &Candidate) -> AnyHit {
        assert_eq!((candidate.kind, candidate.barycentrics), (HitKind::Reported(3), [0.0; 2]));
        self.accept
    }

    fn intersection(&mut self, aabb: &AabbCandidate) -> Option<ReportedHit> {
        self.offered.push(*aabb);
        // Straight down along z, scaled by the direction's length.
        let t = self.report.unwrap_or(((aabb.origin[2] - 1.0) / -aabb.direction[2]) as f32);
        Some(ReportedHit { t, kind: 0x83 })
    }
}

#[test]
fn aabbs_are_offered_and_reports_are_judged() {
    let boxes = aabbs(GeometryFlags::empty(), &[[[-1.0; 3], [1.0; 3]], [[5.0; 3], [6.0; 3]], [[1.0; 3], [-1.0; 3]]]);
    let mut memory = Memory::default();
    let blas = memory.blas(vec![boxes, triangles(GeometryFlags::empty(), [unit_triangle(-3.0)])]);
    let scene = memory.scene(vec![instance(blas)]);
    let run = |ray: &Ray, flags, accept, report| {
        let mut shaders = Ball { accept, offered: Vec::new(), report };
        let mut counters = Counters::default();
        let flags = RayFlags::SKIP_TRIANGLES | flags;
        let hit = scene.trace(ray, &TraceOptions::from(flags), &mut shaders, &mut counters);
        assert_eq!(counters.intersection_calls, shaders.offered.len() as u64);
        (hit.map(|hit| (hit.t, hit.opaque)), shaders.offered, counters)
    };
    let ray = Ray::new([0.5, 0.5, 3.0], [0.0, 0.0, -2.0], 0.0, 8.0).unwrap();
    let (hit, offered, counters) = run(&ray, RayFlags::empty(), AnyHit::Accept, None);
    assert_eq!((hit, counters.candidates, counters.any_hit_calls), (Some((1.0, false)), 1, 1));
    let [aabb] = offered[..] else { panic!("{offered:?}") };
    assert_eq!((aabb.min, aabb.max, aabb.primitive_id, aabb.t_max, aabb.opaque), ([-1.0; 3], [1.0; 3], 0, 8.0, false));
    assert_eq!(run(&ray, RayFlags::empty(), AnyHit::Ignore, None).0, None);
    assert_eq!(run(&ray, RayFlags::OPAQUE, AnyHit::Ignore, None).0, Some((1.0, true)));
    // Closed at both ends, unlike a triangle's range; a ray of a single t inside the box is offered it too.
    for (t, hit) in [(0.0, true), (8.0, true), (8.0_f32.next_up(), false), (-1.0, false), (f32::NAN, false)] {
        assert_eq!(run(&ray, RayFlags::empty(), AnyHit::Accept, Some(t)).0.is_some(), hit, "{t}");
    }
    let inside = Ray::new([1.0, -1.0, 0.0], [0.0, 0.0, 1.0], 1.0, 1.0).unwrap();
    assert_eq!(run(&inside, RayFlags::empty(), AnyHit::Accept, Some(1.0)).0, Some((1.0, false)));
    for (flags, offered, culled) in
        [(RayFlags::SKIP_AABBS, 0, 0), (RayFlags::CULL_NO_OPAQUE, 0, 1), (RayFlags::CULL_OPAQUE, 1, 0)]
    {
        let found = run(&ray, flags, AnyHit::Accept, None);
        assert_eq!((found.1.len(), found.2.culled_aabbs), (offered, culled), "{flags:?}");
    }
    // Face culling is for triangles.
    let both = RayFlags::CULL_BACK_FACING_TRIANGLES | RayFlags::CULL_FRONT_FACING_TRIANGLES;
    assert!(run(&ray, both, AnyHit::Accept, None).0.is_some());
    // Without an intersection shader a box is nothing.
    assert_eq!(scene.trace(&ray, &RayFlags::SKIP_TRIANGLES.into(), &mut NoShaders, &mut Counters::default()), None);
}

#[test]
fn disabled_micromaps_leave_the_geometry_s_flag() {
    let map = TriangleMap::SpecialIndex(OpacityMicromapSpecialIndex::FullyTransparent);
    for (geometry, opaque) in [(GeometryFlags::empty(), false), (GeometryFlags::OPAQUE, true)] {
        let mut memory = Memory::default();
        let blas = memory.blas(vec![mapped(geometry, 0, &[(unit_triangle(0.0), map)])]);
        let scene = memory.scene(vec![with_flags(blas, GeometryInstanceFlags::DISABLE_OPACITY_MICROMAPS)]);
        let (hit, _, record) = trace(&scene, &down(0.25, 0.25), RayFlags::empty());
        assert_eq!(hit.map(|hit| (hit.opaque, hit.micromap)), Some((opaque, None)));
        assert_eq!(record.seen.len(), usize::from(!opaque));
    }
}

#[test]
fn scenes_are_shared_between_threads() {
    fn shared<T: Sync + Send>(_: &T) {}
    shared(&scene_of(plain(0.0)));
}
