//! What an array and an index buffer look like: order, alignment, formats, types, coverage and rejection.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::{discs, level, mesh, run, states, states_at, uniform};
use omm_bake::options::MAX_BLOCK_ALIGNMENT;
use omm_bake::{
    BakeError, BakeInput, BakeOptions, BlockOrder, LevelChoice, StateCounts, Texture, TriangleOverride,
    UnknownStatePromotion, bake, coverage, estimate,
};
use omm_layout::index::IndexType;
use omm_layout::index_buffer::MicromapIndexBuffer;
use omm_model::format::OpacityMicromapFormat;
use omm_model::opacity::OpacityState;

/// Each triangle's level and format are its own, and its states are those of a bake in which all have them.
#[test]
fn overrides_are_as_if_all_had_them() {
    let texture = discs(128, 1, 30);
    let (uvs, mut triangles) = mesh(2, 60, 0.1);
    // The same coordinates again with other overrides.
    triangles.extend_from_within(..20);
    let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
    let levels = [None, Some(0), Some(1), Some(3), Some(6)];
    let formats = [None, Some(OpacityMicromapFormat::TwoState), Some(OpacityMicromapFormat::FourState)];
    let overrides: Vec<TriangleOverride> = (0..triangles.len())
        .map(|k| TriangleOverride { level: levels[k * 7 % 5].map(level), format: formats[k * 5 % 3] })
        .collect();
    for special_indices in [true, false] {
        let base = BakeOptions { special_indices, ..uniform(4) };
        let output = run(&input, &BakeOptions { overrides: overrides.clone(), ..base.clone() });
        for (k, TriangleOverride { level: own, format }) in overrides.iter().enumerate() {
            let all = BakeOptions {
                level: LevelChoice::Uniform(own.unwrap_or(level(4))),
                format: format.unwrap_or(base.format),
                ..base.clone()
            };
            let alone = run(&BakeInput { triangles: &triangles[k..=k], ..input }, &all);
            assert_eq!(states(&output, k), states(&alone, 0), "triangle {k}");
        }
        let sizes: Vec<u32> = output.triangles.iter().map(|block| block.data_size()).collect();
        assert!(sizes.is_sorted_by(|a, b| a >= b), "{sizes:?}");
        assert!(output.triangles.iter().all(|block| block.data_offset.is_multiple_of(block.data_size())));
        assert!(output.usage_counts.len() > 6);
    }
    let few = BakeOptions { overrides: vec![TriangleOverride::default(); 79], ..uniform(4) };
    let error = bake(&input, &few, &|_| {}).unwrap_err();
    assert_eq!(error, BakeError::OverrideCount { found: 79, required: 80 });
    assert_eq!(error.to_string(), "there are 79 overrides for 80 triangles: give one for each triangle, or none");
}

/// Both orders have the same blocks; the spatial one has neighbours close together.
#[test]
fn blocks_lie_in_the_order_asked_for() {
    let texture = discs(256, 3, 20);
    let (uvs, triangles) = mesh(4, 4000, 0.05);
    let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
    let options = uniform(4);
    let spatial = run(&input, &options);
    let meshed = run(&input, &BakeOptions { order: BlockOrder::Mesh, ..options });
    assert_eq!(spatial.statistics, meshed.statistics);
    // The average step between blocks that follow each other, in texture coordinates.
    let walk = |output: &omm_bake::BakeOutput| {
        let first = |block: usize| output.indices.iter().position(|&index| index == block as i32).unwrap();
        let places: Vec<[f32; 2]> = (0..output.triangles.len()).map(|block| uvs[3 * first(block)]).collect();
        let step = |pair: &[[f32; 2]]| (pair[0][0] - pair[1][0]).hypot(pair[0][1] - pair[1][1]);
        places.windows(2).map(step).sum::<f32>() / places.len() as f32
    };
    assert!(spatial.triangles.len() > 300, "{}", spatial.triangles.len());
    assert!(3.0 * walk(&spatial) < walk(&meshed), "{} {}", walk(&spatial), walk(&meshed));
    for triangle in 0..triangles.len() {
        assert_eq!(states(&spatial, triangle), states(&meshed, triangle));
    }
    let used: Vec<_> = meshed.indices.iter().copied().filter(|index| *index >= 0).collect();
    let mut first_uses: Vec<Vec<i32>> = vec![Vec::new(); 13];
    for index in used {
        let of_level = &mut first_uses[meshed.triangles[index as usize].subdivision_level.get() as usize];
        if !of_level.contains(&index) {
            of_level.push(index);
        }
    }
    assert!(first_uses.iter().all(|order| order.is_sorted()), "by first use within a level");
}

#[test]
fn blocks_start_where_they_are_asked_to() {
    let texture = discs(128, 5, 40);
    let (uvs, triangles) = mesh(6, 50, 0.05);
    let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
    for of_level in [0, 1, 3] {
        let plain = run(&input, &uniform(of_level));
        for block_alignment in [4, 64, 256] {
            let options = BakeOptions { block_alignment, ..uniform(of_level) };
            let output = run(&input, &options);
            assert!(output.triangles.iter().all(|block| block.data_offset.is_multiple_of(block_alignment)));
            assert_eq!(
                (output.indices.clone(), output.triangles.len()),
                (plain.indices.clone(), plain.triangles.len())
            );
            assert!((0..triangles.len()).all(|k| states(&output, k) == states(&plain, k)));
            assert!(output.array.len() as u64 <= estimate(&input, &options).unwrap().array_bytes);
        }
    }
    for found in [0, 3, 2 * MAX_BLOCK_ALIGNMENT] {
        let error = bake(&input, &BakeOptions { block_alignment: found, ..uniform(1) }, &|_| {}).unwrap_err();
        assert_eq!(error, BakeError::BlockAlignment { found });
    }
}

/// 252 micromap triangles fit in 8 bits beside the special values, 253 do not; and so on for 16.
#[test]
fn index_buffers_are_as_small_as_may_be() {
    let all = [IndexType::Uint8, IndexType::Uint16, IndexType::Uint32];
    for (count, expected) in
        [(252, IndexType::Uint8), (253, IndexType::Uint16), (65_532, IndexType::Uint16), (65_533, IndexType::Uint32)]
    {
        let output = omm_bake::BakeOutput { indices: (-4..count).collect(), ..omm_bake::BakeOutput::default() };
        let (index_type, bytes) = output.index_buffer(&all).unwrap();
        assert_eq!((index_type, bytes.len()), (expected, output.indices.len() * expected.size() as usize));
        for forced in all.into_iter().filter(|forced| *forced >= expected) {
            let (_, bytes) = output.index_buffer(&[forced]).unwrap();
            let read =
                MicromapIndexBuffer::new(&bytes, forced, forced.size().into(), 0, output.indices.len() as u64).unwrap();
            assert!(read.iter().map(Result::unwrap).eq(output.triangle_maps()));
        }
        for small in all.into_iter().filter(|small| *small < expected) {
            let error = output.index_buffer(&[small]).unwrap_err();
            assert_eq!(error, BakeError::IndexType { micromap_triangles: 0 });
        }
    }
}

#[test]
fn coverage_is_counted_triangle_by_triangle() {
    let texture = discs(128, 7, 40);
    let (mut uvs, triangles) = mesh(8, 60, 0.1);
    // One large triangle among small ones, a line, and one that cannot be baked.
    uvs[..3].copy_from_slice(&[[0.0, 0.0], [0.9, 0.0], [0.0, 0.9]]);
    uvs[3..6].copy_from_slice(&[[0.1, 0.1], [0.2, 0.2], [0.3, 0.3]]);
    uvs[6] = [f32::NAN, 0.0];
    let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
    let output = run(&input, &uniform(4));
    let found = coverage(&input, &output);
    let (mut counts, mut texels, mut known) = (StateCounts::default(), 0.0, 0.0);
    for (k, triangle) in found.triangles.iter().enumerate() {
        let mut own = StateCounts::default();
        states_at(&output, k, level(4)).into_iter().for_each(|state| own.add(state, 1));
        counts.add_all(own, 1);
        assert_eq!(triangle.known_fraction, own.known_fraction());
        texels += triangle.texels;
        known += triangle.texels * own.known_fraction();
    }
    assert_eq!(output.statistics.known_fraction, counts.known_fraction());
    assert!((found.area_known_fraction - known / texels).abs() < 1e-12);
    let areas: Vec<f64> = found.triangles.iter().map(|triangle| triangle.texels).collect();
    assert!((areas[0] - 0.405 * 128.0 * 128.0).abs() < 0.01 && areas[1] < 1e-3 && areas[2] == 0.0, "{areas:?}");
    assert!(areas[3..].iter().all(|&area| (40.0..160.0).contains(&area)));
    assert_eq!(
        coverage(&BakeInput { triangles: &[], ..input }, &omm_bake::BakeOutput::default()).area_known_fraction,
        0.0
    );
}

/// A rejected triangle is unknown on the side that more of it has; the others are as without a threshold.
#[test]
fn what_is_hardly_known_is_rejected() {
    let texture = discs(128, 9, 12);
    let (uvs, triangles) = mesh(10, 200, 0.08);
    let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
    let all = run(&input, &uniform(3));
    let fractions: Vec<f64> = coverage(&input, &all).triangles.iter().map(|t| t.known_fraction).collect();
    for promotion in
        [UnknownStatePromotion::Nearest, UnknownStatePromotion::ForceOpaque, UnknownStatePromotion::ForceTransparent]
    {
        let all = run(&input, &BakeOptions { promotion, ..uniform(3) });
        let options = BakeOptions { promotion, rejection_threshold: 0.8, ..uniform(3) };
        let output = run(&input, &options);
        let mut rejected = 0;
        for (k, &fraction) in fractions.iter().enumerate() {
            if all.indices[k] >= 0 && fraction < 0.8 {
                let sides = states_at(&all, k, level(3));
                let opaque = sides.iter().filter(|state| state.to_two_state() == OpacityState::Opaque).count();
                let expected = match promotion {
                    UnknownStatePromotion::Nearest if opaque >= 32 => OpacityState::UnknownOpaque,
                    UnknownStatePromotion::ForceOpaque => OpacityState::UnknownOpaque,
                    _ => OpacityState::UnknownTransparent,
                };
                assert_eq!(states(&output, k), (None, vec![expected]));
                rejected += 1;
            } else {
                assert_eq!(states(&output, k), states(&all, k));
            }
        }
        assert!(rejected > 8, "{rejected}");
        assert_eq!(output.statistics.rejected, rejected);
        let two = BakeOptions { format: OpacityMicromapFormat::TwoState, ..options };
        assert_eq!(run(&input, &two).statistics.rejected, 0, "2-state data knows everything");
    }
}

#[test]
fn contradictions_are_refused() {
    let texture = Texture::unorm8(1, 1, vec![0]).unwrap();
    let input = BakeInput { texture: &texture, uvs: &[[0.0; 2]; 3], triangles: &[[0, 1, 2]] };
    let error = |options: BakeOptions| bake(&input, &options, &|_| {}).unwrap_err().to_string();
    for (found, text) in [(1.5, "1.5"), (-0.1, "-0.1"), (f32::NAN, "NaN")] {
        let options = BakeOptions { rejection_threshold: found, ..uniform(1) };
        assert_eq!(error(options), format!("rejection_threshold is {text}: it must be 0 to 1"));
        let options = BakeOptions { merge_distance: found, ..uniform(1) };
        assert_eq!(error(options), format!("merge_distance is {text}: it must be 0 to 1"));
    }
    assert_eq!(
        error(BakeOptions { rejection_threshold: 0.5, special_indices: false, ..uniform(1) }),
        "rejection_threshold above 0 contradicts no special_indices: allow special indices, or reject nothing"
    );
    assert_eq!(
        error(BakeOptions { merge_distance: 0.1, merge: false, ..uniform(1) }),
        "merge_distance above 0 contradicts no merge: allow merging, or set the distance to 0"
    );
    let two_state = BakeOptions { merge_distance: 0.1, format: OpacityMicromapFormat::TwoState, ..uniform(1) };
    assert!(error(two_state.clone()).starts_with("merge_distance above 0 contradicts 2-state format: "));
    let own = TriangleOverride { format: Some(OpacityMicromapFormat::FourState), level: None };
    assert!(bake(&input, &BakeOptions { overrides: vec![own], ..two_state }, &|_| {}).is_ok());
}
