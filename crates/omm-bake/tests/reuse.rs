//! Blocks that are almost the same become one: nothing becomes wrong, and no triangle loses more than allowed.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::{Random, discs, level, mesh, run, states_at, uniform};
use omm_bake::{BakeInput, BakeOptions, BakeOutput, StateCounts};
use omm_model::opacity::OpacityState;
use proptest::prelude::*;

/// A mesh of groups of triangles that lie almost on each other.
fn shaken(seed: u64, groups: u32, each: u32, by: f32) -> (Vec<[f32; 2]>, Vec<[u32; 3]>) {
    let (uvs, _) = mesh(seed, groups, 0.15);
    let mut random = Random(seed);
    let mut all = Vec::new();
    for triangle in uvs.chunks(3) {
        for _ in 0..each {
            let [du, dv] = [random.unit(), random.unit()];
            all.extend(triangle.iter().map(|[u, v]| [u + by * (du - 0.5), v + by * (dv - 0.5)]));
        }
    }
    let triangles = (0..groups * each).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    (all, triangles)
}

/// Every state of `near` is that of `exact` or unknown, and no triangle lost more than `allowed`. How many were lost in all.
fn check(exact: &BakeOutput, near: &BakeOutput, of_level: u32, allowed: usize) -> u64 {
    let mut counts = StateCounts::default();
    let mut all_lost = 0;
    for triangle in 0..exact.indices.len() {
        let (before, after) = (states_at(exact, triangle, level(of_level)), states_at(near, triangle, level(of_level)));
        let mut lost = 0;
        for (before, after) in before.into_iter().zip(after) {
            assert!(before == after || !after.is_known(), "{before:?} became {after:?}");
            lost += usize::from(before.is_known() && !after.is_known());
            counts.add(after, 1);
        }
        assert!(lost <= allowed, "triangle {triangle} lost {lost}");
        all_lost += lost as u64;
    }
    assert_eq!(near.statistics.triangle_states, counts);
    let saved = exact.triangles.len() - near.triangles.len();
    assert_eq!(near.statistics.near_merged, saved as u64);
    assert_eq!(near.array.len(), near.triangles.len() * near.triangles.first().map_or(0, |t| t.data_size() as usize));
    all_lost
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn states_only_become_unknown(
        seed: u64, of_level in 1..=5_u32, distance in 0.0_f32..=0.4, shake in 0.0_f32..0.1, alignment in 0..3_u32,
    ) {
        let texture = discs(64, seed, 12);
        let (uvs, triangles) = shaken(seed, 12, 5, shake);
        let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
        let exact = run(&input, &uniform(of_level));
        let options = BakeOptions { merge_distance: distance, block_alignment: 1 << alignment, ..uniform(of_level) };
        let near = run(&input, &BakeOptions { block_alignment: 1, ..options.clone() });
        let allowed = (f64::from(distance) * f64::from(level(of_level).microtriangles())) as usize;
        let lost = check(&exact, &near, of_level, allowed);
        let known = |output: &BakeOutput| output.statistics.triangle_states.known();
        prop_assert_eq!(known(&exact) - known(&near), lost);
        // Gaps change nothing else.
        let gaps = run(&input, &options);
        prop_assert_eq!(&gaps.indices, &near.indices);
        prop_assert!(gaps.triangles.iter().all(|block| block.data_offset.is_multiple_of(1 << alignment)));
        for triangle in 0..triangles.len() {
            let [a, b] = [&gaps, &near].map(|output| states_at(output, triangle, level(of_level)));
            prop_assert_eq!(a, b);
        }
    }
}

/// Triangles that are almost the same really do become one, and it does not depend on threads.
#[test]
fn what_is_almost_the_same_becomes_one() {
    let texture = discs(256, 1, 60);
    let (uvs, triangles) = shaken(1, 40, 20, 0.001);
    let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
    let exact = run(&input, &uniform(4));
    let options = BakeOptions { merge_distance: 0.05, ..uniform(4) };
    let near = run(&input, &options);
    check(&exact, &near, 4, 12);
    assert!(near.triangles.len() * 4 < exact.triangles.len(), "{} {}", near.triangles.len(), exact.triangles.len());
    assert!(near.statistics.known_fraction > exact.statistics.known_fraction - 0.02);
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        assert_eq!(pool.install(|| run(&input, &options)), near);
    }
    // No distance, or less than a microtriangle: nothing happens.
    assert_eq!(run(&input, &BakeOptions { merge_distance: 0.003, ..uniform(4) }), exact);
    let states: Vec<OpacityState> = states_at(&near, 0, level(4));
    assert!(states.iter().any(|state| state.is_known()));
}
