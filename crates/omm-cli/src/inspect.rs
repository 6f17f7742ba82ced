//! `omm inspect`: what serialized data or a bundle says, in short or byte by byte.

use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use omm_serialize::blob::BlockView;
use omm_serialize::header::BLOCK_TYPE_OPACITY_MICROMAP;
use omm_serialize::summary::{Address, Summary};
use omm_serialize::{Blob, Departure, DetectedOrder, ReadError, StreamError, StreamReader, byte_order};
use serde::Serialize;

use crate::bundle;
use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::output;

mod contents;
pub(crate) mod dump;

use contents::Contents;

/// Arguments of `omm inspect`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct InspectArgs {
    /// What vkCmdCopyAccelerationStructureToMemoryKHR or vkCmdCopyMicromapToMemoryEXT wrote, from the first byte to the last;
    /// or a bundle.
    file: PathBuf,
    /// Print every byte with its name.
    #[arg(long)]
    dump: bool,
}

/// A summary and where it comes from.
#[derive(Serialize)]
struct Report<'a> {
    file: String,
    file_size: u64,
    /// Whether only one byte order fits the sizes.
    byte_order_certain: bool,
    #[serde(flatten)]
    summary: Summary<'a>,
    /// What the payload holds, if it is ours.
    contents: Option<Contents>,
    /// How the writer departs from the specification.
    departure: Option<&'static str>,
    /// The text in the place of the driver's UUID, if that is how it departs.
    version_text: Option<String>,
    /// All fields.
    #[serde(skip_serializing_if = "Option::is_none")]
    dump: Option<Vec<dump::Row>>,
}

/// The bytes of `path`, which are serialized data: its header and size were looked at before anything was kept.
pub(crate) fn load(path: &Path) -> Result<Vec<u8>, CliError> {
    let (file, file_size) = output::open(path)?;
    let bad = |source: ReadError| CliError::Blob { path: path.into(), file_size, source };
    let start = output::start(path, SIZES_END)?;
    let order = byte_order::detect_with_length(&start, file_size).map_err(bad)?.order();
    match StreamReader::new(order).read_from(file.take(file_size), |_| Ok(())) {
        Ok(_) => output::read(path),
        Err(StreamError::Read(error)) => Err(bad(error)),
        Err(StreamError::Io { source, .. }) => Err(CliError::read(path)(source)),
    }
}

/// Where the two size fields of serialized data end.
const SIZES_END: usize = 48;

/// The data that [`load`] found in `path`, in the order that it seems to be in.
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
    if bundle::is_bundle(path)? {
        return bundle::inspect(path, args.dump, format);
    }
    let bytes = load(path)?;
    let (blob, order) = read(path, &bytes)?;
    if args.dump && format == Format::Text {
        return dump::print(&bytes, |visit| blob.describe(visit));
    }
    let report = Report {
        file: path.display().to_string(),
        file_size: bytes.len() as u64,
        byte_order_certain: matches!(order, DetectedOrder::Certain(_)),
        summary: blob.summary(),
        contents: Contents::new(&blob),
        departure: blob.departure().map(Departure::explanation),
        version_text: blob.version_text(),
        dump: args.dump.then(|| dump::rows(|visit| blob.describe(visit))),
    };
    match format {
        Format::Text => output::print(|out| report.print(&blob, out))?,
        Format::Json => output::print_json(&report)?,
    }
    Ok(Outcome::Clean)
}

impl Report<'_> {
    fn print(&self, blob: &Blob<'_>, out: &mut dyn Write) -> std::io::Result<()> {
        let Self { file, file_size, byte_order_certain, summary: _, contents, departure, version_text, dump: _ } = self;
        let (prefix, kind) = (blob.prefix(), blob.kind());
        let mut line = |name: &str, value: String| writeln!(out, "{name:<19} {value}");
        let guess = if *byte_order_certain { "" } else { " (assumed: both orders give the same size)" };
        line("file", format!("{file}, {file_size} bytes"))?;
        line("kind", format!("{} ({:?}: {})", kind.name(), kind.certainty, kind.why).to_lowercase())?;
        line("driver UUID", prefix.driver_uuid.to_string())?;
        line("compatibility UUID", prefix.compatibility_uuid.to_string())?;
        line("byte order", format!("{}{guess}", blob.order()))?;
        line("serialized size", format!("{} bytes, {} of them header", prefix.serialized_size, blob.header_size()))?;
        line("deserialized size", format!("{} bytes", prefix.deserialized_size))?;
        line("handles", blob.handles().len().to_string())?;
        blob.handles().try_for_each(|handle| line("", Address(handle).to_string()))?;
        line("blocks", blob.blocks().count().to_string())?;
        for block in blob.blocks() {
            line("", format!("{}, {} addresses", block_type(&block), block.addresses().len()))?;
            block.addresses().try_for_each(|address| line("", format!("  {}", Address(address))))?;
        }
        if let Some(departure) = departure {
            line("departure", (*departure).to_owned())?;
        }
        if let Some(text) = version_text {
            line("driver version", text.clone())?;
        }
        contents.as_ref().map_or(Ok(()), |contents| contents.print(out))
    }
}

fn block_type(block: &BlockView<'_>) -> String {
    match block.block_type {
        BLOCK_TYPE_OPACITY_MICROMAP => format!("type {BLOCK_TYPE_OPACITY_MICROMAP} (opacity micromaps)"),
        other => format!("type {other} (unknown, kept as it is)"),
    }
}

const HELP: &str = "\
Examples:
  omm inspect blas.blob
  omm inspect --dump blas.blob
  omm inspect --format json tlas.blob
  omm inspect model.omm

Exit status:
  0  clean
  2  could not run: no such file, or it is truncated, oversized or contradicts itself";
