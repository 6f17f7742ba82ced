//! `omm explain`: what a rule is about.

use std::io::Write;

use clap::Args;
use omm_validate::catalog::{RULES, Rule};
use serde::Serialize;

use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::output;

/// Arguments of `omm explain`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct ExplainArgs {
    /// The rule's identifier, or what it ends in: the number is enough.
    #[arg(value_name = "VUID")]
    rule: String,
}

const HELP: &str = "\
Examples:
  omm explain VUID-vkCmdBuildAccelerationStructuresKHR-indexBuffer-11575
  omm explain 11575

Exit status:
  0  explained
  2  there is no such rule";

/// What there is to say about a rule.
#[derive(Serialize)]
struct Explanation {
    vuid: &'static str,
    group: &'static str,
    object: &'static str,
    kind: &'static str,
    status: &'static str,
    reason: Option<&'static str>,
    explanation: &'static str,
    note: &'static str,
    url: String,
}

impl Explanation {
    fn new(rule: &'static Rule) -> Self {
        Self {
            vuid: rule.vuid(),
            group: rule.group.name(),
            object: rule.object(),
            kind: rule.kind.name(),
            status: rule.status.name(),
            reason: rule.status.reason(),
            explanation: rule.explanation,
            note: rule.note,
            url: rule.id.url(),
        }
    }

    fn print(&self, out: &mut dyn Write) -> std::io::Result<()> {
        writeln!(out, "{}", self.vuid)?;
        writeln!(out, "{} rule of {}, {}", self.kind, self.object, self.status)?;
        writeln!(out, "\n{}", self.explanation)?;
        if let Some(reason) = self.reason {
            writeln!(out, "\nNot checked: {reason}")?;
        }
        if !self.note.is_empty() {
            writeln!(out, "\nNote: {}", self.note)?;
        }
        writeln!(out, "\n{}", self.url)
    }
}

/// The rules whose identifier is, or ends in, what was asked for: a number may stand in the identifiers of several commands.
pub(crate) fn find(wanted: &str) -> Result<Vec<&'static Rule>, CliError> {
    let is_wanted = |rule: &&'static Rule| rule.vuid() == wanted || rule.vuid().rsplit('-').next() == Some(wanted);
    let found: Vec<_> = RULES.iter().filter(is_wanted).collect();
    if found.is_empty() {
        return Err(CliError::UnknownRule { wanted: wanted.to_owned() });
    }
    Ok(found)
}

/// Runs `omm explain`.
pub(crate) fn run(args: &ExplainArgs, format: Format) -> Result<Outcome, CliError> {
    let found: Vec<_> = find(args.rule.trim())?.into_iter().map(Explanation::new).collect();
    match format {
        Format::Json => output::print_json(&found)?,
        Format::Text => output::print(|out| {
            for (position, explanation) in found.iter().enumerate() {
                if position > 0 {
                    writeln!(out)?;
                }
                explanation.print(out)?;
            }
            Ok(())
        })?,
    }
    Ok(Outcome::Clean)
}
