//! `omm bundle unpack`.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::PathBuf;

use clap::Args;

use super::pack::{Sidecar, SidecarSource};
use super::{hex, load, read};
use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::output::{self, OutputSet};

/// Arguments of `omm bundle unpack`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(super) struct UnpackArgs {
    /// A bundle.
    file: PathBuf,
    /// Where the files go; made if absent.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// The name, if it can be that of a file and leads nowhere else.
pub(super) fn file_name(name: &str) -> Option<&str> {
    let plain = !name.is_empty()
        && name != "."
        && name != ".."
        && !name.chars().any(|letter| matches!(letter, '/' | '\\' | ':') || letter.is_control());
    plain.then_some(name)
}

pub(super) fn run(args: &UnpackArgs, format: Format) -> Result<Outcome, CliError> {
    let UnpackArgs { file, out } = args;
    let bytes = load(file)?;
    let bundle = read(file, &bytes)?;
    let mut files = OutputSet::new(out);
    let mut names = BTreeSet::new();
    for micromap in &bundle.micromaps {
        let bad = |reason: String| CliError::Pack { path: file.clone(), reason };
        let name = file_name(micromap.name).ok_or_else(|| bad(format!("{:?} can be no file name", micromap.name)))?;
        if !names.insert(name) {
            return Err(bad(format!("two micromaps are called {name:?}")));
        }
        files.add(format!("{name}.array.bin"), |out| out.write_all(micromap.array))?;
        files.add(format!("{name}.desc.bin"), |out| out.write_all(micromap.triangle_bytes()))?;
        files.add(format!("{name}.index.bin"), |out| out.write_all(micromap.index_bytes()))?;
        let source = |source: omm_serialize::bundle::Source| SidecarSource {
            name: source.name,
            length: source.length,
            sha256: hex(&source.sha256),
        };
        let described = Sidecar {
            settings: micromap.settings.to_owned(),
            statistics: micromap.statistics.to_owned(),
            sources: micromap.sources().map(source).collect(),
        };
        files.add_json(&format!("{name}.bundle.json"), &described)?;
    }
    let written = files.commit()?;
    match format {
        Format::Text => output::print(|to| writeln!(to, "{} files written to {}", written.len(), out.display()))?,
        Format::Json => output::print_json(&serde_json::json!({ "files": written }))?,
    }
    Ok(Outcome::Clean)
}

const HELP: &str = "\
Examples:
  omm bundle unpack model.omm --out baked

Exit status:
  0  clean
  2  could not run: bad arguments, bad input, or output that cannot be written";
