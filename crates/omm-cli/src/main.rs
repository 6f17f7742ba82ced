//! `omm`: opacity micromaps from the command line.
//!
//! One file per verb; each verb is a function from its arguments to an outcome or an [`error`]. Nothing but
//! [`output`] writes to the standard output or to result files.

use std::process::ExitCode;

use clap::Parser;

mod bake;
mod blob;
mod bundle;
mod check;
mod cli;
mod curve;
mod demo;
mod diff;
mod downsample;
mod error;
mod explain;
mod indices;
mod inspect;
mod output;
mod progress;
mod render;
mod rules;
mod run;
mod trace;
mod watch;

use cli::{Cli, Command};
use error::CliError;

fn main() -> ExitCode {
    let Cli { format, command } = Cli::parse();
    let result = match command {
        Command::Demo(args) => demo::run(&args, format),
        Command::Render(args) => render::run(&args, format),
        Command::Bake(args) => bake::run(&args, format),
        Command::Downsample(args) => downsample::run(&args, format),
        Command::Curve(args) => curve::run(&args, format),
        Command::Inspect(args) => inspect::run(&args, format),
        Command::Check(args) => check::run(&args, format),
        Command::Run(args) => run::run(&args, format),
        Command::Rules(args) => rules::run(&args, format),
        Command::Explain(args) => explain::run(&args, format),
        Command::Blob(args) => blob::run(&args, format),
        Command::Diff(args) => diff::run(&args, format),
        Command::Bundle(args) => bundle::run(&args, format),
        Command::Trace(args) => trace::run(&args, format),
    };
    match result {
        Ok(outcome) => outcome.into(),
        Err(error) => {
            output::complain(&format!("error: {error}"));
            CliError::EXIT_CODE.into()
        }
    }
}
