//! What baking costs beside its input and its result: less than 64 MiB, also for the largest textures, for many triangles, and
//! for data that a budget does not let come to be.
//!
//! A program of its own (`harness = false`): the test harness has a second thread, whose allocations would be counted too.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

mod common;

use std::iter::repeat_n;

use common::{discs, mesh, uniform};
use omm_bake::{
    AddressMode, BakeInput, BakeOptions, BakeOutput, Filter, MipChoice, Sampler, Texture, bake, coverage, downsample,
    dry_run,
};
use omm_model::opacity::OpacityState;

#[global_allocator]
static ALLOCATOR: dhat::Alloc = dhat::Alloc;

const LIMIT: usize = 64 << 20;

/// The most bytes that `run` had at once, its result left out.
fn peak<T>(run: impl FnOnce() -> T, size: impl Fn(&T) -> usize) -> (usize, T) {
    let profiler = dhat::Profiler::builder().testing().build();
    let result = run();
    let peak = dhat::HeapStats::get().max_bytes;
    drop(profiler);
    (peak.saturating_sub(size(&result)), result)
}

fn size(output: &BakeOutput) -> usize {
    let BakeOutput { array, triangles, indices, .. } = output;
    array.len() + size_of_val(&triangles[..]) + size_of_val(&indices[..])
}

fn check(what: &str, input: &BakeInput<'_>, options: &BakeOptions) -> BakeOutput {
    let (peak, output) = peak(|| bake(input, options, &|_| {}).unwrap(), size);
    println!("memory: {what}: {} KiB beside input and result of {} KiB", peak >> 10, size(&output) >> 10);
    assert!(peak < LIMIT, "{what}: {peak} bytes");
    output
}

fn main() {
    largest_texture();
    many_triangles();
    budgets();
}

/// 16383 x 16381 texels, opaque right of a line; sides that are no powers of two, and texel numbers beyond 2^28.
fn largest_texture() {
    let (width, height) = (16_383_u32, 16_381_u32);
    let mut texels = Vec::with_capacity(width as usize * height as usize);
    for y in 0..height as usize {
        texels.extend(repeat_n(0, y));
        texels.extend(repeat_n(255, width as usize - y));
    }
    let half = Texture::unorm8(width / 2, height / 2, texels[..8191 * 8190].to_vec()).unwrap();
    let texture = Texture::unorm8(width, height, texels).unwrap().with_mips(vec![half]).unwrap();
    let uvs =
        [[0.0, 0.0], [0.9999, 0.0], [0.9999, 0.9999], [0.0, 0.9999], [0.999, 0.0], [0.9995, 0.0], [0.999, 0.0005]];
    let triangles = [[0, 1, 2], [0, 2, 3], [0, 1, 3], [4, 5, 6]];
    let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
    // Nothing wraps round from the last row to the first.
    let sampler = Sampler::new(AddressMode::Clamp, Filter::Linear, 0.0);
    let first = BakeOptions { mips: MipChoice::Range { first: 0, last: 0 }, sampler, ..uniform(7) };
    let output = check("a texture of 16383 x 16381", &input, &first);
    let state = |triangle| common::states(&output, triangle).1;
    assert!(state(3) == [OpacityState::Opaque], "far right");
    // The line runs along the first two triangles' common side, a little on the second's side, and through the third.
    assert!(state(0) == [OpacityState::Opaque], "right of the line");
    let count = |triangle, wanted| state(triangle).into_iter().filter(|state| *state == wanted).count();
    let left = count(1, OpacityState::Transparent);
    assert!((128 * 126..128 * 128).contains(&left), "{left}");
    let both = [OpacityState::Opaque, OpacityState::Transparent].map(|wanted| count(2, wanted));
    assert!(both.iter().all(|known| (128 * 62..128 * 64).contains(known)), "{both:?}");
    check("the same with two mips", &input, &BakeOptions { sampler, ..uniform(6) });
}

fn many_triangles() {
    let texture = discs(256, 1, 40);
    let (uvs, triangles) = mesh(1, 100_000, 0.05);
    let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
    let output = check("100000 distinct triangles", &input, &uniform(3));
    check("the same, almost equal ones merged", &input, &BakeOptions { merge_distance: 0.1, ..uniform(3) });
    let budget = Some(output.array.len() as u64 / 2);
    check("the same, half the bytes", &input, &BakeOptions { max_array_bytes: budget, ..uniform(3) });
    let (dry, _) = peak(|| dry_run(&input, &uniform(3)).unwrap(), |run| size_of_val(&run.levels[..]));
    let (covered, _) = peak(|| coverage(&input, &output), |coverage| size_of_val(&coverage.triangles[..]));
    let (lower, _) = peak(|| downsample(&output, 1, &uniform(3)).unwrap(), size);
    println!("memory: dry run {} KiB, coverage {} KiB, downsampling {} KiB", dry >> 10, covered >> 10, lower >> 10);
    assert!(dry < LIMIT && covered < LIMIT && lower < LIMIT);
}

/// 72 MiB of data that the budget does not let come to be.
fn budgets() {
    let texture = discs(64, 1, 2);
    let (uvs, triangles) = mesh(3, 72, 0.9);
    let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
    let options = BakeOptions { max_array_bytes: Some(1000), special_indices: false, merge: false, ..uniform(11) };
    let output = check("72 triangles of 1 MiB each, in 1000 bytes", &input, &options);
    assert!(output.array.len() <= 1000);
}
