//! What a check costs where nothing is wrong: by the call, and by the byte of arrays whose contents are looked at.

#![allow(missing_docs)]

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use omm_bench::calls::Program;
use omm_model::memory::NoMemory;

/// Triangles of the arrays that are looked at: 8 MiB of triangle array; 4 MiB of indices beside 36 MiB of vertices, which are not
/// counted, though they are read as well.
const TRIANGLES: u32 = 1 << 20;

fn calls(criterion: &mut Criterion) {
    let program = Program::new(2);
    let mut group = criterion.benchmark_group("validate/call");
    for (name, call) in program.calls() {
        group.bench_function(name, |bencher| bencher.iter(|| program.validator.check(black_box(&call), &NoMemory)));
    }
    group.finish();
}

fn contents(criterion: &mut Criterion) {
    let program = Program::new(TRIANGLES);
    let mut group = criterion.benchmark_group("validate/contents");
    for (name, call, bytes) in [
        ("triangle array", program.build_micromap(), 8 * u64::from(TRIANGLES)),
        ("EXT triangle array", program.build_micromap_ext(), 8 * u64::from(TRIANGLES)),
        ("indices", program.build_mesh(), 4 * u64::from(TRIANGLES)),
        ("EXT indices", program.build_mesh_ext(), 4 * u64::from(TRIANGLES)),
    ] {
        group.throughput(Throughput::Bytes(bytes));
        let memory = program.memory();
        group.bench_function(name, |bencher| bencher.iter(|| program.validator.check(black_box(&call), &memory)));
    }
    group.finish();
}

criterion_group!(benches, calls, contents);
criterion_main!(benches);
