//! Pictures of what was baked: the texture in grey, each microtriangle tinted by its state.
//!
//! | picture | shows |
//! |---|---|
//! | [`overlay`] | one mesh on its texture |
//! | [`atlas`] | all meshes that read one texture |
//! | [`close_up`] | a part of the contour, enlarged until the edges of microtriangles are apart |
//!
//! The colours are those of the integration guide: opaque green, transparent blue, unknown transparent pink, unknown opaque yellow.

use std::collections::HashSet;

use image::RgbaImage;
use omm_model::curve;
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;
use omm_model::special_index::TriangleMap;
use rayon::prelude::*;

use crate::bake::BakeOutput;
use crate::options::BakeInput;
use crate::sampler::{AddressMode, Sampler};
use crate::texture::Texture;

mod view;

use view::View;

/// Edges are drawn where parallel ones are at least this many pixels apart; closer ones would hide the colours.
const LEAST_SPACING: f64 = 4.0;

/// The colour of a state, red, green and blue.
#[must_use]
pub const fn colour(state: OpacityState) -> [u8; 3] {
    match state {
        OpacityState::Transparent => [66, 115, 235],
        OpacityState::Opaque => [46, 168, 76],
        OpacityState::UnknownTransparent => [240, 120, 190],
        OpacityState::UnknownOpaque => [250, 205, 50],
    }
}

/// A mesh and what was baked from it.
#[derive(Clone, Copy, Debug)]
pub struct Layer<'a> {
    /// What was baked.
    pub input: BakeInput<'a>,
    /// What came out.
    pub output: &'a BakeOutput,
}

/// Draws `output`, which was baked from `input` under `sampler`.
///
/// The picture shows the texture coordinates 0 to 1, or all that the triangles use if some lie outside of that, *v* downwards. Its
/// longer side has as many pixels as that part has texels, but at least 512 and at most 2048. Where triangles overlap, the
/// last one is seen. Triangles without area, or with coordinates that are not finite, are not drawn.
#[must_use]
pub fn overlay(input: &BakeInput<'_>, sampler: Sampler, output: &BakeOutput) -> RgbaImage {
    let layers = [Layer { input: *input, output }];
    draw(input.texture, sampler, &View::new(input.texture, &layers), &layers)
}

/// Draws all of `layers`, as [`overlay`] does one, over `texture`, which they all read.
#[must_use]
pub fn atlas(texture: &Texture, sampler: Sampler, layers: &[Layer<'_>]) -> RgbaImage {
    draw(texture, sampler, &View::new(texture, layers), layers)
}

/// Draws a part of what [`overlay`] shows, [`CLOSE_UP`] pixels large, around the unknown microtriangle in the middle of the mesh's
/// triangle that has most of them. Its microtriangles are at least 12 pixels wide. `None` if no microtriangle is unknown.
#[must_use]
pub fn close_up(input: &BakeInput<'_>, sampler: Sampler, output: &BakeOutput) -> Option<RgbaImage> {
    let layers = [Layer { input: *input, output }];
    let texels = View::texels(input.texture);
    let most = shapes(&layers, &texels).max_by_key(|shape| shape.unknown().count())?;
    let unknown: Vec<_> = most.unknown().collect();
    let [u, v] = curve::MicroTriangle::new(most.level, *unknown.get(unknown.len() / 2)?)?.centroid().map(f64::from);
    let apart = most.apart().into_iter().fold(f64::INFINITY, f64::min);
    let centre = most.point(u, v);
    let view = texels.around(centre, (CLOSE_UP_SPACING / apart).clamp(1.0, MOST_ZOOM));
    Some(draw(input.texture, sampler, &view, &layers))
}

/// Width and height of a [`close_up`].
pub const CLOSE_UP: [u32; 2] = [768, 480];
/// Pixels of a [`close_up`] along a texel, at most.
const MOST_ZOOM: f64 = 2048.0;
/// Pixels between parallel edges of a [`close_up`].
const CLOSE_UP_SPACING: f64 = 12.0;

fn draw(texture: &Texture, sampler: Sampler, view: &View, layers: &[Layer<'_>]) -> RgbaImage {
    let shapes: Vec<_> = shapes(layers, view).collect();
    let mut picture = RgbaImage::new(view.size[0], view.size[1]);
    let row_bytes = view.size[0] as usize * 4;
    let rows: &mut [u8] = &mut picture;
    rows.par_chunks_mut(row_bytes).enumerate().for_each(|(y, row)| {
        let y = y as f64 + 0.5;
        for (x, pixel) in row.as_chunks_mut::<4>().0.iter_mut().enumerate() {
            let [u, v] = view.texture_coordinates([x as f64 + 0.5, y]);
            let grey = grey(texture, sampler, u, v);
            // The last byte keeps the grey below the tints until the row is done.
            *pixel = [grey; 4];
        }
        for shape in shapes.iter().filter(|shape| shape.low[1] <= y && y <= shape.high[1]) {
            shape.draw(row, y);
        }
        for [.., alpha] in row.as_chunks_mut::<4>().0 {
            *alpha = 255;
        }
    });
    picture
}

/// The alpha of the texel at (u, v), as grey.
fn grey(texture: &Texture, sampler: Sampler, u: f64, v: f64) -> u8 {
    let texel =
        |mode: AddressMode, coordinate: f64, size: u32| mode.texel((coordinate * f64::from(size)).floor() as i64, size);
    let column = texel(sampler.address_mode_u, u, texture.width());
    let inside = column.zip(texel(sampler.address_mode_v, v, texture.height()));
    let alpha = inside.and_then(|(x, y)| texture.alpha(x, y)).unwrap_or(sampler.border_alpha.into());
    (alpha.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// A triangle ready to be drawn.
struct Shape<'a> {
    /// The box around it, in pixels.
    low: [f64; 2],
    high: [f64; 2],
    origin: [f64; 2],
    /// From the origin to the other two corners.
    along: [f64; 2],
    across: [f64; 2],
    /// The barycentrics u and v grow by so much for each pixel to the right and down.
    gradients: [[f64; 2]; 2],
    states: States<'a>,
    level: SubdivisionLevel,
    edges: bool,
}

/// The states of a triangle's microtriangles.
enum States<'a> {
    One(OpacityState),
    Each { data: &'a [u8], format: OpacityMicromapFormat },
}

/// The triangles that have an area, in order, those of a layer that look the same only once.
fn shapes<'a>(layers: &[Layer<'a>], view: &View) -> impl Iterator<Item = Shape<'a>> {
    layers.iter().flat_map(move |&Layer { input, output }| {
        let mut seen = HashSet::new();
        input.triangles.iter().zip(output.triangle_maps()).filter_map(move |(corners, map)| {
            let [Some(&a), Some(&b), Some(&c)] = corners.map(|vertex| input.uvs.get(vertex as usize)) else {
                return None;
            };
            let bits = [a, b, c].map(|uv| uv.map(f32::to_bits));
            if !seen.insert((bits, map)) {
                return None;
            }
            Shape::new([a, b, c].map(|uv| view.pixels(uv)), map, output)
        })
    })
}

impl<'a> Shape<'a> {
    fn new([a, b, c]: [[f64; 2]; 3], map: TriangleMap, output: &'a BakeOutput) -> Option<Self> {
        let along = [b[0] - a[0], b[1] - a[1]];
        let across = [c[0] - a[0], c[1] - a[1]];
        let area = along[0] * across[1] - along[1] * across[0];
        if !area.is_finite() || area == 0.0 {
            return None;
        }
        let gradients = [[across[1] / area, -across[0] / area], [-along[1] / area, along[0] / area]];
        let (states, level) = match map {
            TriangleMap::SpecialIndex(index) => (States::One(index.state()), SubdivisionLevel::ZERO),
            TriangleMap::Triangle(index) => {
                let triangle = output.triangles.get(index as usize)?;
                let data = output.array.get(triangle.data_offset as usize..)?;
                (States::Each { data, format: triangle.format }, triangle.subdivision_level)
            }
        };
        let fold = |pick: fn(f64, f64) -> f64| [0, 1].map(|axis| pick(pick(a[axis], b[axis]), c[axis]));
        let (low, high) = (fold(f64::min), fold(f64::max));
        let mut shape = Self { low, high, origin: a, along, across, gradients, states, level, edges: false };
        shape.edges = shape.apart().into_iter().all(|pixels| pixels >= LEAST_SPACING);
        Some(shape)
    }

    /// Pixels between parallel edges of microtriangles, in each of the three directions.
    fn apart(&self) -> [f64; 3] {
        let segments = f64::from(self.level.segments());
        directions(self.gradients).map(|[x, y]| 1.0 / ((x * x + y * y).sqrt() * segments))
    }

    /// The pixel at barycentrics (u, v).
    fn point(&self, u: f64, v: f64) -> [f64; 2] {
        [0, 1].map(|axis| self.origin[axis] + u * self.along[axis] + v * self.across[axis])
    }

    /// The unknown microtriangles, by index.
    fn unknown(&self) -> impl Iterator<Item = u32> {
        (0..self.level.microtriangles()).filter(|&index| {
            let state = match self.states {
                States::One(state) => Some(state),
                States::Each { data, format } => format.state(data, index.into()),
            };
            state.is_some_and(|state| !state.is_known())
        })
    }

    /// Tints the pixels of a row, whose centres are at `y`, that the triangle covers.
    fn draw(&self, row: &mut [u8], y: f64) {
        let first = (self.low[0] - 0.5).ceil().max(0.0) as usize;
        let last = (self.high[0] + 0.5).floor().max(0.0) as usize;
        let pixels = row.as_chunks_mut::<4>().0.iter_mut().enumerate().take(last).skip(first);
        let down = y - self.origin[1];
        for (x, pixel) in pixels {
            let right = x as f64 + 0.5 - self.origin[0];
            let [u, v] = self.gradients.map(|[for_x, for_y]| for_x * right + for_y * down);
            if u < 0.0 || v < 0.0 || u + v > 1.0 {
                continue;
            }
            let Some(state) = self.state(u as f32, v as f32) else { continue };
            let darker = if self.edges && self.on_edge(u, v) { 2 } else { 0 };
            let [.., grey] = *pixel;
            let [r, g, b] = tint(grey, colour(state), darker);
            *pixel = [r, g, b, grey];
        }
    }

    fn state(&self, u: f32, v: f32) -> Option<OpacityState> {
        match self.states {
            States::One(state) => Some(state),
            States::Each { data, format } => format.state(data, curve::index(u, v, self.level).into()),
        }
    }

    /// Whether an edge of a microtriangle is within half a pixel.
    fn on_edge(&self, u: f64, v: f64) -> bool {
        let segments = f64::from(self.level.segments());
        // Edges lie where u, v or u + v is a multiple of a segment.
        [u, v, u + v].into_iter().zip(directions(self.gradients)).any(|(at, [x, y])| {
            let at = at * segments;
            let away = at - at.round();
            let half_pixel = 0.5 * (x * x + y * y).sqrt() * segments;
            // Of two pixels that an edge runs between, one.
            (-half_pixel..half_pixel).contains(&away)
        })
    }
}

/// How u, v and u + v grow for each pixel to the right and down.
fn directions([for_u, for_v]: [[f64; 2]; 2]) -> [[f64; 2]; 3] {
    [for_u, for_v, [for_u[0] + for_v[0], for_u[1] + for_v[1]]]
}

/// A colour over grey, with `darker` eighths taken away.
fn tint(grey: u8, colour: [u8; 3], darker: u16) -> [u8; 3] {
    // Five eighths of the colour: the texture stays visible below it. An average of bytes is one.
    colour.map(|part| ((u16::from(part) * 5 + u16::from(grey) * 3) / 8 * (8 - darker) / 8) as u8)
}

#[cfg(test)]
mod tests {
    use image::Rgba;

    use super::*;
    use crate::{BakeOptions, Filter, LevelChoice, bake};

    fn picture(uvs: &[[f32; 2]], level: u32) -> RgbaImage {
        let texture = Texture::unorm8(2, 1, vec![0, 255]).unwrap();
        let input = BakeInput { texture: &texture, uvs, triangles: &[[0, 1, 2]] };
        let sampler = Sampler::new(AddressMode::Clamp, Filter::Nearest, 0.0);
        let level = LevelChoice::Uniform(SubdivisionLevel::new(level).unwrap());
        let output = bake(&input, &BakeOptions { level, sampler, ..BakeOptions::default() }, &|_| {}).unwrap();
        overlay(&input, sampler, &output)
    }

    fn tinted(state: OpacityState, grey: u8) -> Rgba<u8> {
        let [r, g, b] = tint(grey, colour(state), 0);
        Rgba([r, g, b, 255])
    }

    #[test]
    fn states_tint_the_texture() {
        let picture = picture(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], 2);
        assert_eq!(picture.dimensions(), (512, 256));
        assert_eq!(picture.get_pixel(40, 20), &tinted(OpacityState::Transparent, 0));
        assert_eq!(picture.get_pixel(430, 20), &tinted(OpacityState::Opaque, 255));
        // Beyond the triangle's diagonal the texture is as it was.
        assert_eq!(picture.get_pixel(100, 250), &Rgba([0, 0, 0, 255]));
        assert_eq!(picture.get_pixel(500, 200), &Rgba([255, 255, 255, 255]));
        // An edge of level 2 runs along u = 1/4, between two pixels.
        let (edge, beside) = (picture.get_pixel(127, 40), picture.get_pixel(120, 40));
        assert!(edge.0[2] < beside.0[2], "{edge:?} {beside:?}");
    }

    #[test]
    fn an_atlas_shows_every_layer() {
        let texture = Texture::unorm8(2, 1, vec![0, 255]).unwrap();
        let sampler = Sampler::new(AddressMode::Clamp, Filter::Nearest, 0.0);
        let options = BakeOptions { sampler, ..BakeOptions::default() };
        let halves = [[[0.0, 0.0], [0.4, 0.0], [0.0, 1.0]], [[0.6, 0.0], [1.0, 0.0], [1.0, 1.0]]];
        let inputs = halves.each_ref().map(|uvs| BakeInput { texture: &texture, uvs, triangles: &[[0, 1, 2]] });
        let outputs = inputs.map(|input| bake(&input, &options, &|_| {}).unwrap());
        let layers = [0, 1].map(|layer| Layer { input: inputs[layer], output: &outputs[layer] });
        let picture = atlas(&texture, sampler, &layers);
        assert_eq!(picture.get_pixel(40, 20), &tinted(OpacityState::Transparent, 0));
        assert_eq!(picture.get_pixel(490, 20), &tinted(OpacityState::Opaque, 255));
        assert_eq!(picture.get_pixel(256, 20), &Rgba([255, 255, 255, 255]));
        // Nothing is unknown, so there is no contour to look at.
        assert!(close_up(&inputs[0], sampler, &outputs[0]).is_none());
    }

    #[test]
    fn a_close_up_shows_edges_around_an_unknown_microtriangle() {
        let texture = Texture::unorm8(2, 1, vec![0, 255]).unwrap();
        let uvs = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &[[0, 1, 2]] };
        let sampler = Sampler::new(AddressMode::Clamp, Filter::Linear, 0.0);
        let level = LevelChoice::Uniform(SubdivisionLevel::new(8).unwrap());
        let output = bake(&input, &BakeOptions { level, sampler, ..BakeOptions::default() }, &|_| {}).unwrap();
        let picture = close_up(&input, sampler, &output).unwrap();
        assert_eq!(picture.dimensions(), (CLOSE_UP[0], CLOSE_UP[1]));
        let [r, g, b, _] = picture.get_pixel(CLOSE_UP[0] / 2, CLOSE_UP[1] / 2).0;
        assert!(r > 120 && b < r && g > 60, "unknown states are yellow or pink: {r} {g} {b}");
    }

    #[test]
    fn coordinates_outside_0_to_1_widen_the_view() {
        let wide = picture(&[[-1.0, 0.0], [3.0, 0.0], [-1.0, 2.0]], 0);
        assert_eq!(wide.dimensions(), (512, 128));
        // A mixed triangle of level 0 is one unknown state.
        let unknown = [OpacityState::UnknownOpaque, OpacityState::UnknownTransparent];
        assert!(unknown.iter().any(|&state| wide.get_pixel(20, 60) == &tinted(state, 0)));
        assert_eq!(wide.get_pixel(500, 120), &Rgba([255, 255, 255, 255]));
    }

    #[test]
    fn coordinates_of_any_kind_make_a_picture() {
        for odd in [f32::NAN, f32::INFINITY, f32::MAX, -f32::MAX, 1e-40, 1e9] {
            for uvs in [[[odd, 0.0], [1.0, odd], [0.0, 1.0]], [[odd; 2]; 3], [[odd, 0.0], [odd, 1.0], [odd, 0.5]]] {
                let (width, height) = picture(&uvs, 1).dimensions();
                let texture = Texture::unorm8(2, 1, vec![0, 255]).unwrap();
                let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &[[0, 1, 2]] };
                let output = bake(&input, &BakeOptions::default(), &|_| {}).unwrap();
                if let Some(picture) = close_up(&input, Sampler::default(), &output) {
                    assert_eq!(picture.dimensions(), (CLOSE_UP[0], CLOSE_UP[1]));
                }
                assert!(width.max(height) >= 512 && width.max(height) <= 2048, "{odd}: {width} x {height}");
            }
        }
    }
}
