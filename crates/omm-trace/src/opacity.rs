//! Looking opacity up: from a hit on a triangle to the state that a micromap gives there.
//!
//! What becomes of the state is decided by [`omm_model::opacity::CandidateOpacity::resolve`] alone.

use omm_layout::object::MicromapObject;
use omm_model::curve::TieBreak;
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;

/// A micromap, copied out of memory.
#[derive(Clone, Debug)]
pub(crate) struct Micromap {
    bytes: Vec<u8>,
    triangles: Vec<MicromapTriangle>,
}

#[derive(Clone, Copy, Debug)]
struct MicromapTriangle {
    /// Where its elements begin in the bytes.
    offset: usize,
    level: SubdivisionLevel,
    format: OpacityMicromapFormat,
}

/// Where the opacity of a triangle comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TriangleOpacity {
    /// From the geometry's flags.
    Geometry,
    /// From a special index.
    Whole(OpacityState),
    /// From this triangle of the geometry's micromap.
    Micromap(u32),
}

impl Micromap {
    pub(crate) fn new(object: &MicromapObject<'_>) -> Self {
        let bytes = object.as_bytes();
        let start = bytes.as_ptr().addr();
        // Elements are copied once, with the object: blocks of a compacted one may be shared.
        let triangle = |triangle: omm_layout::object::MicromapTriangleData<'_>| MicromapTriangle {
            offset: triangle.data.as_ptr().addr().saturating_sub(start),
            level: triangle.subdivision_level,
            format: triangle.format,
        };
        Self { triangles: object.triangles().map(triangle).collect(), bytes: bytes.to_vec() }
    }

    pub(crate) fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The state of a triangle at a point.
    fn state(&self, triangle: u32, [u, v]: [f32; 2], tie_break: TieBreak) -> Option<OpacityState> {
        let MicromapTriangle { offset, level, format } = *self.triangles.get(triangle as usize)?;
        format.state(self.bytes.get(offset..)?, tie_break.index(u, v, level).into())
    }
}

impl TriangleOpacity {
    /// The state that the geometry's micromap gives the triangle at a point; `None` if the geometry was built
    /// without one.
    ///
    /// That a triangle's index lies within the micromap was proved when the scene was loaded.
    #[inline]
    pub(crate) fn state(
        self,
        micromap: Option<&Micromap>,
        barycentrics: [f32; 2],
        tie_break: TieBreak,
    ) -> Option<OpacityState> {
        match self {
            Self::Geometry => None,
            Self::Whole(state) => Some(state),
            Self::Micromap(triangle) => micromap?.state(triangle, barycentrics, tie_break),
        }
    }
}
