//! What reading costs: at most 2n + 64 KiB of memory for n bytes of any content, and time linear in n.
//!
//! A program of its own (`harness = false`): the test harness has a second thread, whose allocations would be counted too.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

use std::time::{Duration, Instant};

use omm_layout::object::{
    BlasContents, BlasGeometry, BlasPrimitives, MicromapContents, MicromapTriangleData, TlasContents,
};
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::profile::Uuid;
use omm_model::triangle::MicromapTriangle;
use omm_model::vk;
use omm_serialize::bundle::{Bundle, BundleData, Checksums, MicromapData, Source};
use omm_serialize::{Blob, ByteOrder, Head, StreamReader, deserialize_object, replace_references, serialize_object};

#[global_allocator]
static ALLOCATOR: dhat::Alloc = dhat::Alloc;

const SIZES: [usize; 3] = [1 << 12, 1 << 16, 1 << 18];

/// Sizes between which time is compared, one 64 times the other.
const SHORT_AND_LONG: [usize; 2] = [1 << 14, 1 << 20];

/// A header with these sizes and count, and `fill` behind it up to `length` bytes.
fn header(serialized: u64, deserialized: u64, count: u64, fill: &[u8], length: usize) -> Vec<u8> {
    let mut bytes = vec![0; 32];
    [serialized, deserialized, count].iter().for_each(|number| bytes.extend(number.to_le_bytes()));
    bytes.extend(fill.iter().cycle().take(length.saturating_sub(56)));
    bytes.resize(length, 0);
    bytes
}

/// Inputs of about `size` bytes that lie, or that are as dear as true ones can be.
fn inputs(size: usize) -> Vec<(&'static str, Vec<u8>)> {
    let n = size as u64;
    let blocks = |count: u64| 0xffff_ffff << 32 | count;
    let empty_block = [0; 16];
    let huge_block: Vec<u8> = [0_u64, u64::MAX].iter().flat_map(|n| n.to_le_bytes()).collect();
    let overlapping: Vec<u8> = [0_u64, n / 8 - 10].iter().flat_map(|n| n.to_le_bytes()).collect();
    let whole = (size - 56) / 16;
    let mut ours = header(n, n, 0, &[0], size);
    ours[56..64].copy_from_slice(b"ommobj02");
    ours[64] = 1;
    let mut object = ours.clone();
    object[72..80].copy_from_slice(&(n - 56).to_le_bytes());
    object[80..88].copy_from_slice(&(n - 56).to_le_bytes());
    object[96..104].copy_from_slice(&u64::from(u32::MAX).to_le_bytes());
    let mut bundle = b"ommbundl\x01\0\0\0".to_vec();
    bundle.extend((u64::MAX / 9 * 9).to_le_bytes());
    bundle.resize(size, 0);
    let mut sections = bundle.clone();
    // Micromaps without anything, as many as there is room for.
    let mut at = 20;
    for index in 0_u32.. {
        if at + 9 * 20 + 8 > size {
            break;
        }
        for kind in 1..=9_u32 {
            sections[at..at + 4].copy_from_slice(&kind.to_le_bytes());
            sections[at + 4..at + 8].copy_from_slice(&index.to_le_bytes());
            let length = if kind == 8 { 8 } else { 0 };
            sections[at + 12] = length;
            at += 20 + usize::from(length);
        }
    }
    let lies = [
        ("as many handles as fit", header(n / 8 * 8, 0, (n - 56) / 8, &[7], size / 8 * 8)),
        ("2^32 - 1 blocks, sizes near 2^64", header(u64::MAX, u64::MAX, blocks(0xffff_ffff), &empty_block, size)),
        (
            "as many empty blocks as fit",
            header(56 + 16 * whole as u64, 0, blocks(whole as u64), &empty_block, 56 + 16 * whole),
        ),
        ("a block of 2^64 - 1 addresses", header(u64::MAX, 0, blocks(2), &huge_block, size)),
        ("addresses that overlap the next block", header(n, 0, blocks(2), &overlapping, size)),
        ("2^64 - 1 handles", header(u64::MAX, 0, u64::MAX >> 1, &[1], size)),
        ("our payload, of nothing", ours),
        ("our payload, of 2^32 - 1 triangles", object),
        ("a bundle of 2^64 sections", bundle),
        ("a bundle of empty micromaps", sections),
        ("zeros", vec![0; size]),
        ("ones", vec![0xff; size]),
    ];
    lies.into_iter().chain(truths(size)).collect()
}

/// Inputs of about `size` bytes that are as they should be, with as many of the smallest parts as there is room for.
fn truths(size: usize) -> Vec<(&'static str, Vec<u8>)> {
    let blob = |object: Vec<u8>| serialize_object(&object, Uuid::default(), Uuid::default()).unwrap();
    let level = SubdivisionLevel::ZERO;
    let triangle =
        MicromapTriangleData { subdivision_level: level, format: OpacityMicromapFormat::TwoState, data: &[1] };
    let micromap = MicromapContents { flags: 0, triangles: vec![triangle; size / 24] };
    let geometry = BlasGeometry {
        flags: vk::GeometryFlags::default(),
        primitives: BlasPrimitives::MicromapTriangles { micromap: 1, triangles: Vec::new() },
    };
    let bottom_level = BlasContents { flags: 0, geometries: vec![geometry; size / 40] };
    let instance = |at: usize| vk::Instance { acceleration_structure_reference: at as u64, ..vk::Instance::default() };
    let top_level = TlasContents { flags: 0, instances: (0..size / 72).map(instance).collect() };
    let bundled =
        MicromapTriangle { data_offset: 0, subdivision_level: level, format: OpacityMicromapFormat::TwoState };
    let bundle = MicromapData {
        array: vec![1],
        triangles: vec![bundled; size / 24],
        indices: vec![-1; size / 12],
        sources: vec![Source { name: String::new(), length: 0, sha256: [0; 32] }; size / 144],
        ..MicromapData::default()
    };
    vec![
        ("a micromap of the smallest triangles", blob(micromap.encode().unwrap())),
        ("a bottom-level structure of empty geometries", blob(bottom_level.encode().unwrap())),
        ("a top-level structure of instances", blob(top_level.encode().unwrap())),
        ("a bundle of the smallest triangles, indices and sources", BundleData { micromaps: vec![bundle] }.write()),
    ]
}

/// Reads serialized data in both orders, keeps the header and makes the object of it.
fn read(bytes: &[u8]) {
    for order in [ByteOrder::Little, ByteOrder::Big] {
        let header = Blob::read(bytes, order).map(|blob| blob.header());
        std::hint::black_box(header).ok();
    }
    std::hint::black_box(deserialize_object(bytes)).ok();
}

fn stream(bytes: &[u8]) {
    let mut reader = StreamReader::new(ByteOrder::Little);
    let whole = bytes.chunks(1000).try_for_each(|piece| reader.push(piece).map(drop));
    let addresses = |head: Head<'_>| head.handles().chain(head.micromaps()).fold(0, u64::wrapping_add);
    std::hint::black_box(whole.and_then(|()| reader.finish().map(addresses))).ok();
}

fn relocate(bytes: &[u8]) {
    let mut bytes = bytes.to_vec();
    std::hint::black_box(replace_references(&mut bytes, ByteOrder::Little, u64::swap_bytes)).ok();
}

fn bundle(bytes: &[u8]) {
    for checksums in [Checksums::Skip, Checksums::Verify] {
        std::hint::black_box(Bundle::read(bytes, checksums)).ok();
    }
}

/// Names every byte.
fn describe(bytes: &[u8]) {
    let mut end = 0;
    if let Ok(blob) = Blob::read(bytes, ByteOrder::Little) {
        blob.describe(&mut |field| end += field.size);
    }
    if let Ok(bundle) = Bundle::read(bytes, Checksums::Skip) {
        bundle.describe(&mut |field| end += field.size);
    }
    assert!(end == 0 || end == bytes.len() as u64);
}

/// Everything that reads bytes from outside.
type Reading = (&'static str, fn(&[u8]));
const READINGS: [Reading; 5] =
    [("read", read), ("stream", stream), ("relocate", relocate), ("bundle", bundle), ("describe", describe)];

fn main() {
    memory_is_bounded_and_given_back();
    an_array_out_of_a_bundle_costs_one_copy();
    time_is_linear();
    println!("limits: {} inputs, {} readings, all within bounds", inputs(SIZES[0]).len(), READINGS.len());
}

fn memory_is_bounded_and_given_back() {
    for size in SIZES {
        for (input, bytes) in inputs(size) {
            for (reading, read) in READINGS {
                let profiler = dhat::Profiler::builder().testing().build();
                let before = dhat::HeapStats::get();
                read(&bytes);
                let after = dhat::HeapStats::get();
                drop(profiler);
                let peak = after.max_bytes - before.curr_bytes;
                let limit = 2 * bytes.len() + (1 << 16);
                assert!(peak <= limit, "{reading}, {input}: {peak} bytes for {}, limit {limit}", bytes.len());
                assert_eq!(after.curr_bytes, before.curr_bytes, "{reading}, {input}: everything is given back");
            }
        }
    }
}

/// Reading lends the array; what allocates is the list of micromaps, however large they are.
fn an_array_out_of_a_bundle_costs_one_copy() {
    for size in SIZES {
        let micromap = MicromapData { array: vec![7; size], ..MicromapData::default() };
        let bytes = BundleData { micromaps: vec![micromap] }.write();
        let profiler = dhat::Profiler::builder().testing().build();
        let allocated = || dhat::HeapStats::get().total_bytes;
        let before = allocated();
        let bundle = Bundle::read(&bytes, Checksums::Verify).unwrap();
        let read = allocated() - before;
        let array = bundle.micromaps[0].array.to_vec();
        let copied = allocated() - before - read;
        drop(profiler);
        assert!(read <= 2048 && copied == size as u64 && array.len() == size, "{read} and {copied} bytes for {size}");
    }
}

/// The shortest of some runs.
fn time(read: fn(&[u8]), bytes: &[u8]) -> Duration {
    let run = || {
        let since = Instant::now();
        read(std::hint::black_box(bytes));
        since.elapsed()
    };
    (0..3).map(|_| run()).min().unwrap()
}

/// 64 times the bytes take at most 64 times 8 the time; what is quadratic takes 64 times 64.
///
/// Others use the machine too and make single runs slow, but not all of many: what is linear is seen to be sooner or later.
fn time_is_linear() {
    const TRIES: u32 = 50;
    let [short, long] = SHORT_AND_LONG.map(inputs);
    for ((input, short), (_, long)) in short.into_iter().zip(long) {
        for (reading, read) in READINGS {
            let mut last = (Duration::ZERO, Duration::ZERO);
            let linear = (0..TRIES).any(|_| {
                last = (time(read, &short), time(read, &long));
                last.1 <= 512 * last.0 + Duration::from_millis(5)
            });
            assert!(linear, "{reading}, {input}: {:?} became {:?}, each of {TRIES} times", last.0, last.1);
        }
    }
}
