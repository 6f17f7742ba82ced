//! What happened: for people, and for programs.

use std::fmt;

use omm_device::Undefined;
use omm_model::call::{Call, Output};
use omm_validate::{Report, RuleId, Violation};
use serde::Serialize;

use crate::objects::Objects;
use crate::summary;

/// What the device made of a call.
#[derive(Clone, Debug)]
pub(crate) enum Outcome {
    Output(Output),
    Undefined(Box<Undefined>),
}

/// A rule that a call breaks, as the transcript shows it: objects go by their names.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Finding {
    /// The rule.
    #[serde(rename = "vuid")]
    pub rule: RuleId,
    /// The path from the command's parameters to the offending value.
    #[serde(rename = "path")]
    pub at: String,
    /// What was found there.
    pub found: String,
    /// What was required.
    pub required: String,
}

/// One call.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct CallRecord {
    pub(crate) command: &'static str,
    pub(crate) summary: String,
    /// Whether the scenario asked for it; others lead up to it.
    #[serde(skip)]
    pub(crate) is_main: bool,
    #[serde(rename = "reports")]
    pub(crate) findings: Vec<Finding>,
    /// What it returned, or why the device stopped.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) outcome: Option<String>,
    #[serde(rename = "undefined")]
    pub(crate) is_undefined: bool,
    #[serde(skip)]
    pub(crate) output: Option<Output>,
}

impl CallRecord {
    /// What the validator reported of a call and what the device made of it, in the words of the objects' names.
    pub(crate) fn new(call: &Call, is_main: bool, report: &Report, outcome: &Outcome, objects: &Objects) -> Self {
        let finding = |violation: &Violation| Finding {
            rule: violation.rule,
            at: objects.named(violation.location.as_str()),
            found: objects.named(&violation.kind.found()),
            required: objects.named(&violation.kind.required()),
        };
        let (text, output) = match outcome {
            Outcome::Output(output) => (summary::output(output, objects), Some(output.clone())),
            Outcome::Undefined(undefined) => (Some(objects.named(&undefined.to_string())), None),
        };
        Self {
            command: call.command(),
            summary: summary::call(call, objects),
            is_main,
            findings: report.iter().map(finding).collect(),
            outcome: text,
            is_undefined: output.is_none(),
            output,
        }
    }

    /// The command and what it was given.
    pub(crate) fn head(&self) -> String {
        let separator = if self.summary.is_empty() { "" } else { ": " };
        format!("{}{separator}{}", self.command, self.summary)
    }

    /// What was reported and what came of it, so many blanks from the left.
    pub(crate) fn fmt_details(&self, f: &mut fmt::Formatter<'_>, indent: usize) -> fmt::Result {
        for Finding { rule, at, found, required } in &self.findings {
            writeln!(f, "{:indent$}! {rule}", "")?;
            writeln!(f, "{:indent$}  {at}", "")?;
            writeln!(f, "{:indent$}  found {found}, required {required}", "")?;
        }
        if let Some(outcome) = &self.outcome {
            let undefined = if self.is_undefined { "undefined: " } else { "" };
            writeln!(f, "{:indent$}→ {undefined}{outcome}", "")?;
        }
        Ok(())
    }

    /// Whether there is anything to say about it.
    fn is_shown(&self) -> bool {
        self.is_main || self.is_undefined || !self.findings.is_empty()
    }
}

/// What was done for one object or one step.
#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct Group {
    /// The object, or the step in short.
    pub(crate) name: String,
    /// What it is.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub(crate) description: String,
    /// Parameters that were changed, and their new values.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) changes: Vec<(String, String)>,
    #[serde(serialize_with = "shown_calls")]
    pub(crate) calls: Vec<CallRecord>,
}

fn shown_calls<S: serde::Serializer>(calls: &[CallRecord], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(calls.iter().filter(|call| call.is_shown()))
}

/// Something expected.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Check {
    pub(crate) expected: String,
    /// What was found instead.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) failure: Option<String>,
}

/// The record of a run.
///
/// [`Display`](fmt::Display) writes it for people: what was given, each step with its calls, what the validator reported below
/// them, what the device made of them, and what became of the expectations. Objects go by their names; there are no line numbers,
/// handles or addresses that another line in the scenario would change. `Serialize` writes the same for programs:
///
/// `{"title", "section", "profile", "breaks", "keeps", "given": […], "when": [{"name", "changes", "calls": [{"command",
/// "summary", "reports": [{"vuid", "path", "found", "required"}], "outcome", "undefined"}]}], "then": [{"expected", "failure"}],
/// "reported", "passed"}`
#[derive(Clone, Debug, Serialize)]
pub struct Transcript {
    pub(crate) title: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) section: Option<String>,
    pub(crate) profile: String,
    pub(crate) breaks: Vec<RuleId>,
    pub(crate) keeps: Vec<RuleId>,
    pub(crate) given: Vec<Group>,
    pub(crate) when: Vec<Group>,
    pub(crate) then: Vec<Check>,
    pub(crate) reported: Vec<RuleId>,
    #[serde(skip)]
    pub(crate) stops: bool,
    pub(crate) passed: bool,
}

impl Transcript {
    /// Whether exactly the rules that the scenario breaks were reported, and all that it expects was found.
    #[must_use]
    pub const fn passed(&self) -> bool {
        self.passed
    }

    /// The rules that were reported, in the catalog's order.
    #[must_use]
    pub fn reported(&self) -> &[RuleId] {
        &self.reported
    }

    /// What the validator reported, call by call, with the names of the commands.
    pub fn findings(&self) -> impl Iterator<Item = (&'static str, &Finding)> {
        let calls = self.given.iter().chain(&self.when).flat_map(|group| &group.calls);
        calls.flat_map(|call| call.findings.iter().map(|finding| (call.command, finding)))
    }

    /// Whether the simulated device stopped on the way, because a call left its behaviour undefined.
    #[must_use]
    pub const fn stops(&self) -> bool {
        self.stops
    }

    /// What was expected and not found.
    pub fn failures(&self) -> impl Iterator<Item = String> {
        self.then.iter().filter_map(|check| Some(format!("{}: {}", check.expected, check.failure.as_deref()?)))
    }
}

impl fmt::Display for Transcript {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.title)?;
        writeln!(f, "on {}", self.profile)?;
        for (what, rules) in [("breaks", &self.breaks), ("keeps", &self.keeps)] {
            rules.iter().try_for_each(|rule| writeln!(f, "{what} {rule}"))?;
        }
        for (what, groups) in [("given", &self.given), ("when", &self.when)] {
            if !groups.is_empty() {
                writeln!(f, "\n{what}")?;
            }
            groups.iter().try_for_each(|group| group.fmt(f))?;
        }
        if !self.then.is_empty() {
            writeln!(f, "\nthen")?;
        }
        for Check { expected, failure } in &self.then {
            match failure {
                None => writeln!(f, "  ✓ {expected}")?,
                Some(failure) => writeln!(f, "  ✗ {expected}\n      {failure}")?,
            }
        }
        writeln!(f, "\n{}", if self.passed { "passed" } else { "FAILED" })
    }
}

impl fmt::Display for Group {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let separator = if self.description.is_empty() { "" } else { " = " };
        writeln!(f, "  {}{separator}{}", self.name, self.description)?;
        for (path, value) in &self.changes {
            writeln!(f, "      with {path} = {value}")?;
        }
        for call in self.calls.iter().filter(|call| call.is_shown()) {
            // What only leads to the device's stop says nothing by itself; the reason names the command.
            if call.is_main || !call.findings.is_empty() {
                writeln!(f, "    {}", call.head())?;
            }
            call.fmt_details(f, 6)?;
        }
        Ok(())
    }
}
