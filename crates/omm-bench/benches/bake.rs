//! The baker's parts: whole bakes by level, and the making of what a bake starts from.

#![allow(missing_docs)]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use omm_bake::{BakeInput, BakeOptions, Filter, LevelChoice, Sampler, Surface, Texture, bake};
use omm_bench::workload::Workload;

fn texture(workload: &Workload) -> Option<Texture> {
    Texture::unorm8(workload.texture_side, workload.texture_side, workload.alpha()).ok()
}

fn bakes(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("bake");
    group.sample_size(10);
    for filter in [Filter::Linear, Filter::Nearest] {
        for level in [2, 4, 6, 8] {
            let workload = Workload { level, ..Workload::PEERS[0].scaled_down(8) };
            let Some(texture) = texture(&workload) else { continue };
            let (uvs, triangles) = (workload.uvs(), workload.indices());
            let input = BakeInput { texture: &texture, uvs: &uvs, triangles: &triangles };
            let options = BakeOptions {
                level: LevelChoice::Uniform(workload.subdivision_level()),
                sampler: Sampler { filter, ..Sampler::default() },
                ..BakeOptions::default()
            };
            group.throughput(Throughput::Elements(workload.microtriangles()));
            let id = BenchmarkId::new(format!("{filter:?}"), level);
            group.bench_function(id, |bencher| bencher.iter(|| bake(&input, &options, &|_| {})));
        }
    }
}

fn surfaces(criterion: &mut Criterion) {
    let Some(texture) = texture(&Workload::PEERS[0]) else { return };
    criterion.bench_function("surface of 1024 x 1024", |bencher| {
        bencher.iter(|| Surface::new(&texture, Sampler::default(), 0.5).map(|surface| surface.uniform()));
    });
}

criterion_group!(benches, bakes, surfaces);
criterion_main!(benches);
