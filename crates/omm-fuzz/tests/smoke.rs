//! The targets on seeds, and on seeds with errors.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use omm_fuzz::TARGETS;

/// Mutations for each target.
const MUTATIONS: usize = 1000;

/// A small generator of numbers; only its determinism matters.
fn next(state: &mut u64) -> usize {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    *state as usize
}

/// What fuzzing found wrong with a target once, each under a name that says what.
fn findings(name: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("findings").join(name);
    let Ok(files) = std::fs::read_dir(folder) else { return Vec::new() };
    files.map(|file| std::fs::read(file.unwrap().path()).unwrap()).collect()
}

/// The target of that name on its seeds, earlier findings and their mutations.
fn smoke(name: &str) {
    let target = TARGETS.iter().find(|target| target.name == name).unwrap();
    let seeds = (target.seeds)();
    assert!(!seeds.is_empty());
    seeds.iter().chain(&findings(name)).for_each(|bytes| (target.body)(bytes));
    let mut state = 0x9e37_79b9_7f4a_7c15;
    for seed in seeds.iter().cycle().take(MUTATIONS) {
        let mut bytes = seed.clone();
        for _ in 0..next(&mut state) % 4 {
            match next(&mut state) % 3 {
                _ if bytes.is_empty() => bytes.push(next(&mut state) as u8),
                0 => bytes.truncate(next(&mut state) % bytes.len()),
                _ => {
                    let at = next(&mut state) % bytes.len();
                    bytes[at] = [0, 1, 0xff, next(&mut state) as u8][next(&mut state) % 4];
                }
            }
        }
        (target.body)(&bytes);
    }
}

/// One test for each target.
macro_rules! smoke {
    ($($target:ident)*) => {
        $(
            #[test]
            fn $target() {
                smoke(stringify!($target));
            }
        )*
        const TESTED: &[&str] = &[$(stringify!($target)),*];
    };
}

smoke! {
    blob_identity
    blob_incremental
    blob_structured
    object_payload
    bundle_decode
    trace_decode
    trace_structured
    scenario_text
    two_readings
    replay
    packed_data
    bake_exact
}

fn fuzz() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz")
}

#[test]
fn every_target_has_a_test_and_a_program() {
    let names: BTreeSet<&str> = TARGETS.iter().map(|target| target.name).collect();
    assert_eq!(names, TESTED.iter().copied().collect());
    let manifest = std::fs::read_to_string(fuzz().join("Cargo.toml")).unwrap();
    let programs: BTreeSet<&str> = manifest
        .lines()
        .filter_map(|line| line.strip_prefix("path = \"fuzz_targets/")?.strip_suffix(".rs\""))
        .collect();
    assert_eq!(names, programs);
    for name in names {
        let program = std::fs::read_to_string(fuzz().join(format!("fuzz_targets/{name}.rs"))).unwrap();
        assert_eq!(
            program,
            format!("#![no_main]\n\nlibfuzzer_sys::fuzz_target!(|bytes: &[u8]| omm_fuzz::{name}(bytes));\n")
        );
    }
}

#[test]
fn seeds_of_formats_are_read() {
    use omm_serialize::bundle::{Bundle, Checksums};
    use omm_serialize::trace::Trace;
    assert!(omm_fuzz::seeds::bundles().iter().all(|seed| Bundle::read(seed, Checksums::Verify).is_ok()));
    let traces = omm_fuzz::seeds::traces();
    let read = |seed: &&Vec<u8>| Trace::read(seed, Checksums::Verify).is_ok();
    assert_eq!(traces.iter().filter(read).count() * 2, traces.len(), "half are bytes, half are text");
    assert!(traces.len() >= 20);
}
