//! What a check found.

use std::fmt;

use serde::Serialize;

use crate::location::At;
use crate::rule::RuleId;
use crate::violation::{Severity, Violation, ViolationKind};

/// The violations of one call, in the order in which they were found: rules that look at parameters only first, then rules on
/// tracked objects, then rules on the contents of memory; within each from the first parameter to the last.
///
/// [`Display`](fmt::Display) writes every violation as text with an empty line between them; `Serialize` writes a list.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Report {
    violations: Vec<Violation>,
}

impl Report {
    /// The violations.
    #[must_use]
    pub fn violations(&self) -> &[Violation] {
        &self.violations
    }

    /// Whether nothing is wrong.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.violations.is_empty()
    }

    /// How many violations there are.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.violations.len()
    }

    /// The violations in order.
    pub fn iter(&self) -> std::slice::Iter<'_, Violation> {
        self.violations.iter()
    }

    /// Adds a finding. Only here does a check allocate.
    pub(crate) fn push(&mut self, rule: RuleId, at: &At<'_>, kind: ViolationKind) {
        self.violations.push(Violation {
            rule,
            severity: Severity::Error,
            command: at.command_name(),
            location: at.location(),
            kind,
            objects: at.objects(),
        });
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (position, violation) in self.violations.iter().enumerate() {
            if position > 0 {
                writeln!(f)?;
            }
            violation.fmt(f)?;
        }
        Ok(())
    }
}

impl<'a> IntoIterator for &'a Report {
    type Item = &'a Violation;
    type IntoIter = std::slice::Iter<'a, Violation>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl IntoIterator for Report {
    type Item = Violation;
    type IntoIter = std::vec::IntoIter<Violation>;
    fn into_iter(self) -> Self::IntoIter {
        self.violations.into_iter()
    }
}
