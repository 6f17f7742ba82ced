//! What reading costs: at most 2n + 64 KiB of memory for n bytes of any content, and time linear in n.
//!
//! A program of its own (`harness = false`): the test harness has a second thread, whose allocations would be counted too.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

use std::time::{Duration, Instant};

use omm_serialize::bundle::{Bundle, Checksums};
use omm_serialize::{Blob, ByteOrder, StreamReader, deserialize_object};

#[global_allocator]
static ALLOCATOR: dhat::Alloc = dhat::Alloc;

const SIZES: [usize; 3] = [1 << 12, 1 << 16, 1 << 20];

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
    vec![
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
    ]
}

/// Everything that reads bytes from outside, and keeps what it read.
fn read(bytes: &[u8]) -> usize {
    let mut results = 0;
    for order in [ByteOrder::Little, ByteOrder::Big] {
        results += usize::from(Blob::read(bytes, order).is_ok_and(|blob| {
            let header = blob.header();
            header.size() > 0
        }));
    }
    results + usize::from(deserialize_object(bytes).is_ok())
}

fn stream(bytes: &[u8]) -> usize {
    let mut reader = StreamReader::new(ByteOrder::Little);
    let whole = bytes.chunks(1000).all(|piece| reader.push(piece).is_ok());
    usize::from(whole && reader.finish().is_ok())
}

fn bundle(bytes: &[u8]) -> usize {
    usize::from(Bundle::read(bytes, Checksums::Skip).is_ok())
}

type Reading = (&'static str, fn(&[u8]) -> usize);
const READINGS: [Reading; 3] = [("read", read), ("stream", stream), ("bundle", bundle)];

/// The shortest of some runs, as others use the machine too.
fn time(read: fn(&[u8]) -> usize, bytes: &[u8]) -> Duration {
    let run = || {
        let since = Instant::now();
        std::hint::black_box(read(std::hint::black_box(bytes)));
        since.elapsed()
    };
    (0..5).map(|_| run()).min().unwrap()
}

fn main() {
    memory_is_bounded_and_given_back();
    time_is_linear();
    println!("limits: {} sizes, {} readings, all within bounds", SIZES.len(), READINGS.len());
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

fn time_is_linear() {
    // 16 times the bytes take less than 16 times 8 the time: what is quadratic takes 256 times.
    let [_, small, large] = SIZES;
    for ((input, short), (_, long)) in inputs(small).into_iter().zip(inputs(large)) {
        for (reading, read) in READINGS {
            let (short, long) = (time(read, &short), time(read, &long));
            let limit = 128 * short + Duration::from_millis(20);
            assert!(long <= limit, "{reading}, {input}: {short:?} became {long:?}");
        }
    }
}
