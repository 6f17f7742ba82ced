//! Whole bakes: what is shared, what is special, what is refused, and that threads do not show.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::sync::Mutex;
use std::time::{Duration, Instant};

use omm_bake::texel_triangle::MAX_COORDINATE;
use omm_bake::{
    AddressMode, BakeError, BakeInput, BakeOptions, BakeOutput, BlockOrder, Classification, Filter, LevelChoice,
    Progress, Sampler, StateCounts, Surface, SurfaceError, TexelTriangle, Texture, UnknownStatePromotion, bake,
    classify, estimate,
};
use omm_model::curve::MicroTriangle;
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;
use omm_model::special_index::{OpacityMicromapSpecialIndex, TriangleMap};

fn level(level: u32) -> SubdivisionLevel {
    SubdivisionLevel::new(level).unwrap()
}

/// A disc of radius 1/4 in the middle of `size` x `size` texels.
fn disc(size: u32) -> Texture {
    let value = |k: u32| {
        let at = |k: u32| (f64::from(k) + 0.5) / f64::from(size) - 0.5;
        let distance = (at(k % size).powi(2) + at(k / size).powi(2)).sqrt();
        ((0.25 - distance) * f64::from(size) * 100.0 + 128.0).clamp(0.0, 255.0) as u8
    };
    Texture::unorm8(size, size, (0..size * size).map(value).collect()).unwrap()
}

fn uniform(of: u32) -> BakeOptions {
    BakeOptions { level: LevelChoice::Uniform(level(of)), ..BakeOptions::default() }
}

fn run(texture: &Texture, uvs: &[[f32; 2]], triangles: &[[u32; 3]], options: &BakeOptions) -> BakeOutput {
    let output = bake(&BakeInput { texture, uvs, triangles }, options, &|_| {}).unwrap();
    consistent(&output, triangles.len());
    output
}

/// What holds of every output.
fn consistent(output: &BakeOutput, triangles: usize) {
    let BakeOutput { array, triangles: blocks, indices, usage_counts, index_usage_counts, statistics } = output;
    assert_eq!((indices.len(), statistics.triangles), (triangles, triangles as u64));
    let mut end = 0;
    for block in blocks {
        assert_eq!(block.data_range().start, end);
        end = block.data_range().end;
    }
    assert_eq!((array.len() as u64, statistics.array_bytes), (end, end));
    assert!(blocks.is_sorted_by(|a, b| a.subdivision_level >= b.subdivision_level));
    let (mut array_states, mut triangle_states) = (StateCounts::default(), StateCounts::default());
    let count = |block: &omm_model::triangle::MicromapTriangle, counts: &mut StateCounts| {
        for index in 0..block.subdivision_level.microtriangles() {
            counts.add(block.format.state(&array[block.data_offset as usize..], index.into()).unwrap(), 1);
        }
    };
    blocks.iter().for_each(|block| count(block, &mut array_states));
    assert_eq!(statistics.array_states, array_states);
    assert_eq!(usage_counts.iter().map(|usage| usage.count as usize).sum::<usize>(), blocks.len());
    let mut referred = 0;
    for map in output.triangle_maps() {
        match map {
            TriangleMap::Triangle(index) => {
                count(&blocks[index as usize], &mut triangle_states);
                referred += 1;
            }
            TriangleMap::SpecialIndex(special) => triangle_states.add(special.state(), 0),
        }
    }
    assert_eq!(index_usage_counts.iter().map(|usage| usage.count).sum::<u32>(), referred);
    for state in OpacityState::ALL {
        assert!(statistics.triangle_states.of(state) >= triangle_states.of(state));
    }
    assert_eq!(statistics.special_indices.total() + u64::from(referred), statistics.triangles);
}

/// Quadrants of the disc by symmetry, the same triangle again, one in the disc and one outside.
const UVS: [[f32; 2]; 9] =
    [[0.5, 0.5], [1.0, 0.5], [0.5, 1.0], [1.5, 0.5], [0.5, 0.6], [0.6, 0.5], [0.0, 0.0], [0.1, 0.0], [0.0, 0.1]];
const TRIANGLES: [[u32; 3]; 6] = [[0, 1, 2], [0, 4, 5], [6, 7, 8], [0, 1, 2], [6, 7, 0], [1, 2, 0]];

#[test]
fn sharing_and_special_indices() {
    let texture = disc(64);
    let uniform = |of| BakeOptions { order: BlockOrder::Mesh, ..uniform(of) };
    let shared = run(&texture, &UVS, &TRIANGLES, &uniform(4));
    // The last is the first turned round: the same states elsewhere on the curve.
    assert_eq!(shared.indices, [0, -2, -1, 0, 1, 2]);
    assert_eq!(shared.statistics.special_indices, StateCounts { transparent: 1, opaque: 1, ..StateCounts::default() });
    assert_eq!((shared.statistics.baked_triangles, shared.statistics.micromap_triangles), (5, 3));
    assert_eq!(shared.index_usage_counts[0].count, 4);
    assert_eq!(shared.statistics.triangle_states.total(), 6 * 256);

    let apart = run(&texture, &UVS, &TRIANGLES, &BakeOptions { merge: false, ..uniform(4) });
    assert_eq!(apart.indices, [0, -2, -1, 1, 2, 3]);
    assert_eq!(apart.statistics.baked_triangles, 6);

    let plain = run(&texture, &UVS, &TRIANGLES, &BakeOptions { special_indices: false, ..uniform(4) });
    assert_eq!(plain.indices, [0, 1, 2, 0, 3, 4]);
    let all = BakeOptions { special_indices: false, merge: false, ..uniform(4) };
    assert_eq!(run(&texture, &UVS, &TRIANGLES, &all).indices, [0, 1, 2, 3, 4, 5]);
    assert_eq!(plain.statistics.triangle_states, shared.statistics.triangle_states);
}

/// A period further on everything is the same: other coordinates, the same bytes.
#[test]
fn equal_blocks_of_other_triangles_are_merged() {
    let texture = disc(64);
    let moved = [[0.25, 0.25], [1.0, 0.25], [0.25, 1.0], [-1.75, 1.25], [-1.0, 1.25], [-1.75, 2.0]];
    let output = run(&texture, &moved, &[[0, 1, 2], [3, 4, 5]], &uniform(5));
    assert_eq!((output.indices, output.statistics.baked_triangles), (vec![0, 0], 2));
}

#[test]
fn levels_are_in_order_and_blocks_aligned() {
    let texture = disc(256);
    let uvs: Vec<[f32; 2]> = (1..=6)
        .flat_map(|k| {
            let size = 0.5_f32.powi(k);
            [[0.5, 0.5], [0.5 + size, 0.5], [0.5, 0.7 + size]]
        })
        .collect();
    let triangles: Vec<[u32; 3]> = (0..6).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).rev().collect();
    for format in OpacityMicromapFormat::ALL {
        let options =
            BakeOptions { format, level: LevelChoice::Dynamic { scale: 1.0, max: level(7) }, ..BakeOptions::default() };
        let output = run(&texture, &uvs, &triangles, &options);
        assert!(output.usage_counts.len() > 3, "{:?}", output.usage_counts);
        assert!(
            output.triangles.iter().all(|block| block.data_offset % block.data_size() == 0 || block.data_size() < 8)
        );
        assert!(output.usage_counts.is_sorted_by_key(|usage| std::cmp::Reverse(usage.subdivision_level)));
    }
}

#[test]
fn two_states_follow_from_four() {
    let texture = disc(48);
    for promotion in
        [UnknownStatePromotion::Nearest, UnknownStatePromotion::ForceOpaque, UnknownStatePromotion::ForceTransparent]
    {
        let options = BakeOptions { promotion, ..uniform(5) };
        let four = run(&texture, &UVS, &TRIANGLES[..1], &options);
        let two =
            run(&texture, &UVS, &TRIANGLES[..1], &BakeOptions { format: OpacityMicromapFormat::TwoState, ..options });
        let state = |output: &BakeOutput, index| output.triangles[0].format.state(&output.array, index).unwrap();
        for index in 0..1024 {
            assert_eq!(state(&two, index), state(&four, index).to_two_state());
        }
        let StateCounts { unknown_transparent, unknown_opaque, .. } = four.statistics.array_states;
        match promotion {
            UnknownStatePromotion::Nearest => assert!(unknown_transparent > 0 && unknown_opaque > 0),
            UnknownStatePromotion::ForceOpaque => assert!(unknown_transparent == 0 && unknown_opaque > 0),
            UnknownStatePromotion::ForceTransparent => assert!(unknown_transparent > 0 && unknown_opaque == 0),
        }
    }
}

/// Blocks above level 6 are baked in pieces, and nodes far above the microtriangles may be decided at once.
#[test]
fn blocks_are_what_classify_says_one_by_one() {
    let texture = disc(96);
    let uvs = [[0.1, 0.15], [1.3, 0.2], [0.3, 0.95]];
    for filter in [Filter::Linear, Filter::Nearest] {
        let sampler = Sampler::new(AddressMode::Mirror, filter, 0.0);
        let surface = Surface::new(&texture, sampler, 0.5).unwrap();
        let triangle = TexelTriangle::new(uvs, &texture).unwrap();
        for of in [0, 1, 3, 6, 7, 8] {
            let promotion = UnknownStatePromotion::ForceTransparent;
            let output = run(
                &texture,
                &uvs,
                &[[0, 1, 2]],
                &BakeOptions { sampler, promotion, special_indices: false, ..uniform(of) },
            );
            for microtriangle in MicroTriangle::all(level(of)) {
                let expected = match classify(&surface, &triangle, microtriangle) {
                    Classification::Opaque => OpacityState::Opaque,
                    Classification::Transparent => OpacityState::Transparent,
                    _ => OpacityState::UnknownTransparent,
                };
                let found = OpacityMicromapFormat::FourState.state(&output.array, microtriangle.index().into());
                assert_eq!(found, Some(expected), "{filter:?} {microtriangle:?}");
            }
        }
    }
}

#[test]
fn threads_do_not_show() {
    let texture = disc(128);
    let uvs: Vec<[f32; 2]> = (0..300).map(|k| [(k * 37 % 101) as f32 / 50.0, (k * 53 % 97) as f32 / 60.0]).collect();
    let triangles: Vec<[u32; 3]> = (0..500).map(|k| [k % 300, k * 7 % 299, k * 13 % 293]).collect();
    let options = BakeOptions { level: LevelChoice::Dynamic { scale: 3.0, max: level(8) }, ..BakeOptions::default() };
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run(&texture, &uvs, &triangles, &options))
    };
    let one = with(1);
    assert!(one.triangles.len() > 100 && one.usage_counts.len() > 2);
    assert_eq!(one, with(4));
    assert_eq!(one, with(3));
}

#[test]
fn what_cannot_be_baked_gets_the_chosen_state() {
    let texture = disc(64);
    let far = MAX_COORDINATE as f32;
    let uvs = [[0.5, 0.5], [0.9, 0.5], [0.5, 0.9], [f32::NAN, 0.0], [0.0, f32::NEG_INFINITY], [far, 0.0]];
    let triangles = [[0, 1, 3], [0, 1, 2], [4, 1, 3], [0, 5, 1]];
    let output = run(&texture, &uvs, &triangles, &uniform(2));
    assert_eq!(output.indices, [-4, 0, -4, -4]);
    assert_eq!((output.statistics.not_finite, output.statistics.out_of_range), (2, 1));
    assert_eq!(output.statistics.triangle_states.total(), 4 * 16);

    let chosen = OpacityMicromapSpecialIndex::FullyUnknownTransparent;
    let options = BakeOptions { unbakeable: chosen, ..uniform(2) };
    assert_eq!(run(&texture, &uvs, &triangles, &options).indices, [-3, 0, -3, -3]);
    let plain = run(&texture, &uvs, &triangles, &BakeOptions { special_indices: false, ..options.clone() });
    assert_eq!(plain.indices, [1, 0, 1, 1]);
    assert_eq!(plain.array[4..], [0xaa; 4]);
    let two = BakeOptions { special_indices: false, format: OpacityMicromapFormat::TwoState, ..uniform(2) };
    assert_eq!(run(&texture, &uvs, &triangles, &two).array[2..], [0xff; 2]);
    let dynamic = BakeOptions { special_indices: false, ..BakeOptions::default() };
    assert_eq!(run(&texture, &uvs, &triangles, &dynamic).triangles[1].subdivision_level, level(0));
}

/// One texel of 256 x 256 is opaque; triangles reach over a million periods.
#[test]
fn coordinates_far_away_end_soon() {
    let start = Instant::now();
    let mut texels = vec![0; 256 * 256];
    texels[256 * 255 + 255] = 255;
    let texture = Texture::unorm8(256, 256, texels).unwrap();
    let huge = 4_000_000.0_f32;
    // A wide one, thin ones, and one that lies beyond the texture altogether.
    let uvs = [[-huge, -huge], [huge, -huge], [-huge, huge], [0.0, 0.0], [huge, 0.001], [huge, 0.002], [huge, huge]];
    let triangles = [[0, 1, 2], [3, 4, 5], [3, 5, 6], [4, 5, 6]];
    for address_mode in AddressMode::ALL {
        for filter in [Filter::Nearest, Filter::Linear] {
            let sampler = Sampler::new(address_mode, filter, 0.0);
            let output = run(&texture, &uvs, &triangles, &BakeOptions { sampler, ..uniform(1) });
            let repeats = matches!(address_mode, AddressMode::Wrap | AddressMode::Mirror);
            assert!(repeats || output.statistics.undecided == 0, "{sampler:?}");
        }
    }
    // Minutes if a loop were as long as a coordinate: 2 * 10^18 texels.
    assert!(start.elapsed() < Duration::from_secs(60), "{:?}", start.elapsed());
}

#[test]
fn what_has_no_meaning_is_refused() {
    let texture = disc(8);
    let uvs = [[0.0; 2]; 3];
    let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &[[0, 1, 2], [2, 1, 3]] };
    let error = |input: &BakeInput<'_>, options: &BakeOptions| {
        let error = bake(input, options, &|_| {}).unwrap_err();
        assert_eq!(estimate(input, options).err().unwrap_or(error), error);
        error
    };
    let index = error(&input, &BakeOptions::default());
    assert_eq!(index, BakeError::IndexOutOfRange { triangle: 1, corner: 2, found: 3, count: 3 });
    assert_eq!(index.to_string(), "triangles[1][2] is 3, but there are texture coordinates for 3 vertices");
    let input = BakeInput { triangles: &[[0, 1, 2]], ..input };
    let nan = BakeOptions { alpha_cutoff: f32::NAN, ..BakeOptions::default() };
    assert_eq!(error(&input, &nan), BakeError::Surface(SurfaceError::CutoffNan));
    for scale in [0.0, -1.0, f32::INFINITY] {
        let options = BakeOptions { level: LevelChoice::Dynamic { scale, max: level(3) }, ..BakeOptions::default() };
        assert_eq!(error(&input, &options), BakeError::DynamicScale { found: scale });
    }
    // 1024 blocks of 4 MiB, known to be too many before the first is baked.
    let triangles = vec![[0, 1, 2]; 1024];
    let many = BakeInput { triangles: &triangles, ..input };
    let options = BakeOptions { merge: false, special_indices: false, ..uniform(12) };
    assert_eq!(error(&many, &options), BakeError::ArrayTooLarge { required: 1 << 32, limit: u32::MAX.into() });
    // Shared, they are one.
    let options = BakeOptions { special_indices: false, ..uniform(12) };
    assert_eq!(estimate(&many, &options).unwrap().array_bytes, 1 << 22);
}

#[test]
fn nothing_bakes_to_nothing() {
    let output = run(&disc(8), &[], &[], &BakeOptions::default());
    assert_eq!(output, BakeOutput::default());
}

#[test]
fn progress_ends_at_the_estimate() {
    let texture = disc(64);
    let input = BakeInput { texture: &texture, uvs: &UVS, triangles: &TRIANGLES };
    let seen = Mutex::new(Vec::new());
    bake(&input, &uniform(8), &|progress: Progress| seen.lock().unwrap().push(progress)).unwrap();
    let total = estimate(&input, &uniform(8)).unwrap().microtriangles;
    let seen = seen.into_inner().unwrap();
    assert_eq!(total, 5 << 16);
    assert!(seen.len() > 5 && seen.iter().all(|progress| progress.total == total));
    assert_eq!(seen.iter().map(|progress| progress.done).max(), Some(total));
}

#[test]
fn options_and_statistics_survive_a_file() {
    let options = BakeOptions { alpha_cutoff: 0.25, ..uniform(3) };
    let text = serde_json::to_string(&options).unwrap();
    assert_eq!(serde_json::from_str::<BakeOptions>(&text).unwrap(), options);
    assert_eq!(serde_json::from_str::<BakeOptions>("{}").unwrap(), BakeOptions::default());
    let statistics = run(&disc(64), &UVS, &TRIANGLES, &options).statistics;
    let text = serde_json::to_string(&statistics).unwrap();
    assert_eq!(serde_json::from_str::<omm_bake::BakeStatistics>(&text).unwrap(), statistics);
}
