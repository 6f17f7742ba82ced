//! Why a bake cannot be done.

use crate::schedule::WorkEstimate;
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
    /// A part of something is more than all of it, less than nothing, or NaN.
    #[error("{option} is {found}: it must be 0 to 1")]
    Fraction {
        /// The option.
        option: &'static str,
        /// The value given.
        found: f32,
    },
    /// The alignment of blocks is none.
    #[error("the block alignment is {found}: it must be a power of two up to {}", crate::options::MAX_BLOCK_ALIGNMENT)]
    BlockAlignment {
        /// The alignment given, in bytes.
        found: u32,
    },
    /// Some triangles have levels and formats of their own, but not each has an entry.
    #[error("there are {found} overrides for {required} triangles: give one for each triangle, or none")]
    OverrideCount {
        /// Overrides given.
        found: usize,
        /// Triangles of the mesh.
        required: usize,
    },
    /// The mips that are to be read do not exist.
    #[error("mips {first} to {last} are asked for, but the texture has mips 0 to {}", count - 1)]
    MipRange {
        /// The finest asked for.
        first: u32,
        /// The coarsest asked for.
        last: u32,
        /// Mips that the texture has.
        count: u32,
    },
    /// Two options cannot both be.
    #[error("{option} contradicts {with}: {remedy}")]
    Contradiction {
        /// One.
        option: &'static str,
        /// The other.
        with: &'static str,
        /// What to do about it.
        remedy: &'static str,
    },
    /// The bake would be more work than is allowed.
    #[error(
        "the bake is {} steps of work ({} microtriangles of {} triangles, {} texels), but the work budget is {limit}: \
         raise it, or choose lower levels or fewer mips",
        estimate.work(), estimate.microtriangles, estimate.baked_triangles, estimate.texels
    )]
    WorkBudget {
        /// What would have to be done.
        estimate: WorkEstimate,
        /// The budget.
        limit: u64,
    },
    /// Even at the lowest levels the array is too large.
    #[error(
        "the array cannot have fewer than {least} bytes, but the budget is {limit}: raise it, or allow special indices"
    )]
    ArrayBudget {
        /// Bytes at the lowest levels.
        least: u64,
        /// The budget.
        limit: u64,
    },
    /// The index buffer cannot have the type that was asked for.
    #[error(
        "no index type asked for can number {micromap_triangles} micromap triangles beside the special indices: allow a larger one"
    )]
    IndexType {
        /// Micromap triangles.
        micromap_triangles: usize,
    },
    /// The data of a micromap triangle lies beyond the array.
    #[error("micromap triangle {number} ends at byte {end}, but the array has {available}")]
    BlockBeyond {
        /// Number of the micromap triangle.
        number: usize,
        /// Byte at which its data ends.
        end: u64,
        /// Bytes of the array.
        available: u64,
    },
    /// An index names no micromap triangle.
    #[error("indices[{triangle}] is {found}, but there are {count} micromap triangles")]
    IndexBeyond {
        /// The triangle of the mesh.
        triangle: usize,
        /// Its index.
        found: u32,
        /// Micromap triangles.
        count: usize,
    },
    /// The progress callback asked to stop.
    #[error("the bake was cancelled")]
    Cancelled,
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
