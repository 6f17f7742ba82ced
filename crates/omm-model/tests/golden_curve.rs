//! The bird curve against 60,000 records of the specification's reference code compiled as C, and against the elements that a
//! driver read for 54,509 hits.
#![allow(clippy::unwrap_used, clippy::print_stderr)]

use std::path::PathBuf;

use omm_model::curve;
use omm_model::level::SubdivisionLevel;

fn golden(name: &str) -> Option<Vec<u8>> {
    let folder = std::env::var_os("OMM_GOLDEN")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/golden"), PathBuf::from);
    match std::fs::read(folder.join(name)) {
        Ok(bytes) => Some(bytes),
        Err(error) => {
            eprintln!("skipped: golden data absent ({name}: {error})");
            None
        }
    }
}

fn words<const N: usize>(bytes: &[u8]) -> impl Iterator<Item = [[u8; 4]; N]> + '_ {
    bytes.chunks_exact(4 * N).map(|record| std::array::from_fn(|i| record[4 * i..4 * i + 4].try_into().unwrap()))
}

#[test]
fn index_equals_the_reference_code() {
    let Some(bytes) = golden("bird_curve/uv_level_index.bin") else { return };
    let mut records = 0;
    for [u, v, level, expected] in words(&bytes) {
        let (u, v) = (f32::from_le_bytes(u), f32::from_le_bytes(v));
        let level = SubdivisionLevel::new(u32::from_le_bytes(level)).unwrap();
        assert_eq!(curve::index(u, v, level), u32::from_le_bytes(expected), "u {u:e}, v {v:e}, level {level}");
        records += 1;
    }
    assert_eq!(records, 60_000);
}

#[test]
fn index_equals_what_a_driver_read_away_from_edges() {
    let Some(bytes) = golden("traversal/lookup.bin") else { return };
    let mut records = [0; 5];
    for [u, v, level, kind, expected] in words(&bytes) {
        let (u, v) = (f32::from_le_bytes(u), f32::from_le_bytes(v));
        let level = SubdivisionLevel::new(u32::from_le_bytes(level)).unwrap();
        let kind = u32::from_le_bytes(kind) as usize;
        records[kind] += 1;
        // Kinds 2 and 3 lie on an edge or vertex, where the driver breaks ties in its own way.
        if matches!(kind, 0 | 1 | 4) {
            assert_eq!(curve::index(u, v, level), u32::from_le_bytes(expected), "u {u:e}, v {v:e}, level {level}");
        }
    }
    assert_eq!(records.iter().sum::<u32>(), 54_509);
}
