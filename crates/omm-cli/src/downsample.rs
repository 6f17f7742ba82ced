//! `omm downsample`: lower levels from micromaps that are baked.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use omm_bake::{BakeOptions, BakeOutput, StateCounts};
use omm_model::triangle::MicromapTriangle;
use serde::Serialize;

use crate::bake::{Promotion, write_data};
use crate::check::Index;
use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::indices;
use crate::output::{self, OutputSet};

/// Arguments of `omm downsample`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct DownsampleArgs {
    /// Results of a bake by the start of their names, such as baked/leaf.
    stem: PathBuf,
    /// By how many levels; no triangle goes below level 0.
    #[arg(long, value_name = "N", default_value_t = 1)]
    levels: u32,
    /// Where results go; made if absent.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Which unknown state a microtriangle gets whose children differ.
    #[arg(long, value_name = "HOW", default_value = "nearest")]
    promotion: Promotion,
    /// Store data for triangles of one state, too.
    #[arg(long)]
    no_special_indices: bool,
    /// How indices are stored, there and here.
    #[arg(long, value_enum, value_name = "TYPE", default_value_t = Index::Uint32)]
    index_type: Index,
}

/// What came of it.
#[derive(Debug, Serialize)]
struct Summary {
    name: String,
    micromap_triangles: u64,
    /// Bytes of the array, before and after.
    array_bytes: [u64; 2],
    /// Microtriangles in the array by state, before and after.
    states: [StateCounts; 2],
    /// Triangles with a special index, by its state.
    special_indices: StateCounts,
}

/// Runs `omm downsample`.
pub(crate) fn run(args: &DownsampleArgs, format: Format) -> Result<Outcome, CliError> {
    let name = args.stem.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let options = BakeOptions {
        promotion: args.promotion.into(),
        special_indices: !args.no_special_indices,
        ..BakeOptions::default()
    };
    let fail = |source| CliError::Bake { input: args.stem.display().to_string(), source };
    let before = omm_bake::downsample(&args.read()?, 0, &options).map_err(fail)?;
    let after = omm_bake::downsample(&before, args.levels, &options).map_err(fail)?;
    let (_, indices) = after.index_buffer(&[args.index_type.ty()]).map_err(fail)?;
    let mut files = OutputSet::new(&args.out);
    write_data(&name, &after, &indices, &mut files)?;
    files.commit()?;
    let both = [&before.statistics, &after.statistics];
    let summary = Summary {
        name,
        micromap_triangles: after.statistics.micromap_triangles,
        array_bytes: both.map(|statistics| statistics.array_bytes),
        states: both.map(|statistics| statistics.array_states),
        special_indices: after.statistics.special_indices,
    };
    match format {
        Format::Text => output::print(|out| print(&summary, &args.out, out))?,
        Format::Json => output::print_json(&summary)?,
    }
    Ok(Outcome::Clean)
}

impl DownsampleArgs {
    /// The three files of data.
    fn read(&self) -> Result<BakeOutput, CliError> {
        let path = |part: &str| {
            let mut name = self.stem.as_os_str().to_owned();
            name.push(part);
            PathBuf::from(name)
        };
        let desc = path(".desc.bin");
        let bytes = output::read(&desc)?;
        let (records, rest) = bytes.as_chunks::<{ omm_layout::triangle::SIZE }>();
        if !rest.is_empty() {
            let unit = omm_layout::triangle::SIZE as u64;
            return Err(CliError::CutShort { path: desc, size: bytes.len() as u64, unit });
        }
        let bad = |reason| CliError::Elements { path: desc.clone(), reason };
        let triangle = |(number, record)| {
            let triangle = MicromapTriangle::try_from(omm_layout::triangle::decode(record));
            triangle.map_err(|error| bad(format!("record {number}: {error}")))
        };
        let triangles = records.iter().enumerate().map(triangle).collect::<Result<_, _>>()?;
        let indices = indices::read(&path(".index.bin"), self.index_type.ty())?;
        Ok(BakeOutput { array: output::read(&path(".array.bin"))?, triangles, indices, ..BakeOutput::default() })
    }
}

fn print(summary: &Summary, folder: &Path, out: &mut dyn Write) -> std::io::Result<()> {
    let [before, after] = summary.array_bytes;
    let [known_before, known_after] = summary.states.map(|states| 100.0 * states.known_fraction());
    writeln!(out, "{}: {before} bytes became {after}", summary.name)?;
    writeln!(out, "known in the array: {known_before:.2}% before, {known_after:.2}% after")?;
    writeln!(out, "written to {}", folder.display())
}

const HELP: &str = "\
Reads STEM.array.bin, STEM.desc.bin and STEM.index.bin, as `omm bake` writes them, and writes files of
the same names. A microtriangle is what its four children have in common, and unknown otherwise, as
if it had been baked at the lower level.

Examples:
  omm downsample baked/leaf --out coarse
  omm downsample baked/leaf --levels 2 --promotion force-opaque --out coarse --format json

Exit status:
  0  clean
  2  could not run: bad arguments, bad input, unwritable output; nothing is left behind";
