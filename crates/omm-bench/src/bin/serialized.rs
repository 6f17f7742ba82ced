//! Serialized data and bundles beside `memcpy`, in turns, on one thread.

#![allow(clippy::print_stdout)]

use clap::{Parser, ValueEnum};
use omm_bench::copies::{CopyRow, HANDLES, MICROMAP_SIZE, measure};
use serde_json::json;

/// Compares the writing, reading and relocating of serialized data with a copy of the same bytes.
#[derive(Parser)]
struct Arguments {
    /// How results are printed.
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// How often each is done; the fastest round counts.
    #[arg(long, default_value_t = 5)]
    rounds: u32,
    /// Bytes of a micromap.
    #[arg(long, default_value_t = MICROMAP_SIZE)]
    size: usize,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    Text,
    Json,
}

fn main() {
    let arguments = Arguments::parse();
    let rows = measure(arguments.size, HANDLES, arguments.rounds);
    if arguments.format == Format::Json {
        println!("{}", json!({ "serialized": rows }));
        return;
    }
    println!("{:<40}{:>8}{:>10}{:>10}{:>7}{:>7}", "GB/s", "MB", "ours", "memcpy", "ratio", "goal");
    for CopyRow { name, bytes, ours_gb_per_s, memcpy_gb_per_s, ratio, goal, .. } in rows {
        let (megabytes, goal) = (bytes / 1_000_000, goal.map_or_else(String::new, |goal| format!("{goal:.1}")));
        println!("{name:<40}{megabytes:>8}{ours_gb_per_s:>10.2}{memcpy_gb_per_s:>10.2}{ratio:>7.2}{goal:>7}");
    }
}
