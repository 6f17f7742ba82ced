//! The alpha channel of a PNG or JPEG image.

use std::io::Cursor;

use image::codecs::jpeg::JpegDecoder;
use image::codecs::png::PngDecoder;
use image::{DynamicImage, ImageDecoder, ImageError, RgbImage};

use super::error::GltfErrorKind;
use crate::texture::Texture;

/// The alpha channel of an image file. An image without one is opaque.
///
/// 16-bit alpha becomes the `f32` nearest to the value divided by 65535.
pub(super) fn alpha(bytes: &[u8]) -> Result<Texture, GltfErrorKind> {
    let image = read(bytes)?;
    let (width, height) = (image.width(), image.height());
    let texture = match image {
        DynamicImage::ImageRgba8(image) => {
            Texture::unorm8(width, height, image.pixels().map(|pixel| pixel.0[3]).collect())
        }
        DynamicImage::ImageLumaA8(image) => {
            Texture::unorm8(width, height, image.pixels().map(|pixel| pixel.0[1]).collect())
        }
        DynamicImage::ImageRgba16(image) => {
            Texture::fp32(width, height, image.pixels().map(|pixel| unorm16(pixel.0[3])).collect())
        }
        DynamicImage::ImageLumaA16(image) => {
            Texture::fp32(width, height, image.pixels().map(|pixel| unorm16(pixel.0[1])).collect())
        }
        opaque => Texture::unorm8(width, height, vec![255; opaque.width() as usize * opaque.height() as usize]),
    };
    Ok(texture?)
}

/// The colours of an image file, 8 bits a channel.
pub(super) fn colours(bytes: &[u8]) -> Result<RgbImage, GltfErrorKind> {
    Ok(read(bytes)?.into_rgb8())
}

fn read(bytes: &[u8]) -> Result<DynamicImage, GltfErrorKind> {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => decode(PngDecoder::new(Cursor::new(bytes)), bytes, png_can_hold),
        [0xff, 0xd8, 0xff, ..] => decode(JpegDecoder::new(Cursor::new(bytes)), bytes, jpeg_can_hold),
        _ => Err(GltfErrorKind::ImageFormat { start: bytes.iter().take(8).copied().collect() }),
    }
}

fn unorm16(value: u16) -> f32 {
    f32::from(value) / 65_535.0
}

fn decode<D: ImageDecoder>(
    decoder: Result<D, ImageError>,
    bytes: &[u8],
    can_hold: impl FnOnce(u64, u64, &D) -> u64,
) -> Result<DynamicImage, GltfErrorKind> {
    let decoder = decoder.map_err(GltfErrorKind::Image)?;
    let (width, height) = decoder.dimensions();
    // A size is a claim: before memory is taken for it, the file must be long enough to hold it.
    if can_hold(width.into(), height.into(), &decoder) > bytes.len() as u64 {
        return Err(GltfErrorKind::ImageSize { width, height, bytes: bytes.len() });
    }
    DynamicImage::from_decoder(decoder).map_err(GltfErrorKind::Image)
}

/// The least bytes that a PNG of this size can have: its rows, compressed as well as deflate can, which is 1032 to 1.
///
/// One bit a pixel is the least that a row holds, and every row starts with a byte of its own.
fn png_can_hold<D>(width: u64, height: u64, _: &D) -> u64 {
    (width / 8 + 1).saturating_mul(height) / 1032
}

/// The least bytes that a JPEG of this size can have: one bit for every block of 8 x 8 pixels.
fn jpeg_can_hold<D>(width: u64, height: u64, _: &D) -> u64 {
    width.saturating_mul(height) / 512
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{GrayImage, ImageFormat, Rgba, RgbaImage};

    fn encoded(image: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.into().write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn alpha_channels() {
        let rgba = RgbaImage::from_fn(3, 2, |x, y| Rgba([1, 2, 3, (10 * x + y) as u8]));
        let texture = alpha(&encoded(rgba.clone(), ImageFormat::Png)).unwrap();
        assert_eq!((texture.width(), texture.height(), texture.alpha(2, 1)), (3, 2, Some(21.0 / 255.0)));
        let deep = alpha(&encoded(DynamicImage::from(rgba).into_rgba16(), ImageFormat::Png)).unwrap();
        assert_eq!(deep.alpha(2, 1), Some(f64::from((21 * 257) as f32 / 65_535.0)));
        for format in [ImageFormat::Png, ImageFormat::Jpeg] {
            let opaque = alpha(&encoded(GrayImage::new(5, 4), format)).unwrap();
            assert_eq!((opaque.height(), opaque.alpha(4, 3)), (4, Some(1.0)));
        }
    }

    #[test]
    fn other_formats_are_named_by_their_first_bytes() {
        let error = alpha(b"RIFF....WEBP").unwrap_err().to_string();
        assert_eq!(error, "neither a PNG nor a JPEG image: it starts with [52, 49, 46, 46, 2e, 2e, 2e, 2e]");
        assert!(alpha(b"").is_err());
    }

    #[test]
    fn truncated_images_are_refused() {
        let whole = encoded(RgbaImage::from_fn(40, 40, |x, y| Rgba([0, 0, 0, (x * y) as u8])), ImageFormat::Png);
        for end in 0..whole.len() - 16 {
            assert!(alpha(&whole[..end]).is_err(), "{end}");
        }
    }

    #[test]
    fn a_size_that_the_file_cannot_hold_takes_no_memory() {
        let mut claims = encoded(RgbaImage::new(1, 1), ImageFormat::Png);
        // The width and height of the header, and the header's checksum, which the claim makes wrong.
        claims[16..24].copy_from_slice(&[0, 0, 0xff, 0, 0, 0, 0xff, 0]);
        assert!(alpha(&claims).is_err());
        let text = decode(Ok(Claim), &[0; 100], png_can_hold).unwrap_err().to_string();
        assert_eq!(text, "65000 x 65000 pixels are claimed, more than 100 bytes can hold");
    }

    /// A decoder that claims a size and has nothing.
    struct Claim;

    impl ImageDecoder for Claim {
        fn dimensions(&self) -> (u32, u32) {
            (65_000, 65_000)
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
