//! `omm blob`: serialized data as the application must handle it.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use omm_serialize::replace_references;
use omm_serialize::summary::Address;
use serde::Serialize;

use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::inspect;
use crate::output::{self, OutputSet};

/// Arguments of `omm blob`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct BlobArgs {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Replace handles of bottom-level structures and addresses of micromaps; nothing else changes.
    Relocate(RelocateArgs),
}

/// Arguments of `omm blob relocate`.
#[derive(Debug, Args)]
#[command(after_help = RELOCATE_HELP)]
struct RelocateArgs {
    /// Serialized data in either byte order.
    input: PathBuf,
    /// A JSON object from old to new addresses: { "0x1000": "0x2000" }. Addresses that it does not name stay.
    #[arg(long, value_name = "FILE", required_unless_present = "list", requires = "out")]
    map: Option<PathBuf>,
    /// Where the relocated data goes.
    #[arg(short, long, value_name = "OUT", requires = "map")]
    out: Option<PathBuf>,
    /// Print what the data refers to and write nothing.
    #[arg(long, conflicts_with = "map")]
    list: bool,
}

/// What was done.
#[derive(Debug, Serialize)]
struct Report {
    references: usize,
    replaced: usize,
    /// Null references among those kept.
    null: usize,
    /// References that the map does not name, each once.
    not_in_map: Vec<Address>,
    /// Addresses of the map that nothing refers to.
    unused: Vec<Address>,
}

/// Runs `omm blob`.
pub(crate) fn run(args: &BlobArgs, format: Format) -> Result<Outcome, CliError> {
    let Verb::Relocate(args) = &args.verb;
    match (&args.map, &args.out) {
        (Some(map), Some(out)) => relocate(&args.input, map, out, format)?,
        _ => list(&args.input, format)?,
    }
    Ok(Outcome::Clean)
}

fn list(path: &Path, format: Format) -> Result<(), CliError> {
    let bytes = inspect::load(path)?;
    let (blob, _) = inspect::read(path, &bytes)?;
    let mut references = blob.handles().chain(blob.micromaps()).map(Address);
    match format {
        Format::Text => output::print(|out| references.try_for_each(|reference| writeln!(out, "{reference}"))),
        Format::Json => output::print_json(&references.collect::<Vec<_>>()),
    }
}

fn relocate(input: &Path, map: &Path, out: &Path, format: Format) -> Result<(), CliError> {
    let map = read_map(map)?;
    let mut bytes = inspect::load(input)?;
    let (_, order) = inspect::read(input, &bytes)?;
    let file_size = bytes.len() as u64;
    let mut used = BTreeMap::<u64, u64>::new();
    let (mut kept, mut replaced, mut null) = (BTreeMap::<u64, u64>::new(), 0, 0);
    let references = replace_references(&mut bytes, order.order(), |old| match map.get(&old) {
        Some(&new) => {
            *used.entry(old).or_default() += 1;
            replaced += 1;
            new
        }
        None if old == 0 => {
            null += 1;
            old
        }
        None => {
            *kept.entry(old).or_default() += 1;
            old
        }
    });
    let references = references.map_err(|source| CliError::Blob { path: input.into(), file_size, source })?;
    let mut files = OutputSet::of_file(out)?;
    files.add_file(out, |file| file.write_all(&bytes))?;
    files.commit()?;
    let report = Report {
        references,
        replaced,
        null,
        not_in_map: kept.into_keys().map(Address).collect(),
        unused: map.into_keys().filter(|old| !used.contains_key(old)).map(Address).collect(),
    };
    match format {
        Format::Text => output::print(|out| report.print(out)),
        Format::Json => output::print_json(&report),
    }
}

impl Report {
    fn print(&self, out: &mut dyn Write) -> std::io::Result<()> {
        let Self { references, replaced, null, not_in_map, unused } = self;
        writeln!(out, "{replaced} of {references} references replaced, {null} are null")?;
        not_in_map.iter().try_for_each(|address| writeln!(out, "kept, not in the map: {address}"))?;
        unused.iter().try_for_each(|address| writeln!(out, "in the map, but nothing refers to it: {address}"))
    }
}

/// A hexadecimal number with `0x`.
fn address(text: &str) -> Option<u64> {
    let digits = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X"))?;
    u64::from_str_radix(digits, 16).ok().filter(|_| !digits.starts_with('+'))
}

fn read_map(path: &Path) -> Result<BTreeMap<u64, u64>, CliError> {
    let bad = |reason: String| CliError::AddressMap { path: path.into(), reason };
    let bytes = output::read(path)?;
    let map: serde_json::Map<_, _> = serde_json::from_slice(&bytes).map_err(|error| bad(error.to_string()))?;
    let mut addresses = BTreeMap::new();
    for (old, new) in map {
        let hexadecimal = "required hexadecimal digits behind 0x, 64 bits at most";
        let from = address(&old).ok_or_else(|| bad(format!("key \"{old}\": {hexadecimal}")))?;
        let to = new.as_str().and_then(address).ok_or_else(|| bad(format!("\"{old}\": found {new}, {hexadecimal}")))?;
        if addresses.insert(from, to).is_some_and(|before| before != to) {
            return Err(bad(format!("\"{old}\": {from:#x} is there twice with different values")));
        }
    }
    Ok(addresses)
}

const HELP: &str = "\
Examples:
  omm blob relocate tlas.blob --list
  omm blob relocate tlas.blob --map moved.json -o tlas-moved.blob

Exit status:
  0  clean
  2  could not run: bad arguments, bad input, or output that cannot be written";

const RELOCATE_HELP: &str = "\
Blocks of types that are not known, and the payload, are carried as they are.

Examples:
  omm blob relocate tlas.blob --list
  omm blob relocate tlas.blob --map moved.json -o tlas-moved.blob

Exit status:
  0  clean, also if the map does not name every reference
  2  could not run: bad arguments, bad input, or output that cannot be written";
