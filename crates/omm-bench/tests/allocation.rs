//! A check allocates nothing where nothing is wrong.
//!
//! A program of its own (`harness = false`): the test harness has a second thread, whose allocations would be counted too.
#![allow(clippy::print_stdout)]

use omm_bench::calls::Program;
use omm_model::call::Call;
use omm_model::memory::{MemoryView, NoMemory};

#[global_allocator]
static ALLOCATOR: dhat::Alloc = dhat::Alloc;

/// How many blocks the check of a valid call allocates.
fn allocations(program: &Program, call: &Call, memory: &dyn MemoryView) -> u64 {
    let profiler = dhat::Profiler::builder().testing().build();
    let before = dhat::HeapStats::get();
    let report = program.validator.check(call, memory);
    let after = dhat::HeapStats::get();
    drop(profiler);
    assert!(report.is_empty(), "{report}");
    after.total_blocks - before.total_blocks
}

fn main() {
    let program = Program::new(1000);
    let calls = program.calls();
    for (name, call) in &calls {
        for memory in [&NoMemory as &dyn MemoryView, &program.memory()] {
            assert_eq!(allocations(&program, call, memory), 0, "{name}");
        }
    }
    counting_counts(&program);
    println!("allocation: {} calls, each with and without memory, none allocates", calls.len());
}

/// A check that finds something does allocate, so that no allocation means something.
fn counting_counts(program: &Program) {
    let mut call = program.build_micromap();
    if let Call::CmdBuildAccelerationStructures { infos, .. } = &mut call {
        infos[0].geometries = None;
    }
    let profiler = dhat::Profiler::builder().testing().build();
    let report = program.validator.check(&call, &NoMemory);
    let blocks = dhat::HeapStats::get().total_blocks;
    drop(profiler);
    assert!(!report.is_empty() && blocks > 0, "{blocks} blocks: {report}");
}
