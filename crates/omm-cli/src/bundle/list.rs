//! `omm bundle list`, and what `omm inspect` says of a bundle.

use std::io::Write;
use std::path::Path;

use omm_model::usage::MicromapUsage;
use omm_serialize::bundle::{Bundle, BundledMicromap, Source, VERSION};
use serde::{Serialize, Serializer};
use serde_json::Value;

use super::{hex, load, read};
use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::inspect::dump;
use crate::output;

/// What a list says of a micromap.
#[derive(Serialize)]
struct Row<'a> {
    name: &'a str,
    array_bytes: usize,
    micromap_triangles: usize,
    triangles: usize,
    special: usize,
    histogram: Vec<UsageRow>,
    index_histogram: Vec<UsageRow>,
    settings: Value,
    statistics: Value,
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

impl From<MicromapUsage> for UsageRow {
    fn from(MicromapUsage { count, subdivision_level, format }: MicromapUsage) -> Self {
        Self { level: subdivision_level.get(), format: format.value(), count }
    }
}

impl UsageRow {
    fn print(&self, out: &mut dyn Write) -> std::io::Result<()> {
        let Self { level, format, count } = self;
        writeln!(out, "    {count} of level {level}, {}-state", 2 * format)
    }
}

impl From<Source> for SourceRow {
    fn from(Source { name, length, sha256 }: Source) -> Self {
        Self { name, length, sha256: hex(&sha256) }
    }
}

impl<'a> Row<'a> {
    fn new(micromap: &BundledMicromap<'a>) -> Self {
        // Any text is carried, so one that is no JSON is shown as it is.
        let json = |text: &str| serde_json::from_str(text).unwrap_or_else(|_| Value::String(text.to_owned()));
        Self {
            name: micromap.name,
            array_bytes: micromap.array.len(),
            micromap_triangles: micromap.triangles().len(),
            triangles: micromap.indices().len(),
            special: micromap.indices().filter(|index| *index < 0).count(),
            histogram: micromap.usage_counts().map(UsageRow::from).collect(),
            index_histogram: micromap.index_usage_counts().map(UsageRow::from).collect(),
            settings: json(micromap.settings),
            statistics: json(micromap.statistics),
            sources: micromap.sources().map(SourceRow::from).collect(),
        }
    }

    fn print(&self, out: &mut dyn Write) -> std::io::Result<()> {
        let Self { name, array_bytes, micromap_triangles, triangles, special, .. } = self;
        writeln!(out, "{name}")?;
        writeln!(out, "  {triangles} triangles, {special} of them with a special index")?;
        self.index_histogram.iter().try_for_each(|usage| usage.print(out))?;
        writeln!(out, "  {micromap_triangles} micromap triangles in {array_bytes} bytes")?;
        self.histogram.iter().try_for_each(|usage| usage.print(out))?;
        for SourceRow { name, length, sha256 } in &self.sources {
            writeln!(out, "  from {name}, {length} bytes, SHA-256 {sha256}")?;
        }
        Ok(())
    }
}

pub(super) fn run(path: &Path, format: Format) -> Result<Outcome, CliError> {
    let bytes = load(path)?;
    let bundle = read(path, &bytes)?;
    let rows = Rows(&bundle);
    match format {
        Format::Text => output::print(|out| rows.print(out))?,
        Format::Json => output::print_json(&rows)?,
    }
    Ok(Outcome::Clean)
}

/// What a list says of every micromap, made one by one.
struct Rows<'a>(&'a Bundle<'a>);

impl Rows<'_> {
    fn print(&self, out: &mut dyn Write) -> std::io::Result<()> {
        self.0.micromaps.iter().try_for_each(|micromap| Row::new(micromap).print(out))
    }
}

impl Serialize for Rows<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.micromaps.iter().map(Row::new))
    }
}

/// What `omm inspect` says of a bundle.
#[derive(Serialize)]
struct Report<'a> {
    file: String,
    file_size: usize,
    /// Always `bundle`, where serialized data has what it is guessed to be.
    kind: &'static str,
    version: u32,
    micromaps: Rows<'a>,
    /// All fields.
    #[serde(skip_serializing_if = "Option::is_none")]
    dump: Option<Vec<dump::Row>>,
}

/// Runs `omm inspect` for a bundle.
pub(crate) fn inspect(path: &Path, dump: bool, format: Format) -> Result<Outcome, CliError> {
    let bytes = load(path)?;
    let bundle = read(path, &bytes)?;
    if dump && format == Format::Text {
        return dump::print(&bytes, |visit| bundle.describe(visit));
    }
    let report = Report {
        file: path.display().to_string(),
        file_size: bytes.len(),
        kind: "bundle",
        version: VERSION,
        micromaps: Rows(&bundle),
        dump: dump.then(|| dump::rows(|visit| bundle.describe(visit))),
    };
    match format {
        Format::Text => output::print(|out| {
            let Report { file, file_size, micromaps, .. } = &report;
            let count = bundle.micromaps.len();
            writeln!(out, "{file}, {file_size} bytes: a bundle of version {VERSION}, {count} micromaps")?;
            micromaps.print(out)
        })?,
        Format::Json => output::print_json(&report)?,
    }
    Ok(Outcome::Clean)
}
