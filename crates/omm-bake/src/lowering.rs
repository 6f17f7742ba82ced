//! Which blocks get a lower level so that all together have no more bytes than they may.
//!
//! Blocks are lowered one by one, always the one that loses the least coverage for each byte saved, to the level at which
//! that is so. With special indices the last step is to give a triangle up: it becomes unknown and has no data.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;

use crate::error::BakeError;
use crate::options::BakeOptions;
use crate::schedule::padded_size;

/// What becomes of a block. A finer level is greater.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Choice {
    /// An unknown special index stands for it.
    GivenUp,
    /// It has this level.
    Level(SubdivisionLevel),
}

/// What a block would be at some level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Profile {
    /// The part of it that is known, 0..=1.
    pub(crate) known: f32,
    /// Whether it has no data, as a special index stands for it.
    pub(crate) is_special: bool,
}

/// A block.
#[derive(Debug)]
struct Block {
    format: OpacityMicromapFormat,
    /// Texels under all triangles of the mesh that it stands for.
    weight: f64,
    /// Where its profiles begin.
    profile: usize,
    choice: Choice,
}

/// All blocks of a bake, and what each would be at lower levels.
#[derive(Debug)]
pub(crate) struct Lowering<'a> {
    options: &'a BakeOptions,
    blocks: Vec<Block>,
    profiles: Vec<Profile>,
}

/// One block lowered. The greatest is the one to take.
#[derive(Debug, PartialEq)]
struct Step {
    /// Coverage lost for each byte saved.
    price: f64,
    saved: u64,
    block: usize,
    to: Choice,
}

impl Eq for Step {}

impl Ord for Step {
    fn cmp(&self, other: &Self) -> Ordering {
        let cheap = other.price.total_cmp(&self.price);
        cheap.then(self.saved.cmp(&other.saved)).then(Reverse(self.block).cmp(&Reverse(other.block)))
    }
}

impl PartialOrd for Step {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<'a> Lowering<'a> {
    pub(crate) fn new(options: &'a BakeOptions) -> Self {
        Self { options, blocks: Vec::new(), profiles: Vec::new() }
    }

    /// Adds a block with a profile for each level up to its own, the coarsest first. Returns its number.
    pub(crate) fn add(
        &mut self,
        format: OpacityMicromapFormat,
        level: SubdivisionLevel,
        profiles: impl IntoIterator<Item = Profile>,
    ) -> usize {
        let profile = self.profiles.len();
        self.profiles.extend(profiles);
        self.blocks.push(Block { format, weight: 0.0, profile, choice: Choice::Level(level) });
        self.blocks.len() - 1
    }

    /// The block stands for so many more texels under triangles of the mesh.
    pub(crate) fn weigh(&mut self, block: usize, texels: f64) {
        if let Some(block) = self.blocks.get_mut(block) {
            block.weight += texels;
        }
    }

    /// Texels that a block stands for.
    pub(crate) fn weight(&self, block: usize) -> f64 {
        self.blocks.get(block).map_or(0.0, |block| block.weight)
    }

    /// What has become of a block.
    pub(crate) fn choice(&self, block: usize) -> Option<Choice> {
        self.blocks.get(block).map(|block| block.choice)
    }

    /// The profile of a block as it is.
    pub(crate) fn profile(&self, block: usize) -> Option<Profile> {
        self.blocks.get(block).map(|block| self.profile_of(block, block.choice))
    }

    /// Bytes of a block as it is.
    pub(crate) fn bytes(&self, block: usize) -> u64 {
        self.blocks.get(block).map_or(0, |block| self.bytes_of(block, block.choice))
    }

    /// Lowers blocks until they have at most `limit` bytes, and returns how many they have then.
    pub(crate) fn lower(&mut self, limit: u64) -> Result<u64, BakeError> {
        let mut total: u64 = (0..self.blocks.len()).map(|block| self.bytes(block)).sum();
        let mut steps: BinaryHeap<Step> = (0..self.blocks.len()).filter_map(|block| self.step(block)).collect();
        while total > limit {
            let Some(Step { saved, block, to, .. }) = steps.pop() else {
                return Err(BakeError::ArrayBudget { least: total, limit });
            };
            total -= saved;
            if let Some(block) = self.blocks.get_mut(block) {
                block.choice = to;
            }
            steps.extend(self.step(block));
        }
        Ok(total)
    }

    /// The cheapest way to lower a block further; the shortest of equally cheap ones.
    fn step(&self, number: usize) -> Option<Step> {
        let block = self.blocks.get(number)?;
        let Choice::Level(level) = block.choice else { return None };
        let (now, bytes) = (self.profile_of(block, block.choice), self.bytes_of(block, block.choice));
        let coarser = std::iter::successors(level.coarser(), |level| level.coarser()).map(Choice::Level);
        let given_up = self.options.special_indices.then_some(Choice::GivenUp);
        let mut best: Option<Step> = None;
        for to in coarser.chain(given_up) {
            let saved = bytes.saturating_sub(self.bytes_of(block, to));
            let lost = block.weight * f64::from((now.known - self.profile_of(block, to).known).max(0.0));
            let step = Step { price: lost / saved as f64, saved, block: number, to };
            if saved > 0 && best.as_ref().is_none_or(|best| step.price < best.price) {
                best = Some(step);
            }
        }
        best
    }

    fn profile_of(&self, block: &Block, choice: Choice) -> Profile {
        let nothing = Profile { known: 0.0, is_special: true };
        match choice {
            Choice::GivenUp => nothing,
            Choice::Level(level) => self.profiles.get(block.profile + level.get() as usize).copied().unwrap_or(nothing),
        }
    }

    fn bytes_of(&self, block: &Block, choice: Choice) -> u64 {
        match choice {
            Choice::Level(level) if !self.profile_of(block, choice).is_special => {
                padded_size(block.format, level, self.options)
            }
            Choice::Level(_) | Choice::GivenUp => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const FORMAT: OpacityMicromapFormat = OpacityMicromapFormat::FourState;

    fn level(level: u32) -> SubdivisionLevel {
        SubdivisionLevel::new(level).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

        /// Where all steps save the same, the best choice is known: those that lose the least.
        #[test]
        fn the_cheapest_steps_are_taken(blocks in prop::collection::vec((0.0_f32..1.0, 0.0_f32..1.0, 0.0_f64..9.0), 1..12), part in 0.0_f64..1.0) {
            let options = BakeOptions { special_indices: false, ..BakeOptions::default() };
            let mut lowering = Lowering::new(&options);
            let mut losses = Vec::new();
            for &(fine, coarse, weight) in &blocks {
                let profile = |known| Profile { known, is_special: false };
                let block = lowering.add(FORMAT, level(2), [profile(0.0), profile(fine * coarse), profile(fine)]);
                lowering.weigh(block, weight);
                losses.push(weight * f64::from(fine - fine * coarse));
            }
            // 4 bytes each, 1 when lowered.
            let (most, least) = (4 * blocks.len() as u64, blocks.len() as u64);
            let limit = least + ((most - least) as f64 * part) as u64;
            let total = lowering.lower(limit).unwrap();
            prop_assert!(total <= limit && limit - total < 3);
            let lost: f64 = (0..blocks.len())
                .filter(|&block| lowering.choice(block) == Some(Choice::Level(level(1))))
                .map(|block| losses[block])
                .sum();
            losses.sort_by(f64::total_cmp);
            let best: f64 = losses.iter().take((most - total) as usize / 3).sum();
            prop_assert!((lost - best).abs() <= 1e-9, "{} {}", lost, best);
            let refused = lowering.lower(least - 1);
            prop_assert_eq!(refused, Err(BakeError::ArrayBudget { least, limit: least - 1 }));
        }
    }

    /// A level that only loses is passed over for one that saves, and nothing is given up before it has to be.
    #[test]
    fn levels_are_lowered_as_far_as_it_is_cheapest() {
        let options = BakeOptions::default();
        let mut lowering = Lowering::new(&options);
        let profile = |known| Profile { known, is_special: false };
        let block = lowering.add(FORMAT, level(3), [0.0, 0.0, 0.5, 0.5].map(profile));
        lowering.weigh(block, 1.0);
        assert_eq!((lowering.lower(15), lowering.choice(block)), (Ok(4), Some(Choice::Level(level(2)))));
        // Giving up saves 4 bytes for the same loss as level 1, which saves 3.
        assert_eq!((lowering.lower(3), lowering.choice(block)), (Ok(0), Some(Choice::GivenUp)));
    }
}
