//! `omm trace`: what an application did, kept in a file.

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use omm_scenario::{Keep, minimize, replay};
use omm_serialize::bundle::Checksums;
use omm_serialize::trace::{MAGIC, Trace};
use omm_validate::catalog::Rule;
use serde::Serialize;

use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::{explain, output};

/// Arguments of `omm trace`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct TraceArgs {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Write a trace in the other form: .ron is text, .ommtrace is bytes.
    #[command(after_help = CONVERT_HELP)]
    Convert(ConvertArgs),
    /// Run a trace through validator and simulated device.
    #[command(after_help = RUN_HELP)]
    Run(RunArgs),
    /// Make a trace smaller until every part of it is needed for a report.
    #[command(after_help = MINIMIZE_HELP)]
    Minimize(MinimizeArgs),
}

#[derive(Debug, Args)]
struct ConvertArgs {
    /// A trace in either form.
    file: PathBuf,
    /// The file to write; its extension says which form.
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
}

#[derive(Debug, Args)]
struct RunArgs {
    /// A trace in either form.
    file: PathBuf,
}

#[derive(Debug, Args)]
struct MinimizeArgs {
    /// A trace in either form.
    file: PathBuf,
    /// The file to write; its extension says which form.
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// What to keep: a rule that is reported, by its identifier or the end of it, or `undefined` for the device's stop. Otherwise
    /// the first report is kept, or the stop where there is none.
    #[arg(long, value_name = "VUID")]
    keep: Option<String>,
}

const HELP: &str = "\
Examples:
  omm run spec-tests/readme.ron --trace readme.ommtrace
  omm trace convert readme.ommtrace -o readme.ron
  omm trace run readme.ommtrace
  omm trace minimize readme.ommtrace -o small.ron --keep 11575

Exit status:
  0  clean
  1  run: a rule is broken, or the device stopped
  2  a trace cannot be read, minimized or written";

const CONVERT_HELP: &str = "\
Examples:
  omm trace convert readme.ommtrace -o readme.ron

Exit status:
  0  written
  2  the trace cannot be read or written";

const RUN_HELP: &str = "\
Examples:
  omm trace run readme.ommtrace
  omm trace run --format json readme.ron

Exit status:
  0  nothing was reported, and the device came to the end
  1  a rule is broken, or the device stopped
  2  the trace cannot be read";

const MINIMIZE_HELP: &str = "\
Examples:
  omm trace minimize readme.ommtrace -o small.ron
  omm trace minimize readme.ommtrace -o small.ommtrace --keep undefined

Exit status:
  0  written
  2  the trace cannot be read or written, or does not do what is to be kept";

/// Runs `omm trace`.
pub(crate) fn run(args: &TraceArgs, format: Format) -> Result<Outcome, CliError> {
    match &args.verb {
        Verb::Convert(args) => convert(args, format),
        Verb::Run(args) => run_trace(args, format),
        Verb::Minimize(args) => minimize_trace(args, format),
    }
}

fn read(path: &Path) -> Result<Trace, CliError> {
    let bytes = output::read(path)?;
    if bytes.starts_with(&MAGIC) {
        let file_size = bytes.len() as u64;
        return Trace::read(&bytes, Checksums::Verify).map_err(|source| CliError::Trace {
            path: path.into(),
            file_size,
            source,
        });
    }
    let text = String::from_utf8(bytes).map_err(|source| CliError::NotText { path: path.into(), source })?;
    Trace::from_text(&text).map_err(|source| CliError::TraceText { path: path.into(), source })
}

/// The bytes of a trace in the form that a file's extension asks for.
fn encode(trace: &Trace, path: &Path) -> Result<Vec<u8>, CliError> {
    match path.extension().and_then(std::ffi::OsStr::to_str) {
        Some("ommtrace") => Ok(trace.write()),
        Some("ron") => {
            let text = trace.to_text();
            text.map(String::into_bytes).map_err(|source| CliError::TraceText { path: path.into(), source })
        }
        _ => Err(CliError::TraceExtension { path: path.into() }),
    }
}

/// Writes a trace in the form that the file's extension asks for; how many bytes.
pub(crate) fn write(trace: &Trace, path: &Path) -> Result<usize, CliError> {
    let bytes = encode(trace, path)?;
    let mut files = output::OutputSet::of_file(path)?;
    files.add_file(path, |out| std::io::Write::write_all(out, &bytes))?;
    files.commit()?;
    Ok(bytes.len())
}

/// What was written.
#[derive(Serialize)]
struct Written<'a> {
    file: &'a Path,
    bytes: usize,
    events: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    events_before: Option<usize>,
}

impl Written<'_> {
    fn print(&self, format: Format) -> Result<Outcome, CliError> {
        let Self { file, bytes, events, events_before } = self;
        match format {
            Format::Json => output::print_json(self)?,
            Format::Text => {
                let before = events_before.map(|before| format!(" of {before}")).unwrap_or_default();
                output::print(|out| writeln!(out, "{}: {events}{before} events, {bytes} bytes", file.display()))?;
            }
        }
        Ok(Outcome::Clean)
    }
}

fn convert(args: &ConvertArgs, format: Format) -> Result<Outcome, CliError> {
    let trace = read(&args.file)?;
    let bytes = write(&trace, &args.out)?;
    Written { file: &args.out, bytes, events: trace.events.len(), events_before: None }.print(format)
}

fn run_trace(args: &RunArgs, format: Format) -> Result<Outcome, CliError> {
    let replay = replay(&read(&args.file)?);
    match format {
        Format::Json => output::print_json(&replay)?,
        Format::Text => output::print(|out| write!(out, "{replay}"))?,
    }
    Ok(if replay.is_clean() { Outcome::Clean } else { Outcome::Violations })
}

/// The first of some rules that a trace breaks, otherwise the first of them.
fn rule_of(trace: &Trace, rules: &[&'static Rule]) -> Option<Keep> {
    let replay = replay(trace);
    let broken = rules.iter().find(|rule| replay.reported().contains(&rule.id));
    broken.or(rules.first()).map(|rule| Keep::Rule(rule.id))
}

fn minimize_trace(args: &MinimizeArgs, format: Format) -> Result<Outcome, CliError> {
    let trace = read(&args.file)?;
    let keep = match args.keep.as_deref() {
        Some("undefined") => Some(Keep::Undefined),
        Some(wanted) => rule_of(&trace, &explain::find(wanted)?),
        None => None,
    };
    // What cannot be written is better told before the work than after it.
    encode(&Trace { profile: trace.profile.clone(), events: Vec::new() }, &args.out)?;
    let mut events = trace.events.len();
    let small = minimize(&trace, keep, &mut |now| {
        // A line for every halving, so that a long search is seen to go on and a short one says little.
        if now.events <= events / 2 {
            events = now.events;
            output::complain(&format!("{events} events, {} bytes after {} runs", now.bytes, now.runs));
        }
    });
    let small = small.map_err(|source| CliError::Minimize { path: args.file.clone(), source })?;
    let bytes = write(&small, &args.out)?;
    let events_before = Some(trace.events.len());
    Written { file: &args.out, bytes, events: small.events.len(), events_before }.print(format)
}
