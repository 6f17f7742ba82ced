//! Traversal: bare triangles beside the hierarchy crate's own walk, the garden with micromaps and without.

#![allow(missing_docs)]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use omm_bench::rays::{Garden, Opaque};

const SIZE: [u32; 2] = [240, 135];

fn traversal(criterion: &mut Criterion) {
    let Ok(garden) = Garden::new() else { return };
    let Ok(opaque) = Opaque::new(&garden, SIZE) else { return };
    let mut group = criterion.benchmark_group("opaque");
    group.throughput(Throughput::Elements(opaque.rays() as u64));
    group.bench_function("omm-trace", |bencher| bencher.iter(|| opaque.ours()));
    group.bench_function("obvhs", |bencher| bencher.iter(|| opaque.bare()));
    group.finish();
    let Ok(rays) = garden.rays(SIZE) else { return };
    let mut group = criterion.benchmark_group("garden");
    group.sample_size(20).throughput(Throughput::Elements(rays.len() as u64));
    group.bench_function("micromaps", |bencher| bencher.iter(|| garden.trace(&garden.with, &rays)));
    group.bench_function("any-hit only", |bencher| bencher.iter(|| garden.trace(&garden.without, &rays)));
    group.finish();
}

criterion_group!(benches, traversal);
criterion_main!(benches);
