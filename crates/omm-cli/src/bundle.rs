//! `omm bundle`: baked micromaps in one file.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use omm_serialize::bundle::{Bundle, BundledMicromap, Checksums, Source};
use serde::Serialize;

use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::output;

mod pack;
mod unpack;

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
        Verb::List(args) => list(&args.file, format),
        Verb::Verify(args) => verify(args, format),
        Verb::Diff(args) => diff(&args.a, &args.b, format),
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

/// What a list says of a micromap.
#[derive(Serialize)]
struct Row<'a> {
    name: &'a str,
    array_bytes: usize,
    micromap_triangles: usize,
    triangles: usize,
    special: usize,
    histogram: Vec<UsageRow>,
    sources: Vec<SourceRow>,
}

#[derive(Serialize)]
struct UsageRow {
    level: u32,
    format: u16,
    count: u32,
}

#[derive(Serialize)]
struct SourceRow {
    name: String,
    length: u64,
    sha256: String,
}

impl From<Source> for SourceRow {
    fn from(Source { name, length, sha256 }: Source) -> Self {
        Self { name, length, sha256: hex(&sha256) }
    }
}

impl<'a> Row<'a> {
    fn new(micromap: &BundledMicromap<'a>) -> Self {
        let histogram = micromap.usage_counts().map(|usage| UsageRow {
            level: usage.subdivision_level.get(),
            format: usage.format.value(),
            count: usage.count,
        });
        Self {
            name: micromap.name,
            array_bytes: micromap.array.len(),
            micromap_triangles: micromap.triangles().len(),
            triangles: micromap.indices().len(),
            special: micromap.indices().filter(|index| *index < 0).count(),
            histogram: histogram.collect(),
            sources: micromap.sources().map(SourceRow::from).collect(),
        }
    }

    fn print(&self, out: &mut dyn Write) -> std::io::Result<()> {
        let Self { name, array_bytes, micromap_triangles, triangles, special, histogram, sources } = self;
        writeln!(out, "{name}")?;
        writeln!(out, "  {triangles} triangles, {special} of them with a special index")?;
        writeln!(out, "  {micromap_triangles} micromap triangles in {array_bytes} bytes")?;
        for UsageRow { level, format, count } in histogram {
            writeln!(out, "    {count} of level {level}, {}-state", 2 * format)?;
        }
        for SourceRow { name, length, sha256 } in sources {
            writeln!(out, "  from {name}, {length} bytes, SHA-256 {sha256}")?;
        }
        Ok(())
    }
}

fn list(path: &Path, format: Format) -> Result<Outcome, CliError> {
    let bytes = output::read(path)?;
    let bundle = read(path, &bytes)?;
    let rows: Vec<_> = bundle.micromaps.iter().map(Row::new).collect();
    match format {
        Format::Text => output::print(|out| rows.iter().try_for_each(|row| row.print(out)))?,
        Format::Json => output::print_json(&rows)?,
    }
    Ok(Outcome::Clean)
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
    let bytes = output::read(&args.file)?;
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
                    let Some(name) = unpack::file_name(&source.name) else {
                        findings.push(format!("{}: source \"{}\" is no file name", micromap.name, source.name));
                        continue;
                    };
                    if pack::source(&folder.join(name))? != source {
                        findings.push(format!("{}: source \"{name}\" has changed", micromap.name));
                    }
                }
            }
        }
    }
    report(&findings, "everything fits", format)
}

fn diff(a: &Path, b: &Path, format: Format) -> Result<Outcome, CliError> {
    let (a_bytes, b_bytes) = (output::read(a)?, output::read(b)?);
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
  omm bake model.glb --out baked
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
