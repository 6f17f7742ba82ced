//! How much faster a bake is on two threads than on one, by the clock on the wall.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::hint::black_box;
use std::time::{Duration, Instant};

use clap::Parser;
use omm_bake::{BakeInput, BakeOptions, LevelChoice, Texture, bake};
use omm_bench::arguments::{Common, Format};
use omm_bench::workload::Workload;
use serde_json::json;

/// Bakes on one thread and on two, in turns; the fastest round counts.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: Common,
}

/// How many times the triangles of the workloads are baked, so that the work lasts.
const TIMES: [u32; 3] = [16, 8, 4];

fn main() -> Result<(), Box<dyn Error>> {
    let Common { format, rounds } = Arguments::parse().common;
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pools = [pool(1)?, pool(2)?];
    let mut rows = Vec::new();
    for (workload, times) in Workload::PEERS.into_iter().zip(TIMES) {
        let workload = Workload { triangles: workload.triangles * times, ..workload };
        let texture = Texture::unorm8(workload.texture_side, workload.texture_side, workload.alpha())?;
        let (uvs, triangles) = (workload.uvs(), workload.indices());
        let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
        let level = LevelChoice::Uniform(workload.subdivision_level());
        let options = BakeOptions { level, ..BakeOptions::default() };
        let mut best = [Duration::MAX; 2];
        for _ in 0..rounds.max(1) {
            for (pool, best) in pools.iter().zip(&mut best) {
                let since = Instant::now();
                black_box(pool.install(|| bake(&input, &options, &|_| {}))?);
                *best = since.elapsed().min(*best);
            }
        }
        let [one, two] = best.map(|time| time.as_secs_f64());
        let microtriangles = workload.microtriangles();
        if format == Format::Text {
            println!("{microtriangles:>12} microtriangles {one:>8.4} s {two:>8.4} s {:>6.2}", one / two);
        }
        rows.push(json!({ "microtriangles": microtriangles, "one_s": one, "two_s": two, "ratio": one / two }));
    }
    if format == Format::Json {
        println!("{}", json!({ "cores": rows }));
    }
    Ok(())
}
