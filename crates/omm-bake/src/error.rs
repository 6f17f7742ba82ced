//! Why a bake cannot be done.

use crate::surface::SurfaceError;

/// Why a bake cannot be done. Nothing has been written then.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum BakeError {
    /// The cutoff or the border alpha is not a number.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// A triangle names a vertex that has no texture coordinates.
    #[error("triangles[{triangle}][{corner}] is {found}, but there are texture coordinates for {count} vertices")]
    IndexOutOfRange {
        /// The triangle.
        triangle: usize,
        /// Its corner, 0..=2.
        corner: usize,
        /// The index found.
        found: u32,
        /// Vertices with texture coordinates.
        count: usize,
    },
    /// A triangle index does not fit in the index buffer, whose negative values are special.
    #[error("{found} triangles are more than {limit}, which is all that an index buffer can number")]
    TooManyTriangles {
        /// Triangles given.
        found: usize,
        /// The most that there can be.
        limit: usize,
    },
    /// The scale of dynamic levels is not a size.
    #[error("the dynamic subdivision scale is {found}: it must be finite and above 0")]
    DynamicScale {
        /// The scale given.
        found: f32,
    },
    /// Data offsets have 32 bits.
    #[error(
        "the micromap data needs {required} bytes or more, but offsets reach only up to {limit}: choose a lower level"
    )]
    ArrayTooLarge {
        /// Bytes up to the end of the block that does not fit.
        required: u64,
        /// The most that there can be.
        limit: u64,
    },
    /// The system has no more memory.
    #[error("no memory for {required} bytes of micromap data")]
    OutOfMemory {
        /// Bytes that were asked for in all.
        required: u64,
    },
}
