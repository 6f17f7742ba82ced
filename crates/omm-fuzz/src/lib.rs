//! The bodies of fuzz targets, as plain functions that take any bytes; ordinary tests run them over seeds and mutations of seeds.
//!
//! Each is an equality or holds two readers against each other, and panics where they disagree: that is how a fuzzer is told. The
//! programs for cargo-fuzz are in `fuzz/`; `docs/fuzzing.md` says how to run them.
//!
//! ```
//! for target in omm_fuzz::TARGETS {
//!     let seeds = (target.seeds)();
//!     seeds.iter().take(3).for_each(|seed| (target.body)(seed));
//!     println!("{}: {} seeds", target.name, seeds.len());
//! }
//! ```
// A finding is told by a panic.
#![allow(clippy::panic)]

mod bake;
mod blob;
mod bundle;
pub mod calls;
mod made;
mod packed;
mod scenario;
pub mod seeds;
mod trace;

pub use bake::bake_exact;
pub use blob::{blob_identity, blob_incremental, blob_structured, object_payload};
pub use bundle::bundle_decode;
pub use calls::replay;
pub use made::made;
pub use packed::packed_data;
pub use scenario::scenario_text;
pub use trace::{trace_decode, trace_structured};

/// Where the validator says nothing, the device does not stop.
pub fn two_readings(bytes: &[u8]) {
    calls::calls(bytes);
}

/// A fuzz target: what to do with any bytes, and where to begin.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name, which is that of the program in `fuzz/fuzz_targets`.
    pub name: &'static str,
    /// It returns, or panics with what is wrong.
    pub body: fn(&[u8]),
    /// Inputs to begin with, made of our own output.
    pub seeds: fn() -> Vec<Vec<u8>>,
}

/// Every target.
pub const TARGETS: [Target; 12] = [
    Target { name: "blob_identity", body: blob_identity, seeds: seeds::blobs },
    Target { name: "blob_incremental", body: blob_incremental, seeds: seeds::blobs_in_pieces },
    Target { name: "blob_structured", body: blob_structured, seeds: seeds::blobs },
    Target { name: "object_payload", body: object_payload, seeds: seeds::blobs },
    Target { name: "bundle_decode", body: bundle_decode, seeds: seeds::bundles },
    Target { name: "trace_decode", body: trace_decode, seeds: seeds::traces },
    Target { name: "trace_structured", body: trace_structured, seeds: seeds::numbers },
    Target { name: "scenario_text", body: scenario_text, seeds: seeds::scenarios },
    Target { name: "two_readings", body: two_readings, seeds: seeds::numbers },
    Target { name: "replay", body: replay, seeds: seeds::numbers },
    Target { name: "packed_data", body: packed_data, seeds: seeds::numbers },
    Target { name: "bake_exact", body: bake_exact, seeds: seeds::numbers },
];
