//! Serialized data and bundles, and copies of the same bytes to hold them against.
//!
//! Each group has a `memcpy` of its own with the same allocations: into a new buffer, or for `relocate` between buffers in use. The
//! program `serialized` measures the same in turns and prints the ratios.

#![allow(missing_docs)]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use omm_bench::copies::{HANDLES, MICROMAP_SIZE, bundle, load, micromap, relocate, top_level};
use omm_model::level::SubdivisionLevel;
use omm_model::profile::Uuid;
use omm_serialize::bundle::{Bundle, Checksums};
use omm_serialize::{deserialize_object, serialize_object};

fn level() -> SubdivisionLevel {
    SubdivisionLevel::new(5).unwrap_or(SubdivisionLevel::MAX)
}

fn objects(criterion: &mut Criterion) {
    let object = micromap(MICROMAP_SIZE, level());
    let mut group = criterion.benchmark_group("serialize");
    group.sample_size(10).throughput(Throughput::Bytes(object.len() as u64));
    group.bench_function("memcpy", |bencher| bencher.iter(|| object.to_vec()));
    group.bench_function("ours", |bencher| {
        bencher.iter(|| serialize_object(&object, Uuid::default(), Uuid::default()));
    });
    group.finish();
    let Ok(blob) = serialize_object(&object, Uuid::default(), Uuid::default()) else { return };
    let mut group = criterion.benchmark_group("deserialize");
    group.sample_size(10).throughput(Throughput::Bytes(blob.len() as u64));
    group.bench_function("memcpy", |bencher| bencher.iter(|| blob.to_vec()));
    group.bench_function("ours", |bencher| bencher.iter(|| deserialize_object(&blob)));
}

fn relocation(criterion: &mut Criterion) {
    let mut blob = top_level(HANDLES);
    let (from, mut to) = (vec![1_u8; 8 * HANDLES], vec![2_u8; 8 * HANDLES]);
    let mut group = criterion.benchmark_group("relocate");
    group.throughput(Throughput::Bytes(from.len() as u64));
    group.bench_function("memcpy", |bencher| bencher.iter(|| to.copy_from_slice(&from)));
    group.bench_function("ours", |bencher| bencher.iter(|| relocate(&mut blob)));
}

fn bundles(criterion: &mut Criterion) {
    let bytes = bundle(MICROMAP_SIZE, level());
    let mut group = criterion.benchmark_group("bundle");
    group.sample_size(10).throughput(Throughput::Bytes(bytes.len() as u64));
    group.bench_function("memcpy", |bencher| bencher.iter(|| bytes.to_vec()));
    group.bench_function("load", |bencher| bencher.iter(|| load(&bytes, Checksums::Skip)));
    group.bench_function("load and checksum", |bencher| bencher.iter(|| load(&bytes, Checksums::Verify)));
    group.bench_function("checksum", |bencher| {
        bencher.iter(|| Bundle::read(&bytes, Checksums::Verify).map(|bundle| bundle.micromaps.len()));
    });
}

criterion_group!(benches, objects, relocation, bundles);
criterion_main!(benches);
