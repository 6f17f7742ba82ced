//! Rays of ray-tracing pipelines: shaders answer for candidates as traversal meets them.

use crate::counters::Counters;
use crate::hit::{Candidate, Hit, HitKind};
use crate::ray::{Ray, TraceOptions};
use crate::scene::Scene;
use crate::shader::{AabbCandidate, AnyHit, ReportedHit, Shaders};
use crate::traverse::{Offer, Search};

impl Scene {
    /// Traces a ray and answers the closest hit, or with [`RayFlags::TERMINATE_ON_FIRST_HIT`] or
    /// [`AnyHit::AcceptAndEndSearch`] the hit at which the search ended; `None` is a miss.
    ///
    /// Which candidates shaders see, and in which order, depends on the hierarchy. The closest hit does not, as
    /// long as shaders answer the same for the same candidate: among hits at the same `t` it is the one of the
    /// lowest instance, geometry and primitive. Nothing is allocated.
    ///
    /// [`RayFlags::TERMINATE_ON_FIRST_HIT`]: crate::RayFlags::TERMINATE_ON_FIRST_HIT
    pub fn trace<S: Shaders + ?Sized>(
        &self,
        ray: &Ray,
        options: &TraceOptions,
        shaders: &mut S,
        counters: &mut Counters,
    ) -> Option<Hit> {
        counters.rays += 1;
        let mut search = Search::new(self, ray, options);
        while let Some(offer) = search.next(counters) {
            match offer {
                Offer::Triangle(candidate) => {
                    any_hit(&mut search, candidate, shaders, counters);
                }
                Offer::Aabb(aabb) => intersection(&mut search, aabb, shaders, counters),
            }
        }
        let hit = search.found.closest;
        counters.hits += u64::from(hit.is_some());
        hit
    }
}

/// Calls the any-hit shader and does what it says. Tells whether the candidate is a hit.
#[inline]
fn any_hit<S: Shaders + ?Sized>(
    search: &mut Search<'_>,
    candidate: Candidate,
    shaders: &mut S,
    counters: &mut Counters,
) -> bool {
    counters.any_hit_calls += 1;
    let answer = shaders.any_hit(&candidate);
    if answer == AnyHit::Ignore {
        counters.any_hit_ignored += 1;
        return false;
    }
    search.found.commit(candidate, false);
    search.found.ended |= answer == AnyHit::AcceptAndEndSearch;
    true
}

/// Calls the intersection shader and judges what it reports.
fn intersection<S: Shaders + ?Sized>(
    search: &mut Search<'_>,
    mut aabb: AabbCandidate,
    shaders: &mut S,
    counters: &mut Counters,
) {
    let mut report = shaders.intersection(&aabb);
    while let Some(ReportedHit { t, kind }) = report {
        let accepted = match search.found.reported(&aabb, t, HitKind::Reported(kind & 0x7f)) {
            None => false,
            Some(candidate) => {
                counters.candidates += 1;
                if aabb.opaque {
                    counters.opaque += 1;
                    search.found.commit(candidate, true);
                    true
                } else {
                    any_hit(search, candidate, shaders, counters)
                }
            }
        };
        // Where the search has ended the intersection shader does not go on.
        if search.found.ended {
            return;
        }
        aabb.t_max = search.found.limit();
        report = shaders.next_intersection(&aabb, accepted);
    }
}
