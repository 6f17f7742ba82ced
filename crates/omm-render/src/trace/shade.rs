//! What shaders do: the alpha test, colours, and the normal for the light.

use omm_bake::{AddressMode, Sampler};
use omm_trace::{AnyHit, Candidate, Hit};

use super::Tracer;
use crate::scene::{Paint, Part};
use crate::vector::{cross, normalised, sub};

impl<'a> Tracer<'a> {
    fn part(&self, candidate: &Candidate) -> Option<&'a Part> {
        let mesh = self.scene.meshes.get(candidate.instance_custom_index as usize)?;
        mesh.parts.get(candidate.geometry_index as usize)
    }

    /// The any-hit shader: opaque where the filtered alpha is above the cutoff.
    #[must_use]
    pub fn alpha_test(&self, candidate: &Candidate) -> AnyHit {
        let parts = self.surfaces.get(candidate.instance_custom_index as usize);
        let surface = parts.and_then(|parts| parts.get(candidate.geometry_index as usize)?.as_ref());
        let (Some(surface), Some(part)) = (surface, self.part(candidate)) else { return AnyHit::Accept };
        let [u, v] = texture_coordinates(part, candidate);
        if surface.is_opaque_near(u, v) { AnyHit::Accept } else { AnyHit::Ignore }
    }

    /// The colour of a hit in full light, sRGB.
    pub(super) fn colour(&self, hit: &Hit, point: [f32; 3]) -> [f64; 3] {
        let Some(part) = self.part(hit) else { return [255.0; 3] };
        match part.paint {
            Paint::Plain(colour) => colour.map(f64::from),
            Paint::Image { colour, sampler, factor } => {
                let texel = self.texel(colour, &sampler, texture_coordinates(part, hit));
                [0, 1, 2].map(|channel| f64::from(texel[channel]) * f64::from(factor[channel]))
            }
            Paint::Frond { plant } => {
                let tip = 1.0 - texture_coordinates(part, hit)[1];
                let hue = f64::from(hit.primitive_id.checked_div(plant).unwrap_or(0) % 7) * 5.0;
                [46.0 + 70.0 * tip + hue, 118.0 + 90.0 * tip - hue, 48.0 + 20.0 * tip]
            }
            Paint::Earth => {
                let [x, _, z] = point.map(f64::from);
                let ring = ((x * x + z * z) * 6.0) as u64 % 2;
                [138.0, 112.0, 82.0].map(|channel| channel * (1.0 - 0.06 * ring as f64))
            }
        }
    }

    /// The nearest texel of an image; white if there is none.
    fn texel(&self, image: usize, sampler: &Sampler, [u, v]: [f64; 2]) -> [u8; 3] {
        let read = || {
            let image = self.scene.colours.get(image)?;
            let texel = |mode: AddressMode, at: f64, size: u32| {
                let at = (at * f64::from(size)).floor();
                // Beyond that the address mode is not defined.
                (at.abs() < f64::from(1 << 30)).then(|| mode.texel(at as i64, size))?
            };
            let x = texel(sampler.address_mode_u, u, image.width())?;
            let y = texel(sampler.address_mode_v, v, image.height())?;
            image.get_pixel_checked(x, y).map(|pixel| pixel.0)
        };
        read().unwrap_or([255; 3])
    }

    /// The direction across the triangle that was hit, in the world; `None` if it has none.
    pub(super) fn normal(&self, hit: &Hit) -> Option<[f64; 3]> {
        let part = self.part(hit)?;
        let corners = part.triangles.get(hit.primitive_id as usize)?;
        let placement = self.placed.get(hit.instance_id as usize)?;
        let world = |corner: u32| part.positions.get(corner as usize).map(|&position| placement.apply(position));
        let [a, b, c] = [world(corners[0])?, world(corners[1])?, world(corners[2])?];
        normalised(cross(sub(b, a), sub(c, a)))
    }
}

/// The texture coordinates at a candidate; 0 where there are none.
fn texture_coordinates(part: &Part, candidate: &Candidate) -> [f64; 2] {
    let [b1, b2] = candidate.barycentrics.map(f64::from);
    let uv = |corner: u32| part.uvs.get(corner as usize).map_or([0.0; 2], |uv| uv.map(f64::from));
    let Some(corners) = part.triangles.get(candidate.primitive_id as usize) else { return [0.0; 2] };
    let [uv0, uv1, uv2] = corners.map(uv);
    [0, 1].map(|axis| uv0[axis] * (1.0 - b1 - b2) + uv1[axis] * b1 + uv2[axis] * b2)
}
