//! `omm curve`: the bird curve for people, and held against records of a reference.

use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use omm_model::curve::{self, Corner, MicroTriangle};
use omm_model::level::SubdivisionLevel;
use serde::Serialize;

use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::output;
use crate::progress::Progress;

/// Arguments of `omm curve`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct CurveArgs {
    #[command(subcommand)]
    verb: CurveCommand,
}

#[derive(Debug, Subcommand)]
enum CurveCommand {
    /// The index of the microtriangle that holds a point, or a check of many against a file of records.
    Index(IndexArgs),
    /// Every microtriangle of a level in the order of the curve.
    Table(TableArgs),
}

#[derive(Debug, Args)]
#[command(after_help = INDEX_HELP)]
struct IndexArgs {
    /// Little-endian records of 16 bytes to check: f32 u, f32 v, u32 level, u32 expected index.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["level", "u", "v"])]
    records: Option<PathBuf>,
    /// Subdivision level, 0 to 12.
    #[arg(long, value_name = "L", value_parser = level, required_unless_present = "records")]
    level: Option<SubdivisionLevel>,
    /// Weight of vertex 1.
    #[arg(allow_negative_numbers = true, value_parser = finite, required_unless_present = "records")]
    u: Option<f32>,
    /// Weight of vertex 2.
    #[arg(allow_negative_numbers = true, value_parser = finite, required_unless_present = "records")]
    v: Option<f32>,
}

#[derive(Debug, Args)]
#[command(after_help = TABLE_HELP)]
struct TableArgs {
    /// Subdivision level, 0 to 12.
    #[arg(long, value_name = "L", value_parser = level)]
    level: SubdivisionLevel,
}

/// A subdivision level as an argument.
pub(crate) fn level(text: &str) -> Result<SubdivisionLevel, String> {
    let number: u32 = text.parse().map_err(|error| format!("{error}"))?;
    SubdivisionLevel::new(number).map_err(|error| error.to_string())
}

/// A finite number as an argument.
pub(crate) fn finite(text: &str) -> Result<f32, String> {
    let number: f32 = text.parse().map_err(|error| format!("{error}"))?;
    if number.is_finite() { Ok(number) } else { Err(format!("{text} is not a finite number")) }
}

/// Runs `omm curve`.
pub(crate) fn run(args: &CurveArgs, format: Format) -> Result<Outcome, CliError> {
    match &args.verb {
        CurveCommand::Index(IndexArgs { records: Some(path), .. }) => check_records(path, format),
        CurveCommand::Index(IndexArgs { records: None, level, u, v }) => {
            // The parser demands all three when there is no file.
            let (level, u, v) = (level.unwrap_or_default(), u.unwrap_or_default(), v.unwrap_or_default());
            print_point(u, v, level, format)
        }
        CurveCommand::Table(TableArgs { level }) => print_table(*level, format),
    }
}

/// One microtriangle as it is printed.
#[derive(Serialize)]
struct Row {
    index: u32,
    /// Corners (u, v) in units of one segment, in the order of the curve.
    corners: [[u32; 2]; 3],
    orientation: &'static str,
}

impl Row {
    fn new(microtriangle: MicroTriangle) -> Self {
        Self {
            index: microtriangle.index(),
            corners: microtriangle.corners().map(|Corner { u, v }| [u, v]),
            orientation: if microtriangle.is_flipped() { "flipped" } else { "upright" },
        }
    }

    fn text(&self, segments: u32) -> String {
        let corners = self.corners.map(|[u, v]| format!("({u}, {v})/{segments}")).join("  ");
        format!("{corners}  {}", self.orientation)
    }
}

#[derive(Serialize)]
struct Point {
    u: f32,
    v: f32,
    level: SubdivisionLevel,
    segments: u32,
    #[serde(flatten)]
    row: Row,
}

fn print_point(u: f32, v: f32, level: SubdivisionLevel, format: Format) -> Result<Outcome, CliError> {
    let row = Row::new(MicroTriangle::at(u, v, level));
    let segments = level.segments();
    match format {
        Format::Text => output::print(|out| writeln!(out, "{}  {}", row.index, row.text(segments)))?,
        Format::Json => output::print_json(&Point { u, v, level, segments, row })?,
    }
    Ok(Outcome::Clean)
}

fn print_table(level: SubdivisionLevel, format: Format) -> Result<Outcome, CliError> {
    let segments = level.segments();
    let rows = MicroTriangle::all(level).map(Row::new);
    output::print(|out| match format {
        Format::Text => {
            let width = level.microtriangles().to_string().len().max("index".len());
            writeln!(out, "{:>width$}  corners (u, v) in the order of the curve, orientation", "index")?;
            for row in rows {
                writeln!(out, "{:>width$}  {}", row.index, row.text(segments))?;
            }
            Ok(())
        }
        Format::Json => {
            // Row by row: the finest level has sixteen million.
            write!(out, "{{\"level\":{level},\"segments\":{segments},\"microtriangles\":[")?;
            for row in rows {
                out.write_all(if row.index == 0 { b"\n" } else { b",\n" })?;
                serde_json::to_writer(&mut *out, &row)?;
            }
            out.write_all(b"\n]}\n")
        }
    })?;
    Ok(Outcome::Clean)
}

/// A record whose index is not the one computed.
#[derive(Serialize)]
struct Mismatch {
    record: u64,
    offset: u64,
    u: f32,
    v: f32,
    level: u32,
    expected: u32,
    found: u32,
}

#[derive(Serialize)]
struct RecordsReport {
    records: u64,
    mismatches: u64,
    first_mismatches: Vec<Mismatch>,
}

const RECORD: usize = 16;
/// So many mismatches are shown one by one.
const SHOWN: usize = 10;

fn check_records(path: &Path, format: Format) -> Result<Outcome, CliError> {
    let (file, length) = output::open(path)?;
    let total = length / RECORD as u64;
    let progress = Progress::new("records", total);
    let mut reader = BufReader::new(file);
    let mut report = RecordsReport { records: 0, mismatches: 0, first_mismatches: Vec::new() };
    while let Some(bytes) = next_record(&mut reader, path, report.records)? {
        let mismatch = check(bytes, path, report.records)?;
        report.records += 1;
        if let Some(mismatch) = mismatch {
            report.mismatches += 1;
            if report.first_mismatches.len() < SHOWN {
                report.first_mismatches.push(mismatch);
            }
        }
        if report.records.is_multiple_of(1 << 16) {
            progress.set(report.records, total);
        }
    }
    drop(progress);
    match format {
        Format::Text => {
            for Mismatch { record, offset, u, v, level, expected, found } in &report.first_mismatches {
                output::complain(&format!(
                    "record {record} at byte {offset}: ({u}, {v}) at level {level} has index {found}, the record says {expected}"
                ));
            }
            output::print(|out| writeln!(out, "{} records, {} mismatches", report.records, report.mismatches))?;
        }
        Format::Json => output::print_json(&report)?,
    }
    Ok(if report.mismatches == 0 { Outcome::Clean } else { Outcome::Violations })
}

/// The next record's bytes; `None` at the end of the file.
fn next_record(reader: &mut impl Read, path: &Path, record: u64) -> Result<Option<[[u8; 4]; 4]>, CliError> {
    let mut bytes = [0; RECORD];
    let mut found = 0;
    while let Some(rest) = bytes.get_mut(found..).filter(|rest| !rest.is_empty()) {
        match reader.read(rest) {
            Ok(0) if found == 0 => return Ok(None),
            Ok(0) => {
                let offset = record.saturating_mul(RECORD as u64);
                return Err(CliError::TruncatedRecord { path: path.into(), record, offset, found });
            }
            Ok(count) => found += count,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(CliError::read(path)(error)),
        }
    }
    let (fields, _) = bytes.as_chunks::<4>();
    Ok(fields.first_chunk::<4>().copied())
}

fn check([u, v, level, expected]: [[u8; 4]; 4], path: &Path, record: u64) -> Result<Option<Mismatch>, CliError> {
    let offset = record.saturating_mul(RECORD as u64);
    let (u, v) = (f32::from_le_bytes(u), f32::from_le_bytes(v));
    let (level, expected) = (u32::from_le_bytes(level), u32::from_le_bytes(expected));
    let checked = SubdivisionLevel::new(level).map_err(|source| CliError::RecordLevel {
        path: path.into(),
        record,
        offset: offset.saturating_add(8),
        source,
    })?;
    let found = curve::index(u, v, checked);
    Ok((found != expected).then_some(Mismatch { record, offset, u, v, level, expected, found }))
}

const HELP: &str = "\
Examples:
  omm curve index --level 3 0.25 0.6
  omm curve index --records uv_level_index.bin
  omm curve table --level 2

Exit status:
  0  clean
  1  records whose index is not the one computed
  2  could not run";

const INDEX_HELP: &str = "\
Examples:
  omm curve index --level 3 0.25 0.6               the index, the corners and the orientation
  omm curve index --records uv_level_index.bin     prints `N records, M mismatches`

Any f32 is a valid coordinate in a file of records, as in the specification's reference code;
NaN counts as 0.

Exit status:
  0  clean
  1  records whose index is not the one computed
  2  could not run: bad arguments, a truncated file, a level above 12";

const TABLE_HELP: &str = "\
Examples:
  omm curve table --level 2
  omm curve table --level 5 --format json

Exit status:
  0  clean
  2  could not run";
