//! DDS files.

use ddsfile::{Caps2, D3DFormat, Dds, DxgiFormat, MiscFlag};

use super::block::BlockFormat;
use super::error::ImageError;
use super::texels::{Order, Sample, TexelFormat};
use super::{Channel, ImageOptions, level_size};
use crate::texture::Texture;

pub(super) fn read(bytes: &[u8], options: ImageOptions, level: u32) -> Result<Texture, ImageError> {
    let dds = Dds::read(bytes).map_err(ImageError::Dds)?;
    let shape = |what| Err(ImageError::Shape { what });
    if dds.header.depth.is_some_and(|depth| depth > 1) {
        return shape("a volume");
    }
    let newer = dds.header10.as_ref();
    if dds.header.caps2.contains(Caps2::CUBEMAP) || newer.is_some_and(|h| h.misc_flag.contains(MiscFlag::TEXTURECUBE)) {
        return shape("a cube map");
    }
    // The crate's own count of layers overflows where a file claims too many.
    if newer.is_some_and(|header| header.array_size > 1) {
        return shape("an array");
    }
    let (format, srgb, name) = format(&dds)?;
    if srgb && options.channel != Channel::Alpha {
        return Err(ImageError::SrgbColour { format: name });
    }
    let [full_width, full_height] = [dds.header.width, dds.header.height];
    let levels = dds.header.mip_map_count.unwrap_or(1).max(1);
    let (width, height) = level_size(full_width, full_height, level, levels)?;
    // Levels lie one after the other, the largest first. Beyond 32 there are none that differ.
    let before: u64 = (0..level.min(32))
        .filter_map(|level| level_size(full_width, full_height, level, levels).ok())
        .map(|(width, height)| format.bytes(width, height))
        .sum();
    let size = format.bytes(width, height);
    let range = usize::try_from(before).ok().zip(usize::try_from(before + size).ok());
    let data = range.and_then(|(start, end)| dds.data.get(start..end));
    let too_short = ImageError::Size { width: full_width, height: full_height, bytes: dds.data.len() };
    format.texture(width, height, options, data.ok_or(too_short)?)
}

/// The format, whether its colours are sRGB, and its name.
fn format(dds: &Dds) -> Result<(TexelFormat, bool, String), ImageError> {
    // Files of the older kind do not say whether they are sRGB.
    let older = if dds.header10.is_none() { dds.get_d3d_format() } else { None };
    let known = match (older, dds.get_dxgi_format()) {
        (Some(format), _) => d3d(format).map(|texels| (texels, false, format!("{format:?}"))),
        (None, Some(format)) => dxgi(format).map(|texels| (texels, is_srgb(format), format!("{format:?}"))),
        (None, None) => None,
    };
    let name = || match (older, dds.get_dxgi_format()) {
        (Some(format), _) => format!("{format:?}"),
        (None, Some(format)) => format!("{format:?}"),
        (None, None) => "unknown".to_owned(),
    };
    known.ok_or_else(|| ImageError::Format { format: name() })
}

const fn samples(sample: Sample, order: Order) -> Option<TexelFormat> {
    Some(TexelFormat::Samples { sample, order })
}

fn d3d(format: D3DFormat) -> Option<TexelFormat> {
    // Direct3D 9 names channels from the highest bits down, so the last one is stored first.
    match format {
        D3DFormat::DXT1 => Some(TexelFormat::Blocks(BlockFormat::Bc1 { punch_through: true })),
        D3DFormat::DXT2 | D3DFormat::DXT3 => Some(TexelFormat::Blocks(BlockFormat::Bc2)),
        D3DFormat::DXT4 | D3DFormat::DXT5 => Some(TexelFormat::Blocks(BlockFormat::Bc3)),
        D3DFormat::A8R8G8B8 => samples(Sample::Unorm8, Order::Bgra),
        D3DFormat::X8R8G8B8 => samples(Sample::Unorm8, Order::Bgrx),
        D3DFormat::A8B8G8R8 => samples(Sample::Unorm8, Order::Rgba),
        D3DFormat::X8B8G8R8 => samples(Sample::Unorm8, Order::Rgbx),
        D3DFormat::R8G8B8 => samples(Sample::Unorm8, Order::Bgr),
        D3DFormat::A8 => samples(Sample::Unorm8, Order::A),
        D3DFormat::L8 => samples(Sample::Unorm8, Order::L),
        D3DFormat::A8L8 => samples(Sample::Unorm8, Order::La),
        D3DFormat::L16 => samples(Sample::Unorm16, Order::L),
        D3DFormat::G16R16 => samples(Sample::Unorm16, Order::Rg),
        D3DFormat::A16B16G16R16 => samples(Sample::Unorm16, Order::Rgba),
        D3DFormat::R32F => samples(Sample::Float32, Order::R),
        D3DFormat::G32R32F => samples(Sample::Float32, Order::Rg),
        D3DFormat::A32B32G32R32F => samples(Sample::Float32, Order::Rgba),
        _ => None,
    }
}

fn dxgi(format: DxgiFormat) -> Option<TexelFormat> {
    let blocks = |format| Some(TexelFormat::Blocks(format));
    match format {
        DxgiFormat::BC1_UNorm | DxgiFormat::BC1_UNorm_sRGB => blocks(BlockFormat::Bc1 { punch_through: true }),
        DxgiFormat::BC2_UNorm | DxgiFormat::BC2_UNorm_sRGB => blocks(BlockFormat::Bc2),
        DxgiFormat::BC3_UNorm | DxgiFormat::BC3_UNorm_sRGB => blocks(BlockFormat::Bc3),
        DxgiFormat::BC4_UNorm => blocks(BlockFormat::Bc4 { signed: false }),
        DxgiFormat::BC4_SNorm => blocks(BlockFormat::Bc4 { signed: true }),
        DxgiFormat::BC5_UNorm => blocks(BlockFormat::Bc5 { signed: false }),
        DxgiFormat::BC5_SNorm => blocks(BlockFormat::Bc5 { signed: true }),
        DxgiFormat::BC6H_UF16 => blocks(BlockFormat::Bc6h { signed: false }),
        DxgiFormat::BC6H_SF16 => blocks(BlockFormat::Bc6h { signed: true }),
        DxgiFormat::BC7_UNorm | DxgiFormat::BC7_UNorm_sRGB => blocks(BlockFormat::Bc7),
        DxgiFormat::R8G8B8A8_UNorm | DxgiFormat::R8G8B8A8_UNorm_sRGB => samples(Sample::Unorm8, Order::Rgba),
        DxgiFormat::B8G8R8A8_UNorm | DxgiFormat::B8G8R8A8_UNorm_sRGB => samples(Sample::Unorm8, Order::Bgra),
        DxgiFormat::B8G8R8X8_UNorm | DxgiFormat::B8G8R8X8_UNorm_sRGB => samples(Sample::Unorm8, Order::Bgrx),
        DxgiFormat::R8_UNorm => samples(Sample::Unorm8, Order::R),
        DxgiFormat::A8_UNorm => samples(Sample::Unorm8, Order::A),
        DxgiFormat::R8G8_UNorm => samples(Sample::Unorm8, Order::Rg),
        DxgiFormat::R16_UNorm => samples(Sample::Unorm16, Order::R),
        DxgiFormat::R16G16_UNorm => samples(Sample::Unorm16, Order::Rg),
        DxgiFormat::R16G16B16A16_UNorm => samples(Sample::Unorm16, Order::Rgba),
        DxgiFormat::R32_Float => samples(Sample::Float32, Order::R),
        DxgiFormat::R32G32_Float => samples(Sample::Float32, Order::Rg),
        DxgiFormat::R32G32B32_Float => samples(Sample::Float32, Order::Rgb),
        DxgiFormat::R32G32B32A32_Float => samples(Sample::Float32, Order::Rgba),
        _ => None,
    }
}

const fn is_srgb(format: DxgiFormat) -> bool {
    matches!(
        format,
        DxgiFormat::BC1_UNorm_sRGB
            | DxgiFormat::BC2_UNorm_sRGB
            | DxgiFormat::BC3_UNorm_sRGB
            | DxgiFormat::BC7_UNorm_sRGB
            | DxgiFormat::R8G8B8A8_UNorm_sRGB
            | DxgiFormat::B8G8R8A8_UNorm_sRGB
            | DxgiFormat::B8G8R8X8_UNorm_sRGB
    )
}
