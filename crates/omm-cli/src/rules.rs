//! `omm rules`: the ledger of rules.

use std::io::Write;

use clap::Args;
use clap::builder::PossibleValuesParser;
use omm_scenario::{Library, Scenario};
use omm_validate::RuleId;
use omm_validate::catalog::{RULES, Rule, Status};
use serde::Serialize;

use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::output;

/// Arguments of `omm rules`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct RulesArgs {
    /// Only rules of this group.
    #[arg(long, value_parser = groups())]
    group: Option<String>,
    /// Only rules on this structure or command, such as VkMicromapBuildInfoEXT; part of the name is enough.
    #[arg(long)]
    object: Option<String>,
    /// Only rules of this status: those that a function checks, or those that no call can be written down to break.
    #[arg(long, value_parser = ["checked", "structural"])]
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

/// The names of the groups.
fn groups() -> PossibleValuesParser {
    let mut groups: Vec<_> = RULES.iter().map(|rule| rule.group.name()).collect();
    groups.sort_unstable();
    groups.dedup();
    groups.into()
}

/// All rules that were asked for.
#[derive(Serialize)]
struct List<'a> {
    rules: Vec<Row<'a>>,
}

/// One rule.
#[derive(Serialize)]
struct Row<'a> {
    vuid: &'static str,
    group: &'static str,
    object: &'static str,
    kind: &'static str,
    status: &'static str,
    /// Why a structural rule cannot be written down as a call.
    reason: Option<&'static str>,
    /// The scenarios that break the rule, then those that keep it: paths below `spec-tests`.
    scenarios: Vec<&'a str>,
}

impl<'a> Row<'a> {
    fn new(rule: &'static Rule, library: &'a Library) -> Self {
        Self {
            vuid: rule.vuid(),
            group: rule.group.name(),
            object: rule.object(),
            kind: rule.kind.name(),
            status: rule.status.name(),
            reason: rule.status.reason(),
            scenarios: library.about(rule.id).map(Scenario::name).collect(),
        }
    }
}

/// Runs `omm rules`.
pub(crate) fn run(args: &RulesArgs, format: Format) -> Result<Outcome, CliError> {
    let RulesArgs { group, object, status } = args;
    let wanted = |rule: &&Rule| {
        group.as_ref().is_none_or(|group| rule.group.name() == group)
            && object.as_ref().is_none_or(|object| rule.object().contains(object))
            && status.as_ref().is_none_or(|status| rule.status.name() == status)
    };
    let rules: Vec<&Rule> = RULES.iter().filter(wanted).collect();
    let library = Library::built_in()?;
    let list = List { rules: rules.iter().map(|rule| Row::new(rule, &library)).collect() };
    match format {
        Format::Json => output::print_json(&list)?,
        Format::Text => output::print(|out| {
            list.print(out)?;
            writeln!(out, "{}", summary(&rules))
        })?,
    }
    Ok(Outcome::Clean)
}

impl List<'_> {
    fn print(&self, out: &mut dyn Write) -> std::io::Result<()> {
        for Row { vuid, kind, status, reason, .. } in &self.rules {
            match reason {
                Some(reason) => writeln!(out, "{status:<10}  {kind:<8}  {vuid}: {reason}")?,
                None => writeln!(out, "{status:<10}  {kind:<8}  {vuid}")?,
            }
        }
        Ok(())
    }
}

/// How many rules there are of which kind.
fn summary(rules: &[&Rule]) -> String {
    let (in_scope, others): (Vec<&Rule>, Vec<&Rule>) = rules.iter().copied().partition(|rule| rule.is_in_scope());
    let all = in_scope.len();
    let checked = in_scope.iter().filter(|rule| rule.status == Status::Checked).count();
    let without = match RuleId::ALL.iter().filter(|id| id.rule().is_none()).count() {
        0 => "none".to_owned(),
        count => count.to_string(),
    };
    let structural = all - checked;
    let mut text =
        format!("{all} rules in scope: {checked} checked, {structural} structural, {without} without a verdict");
    if !others.is_empty() {
        text += &format!("; and {} beyond it", others.len());
    }
    text
}
