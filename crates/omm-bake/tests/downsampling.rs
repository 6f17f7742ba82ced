//! Lower levels from what was baked are what baking at the lower level gives.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::{discs, level, mesh, run, states, states_at, uniform};
use omm_bake::{BakeError, BakeInput, BakeOptions, LevelChoice, MipChoice, UnknownStatePromotion, downsample};
use omm_model::format::OpacityMicromapFormat;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn as_baked_at_the_lower_level(
        seed: u64, from in 0..=6_u32, levels in 0..=6_u32, promotion in 0..3_usize, two_state: bool, special_indices: bool, mips: bool,
    ) {
        let texture = discs(64, seed, 15).with_mips(vec![discs(32, seed, 15)]).unwrap();
        let (uvs, mut triangles) = mesh(seed, 20, 0.3);
        triangles.push([0; 3]);
        let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
        let promotion = [
            UnknownStatePromotion::Nearest, UnknownStatePromotion::ForceOpaque, UnknownStatePromotion::ForceTransparent
        ][promotion];
        let options = BakeOptions {
            promotion,
            special_indices,
            format: OpacityMicromapFormat::ALL[usize::from(!two_state)],
            mips: if mips { MipChoice::All } else { MipChoice::Range { first: 0, last: 0 } },
            ..uniform(from)
        };
        let to = from.saturating_sub(levels);
        let lower = BakeOptions { level: LevelChoice::Uniform(level(to)), ..options.clone() };
        let (found, baked) = (downsample(&run(&input, &options), levels, &options).unwrap(), run(&input, &lower));
        if promotion == UnknownStatePromotion::Nearest {
            for triangle in 0..triangles.len() {
                let [a, b] = [&found, &baked].map(|output| states_at(output, triangle, level(to)));
                for (found, baked) in a.into_iter().zip(b) {
                    // Which unknown state, and so which of two states, is an estimate from the children.
                    prop_assert!(two_state || found == baked || !(found.is_known() || baked.is_known()));
                }
            }
        } else {
            prop_assert_eq!((&found.array, &found.triangles), (&baked.array, &baked.triangles));
            prop_assert_eq!((&found.indices, &found.usage_counts), (&baked.indices, &baked.usage_counts));
            prop_assert_eq!(&found.index_usage_counts, &baked.index_usage_counts);
            prop_assert_eq!(&found.statistics.array_states, &baked.statistics.array_states);
            prop_assert_eq!(&found.statistics.special_indices, &baked.statistics.special_indices);
        }
    }
}

#[test]
fn levels_that_differ_are_lowered_each() {
    let texture = discs(128, 1, 30);
    let (mut uvs, triangles) = mesh(2, 60, 0.1);
    uvs[..3].copy_from_slice(&[[0.0, 0.0], [0.9, 0.0], [0.0, 0.9]]);
    let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
    let options = BakeOptions::default();
    let fine = run(&input, &options);
    let coarse = downsample(&fine, 2, &options).unwrap();
    for triangle in 0..triangles.len() {
        if let (Some(before), _) = states(&fine, triangle) {
            let (after, _) = states(&coarse, triangle);
            assert!(after.is_none_or(|after| after.get() == before.get().saturating_sub(2)));
        }
    }
    assert!(coarse.statistics.known_fraction < fine.statistics.known_fraction);
    assert_eq!(downsample(&fine, 0, &options).unwrap().array, fine.array);
}

/// What comes from files may be anything.
#[test]
fn what_lies_beyond_the_array_is_named() {
    let texture = discs(64, 1, 30);
    let (uvs, triangles) = mesh(2, 20, 0.2);
    let output = run(&BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles }, &uniform(3));
    let (count, available) = (output.triangles.len(), output.array.len() as u64);
    let mut short = output.clone();
    short.array.pop();
    let error = downsample(&short, 1, &uniform(3)).unwrap_err();
    assert_eq!(error, BakeError::BlockBeyond { number: count - 1, end: available, available: available - 1 });
    let mut far = output.clone();
    far.indices[7] = count as i32;
    let error = downsample(&far, 1, &uniform(3)).unwrap_err();
    assert_eq!(error, BakeError::IndexBeyond { triangle: 7, found: count as u32, count });
    let negative = omm_bake::BakeOutput { indices: vec![-5], ..output };
    assert!(matches!(downsample(&negative, 1, &uniform(3)), Err(BakeError::IndexBeyond { triangle: 0, .. })));
}
