//! The parts of a picture: what one thread traces at a time.

use std::ops::Range;

use omm_trace::{Candidate, Counters, Hit, Ray, TraceOptions};

use super::{OpacitySource, PictureOptions, SKY, Tracer};
use crate::error::RenderError;
use crate::random::Random;

/// Pixels along each side of a tile.
const SIDE: u32 = 16;

/// A part of a picture: columns and rows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tile {
    columns: Range<u32>,
    rows: Range<u32>,
}

/// A pixel as it is shown.
pub(super) struct Pixel {
    pub(super) colour: [u8; 3],
    pub(super) any_hit_calls: u32,
    /// What the first sample ends on.
    pub(super) source: OpacitySource,
}

/// A pixel while its samples are added up.
struct Open {
    /// Column and row.
    at: [u32; 2],
    any_hit_calls: u64,
    source: Option<OpacitySource>,
    sum: [f64; 3],
    random: Random,
}

/// A sample that waits for its ray to the sun.
struct Waiting {
    pixel: usize,
    hit: Hit,
    point: [f32; 3],
    to_sun: (Ray, TraceOptions),
}

/// The tiles of a picture of `size` pixels, row by row.
pub fn tiles(size: [u32; 2]) -> impl Iterator<Item = Tile> {
    let parts = |size: u32| (0..size).step_by(SIDE as usize).map(move |from| from..from.saturating_add(SIDE).min(size));
    let [width, height] = size;
    parts(height).flat_map(move |rows| parts(width).map(move |columns| Tile { columns, rows: rows.clone() }))
}

impl Tile {
    /// Columns and rows of its pixels, row by row.
    pub fn pixels(&self) -> impl Iterator<Item = [u32; 2]> {
        let columns = self.columns.clone();
        self.rows.clone().flat_map(move |row| columns.clone().map(move |column| [column, row]))
    }
}

impl Open {
    fn new(at: [u32; 2], options: &PictureOptions) -> Self {
        let number = u64::from(at[1]) * u64::from(options.size[0]) + u64::from(at[0]);
        let random = Random::new(options.seed ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        Self { at, any_hit_calls: 0, source: None, sum: [0.0; 3], random }
    }

    /// Where the next of its samples lies.
    fn place(&mut self, samples: u32) -> [f64; 2] {
        let shift = if samples == 1 { [0.5; 2] } else { [self.random.unit(), self.random.unit()] };
        [0, 1].map(|axis| f64::from(self.at[axis]) + shift[axis])
    }

    fn add(&mut self, colour: [f64; 3]) {
        self.sum = [0, 1, 2].map(|channel| self.sum[channel] + colour[channel]);
    }

    /// The mean of its samples.
    fn close(self, samples: u32) -> Pixel {
        Pixel {
            colour: self.sum.map(|channel| (channel / f64::from(samples)) as u8),
            any_hit_calls: u32::try_from(self.any_hit_calls).unwrap_or(u32::MAX),
            source: self.source.unwrap_or(OpacitySource::Miss),
        }
    }
}

impl Tracer<'_> {
    /// Traces a tile: for each sample the rays from the camera, then those to the sun. So rays follow each other that go the same way
    /// through the same boxes.
    pub(super) fn tile(
        &self,
        tile: &Tile,
        options: &PictureOptions,
        counters: &mut Counters,
    ) -> Result<Vec<Pixel>, RenderError> {
        let samples = options.samples.max(1);
        let mut alpha_test = |candidate: &Candidate| self.alpha_test(candidate);
        let mut pixels: Vec<_> = tile.pixels().map(|at| Open::new(at, options)).collect();
        let mut waiting = Vec::with_capacity(pixels.len());
        for _ in 0..samples {
            for (number, pixel) in pixels.iter_mut().enumerate() {
                let (ray, how) = self.camera_ray(pixel.place(samples), options.size)?;
                let before = counters.any_hit_calls;
                let hit = self.rays.trace(&ray, &how, &mut alpha_test, counters);
                pixel.any_hit_calls += counters.any_hit_calls - before;
                pixel.source.get_or_insert(hit.as_ref().map_or(OpacitySource::Miss, OpacitySource::of));
                match hit {
                    None => pixel.add(SKY),
                    Some(hit) => {
                        let to_sun = self.sun_ray(&ray, &hit)?;
                        waiting.push(Waiting { pixel: number, point: ray.at(hit.t), hit, to_sun });
                    }
                }
            }
            for Waiting { pixel, hit, point, to_sun: (ray, how) } in waiting.drain(..) {
                let Some(pixel) = pixels.get_mut(pixel) else { continue };
                let before = counters.any_hit_calls;
                let in_shadow = self.rays.trace(&ray, &how, &mut alpha_test, counters).is_some();
                pixel.any_hit_calls += counters.any_hit_calls - before;
                pixel.add(self.lit(&hit, point, in_shadow));
            }
        }
        Ok(pixels.into_iter().map(|pixel| pixel.close(samples)).collect())
    }
}

#[cfg(test)]
mod tests {
    use omm_bake::BakeOptions;
    use omm_device::Device;
    use omm_device::app::App;
    use omm_model::profile::DeviceProfile;
    use omm_trace::Scene;

    use super::*;
    use crate::{Baked, Built, garden};

    #[test]
    fn a_pixel_shows_what_its_ray_ends_on() {
        let scene = garden::garden().unwrap();
        let baked = Baked::new(&scene, &BakeOptions::default(), &|_, _| {}).unwrap();
        let mut device = Device::new(DeviceProfile::reference());
        let built = Built::new(&mut App::new(&mut device, &mut ()), &scene, &baked).unwrap();
        let rays = Scene::load(&device, built.with.address).unwrap();
        let tracer = Tracer::new(&rays, &scene).unwrap();
        let options = PictureOptions { size: [37, 21], samples: 1, seed: 0 };
        let picture = tracer.picture(&options, &|_, _| {}).unwrap();
        let mut counters = Counters::default();
        for (at, source) in picture.sources.iter().enumerate() {
            let place = [at % 37, at / 37].map(|at| at as f64 + 0.5);
            let (ray, how) = tracer.camera_ray(place, options.size).unwrap();
            let hit = rays.trace(&ray, &how, &mut |of: &Candidate| tracer.alpha_test(of), &mut counters);
            assert_eq!(*source, hit.as_ref().map_or(OpacitySource::Miss, OpacitySource::of), "{place:?}");
        }
        // One ray more for each that ends somewhere.
        assert_eq!(picture.counters.rays, counters.rays + counters.hits);
        assert_eq!((picture.sources.len(), picture.colours.len()), (37 * 21, 37 * 21));
    }

    #[test]
    fn each_pixel_is_in_one_tile() {
        for size in [[1, 1], [16, 16], [17, 33], [0, 5], [5, 0]] {
            let mut seen: Vec<_> = tiles(size).flat_map(|tile| tile.pixels().collect::<Vec<_>>()).collect();
            seen.sort_unstable_by_key(|&[column, row]| (row, column));
            let all = (0..size[1]).flat_map(|row| (0..size[0]).map(move |column| [column, row]));
            assert!(seen.into_iter().eq(all), "{size:?}");
        }
    }
}
