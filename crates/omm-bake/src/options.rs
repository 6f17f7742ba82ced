//! What a bake is asked for.

use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;
use omm_model::special_index::OpacityMicromapSpecialIndex;
use serde::{Deserialize, Serialize};

use crate::error::BakeError;
use crate::level::LevelChoice;
use crate::mip::MipChoice;
use crate::order::BlockOrder;
use crate::promotion::UnknownStatePromotion;
use crate::sampler::Sampler;
use crate::statistics::StateCounts;
use crate::texture::Texture;

/// The largest [`BakeOptions::block_alignment`], in bytes.
pub const MAX_BLOCK_ALIGNMENT: u32 = 1 << 16;

/// What is baked.
#[derive(Clone, Copy, Debug)]
pub struct BakeInput<'a> {
    /// The alpha texture, exactly as the shader sees it.
    pub texture: &'a Texture,
    /// Texture coordinates (u, v) of the vertices. Any number is taken; see [`BakeOptions::unbakeable`].
    /// [`read_uvs`](crate::input::read_uvs) reads other formats.
    pub uvs: &'a [[f32; 2]],
    /// Three indices into `uvs` for each triangle. [`read_triangles`](crate::input::read_triangles) reads other formats.
    pub triangles: &'a [[u32; 3]],
}

/// How it is baked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BakeOptions {
    /// Format of the micromap triangles. 2-state data has no unknown states: each becomes the one that its name ends in.
    pub format: OpacityMicromapFormat,
    /// How finely triangles are split.
    pub level: LevelChoice,
    /// For each triangle of the mesh a level and a format of its own; empty if none has any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub overrides: Vec<TriangleOverride>,
    /// How the shader reads the texture.
    pub sampler: Sampler,
    /// Which mips of the texture it may read.
    pub mips: MipChoice,
    /// Opaque is alpha above this; not NaN.
    pub alpha_cutoff: f32,
    /// The states on both sides of the cutoff.
    pub cutoff_states: CutoffStates,
    /// Which unknown state mixed microtriangles get.
    pub promotion: UnknownStatePromotion,
    /// Whether a triangle of one state gets a special index instead of data.
    pub special_indices: bool,
    /// What a triangle gets whose texture coordinates are not finite, or too far out to name texels. Without
    /// `special_indices` it is a block of this state.
    pub unbakeable: OpacityMicromapSpecialIndex,
    /// A triangle of which a smaller part than this is known, 0..=1, gets an unknown special index instead of data: looking it up
    /// would save too few calls of a shader. Of the side that `promotion` chooses for it as a whole.
    pub rejection_threshold: f32,
    /// Whether triangles may share data: those with the same texture coordinates are baked once, and blocks of the same bytes are
    /// stored once.
    pub merge: bool,
    /// Whether triangles may share data that is almost the same: the part of a triangle's microtriangles, 0..=1, that may become
    /// unknown for that. 0 is none. Only 4-state data is shared so.
    pub merge_distance: f32,
    /// In which order blocks of one level lie in the array.
    pub order: BlockOrder,
    /// Every block starts at a multiple of so many bytes, a power of two up to [`MAX_BLOCK_ALIGNMENT`]. Blocks are always aligned to their own size,
    /// or to this if it is more.
    pub block_alignment: u32,
    /// The most bytes that the array may have. Levels are lowered where that costs the least coverage for a byte until it is met.
    pub max_array_bytes: Option<u64>,
    /// The most work that may be done, as [`WorkEstimate::work`](crate::WorkEstimate::work) counts it. More is refused at once.
    pub max_work: Option<u64>,
}

/// A triangle's own level and format. What is `None` is as for the others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(default)]
pub struct TriangleOverride {
    /// Its level, instead of [`BakeOptions::level`].
    pub level: Option<SubdivisionLevel>,
    /// Its format, instead of [`BakeOptions::format`].
    pub format: Option<OpacityMicromapFormat>,
}

/// What the shader's alpha test makes of both sides of the cutoff.
///
/// Smoke that is blended where it is not clear has `greater` [`UnknownOpaque`](OpacityState::UnknownOpaque): a shader must see
/// it, but none is called where there is nothing. A shader that keeps what lies below the cutoff has both states exchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(default)]
pub struct CutoffStates {
    /// The state of a microtriangle on all of which alpha is above the cutoff.
    pub greater: OpacityState,
    /// The state of a microtriangle on all of which alpha is at most the cutoff.
    pub less_or_equal: OpacityState,
}

impl Default for CutoffStates {
    /// Opaque and transparent.
    fn default() -> Self {
        Self { greater: OpacityState::Opaque, less_or_equal: OpacityState::Transparent }
    }
}

impl CutoffStates {
    /// What each state of data that was baked with the default states becomes under `promotion`: a mixed microtriangle is
    /// unknown on the side of the state that it would have been taken for, unless a side is forced.
    pub(crate) fn names(self, promotion: UnknownStatePromotion) -> [OpacityState; 4] {
        let Self { greater, less_or_equal } = self;
        let unknown = |side: OpacityState| match (promotion, side.to_two_state()) {
            (UnknownStatePromotion::ForceOpaque, _) => OpacityState::UnknownOpaque,
            (UnknownStatePromotion::ForceTransparent, _) => OpacityState::UnknownTransparent,
            (UnknownStatePromotion::Nearest, OpacityState::Opaque) => OpacityState::UnknownOpaque,
            (UnknownStatePromotion::Nearest, _) => OpacityState::UnknownTransparent,
        };
        [less_or_equal, greater, unknown(less_or_equal), unknown(greater)]
    }
}

impl Default for BakeOptions {
    /// 4-state data at dynamic levels, one microtriangle for 2 x 2 texels and no finer than level 8, for a linear filter that
    /// wraps, a cutoff of 0.5 and all mips; special indices and sharing of equal data on; no budgets.
    fn default() -> Self {
        let max = SubdivisionLevel::new(8).unwrap_or(SubdivisionLevel::MAX);
        Self {
            format: OpacityMicromapFormat::FourState,
            level: LevelChoice::Dynamic { scale: 2.0, max },
            overrides: Vec::new(),
            sampler: Sampler::default(),
            mips: MipChoice::All,
            alpha_cutoff: 0.5,
            cutoff_states: CutoffStates::default(),
            promotion: UnknownStatePromotion::Nearest,
            special_indices: true,
            unbakeable: OpacityMicromapSpecialIndex::FullyUnknownOpaque,
            rejection_threshold: 0.0,
            merge: true,
            merge_distance: 0.0,
            order: BlockOrder::Spatial,
            block_alignment: 1,
            max_array_bytes: None,
            max_work: None,
        }
    }
}

impl BakeOptions {
    /// Whether each number is in its range and no option contradicts another, for a mesh of `triangles` triangles.
    pub(crate) fn check(&self, triangles: usize) -> Result<(), BakeError> {
        if let LevelChoice::Dynamic { scale, max: _ } = self.level
            && !(scale.is_finite() && scale > 0.0)
        {
            return Err(BakeError::DynamicScale { found: scale });
        }
        let fractions = [("rejection_threshold", self.rejection_threshold), ("merge_distance", self.merge_distance)];
        if let Some((option, found)) = fractions.into_iter().find(|(_, found)| !(0.0..=1.0).contains(found)) {
            return Err(BakeError::Fraction { option, found });
        }
        let found = self.block_alignment;
        if !found.is_power_of_two() || found > MAX_BLOCK_ALIGNMENT {
            return Err(BakeError::BlockAlignment { found });
        }
        if !self.overrides.is_empty() && self.overrides.len() != triangles {
            return Err(BakeError::OverrideCount { found: self.overrides.len(), required: triangles });
        }
        self.check_contradictions()
    }

    fn check_contradictions(&self) -> Result<(), BakeError> {
        let contradiction = |option, with, remedy| Err(BakeError::Contradiction { option, with, remedy });
        if self.rejection_threshold > 0.0 && !self.special_indices {
            let remedy = "allow special indices, or reject nothing";
            return contradiction("rejection_threshold above 0", "no special_indices", remedy);
        }
        if self.merge_distance > 0.0 && !self.merge {
            let remedy = "allow merging, or set the distance to 0";
            return contradiction("merge_distance above 0", "no merge", remedy);
        }
        let four_state = Some(OpacityMicromapFormat::FourState);
        let has_unknown = Some(self.format) == four_state || self.overrides.iter().any(|o| o.format == four_state);
        if self.merge_distance > 0.0 && !has_unknown {
            let remedy = "2-state data has no unknown state for what differs: use 4-state, or set the distance to 0";
            return contradiction("merge_distance above 0", "2-state format", remedy);
        }
        Ok(())
    }

    /// The level and format that triangle `triangle` asks for itself.
    pub(crate) fn override_of(&self, triangle: usize) -> TriangleOverride {
        self.overrides.get(triangle).copied().unwrap_or_default()
    }

    /// The special index that stands for a block with these states, if one may.
    pub(crate) fn replaces(&self, states: StateCounts) -> Option<OpacityMicromapSpecialIndex> {
        let rejected = states.known_fraction() < self.rejection_threshold.into();
        let given_up = || self.given_up(states.opaque + states.unknown_opaque, states.total());
        let state = states.only_state().or_else(|| rejected.then(given_up));
        state.filter(|_| self.special_indices).map(OpacityMicromapSpecialIndex::of_state)
    }

    /// The unknown state of a triangle that is given up, if so many of so many microtriangles have the opaque side.
    pub(crate) fn given_up(&self, opaque: u64, total: u64) -> OpacityState {
        match self.promotion {
            UnknownStatePromotion::ForceOpaque => OpacityState::UnknownOpaque,
            UnknownStatePromotion::Nearest if 2 * opaque >= total => OpacityState::UnknownOpaque,
            UnknownStatePromotion::Nearest | UnknownStatePromotion::ForceTransparent => {
                OpacityState::UnknownTransparent
            }
        }
    }
}
