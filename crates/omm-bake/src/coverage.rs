//! How much of a mesh needs no shader, triangle by triangle.

use omm_model::special_index::TriangleMap;
use serde::{Deserialize, Serialize};

use crate::bake::BakeOutput;
use crate::options::BakeInput;
use crate::packed;
use crate::schedule::corner_uvs;
use crate::texel_triangle::TexelTriangle;

/// How much of a mesh needs no shader.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Coverage {
    /// Of each triangle of the mesh.
    pub triangles: Vec<TriangleCoverage>,
    /// The known part of the area that all triangles cover in the texture, 0..=1: each triangle counts as its texels, however finely it
    /// is split. 0 if nothing has an area.
    pub area_known_fraction: f64,
}

/// How much of one triangle needs no shader.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TriangleCoverage {
    /// The part of its microtriangles that is known, 0..=1. They are all of the same area, so this is the part of its area, too.
    pub known_fraction: f64,
    /// Its area in texels; 0 if it cannot be baked.
    pub texels: f64,
}

/// The coverage of `output`, which was baked from `input`.
#[must_use]
pub fn coverage(input: &BakeInput<'_>, output: &BakeOutput) -> Coverage {
    let of_block = |triangle: &omm_model::triangle::MicromapTriangle| {
        let range = triangle.data_range();
        let data = output.array.get(range.start as usize..range.end as usize).unwrap_or_default();
        packed::count(data, triangle.format, triangle.subdivision_level).known_fraction()
    };
    let of_blocks: Vec<f64> = output.triangles.iter().map(of_block).collect();
    let of_triangle = |(triangle, map): (usize, TriangleMap)| {
        let known_fraction = match map {
            TriangleMap::SpecialIndex(special) => f64::from(u8::from(special.state().is_known())),
            TriangleMap::Triangle(index) => of_blocks.get(index as usize).copied().unwrap_or_default(),
        };
        let texels = corner_uvs(input, triangle).ok().and_then(|uvs| TexelTriangle::new(uvs, input.texture).ok());
        TriangleCoverage { known_fraction, texels: texels.map_or(0.0, |texels| texels.area()) }
    };
    let triangles: Vec<_> = output.triangle_maps().enumerate().map(of_triangle).collect();
    let all: f64 = triangles.iter().map(|triangle| triangle.texels).sum();
    let known: f64 = triangles.iter().map(|triangle| triangle.texels * triangle.known_fraction).sum();
    Coverage { triangles, area_known_fraction: if all > 0.0 { known / all } else { 0.0 } }
}
