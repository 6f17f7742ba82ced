//! Serialized data and bundles beside `memcpy`, in turns, on one thread.

#![allow(clippy::print_stdout)]

use clap::Parser;
use omm_bench::arguments::{Common, Format};
use omm_bench::copies::{CopyRow, HANDLES, MICROMAP_SIZE, measure};
use serde_json::json;

/// Compares the writing, reading and relocating of serialized data with a copy of the same bytes.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: Common,
    /// Bytes of a micromap.
    #[arg(long, default_value_t = MICROMAP_SIZE)]
    size: usize,
}

fn main() {
    let Arguments { common: Common { format, rounds }, size } = Arguments::parse();
    let rows = measure(size, HANDLES, rounds);
    if format == Format::Json {
        println!("{}", json!({ "serialized": rows }));
        return;
    }
    println!("{:<40}{:>8}{:>10}{:>10}{:>7}{:>7}", "GB/s", "MB", "ours", "memcpy", "ratio", "goal");
    for CopyRow { name, bytes, ours_gb_per_s, memcpy_gb_per_s, ratio, goal, .. } in rows {
        let (megabytes, goal) = (bytes / 1_000_000, goal.map_or_else(String::new, |goal| format!("{goal:.1}")));
        println!("{name:<40}{megabytes:>8}{ours_gb_per_s:>10.2}{memcpy_gb_per_s:>10.2}{ratio:>7.2}{goal:>7}");
    }
}
