//! Serialized data and bundles beside `memcpy`: what is done to bytes that a copy would not do.
//!
//! Ours and the copy get their memory alike. What makes a new buffer is held against a copy into a new buffer, so both pay for
//! fresh pages; what works in place, against a copy between two buffers that were in use before. Pages are most of what large
//! buffers cost: with micromaps of 16 MiB (`--size 16777216`), whose memory allocators use again, the ratios are those of the copying
//! and checking alone. Both run on the calling thread, in turns of a fifth of a second of processor time, and the fastest of
//! several rounds counts.

use std::hint::black_box;
use std::time::Duration;

use omm_layout::object::{MicromapContents, MicromapTriangleData, TlasContents};
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::profile::Uuid;
use omm_model::triangle::MicromapTriangle;
use omm_model::{usage, vk};
use omm_serialize::bundle::{Bundle, BundleData, Checksums, MicromapData};
use omm_serialize::{ByteOrder, deserialize_object, replace_references, serialize_object};
use serde::Serialize;

use crate::clock::{self, ClockKind, Times};
use crate::foliage::Random;

/// How long a round of one of the two lasts.
const ENOUGH: Duration = Duration::from_millis(200);

/// Bytes of the micromaps that are measured.
pub const MICROMAP_SIZE: usize = 256 << 20;
/// Handles of the top-level structure that is relocated.
pub const HANDLES: usize = 1_000_000;

/// What was measured.
#[derive(Clone, Debug, Serialize)]
pub struct CopyRow {
    /// What was done.
    pub name: String,
    /// Bytes that went in, which are the bytes that the copy copies.
    pub bytes: u64,
    /// Where both wrote to.
    pub memory: Memory,
    /// Ours, 10<sup>9</sup> bytes a second.
    pub ours_gb_per_s: f64,
    /// The copy, 10<sup>9</sup> bytes a second.
    pub memcpy_gb_per_s: f64,
    /// The first over the second.
    pub ratio: f64,
    /// What the ratio is to be at least, where that is a goal.
    pub goal: Option<f64>,
    /// Our slowest round over our fastest, and the same for the copy: how noisy the measurement was.
    pub spread: [f64; 2],
    /// What time was measured with.
    pub clock: ClockKind,
}

/// Where both wrote to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Memory {
    /// A buffer of their own each time.
    New,
    /// Buffers that were in use before.
    InUse,
    /// Ours nowhere, the copy into a buffer of its own.
    None,
}

/// A built micromap of about `size` bytes, all triangles of one level with four states, none like another.
#[must_use]
pub fn micromap(size: usize, level: SubdivisionLevel) -> Vec<u8> {
    let format = OpacityMicromapFormat::FourState;
    let block = format.data_size(level) as usize;
    let data = noise(size / (16 + block.next_multiple_of(8)) * block);
    let triangle = |data| MicromapTriangleData { subdivision_level: level, format, data };
    let triangles = data.chunks_exact(block).map(triangle).collect();
    MicromapContents { flags: 0, triangles }.encode().unwrap_or_default()
}

/// The serialized data of a top-level structure that refers to so many others.
#[must_use]
pub fn top_level(handles: usize) -> Vec<u8> {
    let instance =
        |at: u64| vk::Instance { acceleration_structure_reference: 256 * (at + 1), ..vk::Instance::default() };
    let object = TlasContents { flags: 0, instances: (0..handles as u64).map(instance).collect() }.encode();
    serialize_object(&object.unwrap_or_default(), Uuid::default(), Uuid::default()).unwrap_or_default()
}

/// A bundle of one micromap with an array of about `size` bytes and twice as many indices as triangles.
#[must_use]
pub fn bundle(size: usize, level: SubdivisionLevel) -> Vec<u8> {
    let format = OpacityMicromapFormat::FourState;
    let block = format.data_size(level);
    let count = size as u32 / block;
    let triangle = |at| MicromapTriangle { data_offset: at * block, subdivision_level: level, format };
    let triangles: Vec<_> = (0..count).map(triangle).collect();
    let index = |at: u32| if at.is_multiple_of(5) { -1 } else { (at / 2).cast_signed() };
    let indices: Vec<_> = (0..2 * count).map(index).collect();
    let used = indices.iter().filter_map(|&index| triangles.get(usize::try_from(index).ok()?).copied());
    let micromap = MicromapData {
        name: "noise".to_owned(),
        array: noise((count * block) as usize),
        usage_counts: usage::histogram(triangles.iter().copied()),
        index_usage_counts: usage::histogram(used),
        triangles,
        indices,
        ..MicromapData::default()
    };
    BundleData { micromaps: vec![micromap] }.write()
}

/// What an engine takes out of a bundle: array, triangles and indices, each copied once.
#[must_use]
pub fn load(bytes: &[u8], checksums: Checksums) -> Option<[Vec<u8>; 3]> {
    let bundle = Bundle::read(bytes, checksums).ok()?;
    let micromap = bundle.micromaps.first()?;
    Some([micromap.array.to_vec(), micromap.triangle_bytes().to_vec(), micromap.index_bytes().to_vec()])
}

/// Relocates the little-endian `blob` in place, as if everything had moved by as many bytes.
pub fn relocate(blob: &mut [u8]) -> usize {
    replace_references(blob, ByteOrder::Little, |address| address.wrapping_add(0x1000)).unwrap_or_default()
}

fn noise(size: usize) -> Vec<u8> {
    let mut random = Random(size as u64);
    let mut bytes = Vec::with_capacity(size + 8);
    while bytes.len() < size {
        bytes.extend_from_slice(&random.bits().to_le_bytes());
    }
    bytes.truncate(size);
    bytes
}

/// Measures everything, `rounds` times each, with micromaps of about `size` bytes and so many `handles`.
#[must_use]
pub fn measure(size: usize, handles: usize, rounds: u32) -> Vec<CopyRow> {
    let mut rows = Vec::new();
    for level in [SubdivisionLevel::MAX, level(8), level(5), level(3)] {
        let object = micromap(size, level);
        let name = |what: &str| format!("{what} a micromap of level {}", level.get());
        rows.push(against_new(name("serialize"), &object, Some(0.5), rounds, || {
            serialize_object(&object, Uuid::default(), Uuid::default()).map(|blob| blob.len())
        }));
        let blob = serialize_object(&object, Uuid::default(), Uuid::default()).unwrap_or_default();
        drop(object);
        rows.push(against_new(name("deserialize"), &blob, Some(0.5), rounds, || {
            deserialize_object(&blob).map(|object| object.len())
        }));
    }
    rows.push(relocation(handles, rounds));
    for level in [level(8), level(5)] {
        let bytes = bundle(size, level);
        let name = |what: &str| format!("{what} a bundle of level {}", level.get());
        let (skip, verify) = (Checksums::Skip, Checksums::Verify);
        rows.push(against_new(name("load"), &bytes, Some(0.8), rounds, || load(&bytes, skip)));
        rows.push(against_new(name("load and checksum"), &bytes, None, rounds, || load(&bytes, verify)));
        let read = |checksums| Bundle::read(&bytes, checksums).map(|bundle| bundle.micromaps.len());
        let borrowed = |row| CopyRow { memory: Memory::None, ..row };
        rows.push(borrowed(against_new(name("borrow"), &bytes, None, rounds, || read(skip))));
        rows.push(borrowed(against_new(name("borrow and checksum"), &bytes, None, rounds, || read(verify))));
    }
    rows
}

/// `level`, or 12 if there is no such one.
fn level(level: u32) -> SubdivisionLevel {
    SubdivisionLevel::new(level).unwrap_or(SubdivisionLevel::MAX)
}

/// `work`, which reads `bytes`, beside a copy of `bytes` into a new buffer.
fn against_new<T>(name: String, bytes: &[u8], goal: Option<f64>, rounds: u32, mut work: impl FnMut() -> T) -> CopyRow {
    let (mut ours, mut copy) = (Times::default(), Times::default());
    for _ in 0..rounds.max(1) {
        ours.add(clock::time(ENOUGH, || drop(black_box(work()))).0);
        copy.add(clock::time(ENOUGH, || drop(black_box(black_box(bytes).to_vec()))).0);
    }
    row(name, bytes.len(), Memory::New, goal, [ours, copy])
}

/// The relocation of so many handles beside a copy of the handles alone.
fn relocation(handles: usize, rounds: u32) -> CopyRow {
    let mut blob = top_level(handles);
    let (from, mut to) = (noise(8 * handles), vec![1; 8 * handles]);
    let (mut ours, mut copy) = (Times::default(), Times::default());
    for _ in 0..rounds.max(1) {
        ours.add(clock::time(ENOUGH, || black_box(relocate(black_box(&mut blob)))).0);
        copy.add(clock::time(ENOUGH, || black_box(&mut to).copy_from_slice(black_box(&from))).0);
    }
    row(format!("relocate {handles} handles"), from.len(), Memory::InUse, Some(0.5), [ours, copy])
}

fn row(name: String, bytes: usize, memory: Memory, goal: Option<f64>, [ours, copy]: [Times; 2]) -> CopyRow {
    let rate = |times: &Times| bytes as f64 / times.least().as_secs_f64() / 1e9;
    CopyRow {
        name,
        bytes: bytes as u64,
        memory,
        ours_gb_per_s: rate(&ours),
        memcpy_gb_per_s: rate(&copy),
        ratio: rate(&ours) / rate(&copy),
        goal,
        spread: [ours.spread(), copy.spread()],
        clock: clock::kind(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_measured_is_done() {
        let (size, three) = (1 << 16, level(3));
        let object = micromap(size, three);
        assert_eq!(object.len(), 64 + size);
        let blob = serialize_object(&object, Uuid::default(), Uuid::default()).unwrap();
        assert_eq!(deserialize_object(&blob), Ok(object));
        let mut blob = top_level(100);
        let before: Vec<_> = omm_serialize::Blob::read(&blob, ByteOrder::Little).unwrap().handles().collect();
        assert_eq!(relocate(&mut blob), 100);
        let after: Vec<_> = omm_serialize::Blob::read(&blob, ByteOrder::Little).unwrap().handles().collect();
        assert!(before.len() == 100 && before.iter().zip(after).all(|(before, after)| before + 0x1000 == after));
        let [array, triangles, indices] = load(&bundle(size, three), Checksums::Verify).unwrap();
        assert_eq!([array.len(), triangles.len(), indices.len()], [size, size / 16 * 8, size / 16 * 2 * 4]);
    }
}
