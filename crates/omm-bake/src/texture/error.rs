//! Why data does not make a texture.

use super::MAX_SIDE;

/// Data that does not make a texture.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TextureError {
    /// A side has no texels.
    #[error("a texture of {width} x {height} texels is empty")]
    Empty {
        /// Width in texels.
        width: u32,
        /// Height in texels.
        height: u32,
    },
    /// A side is longer than [`MAX_SIDE`].
    #[error("a texture of {width} x {height} texels is too large: no side may exceed {MAX_SIDE}")]
    TooLarge {
        /// Width in texels.
        width: u32,
        /// Height in texels.
        height: u32,
    },
    /// Rows overlap.
    #[error("a row pitch of {row_pitch} texels is less than the width of {width}")]
    RowPitch {
        /// The pitch that was given.
        row_pitch: usize,
        /// Width in texels.
        width: u32,
    },
    /// There are fewer or more values than the sizes ask for.
    #[error("the texture data has {found} texels, but its size asks for {least} to {most}")]
    DataLength {
        /// Values given.
        found: usize,
        /// Values up to the end of the last row's texels.
        least: u64,
        /// Values up to the end of the last row's pitch.
        most: u64,
    },
    /// A float texel is NaN or infinite.
    #[error("texel ({x}, {y}) is {value}, which is not a finite number")]
    NotFinite {
        /// Column of the texel.
        x: u32,
        /// Row of the texel.
        y: u32,
        /// Its value.
        value: f32,
    },
    /// A mip is not half as large as the one before, rounded down.
    #[error(
        "mip {mip} has {} x {} texels, but half of the mip before is {} x {}",
        found[0], found[1], required[0], required[1]
    )]
    MipSize {
        /// Number of the mip.
        mip: u32,
        /// Its width and height in texels.
        found: [u32; 2],
        /// The sizes that it must have.
        required: [u32; 2],
    },
    /// What other devices read is not as large as the texture, or has mips or readings of its own.
    #[error("a reading of {} x {} texels is not one of a texture of {} x {}, or brings textures of its own", found[0], found[1], required[0], required[1])]
    Reading {
        /// Its width and height in texels.
        found: [u32; 2],
        /// Those of the texture.
        required: [u32; 2],
    },
    /// There are mips behind the one of a single texel, or a mip has mips of its own.
    #[error("mip {mip} cannot be: the one before has a single texel, or brings mips of its own")]
    MipChain {
        /// Number of the mip.
        mip: u32,
    },
}
