//! `omm bundle`: baked micromaps in one file.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use omm_serialize::bundle::{Bundle, BundledMicromap, Checksums, MAGIC, START_SIZE};

use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::output;

mod list;
mod pack;
mod unpack;

pub(crate) use list::inspect;
pub(crate) use pack::{settings_and_statistics, source};

/// Arguments of `omm bundle`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct BundleArgs {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Put what `omm bake` wrote into one file.
    Pack(pack::PackArgs),
    /// Take a bundle apart into the files that it was packed from.
    Unpack(unpack::UnpackArgs),
    /// Say what a bundle holds.
    #[command(after_help = READ_HELP)]
    List(FileArgs),
    /// Compare checksums, offsets, indices and histograms.
    #[command(after_help = READ_HELP)]
    Verify(VerifyArgs),
    /// Say in words how two bundles differ.
    #[command(after_help = READ_HELP)]
    Diff(DiffArgs),
}

/// Arguments of `omm bundle list`.
#[derive(Debug, Args)]
struct FileArgs {
    /// A bundle.
    file: PathBuf,
}

/// Arguments of `omm bundle verify`.
#[derive(Debug, Args)]
struct VerifyArgs {
    /// A bundle.
    file: PathBuf,
    /// Also compare the digests of the sources with the files of these names in DIR.
    #[arg(long, value_name = "DIR")]
    sources: Option<PathBuf>,
}

/// Arguments of `omm bundle diff`.
#[derive(Debug, Args)]
struct DiffArgs {
    /// A bundle.
    a: PathBuf,
    /// A bundle to hold against it.
    b: PathBuf,
}

/// Runs `omm bundle`.
pub(crate) fn run(args: &BundleArgs, format: Format) -> Result<Outcome, CliError> {
    match &args.verb {
        Verb::Pack(args) => pack::run(args, format),
        Verb::Unpack(args) => unpack::run(args, format),
        Verb::List(args) => list::run(&args.file, format),
        Verb::Verify(args) => verify(args, format),
        Verb::Diff(args) => diff(&args.a, &args.b, format),
    }
}

/// Whether `path` begins as a bundle of any version does.
pub(crate) fn is_bundle(path: &Path) -> Result<bool, CliError> {
    output::starts_with(path, &MAGIC)
}

/// The bytes of `path`, which begin as a bundle: that was looked at before anything was kept.
fn load(path: &Path) -> Result<Vec<u8>, CliError> {
    let start = output::start(path, START_SIZE)?;
    match Bundle::read(&start, Checksums::Skip) {
        // Of a bundle of any length, the start alone is too short.
        Err(source) if !source.is_truncated() => {
            let (_, file_size) = output::open(path)?;
            Err(CliError::Bundle { path: path.into(), file_size, source })
        }
        _ => output::read(path),
    }
}

fn read<'a>(path: &Path, bytes: &'a [u8]) -> Result<Bundle<'a>, CliError> {
    Bundle::read(bytes, Checksums::Verify).map_err(|source| CliError::Bundle {
        path: path.into(),
        file_size: bytes.len() as u64,
        source,
    })
}

/// Hexadecimal digits of a digest.
fn hex(digest: &[u8; 32]) -> String {
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Prints findings; none is what was hoped for.
fn report(findings: &[String], none: &str, format: Format) -> Result<Outcome, CliError> {
    match format {
        Format::Text if findings.is_empty() => output::print(|out| writeln!(out, "{none}"))?,
        Format::Text => output::print(|out| findings.iter().try_for_each(|finding| writeln!(out, "{finding}")))?,
        Format::Json => output::print_json(&findings)?,
    }
    Ok(if findings.is_empty() { Outcome::Clean } else { Outcome::Violations })
}

fn verify(args: &VerifyArgs, format: Format) -> Result<Outcome, CliError> {
    let none = "everything fits";
    let bytes = match load(&args.file) {
        Err(CliError::Bundle { source, .. }) => return report(&[source.to_string()], none, format),
        bytes => bytes?,
    };
    let mut findings = Vec::new();
    match Bundle::read(&bytes, Checksums::Verify) {
        Err(error) => findings.push(error.to_string()),
        Ok(bundle) => {
            for micromap in &bundle.micromaps {
                if let Err(error) = micromap.check_histograms() {
                    findings.push(format!("{}: {error}", micromap.name));
                }
                let Some(folder) = &args.sources else { continue };
                for source in micromap.sources() {
                    let name = &source.name;
                    let plain: Option<PathBuf> = name.split('/').map(unpack::file_name).collect();
                    let Some(path) = plain else {
                        findings.push(format!("{}: source {name:?} is no path in a folder", micromap.name));
                        continue;
                    };
                    let found = pack::source(&folder.join(path))?;
                    if (found.length, found.sha256) != (source.length, source.sha256) {
                        findings.push(format!("{}: source {name:?} has changed", micromap.name));
                    }
                }
            }
        }
    }
    report(&findings, none, format)
}

pub(crate) fn diff(a: &Path, b: &Path, format: Format) -> Result<Outcome, CliError> {
    let (a_bytes, b_bytes) = (load(a)?, load(b)?);
    let (a, b) = (read(a, &a_bytes)?, read(b, &b_bytes)?);
    let mut others: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for micromap in b.micromaps.iter().rev() {
        others.entry(micromap.name).or_default().push(micromap);
    }
    let mut findings = Vec::new();
    for micromap in &a.micromaps {
        match others.get_mut(micromap.name).and_then(Vec::pop) {
            Some(other) => differences(micromap, other, &mut findings),
            None => findings.push(format!("{}: absent from the second", micromap.name)),
        }
    }
    for (name, rest) in others {
        findings.extend(rest.iter().map(|_| format!("{name}: absent from the first")));
    }
    let order =
        |bundle: &Bundle<'_>| bundle.micromaps.iter().map(|micromap| micromap.name.to_owned()).collect::<Vec<_>>();
    if findings.is_empty() && order(&a) != order(&b) {
        findings.push("the same micromaps in another order".to_owned());
    }
    report(&findings, "no difference", format)
}

fn differences(a: &BundledMicromap<'_>, b: &BundledMicromap<'_>, findings: &mut Vec<String>) {
    let mut push = |text: String| findings.push(format!("{}: {text}", a.name));
    let mut part = |what: &str, one: &[u8], other: &[u8], size: usize| {
        let (count, others) = (one.len() / size, other.len() / size);
        if count != others {
            push(format!("{count} {what} in the first, {others} in the second"));
        } else if one != other {
            let differ = one.chunks(size).zip(other.chunks(size)).filter(|(one, other)| one != other).count();
            push(format!("{differ} of {count} {what} differ"));
        }
    };
    part("bytes of the array", a.array, b.array, 1);
    part("micromap triangles", a.triangle_bytes(), b.triangle_bytes(), 8);
    part("indices", a.index_bytes(), b.index_bytes(), 4);
    if !a.usage_counts().eq(b.usage_counts()) {
        push("the usage counts differ".to_owned());
    }
    if !a.index_usage_counts().eq(b.index_usage_counts()) {
        push("the index usage counts differ".to_owned());
    }
    if a.settings != b.settings {
        push(format!("settings {} in the first, {} in the second", a.settings, b.settings));
    }
    if !a.sources().eq(b.sources()) {
        push("the sources differ".to_owned());
    }
    if a.statistics != b.statistics {
        push("the statistics differ".to_owned());
    }
}

const HELP: &str = "\
Examples:
  omm bake model.glb -o model.omm
  omm bundle pack baked -o model.omm --source model.glb
  omm bundle list model.omm
  omm bundle verify model.omm
  omm bundle unpack model.omm --out again

Exit status:
  0  clean
  1  verify: the bundle contradicts itself; diff: they differ
  2  could not run: bad arguments, bad input, or output that cannot be written";

const READ_HELP: &str = "\
Examples:
  omm bundle list model.omm
  omm bundle verify model.omm --sources .
  omm bundle diff before.omm after.omm

Exit status:
  0  clean
  1  verify: the bundle contradicts itself; diff: they differ
  2  could not run: no such file, or (not for verify) one that does not decode";
