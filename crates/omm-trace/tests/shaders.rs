//! What shaders report and read, and which of them runs.
#![allow(clippy::unwrap_used)]

mod support;

use omm_model::opacity::OpacityState;
use omm_model::vk::{GeometryFlags, Instance};
use omm_trace::{
    AabbCandidate, AnyHit, Candidate, Counters, LastShader, NoShaders, Ray, RayFlags, ReportedHit, Shaders,
    TraceOptions,
};
use support::*;

/// Reports every t that it was given, one after the other, and notes what became of them.
struct Volley {
    left: Vec<f32>,
    accepted: Vec<(f32, bool)>,
    any_hit: AnyHit,
}

impl Shaders for Volley {
    fn any_hit(&mut self, _: &Candidate) -> AnyHit {
        self.any_hit
    }

    fn intersection(&mut self, _: &AabbCandidate) -> Option<ReportedHit> {
        self.left.pop().map(|t| ReportedHit { t, kind: 1 })
    }

    fn next_intersection(&mut self, aabb: &AabbCandidate, accepted: bool) -> Option<ReportedHit> {
        self.accepted.push((aabb.t_max, accepted));
        self.left.pop().map(|t| ReportedHit { t, kind: 2 })
    }
}

#[test]
fn an_intersection_shader_can_report_several_hits() {
    let scene = scene_of(aabbs(GeometryFlags::empty(), &[[[0.0; 3], [1.0; 3]]]));
    let run = |any_hit, flags: RayFlags| {
        let mut shaders = Volley { left: vec![f32::NAN, 2.0, 3.0, 1.5, 0.5, 2.5], accepted: Vec::new(), any_hit };
        let mut counters = Counters::default();
        let ray = Ray::new([0.5, 0.5, 2.0], [0.0, 0.0, -1.0], 0.75, 4.0).unwrap();
        let hit = scene.trace(&ray, &flags.into(), &mut shaders, &mut counters);
        (hit.map(|hit| (hit.t, hit.kind.value())), shaders.accepted, counters)
    };
    let (hit, accepted, counters) = run(AnyHit::Accept, RayFlags::empty());
    assert_eq!(hit, Some((1.5, 2)));
    // Each that is nearer is accepted and shortens the ray; 0.5 lies before it.
    assert_eq!(accepted, [(2.5, true), (2.5, false), (1.5, true), (1.5, false), (1.5, false), (1.5, false)]);
    assert_eq!((counters.intersection_calls, counters.candidates, counters.any_hit_calls), (1, 2, 2));
    let (hit, accepted, _) = run(AnyHit::Ignore, RayFlags::empty());
    assert_eq!((hit, accepted.len()), (None, 6));
    for (any_hit, flags) in [
        (AnyHit::AcceptAndEndSearch, RayFlags::empty()),
        (AnyHit::Accept, RayFlags::TERMINATE_ON_FIRST_HIT),
        (AnyHit::Ignore, RayFlags::TERMINATE_ON_FIRST_HIT | RayFlags::OPAQUE),
    ] {
        let (hit, accepted, _) = run(any_hit, flags);
        assert_eq!((hit, accepted.len()), (Some((2.5, 1)), 0), "{flags:?}");
    }
}

#[test]
fn the_last_shader_is_that_of_the_closest_hit_or_a_miss() {
    let mut memory = Memory::default();
    let blas = memory.blas(vec![plain(-1.0), plain(0.0)]);
    let offset = Instance { instance_shader_binding_table_record_offset: 100, ..instance(blas) };
    let scene = memory.scene(vec![offset]);
    let options = TraceOptions { sbt_offset: 1, sbt_stride: 2, miss_index: 3, ..TraceOptions::default() };
    let trace = |ray: &Ray, options: &TraceOptions| {
        let hit = scene.trace(ray, options, &mut NoShaders, &mut Counters::default());
        options.last_shader(hit.as_ref())
    };
    assert_eq!(trace(&down(0.25, 0.25), &options), Some(LastShader::ClosestHit { hit_group: 103 }));
    assert_eq!(trace(&down(2.0, 2.0), &options), Some(LastShader::Miss { index: 3 }));
    let skip = TraceOptions { flags: RayFlags::SKIP_CLOSEST_HIT_SHADER, ..options };
    assert_eq!(
        (trace(&down(0.25, 0.25), &skip), trace(&down(2.0, 2.0), &skip)),
        (None, trace(&down(2.0, 2.0), &options))
    );
}

#[test]
fn object_space_is_what_the_instance_s_matrix_makes_of_the_ray() {
    let mut memory = Memory::default();
    let blas = memory.blas(vec![plain(0.0)]);
    let matrix = [[0.0, -2.0, 0.0, 5.0], [2.0, 0.0, 0.0, 0.0], [0.0, 0.0, 4.0, -1.0]];
    let scene = memory.scene(vec![instance(0), with_transform(blas, matrix), with_transform(blas, [[0.0; 4]; 3])]);
    let ray = Ray::unbounded([4.5, 0.5, 1.0], [0.0, 0.0, -1.0]).unwrap();
    let space = scene.object_space(1, &ray).unwrap();
    assert_eq!(space.object_to_world, matrix);
    assert_eq!(space.world_to_object, [[0.0, 0.5, 0.0, 0.0], [-0.5, 0.0, 0.0, 2.5], [0.0, 0.0, 0.25, 0.25]]);
    assert_eq!((space.origin, space.direction), ([0.25, 0.25, 0.5], [0.0, 0.0, -0.25]));
    assert_eq!(closest(&scene, &ray).map(|hit| (hit.t, hit.barycentrics)), Some((2.0, [0.25, 0.25])));
    assert_eq!(scene.triangle_vertices(1, 0, 0, 0.0), Some(unit_triangle(0.0)));
    // Neither inactive nor squashed, nor beyond the last.
    assert_eq!([0, 2, 3].map(|id| scene.object_space(id, &ray)), [None; 3]);
}

#[test]
fn without_the_pipeline_flag_micromaps_do_not_count() {
    let scene = stack(&[OpacityState::Transparent, OpacityState::Opaque]);
    let options = TraceOptions { micromaps: false, ..TraceOptions::default() };
    let hit = scene.trace(&down(0.25, 0.25), &options, &mut NoShaders, &mut Counters::default()).unwrap();
    assert_eq!((hit.primitive_id, hit.opaque, hit.micromap), (0, false, None));
}
