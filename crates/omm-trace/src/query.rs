//! Ray queries: traversal that stops at each candidate and leaves the answer to its caller.
//!
//! [`RayQuery`] has a method for each instruction of `SPV_KHR_ray_query`, and [`QueryState`] says which of them make
//! sense when. Where the specification leaves a call undefined the answer is a [`QueryError`], and the query is as it
//! was before.
//!
//! ```
//! # use omm_trace::{Ray, Scene, TraceOptions};
//! use omm_trace::query::{QueryCandidate, RayQuery};
//!
//! # fn shadow(scene: &Scene, ray: &Ray) -> Result<bool, Box<dyn std::error::Error>> {
//! let mut query = RayQuery::new();
//! query.initialize(scene, ray, &TraceOptions::default());
//! while query.proceed()? {
//!     match query.candidate()? {
//!         QueryCandidate::Triangle(triangle) if triangle.barycentrics[0] < 0.5 => query.confirm()?,
//!         QueryCandidate::Triangle(_) => {}
//!         QueryCandidate::Aabb(aabb) => query.generate(aabb.t_min)?,
//!     }
//! }
//! Ok(query.committed()?.is_some())
//! # }
//! ```

use crate::counters::Counters;
use crate::hit::{Candidate, Hit, HitKind};
use crate::ray::{Ray, TraceOptions};
use crate::scene::Scene;
use crate::shader::AabbCandidate;
use crate::space::ObjectSpace;
use crate::traverse::{Offer, Search};

/// Whether micromaps count for the ray queries of a shader.
///
/// `execution_mode` is the operand of the shader's `OpacityMicromapKHR` execution mode, which decides where it is given.
/// Where it is not, micromaps only count if the device has `VK_EXT_opacity_micromap` enabled. The flags of a pipeline
/// make no difference to ray queries in its shaders.
#[must_use]
pub const fn micromaps_in_ray_queries(ext_enabled: bool, execution_mode: Option<bool>) -> bool {
    match execution_mode {
        Some(enabled) => enabled,
        None => ext_enabled,
    }
}

/// Where a ray query is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum QueryState {
    /// There is no ray yet.
    Uninitialized,
    /// There is a ray; traversal has not begun.
    Initialized,
    /// Traversal has stopped at a non-opaque triangle, which can be confirmed.
    TriangleCandidate,
    /// Traversal has stopped at a box, for which hits can be generated.
    AabbCandidate,
    /// Traversal is over.
    Complete,
}

impl std::fmt::Display for QueryState {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Uninitialized => "an uninitialized query",
            Self::Initialized => "a query before its first proceed",
            Self::TriangleCandidate => "a query at a triangle",
            Self::AabbCandidate => "a query at an AABB",
            Self::Complete => "a complete query",
        })
    }
}

/// A call that the state of a query forbids, or a value that it does.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum QueryError {
    /// The instruction has no meaning in this state.
    #[error("{instruction}: found {found}, required {required}")]
    State {
        /// The SPIR-V instruction that the call stands for.
        instruction: &'static str,
        /// The state that the query is in.
        found: QueryState,
        /// What it should be.
        required: &'static str,
    },
    /// A hit was generated outside of the range that is left, or with NaN.
    #[error("OpRayQueryGenerateIntersectionKHR: found a t of {found}, required {t_min} to {t_max}")]
    HitT {
        /// The `t` found.
        found: f32,
        /// The smallest that is a hit.
        t_min: f32,
        /// The largest: the committed hit, or the end of the ray.
        t_max: f32,
    },
}

/// What a query has stopped at: the candidate of the `OpRayQueryGetIntersection…` instructions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum QueryCandidate {
    /// `RayQueryCandidateIntersectionTriangleKHR`: a triangle that is not opaque.
    Triangle(Candidate),
    /// `RayQueryCandidateIntersectionAABBKHR`: a box; [`AabbCandidate::opaque`] is
    /// `OpRayQueryGetIntersectionCandidateAABBOpaqueKHR`.
    Aabb(AabbCandidate),
}

impl QueryCandidate {
    const fn instance_id(&self) -> u32 {
        match self {
            Self::Triangle(triangle) => triangle.instance_id,
            Self::Aabb(aabb) => aabb.instance_id,
        }
    }
}

/// The committed hit of a query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CommittedIntersection {
    /// `RayQueryCommittedIntersectionTriangleKHR`: a triangle that was opaque or was confirmed.
    Triangle(Hit),
    /// `RayQueryCommittedIntersectionGeneratedKHR`: a hit that was generated for a box.
    Generated(Hit),
}

impl CommittedIntersection {
    /// The hit.
    #[must_use]
    pub const fn hit(&self) -> &Hit {
        match self {
            Self::Triangle(hit) | Self::Generated(hit) => hit,
        }
    }
}

/// Which of the two intersections of a query an instruction is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Intersection {
    /// What the query has stopped at.
    Candidate,
    /// The closest hit so far.
    Committed,
}

/// A ray query. It can be initialized again at any time, for the same scene or another, and allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct RayQuery<'s> {
    search: Option<Search<'s>>,
    /// What the search has stopped at.
    candidate: Option<QueryCandidate>,
    /// Whether something was committed for the candidate.
    answered: bool,
    /// Whether traversal has begun.
    begun: bool,
    complete: bool,
    counters: Counters,
}

impl<'s> RayQuery<'s> {
    /// A query that is not initialized.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// `OpRayQueryInitializeKHR`: begins anew, with this ray. Of the options flags, cull mask and
    /// [`micromaps`](TraceOptions::micromaps) count; there is no shader binding table.
    pub fn initialize(&mut self, scene: &'s Scene, ray: &Ray, options: &TraceOptions) {
        *self = Self {
            search: Some(Search::new(scene, ray, options)),
            counters: Counters { rays: 1, ..Counters::default() },
            ..Self::default()
        };
    }

    /// Where the query is.
    #[must_use]
    pub const fn state(&self) -> QueryState {
        match self.candidate {
            _ if self.search.is_none() => QueryState::Uninitialized,
            _ if self.complete => QueryState::Complete,
            Some(QueryCandidate::Triangle(_)) => QueryState::TriangleCandidate,
            Some(QueryCandidate::Aabb(_)) => QueryState::AabbCandidate,
            None => QueryState::Initialized,
        }
    }

    /// What traversal has done so far. Of a triangle that was offered [`Counters::any_hit_calls`] says so, as if the
    /// caller were an any-hit shader.
    #[must_use]
    pub const fn counters(&self) -> Counters {
        self.counters
    }

    /// `OpRayQueryProceedKHR`: goes on to the next candidate that the caller has to decide about. Opaque triangles are
    /// committed on the way. `false` once traversal is over, and then whenever it is called again.
    ///
    /// # Errors
    /// The query is not initialized.
    pub fn proceed(&mut self) -> Result<bool, QueryError> {
        let error = self.forbidden("OpRayQueryProceedKHR", "an initialized one");
        let search = self.search.as_mut().ok_or(error)?;
        if self.complete {
            return Ok(false);
        }
        if let Some(QueryCandidate::Triangle(_)) = self.candidate {
            self.counters.any_hit_ignored += u64::from(!self.answered);
        }
        self.answered = false;
        self.begun = true;
        self.candidate = match search.next(&mut self.counters) {
            Some(Offer::Triangle(candidate)) => {
                self.counters.any_hit_calls += 1;
                Some(QueryCandidate::Triangle(candidate))
            }
            Some(Offer::Aabb(aabb)) => Some(QueryCandidate::Aabb(aabb)),
            None => None,
        };
        if self.candidate.is_none() {
            self.finish();
        }
        Ok(!self.complete)
    }

    fn finish(&mut self) {
        self.complete = true;
        self.candidate = None;
        let hit = self.search.as_ref().is_some_and(|search| search.found.closest.is_some());
        self.counters.hits += u64::from(hit);
    }

    /// `OpRayQueryTerminateKHR`: ends the traversal. What was committed stays.
    ///
    /// # Errors
    /// No proceed has answered `true` yet, or traversal is over.
    pub fn terminate(&mut self) -> Result<(), QueryError> {
        let Some(candidate) = self.candidate else {
            return Err(self.forbidden("OpRayQueryTerminateKHR", "one at a candidate"));
        };
        if matches!(candidate, QueryCandidate::Triangle(_)) {
            self.counters.any_hit_ignored += u64::from(!self.answered);
        }
        self.finish();
        Ok(())
    }

    /// `OpRayQueryConfirmIntersectionKHR`: the triangle at hand is a hit. To confirm it twice changes nothing.
    ///
    /// # Errors
    /// The query is not at a triangle.
    pub fn confirm(&mut self) -> Result<(), QueryError> {
        match (&mut self.search, self.candidate) {
            (Some(search), Some(QueryCandidate::Triangle(candidate))) => {
                search.found.commit(candidate, false);
                self.answered = true;
                Ok(())
            }
            _ => Err(self.forbidden("OpRayQueryConfirmIntersectionKHR", "one at a triangle")),
        }
    }

    /// `OpRayQueryGenerateIntersectionKHR`: what the box at hand stands for is hit at `t`. A nearer hit can be generated
    /// after it.
    ///
    /// # Errors
    /// The query is not at a box, or `t` is not in the range that is left.
    pub fn generate(&mut self, t: f32) -> Result<(), QueryError> {
        let (Some(search), Some(QueryCandidate::Aabb(aabb))) = (&mut self.search, &mut self.candidate) else {
            return Err(self.forbidden("OpRayQueryGenerateIntersectionKHR", "one at an AABB"));
        };
        let (t_min, t_max) = (search.found.ray.t_min(), search.found.limit());
        if !(t_min..=t_max).contains(&t) {
            return Err(QueryError::HitT { found: t, t_min, t_max });
        }
        // At the same `t` as a hit of a lower instance, geometry or primitive that one stays.
        if let Some(candidate) = search.found.reported(aabb, t, HitKind::Reported(0)) {
            self.counters.candidates += 1;
            *(if aabb.opaque { &mut self.counters.opaque } else { &mut self.counters.any_hit_calls }) += 1;
            search.found.commit(candidate, aabb.opaque);
            aabb.t_max = t;
        }
        Ok(())
    }

    /// What the query has stopped at.
    ///
    /// # Errors
    /// The query is not at a candidate.
    pub fn candidate(&self) -> Result<QueryCandidate, QueryError> {
        self.candidate
            .ok_or_else(|| self.forbidden("OpRayQueryGetIntersectionTypeKHR of the candidate", "one at a candidate"))
    }

    /// The closest hit so far; `None` is `RayQueryCommittedIntersectionNoneKHR`.
    ///
    /// # Errors
    /// The query has not begun to proceed.
    pub fn committed(&self) -> Result<Option<CommittedIntersection>, QueryError> {
        let instruction = "OpRayQueryGetIntersectionTypeKHR of the committed intersection";
        let error = || self.forbidden(instruction, "one that has proceeded");
        let search = self.search.as_ref().filter(|_| self.begun).ok_or_else(error)?;
        Ok(search.found.closest.map(|hit| match hit.kind {
            HitKind::Reported(_) => CommittedIntersection::Generated(hit),
            _ => CommittedIntersection::Triangle(hit),
        }))
    }

    /// How the instance of an intersection lies: `OpRayQueryGetIntersectionObjectToWorldKHR` and the three like it.
    /// `None` if nothing is committed.
    ///
    /// # Errors
    /// As [`candidate`](Self::candidate) and [`committed`](Self::committed).
    pub fn object_space(&self, of: Intersection) -> Result<Option<ObjectSpace>, QueryError> {
        let instance_id = match of {
            Intersection::Candidate => Some(self.candidate()?.instance_id()),
            Intersection::Committed => self.committed()?.map(|committed| committed.hit().instance_id),
        };
        let space = |id| self.search.as_ref().and_then(|search| search.found.scene.object_space(id, &search.found.ray));
        Ok(instance_id.and_then(space))
    }

    /// The ray: `OpRayQueryGetRayTMinKHR`, `OpRayQueryGetWorldRayOriginKHR` and `OpRayQueryGetWorldRayDirectionKHR`.
    ///
    /// # Errors
    /// The query is not initialized.
    pub fn ray(&self) -> Result<&Ray, QueryError> {
        let error = || self.forbidden("OpRayQueryGetRayTMinKHR", "an initialized one");
        self.search.as_ref().map(|search| &search.found.ray).ok_or_else(error)
    }

    /// The options: `OpRayQueryGetRayFlagsKHR`.
    ///
    /// # Errors
    /// The query is not initialized.
    pub fn options(&self) -> Result<&TraceOptions, QueryError> {
        let error = || self.forbidden("OpRayQueryGetRayFlagsKHR", "an initialized one");
        self.search.as_ref().map(|search| &search.found.options).ok_or_else(error)
    }

    fn forbidden(&self, instruction: &'static str, required: &'static str) -> QueryError {
        QueryError::State { instruction, found: self.state(), required }
    }
}
