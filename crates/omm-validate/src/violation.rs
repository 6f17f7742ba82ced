//! One finding: which rule, where, what was found and what was required.

mod found;
mod kind;
mod origin;
mod required;

use std::fmt;

use serde::Serialize;
use serde::ser::{SerializeSeq, SerializeStruct, Serializer};

use crate::location::{Location, Object};
use crate::rule::RuleId;
use crate::value::{object_type_name, write_objects};

pub use kind::ViolationKind;
pub use origin::Origin;

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Severity {
    /// Valid usage is broken: a driver may do anything.
    Error,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Error => "Error",
        })
    }
}

/// A rule that a call breaks.
///
/// [`Display`](fmt::Display) writes it as the messages of a validation layer read: the rule's identifier, the objects, the path,
/// found and required, what it means, a link. `Serialize` writes an object of `vuid`, `severity`, `command`, `path`, `found`,
/// `required`, `objects` (each `type` and `handle`, the latter in hexadecimal) and `message`, all of them strings but `objects`.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Violation {
    /// The rule.
    pub rule: RuleId,
    /// How bad it is.
    pub severity: Severity,
    /// The command's name, such as `vkCmdBuildAccelerationStructuresKHR`.
    pub command: &'static str,
    /// The path to the offending value.
    pub location: Location,
    /// What was found there and what was required.
    pub kind: ViolationKind,
    /// The objects concerned, the one that the command was called on first.
    pub objects: Vec<Object>,
}

impl Violation {
    /// The finding in one line: command, path, found and required.
    #[must_use]
    pub fn summary(&self) -> String {
        let Self { command, location, kind, .. } = self;
        format!("{command}(): {location}: found {}, required {}", kind.found(), kind.required())
    }
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Validation {}: [ {} ]", self.severity, self.rule)?;
        if !self.objects.is_empty() {
            f.write_str("Objects: ")?;
            write_objects(f, &self.objects)?;
            writeln!(f)?;
        }
        writeln!(f, "{}", self.summary())?;
        writeln!(f, "{}", self.rule.explanation())?;
        writeln!(f, "{}", self.rule.url())
    }
}

impl Serialize for Violation {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("Violation", 8)?;
        object.serialize_field("vuid", self.rule.vuid())?;
        object.serialize_field("severity", &self.severity)?;
        object.serialize_field("command", self.command)?;
        object.serialize_field("path", &self.location)?;
        object.serialize_field("found", &self.kind.found())?;
        object.serialize_field("required", &self.kind.required())?;
        object.serialize_field("objects", &ObjectList(&self.objects))?;
        object.serialize_field("message", &format!("{}. {}", self.summary(), self.rule.explanation()))?;
        object.end()
    }
}

struct ObjectList<'a>(&'a [Object]);

impl Serialize for ObjectList<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Entry {
            r#type: String,
            handle: String,
        }
        let mut list = serializer.serialize_seq(Some(self.0.len()))?;
        for (ty, handle) in self.0 {
            list.serialize_element(&Entry { r#type: object_type_name(*ty), handle: format!("{handle:#x}") })?;
        }
        list.end()
    }
}
