//! What a picture shows, and how large.

use super::{CLOSE_UP, Layer};
use crate::texture::Texture;

/// The longer side of a picture is at least this many pixels.
const LEAST_SIDE: f64 = 512.0;
/// No side of a picture is longer, in pixels.
const MOST_SIDE: f64 = 2048.0;
/// The shorter side of a picture of a narrow strip is at least this many pixels.
const LEAST_SHORT_SIDE: f64 = 16.0;

/// Which part of texture space is shown, and how large.
pub(super) struct View {
    /// The least u and v.
    pub(super) low: [f64; 2],
    /// Pixels for a unit of u and of v.
    pub(super) scale: [f64; 2],
    /// Width and height in pixels.
    pub(super) size: [u32; 2],
}

impl View {
    pub(super) fn new(texture: &Texture, layers: &[Layer<'_>]) -> Self {
        let (mut low, mut high) = ([0.0, 0.0], [1.0, 1.0]);
        let (mut least, mut most) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for input in layers.iter().map(|layer| layer.input) {
            let used = input.triangles.iter().flatten().filter_map(|&vertex| input.uvs.get(vertex as usize));
            for uv in used.filter(|uv| uv.iter().all(|x| x.is_finite())) {
                for (axis, &x) in uv.iter().enumerate() {
                    least[axis] = least[axis].min(x.into());
                    most[axis] = most[axis].max(x.into());
                }
            }
        }
        if (0..2).any(|axis| least[axis] < 0.0 || most[axis] > 1.0) {
            (low, high) = (least, most);
        }
        let texels = Self::texels(texture).scale;
        // A box without width would have no scale.
        let extent = [0, 1].map(|axis| (high[axis] - low[axis]).max(f64::EPSILON));
        let wanted = [0, 1].map(|axis| extent[axis] * texels[axis]);
        let longer = wanted[0].max(wanted[1]);
        let zoom = longer.clamp(LEAST_SIDE, MOST_SIDE) / longer;
        let size = wanted.map(|side| (side * zoom).round().clamp(LEAST_SHORT_SIDE, MOST_SIDE));
        let scale = [0, 1].map(|axis| size[axis] / extent[axis]);
        Self { low, scale, size: size.map(|side| side as u32) }
    }

    /// The texture coordinates 0 to 1, a pixel for each texel.
    pub(super) fn texels(texture: &Texture) -> Self {
        let size = [texture.width(), texture.height()];
        Self { low: [0.0; 2], scale: size.map(f64::from), size }
    }

    /// What lies around a pixel of this view, `zoom` times as large.
    pub(super) fn around(&self, centre: [f64; 2], zoom: f64) -> Self {
        let scale = self.scale.map(|scale| scale * zoom);
        let centre = self.texture_coordinates(centre);
        let low = [0, 1].map(|axis| centre[axis] - f64::from(CLOSE_UP[axis]) / 2.0 / scale[axis]);
        Self { low, scale, size: CLOSE_UP }
    }

    pub(super) fn texture_coordinates(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x / self.scale[0] + self.low[0], y / self.scale[1] + self.low[1]]
    }

    pub(super) fn pixels(&self, [u, v]: [f32; 2]) -> [f64; 2] {
        [(f64::from(u) - self.low[0]) * self.scale[0], (f64::from(v) - self.low[1]) * self.scale[1]]
    }
}
