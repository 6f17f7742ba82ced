//! What traversal did, in numbers.

use std::iter::Sum;
use std::ops::{Add, AddAssign};

/// Counts of what happened to rays. Add those of several threads up; the sum does not depend on who did what.
///
/// Every candidate ends in exactly one way: `candidates == ignored + culled_by_facing + culled_by_opacity + opaque
/// + any_hit_calls`. An AABB that a ray may meet is no candidate; a hit reported for it is one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Rays traced.
    pub rays: u64,
    /// Candidates: intersections with triangles in the range of `t` that is left, and hits reported by intersection
    /// shaders.
    pub candidates: u64,
    /// Candidates that a micromap says are transparent.
    pub ignored: u64,
    /// Candidates dropped for the side of the triangle they are on.
    pub culled_by_facing: u64,
    /// Candidates dropped because they are opaque, or because they are not.
    pub culled_by_opacity: u64,
    /// Candidates confirmed without a shader.
    pub opaque: u64,
    /// Calls of the any-hit shader.
    pub any_hit_calls: u64,
    /// Calls of the any-hit shader that ignored the candidate.
    pub any_hit_ignored: u64,
    /// Calls of the intersection shader.
    pub intersection_calls: u64,
    /// AABBs dropped because they are opaque, or because they are not, before any intersection shader was called.
    pub culled_aabbs: u64,
    /// Rays that ended with a hit.
    pub hits: u64,
}

impl Counters {
    /// All candidates that were dropped by a culling flag.
    #[must_use]
    pub const fn culled(&self) -> u64 {
        self.culled_by_facing + self.culled_by_opacity
    }
}

impl AddAssign for Counters {
    fn add_assign(&mut self, other: Self) {
        let Self {
            rays,
            candidates,
            ignored,
            culled_by_facing,
            culled_by_opacity,
            opaque,
            any_hit_calls,
            any_hit_ignored,
            intersection_calls,
            culled_aabbs,
            hits,
        } = other;
        self.rays += rays;
        self.candidates += candidates;
        self.ignored += ignored;
        self.culled_by_facing += culled_by_facing;
        self.culled_by_opacity += culled_by_opacity;
        self.opaque += opaque;
        self.any_hit_calls += any_hit_calls;
        self.any_hit_ignored += any_hit_ignored;
        self.intersection_calls += intersection_calls;
        self.culled_aabbs += culled_aabbs;
        self.hits += hits;
    }
}

impl Add for Counters {
    type Output = Self;
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl Sum for Counters {
    fn sum<I: Iterator<Item = Self>>(counters: I) -> Self {
        counters.fold(Self::default(), Add::add)
    }
}
