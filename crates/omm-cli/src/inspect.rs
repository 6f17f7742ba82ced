//! `omm inspect`: what a serialized acceleration structure says, in short or byte by byte.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use omm_serialize::summary::Summary;
use omm_serialize::{Blob, DetectedOrder};
use serde::Serialize;

use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::output;

mod contents;
mod dump;

use contents::Contents;

/// Arguments of `omm inspect`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct InspectArgs {
    /// What vkCmdCopyAccelerationStructureToMemoryKHR or vkCmdCopyMicromapToMemoryEXT wrote, from the first byte to the last.
    file: PathBuf,
    /// Print every byte with its name.
    #[arg(long)]
    dump: bool,
}

/// A summary and where it comes from.
#[derive(Serialize)]
struct Report {
    file: String,
    file_size: u64,
    /// Whether only one byte order fits the sizes.
    byte_order_certain: bool,
    #[serde(flatten)]
    summary: Summary,
    /// What the payload holds, if it is ours.
    contents: Option<Contents>,
    /// How the writer departs from the specification.
    departure: Option<String>,
    /// All fields.
    #[serde(skip_serializing_if = "Option::is_none")]
    dump: Option<Vec<dump::Row>>,
}

/// Reads `path` as serialized data in the order that it seems to be in.
pub(crate) fn read<'a>(path: &Path, bytes: &'a [u8]) -> Result<(Blob<'a>, DetectedOrder), CliError> {
    Blob::read_detected(bytes).map_err(|source| CliError::Blob {
        path: path.into(),
        file_size: bytes.len() as u64,
        source,
    })
}

/// Runs `omm inspect`.
pub(crate) fn run(args: &InspectArgs, format: Format) -> Result<Outcome, CliError> {
    let path = &args.file;
    let bytes = output::read(path)?;
    let (blob, order) = read(path, &bytes)?;
    let report = Report {
        file: path.display().to_string(),
        file_size: bytes.len() as u64,
        byte_order_certain: matches!(order, DetectedOrder::Certain(_)),
        summary: blob.summary(),
        contents: Contents::new(&blob),
        departure: blob.departure().map(|departure| departure.explanation().to_owned()),
        dump: (args.dump && format == Format::Json).then(|| dump::rows(&blob)),
    };
    let mut whole = true;
    match format {
        Format::Text if args.dump => output::print(|out| {
            whole = dump::print(&bytes, &blob, out)?;
            Ok(())
        })?,
        Format::Text => output::print(|out| report.print(out))?,
        Format::Json => output::print_json(&report)?,
    }
    Ok(if whole { Outcome::Clean } else { Outcome::Violations })
}

impl Report {
    fn print(&self, out: &mut dyn Write) -> std::io::Result<()> {
        let Self { file, file_size, byte_order_certain, summary, contents, departure, dump: _ } = self;
        let Summary {
            driver_uuid,
            compatibility_uuid,
            byte_order,
            serialized_size,
            deserialized_size,
            handle_count,
            handles,
            blocks,
            header_size,
            kind,
        } = summary;
        let mut line = |name: &str, value: String| writeln!(out, "{name:<19} {value}");
        let guess = if *byte_order_certain { "" } else { " (assumed)" };
        line("file", format!("{file}, {file_size} bytes"))?;
        line("kind", format!("{} ({:?}: {})", kind.name(), kind.certainty, kind.why).to_lowercase())?;
        line("driver UUID", driver_uuid.clone())?;
        line("compatibility UUID", compatibility_uuid.clone())?;
        line("byte order", format!("{byte_order:?}{guess}").to_lowercase())?;
        line("serialized size", format!("{serialized_size} bytes, {header_size} of them header"))?;
        line("deserialized size", format!("{deserialized_size} bytes"))?;
        line("handles", handle_count.to_string())?;
        for handle in handles {
            line("", handle.clone())?;
        }
        line("blocks", blocks.len().to_string())?;
        for block in blocks {
            line("", format!("type {}, {} addresses", block.block_type, block.addresses.len()))?;
            for address in &block.addresses {
                line("", format!("  {address}"))?;
            }
        }
        if let Some(departure) = departure {
            line("departure", departure.clone())?;
        }
        contents.as_ref().map_or(Ok(()), |contents| contents.print(out))
    }
}

const HELP: &str = "\
Examples:
  omm inspect blas.blob
  omm inspect --dump blas.blob
  omm inspect --format json tlas.blob

Exit status:
  0  clean
  2  could not run: no such file, or it is truncated, oversized or contradicts itself";
