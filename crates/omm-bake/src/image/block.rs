//! Block-compressed texels: one channel of BC1 to BC7.
//!
//! BC1 to BC5 are decoded here, in the exact fractions of the [Khronos data format specification][1]: libraries round them to
//! 8 bits, which a device does not. BC6H and BC7 are integers by specification and come from the crate `bcdec_rs`.
//!
//! [1]: https://registry.khronos.org/DataFormat/specs/1.3/dataformat.1.3.html#S3TC

use super::error::ImageError;
use super::{BlockDecoding, Channel, ImageOptions};
use crate::texture::Texture;

mod nvidia;

/// A block-compressed format, without its transfer function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BlockFormat {
    /// With punch-through alpha, or without.
    Bc1 {
        punch_through: bool,
    },
    Bc2,
    Bc3,
    Bc4 {
        signed: bool,
    },
    Bc5 {
        signed: bool,
    },
    Bc6h {
        signed: bool,
    },
    Bc7,
}

impl BlockFormat {
    pub(super) const fn bytes(self) -> usize {
        match self {
            Self::Bc1 { .. } | Self::Bc4 { .. } => 8,
            Self::Bc2 | Self::Bc3 | Self::Bc5 { .. } | Self::Bc6h { .. } | Self::Bc7 => 16,
        }
    }
}

/// The numerators of a block's texels.
type Fractions = fn(&[u8]) -> [i32; 16];

/// How one channel of a block is decoded.
enum Decoder {
    /// The same for all texels.
    Constant(u8),
    /// Numerators over a common denominator.
    Fractions { denominator: i32, decode: Fractions },
    /// Numbers as they are.
    Floats(fn(&[u8], usize) -> [f32; 16], usize),
}

/// One channel of a level; `data` has whole blocks, as many as it needs.
pub(super) fn texture(
    format: BlockFormat,
    width: u32,
    height: u32,
    options: ImageOptions,
    data: &[u8],
) -> Result<Texture, ImageError> {
    let blocks = Blocks { width: width as usize, height: height as usize, bytes: format.bytes(), data };
    let (specified, measured) = (decoder(format, options.channel), nvidia(format, options.channel));
    match (options.block_decoding, measured) {
        (BlockDecoding::Specification, _) | (_, None) => decoded(specified, &blocks),
        (BlockDecoding::Nvidia, Some(measured)) => decoded(measured, &blocks),
        (BlockDecoding::All, Some(measured)) => {
            let reading = decoded(measured, &blocks)?;
            Ok(decoded(specified, &blocks)?.with_readings(vec![reading])?)
        }
    }
}

/// The texture that a decoder makes of all blocks.
fn decoded(decoder: Decoder, blocks: &Blocks<'_>) -> Result<Texture, ImageError> {
    let (width, height) = (blocks.width as u32, blocks.height as u32);
    let texture = match decoder {
        Decoder::Constant(value) => Texture::unorm8(width, height, vec![value; blocks.texels()]),
        Decoder::Floats(decode, component) => {
            Texture::fp32(width, height, blocks.texels_of(|block| decode(block, component), |value| value))
        }
        Decoder::Fractions { denominator, decode } => {
            // Whole 255ths need a byte, and no rounding.
            let step = denominator / 255;
            let whole = |block: &[u8]| decode(block).into_iter().all(|value| value >= 0 && value % step == 0);
            if denominator % 255 == 0 && blocks.data.chunks_exact(blocks.bytes).all(whole) {
                Texture::unorm8(width, height, blocks.texels_of(decode, |value| (value / step) as u8))
            } else {
                // The quotient of such small integers is so far from a tie of f32 that rounding twice is rounding once.
                let round = |value| (f64::from(value) / f64::from(denominator)) as f32;
                Texture::fp32(width, height, blocks.texels_of(decode, round))
            }
        }
    };
    Ok(texture?)
}

/// The decoders that are NVIDIA's own.
fn nvidia(format: BlockFormat, channel: Channel) -> Option<Decoder> {
    let (denominator, decode): (_, Fractions) = match (format, channel) {
        (BlockFormat::Bc3, Channel::Alpha) => (255, nvidia::bc3),
        (BlockFormat::Bc4 { signed: false } | BlockFormat::Bc5 { signed: false }, Channel::Red) => {
            (65_535, nvidia::bc4)
        }
        (BlockFormat::Bc5 { signed: false }, Channel::Green) => (65_535, |block| nvidia::bc4(second(block))),
        _ => return None,
    };
    Some(Decoder::Fractions { denominator, decode })
}

fn decoder(format: BlockFormat, channel: Channel) -> Decoder {
    use Channel::{Alpha, Blue, Green, Red};
    let unsigned = |decode| Decoder::Fractions { denominator: 255 * SEVENTHS_AND_FIFTHS, decode };
    let signed = |decode| Decoder::Fractions { denominator: 127 * SEVENTHS_AND_FIFTHS, decode };
    let bytes = |decode| Decoder::Fractions { denominator: 255, decode };
    match (format, channel) {
        (BlockFormat::Bc1 { punch_through: true }, Alpha) => bytes(punch_through),
        (BlockFormat::Bc1 { .. } | BlockFormat::Bc6h { .. }, Alpha) => Decoder::Constant(255),
        (BlockFormat::Bc4 { .. } | BlockFormat::Bc5 { .. }, Alpha) => Decoder::Constant(255),
        (BlockFormat::Bc2, Alpha) => bytes(four_bits),
        (BlockFormat::Bc3, Alpha) => unsigned(|block| interpolated(block, unsigned_ends)),
        (BlockFormat::Bc4 { signed: false } | BlockFormat::Bc5 { signed: false }, Red) => {
            unsigned(|block| interpolated(block, unsigned_ends))
        }
        (BlockFormat::Bc4 { signed: true } | BlockFormat::Bc5 { signed: true }, Red) => {
            signed(|block| interpolated(block, signed_ends))
        }
        (BlockFormat::Bc5 { signed: false }, Green) => unsigned(|block| interpolated(second(block), unsigned_ends)),
        (BlockFormat::Bc5 { signed: true }, Green) => signed(|block| interpolated(second(block), signed_ends)),
        (BlockFormat::Bc4 { .. }, Green | Blue) | (BlockFormat::Bc5 { .. }, Blue) => Decoder::Constant(0),
        (BlockFormat::Bc1 { .. }, Red) => colour(31, |block| colours(block, true, red)),
        (BlockFormat::Bc1 { .. }, Green) => colour(63, |block| colours(block, true, green)),
        (BlockFormat::Bc1 { .. }, Blue) => colour(31, |block| colours(block, true, blue)),
        (BlockFormat::Bc2 | BlockFormat::Bc3, Red) => colour(31, |block| colours(second(block), false, red)),
        (BlockFormat::Bc2 | BlockFormat::Bc3, Green) => colour(63, |block| colours(second(block), false, green)),
        (BlockFormat::Bc2 | BlockFormat::Bc3, Blue) => colour(31, |block| colours(second(block), false, blue)),
        (BlockFormat::Bc7, Red) => bytes(|block| bc7(block, 0)),
        (BlockFormat::Bc7, Green) => bytes(|block| bc7(block, 1)),
        (BlockFormat::Bc7, Blue) => bytes(|block| bc7(block, 2)),
        (BlockFormat::Bc7, Alpha) => bytes(|block| bc7(block, 3)),
        (BlockFormat::Bc6h { signed: false }, component) => {
            Decoder::Floats(|block, component| bc6h(block, component, false), component as usize)
        }
        (BlockFormat::Bc6h { signed: true }, component) => {
            Decoder::Floats(|block, component| bc6h(block, component, true), component as usize)
        }
    }
}

/// Colours of 5 or 6 bits, of which a half and a third are taken.
fn colour(most: i32, decode: Fractions) -> Decoder {
    Decoder::Fractions { denominator: most * HALVES_AND_THIRDS, decode }
}

/// The blocks of a level, row by row.
struct Blocks<'a> {
    width: usize,
    height: usize,
    /// Bytes of a block.
    bytes: usize,
    data: &'a [u8],
}

impl Blocks<'_> {
    fn texels(&self) -> usize {
        self.width * self.height
    }

    /// The texels, without those of the last blocks that lie outside.
    fn texels_of<V: Copy, T: Copy + Default>(
        &self,
        decode: impl Fn(&[u8]) -> [V; 16],
        texel: impl Fn(V) -> T,
    ) -> Vec<T> {
        let mut texels = vec![T::default(); self.texels()];
        let rows = texels.chunks_mut(4 * self.width);
        for (rows, blocks) in rows.zip(self.data.chunks_exact(self.width.div_ceil(4) * self.bytes)) {
            for (column, block) in blocks.chunks_exact(self.bytes).enumerate() {
                let values = decode(block);
                for (row, values) in rows.chunks_mut(self.width).zip(values.as_chunks::<4>().0) {
                    let row = row.get_mut(4 * column..).unwrap_or_default();
                    row.iter_mut().zip(values).for_each(|(to, &value)| *to = texel(value));
                }
            }
        }
        texels
    }
}

/// The second half of a block of 16 bytes.
fn second(block: &[u8]) -> &[u8] {
    block.get(8..).unwrap_or_default()
}

/// Little-endian bytes, from `start` on, as an integer.
fn little_endian(block: &[u8], start: usize, bytes: usize) -> u64 {
    let bytes = block.iter().skip(start).take(bytes);
    bytes.rev().fold(0, |value, &byte| value << 8 | u64::from(byte))
}

/// What `per_texel` bits, the lowest first, say of each of 16 texels.
fn codes(bits: u64, per_texel: u32) -> [usize; 16] {
    std::array::from_fn(|texel| (bits >> (texel as u32 * per_texel)) as usize & ((1 << per_texel) - 1))
}

/// BC2 alpha: 4 bits a texel, which are fifteenths.
fn four_bits(block: &[u8]) -> [i32; 16] {
    codes(little_endian(block, 0, 8), 4).map(|code| code as i32 * 17)
}

/// The least denominator of the fractions of [`interpolated`].
const SEVENTHS_AND_FIFTHS: i32 = 35;

/// BC3 alpha and BC4: 3 bits a texel choose one of 8 values, in 35ths of a step.
fn interpolated(block: &[u8], ends: fn([u8; 2]) -> Ends) -> [i32; 16] {
    let Ends { a, b, wide, least, most } = ends(*block.first_chunk().unwrap_or(&[0; 2]));
    let value = |code: i32| match (wide, code) {
        (_, 0) => 35 * a,
        (_, 1) => 35 * b,
        (true, _) => 5 * ((8 - code) * a + (code - 1) * b),
        (false, 6) => 35 * least,
        (false, 7) => 35 * most,
        (false, _) => 7 * ((6 - code) * a + (code - 1) * b),
    };
    let values: [i32; 8] = std::array::from_fn(|code| value(code as i32));
    codes(little_endian(block, 2, 6), 3).map(|code| values.get(code).copied().unwrap_or_default())
}

/// The ends of an interpolation.
struct Ends {
    a: i32,
    b: i32,
    /// Whether the six other values lie between the ends; otherwise four do, and the last two are the extremes.
    wide: bool,
    least: i32,
    most: i32,
}

fn unsigned_ends([a, b]: [u8; 2]) -> Ends {
    Ends { a: a.into(), b: b.into(), wide: a > b, least: 0, most: 255 }
}

fn signed_ends(ends: [u8; 2]) -> Ends {
    let [a, b] = ends.map(u8::cast_signed);
    // -128 counts as -127, which is -1.
    let number = |value: i8| i32::from(value).max(-127);
    Ends { a: number(a), b: number(b), wide: a > b, least: -127, most: 127 }
}

/// The least denominator of the fractions of [`colours`].
const HALVES_AND_THIRDS: i32 = 6;

/// Colours of a BC1 block, in sixths of a step: 2 bits a texel choose one of 4. Only in BC1 the order of the ends says that there
/// are three and black; in BC2 and BC3 there are always four.
fn colours(block: &[u8], may_be_three: bool, component: fn(i32) -> i32) -> [i32; 16] {
    let [first, second] = [0, 2].map(|start| little_endian(block, start, 2) as i32);
    let (a, b) = (component(first), component(second));
    let values = if first > second || !may_be_three {
        [6 * a, 6 * b, 4 * a + 2 * b, 2 * a + 4 * b]
    } else {
        [6 * a, 6 * b, 3 * a + 3 * b, 0]
    };
    codes(little_endian(block, 4, 4), 2).map(|code| values.get(code).copied().unwrap_or_default())
}

fn red(colour: i32) -> i32 {
    colour >> 11
}

fn green(colour: i32) -> i32 {
    colour >> 5 & 63
}

fn blue(colour: i32) -> i32 {
    colour & 31
}

/// BC1 alpha: black of a block of three colours is transparent.
fn punch_through(block: &[u8]) -> [i32; 16] {
    let three = little_endian(block, 0, 2) <= little_endian(block, 2, 2);
    codes(little_endian(block, 4, 4), 2).map(|code| if three && code == 3 { 0 } else { 255 })
}

fn bc7(block: &[u8], component: usize) -> [i32; 16] {
    let mut texels = [0_u8; 64];
    bcdec_rs::bc7(block, &mut texels, 16);
    std::array::from_fn(|texel| texels.get(4 * texel + component).copied().unwrap_or_default().into())
}

fn bc6h(block: &[u8], component: usize, signed: bool) -> [f32; 16] {
    let mut texels = [0_f32; 48];
    bcdec_rs::bc6h_float(block, &mut texels, 12, signed);
    std::array::from_fn(|texel| texels.get(3 * texel + component).copied().unwrap_or_default())
}

#[cfg(test)]
mod tests;
