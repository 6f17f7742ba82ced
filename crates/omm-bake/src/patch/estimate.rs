//! Which half of a mixed microtriangle is larger, by the samples of [`promotion`](crate::promotion), 16 at a time.
//!
//! Samples are the centroids of [`SAMPLES`]; their values are those of [`tile`](super::tile), with its proof. The same samples in
//! `f64` are off by far less. So a value that is above or below with certainty has the sign that `f64` finds, and if those do not
//! decide, `f64` is asked.

use super::Patch;
use super::grid::Spot;
use super::tile::Points;
use crate::promotion::SAMPLES;
use crate::surface::Surface;

/// Weights of the samples, in twelfths.
const WEIGHTS: [[i32; 2]; 16] = {
    let mut weights = [[0; 2]; 16];
    let mut k = 0;
    while k < 16 {
        weights[k] = [SAMPLES[k][0] as i32, SAMPLES[k][1] as i32];
        k += 1;
    }
    weights
};

/// The samples of a microtriangle.
pub(super) fn set_samples(points: &mut Points, steps: [[i64; 2]; 2]) {
    points.set(steps, &WEIGHTS, 12, 1);
}

impl Patch {
    /// Whether at least half of the samples of a microtriangle are opaque; `None` if rounding decides, or if the microtriangle is
    /// large.
    pub(crate) fn mostly_opaque(&mut self, surface: &Surface<'_>, spot: Spot) -> Option<bool> {
        if !self.linear || !self.tile.load(surface, &self.window, self.grid.cells(spot, 0)) {
            return None;
        }
        self.mostly_opaque_in_tile(spot)
    }

    /// The same for a microtriangle where the tile is.
    pub(crate) fn mostly_opaque_in_tile(&self, spot: Spot) -> Option<bool> {
        let [above, below] = self.tile.count(spot, &self.samples);
        // Whatever rounding decides of the others.
        if above >= 8 { Some(true) } else { (below > 8).then_some(false) }
    }
}

#[cfg(test)]
mod tests {
    use omm_model::curve::MicroTriangle;
    use omm_model::level::SubdivisionLevel;

    use crate::classify::Node;
    use crate::patch::Patch;
    use crate::planes::Planes;
    use crate::promotion::mostly_opaque;
    use crate::sampler::{AddressMode, Filter, Sampler};
    use crate::surface::Surface;
    use crate::texel_triangle::TexelTriangle;
    use crate::texture::Texture;

    /// Where there is an answer it is that of `f64`, for bytes and floats, within the texture and over its edge; and mostly there is.
    #[test]
    fn answers_are_those_of_f64() {
        let values: Vec<u8> = (0..1600_u32).map(|k| (k * k * 7 % 251) as u8).collect();
        let floats = values.iter().map(|&value| f32::from(value) / 255.0).collect();
        let level = SubdivisionLevel::new(4).unwrap();
        let (mut answers, mut all) = (0, 0);
        for texture in [Texture::unorm8(40, 40, values).unwrap(), Texture::fp32(40, 40, floats).unwrap()] {
            let sampler = Sampler::new(AddressMode::Mirror, Filter::Linear, 0.0);
            let surface = Surface::new(&texture, sampler, 0.4).unwrap();
            let planes = Planes::new(&surface);
            for uvs in [
                [[0.1, 0.1], [0.93, 0.3], [0.2, 0.9]],
                [[0.1, 0.1], [0.2, 0.9], [0.93, 0.3]],
                [[0.7, 0.8], [1.6, 1.1], [0.6, 1.7]],
            ] {
                let triangle = TexelTriangle::new(uvs, &texture).unwrap();
                let mut patch = Patch::new();
                let node = Node {
                    weights: MicroTriangle::ROOT
                        .corners()
                        .map(|c| omm_model::curve::Corner { u: 16 * c.u, v: 16 * c.v }),
                    level,
                };
                let mut spots = vec![patch.load(&surface, &planes, &triangle, node, 16).unwrap()];
                for size in (0..4).rev() {
                    spots = spots.iter().flat_map(|&s| [0, 1, 2, 3].map(|which| patch.part(s, size, which))).collect();
                }
                for spot in spots {
                    let corners = triangle.corners(patch.weights(spot), level, surface.shift());
                    let expected = mostly_opaque(&corners, |x, y| surface.is_above_near(x, y));
                    let found = patch.mostly_opaque(&surface, spot);
                    assert_eq!(found.unwrap_or(expected), expected);
                    answers += u32::from(found.is_some());
                    all += 1;
                }
            }
        }
        assert!(answers > all * 9 / 10, "{answers} of {all}");
    }
}
