//! What each subdivision level costs and brings, on the foliage texture: the numbers of the baking guide.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::time::Duration;

use omm_bake::{BakeInput, BakeOptions, Filter, LevelChoice, Sampler, Texture, bake};
use omm_bench::clock;
use omm_bench::workload::Workload;

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build()?;
    pool.install(|| {
        let base = Workload { triangles: 64, ..Workload::PEERS[0] };
        let texture = Texture::unorm8(base.texture_side, base.texture_side, base.alpha())?;
        // The same triangles at every level.
        let (uvs, triangles) = (base.uvs(), base.indices());
        let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
        println!("| filter | level | texels a microtriangle | known | bytes a triangle | ms | M microtriangles/s |");
        println!("|---|---|---|---|---|---|---|");
        for filter in [Filter::Linear, Filter::Nearest] {
            for level in 1..=9 {
                let workload = Workload { level, ..base };
                let options = BakeOptions {
                    level: LevelChoice::Uniform(workload.subdivision_level()),
                    sampler: Sampler { filter, ..Sampler::default() },
                    ..BakeOptions::default()
                };
                let (time, output) = clock::time(Duration::from_millis(200), || bake(&input, &options, &|_| {}));
                let (seconds, statistics) = (time.as_secs_f64(), output?.statistics);
                let side = base.uv_size * f64::from(base.texture_side);
                let texels = side * side / 2.0 / f64::from(workload.subdivision_level().microtriangles());
                println!(
                    "| {filter:?} | {level} | {texels:.2} | {:.1} % | {} | {:.3} | {:.1} |",
                    statistics.known_fraction * 100.0,
                    statistics.array_bytes / u64::from(base.triangles),
                    seconds * 1e3,
                    workload.microtriangles() as f64 / seconds / 1e6
                );
            }
        }
        Ok(())
    })
}
