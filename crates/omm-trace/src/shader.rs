//! The shaders that traversal calls.

use crate::hit::Candidate;

/// What an any-hit shader makes of a candidate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AnyHit {
    /// The candidate is a hit; what lies behind it is no longer of interest. (The shader returned.)
    Accept,
    /// The candidate is dropped. (`OpIgnoreIntersectionKHR`.)
    Ignore,
    /// The candidate is a hit and the search ends. (`OpTerminateRayKHR`.)
    AcceptAndEndSearch,
}

/// An AABB that a ray may meet. That it is offered does not prove that the ray meets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AabbCandidate {
    /// The lowest coordinates of the box, in the space of the bottom-level structure.
    pub min: [f32; 3],
    /// The highest.
    pub max: [f32; 3],
    /// The ray's origin in that space: `ObjectRayOriginKHR`, before it is rounded to `f32`.
    pub origin: [f64; 3],
    /// The ray's direction in that space: `ObjectRayDirectionKHR`, likewise. `t` is the same in every space.
    pub direction: [f64; 3],
    /// The smallest `t` that can be reported.
    pub t_min: f32,
    /// The largest `t` that can be reported: the closest hit so far, or the end of the ray.
    pub t_max: f32,
    /// The instance's position in the top-level structure.
    pub instance_id: u32,
    /// The number that the application gave to the instance, 24 bits.
    pub instance_custom_index: u32,
    /// The geometry's position in the bottom-level structure.
    pub geometry_index: u32,
    /// The box's position in the geometry, inactive ones counted.
    pub primitive_id: u32,
    /// What the instance adds to the index of the hit group, 24 bits.
    pub sbt_record_offset: u32,
    /// Whether hits reported for the box are opaque.
    pub opaque: bool,
}

/// A hit that an intersection shader reports: the operands of `OpReportIntersectionKHR`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReportedHit {
    /// The ray's parameter. A hit outside of `t_min..=t_max` of the candidate, or NaN, is no hit.
    pub t: f32,
    /// A number of the shader's own; its low 7 bits count.
    pub kind: u8,
}

/// The any-hit and intersection shaders of all hit groups. Which one is meant follows from the instance, geometry
/// and record offset in the candidate.
///
/// Each is called at most once for each primitive that a ray meets; the any-hit shader once for each hit that is reported
/// for an AABB. In which order candidates come is not
/// specified, neither by Vulkan nor here, but it is the same for the same scene and ray.
pub trait Shaders {
    /// Decides about a non-opaque candidate. As if no shader were there, the default accepts.
    fn any_hit(&mut self, candidate: &Candidate) -> AnyHit {
        let _ = candidate;
        AnyHit::Accept
    }

    /// Intersects what an AABB stands for, and reports the first hit, if there is one. As if no shader were there,
    /// the default reports nothing.
    fn intersection(&mut self, aabb: &AabbCandidate) -> Option<ReportedHit> {
        let _ = aabb;
        None
    }

    /// Goes on after a hit was reported, which was `accepted` or not (the result of `OpReportIntersectionKHR`), and
    /// reports the next one, if there is one; [`AabbCandidate::t_max`] has shrunk to what was accepted. The default
    /// reports no more.
    fn next_intersection(&mut self, aabb: &AabbCandidate, accepted: bool) -> Option<ReportedHit> {
        let _ = (aabb, accepted);
        None
    }
}

/// No shaders: non-opaque candidates are hits, AABBs are not.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoShaders;

impl Shaders for NoShaders {}

/// A closure is an any-hit shader.
impl<F: FnMut(&Candidate) -> AnyHit> Shaders for F {
    fn any_hit(&mut self, candidate: &Candidate) -> AnyHit {
        self(candidate)
    }
}
