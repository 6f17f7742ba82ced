//! The texel formats of DDS and KTX2 files, and one channel of their data.

use super::block::{self, BlockFormat};
use super::error::ImageError;
use super::{Channel, ImageOptions};
use crate::texture::Texture;

/// How texels are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TexelFormat {
    /// Blocks of 4 x 4.
    Blocks(BlockFormat),
    /// One by one.
    Samples { sample: Sample, order: Order },
}

/// What a channel of an uncompressed texel is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sample {
    Unorm8,
    Unorm16,
    Float32,
}

/// Which channels an uncompressed texel has, in the order in which they are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    R,
    Rg,
    Rgb,
    Bgr,
    Rgba,
    Bgra,
    /// The fourth is there, but reads as 1.
    Bgrx,
    Rgbx,
    A,
    /// Grey, which is red, green and blue.
    L,
    La,
}

/// Where a channel of a texel comes from.
enum Source {
    Position(usize),
    /// Channels that a format lacks: 0 for colours, 1 for alpha.
    Constant(u8),
}

impl Order {
    const fn channels(self) -> usize {
        match self {
            Self::R | Self::A | Self::L => 1,
            Self::Rg | Self::La => 2,
            Self::Rgb | Self::Bgr => 3,
            Self::Rgba | Self::Bgra | Self::Bgrx | Self::Rgbx => 4,
        }
    }

    fn source(self, channel: Channel) -> Source {
        let letters = match self {
            Self::R => "r",
            Self::Rg => "rg",
            Self::Rgb | Self::Rgbx => "rgb",
            Self::Bgr | Self::Bgrx => "bgr",
            Self::Rgba => "rgba",
            Self::Bgra => "bgra",
            Self::A => "a",
            Self::L => "l",
            Self::La => "la",
        };
        let letter = match channel {
            Channel::Red => 'r',
            Channel::Green => 'g',
            Channel::Blue => 'b',
            Channel::Alpha => 'a',
        };
        let found = letters.find(letter).or_else(|| letters.find('l').filter(|_| channel != Channel::Alpha));
        found.map_or(Source::Constant(if channel == Channel::Alpha { 255 } else { 0 }), Source::Position)
    }
}

impl Sample {
    const fn size(self) -> usize {
        match self {
            Self::Unorm8 => 1,
            Self::Unorm16 => 2,
            Self::Float32 => 4,
        }
    }
}

impl TexelFormat {
    /// Bytes of a level of this size, without gaps.
    pub(super) fn bytes(self, width: u32, height: u32) -> u64 {
        let [width, height] = [width, height].map(u64::from);
        match self {
            Self::Blocks(format) => width.div_ceil(4) * height.div_ceil(4) * format.bytes() as u64,
            Self::Samples { sample, order } => width * height * (sample.size() * order.channels()) as u64,
        }
    }

    /// The channel of `options` of a level of this size. `data` has as many bytes as [`bytes`](Self::bytes) says.
    pub(super) fn texture(
        self,
        width: u32,
        height: u32,
        options: ImageOptions,
        data: &[u8],
    ) -> Result<Texture, ImageError> {
        let (sample, order) = match self {
            Self::Blocks(format) => return block::texture(format, width, height, options, data),
            Self::Samples { sample, order } => (sample, order),
        };
        let position = match order.source(options.channel) {
            Source::Position(position) => position * sample.size(),
            Source::Constant(value) => {
                return Ok(Texture::unorm8(width, height, vec![value; width as usize * height as usize])?);
            }
        };
        let samples = data.chunks_exact(sample.size() * order.channels()).filter_map(|texel| texel.get(position..));
        let floats = |value: fn(&[u8]) -> Option<f32>| samples.clone().filter_map(value).collect();
        Ok(match sample {
            Sample::Unorm8 => Texture::unorm8(width, height, samples.filter_map(|s| s.first().copied()).collect()),
            Sample::Unorm16 => {
                let value = |sample: &[u8]| Some(f32::from(u16::from_le_bytes(*sample.first_chunk()?)) / 65_535.0);
                Texture::fp32(width, height, floats(value))
            }
            Sample::Float32 => {
                Texture::fp32(width, height, floats(|sample| Some(f32::from_le_bytes(*sample.first_chunk()?))))
            }
        }?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options(channel: Channel) -> ImageOptions {
        ImageOptions { channel, ..ImageOptions::default() }
    }

    #[test]
    fn channels_that_are_absent_are_0_or_1() {
        let value = |order, channel, data: &[u8]| {
            let format = TexelFormat::Samples { sample: Sample::Unorm8, order };
            assert_eq!(format.bytes(1, 1), data.len() as u64);
            format.texture(1, 1, options(channel), data).unwrap().alpha(0, 0).map(|value| (value * 255.0).round())
        };
        assert_eq!(value(Order::Bgra, Channel::Red, &[1, 2, 3, 4]), Some(3.0));
        assert_eq!(value(Order::Bgra, Channel::Alpha, &[1, 2, 3, 4]), Some(4.0));
        assert_eq!(value(Order::Bgrx, Channel::Alpha, &[1, 2, 3, 4]), Some(255.0));
        assert_eq!(value(Order::R, Channel::Green, &[9]), Some(0.0));
        assert_eq!(value(Order::A, Channel::Red, &[9]), Some(0.0));
        assert_eq!(value(Order::La, Channel::Blue, &[5, 6]), Some(5.0));
        assert_eq!(value(Order::La, Channel::Alpha, &[5, 6]), Some(6.0));
        assert_eq!(value(Order::L, Channel::Alpha, &[5]), Some(255.0));
    }

    #[test]
    fn wider_samples() {
        let format = |sample| TexelFormat::Samples { sample, order: Order::Rg };
        let wide = format(Sample::Unorm16).texture(1, 1, options(Channel::Green), &[0, 0, 0x33, 0x33]).unwrap();
        assert_eq!(wide.alpha(0, 0), Some(f64::from(0.2_f32)));
        let bytes = [0.0_f32, -2.5].map(f32::to_le_bytes).concat();
        let float = format(Sample::Float32).texture(1, 1, options(Channel::Green), &bytes).unwrap();
        assert_eq!(float.alpha(0, 0), Some(-2.5));
        let bytes = [0.0_f32, f32::NAN].map(f32::to_le_bytes).concat();
        assert!(format(Sample::Float32).texture(1, 1, options(Channel::Green), &bytes).is_err());
    }
}
