//! What a bake is asked for.

use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::special_index::OpacityMicromapSpecialIndex;
use serde::{Deserialize, Serialize};

use crate::level::LevelChoice;
use crate::promotion::UnknownStatePromotion;
use crate::sampler::Sampler;
use crate::texture::Texture;

/// What is baked.
#[derive(Clone, Copy, Debug)]
pub struct BakeInput<'a> {
    /// The alpha texture, exactly as the shader sees it.
    pub texture: &'a Texture,
    /// Texture coordinates (u, v) of the vertices. Any number is taken; see [`BakeOptions::unbakeable`].
    pub uvs: &'a [[f32; 2]],
    /// Three indices into `uvs` for each triangle.
    pub triangles: &'a [[u32; 3]],
}

/// How it is baked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BakeOptions {
    /// Format of all micromap triangles. 2-state data has no unknown states: each becomes the one that its name ends in.
    pub format: OpacityMicromapFormat,
    /// How finely triangles are split.
    pub level: LevelChoice,
    /// How the shader reads the texture.
    pub sampler: Sampler,
    /// Opaque is alpha above this; not NaN.
    pub alpha_cutoff: f32,
    /// Which unknown state mixed microtriangles get.
    pub promotion: UnknownStatePromotion,
    /// Whether a triangle of one state gets a special index instead of data.
    pub special_indices: bool,
    /// What a triangle gets whose texture coordinates are not finite, or too far out to name texels. Without
    /// `special_indices` it is a block of this state.
    pub unbakeable: OpacityMicromapSpecialIndex,
    /// Whether triangles may share data: those with the same texture coordinates are baked once, and blocks of the same bytes are
    /// stored once.
    pub merge: bool,
}

impl Default for BakeOptions {
    /// 4-state data at dynamic levels, one microtriangle for 2 x 2 texels and no finer than level 8, for a linear filter that
    /// wraps and a cutoff of 0.5; special indices and sharing on.
    fn default() -> Self {
        let max = SubdivisionLevel::new(8).unwrap_or(SubdivisionLevel::MAX);
        Self {
            format: OpacityMicromapFormat::FourState,
            level: LevelChoice::Dynamic { scale: 2.0, max },
            sampler: Sampler::default(),
            alpha_cutoff: 0.5,
            promotion: UnknownStatePromotion::Nearest,
            special_indices: true,
            unbakeable: OpacityMicromapSpecialIndex::FullyUnknownOpaque,
            merge: true,
        }
    }
}
