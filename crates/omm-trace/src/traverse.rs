//! Following a ray through a scene, from one candidate that needs an answer to the next.

use std::ops::{ControlFlow, Range};

use omm_model::opacity::{CandidateOpacity, InstanceOpacity, OpacityResult, OpacityState, RayOpacity};

use crate::bvh::{BoxRay, Walk};
use crate::counters::Counters;
use crate::flags::{self, Facing, RayFlags};
use crate::hit::{Candidate, Hit, HitKind};
use crate::placement::moved;
use crate::ray::{Ray, TraceOptions};
use crate::scene::{Aabb, Blas, Instance, Scene, Triangle};
use crate::shader::AabbCandidate;
use crate::transform::WorldToObject;
use crate::triangle::{TriangleHit, TriangleRay};

/// The search along one ray. It stops at every candidate that somebody else has to decide about, and can be taken
/// up again afterwards: pipelines and ray queries differ in who answers.
#[derive(Clone, Debug)]
pub(crate) struct Search<'s> {
    pub(crate) found: Found<'s>,
    /// The ray among the boxes of instances.
    box_ray: BoxRay,
    outer: Walk,
    /// Slots of instances that are to be entered before the walk goes on.
    instances: Range<usize>,
    /// Whether only the instances without a box are left.
    boxes_done: bool,
    stage: Stage,
    /// The instance that was entered last.
    visit: Option<Visit<'s>>,
    inner: Walk,
    /// Slots of primitives of the instance that are to be tried before its walk goes on.
    primitives: Range<usize>,
}

/// Where a search is.
#[derive(Clone, Copy, Debug)]
enum Stage {
    /// Between two instances.
    Outside,
    /// Among the triangles of an instance.
    Triangles,
    /// Among its boxes.
    Aabbs,
}

/// What the search knows while it is inside an instance.
#[derive(Clone, Debug)]
struct Visit<'s> {
    instance: &'s Instance,
    blas: &'s Blas,
    origin: [f64; 3],
    direction: [f64; 3],
    opacity: InstanceOpacity,
    facing: Facing,
    triangle_ray: TriangleRay,
    /// The ray among the boxes of triangles, or of AABBs.
    box_ray: BoxRay,
}

/// The operands of a search and its result.
#[derive(Clone, Debug)]
pub(crate) struct Found<'s> {
    pub(crate) scene: &'s Scene,
    pub(crate) ray: Ray,
    pub(crate) options: TraceOptions,
    opacity: RayOpacity,
    pub(crate) closest: Option<Hit>,
    /// Whether the search was ended before everything was tried.
    pub(crate) ended: bool,
}

/// What somebody else has to decide about.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Offer {
    /// A non-opaque triangle, which would be the closest hit.
    Triangle(Candidate),
    /// A box.
    Aabb(AabbCandidate),
}

impl<'s> Search<'s> {
    #[inline]
    pub(crate) fn new(scene: &'s Scene, ray: &Ray, options: &TraceOptions) -> Self {
        let found = Found {
            scene,
            ray: *ray,
            options: *options,
            opacity: options.flags.opacity(),
            closest: None,
            ended: false,
        };
        let (origin, direction) = (ray.origin().map(f64::from), ray.direction().map(f64::from));
        let mut outer = Walk::new();
        outer.begin(&scene.bvh);
        Self {
            found,
            box_ray: BoxRay::new(&scene.bvh, origin, direction, ray.t_min()),
            outer,
            instances: 0..0,
            boxes_done: false,
            stage: Stage::Outside,
            visit: None,
            inner: Walk::new(),
            primitives: 0..0,
        }
    }

    /// The next candidate that somebody has to decide about; opaque triangles are confirmed on the way. `None` once
    /// everything was tried or the search was ended.
    #[inline]
    pub(crate) fn next(&mut self, counters: &mut Counters) -> Option<Offer> {
        while !self.found.ended {
            match self.stage {
                Stage::Outside => self.enter()?,
                Stage::Triangles => {
                    if let Some(candidate) = self.triangles(counters) {
                        return Some(Offer::Triangle(candidate));
                    }
                }
                Stage::Aabbs => {
                    if let Some(aabb) = self.aabbs(counters) {
                        return Some(Offer::Aabb(aabb));
                    }
                }
            }
        }
        None
    }

    /// Goes to the next instance that the ray can hit something in; `None` if there is none.
    fn enter(&mut self) -> Option<()> {
        let scene = self.found.scene;
        loop {
            for slot in self.instances.by_ref() {
                let Some(instance) = scene.instances.get(slot) else { continue };
                let [visible, ..] = self.found.options.cull_mask.to_le_bytes();
                if instance.mask & visible == 0 {
                    continue;
                }
                let Some(blas) = scene.blases.get(instance.blas as usize) else { continue };
                let Some(to_object) = scene.to_object(slot, instance, self.found.ray.time()) else { continue };
                let origin = to_object.point(self.found.ray.origin());
                let direction = to_object.direction(self.found.ray.direction());
                self.visit = Some(Visit {
                    instance,
                    blas,
                    origin,
                    direction,
                    opacity: flags::instance_opacity(instance.flags),
                    facing: Facing::new(self.found.options.flags, instance.flags),
                    triangle_ray: TriangleRay::new(origin, direction),
                    box_ray: BoxRay::new(&blas.triangle_bvh, origin, direction, self.found.ray.t_min()),
                });
                self.begin_triangles(blas);
                return Some(());
            }
            match self.outer.next(&scene.bvh, &self.box_ray, self.found.limit()) {
                Some(slots) => self.instances = slots,
                None if self.boxes_done => return None,
                None => {
                    self.boxes_done = true;
                    self.instances = scene.boxed..scene.instances.len();
                }
            }
        }
    }

    fn begin_triangles(&mut self, blas: &Blas) {
        if blas.triangles.is_empty() || self.found.options.flags.contains(RayFlags::SKIP_TRIANGLES) {
            return self.begin_aabbs();
        }
        self.inner.begin(&blas.triangle_bvh);
        self.stage = Stage::Triangles;
    }

    fn begin_aabbs(&mut self) {
        self.stage = Stage::Outside;
        let Some(visit) = &mut self.visit else { return };
        let bvh = &visit.blas.aabb_bvh;
        if !visit.blas.aabbs.is_empty() && !self.found.options.flags.contains(RayFlags::SKIP_AABBS) {
            self.inner.begin(bvh);
            visit.box_ray = BoxRay::new(bvh, visit.origin, visit.direction, self.found.ray.t_min());
            self.stage = Stage::Aabbs;
        }
    }

    /// The next triangle of the instance that somebody has to decide about. If there is none the stage is left,
    /// unless the search was ended.
    fn triangles(&mut self, counters: &mut Counters) -> Option<Candidate> {
        let Self { found, visit: Some(visit), inner, primitives, .. } = self else { return None };
        loop {
            for (slot, triangle) in
                primitives.clone().zip(visit.blas.triangles.get(primitives.clone()).unwrap_or_default())
            {
                let at_time;
                let vertices = match visit.blas.ends.get(slot) {
                    None => &triangle.vertices,
                    Some(end) => {
                        at_time = moved(&triangle.vertices, end, found.ray.time());
                        &at_time
                    }
                };
                let Some(hit) = visit.triangle_ray.intersect(vertices) else { continue };
                if let ControlFlow::Break(offer) = found.triangle(visit, triangle, hit, counters) {
                    primitives.start = slot + 1;
                    return offer;
                }
            }
            let next = inner.next(&visit.blas.triangle_bvh, &visit.box_ray, found.limit());
            *primitives = next.clone().unwrap_or_default();
            if next.is_none() {
                break;
            }
        }
        self.begin_aabbs();
        None
    }

    /// The next box of the instance that the ray may meet. If there is none the stage is left.
    fn aabbs(&mut self, counters: &mut Counters) -> Option<AabbCandidate> {
        let Self { found, visit: Some(visit), inner, primitives, .. } = self else { return None };
        loop {
            for (slot, aabb) in primitives.clone().zip(visit.blas.aabbs.get(primitives.clone()).unwrap_or_default()) {
                if !visit.box_ray.meets(&aabb.planes, found.limit()) {
                    continue;
                }
                if let Some(offer) = found.aabb(visit, aabb, counters) {
                    primitives.start = slot + 1;
                    return Some(offer);
                }
            }
            let next = inner.next(&visit.blas.aabb_bvh, &visit.box_ray, found.limit());
            *primitives = next.clone().unwrap_or_default();
            if next.is_none() {
                break;
            }
        }
        self.stage = Stage::Outside;
        None
    }
}

impl Scene {
    /// The way into the instance in a slot at a time, if there is one.
    fn to_object(&self, slot: usize, instance: &Instance, time: f32) -> Option<WorldToObject> {
        match instance.to_object {
            Some(known) => Some(known),
            None => WorldToObject::new(&self.placements.get(slot)?.at(time)),
        }
    }
}

impl Found<'_> {
    /// The largest `t` that is still of interest.
    pub(crate) fn limit(&self) -> f32 {
        self.closest.as_ref().map_or(self.ray.t_max(), |hit| hit.t)
    }

    /// What becomes of an intersection with a triangle: it is offered, or the search ends with it, or it goes on.
    #[inline]
    fn triangle(
        &mut self,
        visit: &Visit<'_>,
        triangle: &Triangle,
        hit: TriangleHit,
        counters: &mut Counters,
    ) -> ControlFlow<Option<Candidate>> {
        // The range of a triangle is open at both ends.
        if !(hit.t > self.ray.t_min() && hit.t <= self.limit() && hit.t < self.ray.t_max()) {
            return ControlFlow::Continue(());
        }
        let front = visit.facing.is_front(hit.front);
        let mut candidate = Candidate {
            t: hit.t,
            barycentrics: hit.barycentrics,
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
        counters.candidates += 1;
        if visit.facing.culls(front) {
            counters.culled_by_facing += 1;
            return ControlFlow::Continue(());
        }
        let Some(geometry) = visit.blas.geometries.get(triangle.geometry as usize) else {
            return ControlFlow::Continue(());
        };
        if self.options.micromaps && !visit.opacity.disable_micromaps {
            let micromap = geometry.micromap.and_then(|micromap| self.scene.micromaps.get(micromap as usize));
            candidate.micromap = triangle.opacity.state(micromap, hit.barycentrics, self.scene.tie_break);
        }
        match self.resolve(visit, candidate.micromap, geometry.opaque) {
            OpacityResult::Ignored => counters.ignored += 1,
            OpacityResult::Culled => counters.culled_by_opacity += 1,
            OpacityResult::NonOpaque => return ControlFlow::Break(Some(candidate)),
            OpacityResult::Opaque => {
                counters.opaque += 1;
                self.commit(candidate, true);
                if self.ended {
                    return ControlFlow::Break(None);
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// The box as it is offered, unless a flag culls it.
    fn aabb(&self, visit: &Visit<'_>, aabb: &Aabb, counters: &mut Counters) -> Option<AabbCandidate> {
        let geometry = visit.blas.geometries.get(aabb.geometry as usize)?;
        let result = self.resolve(visit, None, geometry.opaque);
        if !matches!(result, OpacityResult::Opaque | OpacityResult::NonOpaque) {
            counters.culled_aabbs += 1;
            return None;
        }
        counters.intersection_calls += 1;
        Some(AabbCandidate {
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
        })
    }

    fn resolve(&self, visit: &Visit<'_>, micromap: Option<OpacityState>, geometry_opaque: bool) -> OpacityResult {
        CandidateOpacity { micromap, geometry_opaque, instance: visit.opacity, ray: self.opacity }.resolve()
    }

    /// The hit that is reported for a box as a candidate, if it lies in the range that is left.
    ///
    /// The range of anything but a triangle is closed at both ends. NaN is in no range.
    pub(crate) fn reported(&self, aabb: &AabbCandidate, t: f32, kind: HitKind) -> Option<Candidate> {
        let candidate = Candidate {
            t,
            barycentrics: [0.0; 2],
            kind,
            instance_id: aabb.instance_id,
            instance_custom_index: aabb.instance_custom_index,
            geometry_index: aabb.geometry_index,
            primitive_id: aabb.primitive_id,
            sbt_record_offset: aabb.sbt_record_offset,
            micromap: None,
        };
        let within = t >= self.ray.t_min() && t <= self.limit();
        Some(candidate).filter(|candidate| within && self.is_closer(candidate))
    }

    /// Whether the candidate would take the place of the closest hit.
    fn is_closer(&self, candidate: &Candidate) -> bool {
        self.closest
            .as_ref()
            .is_none_or(|hit| candidate.t < hit.t || (candidate.t == hit.t && candidate.rank() < hit.candidate.rank()))
    }

    /// Makes a candidate the closest hit.
    pub(crate) fn commit(&mut self, candidate: Candidate, opaque: bool) {
        self.closest = Some(Hit { candidate, opaque });
        self.ended |= self.options.flags.contains(RayFlags::TERMINATE_ON_FIRST_HIT);
    }
}
