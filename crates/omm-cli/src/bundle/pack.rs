//! `omm bundle pack`.

use std::fs;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use omm_model::triangle::MicromapTriangle;
use omm_model::usage::histogram;
use omm_serialize::bundle::{Bundle, BundleData, Checksums, MicromapData, Source};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::output::{self, OutputSet};

/// Arguments of `omm bundle pack`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(super) struct PackArgs {
    /// The folder that `omm bake` or `omm bundle unpack` wrote.
    folder: PathBuf,
    /// Where the bundle goes.
    #[arg(short, long, value_name = "FILE.omm")]
    out: PathBuf,
    /// A file that was baked from, whose digest goes into the bundle; may be repeated.
    #[arg(long, value_name = "FILE")]
    source: Vec<PathBuf>,
}

/// What a bundle says of a micromap besides its data: `NAME.bundle.json`, which `unpack` writes.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Sidecar {
    pub(super) settings: String,
    pub(super) statistics: String,
    pub(super) sources: Vec<SidecarSource>,
}

/// A source with its digest in hexadecimal.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SidecarSource {
    pub(super) name: String,
    pub(super) length: u64,
    pub(super) sha256: String,
}

/// Name, length and digest of a file.
pub(crate) fn source(path: &Path) -> Result<Source, CliError> {
    let (mut file, _) = output::open(path)?;
    let (mut hasher, mut buffer, mut length) = (Sha256::new(), vec![0; 1 << 16], 0);
    loop {
        let size = file.read(&mut buffer).map_err(CliError::read(path))?;
        if size == 0 {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            return Ok(Source { name, length, sha256: hasher.finalize().into() });
        }
        hasher.update(buffer.get(..size).unwrap_or_default());
        length += size as u64;
    }
}

pub(super) fn run(args: &PackArgs, format: Format) -> Result<Outcome, CliError> {
    let PackArgs { folder, out, source: files } = args;
    let sources = files.iter().map(|path| source(path)).collect::<Result<Vec<_>, _>>()?;
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).map_err(CliError::read(folder))? {
        let name = entry.map_err(CliError::read(folder))?.file_name();
        names.extend(name.to_string_lossy().strip_suffix(".array.bin").map(str::to_owned));
    }
    names.sort();
    let bad = |reason: String| CliError::Pack { path: folder.clone(), reason };
    if names.is_empty() {
        return Err(bad("there is no NAME.array.bin".to_owned()));
    }
    let micromaps = names.into_iter().map(|name| micromap(folder, name, &sources)).collect::<Result<_, _>>()?;
    let bytes = BundleData { micromaps }.write();
    // What cannot be read is not written.
    let bundle = Bundle::read(&bytes, Checksums::Skip).map_err(|error| bad(error.to_string()))?;
    let mut set = OutputSet::of_file(out)?;
    set.add_file(out, |file| file.write_all(&bytes))?;
    set.commit()?;
    match format {
        Format::Text => output::print(|to| {
            writeln!(to, "{} micromaps, {} bytes, written to {}", bundle.micromaps.len(), bytes.len(), out.display())
        })?,
        Format::Json => output::print_json(&serde_json::json!({
            "micromaps": bundle.micromaps.len(),
            "bytes": bytes.len(),
        }))?,
    }
    Ok(Outcome::Clean)
}

fn micromap(folder: &Path, name: String, sources: &[Source]) -> Result<MicromapData, CliError> {
    let path = |end: &str| folder.join(format!("{name}.{end}"));
    let bad = |path: &Path, reason: String| CliError::Pack { path: path.into(), reason };
    let array = output::read(&path("array.bin"))?;

    let desc = path("desc.bin");
    let bytes = output::read(&desc)?;
    let (records, rest) = bytes.as_chunks::<8>();
    if !rest.is_empty() {
        return Err(bad(&desc, format!("{} bytes are no whole number of records of 8", bytes.len())));
    }
    let mut triangles = Vec::with_capacity(records.len());
    for (index, record) in records.iter().enumerate() {
        let triangle = MicromapTriangle::try_from(omm_layout::triangle::decode(record));
        triangles.push(triangle.map_err(|error| bad(&desc, format!("record {index}: {error}")))?);
    }

    let index = path("index.bin");
    let bytes = output::read(&index)?;
    let (records, rest) = bytes.as_chunks::<4>();
    if !rest.is_empty() {
        return Err(bad(&index, format!("{} bytes are no whole number of indices of 4", bytes.len())));
    }
    let indices: Vec<_> = records.iter().map(|record| i32::from_le_bytes(*record)).collect();
    let used = indices.iter().filter_map(|&index| triangles.get(usize::try_from(index).ok()?).copied());

    let mut described = describe(&path("bundle.json"), &path("stats.json"))?;
    if !sources.is_empty() {
        described.2 = sources.to_vec();
    }
    let (settings, statistics, sources) = described;
    Ok(MicromapData {
        usage_counts: histogram(triangles.iter().copied()),
        index_usage_counts: histogram(used),
        name,
        array,
        triangles,
        indices,
        settings,
        sources,
        statistics,
    })
}

/// Settings, statistics and sources: from an unpacked bundle, or from the statistics of a bake, or nothing.
fn describe(sidecar: &Path, stats: &Path) -> Result<(String, String, Vec<Source>), CliError> {
    let bad = |path: &Path, reason: String| CliError::Pack { path: path.into(), reason };
    if sidecar.exists() {
        let described: Sidecar =
            serde_json::from_slice(&output::read(sidecar)?).map_err(|error| bad(sidecar, error.to_string()))?;
        let Sidecar { settings, statistics, sources } = described;
        let decode =
            |SidecarSource { name, length, sha256 }| digest(&sha256).map(|sha256| Source { name, length, sha256 });
        let sources: Option<Vec<_>> = sources.into_iter().map(decode).collect();
        let sources = sources.ok_or_else(|| bad(sidecar, "a sha256 is not 64 hexadecimal digits".to_owned()))?;
        return Ok((settings, statistics, sources));
    }
    if !stats.exists() {
        return Ok(("{}".to_owned(), "{}".to_owned(), Vec::new()));
    }
    let text = output::read(stats)?;
    let value = serde_json::from_slice(&text).map_err(|error| bad(stats, error.to_string()))?;
    let (settings, statistics) = settings_and_statistics(value);
    Ok((settings, statistics, Vec::new()))
}

/// The two texts of a bundle that the statistics of a bake become.
pub(crate) fn settings_and_statistics(mut statistics: Value) -> (String, String) {
    let mut settings = Value::Object(serde_json::Map::new());
    if let Some(map) = statistics.as_object_mut() {
        settings = map.shift_remove("options").unwrap_or(settings);
        // The time that it took differs from run to run, and a bundle of the same input is the same.
        map.shift_remove("seconds");
    }
    (settings.to_string(), statistics.to_string())
}

/// The digest of 64 hexadecimal digits.
fn digest(text: &str) -> Option<[u8; 32]> {
    let mut digest = [0; 32];
    let (pairs, rest) = text.as_bytes().as_chunks::<2>();
    if pairs.len() != digest.len() || !rest.is_empty() {
        return None;
    }
    for (byte, pair) in digest.iter_mut().zip(pairs) {
        if !pair.iter().all(u8::is_ascii_hexdigit) {
            return None;
        }
        *byte = u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok()?;
    }
    Some(digest)
}

const HELP: &str = "\
Reads NAME.array.bin, NAME.desc.bin and NAME.index.bin, and NAME.stats.json or NAME.bundle.json
where there is one. The same files give the same bundle.

Examples:
  omm bundle pack baked -o model.omm --source model.glb

Exit status:
  0  clean
  2  could not run: bad arguments, bad input, or output that cannot be written";
