//! Mips, and the states on both sides of the cutoff: every microtriangle by brute force over each mip.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;
mod oracle;

use common::{Random, level, states_at, uniform};
use num_rational::{BigRational, Ratio};
use omm_bake::{
    AddressMode, BakeError, BakeInput, BakeOptions, Classification, CutoffStates, Filter, MipChoice, Sampler, Texture,
    UnknownStatePromotion, bake,
};
use omm_model::curve::MicroTriangle;
use omm_model::format::OpacityMicromapFormat;
use omm_model::opacity::OpacityState;
use oracle::Scene;
use rayon::prelude::*;

/// A texture of few texels with all its mips, which have nothing to do with each other.
struct Chain {
    sizes: Vec<[u32; 2]>,
    values: Vec<Vec<f64>>,
}

impl Chain {
    fn random(random: &mut Random, powers: bool) -> Self {
        let mut side = || if powers { 1 << random.below(3) } else { 1 + random.below(7) as u32 };
        let mut sizes = vec![[side(), side()]];
        while let Some(&[width, height]) = sizes.last().filter(|size| **size != [1, 1]) {
            sizes.push([width, height].map(|side| (side / 2).max(1)));
        }
        let palette = random.pick::<&[f64]>(&[&[0.0, 255.0], &[0.0, 255.0, 255.0, 255.0], &[0.0, 51.0, 128.0, 255.0]]);
        let values = sizes.iter().map(|[w, h]| (0..w * h).map(|_| random.pick(palette)).collect()).collect();
        Self { sizes, values }
    }

    fn texture(&self) -> Texture {
        let mip = |(&[w, h], values): (&[u32; 2], &Vec<f64>)| {
            Texture::unorm8(w, h, values.iter().map(|&value| value as u8).collect()).unwrap()
        };
        let mut mips: Vec<Texture> = self.sizes.iter().zip(&self.values).map(mip).collect();
        let first = mips.remove(0);
        first.with_mips(mips).unwrap()
    }
}

struct Case {
    chain: Chain,
    options: BakeOptions,
    mips: std::ops::RangeInclusive<usize>,
    uvs: [[f32; 2]; 3],
    level: u32,
    /// Coordinates have few bits.
    few_bits: bool,
}

impl Case {
    fn random(seed: u64) -> Self {
        let mut random = Random(seed);
        let few_bits = random.below(4) != 0;
        let chain = Chain::random(&mut random, few_bits);
        let count = chain.sizes.len() as u64;
        let (a, b) = (random.below(count), random.below(count));
        let (first, last) = (a.min(b), a.max(b));
        let all = random.below(3) == 0;
        let known = [OpacityState::Transparent, OpacityState::Opaque];
        let (cutoff_states, format) = match random.below(4) {
            0 => (CutoffStates { greater: OpacityState::UnknownOpaque, ..CutoffStates::default() }, 1),
            1 => (CutoffStates { greater: known[0], less_or_equal: known[1] }, random.below(2)),
            _ => (CutoffStates::default(), random.below(2)),
        };
        let of_level = random.below(4) as u32;
        let options = BakeOptions {
            mips: if all { MipChoice::All } else { MipChoice::Range { first: first as u32, last: last as u32 } },
            sampler: Sampler {
                address_mode_u: random.pick(&AddressMode::ALL),
                address_mode_v: random.pick(&AddressMode::ALL),
                filter: random.pick(&[Filter::Linear, Filter::Nearest]),
                border_alpha: random.pick(&[0.0, 1.0]),
            },
            cutoff_states,
            format: OpacityMicromapFormat::ALL[format as usize],
            promotion: random.pick(&[
                UnknownStatePromotion::Nearest,
                UnknownStatePromotion::ForceOpaque,
                UnknownStatePromotion::ForceTransparent,
            ]),
            special_indices: random.below(2) == 0,
            ..uniform(of_level)
        };
        let size = chain.sizes[0];
        let grid =
            |random: &mut Random, side: u32| (random.below(u64::from(12 * side)) as f32 / 4.0) / side as f32 - 1.0;
        let uvs = [[0; 2]; 3].map(|_| [grid(&mut random, size[0]), grid(&mut random, size[1])]);
        let mips = if all { 0..=chain.sizes.len() - 1 } else { first as usize..=last as usize };
        Self { chain, options, mips, uvs, level: of_level, few_bits }
    }

    /// What holds of a microtriangle at each mip.
    fn truths(&self, microtriangle: MicroTriangle) -> Vec<Classification> {
        let BakeOptions { sampler, alpha_cutoff: cutoff, .. } = self.options;
        let weights = microtriangle.corners().map(|corner| (corner.u, corner.v));
        let truth = |mip: usize| {
            let [width, height] = self.chain.sizes[mip].map(i64::from);
            let scene = Scene {
                width,
                height,
                values: &self.chain.values[mip],
                unit: 255.0,
                address_modes: [sampler.address_mode_u, sampler.address_mode_v],
                filter: sampler.filter,
                border: sampler.border_alpha,
                cutoff,
            };
            if self.few_bits {
                scene.classify(Scene::corners::<Ratio<i128>>(self.uvs, weights, self.level))
            } else {
                scene.classify(Scene::corners::<BigRational>(self.uvs, weights, self.level))
            }
        };
        self.mips.clone().map(truth).collect()
    }

    /// Compares all microtriangles; how many there were, and how many of them known and mixed.
    fn check(&self) -> [u64; 3] {
        let texture = self.chain.texture();
        let input = BakeInput { texture: &texture, uvs: &self.uvs, triangles: &[[0, 1, 2]] };
        let output = bake(&input, &self.options, &|_| {}).unwrap();
        assert_eq!(output.statistics.undecided, 0);
        let CutoffStates { greater, less_or_equal } = self.options.cutoff_states;
        let is_two_state = self.options.format == OpacityMicromapFormat::TwoState;
        let as_stored = |state: OpacityState| if is_two_state { state.to_two_state() } else { state };
        let found = states_at(&output, 0, level(self.level));
        let mut counts = [0; 3];
        for (found, microtriangle) in found.into_iter().zip(MicroTriangle::all(level(self.level))) {
            let truths = self.truths(microtriangle);
            let all = |of: Classification| truths.iter().all(|&truth| truth == of);
            let what = format!("{found:?} {truths:?} {:?}", self.options);
            counts[0] += 1;
            if all(Classification::Opaque) || all(Classification::Transparent) {
                let expected = if all(Classification::Opaque) { greater } else { less_or_equal };
                assert_eq!(found, as_stored(expected), "{what}");
                counts[1] += 1;
                continue;
            }
            counts[2] += 1;
            let expected = match (self.options.promotion, truths[0]) {
                (UnknownStatePromotion::ForceOpaque, _) => OpacityState::UnknownOpaque,
                (UnknownStatePromotion::ForceTransparent, _) => OpacityState::UnknownTransparent,
                // On the side of the finest mip.
                (_, Classification::Opaque) if greater.to_two_state() == OpacityState::Opaque => {
                    OpacityState::UnknownOpaque
                }
                (_, Classification::Transparent) if less_or_equal == OpacityState::Opaque => {
                    OpacityState::UnknownOpaque
                }
                (_, Classification::Opaque | Classification::Transparent) => OpacityState::UnknownTransparent,
                _ => {
                    assert!(is_two_state || !found.is_known(), "{what}");
                    continue;
                }
            };
            assert_eq!(found, as_stored(expected), "{what}");
        }
        counts
    }
}

#[test]
fn seeded_cases_agree_with_the_oracle_at_every_mip() {
    let sum = |a: [u64; 3], b: [u64; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    let [all, known, mixed] =
        (0..1500_u64).into_par_iter().map(|seed| Case::random(seed).check()).reduce(|| [0; 3], sum);
    println!("{all} microtriangles agree with the oracle at every mip: {known} known, {mixed} not");
    assert!(all > 20_000 && known > all / 20 && mixed > all / 20);
}

#[test]
fn a_range_of_one_mip_is_that_mip_alone() {
    for seed in 0..200 {
        let case = Case::random(seed);
        let texture = case.chain.texture();
        let input = BakeInput { texture: &texture, uvs: &case.uvs, triangles: &[[0, 1, 2]] };
        for mip in 0..texture.mip_count() {
            let options = BakeOptions { mips: MipChoice::Range { first: mip, last: mip }, ..case.options.clone() };
            let alone = BakeInput { texture: texture.mip(mip).unwrap(), ..input };
            let without = BakeOptions { mips: MipChoice::Range { first: 0, last: 0 }, ..options.clone() };
            assert_eq!(bake(&input, &options, &|_| {}), bake(&alone, &without, &|_| {}));
        }
        let (first, last, count) = (1, texture.mip_count(), texture.mip_count());
        let options = BakeOptions { mips: MipChoice::Range { first, last }, ..case.options };
        let error = bake(&input, &options, &|_| {}).unwrap_err();
        assert_eq!(error, BakeError::MipRange { first, last, count });
    }
}
