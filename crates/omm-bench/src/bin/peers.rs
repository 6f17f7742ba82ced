//! Bakes the three workloads with this baker and with meshoptimizer, in turns, on one thread.

#![allow(clippy::print_stdout)]

use std::error::Error;

use clap::Parser;
use omm_bench::arguments::{Common, Format};
use omm_bench::peers::{BakeRow, measure};
use omm_bench::workload::Workload;
use serde_json::json;

/// Compares bakers on one thread.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: Common,
}

fn main() -> Result<(), Box<dyn Error>> {
    let Common { format, rounds } = Arguments::parse().common;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build()?;
    let rows: Vec<BakeRow> =
        pool.install(|| Workload::PEERS.iter().map(|workload| measure(workload, rounds)).collect::<Result<_, _>>())?;
    if format == Format::Json {
        println!("{}", json!({ "bake": rows }));
        return Ok(());
    }
    println!(
        "{:<40}{:>10}{:>10}{:>7}{:>9}{:>9}{:>9}{:>9}",
        "Mmicrotriangles/s", "ours", "meshopt", "ratio", "unsound", "theirs", "missed", "theirs"
    );
    for row in rows {
        println!(
            "{:<40}{:>10.1}{:>10.1}{:>7.2}{:>9}{:>9}{:>9}{:>9}",
            row.workload,
            row.ours_mtri_per_s,
            row.meshopt_mtri_per_s,
            row.ratio,
            row.ours_unsound,
            row.meshopt_unsound,
            row.ours_missed,
            row.meshopt_missed
        );
    }
    Ok(())
}
