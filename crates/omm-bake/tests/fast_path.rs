//! Whole bakes, which take every short cut, against `classify`, which takes none: all golden jobs, and random triangles on textures
//! with many ties, seams and address modes.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, unreachable_pub, dead_code)]

mod golden;

use omm_bake::{
    AddressMode, BakeInput, BakeOptions, Classification, Filter, LevelChoice, Sampler, Surface, TexelTriangle, Texture,
    UnknownStatePromotion, bake, classify,
};
use omm_model::curve::MicroTriangle;
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;
use rayon::prelude::*;

/// How many microtriangles of a bake at `level` were compared; all must be as `classify` says.
fn compare(texture: &Texture, uvs: &[[f32; 2]], triangles: &[[u32; 3]], options: &BakeOptions) -> u64 {
    let options = BakeOptions {
        format: OpacityMicromapFormat::FourState,
        promotion: UnknownStatePromotion::ForceOpaque,
        special_indices: false,
        merge: false,
        ..options.clone()
    };
    let LevelChoice::Uniform(level) = options.level else { panic!("a uniform level") };
    let output = bake(&BakeInput { texture, uvs, triangles }, &options, &|_| {}).unwrap();
    let surface = Surface::new(texture, options.sampler, options.alpha_cutoff).unwrap();
    let one = |(corners, &entry): (&[u32; 3], &i32)| {
        let uvs = corners.map(|corner| uvs[corner as usize]);
        let Ok(triangle) = TexelTriangle::new(uvs, texture) else { return 0 };
        let data = &output.array[output.triangles[entry as usize].data_offset as usize..];
        for microtriangle in MicroTriangle::all(level) {
            let expected = match classify(&surface, &triangle, microtriangle) {
                Classification::Transparent => OpacityState::Transparent,
                Classification::Opaque => OpacityState::Opaque,
                Classification::Mixed => OpacityState::UnknownOpaque,
                // A short cut may know what the budget does not reach.
                Classification::Undecided => continue,
            };
            let found = options.format.state(data, microtriangle.index().into()).unwrap();
            assert_eq!(found, expected, "{microtriangle:?} of {uvs:?}, {:?}", options.sampler);
        }
        u64::from(level.microtriangles())
    };
    triangles.par_iter().zip(&output.indices).map(one).sum()
}

#[test]
fn golden_jobs() {
    let folder = golden::folder().join("bake");
    if !folder.is_dir() {
        println!("skipped: golden data absent");
        return;
    }
    let mut compared = 0;
    for job in golden::jobs(&folder) {
        let max = match job.options.level {
            LevelChoice::Uniform(level) => level.get(),
            LevelChoice::Dynamic { .. } => 5,
        };
        for level in [max.min(3), max.min(8)] {
            let level = LevelChoice::Uniform(SubdivisionLevel::new(level).unwrap());
            compared += compare(&job.texture, &job.uvs, &job.triangles, &BakeOptions { level, ..job.options.clone() });
        }
    }
    println!("{compared} microtriangles agree");
    assert!(compared > 400_000);
}

/// splitmix64
fn next(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

fn texture(random: &mut u64) -> Texture {
    let (width, height) = (1 + next(random) % 90, 1 + next(random) % 90);
    // Blocks of a few texels, some with soft values, some that tie with the cutoff.
    let block = 1 + next(random) % 7;
    let palette: &[u8] = [&[0_u8, 255][..], &[0, 0, 51, 102, 128, 255], &[50, 51, 52]][(next(random) % 3) as usize];
    let salt = next(random);
    let value = |k: u64| {
        let mut cell = salt ^ (k % width / block) << 32 ^ (k / width / block);
        palette[(next(&mut cell) % palette.len() as u64) as usize]
    };
    let values: Vec<u8> = (0..width * height).map(value).collect();
    if next(random).is_multiple_of(3) {
        let floats = values.iter().map(|&value| f32::from(value) / 255.0).collect();
        Texture::fp32(width as u32, height as u32, floats).unwrap()
    } else {
        Texture::unorm8(width as u32, height as u32, values).unwrap()
    }
}

#[test]
fn random_cases() {
    const CASES: u64 = 12_000;
    let one = |seed: u64| {
        let mut random = seed;
        let random = &mut random;
        let texture = texture(random);
        let mode = |random: &mut u64| AddressMode::ALL[(next(random) % 5) as usize];
        let sampler = Sampler {
            address_mode_u: mode(random),
            address_mode_v: mode(random),
            filter: if next(random).is_multiple_of(4) { Filter::Nearest } else { Filter::Linear },
            border_alpha: [0.0, 0.2, 1.0][(next(random) % 3) as usize],
        };
        let kind = next(random) % 3;
        let (at_u, at_v, size) = (next(random) % 96, next(random) % 96, 1 + next(random) % 40);
        let coordinate = |random: &mut u64, at: u64, texels: u32| {
            let near = next(random) % (size * 8);
            match kind {
                // Halves of texels: corners and edges on texel centres and bounds.
                0 => (at as f32 - 24.0 + (near / 4) as f32 / 2.0) / texels as f32,
                1 => (at as f32 - 24.0 + near as f32 / 8.0 + next(random) as f32 / 2e19) / texels as f32,
                _ => (next(random) >> 40) as f32 / (1 << 23) as f32 - 0.5,
            }
        };
        let uvs: Vec<[f32; 2]> = (0..6)
            .map(|_| [coordinate(random, at_u, texture.width()), coordinate(random, at_v, texture.height())])
            .collect();
        let level = SubdivisionLevel::new((next(random) % 6) as u32).unwrap();
        let options = BakeOptions {
            level: LevelChoice::Uniform(level),
            sampler,
            alpha_cutoff: [0.5, 0.2, 0.4][(next(random) % 3) as usize],
            ..BakeOptions::default()
        };
        // A line of two of the first corners, too.
        compare(&texture, &uvs, &[[0, 1, 2], [3, 4, 5], [0, 1, 1]], &options)
    };
    let compared: u64 = (0..CASES).into_par_iter().map(one).sum();
    println!("{compared} microtriangles of {CASES} cases agree");
    assert!(compared > CASES * 100);
}
