//! `omm run`: executes scenarios and prints what happened.

use std::path::PathBuf;

use clap::Args;
use omm_scenario::{Scenario, record, run as execute};

use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::{output, trace};

/// Arguments of `omm run`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct RunArgs {
    /// Scenario files.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Also write down what the only scenario does: .ron for text, .ommtrace for bytes. See `omm trace`.
    #[arg(long, value_name = "TRACE")]
    trace: Option<PathBuf>,
}

const HELP: &str = "\
The form of a scenario is explained by one: spec-tests/readme.ron.

Examples:
  omm run spec-tests/readme.ron
  omm run --format json spec-tests/build/*.ron
  omm run spec-tests/readme.ron --trace readme.ommtrace

Exit status:
  0  every expectation holds
  1  an expectation does not hold
  2  a scenario cannot be read or run";

/// Runs `omm run`.
pub(crate) fn run(args: &RunArgs, format: Format) -> Result<Outcome, CliError> {
    if let (Some(path), true) = (&args.trace, args.files.len() > 1) {
        return Err(CliError::TraceOfMany { path: path.clone(), scenarios: args.files.len() });
    }
    let mut transcripts = Vec::with_capacity(args.files.len());
    for path in &args.files {
        let bytes = output::read(path)?;
        let text = String::from_utf8(bytes).map_err(|source| CliError::NotText { path: path.clone(), source })?;
        let name = path.display().to_string();
        let scenario = Scenario::parse(&name, &text).map_err(CliError::Scenario)?;
        transcripts.push(match &args.trace {
            Some(path) => {
                let (transcript, recorded) = record(&scenario).map_err(CliError::Scenario)?;
                trace::write(&recorded, path)?;
                transcript
            }
            None => execute(&scenario).map_err(CliError::Scenario)?,
        });
    }
    match format {
        Format::Json => output::print_json(&transcripts)?,
        Format::Text => {
            output::print(|out| transcripts.iter().try_for_each(|transcript| writeln!(out, "{transcript}")))?;
        }
    }
    let passed = transcripts.iter().all(omm_scenario::Transcript::passed);
    Ok(if passed { Outcome::Clean } else { Outcome::Violations })
}
