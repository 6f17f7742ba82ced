//! Pictures to look at: what a traced picture shows in each mode, alone or beside another.

use image::{Rgb, RgbImage};

use crate::heat;
use crate::trace::{OpacitySource, Picture};

/// What a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Colours in the light of the sun.
    Shaded,
    /// Any-hit calls for each pixel: black, blue, red, yellow, white.
    AnyHit,
    /// What decided about the surface: the geometry's flag grey, the micromap green, a shader pink where a micromap does not know and
    /// red where there is none.
    Source,
}

impl OpacitySource {
    /// Its colour in [`Mode::Source`].
    #[must_use]
    pub const fn colour(self) -> [u8; 3] {
        match self {
            Self::Miss => [16, 18, 24],
            Self::Geometry => [120, 124, 132],
            Self::Micromap => [66, 166, 88],
            Self::AnyHitUnknown => [236, 130, 190],
            Self::AnyHit => [206, 52, 48],
        }
    }
}

/// One picture. The scale of any-hit calls ends where only one pixel in a hundred is beyond it.
#[must_use]
pub fn single(picture: &Picture, mode: Mode) -> RgbImage {
    let most = most(picture);
    draw(picture.size, |pixel| picture.shows(mode, most, pixel))
}

/// Two pictures side by side: without micromaps and with them. The scale of any-hit calls is that of the first.
#[must_use]
pub fn pair(without: &Picture, with: &Picture, mode: Mode) -> RgbImage {
    let most = most(without);
    beside(&[without, with].map(|picture| draw(picture.size, |pixel| picture.shows(mode, most, pixel))))
}

/// Three pictures side by side: without micromaps, with them, and what differs: how far colours are apart, the any-hit calls that were
/// saved, or where the source is another, by its colour with micromaps. The scale of any-hit calls is that of the first.
///
/// Both must be of one size; what is missing of one is black.
#[must_use]
pub fn compared(without: &Picture, with: &Picture, mode: Mode) -> RgbImage {
    let most = most(without);
    let difference = |pixel: usize| match mode {
        Mode::Shaded => {
            let [a, b] = [without, with].map(|picture| picture.shows(mode, most, pixel));
            [0, 1, 2].map(|channel| a[channel].abs_diff(b[channel]))
        }
        Mode::AnyHit => {
            let [a, b] = [without, with].map(|picture| picture.any_hit_calls.get(pixel).copied().unwrap_or(0));
            heat::colour(a.saturating_sub(b), most)
        }
        Mode::Source => match [without, with].map(|picture| picture.sources.get(pixel)) {
            [Some(a), Some(b)] if a != b => b.colour(),
            _ => [0; 3],
        },
    };
    beside(&[pair(without, with, mode), draw(with.size, difference)])
}

/// Images one below the other.
#[must_use]
pub fn stacked(images: &[RgbImage]) -> RgbImage {
    let width = images.iter().map(RgbImage::width).max().unwrap_or(0);
    let mut sheet = RgbImage::new(width, images.iter().map(RgbImage::height).sum());
    let mut top = 0;
    for image in images {
        image::imageops::replace(&mut sheet, image, 0, top);
        top += i64::from(image.height());
    }
    sheet
}

/// Images from left to right.
fn beside(images: &[RgbImage]) -> RgbImage {
    let height = images.iter().map(RgbImage::height).max().unwrap_or(0);
    let mut sheet = RgbImage::new(images.iter().map(RgbImage::width).sum(), height);
    let mut left = 0;
    for image in images {
        image::imageops::replace(&mut sheet, image, left, 0);
        left += i64::from(image.width());
    }
    sheet
}

fn draw([width, height]: [u32; 2], colour: impl Fn(usize) -> [u8; 3]) -> RgbImage {
    RgbImage::from_fn(width, height, |x, y| Rgb(colour(y as usize * width as usize + x as usize)))
}

/// The end of the scale of any-hit calls.
fn most(picture: &Picture) -> u32 {
    let mut calls = picture.any_hit_calls.clone();
    let rank = calls.len() * 99 / 100;
    if rank < calls.len() { *calls.select_nth_unstable(rank).1 } else { 0 }
}

impl Picture {
    /// The colour of a pixel, black if there is none.
    fn shows(&self, mode: Mode, most: u32, pixel: usize) -> [u8; 3] {
        let shown = match mode {
            Mode::Shaded => self.colours.get(pixel).copied(),
            Mode::AnyHit => self.any_hit_calls.get(pixel).map(|&calls| heat::colour(calls, most)),
            Mode::Source => self.sources.get(pixel).map(|source| source.colour()),
        };
        shown.unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use omm_trace::Counters;

    use super::*;

    fn picture(calls: [u32; 2], source: OpacitySource) -> Picture {
        Picture {
            size: [2, 1],
            colours: vec![[10, 20, 30], [40, 50, 60]],
            any_hit_calls: calls.into(),
            sources: vec![OpacitySource::Geometry, source],
            counters: Counters::default(),
        }
    }

    #[test]
    fn differences_stand_on_the_right() {
        let without = picture([4, 4], OpacitySource::AnyHit);
        let with = picture([4, 0], OpacitySource::Micromap);
        let shaded = compared(&without, &with, Mode::Shaded);
        assert_eq!((shaded.width(), shaded.height()), (6, 1));
        assert_eq!(shaded.get_pixel(3, 0).0, [40, 50, 60]);
        assert_eq!([shaded.get_pixel(4, 0).0, shaded.get_pixel(5, 0).0], [[0; 3]; 2]);
        let calls = compared(&without, &with, Mode::AnyHit);
        assert_eq!([4, 5].map(|x| calls.get_pixel(x, 0).0), [[0; 3], [255; 3]]);
        let sources = compared(&without, &with, Mode::Source);
        assert_eq!([4, 5].map(|x| sources.get_pixel(x, 0).0), [[0; 3], OpacitySource::Micromap.colour()]);
    }

    #[test]
    fn modes_are_stacked() {
        let one = picture([1, 0], OpacitySource::Miss);
        let sheet = stacked(&[single(&one, Mode::Shaded), single(&one, Mode::AnyHit), single(&one, Mode::Source)]);
        assert_eq!((sheet.width(), sheet.height()), (2, 3));
        assert_eq!(sheet.get_pixel(1, 0).0, [40, 50, 60]);
        assert_eq!([sheet.get_pixel(0, 1).0, sheet.get_pixel(1, 1).0], [[255; 3], [0; 3]]);
        assert_eq!(sheet.get_pixel(1, 2).0, OpacitySource::Miss.colour());
    }
}
