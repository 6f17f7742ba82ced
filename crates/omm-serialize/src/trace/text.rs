//! Traces as text.

use ron::Options;
use ron::ser::PrettyConfig;
use serde::{Deserialize, Serialize};

use super::{Trace, VERSION};

/// Levels of values inside each other in a text; each of the binary form takes two at most.
const RECURSION_LIMIT: usize = 256;
/// Up to this level values stand on lines of their own, so that every event has one.
const LINES_TO_LEVEL: usize = 3;

/// Why a text is no trace.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}, column {column}: {message}")]
pub struct TraceTextError {
    /// The line, from 1 on; 0 where a trace cannot be written.
    pub line: usize,
    /// The column, from 1 on; 0 where a trace cannot be written.
    pub column: usize,
    /// What is wrong there.
    pub message: String,
}

/// The whole text.
#[derive(Serialize, Deserialize)]
#[serde(rename = "Trace", deny_unknown_fields)]
struct Text<T> {
    version: u32,
    trace: T,
}

fn options() -> Options {
    Options::default().with_recursion_limit(RECURSION_LIMIT)
}

impl Trace {
    /// The trace as text, one event a line.
    ///
    /// # Errors
    /// Values inside each other to a depth of more than a hundred, which a chain can have that holds chains.
    pub fn to_text(&self) -> Result<String, TraceTextError> {
        let pretty = PrettyConfig::new().depth_limit(LINES_TO_LEVEL).struct_names(true).new_line("\n").indentor("  ");
        let text = options().to_string_pretty(&Text { version: VERSION, trace: self }, pretty);
        let mut text = text.map_err(|error| TraceTextError { line: 0, column: 0, message: error.to_string() })?;
        text.push('\n');
        Ok(text)
    }

    /// Reads a text.
    ///
    /// # Errors
    /// The first place that is no RON, or where something else is required; a version other than [`VERSION`].
    pub fn from_text(text: &str) -> Result<Self, TraceTextError> {
        let read: Result<Text<Self>, _> = options().from_str(text);
        let Text { version, trace } = read.map_err(|error| TraceTextError {
            line: error.span.start.line,
            column: error.span.start.col,
            message: error.code.to_string(),
        })?;
        if version != VERSION {
            let message = format!("found version {version}, required {VERSION}, the only version this program reads");
            return Err(TraceTextError { line: 1, column: 1, message });
        }
        Ok(trace)
    }
}
