//! Traversal beside the hierarchy crate's own, and micromaps beside any-hit shaders alone, in turns.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::time::{Duration, Instant};

use clap::{Parser, ValueEnum};
use omm_bench::clock;
use omm_bench::rays::{Garden, Opaque};
use serde_json::json;

/// Measures rays a second.
#[derive(Parser)]
struct Arguments {
    /// How results are printed.
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// How often each side does its work; the fastest round counts.
    #[arg(long, default_value_t = 5)]
    rounds: u32,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    Text,
    Json,
}

/// Pixels of a picture.
const SIZE: [u32; 2] = [480, 270];
/// How long a round of one side lasts.
const ENOUGH: Duration = Duration::from_millis(300);

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    // The clock counts this thread's time, so this thread does the work.
    rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global()?;
    let garden = Garden::new()?;
    let opaque = Opaque::new(&garden, SIZE)?;
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build();

    let [ours, bare] = fastest(arguments.rounds, [&|| opaque.ours() as u64, &|| opaque.bare() as u64]);
    let rays = opaque.rays() as f64;
    let aimed = garden.rays(SIZE)?;
    let trace = |scene| garden.trace(scene, &aimed).map_or(0, |counters| counters.rays);
    let [with, without] = fastest(arguments.rounds, [&|| trace(&garden.with), &|| trace(&garden.without)]);
    let (micromaps, shaders) = (garden.trace(&garden.with, &aimed)?, garden.trace(&garden.without, &aimed)?);
    let (one, two) = (pool(1)?, pool(2)?);
    let [one, two] = fastest_wall(
        arguments.rounds,
        [&|| one.install(|| picture_rays(&garden)), &|| two.install(|| picture_rays(&garden))],
    );

    let per_second = |rays: f64, time: Duration| rays / time.as_secs_f64() / 1e6;
    // Those of a picture, too.
    let aimed = aimed.len() as f64;
    let result = json!({ "trace": {
        "triangles": garden.with.triangle_count(),
        "opaque": {
            "rays": opaque.rays(),
            "ours_mrays_per_s": per_second(rays, ours),
            "obvhs_mrays_per_s": per_second(rays, bare),
            "ratio": bare.as_secs_f64() / ours.as_secs_f64(),
        },
        "micromaps": {
            "rays": micromaps.rays,
            "with_mrays_per_s": per_second(aimed, with),
            "without_mrays_per_s": per_second(aimed, without),
            "ratio": without.as_secs_f64() / with.as_secs_f64(),
            "any_hit_with": micromaps.any_hit_calls,
            "any_hit_without": shaders.any_hit_calls,
        },
        "threads": {
            "one_mrays_per_s": per_second(aimed, one),
            "two_mrays_per_s": per_second(aimed, two),
            "ratio": one.as_secs_f64() / two.as_secs_f64(),
        },
    }});
    if arguments.format == Format::Json {
        println!("{result}");
        return Ok(());
    }
    let show =
        |what: &str, ours: f64, theirs: f64| println!("{what:<48}{ours:>9.2}{theirs:>9.2}{:>7.2}", ours / theirs);
    println!("{:<48}{:>9}{:>9}{:>7}", "million rays a second", "first", "second", "ratio");
    show("opaque triangles: ours, bare walk of obvhs", per_second(rays, ours), per_second(rays, bare));
    show("garden: with micromaps, without", per_second(aimed, with), per_second(aimed, without));
    show("pictures of the garden: two threads, one", per_second(aimed, two), per_second(aimed, one));
    println!("any-hit calls: {} with micromaps, {} without", micromaps.any_hit_calls, shaders.any_hit_calls);
    Ok(())
}

fn picture_rays(garden: &Garden) -> u64 {
    garden.picture(&garden.with, SIZE).map_or(0, |counters| counters.rays)
}

/// The fastest round of each of two sides, which take turns, in processor time of this thread.
fn fastest(rounds: u32, sides: [&dyn Fn() -> u64; 2]) -> [Duration; 2] {
    let mut best = [Duration::MAX; 2];
    for _ in 0..rounds.max(1) {
        for (best, side) in best.iter_mut().zip(sides) {
            *best = clock::time(ENOUGH, side).0.min(*best);
        }
    }
    best
}

/// The same by the clock on the wall, for work of several threads.
fn fastest_wall(rounds: u32, sides: [&dyn Fn() -> u64; 2]) -> [Duration; 2] {
    let mut best = [Duration::MAX; 2];
    for _ in 0..2 * rounds.max(1) {
        for (best, side) in best.iter_mut().zip(sides) {
            let since = Instant::now();
            std::hint::black_box(side());
            *best = since.elapsed().min(*best);
        }
    }
    best
}
