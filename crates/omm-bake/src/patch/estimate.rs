//! Which half of a mixed microtriangle is larger, by the samples of [`promotion`](crate::promotion), 16 at a time.
//!
//! # Why the answer is that of `f64`
//!
//! Samples are the centroids of [`SAMPLES`], at fixed-point coordinates: off by less than 2^-13 texel, as boxes are (see
//! [`Patch`](super::Patch)), and by 2^-20 for their own rounding. Values are taken less the cutoff and divided by the
//! surface's *reach*, so all are within -1..=1, the surface is continuous, and it changes by no more than 2 for a texel along an
//! axis: a value is off by less than 2^-11 + 2^-18 for its place. In `f32`, of which no number here exceeds 4, its texels and the
//! polynomial make some ten roundings of at most 2^-22 each. Together that is less than 2^-10. The same samples in `f64` are off by
//! far less than what is left. So a value further from 0 than [`MARGIN`] = 2^-10 has the sign that `f64` finds, and if one is not
//! further, `f64` is asked.

use super::grid::{Cells, FRACTION, Spot};
use crate::promotion::SAMPLES;
use crate::surface::Surface;
use crate::window::Window;

/// Values further from 0 have a certain sign.
const MARGIN: f32 = 1.0 / 1024.0;
/// Columns and rows of texels around a microtriangle, at most.
pub(crate) const BLOCK: usize = 8;

/// The 16 samples of a microtriangle of each half, in fixed-point coordinates from its anchor.
#[derive(Clone, Debug, Default)]
pub(super) struct Samples {
    x: [[i32; 16]; 2],
    y: [[i32; 16]; 2],
    /// Texels around a microtriangle, and two rows more for the compiler: indices into them are in range by their bits.
    block: [[f32; BLOCK]; BLOCK + 2],
}

impl Samples {
    /// Takes the steps of a grid.
    pub(super) fn set(&mut self, steps: [[i64; 2]; 2]) {
        for (axis, halves) in [&mut self.x, &mut self.y].into_iter().enumerate() {
            let [a, b] = [steps[0][axis], steps[1][axis]];
            let [lower, upper] = halves;
            for ((lower, upper), weights) in lower.iter_mut().zip(upper).zip(SAMPLES) {
                let [p, q] = weights.map(|weight| weight as i64);
                // A step is at most 64 texels.
                *lower = ((a * p + b * q) / 12) as i32;
                // The other half is the first turned round the middle of both.
                *upper = (a + b) as i32 - *lower;
            }
        }
    }

    /// Whether at least half of the samples of `spot`, which touches `cells`, are opaque; `None` if rounding decides, or if the
    /// microtriangle is large.
    pub(super) fn mostly_opaque(
        &mut self,
        surface: &Surface<'_>,
        window: &Window,
        spot: Spot,
        cells: Cells,
    ) -> Option<bool> {
        let (columns, rows) = (cells.right - cells.left + 2, cells.bottom - cells.top + 2);
        if columns.max(rows) > BLOCK as u32 {
            return None;
        }
        window.differences(surface, [cells.left, cells.top], [columns, rows], &mut self.block);
        let [x, y] = spot.coordinates();
        let (x, y) = (x - (cells.left << FRACTION) as i32, y - (cells.top << FRACTION) as i32);
        let (above, below) = count([x, y], &self.x[spot.half()], &self.y[spot.half()], self.block.as_flattened());
        (above + below == 16).then_some(above >= 8)
    }
}

/// How many of 16 points, given from (`x`, `y`) on, are above and below with certainty. Loops over all of them with an index each, by
/// itself: so the compiler makes vectors of them.
#[allow(clippy::needless_range_loop)]
#[inline(never)]
fn count([x, y]: [i32; 2], from_x: &[i32; 16], from_y: &[i32; 16], texels: &[f32]) -> (i32, i32) {
    let Some(texels) = texels.first_chunk::<{ BLOCK * (BLOCK + 2) }>() else { return (0, 0) };
    let (mut xs, mut ys, mut at) = ([0; 16], [0; 16], [0; 16]);
    for k in 0..16 {
        xs[k] = x + from_x[k];
        ys[k] = y + from_y[k];
    }
    for k in 0..16 {
        // The cell's texel: its row in the upper three bits, its column in the lower.
        at[k] = ys[k] >> (FRACTION - 3) & 0x38 | xs[k] >> FRACTION & 7;
    }
    let (mut lower, mut upper) = ([[0.0; 2]; 16], [[0.0; 2]; 16]);
    for k in 0..16 {
        let at = (at[k] & 0x3f) as usize;
        lower[k] = [texels[at], texels[at + 1]];
        upper[k] = [texels[at + BLOCK], texels[at + BLOCK + 1]];
    }
    let (mut above, mut below) = (0, 0);
    for k in 0..16 {
        let (x, y) = (fraction(xs[k]), fraction(ys[k]));
        let ([d00, d10], [d01, d11]) = (lower[k], upper[k]);
        let (lower, upper) = (d00 + x * (d10 - d00), d01 + x * (d11 - d01));
        let value: f32 = lower + y * (upper - lower);
        above += i32::from(value > MARGIN);
        below += i32::from(value < -MARGIN);
    }
    (above, below)
}

/// The position within a cell.
fn fraction(coordinate: i32) -> f32 {
    let unit = 1_i32 << FRACTION;
    (coordinate & (unit - 1)) as f32 * (1.0 / unit as f32)
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
