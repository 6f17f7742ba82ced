//! PNG, JPEG and TGA.

use std::io::Cursor;

use image::codecs::jpeg::JpegDecoder;
use image::codecs::png::PngDecoder;
use image::codecs::tga::TgaDecoder;
use image::{DynamicImage, ImageDecoder};

use super::error::ImageError;
use super::{Channel, ImageOptions, level_size};
use crate::texture::Texture;

pub(super) fn read(bytes: &[u8], options: ImageOptions, level: u32) -> Result<Texture, ImageError> {
    let image = match bytes {
        [0x89, b'P', b'N', b'G', ..] => decode(PngDecoder::new(Cursor::new(bytes)), bytes, level, png_can_hold),
        [0xff, 0xd8, 0xff, ..] => decode(JpegDecoder::new(Cursor::new(bytes)), bytes, level, jpeg_can_hold),
        _ if is_tga(bytes) => decode(TgaDecoder::new(Cursor::new(bytes)), bytes, level, tga_can_hold),
        _ => return Err(ImageError::Kind { start: bytes.iter().take(8).copied().collect() }),
    }?;
    texture(&image, options.channel)
}

/// Whether `bytes` start as a TGA file does, which has no magic number: a type of image and a depth that there are.
fn is_tga(bytes: &[u8]) -> bool {
    matches!(bytes, [_, 0 | 1, 1..=3 | 9..=11, _, _, _, _, _, _, _, _, _, _, _, _, _, 8 | 15 | 16 | 24 | 32, _, ..])
}

fn decode<D: ImageDecoder>(
    decoder: Result<D, image::ImageError>,
    bytes: &[u8],
    level: u32,
    least: impl FnOnce(u64, u64) -> u64,
) -> Result<DynamicImage, ImageError> {
    let decoder = decoder.map_err(ImageError::Raster)?;
    let (width, height) = decoder.dimensions();
    level_size(width, height, level, 1)?;
    // A size is a claim: before memory is taken for it, the file must be long enough to hold it.
    if least(width.into(), height.into()) > bytes.len() as u64 {
        return Err(ImageError::Size { width, height, bytes: bytes.len() });
    }
    DynamicImage::from_decoder(decoder).map_err(ImageError::Raster)
}

/// The least bytes that a PNG of this size can have: its rows, compressed as well as deflate can, which is 1032 to 1.
///
/// One bit a pixel is the least that a row holds, and every row starts with a byte of its own.
fn png_can_hold(width: u64, height: u64) -> u64 {
    (width / 8 + 1).saturating_mul(height) / 1032
}

/// The least bytes that a JPEG of this size can have: one bit for every block of 8 x 8 pixels.
fn jpeg_can_hold(width: u64, height: u64) -> u64 {
    width.saturating_mul(height) / 512
}

/// The least bytes that a TGA of this size can have: two for a run of 128 pixels.
fn tga_can_hold(width: u64, height: u64) -> u64 {
    width.saturating_mul(height) / 64
}

fn texture(image: &DynamicImage, channel: Channel) -> Result<Texture, ImageError> {
    let (width, height) = (image.width(), image.height());
    let channels = usize::from(image.color().channel_count());
    let Some(position) = position(channels, channel) else {
        return Ok(Texture::unorm8(width, height, vec![255; width as usize * height as usize])?);
    };
    if let Some(samples) = image.as_flat_samples_u8() {
        let values = samples.samples.iter().skip(position).step_by(channels);
        return Ok(Texture::unorm8(width, height, values.copied().collect())?);
    }
    match image.as_flat_samples_u16() {
        Some(samples) => {
            let values = samples.samples.iter().skip(position).step_by(channels);
            Ok(Texture::fp32(width, height, values.map(|&value| f32::from(value) / 65_535.0).collect())?)
        }
        None => Err(ImageError::Format { format: format!("{:?}", image.color()) }),
    }
}

/// Where a channel is among those of a pixel; `None` for alpha that there is not. Grey is red, green and blue.
fn position(channels: usize, channel: Channel) -> Option<usize> {
    match (channels, channel) {
        (1 | 3, Channel::Alpha) => None,
        (1 | 2, Channel::Red | Channel::Green | Channel::Blue) => Some(0),
        (2, Channel::Alpha) => Some(1),
        _ => Some(channel as usize),
    }
}

#[cfg(test)]
mod tests {
    use image::{GrayImage, ImageFormat, LumaA, Rgb, RgbImage, Rgba, RgbaImage};

    use super::*;

    fn encoded(image: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.into().write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    fn channel(bytes: &[u8], channel: Channel) -> Texture {
        read(bytes, ImageOptions { channel, ..ImageOptions::default() }, 0).unwrap()
    }

    #[test]
    fn every_channel_of_every_kind() {
        let rgba = RgbaImage::from_fn(3, 2, |x, y| Rgba([10, 20, 30 + x as u8, (10 * x + y) as u8]));
        for format in [ImageFormat::Png, ImageFormat::Tga] {
            let bytes = encoded(rgba.clone(), format);
            let found = [Channel::Red, Channel::Green, Channel::Blue, Channel::Alpha]
                .map(|which| channel(&bytes, which).alpha(2, 1).map(|value| (value * 255.0).round()));
            assert_eq!(found, [10.0, 20.0, 32.0, 21.0].map(Some), "{format:?}");
        }
        let deep = encoded(DynamicImage::from(rgba).into_rgba16(), ImageFormat::Png);
        let texture = channel(&deep, Channel::Alpha);
        assert_eq!((texture.width(), texture.height()), (3, 2));
        assert_eq!(texture.alpha(2, 1), Some(f64::from((21 * 257) as f32 / 65_535.0)));
        let grey_alpha = image::ImageBuffer::from_pixel(2, 2, LumaA([7_u8, 9]));
        let bytes = encoded(DynamicImage::ImageLumaA8(grey_alpha), ImageFormat::Png);
        assert_eq!(channel(&bytes, Channel::Blue).alpha(1, 1), Some(7.0 / 255.0));
        assert_eq!(channel(&bytes, Channel::Alpha).alpha(1, 1), Some(9.0 / 255.0));
    }

    #[test]
    fn images_without_alpha_are_opaque() {
        for format in [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Tga] {
            let opaque = channel(&encoded(GrayImage::new(5, 4), format), Channel::Alpha);
            assert_eq!((opaque.height(), opaque.alpha(4, 3)), (4, Some(1.0)));
        }
        let grey = RgbImage::from_pixel(16, 16, Rgb([200, 200, 200]));
        let red = channel(&encoded(grey, ImageFormat::Jpeg), Channel::Red).alpha(3, 3).unwrap();
        assert!((red - 200.0 / 255.0).abs() < 0.02, "{red}");
    }

    #[test]
    fn other_kinds_are_named_by_their_first_bytes() {
        let text = |bytes| read(bytes, ImageOptions::default(), 0).unwrap_err().to_string();
        assert_eq!(
            text(b"RIFF....WEBPVP8L................"),
            "not a PNG, JPEG, TGA, DDS or KTX2 image: it starts with [52, 49, 46, 46, 2e, 2e, 2e, 2e]"
        );
        assert_eq!(text(b""), "not a PNG, JPEG, TGA, DDS or KTX2 image: it starts with []");
        let png = encoded(GrayImage::new(2, 2), ImageFormat::Png);
        let level = read(&png, ImageOptions::default(), 1).unwrap_err();
        assert_eq!(level.to_string(), "there is no mip level 1: the image has 1");
    }

    #[test]
    fn truncated_images_are_refused() {
        let image = RgbaImage::from_fn(40, 40, |x, y| Rgba([0, 0, 0, (x * y) as u8]));
        for format in [ImageFormat::Png, ImageFormat::Tga] {
            let whole = encoded(image.clone(), format);
            // The last 16 bytes of a PNG say only that it ends.
            for end in 0..whole.len() - 16 {
                assert!(read(&whole[..end], ImageOptions::default(), 0).is_err(), "{format:?} {end}");
            }
        }
    }

    #[test]
    fn a_size_that_the_file_cannot_hold_takes_no_memory() {
        let text = |result: Result<DynamicImage, ImageError>| result.unwrap_err().to_string();
        let claim = |width, height| decode(Ok(Claim(width, height)), &[0; 100], 0, png_can_hold);
        assert_eq!(text(claim(16_000, 16_000)), "16000 x 16000 pixels are claimed, more than 100 bytes can hold");
        assert_eq!(
            text(claim(65_000, 65_000)),
            "an image of 65000 x 65000 texels is too large: no more than 268435456 texels are read"
        );
        let mut tga = vec![0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x10, 0, 0x10, 32, 8];
        tga.extend([0; 100]);
        let error = read(&tga, ImageOptions::default(), 0).unwrap_err().to_string();
        assert_eq!(error, "4096 x 4096 pixels are claimed, more than 118 bytes can hold");
    }

    /// A decoder that claims a size and has nothing.
    struct Claim(u32, u32);

    impl ImageDecoder for Claim {
        fn dimensions(&self) -> (u32, u32) {
            (self.0, self.1)
        }
        fn color_type(&self) -> image::ColorType {
            image::ColorType::Rgba8
        }
        fn read_image(self, _: &mut [u8]) -> image::ImageResult<()> {
            panic!("nothing is to be decoded")
        }
        fn read_image_boxed(self: Box<Self>, _: &mut [u8]) -> image::ImageResult<()> {
            panic!("nothing is to be decoded")
        }
    }
}
