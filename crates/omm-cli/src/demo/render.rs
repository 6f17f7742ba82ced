//! The demo's renderer: one ray through each pixel, one towards the sun from where it ends.

use omm_bake::surface::Surface;
use omm_trace::{AnyHit, Candidate, Counters, Hit, Ray, RayError, RayFlags, Scene, TraceOptions};
use rayon::prelude::*;

use super::devices::PLANT;
use super::scene::{Camera, Mesh, SUN};
use crate::progress::Progress;

/// Pixels of a picture, across and down.
pub(super) const SIZE: [u32; 2] = [960, 540];

/// What a shader needs.
pub(super) struct Shading<'a> {
    /// The alpha test.
    pub(super) surface: &'a Surface<'a>,
    /// The plant's mesh.
    pub(super) plant: &'a Mesh,
}

/// A traced picture.
pub(super) struct Picture {
    /// Colours, row by row.
    pub(super) colours: Vec<[u8; 3]>,
    /// Any-hit calls for each pixel.
    pub(super) any_hit_calls: Vec<u32>,
    /// Sums over all rays.
    pub(super) counters: Counters,
}

/// Traces all rays of `scene`. The result does not depend on the number of threads.
pub(super) fn render(scene: &Scene, shading: &Shading<'_>, progress: &Progress) -> Result<Picture, RayError> {
    let camera = Camera::new();
    let rows: Vec<_> = (0..SIZE[1])
        .into_par_iter()
        .map(|row| {
            let mut counters = Counters::default();
            let pixels: Vec<_> = (0..SIZE[0])
                .map(|column| {
                    let before = counters.any_hit_calls;
                    let colour = pixel(scene, shading, &camera, [column, row], &mut counters)?;
                    Ok((colour, (counters.any_hit_calls - before) as u32))
                })
                .collect::<Result<_, RayError>>()?;
            progress.advance(1);
            Ok((pixels, counters))
        })
        .collect::<Result<_, RayError>>()?;
    let mut picture = Picture { colours: Vec::new(), any_hit_calls: Vec::new(), counters: Counters::default() };
    for (pixels, counters) in rows {
        for (colour, calls) in pixels {
            picture.colours.push(colour);
            picture.any_hit_calls.push(calls);
        }
        picture.counters += counters;
    }
    Ok(picture)
}

fn pixel(
    scene: &Scene,
    shading: &Shading<'_>,
    camera: &Camera,
    at: [u32; 2],
    counters: &mut Counters,
) -> Result<[u8; 3], RayError> {
    let mut alpha_test = |candidate: &Candidate| shading.alpha_test(candidate);
    let options = TraceOptions::default();
    let ray = Ray::unbounded(camera.eye(), camera.direction(at, SIZE))?;
    let Some(hit) = scene.trace(&ray, &options, &mut alpha_test, counters) else {
        return Ok([150, 180, 215]);
    };
    // Above the surface by more than rounding, so that the ray to the sun does not meet it again.
    let end = ray.at(hit.t);
    let to_sun = Ray::new([0, 1, 2].map(|axis| end[axis] + 1e-3 * SUN[axis]), SUN, 0.0, 100.0)?;
    let flags = RayFlags::TERMINATE_ON_FIRST_HIT | RayFlags::SKIP_CLOSEST_HIT_SHADER;
    let options = TraceOptions { flags, ..options };
    let in_shadow = scene.trace(&to_sun, &options, &mut alpha_test, counters).is_some();
    let light = if in_shadow { 0.38 } else { 1.0 };
    Ok(shading.colour(&hit, end).map(|channel| (channel * light) as u8))
}

impl Shading<'_> {
    /// The any-hit shader: opaque where the filtered alpha is above the cutoff.
    fn alpha_test(&self, candidate: &Candidate) -> AnyHit {
        let [u, v] = self.texture_coordinates(candidate);
        if self.surface.is_opaque_near(u, v) { AnyHit::Accept } else { AnyHit::Ignore }
    }

    /// The texture coordinates at a candidate on a plant; 0 if it is on none.
    fn texture_coordinates(&self, candidate: &Candidate) -> [f64; 2] {
        let [b1, b2] = candidate.barycentrics.map(f64::from);
        let uv = |corner: u32| self.plant.uvs.get(corner as usize).map_or([0.0; 2], |uv| uv.map(f64::from));
        let Some(corners) = self.plant.triangles.get(candidate.primitive_id as usize) else { return [0.0; 2] };
        let [uv0, uv1, uv2] = corners.map(uv);
        [0, 1].map(|axis| uv0[axis] * (1.0 - b1 - b2) + uv1[axis] * b1 + uv2[axis] * b2)
    }

    /// The colour of a hit in full light: greens along a frond, earth in rings around the middle.
    fn colour(&self, hit: &Hit, point: [f32; 3]) -> [f64; 3] {
        if hit.instance_custom_index == PLANT {
            let [_, v] = self.texture_coordinates(&hit.candidate);
            let tip = 1.0 - v;
            let hue = f64::from(hit.instance_id % 7) * 5.0;
            return [46.0 + 70.0 * tip + hue, 118.0 + 90.0 * tip - hue, 48.0 + 20.0 * tip];
        }
        let [x, _, z] = point.map(f64::from);
        let ring = ((x * x + z * z) * 6.0) as u64 % 2;
        let shade = 1.0 - 0.06 * ring as f64;
        [138.0 * shade, 112.0 * shade, 82.0 * shade]
    }
}
