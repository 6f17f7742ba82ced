//! Budgets of bytes and work, the dry run, and cancelling.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use common::{Random, discs, level, mesh, run, states, uniform};
use omm_bake::{
    BakeError, BakeInput, BakeOptions, LevelChoice, MipChoice, Progress, Texture, UnknownStatePromotion, WorkEstimate,
    bake, coverage, dry_run, estimate,
};
use omm_model::format::OpacityMicromapFormat;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn any_budget_is_met_or_refused(
        seed: u64, part in 0.0_f64..1.1, promotion in 0..3_usize, special_indices: bool, merge: bool, two_state: bool,
        rejection in prop_oneof![Just(0.0_f32), 0.0_f32..0.6], alignment in 0..4_u32,
    ) {
        let texture = discs(64, seed, 15);
        let (uvs, mut triangles) = mesh(seed, 40, 0.2);
        triangles.extend_from_within(..7);
        let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
        let options = BakeOptions {
            level: LevelChoice::Dynamic { scale: 1.0, max: level(5) },
            promotion: [
                UnknownStatePromotion::Nearest, UnknownStatePromotion::ForceOpaque, UnknownStatePromotion::ForceTransparent
            ][promotion],
            format: OpacityMicromapFormat::ALL[usize::from(!two_state)],
            special_indices,
            merge,
            rejection_threshold: if special_indices { rejection } else { 0.0 },
            block_alignment: 1 << alignment,
            ..BakeOptions::default()
        };
        let all = run(&input, &options);
        let budget = (all.statistics.array_bytes as f64 * part) as u64;
        let limited = BakeOptions { max_array_bytes: Some(budget), ..options.clone() };
        match bake(&input, &limited, &|_| {}) {
            Ok(output) => {
                prop_assert!(output.statistics.array_bytes <= budget);
                if budget >= all.statistics.array_bytes {
                    prop_assert_eq!(&output, &all);
                } else {
                    prop_assert!(output.statistics.lowered > 0);
                }
                for triangle in 0..triangles.len() {
                    // Lowered or as before, never finer.
                    let (before, after) = (states(&all, triangle), states(&output, triangle));
                    prop_assert!(before == after || after.0 < before.0);
                }
                let [before, after] = [&all, &output].map(|output| coverage(&input, output).area_known_fraction);
                prop_assert!(after <= before + 1e-12);
            }
            Err(BakeError::ArrayBudget { least, limit }) => {
                prop_assert!(!special_indices && limit == budget && least > budget);
            }
            Err(other) => prop_assert!(false, "{other}"),
        }
    }
}

/// A triangle that a smooth contour cuts and one over a chequerboard, which no level makes known: the latter pays.
#[test]
fn what_costs_least_is_lowered() {
    let texel = |x: u32, y: u32| if x < 64 { x > 30 } else { (x + y).is_multiple_of(2) };
    let texels = (0..128 * 64_u32).map(|k| u8::from(texel(k % 128, k / 128)) * 255).collect();
    let texture = Texture::unorm8(128, 64, texels).unwrap();
    let uvs = [[0.02, 0.1], [0.48, 0.1], [0.02, 0.9], [0.52, 0.1], [0.98, 0.1], [0.52, 0.9]];
    let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &[[0, 1, 2], [3, 4, 5]] };
    let options = BakeOptions { max_array_bytes: Some(256 + 64), ..uniform(5) };
    let output = run(&input, &options);
    assert_eq!(states(&output, 0).0, Some(level(5)));
    assert!(states(&output, 1).0 <= Some(level(4)), "{:?}", output.usage_counts);
    assert_eq!(output.statistics.lowered, 1);
    // With nothing left to spend both are given up, to the side that more of them has.
    let nothing = run(&input, &BakeOptions { max_array_bytes: Some(0), ..uniform(5) });
    assert_eq!((nothing.array.len(), nothing.statistics.lowered), (0, 2));
    assert!(nothing.indices.iter().all(|&index| index == -3 || index == -4));
    let plain = BakeOptions { special_indices: false, max_array_bytes: Some(1), ..uniform(5) };
    let error = bake(&input, &plain, &|_| {}).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the array cannot have fewer than 2 bytes, but the budget is 1: raise it, or allow special indices"
    );
}

#[test]
fn results_do_not_depend_on_threads_whatever_is_asked_for() {
    let texture = discs(64, 3, 15).with_mips(vec![discs(32, 3, 15), discs(16, 4, 15)]).unwrap();
    let (uvs, triangles) = mesh(5, 80, 0.2);
    let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
    let base = BakeOptions {
        level: LevelChoice::Dynamic { scale: 0.5, max: level(8) },
        merge_distance: 0.02,
        rejection_threshold: 0.2,
        ..BakeOptions::default()
    };
    let bytes = run(&input, &base).statistics.array_bytes;
    let options = BakeOptions { max_array_bytes: Some(bytes / 2), ..base };
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| (run(&input, &options), dry_run(&input, &options).unwrap()))
    };
    let one = with(1);
    assert!(one.0.statistics.lowered > 10 && one.0.array.len() as u64 * 2 <= bytes);
    assert_eq!(one, with(2));
    assert_eq!(one, with(5));
}

#[test]
fn work_beyond_the_budget_is_refused_with_the_estimate() {
    let texture = discs(64, 1, 5).with_mips(vec![discs(32, 1, 5)]).unwrap();
    let (uvs, triangles) = mesh(1, 10, 0.25);
    let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
    let found = estimate(&input, &uniform(3)).unwrap();
    assert_eq!((found.baked_triangles, found.microtriangles, found.array_bytes), (10, 2 * 640, 160));
    // A triangle has an area of about 1/30 of the texture, and a quarter of it in the second mip.
    let texels = 10.0 * 64.0 * 64.0 / 30.0 * 1.25;
    assert!((found.texels as f64 / texels - 1.0).abs() < 0.2, "{found:?} {texels}");
    let first = BakeOptions { mips: MipChoice::Range { first: 0, last: 0 }, ..uniform(3) };
    assert_eq!(estimate(&input, &first).unwrap().microtriangles, 640);
    let options = |max_work| BakeOptions { max_work: Some(max_work), ..uniform(3) };
    assert_eq!(run(&input, &options(found.work())), run(&input, &uniform(3)));
    let limit = found.work() - 1;
    let error = bake(&input, &options(limit), &|_| {}).unwrap_err();
    assert_eq!(error, BakeError::WorkBudget { estimate: found, limit });
    let WorkEstimate { texels, .. } = found;
    let message = format!(
        "the bake is {} steps of work (1280 microtriangles of 10 triangles, {texels} texels), but the work budget is \
         {limit}: raise it, or choose lower levels or fewer mips",
        limit + 1
    );
    assert_eq!(error.to_string(), message);
    assert_eq!(dry_run(&input, &options(limit)).unwrap_err(), error);
}

/// Levels are those of the bake; sizes and coverage are close to it.
#[test]
fn a_dry_run_predicts_the_bake() {
    let noise = {
        let mut random = Random(9);
        Texture::unorm8(256, 256, (0..1 << 16).map(|_| random.pick(&[0, 255])).collect()).unwrap()
    };
    for (texture, tolerance) in [(discs(256, 11, 60), 0.03), (discs(512, 12, 20), 0.03), (noise, 0.2)] {
        let (uvs, triangles) = mesh(13, 150, 0.1);
        let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
        for options in [
            uniform(2),
            uniform(6),
            BakeOptions::default(),
            BakeOptions { format: OpacityMicromapFormat::TwoState, ..uniform(5) },
            BakeOptions { special_indices: false, ..uniform(4) },
        ] {
            let (predicted, output) = (dry_run(&input, &options).unwrap(), run(&input, &options));
            for (triangle, predicted) in predicted.levels.iter().enumerate() {
                let (found, _) = states(&output, triangle);
                assert!(found.is_none() || found == *predicted);
            }
            let known = coverage(&input, &output).area_known_fraction;
            assert!(
                (predicted.area_known_fraction - known).abs() < tolerance,
                "{} {known}",
                predicted.area_known_fraction
            );
            let bytes = output.statistics.array_bytes as f64;
            // What different triangles share by chance is not foreseen: much at low levels.
            let most = match options.special_indices {
                true if options.level == LevelChoice::Uniform(level(2)) => 1.3,
                true => 1.1,
                false => f64::INFINITY,
            };
            let ratio = predicted.array_bytes as f64 / bytes;
            assert!((0.9..most).contains(&ratio), "{} {bytes} {options:?}", predicted.array_bytes);
            assert!(predicted.special_triangles.abs_diff(output.statistics.special_indices.total()) < 8);
            let budget = output.statistics.array_bytes / 3;
            let limited = BakeOptions { max_array_bytes: Some(budget), ..options };
            match dry_run(&input, &limited) {
                Ok(limited) => assert!(limited.array_bytes <= budget && limited.levels <= predicted.levels),
                Err(error) => assert!(matches!(error, BakeError::ArrayBudget { .. }), "{error}"),
            }
        }
    }
}

#[test]
fn a_bake_ends_soon_after_it_is_cancelled() {
    let texture = discs(128, 1, 30);
    let (uvs, triangles) = mesh(1, 2000, 0.2);
    let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
    let calls = AtomicUsize::new(0);
    let progress = |_: Progress| {
        let calls = calls.fetch_add(1, Ordering::Relaxed) + 1;
        if calls >= 5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    let result = pool.install(|| bake(&input, &uniform(6), &progress));
    assert_eq!(result, Err(BakeError::Cancelled));
    // Each thread may have been within a triangle.
    let calls = calls.into_inner();
    assert!((5..=5 + 3).contains(&calls), "{calls}");
    // Also in the pass that only measures.
    let limited = BakeOptions { max_array_bytes: Some(1), ..uniform(6) };
    assert_eq!(bake(&input, &limited, &|_| ControlFlow::Break(())), Err(BakeError::Cancelled));
}
