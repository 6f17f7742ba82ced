//! How the time of a bake grows with the level, the texture and the number of triangles: the figure of the baking guide.
//!
//! `cargo run --release -p omm-bench --bin growth` prints the numbers and writes `docs/images/growth.svg`.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::PathBuf;
use std::time::Duration;

use clap::Parser;
use omm_bake::{BakeInput, BakeOptions, LevelChoice, Texture, bake};
use omm_bench::clock;
use omm_bench::plot::{Panel, figure};
use omm_bench::workload::Workload;

/// How the time of a bake grows.
#[derive(Parser)]
struct Arguments {
    /// Where the figure goes.
    #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/images/growth.svg"))]
    out: PathBuf,
}

/// How often each point is measured; the least time counts.
const ROUNDS: usize = 3;

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let arguments = Arguments::parse();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build()?;
    let panels = pool.install(panels)?;
    let caption =
        "One thread, foliage texture, linear filter; dashed: in proportion to microtriangles, texels, triangles";
    std::fs::write(&arguments.out, figure(&panels, caption)?)?;
    Ok(())
}

fn panels() -> Result<Vec<Panel>, Box<dyn Error + Send + Sync>> {
    let base = Workload { name: "growth", texture_side: 1024, triangles: 64, level: 6, uv_size: 0.1 };
    let levels = (2..=10).map(|level| (4_f64.powi(level as i32), Workload { level, ..base }));
    let sides = (8..=13).map(|bits| (4_f64.powi(bits), Workload { texture_side: 1 << bits, ..base }));
    let counts = (4..=14).step_by(2).map(|bits| {
        let triangles = 1 << bits;
        (f64::from(triangles), Workload { triangles, level: 4, uv_size: 0.02, ..base })
    });
    Ok(vec![
        panel("Level", "level (4^N microtriangles)", levels, |count| (count.ln() / 4_f64.ln()).round().to_string())?,
        panel("Texture", "side of the texture in texels", sides, |texels| texels.sqrt().to_string())?,
        panel("Triangles", "triangles at level 4", counts, |count| count.to_string())?,
    ])
}

fn panel(
    title: &str,
    across: &str,
    workloads: impl Iterator<Item = (f64, Workload)>,
    label: fn(f64) -> String,
) -> Result<Panel, Box<dyn Error + Send + Sync>> {
    println!("| {across} | ms | M microtriangles/s |\n|---|---|---|");
    let mut points = Vec::new();
    for (value, workload) in workloads {
        let time = measure(&workload)?.as_secs_f64();
        let rate = workload.microtriangles() as f64 / time / 1e6;
        println!("| {} | {:.3} | {rate:.1} |", label(value), time * 1e3);
        points.push((value, time * 1e3));
    }
    println!();
    Ok(Panel { title: title.into(), across: across.into(), points, label })
}

/// The least time of a bake.
fn measure(workload: &Workload) -> Result<Duration, Box<dyn Error + Send + Sync>> {
    let texture = Texture::unorm8(workload.texture_side, workload.texture_side, workload.alpha())?;
    let (uvs, triangles) = (workload.uvs(), workload.indices());
    let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
    let level = LevelChoice::Uniform(workload.subdivision_level());
    let options = BakeOptions { level, ..BakeOptions::default() };
    let mut least = Duration::MAX;
    for _ in 0..ROUNDS {
        let (time, output) = clock::time(Duration::from_millis(100), || bake(&input, &options, &|_| {}));
        output?;
        least = least.min(time);
    }
    Ok(least)
}
