//! KTX2 files.

use std::borrow::Cow;
use std::io::Read;

use ktx2::{ColorModel, Format, Header, LevelIndex, ParseError, SupercompressionScheme};

use super::block::BlockFormat;
use super::error::ImageError;
use super::texels::{Order, Sample, TexelFormat};
use super::{Channel, ImageOptions, level_size};
use crate::texture::Texture;

pub(super) fn read(bytes: &[u8], options: ImageOptions, level: u32) -> Result<Texture, ImageError> {
    // The crate's `Reader` panics on some descriptors of the data format, so only its structures are used.
    let header = bytes.first_chunk().ok_or(ParseError::UnexpectedEnd).and_then(Header::from_bytes);
    let header = header.map_err(ImageError::Ktx)?;
    check_shape(&header)?;
    if header.supercompression_scheme == Some(SupercompressionScheme::BasisLZ) || is_basis(&header, bytes) {
        return Err(ImageError::Basis);
    }
    let name = || header.format.map_or_else(|| "undefined".to_owned(), |format| format!("{format:?}"));
    let known = header.format.and_then(format);
    let (format, srgb) = known.ok_or_else(|| ImageError::Format { format: name() })?;
    if srgb && options.channel != Channel::Alpha {
        return Err(ImageError::SrgbColour { format: name() });
    }
    let levels = header.level_count.max(1);
    let (width, height) = level_size(header.pixel_width, header.pixel_height, level, levels)?;
    let stored = stored(bytes, level).ok_or(ImageError::Ktx(ParseError::UnexpectedEnd))?;
    let size = format.bytes(width, height);
    let data = match header.supercompression_scheme {
        None => Cow::Borrowed(stored),
        Some(scheme) => decompress(scheme, stored, size)?,
    };
    let data = usize::try_from(size).ok().and_then(|size| data.get(..size));
    format.texture(width, height, options, data.ok_or(ImageError::Size { width, height, bytes: stored.len() })?)
}

fn check_shape(header: &Header) -> Result<(), ImageError> {
    let what = match header {
        Header { pixel_height: 0, .. } => "a line",
        Header { pixel_depth: 2.., .. } => "a volume",
        Header { face_count: 2.., .. } => "a cube map",
        Header { layer_count: 2.., .. } => "an array",
        _ => return Ok(()),
    };
    Err(ImageError::Shape { what })
}

/// Whether the data format descriptor names a colour model of Basis Universal: it does so in the first byte of its first block's
/// body, behind a length and the block's header.
fn is_basis(header: &Header, bytes: &[u8]) -> bool {
    let model = bytes.get(header.index.dfd_byte_offset as usize..).and_then(|descriptor| descriptor.get(12));
    let basis = [ColorModel::ETC1S, ColorModel::UASTC].map(|model| model.value());
    header.format.is_none() && model.is_some_and(|model| basis.contains(model))
}

/// The bytes of a mip level, whose entry in the index behind the header says where they are.
fn stored(bytes: &[u8], level: u32) -> Option<&[u8]> {
    let entry = bytes.get(Header::LENGTH..)?.chunks_exact(LevelIndex::LENGTH).nth(level as usize)?;
    let LevelIndex { byte_offset, byte_length, .. } = LevelIndex::from_bytes(entry.first_chunk()?);
    let start = usize::try_from(byte_offset).ok()?;
    bytes.get(start..start.checked_add(usize::try_from(byte_length).ok()?)?)
}

/// Decompresses a level to the `required` bytes that its size asks for; no more are held.
fn decompress(scheme: SupercompressionScheme, data: &[u8], required: u64) -> Result<Cow<'_, [u8]>, ImageError> {
    let (name, result) = match scheme {
        SupercompressionScheme::Zstandard => {
            let decoder = ruzstd::decoding::StreamingDecoder::new(data).map_err(|error| error.to_string());
            ("Zstandard", decoder.and_then(|decoder| read_exactly(decoder, required)))
        }
        SupercompressionScheme::ZLIB => ("zlib", read_exactly(flate2::read::ZlibDecoder::new(data), required)),
        _ => return Err(ImageError::Format { format: format!("supercompressed with {scheme:?}") }),
    };
    let error = |reason| ImageError::Supercompression { scheme: name, compressed: data.len(), required, reason };
    result.map(Cow::Owned).map_err(error)
}

fn read_exactly(decoder: impl Read, required: u64) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    // One byte more tells that there is more.
    decoder.take(required.saturating_add(1)).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    match (bytes.len() as u64).cmp(&required) {
        std::cmp::Ordering::Less => Err(format!("it ends after {} bytes", bytes.len())),
        std::cmp::Ordering::Equal => Ok(bytes),
        std::cmp::Ordering::Greater => Err("there is more".to_owned()),
    }
}

/// The format, and whether its colours are sRGB.
fn format(format: Format) -> Option<(TexelFormat, bool)> {
    let blocks = |format, srgb| Some((TexelFormat::Blocks(format), srgb));
    let samples = |sample, order, srgb| Some((TexelFormat::Samples { sample, order }, srgb));
    match format {
        Format::BC1_RGB_UNORM_BLOCK => blocks(BlockFormat::Bc1 { punch_through: false }, false),
        Format::BC1_RGB_SRGB_BLOCK => blocks(BlockFormat::Bc1 { punch_through: false }, true),
        Format::BC1_RGBA_UNORM_BLOCK => blocks(BlockFormat::Bc1 { punch_through: true }, false),
        Format::BC1_RGBA_SRGB_BLOCK => blocks(BlockFormat::Bc1 { punch_through: true }, true),
        Format::BC2_UNORM_BLOCK => blocks(BlockFormat::Bc2, false),
        Format::BC2_SRGB_BLOCK => blocks(BlockFormat::Bc2, true),
        Format::BC3_UNORM_BLOCK => blocks(BlockFormat::Bc3, false),
        Format::BC3_SRGB_BLOCK => blocks(BlockFormat::Bc3, true),
        Format::BC4_UNORM_BLOCK => blocks(BlockFormat::Bc4 { signed: false }, false),
        Format::BC4_SNORM_BLOCK => blocks(BlockFormat::Bc4 { signed: true }, false),
        Format::BC5_UNORM_BLOCK => blocks(BlockFormat::Bc5 { signed: false }, false),
        Format::BC5_SNORM_BLOCK => blocks(BlockFormat::Bc5 { signed: true }, false),
        Format::BC6H_UFLOAT_BLOCK => blocks(BlockFormat::Bc6h { signed: false }, false),
        Format::BC6H_SFLOAT_BLOCK => blocks(BlockFormat::Bc6h { signed: true }, false),
        Format::BC7_UNORM_BLOCK => blocks(BlockFormat::Bc7, false),
        Format::BC7_SRGB_BLOCK => blocks(BlockFormat::Bc7, true),
        Format::R8_UNORM => samples(Sample::Unorm8, Order::R, false),
        Format::R8G8_UNORM => samples(Sample::Unorm8, Order::Rg, false),
        Format::R8G8B8_UNORM => samples(Sample::Unorm8, Order::Rgb, false),
        Format::R8G8B8_SRGB => samples(Sample::Unorm8, Order::Rgb, true),
        Format::B8G8R8_UNORM => samples(Sample::Unorm8, Order::Bgr, false),
        Format::B8G8R8_SRGB => samples(Sample::Unorm8, Order::Bgr, true),
        Format::R8G8B8A8_UNORM => samples(Sample::Unorm8, Order::Rgba, false),
        Format::R8G8B8A8_SRGB => samples(Sample::Unorm8, Order::Rgba, true),
        Format::B8G8R8A8_UNORM => samples(Sample::Unorm8, Order::Bgra, false),
        Format::B8G8R8A8_SRGB => samples(Sample::Unorm8, Order::Bgra, true),
        Format::R16_UNORM => samples(Sample::Unorm16, Order::R, false),
        Format::R16G16_UNORM => samples(Sample::Unorm16, Order::Rg, false),
        Format::R16G16B16A16_UNORM => samples(Sample::Unorm16, Order::Rgba, false),
        Format::R32_SFLOAT => samples(Sample::Float32, Order::R, false),
        Format::R32G32_SFLOAT => samples(Sample::Float32, Order::Rg, false),
        Format::R32G32B32A32_SFLOAT => samples(Sample::Float32, Order::Rgba, false),
        _ => None,
    }
}
