//! Following a ray through a scene.

use std::ops::ControlFlow;

use omm_model::opacity::{CandidateOpacity, InstanceOpacity, OpacityResult, RayOpacity};

use crate::bvh::{BoxRay, Stack};
use crate::counters::Counters;
use crate::flags::{self, Facing, RayFlags};
use crate::hit::{Candidate, Hit, HitKind};
use crate::ray::{Ray, TraceOptions};
use crate::scene::{Aabb, Blas, Instance, Scene, Triangle};
use crate::shader::{AabbCandidate, AnyHit, Shaders};
use crate::triangle::TriangleRay;

/// The search along one ray.
struct Search<'a, S: ?Sized> {
    scene: &'a Scene,
    ray: &'a Ray,
    flags: RayFlags,
    opacity: RayOpacity,
    cull_mask: u8,
    shaders: &'a mut S,
    counters: &'a mut Counters,
    closest: Option<Hit>,
}

/// What the search knows while it is inside an instance.
struct Visit<'a> {
    instance: &'a Instance,
    blas: &'a Blas,
    origin: [f64; 3],
    direction: [f64; 3],
    opacity: InstanceOpacity,
    facing: Facing,
}

impl Scene {
    /// Traces a ray and answers the closest hit, or with [`RayFlags::TERMINATE_ON_FIRST_HIT`] or
    /// [`AnyHit::AcceptAndEndSearch`] the hit at which the search ended; `None` is a miss.
    ///
    /// Which candidates shaders see, and in which order, depends on the hierarchy. The closest hit does not, as
    /// long as shaders answer the same for the same candidate: among hits at the same `t` it is the one of the
    /// lowest instance, geometry and primitive. Nothing is allocated.
    pub fn trace<S: Shaders + ?Sized>(
        &self,
        ray: &Ray,
        options: &TraceOptions,
        shaders: &mut S,
        counters: &mut Counters,
    ) -> Option<Hit> {
        counters.rays += 1;
        let mut search = Search {
            scene: self,
            ray,
            flags: options.flags,
            opacity: options.flags.opacity(),
            cull_mask: options.cull_mask.to_le_bytes()[0],
            shaders,
            counters,
            closest: None,
        };
        // Breaking off is one way to be done.
        let _ = search.run();
        let hit = search.closest;
        counters.hits += u64::from(hit.is_some());
        hit
    }
}

impl<S: Shaders + ?Sized> Search<'_, S> {
    fn run(&mut self) -> ControlFlow<()> {
        let scene = self.scene;
        let (mut outer, mut inner) = (Stack::new(), Stack::new());
        let (boxed, unboxed) = scene.instances.split_at_checked(scene.boxed).unwrap_or_default();
        let (origin, direction) = (self.ray.origin().map(f64::from), self.ray.direction().map(f64::from));
        let box_ray = BoxRay::new(&scene.bvh, origin, direction, self.ray.t_min());
        scene.bvh.walk(&box_ray, &mut outer, self.limit(), |slots, _| {
            for instance in boxed.get(slots).unwrap_or_default() {
                self.instance(instance, &mut inner)?;
            }
            ControlFlow::Continue(self.limit())
        })?;
        unboxed.iter().try_for_each(|instance| self.instance(instance, &mut inner))
    }

    /// The largest `t` that is still of interest.
    fn limit(&self) -> f32 {
        self.closest.as_ref().map_or(self.ray.t_max(), |hit| hit.t)
    }

    fn instance(&mut self, instance: &Instance, stack: &mut Stack) -> ControlFlow<()> {
        if instance.mask & self.cull_mask == 0 {
            return ControlFlow::Continue(());
        }
        let Some(blas) = self.scene.blases.get(instance.blas as usize) else { return ControlFlow::Continue(()) };
        let origin = instance.to_object.point(self.ray.origin());
        let direction = instance.to_object.direction(self.ray.direction());
        let visit = Visit {
            instance,
            blas,
            origin,
            direction,
            opacity: flags::instance_opacity(instance.flags),
            facing: Facing::new(self.flags, instance.flags),
        };
        if !blas.triangles.is_empty() && !self.flags.contains(RayFlags::SKIP_TRIANGLES) {
            let triangle_ray = TriangleRay::new(origin, direction);
            let box_ray = BoxRay::new(&blas.triangle_bvh, origin, direction, self.ray.t_min());
            blas.triangle_bvh.walk(&box_ray, stack, self.limit(), |slots, _| {
                for triangle in blas.triangles.get(slots).unwrap_or_default() {
                    self.triangle(&visit, &triangle_ray, triangle)?;
                }
                ControlFlow::Continue(self.limit())
            })?;
        }
        if !blas.aabbs.is_empty() && !self.flags.contains(RayFlags::SKIP_AABBS) {
            let box_ray = BoxRay::new(&blas.aabb_bvh, origin, direction, self.ray.t_min());
            blas.aabb_bvh.walk(&box_ray, stack, self.limit(), |slots, _| {
                for aabb in blas.aabbs.get(slots).unwrap_or_default() {
                    if box_ray.meets(&aabb.planes, self.limit()) {
                        self.aabb(&visit, aabb)?;
                    }
                }
                ControlFlow::Continue(self.limit())
            })?;
        }
        ControlFlow::Continue(())
    }

    #[inline]
    fn triangle(&mut self, visit: &Visit<'_>, ray: &TriangleRay, triangle: &Triangle) -> ControlFlow<()> {
        let Some(found) = ray.intersect(&triangle.vertices) else { return ControlFlow::Continue(()) };
        // The range of a triangle is open at both ends.
        if !(found.t > self.ray.t_min() && found.t <= self.limit() && found.t < self.ray.t_max()) {
            return ControlFlow::Continue(());
        }
        let front = visit.facing.is_front(found.front);
        let mut candidate = Candidate {
            t: found.t,
            barycentrics: found.barycentrics,
            kind: if front { HitKind::FrontFacingTriangle } else { HitKind::BackFacingTriangle },
            instance_id: visit.instance.instance_id,
            instance_custom_index: visit.instance.custom_index,
            geometry_index: triangle.geometry,
            primitive_id: triangle.primitive,
            sbt_record_offset: visit.instance.sbt_record_offset,
            micromap: None,
        };
        if !self.is_closer(&candidate) {
            return ControlFlow::Continue(());
        }
        self.counters.candidates += 1;
        if visit.facing.culls(front) {
            self.counters.culled_by_facing += 1;
            return ControlFlow::Continue(());
        }
        let Some(geometry) = visit.blas.geometries.get(triangle.geometry as usize) else {
            return ControlFlow::Continue(());
        };
        if !visit.opacity.disable_micromaps {
            let micromap = geometry.micromap.and_then(|micromap| self.scene.micromaps.get(micromap as usize));
            candidate.micromap = triangle.opacity.state(micromap, found.barycentrics);
        }
        let result = self.resolve(visit, candidate.micromap, geometry.opaque);
        self.confirm(candidate, result)
    }

    fn aabb(&mut self, visit: &Visit<'_>, aabb: &Aabb) -> ControlFlow<()> {
        let Some(geometry) = visit.blas.geometries.get(aabb.geometry as usize) else {
            return ControlFlow::Continue(());
        };
        let result = self.resolve(visit, None, geometry.opaque);
        if !matches!(result, OpacityResult::Opaque | OpacityResult::NonOpaque) {
            self.counters.culled_aabbs += 1;
            return ControlFlow::Continue(());
        }
        let offered = AabbCandidate {
            min: aabb.min,
            max: aabb.max,
            origin: visit.origin,
            direction: visit.direction,
            t_min: self.ray.t_min(),
            t_max: self.limit(),
            instance_id: visit.instance.instance_id,
            instance_custom_index: visit.instance.custom_index,
            geometry_index: aabb.geometry,
            primitive_id: aabb.primitive,
            sbt_record_offset: visit.instance.sbt_record_offset,
            opaque: result == OpacityResult::Opaque,
        };
        self.counters.intersection_calls += 1;
        let Some(reported) = self.shaders.intersection(&offered) else { return ControlFlow::Continue(()) };
        let candidate = Candidate {
            t: reported.t,
            barycentrics: [0.0; 2],
            kind: HitKind::Reported(reported.kind & 0x7f),
            instance_id: offered.instance_id,
            instance_custom_index: offered.instance_custom_index,
            geometry_index: offered.geometry_index,
            primitive_id: offered.primitive_id,
            sbt_record_offset: offered.sbt_record_offset,
            micromap: None,
        };
        // The range of anything but a triangle is closed at both ends. NaN is in no range.
        if !(reported.t >= offered.t_min && reported.t <= offered.t_max && self.is_closer(&candidate)) {
            return ControlFlow::Continue(());
        }
        self.counters.candidates += 1;
        self.confirm(candidate, result)
    }

    fn resolve(
        &self,
        visit: &Visit<'_>,
        micromap: Option<omm_model::opacity::OpacityState>,
        geometry_opaque: bool,
    ) -> OpacityResult {
        CandidateOpacity { micromap, geometry_opaque, instance: visit.opacity, ray: self.opacity }.resolve()
    }

    /// Whether the candidate would take the place of the closest hit.
    fn is_closer(&self, candidate: &Candidate) -> bool {
        self.closest
            .as_ref()
            .is_none_or(|hit| candidate.t < hit.t || (candidate.t == hit.t && candidate.rank() < hit.candidate.rank()))
    }

    /// What becomes of a candidate that would be the closest hit.
    fn confirm(&mut self, candidate: Candidate, result: OpacityResult) -> ControlFlow<()> {
        let answer = match result {
            OpacityResult::Ignored => {
                self.counters.ignored += 1;
                AnyHit::Ignore
            }
            OpacityResult::Culled => {
                self.counters.culled_by_opacity += 1;
                AnyHit::Ignore
            }
            OpacityResult::Opaque => {
                self.counters.opaque += 1;
                AnyHit::Accept
            }
            OpacityResult::NonOpaque => {
                self.counters.any_hit_calls += 1;
                let answer = self.shaders.any_hit(&candidate);
                self.counters.any_hit_ignored += u64::from(answer == AnyHit::Ignore);
                answer
            }
        };
        if answer == AnyHit::Ignore {
            return ControlFlow::Continue(());
        }
        self.closest = Some(Hit { candidate, opaque: result == OpacityResult::Opaque });
        if answer == AnyHit::AcceptAndEndSearch || self.flags.contains(RayFlags::TERMINATE_ON_FIRST_HIT) {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }
}
