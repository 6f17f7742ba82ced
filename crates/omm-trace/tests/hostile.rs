//! Whatever numbers rays, instances and primitives hold: an error, a miss or a hit in range, and an end.
#![allow(clippy::unwrap_used)]

mod support;

use omm_layout::object::{BlasGeometry, BlasPrimitives, MovingVertices};
use omm_model::vk::{GeometryFlags, Instance, MotionInstanceData, SrtData, SrtMotionInstance, TransformMatrix};
use omm_trace::{AabbCandidate, Counters, Ray, ReportedHit, Shaders, TraceOptions};
use proptest::prelude::*;
use support::*;

/// Any 32 bits, with those preferred that are hard to live with.
fn any_number() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => any::<u32>().prop_map(f32::from_bits),
        4 => -4.0_f32..4.0,
        1 => prop::sample::select(vec![0.0, -0.0, f32::MAX, f32::MIN, f32::INFINITY, f32::NEG_INFINITY, f32::NAN]),
        1 => (1_u32..9).prop_map(f32::from_bits),
    ]
}

fn any_point() -> impl Strategy<Value = [f32; 3]> {
    [any_number(), any_number(), any_number()]
}

fn any_vertices() -> impl Strategy<Value = Vertices> {
    [any_point(), any_point(), any_point()]
}

/// Reports anything for a box.
struct Reporter(f32);

impl Shaders for Reporter {
    fn intersection(&mut self, _: &AabbCandidate) -> Option<ReportedHit> {
        Some(ReportedHit { t: self.0, kind: 0xff })
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn anything_can_be_traced(
        plain in prop::collection::vec(any_vertices(), 0..6),
        moving in prop::collection::vec([any_vertices(), any_vertices()], 0..4),
        boxes in prop::collection::vec([any_point(), any_point()], 0..4),
        matrices in prop::collection::vec(prop::array::uniform12(any_number()), 0..4),
        srts in prop::collection::vec(prop::array::uniform32(any_number()), 0..3),
        rays in prop::collection::vec((any_point(), any_point(), any_number(), any_number(), any_number()), 8),
        flags: u32,
    ) {
        let mut memory = Memory::default();
        let moving: Vec<Option<MovingVertices>> = moving.into_iter().map(Some).collect();
        let moving = BlasGeometry { flags: GeometryFlags::empty(), primitives: BlasPrimitives::MovingTriangles(moving) };
        let still = memory.blas(vec![triangles(GeometryFlags::OPAQUE, plain), aabbs(GeometryFlags::empty(), &boxes)]);
        let other = memory.blas(vec![moving]);
        let mut instances = vec![MotionInstanceData::StaticInstance(instance(still)), MotionInstanceData::StaticInstance(instance(other))];
        for numbers in matrices {
            let matrix = std::array::from_fn(|row| std::array::from_fn(|at| numbers[4 * row + at]));
            let found = Instance { transform: TransformMatrix { matrix }, ..instance(still) };
            instances.push(MotionInstanceData::StaticInstance(found));
        }
        for numbers in srts {
            let ends = [0, 16].map(|at| {
                let [sx, a, b, pvx, sy, c, pvy, sz] = std::array::from_fn(|i| numbers[at + i]);
                let [pvz, qx, qy, qz, qw, tx, ty, tz] = std::array::from_fn(|i| numbers[at + 8 + i]);
                SrtData { sx, a, b, pvx, sy, c, pvy, sz, pvz, qx, qy, qz, qw, tx, ty, tz }
            });
            instances.push(MotionInstanceData::SrtMotionInstance(SrtMotionInstance {
                transform_t0: ends[0],
                transform_t1: ends[1],
                mask: 0xff,
                acceleration_structure_reference: other,
                ..Default::default()
            }));
        }
        let scene = memory.motion_scene(instances);
        for (origin, direction, t_min, t_max, time) in rays {
            // NaN, infinities, zero directions, ranges and times are refused here and nowhere else.
            let Ok(ray) = Ray::new(origin, direction, t_min, t_max).and_then(|ray| ray.at_time(time)) else { continue };
            let options = TraceOptions::from(omm_trace::RayFlags::from_bits_retain(flags));
            let hit = scene.trace(&ray, &options, &mut Reporter(t_min), &mut Counters::default());
            if let Some(hit) = hit {
                prop_assert!(hit.t >= t_min && hit.t <= t_max, "{:?}", hit);
                prop_assert!(hit.barycentrics.iter().all(|weight| (0.0..=1.0).contains(weight)), "{:?}", hit);
            }
        }
    }
}
