//! `omm explain`: what a rule is about, and what a program that breaks it gets to read.

use std::io::Write;

use clap::Args;
use omm_scenario::{Finding, Library, Scenario, names_like, run as execute};
use omm_validate::RuleId;
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

/// Rules offered where there is none of the identifier that was asked for.
const OFFERED: usize = 3;

/// What there is to say about a rule.
#[derive(Serialize)]
struct Explanation<'a> {
    vuid: &'static str,
    group: &'static str,
    object: &'static str,
    kind: &'static str,
    status: &'static str,
    reason: Option<&'static str>,
    explanation: &'static str,
    note: &'static str,
    /// Commands and paths at which the scenarios break the rule.
    looks_at: Vec<String>,
    /// The scenario that breaks the rule and least besides.
    broken_by: Option<Broken<'a>>,
    /// The scenarios that break the rule, then those that keep it: paths below `spec-tests`.
    scenarios: Vec<&'a str>,
    url: String,
}

/// A scenario that breaks a rule.
#[derive(Serialize)]
struct Broken<'a> {
    scenario: &'a str,
    text: &'a str,
    /// What its transcript says of the rule.
    reports: Vec<Reported>,
}

/// A finding and the command that it is about.
#[derive(Serialize)]
struct Reported {
    command: &'static str,
    #[serde(flatten)]
    finding: Finding,
}

impl Reported {
    fn place(&self) -> String {
        format!("{}(): {}", self.command, self.finding.at)
    }
}

/// What the validator says of a rule when a scenario runs.
fn reports(rule: RuleId, scenario: &Scenario) -> Result<Vec<Reported>, CliError> {
    let transcript = execute(scenario).map_err(CliError::Scenario)?;
    let of_rule = transcript.findings().filter(|(_, finding)| finding.rule == rule);
    Ok(of_rule.map(|(command, finding)| Reported { command, finding: finding.clone() }).collect())
}

impl<'a> Explanation<'a> {
    fn new(rule: &'static Rule, library: &'a Library) -> Result<Self, CliError> {
        let breaking = library.breaking(rule.id);
        let mut runs = breaking.iter().map(|it| reports(rule.id, it)).collect::<Result<Vec<_>, _>>()?;
        let mut looks_at = Vec::new();
        for place in runs.iter().flatten().map(Reported::place) {
            if !looks_at.contains(&place) {
                looks_at.push(place);
            }
        }
        let broken_by = breaking.first().map(|scenario| Broken {
            scenario: scenario.name(),
            text: scenario.text(),
            reports: runs.swap_remove(0),
        });
        Ok(Self {
            vuid: rule.vuid(),
            group: rule.group.name(),
            object: rule.object(),
            kind: rule.kind.name(),
            status: rule.status.name(),
            reason: rule.status.reason(),
            explanation: rule.explanation,
            note: rule.note,
            looks_at,
            broken_by,
            scenarios: library.about(rule.id).map(Scenario::name).collect(),
            url: rule.id.url(),
        })
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
        if !self.looks_at.is_empty() {
            writeln!(out, "\nLooks at:")?;
            self.looks_at.iter().try_for_each(|place| writeln!(out, "  {place}"))?;
        }
        if let Some(broken) = &self.broken_by {
            broken.print(out)?;
            let others: Vec<_> = self.scenarios.iter().filter(|name| **name != broken.scenario).copied().collect();
            if !others.is_empty() {
                writeln!(out, "\nSee also: {}", others.join(", "))?;
            }
        }
        writeln!(out, "\n{}", self.url)
    }
}

impl Broken<'_> {
    fn print(&self, out: &mut dyn Write) -> std::io::Result<()> {
        writeln!(out, "\nBroken by spec-tests/{}:", self.scenario)?;
        self.text.lines().try_for_each(|line| writeln!(out, "{}", format!("  {line}").trim_end()))?;
        writeln!(out, "\nwhich is reported as:")?;
        self.reports.iter().try_for_each(|report| {
            let Finding { found, required, .. } = &report.finding;
            writeln!(out, "  {}: found {found}, required {required}", report.place())
        })
    }
}

/// What identifiers end in: the number, or the words behind the last dash.
fn last_part(vuid: &'static str) -> &'static str {
    vuid.rsplit('-').next().unwrap_or_default()
}

/// The rules of an identifier or of what identifiers end in; a number may stand in those of several commands.
pub(crate) fn find(wanted: &str) -> Result<Vec<&'static Rule>, CliError> {
    let ends = |vuid: &str| {
        let end = vuid.len().checked_sub(wanted.len()).and_then(|start| vuid.get(start..).zip(vuid.get(..start)));
        end.is_some_and(|(end, before)| {
            end.eq_ignore_ascii_case(wanted) && (before.is_empty() || before.ends_with('-'))
        })
    };
    let found: Vec<_> = RULES.iter().filter(|rule| ends(rule.vuid())).collect();
    if !found.is_empty() {
        return Ok(found);
    }
    let names = RULES.iter().map(|rule| match wanted.contains('-') {
        true => rule.vuid(),
        false => last_part(rule.vuid()),
    });
    let longer = names.clone().filter(|name| name.starts_with(wanted));
    let mut near: Vec<String> = Vec::new();
    for name in longer.chain(names_like(wanted, names)) {
        if near.len() < OFFERED && !near.iter().any(|known| known == name) {
            near.push(name.to_owned());
        }
    }
    Err(CliError::UnknownRule { wanted: wanted.to_owned(), near })
}

/// Runs `omm explain`.
pub(crate) fn run(args: &ExplainArgs, format: Format) -> Result<Outcome, CliError> {
    let rules = find(args.rule.trim())?;
    let library = Library::built_in()?;
    let found = rules.into_iter().map(|rule| Explanation::new(rule, &library)).collect::<Result<Vec<_>, _>>()?;
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
