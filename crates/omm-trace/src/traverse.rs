//! Following a ray through a scene, from one candidate that needs an answer to the next.

use std::ops::{ControlFlow, Range};

use omm_model::opacity::{CandidateOpacity, InstanceOpacity, OpacityResult, OpacityState, RayOpacity};

use crate::bvh::{BoxRay, Walk};
use crate::counters::Counters;
use crate::flags::{self, Facing, RayFlags};
use crate::hit::{Candidate, Hit, HitKind};
use crate::placement::moved;
use crate::ray::{Ray, TraceOptions};
use crate::scene::{Aabb, Primitives, Reference, Scene, Triangle};
use crate::shader::AabbCandidate;
use crate::triangle::TriangleHit;

mod visit;

use visit::{Pending, Visit};

/// The search along one ray. It stops at every candidate that somebody else has to decide about, and can be taken
/// up again afterwards: pipelines and ray queries differ in who answers.
#[derive(Clone, Debug)]
pub(crate) struct Search<'s> {
    pub(crate) found: Found<'s>,
    /// The ray among the boxes of the scene.
    box_ray: BoxRay,
    /// What is open of the scene, and above it what is open of the part of an instance that the search is in.
    walk: Walk,
    /// How much is open of the scene.
    floor: usize,
    /// References without a box, which every ray follows in the end.
    unboxed: Range<usize>,
    stage: Stage,
    /// The instance that was entered last.
    visit: Option<Visit<'s>>,
    /// The ray among the boxes of that instance, once it is needed.
    object_box_ray: Option<BoxRay>,
    /// Primitives of that instance that are to be tried before the walk goes on.
    pending: Pending,
}

/// Where a search is.
#[derive(Clone, Copy, Debug)]
enum Stage {
    /// Between two parts of instances.
    Outside,
    /// Among triangles.
    Triangles,
    /// Among boxes.
    Aabbs,
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
        let mut walk = Walk::new();
        walk.begin(&scene.bvh);
        Self {
            found,
            box_ray: BoxRay::new(&scene.bvh, origin, direction, ray.t_min()),
            walk,
            floor: 0,
            unboxed: scene.boxed..scene.references.len(),
            stage: Stage::Outside,
            visit: None,
            object_box_ray: None,
            pending: Pending::default(),
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

    /// Goes to the next part of an instance that the ray can hit something in; `None` if there is none.
    fn enter(&mut self) -> Option<()> {
        let scene = self.found.scene;
        loop {
            let at = match self.walk.next(&scene.bvh, &self.box_ray, self.found.limit(), 0) {
                Some(leaf) => leaf,
                None => self.unboxed.next()?,
            };
            let Some(&Reference { instance, primitives, node }) = scene.references.get(at) else { continue };
            if self.found.passes_over(primitives) || !self.visit(instance) {
                continue;
            }
            let Self { found, visit: Some(visit), object_box_ray, .. } = self else { continue };
            self.floor = self.walk.depth();
            self.stage = match primitives {
                Primitives::Triangles => Stage::Triangles,
                Primitives::Aabbs => Stage::Aabbs,
            };
            match (node.as_leaf(), primitives) {
                (Some(leaf), Primitives::Triangles) => self.pending = visit.triangles(leaf),
                _ => {
                    object_box_ray.get_or_insert_with(|| visit.box_ray(&found.ray));
                    self.walk.begin_at(node);
                }
            }
            return Some(());
        }
    }

    /// Makes an instance the one that is visited, unless the ray cannot see or enter it.
    #[inline]
    fn visit(&mut self, at: u32) -> bool {
        if self.visit.as_ref().is_some_and(|visit| visit.is_of(at)) {
            return true;
        }
        let Found { scene, ray, options, .. } = &self.found;
        let [visible, ..] = options.cull_mask.to_le_bytes();
        if scene.instances.get(at as usize).is_none_or(|instance| instance.mask & visible == 0) {
            return false;
        }
        let Some(visit) = Visit::new(scene, at, ray) else { return false };
        self.visit = Some(visit);
        self.object_box_ray = None;
        true
    }

    /// The next triangle of the instance that somebody has to decide about. If there is none the stage is left,
    /// unless the search was ended.
    fn triangles(&mut self, counters: &mut Counters) -> Option<Candidate> {
        let Self { found, visit: Some(visit), object_box_ray, walk, floor, pending, .. } = self else { return None };
        loop {
            while let Some(slot) = pending.take() {
                let Some(triangle) = visit.blas.triangles.get(slot) else { continue };
                let at_time;
                let vertices = match visit.blas.ends.get(slot) {
                    None => &triangle.vertices,
                    Some(end) => {
                        at_time = moved(&triangle.vertices, end, found.ray.time());
                        &at_time
                    }
                };
                let Some(hit) = visit.triangle_ray().intersect(vertices) else { continue };
                if let ControlFlow::Break(offer) = found.triangle(visit, triangle, hit, counters) {
                    return offer;
                }
            }
            let Some(box_ray) = object_box_ray else { break };
            let Some(leaf) = walk.next(&visit.blas.triangle_bvh, box_ray, found.limit(), *floor) else { break };
            *pending = visit.triangles(leaf);
        }
        self.stage = Stage::Outside;
        None
    }

    /// The next box of the instance that the ray may meet. If there is none the stage is left.
    fn aabbs(&mut self, counters: &mut Counters) -> Option<AabbCandidate> {
        let Self { found, visit: Some(visit), object_box_ray: Some(box_ray), walk, floor, .. } = self else {
            return None;
        };
        while let Some(slot) = walk.next(&visit.blas.aabb_bvh, box_ray, found.limit(), *floor) {
            let Some(aabb) = visit.blas.aabbs.get(slot) else { continue };
            if !box_ray.meets(&aabb.planes, found.limit()) {
                continue;
            }
            if let Some(offer) = found.aabb(visit, aabb, counters) {
                return Some(offer);
            }
        }
        self.stage = Stage::Outside;
        None
    }
}

impl Found<'_> {
    /// Whether a flag says that such primitives are left out.
    const fn passes_over(&self, primitives: Primitives) -> bool {
        self.options.flags.contains(match primitives {
            Primitives::Triangles => RayFlags::SKIP_TRIANGLES,
            Primitives::Aabbs => RayFlags::SKIP_AABBS,
        })
    }

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
        let facing = Facing::new(self.options.flags, visit.instance.flags);
        let front = facing.is_front(hit.front);
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
        if facing.culls(front) {
            counters.culled_by_facing += 1;
            return ControlFlow::Continue(());
        }
        let Some(geometry) = visit.blas.geometries.get(triangle.geometry as usize) else {
            return ControlFlow::Continue(());
        };
        let instance = flags::instance_opacity(visit.instance.flags);
        if self.options.micromaps && !instance.disable_micromaps {
            let micromap = geometry.micromap.and_then(|micromap| self.scene.micromaps.get(micromap as usize));
            candidate.micromap = triangle.opacity.state(micromap, hit.barycentrics, self.scene.tie_break);
        }
        match self.resolve(instance, candidate.micromap, geometry.opaque) {
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
        let instance = flags::instance_opacity(visit.instance.flags);
        let result = self.resolve(instance, None, geometry.opaque);
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

    fn resolve(
        &self,
        instance: InstanceOpacity,
        micromap: Option<OpacityState>,
        geometry_opaque: bool,
    ) -> OpacityResult {
        CandidateOpacity { micromap, geometry_opaque, instance, ray: self.opacity }.resolve()
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
