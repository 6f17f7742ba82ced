//! Why an image cannot be read.

use super::MAX_TEXELS;
use crate::texture::TextureError;

/// Why an image cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// The file is of no kind that is known.
    #[error("not a PNG, JPEG, TGA, DDS or KTX2 image: it starts with {start:02x?}")]
    Kind {
        /// Its first bytes.
        start: Vec<u8>,
    },
    /// A PNG, JPEG or TGA image cannot be decoded.
    #[error("{0}")]
    Raster(#[source] image::ImageError),
    /// A DDS header makes no sense.
    #[error("DDS: {0}")]
    Dds(#[source] ddsfile::Error),
    /// A KTX2 header makes no sense.
    #[error("KTX2: {0}")]
    Ktx(#[source] ktx2::ParseError),
    /// The file claims more than its data can hold.
    #[error("{width} x {height} pixels are claimed, more than {bytes} bytes can hold")]
    Size {
        /// Width claimed.
        width: u32,
        /// Height claimed.
        height: u32,
        /// Bytes of data.
        bytes: usize,
    },
    /// The image has more than [`MAX_TEXELS`].
    #[error("an image of {width} x {height} texels is too large: no more than {MAX_TEXELS} texels are read")]
    TooManyTexels {
        /// Width claimed.
        width: u32,
        /// Height claimed.
        height: u32,
    },
    /// There is no such mip level.
    #[error("there is no mip level {level}: the image has {levels}")]
    MipLevel {
        /// The level asked for.
        level: u32,
        /// How many there are.
        levels: u32,
    },
    /// The image is a volume, a cube map or an array.
    #[error("the image is {what}; only single 2D textures are read")]
    Shape {
        /// What it is.
        what: &'static str,
    },
    /// The texel format is none that is read.
    #[error("texel format {format} is not read: use an 8- or 16-bit unorm, a 32-bit float or a BC1 to BC7 format")]
    Format {
        /// Its name.
        format: String,
    },
    /// A colour channel of an sRGB format was asked for.
    #[error(
        "colours of {format} go through the sRGB curve, which no device computes alike: choose alpha or a linear format"
    )]
    SrgbColour {
        /// The format's name.
        format: String,
    },
    /// The texels are those of Basis Universal, which a device never sees.
    #[error(
        "the texels are supercompressed with Basis Universal, and what the shader reads depends on the transcoder: transcode to the format \
         that your engine uploads (such as `ktx transcode --target bc7`) and bake from that"
    )]
    Basis,
    /// Supercompressed data does not decompress to the size that the level claims.
    #[error("{scheme} data of {compressed} bytes does not decompress to {required} bytes: {reason}")]
    Supercompression {
        /// The scheme's name.
        scheme: &'static str,
        /// Bytes of compressed data.
        compressed: usize,
        /// Bytes that the level needs.
        required: u64,
        /// What happened instead.
        reason: String,
    },
    /// The values do not make a texture.
    #[error(transparent)]
    Texture(#[from] TextureError),
}
