//! A byte budget for the array, met by lowering levels where that costs the least coverage for a byte.
//!
//! Coverage is the part of the texture under the mesh that needs no shader, each triangle as often as the mesh has it. What a
//! triangle would cover at a lower level follows from its states at the level it was baked at: a parent is known if its
//! four children are known to be the same. So one pass over the mesh says it for all levels, and only if something has to be lowered
//! there is a second. Of 2-state data, all of which is known, those microtriangles count whose descendants are all alike.
//!
//! Bytes are counted without what blocks of lowered levels come to share, so that the budget is met whatever they do.

use std::collections::HashMap;
use std::hash::DefaultHasher;

use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;

use crate::bake::BakeOutput;
use crate::block::Block;
use crate::collect::Collector;
use crate::error::BakeError;
use crate::layers::Layers;
use crate::lowering::{Choice, Lowering, Profile};
use crate::merge::{self, MAX_ARRAY_BYTES};
use crate::options::{BakeOptions, CutoffStates};
use crate::packed;
use crate::promotion::UnknownStatePromotion;
use crate::schedule::{Job, Schedule, Source};

/// The pass that measures, and what it found.
#[derive(Debug)]
pub(crate) struct Budget<'a> {
    options: &'a BakeOptions,
    limit: u64,
    lowering: Lowering<'a>,
    /// The block of each job, and whether more of it is opaque than not; none if it has no data.
    block_of: Vec<Option<(u32, bool)>>,
    by_content: HashMap<u64, u32>,
    /// The array as it is without lowering, and the entry of each job, as long as the budget is met.
    unlowered: Option<(Collector<'a>, Vec<i32>)>,
}

impl<'a> Budget<'a> {
    pub(crate) fn new(jobs: usize, options: &'a BakeOptions, limit: u64) -> Self {
        Self {
            options,
            limit: limit.min(MAX_ARRAY_BYTES),
            lowering: Lowering::new(options),
            block_of: vec![None; jobs],
            by_content: HashMap::new(),
            unlowered: Some((Collector::new(options), vec![0; jobs])),
        }
    }

    /// Takes note of the block of job number `number`.
    pub(crate) fn measure(
        &mut self,
        schedule: &Schedule<'_>,
        layers: &Layers<'_>,
        number: usize,
        block: &Block,
    ) -> Result<(), BakeError> {
        let job = &schedule.jobs[number];
        if let Some((collector, entries)) = &mut self.unlowered {
            entries[number] = collector.add(block, job.level, job.format, job.uses.into())?;
            if collector.array_bytes() > self.limit {
                self.unlowered = None;
            }
        }
        if self.options.replaces(block.tally.states).is_some() {
            return Ok(());
        }
        // Blocks of which a 64-bit hash, the same in every run, is the same are taken to share their bytes; the end is checked.
        let hash = merge::hash(DefaultHasher::new(), job.level, job.format, &block.data);
        let known = self.options.merge.then(|| self.by_content.get(&hash)).flatten();
        let index = match known {
            Some(&index) => index as usize,
            None => {
                let index = self.lowering.add(job.format, job.level, self.profiles(job, &block.data));
                if self.options.merge {
                    // No more than jobs, of which there are at most i32::MAX.
                    self.by_content.insert(hash, index as u32);
                }
                index
            }
        };
        let states = block.tally.states;
        let is_opaque = 2 * (states.opaque + states.unknown_opaque) >= states.total();
        self.block_of[number] = Some((index as u32, is_opaque));
        let texels = layers.triangle(job).map_or(0.0, |triangle| triangle.area());
        self.lowering.weigh(index, texels * f64::from(job.uses));
        Ok(())
    }

    /// What a block would be at each level, the coarsest first.
    fn profiles(&self, job: &Job, data: &[u8]) -> Vec<Profile> {
        const FORMAT: OpacityMicromapFormat = OpacityMicromapFormat::FourState;
        let BakeOptions { special_indices, promotion, cutoff_states, .. } = *self.options;
        // Only then all that is unknown is surely unknown on one side.
        let one_unknown = job.format == FORMAT
            && promotion != UnknownStatePromotion::Nearest
            && cutoff_states == CutoffStates::default();
        let profile = |data: &[u8], level: SubdivisionLevel| {
            let states = packed::count(data, FORMAT, level);
            let known = states.known_fraction() as f32;
            Profile { known, is_special: special_indices && one_unknown && states.known() == 0 }
        };
        let mut data = match job.format {
            OpacityMicromapFormat::TwoState => packed::to_four_state(data, job.level),
            OpacityMicromapFormat::FourState => data.to_vec(),
        };
        let mut profiles = vec![profile(&data, job.level)];
        for level in std::iter::successors(Some(job.level), |level| level.coarser()) {
            let Some(coarser) = level.coarser() else { break };
            data = packed::coarser(&data, FORMAT, level, UnknownStatePromotion::Nearest);
            profiles.push(profile(&data, coarser));
        }
        profiles.reverse();
        profiles
    }

    /// The result if nothing has to be lowered; otherwise gives the jobs of `schedule` lower levels.
    pub(crate) fn fit(mut self, schedule: &mut Schedule<'_>) -> Result<Option<BakeOutput>, BakeError> {
        if let Some((collector, entries)) = self.unlowered {
            return Ok(Some(collector.finish(schedule.indices(&entries), schedule.facts())));
        }
        self.lowering.lower(self.limit)?;
        for (job, block) in schedule.jobs.iter_mut().zip(&self.block_of) {
            let Some((block, is_opaque)) = *block else { continue };
            match self.lowering.choice(block as usize) {
                Some(Choice::Level(level)) if level == job.level => continue,
                Some(Choice::Level(level)) => job.level = level,
                Some(Choice::GivenUp) | None => {
                    job.source = Source::Uniform(self.options.given_up(is_opaque.into(), 1));
                }
            }
            schedule.lowered += u64::from(job.uses);
        }
        Ok(None)
    }
}
