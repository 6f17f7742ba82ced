//! One job baked: from one mip at once, or from several whose states are combined.

use omm_model::format::OpacityMicromapFormat;

use crate::block::{Block, BlockBaker, Tally};
use crate::error::BakeError;
use crate::options::{BakeOptions, CutoffStates};
use crate::packed;
use crate::patch::Patch;
use crate::planes::Planes;
use crate::schedule::{Job, Schedule, Source};
use crate::surface::Surface;
use crate::texel_triangle::TexelTriangle;

/// A mip as the shader sees it.
#[derive(Debug)]
struct Layer<'a> {
    surface: Surface<'a>,
    planes: Planes,
}

/// All mips that the shader may read.
#[derive(Debug)]
pub(crate) struct Layers<'a> {
    layers: Vec<Layer<'a>>,
    options: &'a BakeOptions,
}

impl<'a> Layers<'a> {
    pub(crate) fn new(schedule: &Schedule<'a>, options: &'a BakeOptions) -> Result<Self, BakeError> {
        let layer = |mip| {
            let surface = Surface::new(mip, options.sampler, options.alpha_cutoff)?;
            let planes = Planes::new(&surface);
            Ok(Layer { surface, planes })
        };
        let layers = schedule.mips.iter().copied().map(layer).collect::<Result<_, BakeError>>()?;
        Ok(Self { layers, options })
    }

    /// The triangle of `job` in texels of the finest mip.
    pub(crate) fn triangle(&self, job: &Job) -> Option<TexelTriangle> {
        TexelTriangle::new(job.uvs, self.layers.first()?.surface.texture()).ok()
    }

    /// The data of `job`; none if a special index will stand for it. `patch` is room to work in, and `finished` is told of microtriangles
    /// that are done.
    pub(crate) fn bake(&self, job: &Job, patch: &mut Patch, finished: &(dyn Fn(u64) + Sync)) -> Block {
        let state = match job.source {
            Source::Texels => return self.bake_texels(job, patch, finished),
            Source::Uniform(state) => state,
        };
        let mut block = Block::default();
        if self.options.special_indices {
            block.tally.states.add(state, job.level.microtriangles().into());
        } else if let Some(baker) = self.bakers(job.format).next() {
            block = baker.uniform(state, job.level);
        }
        block
    }

    /// A baker for each mip.
    fn bakers(&self, format: OpacityMicromapFormat) -> impl Iterator<Item = BlockBaker<'_>> {
        let promotion = self.options.promotion;
        self.layers.iter().map(move |Layer { surface, planes }| BlockBaker { surface, planes, format, promotion })
    }

    fn bake_texels(&self, job: &Job, patch: &mut Patch, finished: &(dyn Fn(u64) + Sync)) -> Block {
        let is_plain = self.layers.len() == 1 && self.options.cutoff_states == CutoffStates::default();
        let format = if is_plain { job.format } else { OpacityMicromapFormat::FourState };
        let mut block = Block::default();
        for (mip, baker) in self.bakers(format).enumerate() {
            // Found to succeed for the first mip, and the others are no larger.
            let Ok(triangle) = TexelTriangle::new(job.uvs, baker.surface.texture()) else { continue };
            if mip == 0 {
                block = baker.bake(&triangle, job.level, patch, finished);
            } else if packed::count(&block.data, format, job.level).known() == 0 {
                // Nothing that could become unknown.
                finished(job.level.microtriangles().into());
            } else {
                let other = baker.bake(&triangle, job.level, patch, finished);
                packed::combine(&mut block.data, &other.data);
                block.tally.undecided += other.tally.undecided;
            }
        }
        if !is_plain {
            self.finish(job, &mut block);
        }
        block
    }

    /// Makes of combined 4-state data what was asked for.
    fn finish(&self, job: &Job, block: &mut Block) {
        let BakeOptions { promotion, cutoff_states, .. } = *self.options;
        packed::settle(&mut block.data, promotion);
        packed::rename(&mut block.data, job.level, cutoff_states.names(promotion));
        if job.format == OpacityMicromapFormat::TwoState {
            block.data = packed::to_two_state(&block.data);
        }
        let states = packed::count(&block.data, job.format, job.level);
        block.tally = Tally { states, ..block.tally };
    }
}
