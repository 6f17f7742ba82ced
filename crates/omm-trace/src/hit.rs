//! Candidates and hits: what shaders see of an intersection.

use std::ops::Deref;

use omm_model::opacity::OpacityState;

/// What was hit: `HitKindKHR`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum HitKind {
    /// The front of a triangle, 0xFE.
    FrontFacingTriangle,
    /// The back of a triangle, 0xFF.
    BackFacingTriangle,
    /// What an intersection shader reported, by the number that it gave, `0..=127`.
    Reported(u8),
}

impl HitKind {
    /// The value that a shader reads.
    #[must_use]
    pub const fn value(self) -> u8 {
        match self {
            Self::FrontFacingTriangle => 0xfe,
            Self::BackFacingTriangle => 0xff,
            Self::Reported(kind) => kind,
        }
    }
}

/// An intersection candidate: a point at which a ray meets a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// The ray's parameter at the point: `RayTmaxKHR` in an any-hit shader.
    pub t: f32,
    /// The weights of the triangle's vertices 1 and 2, each in `0.0..=1.0`; zeros for an AABB.
    pub barycentrics: [f32; 2],
    /// What was met.
    pub kind: HitKind,
    /// The instance's position in the top-level structure, inactive ones counted: `InstanceId`.
    pub instance_id: u32,
    /// The number that the application gave to the instance, 24 bits: `InstanceCustomIndexKHR`.
    pub instance_custom_index: u32,
    /// The geometry's position in the bottom-level structure: `RayGeometryIndexKHR`.
    pub geometry_index: u32,
    /// The primitive's position in the geometry, inactive ones counted: `PrimitiveId`.
    pub primitive_id: u32,
    /// What the instance adds to the index of the hit group, 24 bits.
    pub sbt_record_offset: u32,
    /// The state that the micromap gives at the point, before any override; `None` if no micromap was looked at:
    /// the geometry has none, the instance disables them, or it is an AABB.
    pub micromap: Option<OpacityState>,
}

impl Candidate {
    /// Among hits at the same `t` the one of the lowest instance, geometry and primitive counts as the closest.
    pub(crate) const fn rank(&self) -> (u32, u32, u32) {
        (self.instance_id, self.geometry_index, self.primitive_id)
    }
}

/// A confirmed hit: a [`Candidate`], whose fields can be read through it, and how it was confirmed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// What was hit.
    pub candidate: Candidate,
    /// Whether it was opaque, so that no any-hit shader was asked.
    pub opaque: bool,
}

impl Deref for Hit {
    type Target = Candidate;
    fn deref(&self) -> &Candidate {
        &self.candidate
    }
}
