//! Serialized data and bundles, and copies of the same bytes to hold them against.
//!
//! Each group has a `memcpy` of its own with the same allocations: into a new buffer, or for `relocate` between buffers in use. The
//! program `serialized` measures the same in turns and prints the ratios. Time is the thread's on a processor, as others may use the
//! machine.

#![allow(missing_docs)]

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::measurement::{Measurement, ValueFormatter, WallTime};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use omm_bench::clock;
use omm_bench::copies::{HANDLES, MICROMAP_SIZE, bundle, load, micromap, relocate, top_level};
use omm_model::level::SubdivisionLevel;
use omm_model::profile::Uuid;
use omm_serialize::bundle::{Bundle, Checksums};
use omm_serialize::{deserialize_object, serialize_object};

/// Time that the thread ran; time on the wall where the system does not tell the former.
struct ThreadTime;

impl Measurement for ThreadTime {
    type Intermediate = (Instant, Option<Duration>);
    type Value = Duration;

    fn start(&self) -> Self::Intermediate {
        (Instant::now(), clock::thread_time())
    }

    fn end(&self, (wall, thread): Self::Intermediate) -> Duration {
        let spent = thread.and_then(|start| clock::thread_time()?.checked_sub(start));
        spent.unwrap_or_else(|| wall.elapsed())
    }

    fn add(&self, a: &Duration, b: &Duration) -> Duration {
        *a + *b
    }

    fn zero(&self) -> Duration {
        Duration::ZERO
    }

    fn to_f64(&self, value: &Duration) -> f64 {
        WallTime.to_f64(value)
    }

    fn formatter(&self) -> &dyn ValueFormatter {
        WallTime.formatter()
    }
}

fn level() -> SubdivisionLevel {
    SubdivisionLevel::new(5).unwrap_or(SubdivisionLevel::MAX)
}

fn objects(criterion: &mut Criterion<ThreadTime>) {
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

fn relocation(criterion: &mut Criterion<ThreadTime>) {
    let mut blob = top_level(HANDLES);
    let (from, mut to) = (vec![1_u8; 8 * HANDLES], vec![2_u8; 8 * HANDLES]);
    let mut group = criterion.benchmark_group("relocate");
    // Systems may count a thread's time in steps of some milliseconds: one pass would be too short.
    const PASSES: usize = 200;
    group.sample_size(10).throughput(Throughput::Bytes((PASSES * from.len()) as u64));
    group.bench_function("memcpy", |bencher| {
        bencher.iter(|| (0..PASSES).for_each(|_| black_box(&mut to).copy_from_slice(black_box(&from))));
    });
    group.bench_function("ours", |bencher| {
        bencher.iter(|| (0..PASSES).map(|_| relocate(black_box(&mut blob))).sum::<usize>());
    });
}

fn bundles(criterion: &mut Criterion<ThreadTime>) {
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

criterion_group! {
    name = benches;
    config = Criterion::default().with_measurement(ThreadTime);
    targets = objects, relocation, bundles
}
criterion_main!(benches);
