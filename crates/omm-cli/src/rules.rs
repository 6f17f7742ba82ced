//! `omm rules`: the ledger of rules.

use std::io::Write;

use clap::Args;
use omm_validate::catalog::{RULES, Rule};
use serde::Serialize;

use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::output;

/// Arguments of `omm rules`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct RulesArgs {
    /// Only rules of this group, such as khr_opacity_micromap.
    #[arg(long)]
    group: Option<String>,
    /// Only rules on this structure or command, such as VkMicromapBuildInfoEXT; part of the name is enough.
    #[arg(long)]
    object: Option<String>,
    /// Only rules of this status: checked or structural.
    #[arg(long)]
    status: Option<String>,
}

const HELP: &str = "\
Examples:
  omm rules
  omm rules --group khr_opacity_micromap
  omm rules --object MicromapBuildInfo --format json

Exit status:
  0  printed
  2  could not run";

/// All rules that were asked for.
#[derive(Serialize)]
struct List {
    rules: Vec<Row>,
}

/// One rule.
#[derive(Serialize)]
struct Row {
    vuid: &'static str,
    group: &'static str,
    object: &'static str,
    kind: &'static str,
    status: &'static str,
    /// Why a structural rule cannot be written down as a call.
    reason: Option<&'static str>,
}

impl Row {
    fn new(rule: &'static Rule) -> Self {
        Self {
            vuid: rule.vuid(),
            group: rule.group.name(),
            object: rule.object(),
            kind: rule.kind.name(),
            status: rule.status.name(),
            reason: rule.status.reason(),
        }
    }
}

/// Runs `omm rules`.
pub(crate) fn run(args: &RulesArgs, format: Format) -> Result<Outcome, CliError> {
    let RulesArgs { group, object, status } = args;
    let wanted = |row: &Row| {
        group.as_ref().is_none_or(|group| row.group == group)
            && object.as_ref().is_none_or(|object| row.object.contains(object))
            && status.as_ref().is_none_or(|status| row.status == status)
    };
    let list = List { rules: RULES.iter().map(Row::new).filter(wanted).collect() };
    match format {
        Format::Json => output::print_json(&list)?,
        Format::Text => output::print(|out| list.print(out))?,
    }
    Ok(Outcome::Clean)
}

impl List {
    fn print(&self, out: &mut dyn Write) -> std::io::Result<()> {
        for Row { vuid, kind, status, reason, .. } in &self.rules {
            match reason {
                Some(reason) => writeln!(out, "{status:<10}  {kind:<8}  {vuid}: {reason}")?,
                None => writeln!(out, "{status:<10}  {kind:<8}  {vuid}")?,
            }
        }
        let structural = self.rules.iter().filter(|row| row.reason.is_some()).count();
        let all = self.rules.len();
        writeln!(out, "{all} rules: {} checked, {structural} structural", all - structural)
    }
}
