//! The same bake by this baker and by meshoptimizer.
//!
//! Ours is everything that `omm_bake::bake` does: the texture's planes of bits, the micromap data, special indices, merging,
//! histograms and statistics. Of meshoptimizer only the rasterization of each triangle is timed, without its deduplication,
//! layout and compaction. Both run on the calling thread, in turns of a fifth of a second of processor
//! time, and the fastest of several rounds counts.

use std::time::Duration;

use meshopt::{AlphaTexture, OpacityStates, opacity_map_entry_size, opacity_map_rasterize};
use omm_bake::{
    BakeError, BakeInput, BakeOptions, Classification, LevelChoice, Surface, TexelTriangle, Texture, TextureError,
    bake, classify,
};
use omm_model::curve::MicroTriangle;
use omm_model::format::OpacityMicromapFormat;
use omm_model::opacity::OpacityState;
use omm_model::special_index::TriangleMap;
use serde::Serialize;

use crate::clock::{self, ClockKind, Times};
use crate::workload::Workload;

/// How long a round of one baker lasts.
const ENOUGH: Duration = Duration::from_millis(200);

/// What was measured for one workload.
#[derive(Clone, Debug, Serialize)]
pub struct BakeRow {
    /// The workload's name.
    pub workload: &'static str,
    /// How many microtriangles it has.
    pub microtriangles: u64,
    /// This baker, million microtriangles a second.
    pub ours_mtri_per_s: f64,
    /// meshoptimizer's rasterization, million microtriangles a second.
    pub meshopt_mtri_per_s: f64,
    /// The first over the second.
    pub ratio: f64,
    /// Our slowest round over our fastest, and the same for meshoptimizer: how noisy the measurement was.
    pub spread: [f64; 2],
    /// The part of our states that is known.
    pub ours_known: f64,
    /// The part of meshoptimizer's states that is known.
    pub meshopt_known: f64,
    /// Known states of ours that exact classification contradicts.
    pub ours_unsound: u64,
    /// Known states of meshoptimizer's that exact classification contradicts.
    pub meshopt_unsound: u64,
    /// Unknown states of ours for which exact classification proves one.
    pub ours_missed: u64,
    /// Unknown states of meshoptimizer's for which exact classification proves one.
    pub meshopt_missed: u64,
    /// What time was measured with.
    pub clock: ClockKind,
}

/// Why a workload cannot be measured.
#[derive(Debug)]
pub enum MeasureError {
    /// The texture.
    Texture(TextureError),
    /// The bake.
    Bake(BakeError),
}

impl std::fmt::Display for MeasureError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Texture(error) => error.fmt(f),
            Self::Bake(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for MeasureError {}

/// What was counted in one baker's states.
#[derive(Clone, Copy, Debug, Default)]
struct Judged {
    known: u64,
    unsound: u64,
    missed: u64,
}

impl Judged {
    fn add(&mut self, state: OpacityState, truth: Classification) {
        let proved = match truth {
            Classification::Transparent => Some(OpacityState::Transparent),
            Classification::Opaque => Some(OpacityState::Opaque),
            Classification::Mixed | Classification::Undecided => None,
        };
        self.known += u64::from(state.is_known());
        self.unsound += u64::from(state.is_known() && Some(state) != proved);
        self.missed += u64::from(!state.is_known() && proved.is_some());
    }
}

/// Bakes `workload` with both, `rounds` times each.
///
/// # Errors
/// [`MeasureError`] if the baker refuses the workload.
pub fn measure(workload: &Workload, rounds: u32) -> Result<BakeRow, MeasureError> {
    let alpha = workload.alpha();
    let texture =
        Texture::unorm8(workload.texture_side, workload.texture_side, alpha.clone()).map_err(MeasureError::Texture)?;
    let (uvs, triangles) = (workload.uvs(), workload.indices());
    let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
    let level = workload.subdivision_level();
    let options = BakeOptions { level: LevelChoice::Uniform(level), ..BakeOptions::default() };
    let peer = Peer { alpha: &alpha, workload };

    let (mut ours, mut theirs) = (Times::default(), Times::default());
    let mut output = None;
    let mut data = peer.buffer();
    for _ in 0..rounds.max(1) {
        let (time, baked) = clock::time(ENOUGH, || bake(&input, &options, &|_| {}));
        ours.add(time);
        output = Some(baked.map_err(MeasureError::Bake)?);
        let (time, ()) = clock::time(ENOUGH, || peer.bake(&uvs, &mut data));
        theirs.add(time);
    }
    let output = output.unwrap_or_default();

    let surface = Surface::new(&texture, options.sampler, options.alpha_cutoff)
        .map_err(|error| MeasureError::Bake(error.into()))?;
    let (mut our_states, mut their_states) = (Judged::default(), Judged::default());
    for ((uvs, map), theirs) in
        uvs.chunks_exact(3).zip(output.triangle_maps()).zip(data.chunks_exact(peer.entry_size()))
    {
        let [a, b, c] = uvs else { continue };
        let Ok(triangle) = TexelTriangle::new([*a, *b, *c], &texture) else { continue };
        for microtriangle in MicroTriangle::all(level) {
            let truth = classify(&surface, &triangle, microtriangle);
            let index = u64::from(microtriangle.index());
            let state = match map {
                TriangleMap::SpecialIndex(special) => Some(special.state()),
                TriangleMap::Triangle(entry) => output
                    .triangles
                    .get(entry as usize)
                    .and_then(|entry| entry.format.state(output.array.get(entry.data_offset as usize..)?, index)),
            };
            let their_state = OpacityMicromapFormat::FourState.state(theirs, index);
            state.into_iter().for_each(|state| our_states.add(state, truth));
            their_state.into_iter().for_each(|state| their_states.add(state, truth));
        }
    }
    let microtriangles = workload.microtriangles();
    let rate = |times: &Times| microtriangles as f64 / times.least().as_secs_f64() / 1e6;
    let known = |judged: Judged| judged.known as f64 / microtriangles as f64;
    Ok(BakeRow {
        workload: workload.name,
        microtriangles,
        ours_mtri_per_s: rate(&ours),
        meshopt_mtri_per_s: rate(&theirs),
        ratio: rate(&ours) / rate(&theirs),
        spread: [ours.spread(), theirs.spread()],
        ours_known: known(our_states),
        meshopt_known: known(their_states),
        ours_unsound: our_states.unsound,
        meshopt_unsound: their_states.unsound,
        ours_missed: our_states.missed,
        meshopt_missed: their_states.missed,
        clock: clock::kind(),
    })
}

/// meshoptimizer's baker: linear filter, wrapping, cutoff 0.5, 4 states.
struct Peer<'a> {
    alpha: &'a [u8],
    workload: &'a Workload,
}

impl Peer<'_> {
    fn level(&self) -> u8 {
        // At most 12.
        self.workload.subdivision_level().get() as u8
    }

    fn entry_size(&self) -> usize {
        opacity_map_entry_size(self.level(), OpacityStates::Four)
    }

    fn buffer(&self) -> Vec<u8> {
        vec![0; self.entry_size() * self.workload.triangles as usize]
    }

    fn bake(&self, uvs: &[[f32; 2]], data: &mut [u8]) {
        let side = self.workload.texture_side;
        let texture = AlphaTexture { data: self.alpha, stride: 1, pitch: side as usize, width: side, height: side };
        for (uvs, entry) in uvs.chunks_exact(3).zip(data.chunks_exact_mut(self.entry_size())) {
            let [a, b, c] = uvs else { continue };
            opacity_map_rasterize(entry, self.level(), OpacityStates::Four, &[*a, *b, *c], &texture);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ours_never_contradicts_the_texture() {
        for workload in Workload::PEERS {
            let row = measure(&workload.scaled_down(64), 1).unwrap();
            assert_eq!((row.ours_unsound, row.ours_missed), (0, 0), "{row:?}");
            assert!(row.ours_known > 0.5 && row.ours_known < 1.0, "{row:?}");
            // The peer reads the same texture in the same order on the curve, or nothing would agree.
            assert!((row.meshopt_unsound as f64) < 0.01 * row.microtriangles as f64, "{row:?}");
        }
    }
}
