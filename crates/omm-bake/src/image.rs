//! One channel of an image file as an alpha texture: PNG, JPEG, TGA, DDS and KTX2.
//!
//! The texture holds what a sampler would read, so that the bake is sound for the file that the shader sees:
//!
//! | texels | what is guaranteed |
//! |---|---|
//! | 8-bit unorm, BC2 alpha, BC7 | the value over 255, exactly |
//! | BC1 alpha | 0 or 1; 1 everywhere where the format has no punch-through (`BC1_RGB`) |
//! | BC3 alpha, BC4, BC5 | the interpolated fraction of the Khronos data format specification, `(6 a + b) / 7` and its like, over 255 (127 for snorm), rounded once to `f32`; exactly where it is a whole number of 255ths |
//! | BC1, BC2 and BC3 colours | the interpolated fraction of 5- or 6-bit endpoints, rounded once to `f32` |
//! | BC6H | the half float |
//! | 16-bit unorm | the value over 65535, rounded once to `f32` |
//! | 32-bit float | the value |
//!
//! Devices need not agree with the specification's fractions of BC1 to BC5, and some do not: see [`BlockDecoding`]. BC1 alpha, BC2
//! alpha and BC7 have none, and an NVIDIA H200 gave these alphas for a million texels of random blocks each.
//!
//! Alpha has no transfer function: in sRGB formats it is taken as it is stored. A colour channel of an sRGB format of DDS or KTX2
//! is refused, because no specification says to the last bit what a sampler makes of it. PNG, JPEG and TGA files do not say how
//! they are uploaded; their colours are taken as stored. Rows are taken in the order of the file, the first at *v* = 0.

use serde::{Deserialize, Serialize};

use crate::texture::{Texture, TextureError};

mod block;
mod dds;
mod error;
mod ktx;
mod raster;
mod texels;

pub use error::ImageError;

/// The channel of an image that is an alpha texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Channel {
    /// Red, or the only one of a grey image.
    Red,
    /// Green.
    Green,
    /// Blue.
    Blue,
    /// Alpha, which is 1 where an image has none.
    #[default]
    Alpha,
}

/// How a device makes values between the ends of a block of BC3 alpha, BC4 or BC5.
///
/// The specification gives fractions, but devices are allowed some tolerance, and [they use it][1]: an NVIDIA device has 0.375 of
/// the way where the fraction is 2/5. A bake is sound for the devices that decode as it did.
///
/// [1]: https://fgiesen.wordpress.com/2021/10/04/gpu-bcn-decoding/
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BlockDecoding {
    /// The fractions of the Khronos data format specification.
    #[default]
    Specification,
    /// As an NVIDIA H200 was seen to decode, to the last bit. Signed formats and colours, which were not measured, are decoded by the
    /// specification.
    Nvidia,
    /// Both: a bake of such a texture is sound for devices of either kind. States that only one of them has are unknown.
    All,
}

/// What is read of an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ImageOptions {
    /// Which channel.
    pub channel: Channel,
    /// The last mip level that the texture gets; it has all from 0, the largest, to this one. Only DDS and KTX2 files have others
    /// than 0.
    pub last_mip: u32,
    /// As which device blocks are decoded.
    pub block_decoding: BlockDecoding,
}

/// No image has more texels: those of 16384 x 16384.
pub const MAX_TEXELS: u64 = 1 << 28;

/// One channel of the image file that `bytes` are. The kind is known by its first bytes.
///
/// At most 16 bytes a texel are held at a time beside `bytes`, and none before the file was found long enough for the size
/// that it claims.
///
/// # Errors
/// [`ImageError`] if the file is of no known kind or format, ends early, has no such mip level, or claims more than it holds.
///
/// ```
/// use omm_bake::image::{self, Channel, ImageOptions};
///
/// // A TGA file of 2 x 1 grey texels.
/// let file = [0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 8, 0, 51, 255];
/// let texture = image::read(&file, ImageOptions { channel: Channel::Red, ..ImageOptions::default() })?;
/// assert_eq!((texture.width(), texture.alpha(0, 0)), (2, Some(0.2)));
/// # Ok::<(), image::ImageError>(())
/// ```
pub fn read(bytes: &[u8], options: ImageOptions) -> Result<Texture, ImageError> {
    let texture = read_level(bytes, options, 0)?;
    let mips = (1..=options.last_mip).map(|level| read_level(bytes, options, level)).collect::<Result<_, _>>()?;
    Ok(texture.with_mips(mips)?)
}

/// One mip level by itself.
fn read_level(bytes: &[u8], options: ImageOptions, level: u32) -> Result<Texture, ImageError> {
    match bytes {
        [b'D', b'D', b'S', b' ', ..] => dds::read(bytes, options, level),
        [0xab, b'K', b'T', b'X', b' ', b'2', b'0', ..] => ktx::read(bytes, options, level),
        _ => raster::read(bytes, options, level),
    }
}

/// Width and height of a mip level, with a size that may be held in memory.
fn level_size(width: u32, height: u32, level: u32, claimed: u32) -> Result<(u32, u32), ImageError> {
    if width == 0 || height == 0 {
        return Err(TextureError::Empty { width, height }.into());
    }
    // Behind the level of a single texel there is none, whatever the file claims.
    let levels = claimed.min(width.max(height).checked_ilog2().unwrap_or(0) + 1);
    if level >= levels {
        return Err(ImageError::MipLevel { level, levels });
    }
    if u64::from(width) * u64::from(height) > MAX_TEXELS {
        return Err(ImageError::TooManyTexels { width, height });
    }
    let half = |side: u32| side.checked_shr(level).unwrap_or(0).max(1);
    Ok((half(width), half(height)))
}

#[cfg(test)]
mod tests;
