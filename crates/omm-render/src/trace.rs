//! The renderer: rays through each pixel, one towards the sun from where each ends.

use omm_bake::Surface;
use omm_trace::{Counters, Hit, Ray, RayError, RayFlags, Scene, TraceOptions};
use rayon::prelude::*;

use crate::error::RenderError;
use crate::scene::{Part, Placement, RenderScene};
use crate::vector::{dot, normalised};

mod shade;
mod tile;

pub use tile::{Tile, tiles};

/// The part of the light that comes from everywhere.
const AMBIENT: f64 = 0.38;
const SKY: [f64; 3] = [150.0, 180.0, 215.0];

/// How a picture is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureOptions {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Rays from the camera for each pixel: one through its middle, or several through places that `seed` picks.
    pub samples: u32,
    /// Which places.
    pub seed: u64,
}

/// What decided about the surface that a camera ray ends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum OpacitySource {
    /// The ray meets nothing.
    Miss,
    /// The geometry is opaque.
    Geometry,
    /// The micromap knows it to be opaque.
    Micromap,
    /// An any-hit shader, because the micromap does not know.
    AnyHitUnknown,
    /// An any-hit shader, because there is no micromap or it is disabled.
    AnyHit,
}

/// A traced picture. Rows run down, pixels from left to right.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Colours, sRGB.
    pub colours: Vec<[u8; 3]>,
    /// Any-hit calls for each pixel.
    pub any_hit_calls: Vec<u32>,
    /// For each pixel what decided about the end of its first ray.
    pub sources: Vec<OpacitySource>,
    /// Sums over all rays.
    pub counters: Counters,
}

/// A scene as it was built, and all that its shaders need.
#[derive(Debug)]
pub struct Tracer<'a> {
    rays: &'a Scene,
    scene: &'a RenderScene,
    /// The placements that were built, by instance.
    placed: Vec<&'a Placement>,
    /// What is cut out, by mesh, then by part.
    surfaces: Vec<Vec<Option<Surface<'a>>>>,
    sun: [f64; 3],
}

impl<'a> Tracer<'a> {
    /// Shaders for `rays`, which was built from `scene`.
    ///
    /// # Errors
    /// A cutout whose cutoff or border nothing can be compared with, or a sun that has no direction.
    pub fn new(rays: &'a Scene, scene: &'a RenderScene) -> Result<Self, RenderError> {
        let surface = |mesh, (part, description): (usize, &'a Part)| {
            let Some(cutout) = description.cutout else { return Ok(None) };
            let Some(texture) = scene.alphas.get(cutout.alpha) else { return Ok(None) };
            let surface = Surface::new(texture, cutout.sampler, cutout.alpha_cutoff);
            surface.map(Some).map_err(|source| RenderError::Surface { mesh, part, source })
        };
        let meshes = scene.meshes.iter().enumerate();
        let surfaces = meshes.map(|(at, mesh)| mesh.parts.iter().enumerate().map(|part| surface(at, part)).collect());
        let sun = normalised(scene.sun.map(f64::from)).ok_or(RayError::ZeroDirection)?;
        Ok(Self { rays, scene, placed: scene.placed().collect(), surfaces: surfaces.collect::<Result<_, _>>()?, sun })
    }

    /// Takes a picture, the same whatever the number of threads. `progress` is told how many pixels and rays more are done.
    ///
    /// # Errors
    /// A camera that is so far away that its rays are none.
    pub fn picture(
        &self,
        options: &PictureOptions,
        progress: &(dyn Fn(u64, u64) + Sync),
    ) -> Result<Picture, RenderError> {
        let [width, height] = options.size.map(|size| size as usize);
        let tiles: Vec<_> = tiles(options.size).collect();
        let traced: Vec<_> = tiles
            .par_iter()
            .map(|tile| {
                let mut counters = Counters::default();
                let pixels = self.tile(tile, options, &mut counters)?;
                progress(pixels.len() as u64, counters.rays);
                Ok((pixels, counters))
            })
            .collect::<Result<_, RenderError>>()?;
        let mut picture = Picture {
            size: options.size,
            colours: vec![[0; 3]; width * height],
            any_hit_calls: vec![0; width * height],
            sources: vec![OpacitySource::Miss; width * height],
            counters: Counters::default(),
        };
        for (tile, (pixels, counters)) in tiles.iter().zip(traced) {
            picture.counters += counters;
            for ([column, row], pixel) in tile.pixels().zip(pixels) {
                let at = row as usize * width + column as usize;
                picture.colours[at] = pixel.colour;
                picture.any_hit_calls[at] = pixel.any_hit_calls;
                picture.sources[at] = pixel.source;
            }
        }
        Ok(picture)
    }

    /// The colour of a hit at a point, in the sun or not.
    fn lit(&self, hit: &Hit, point: [f32; 3], in_shadow: bool) -> [f64; 3] {
        let facing = self.normal(hit).map_or(0.0, |normal| dot(normal, self.sun).abs());
        let direct = if in_shadow { 0.0 } else { (1.0 - AMBIENT) * (0.4 + 0.6 * facing) };
        self.colour(hit, point).map(|channel| (channel * (AMBIENT + direct)).clamp(0.0, 255.0))
    }

    /// The ray from the camera through a place of a picture of `size` pixels, whose left upper corner is 0, 0; and how it is traced.
    ///
    /// # Errors
    /// A camera that is so far away that its rays are none.
    pub fn camera_ray(&self, place: [f64; 2], size: [u32; 2]) -> Result<(Ray, TraceOptions), RayError> {
        let camera = &self.scene.camera;
        Ok((Ray::unbounded(camera.eye(), camera.direction(place, size))?, TraceOptions::default()))
    }

    /// The ray towards the sun from where another ended; and how it is traced.
    ///
    /// # Errors
    /// A hit that is too far away for a ray to start there.
    pub fn sun_ray(&self, ray: &Ray, hit: &Hit) -> Result<(Ray, TraceOptions), RayError> {
        let end = ray.at(hit.t);
        // Above the surface by more than rounding, so that the ray to the sun does not meet it again.
        let far = end.iter().fold(1.0, |far: f64, x| far.max(f64::from(x.abs())));
        let start = [0, 1, 2].map(|axis| (f64::from(end[axis]) + 1e-3 * far * self.sun[axis]) as f32);
        let flags = RayFlags::TERMINATE_ON_FIRST_HIT | RayFlags::SKIP_CLOSEST_HIT_SHADER;
        let options = TraceOptions { flags, ..TraceOptions::default() };
        Ok((Ray::unbounded(start, self.sun.map(|x| x as f32))?, options))
    }
}

impl OpacitySource {
    /// What decided about a hit.
    fn of(hit: &Hit) -> Self {
        match (hit.opaque, hit.micromap) {
            (true, Some(_)) => Self::Micromap,
            (true, None) => Self::Geometry,
            (false, Some(_)) => Self::AnyHitUnknown,
            (false, None) => Self::AnyHit,
        }
    }
}
