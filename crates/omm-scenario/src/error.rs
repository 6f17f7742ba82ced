//! What is wrong with a scenario, shown in its source.

use std::fmt;
use std::sync::Arc;

/// Bytes of a scenario's text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Span {
    pub(crate) start: usize,
    pub(crate) end: usize,
}

/// A value and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Spanned<T> {
    pub(crate) value: T,
    pub(crate) span: Span,
}

/// The text of a scenario and the name of the file that it came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Source {
    pub(crate) name: String,
    pub(crate) text: String,
}

/// Something wrong at a place in the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Mistake {
    pub(crate) span: Span,
    pub(crate) message: String,
    pub(crate) help: Option<String>,
}

impl Mistake {
    pub(crate) fn new(span: Span, message: impl Into<String>) -> Self {
        Self { span, message: message.into(), help: None }
    }

    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Adds what else there is to choose from: the names nearest to `found` first.
    pub(crate) fn nearest<'a>(self, found: &str, names: impl IntoIterator<Item = &'a str>) -> Self {
        match crate::nearest::among(found, names) {
            Some(help) => self.help(help),
            None => self,
        }
    }
}

/// Why a scenario cannot be read or run.
///
/// [`Display`](fmt::Display) shows the line of the source with a caret below the place:
///
/// ```text
/// error: there is no object "crad"
///   --> stride.ron:9:13
///    |
///  9 |     when: [build("crad")],
///    |                  ^^^^^^
///    = help: did you mean "card"? There are "card" and "leaf"
/// ```
#[derive(Clone, PartialEq, Eq)]
pub struct ScenarioError {
    source: Arc<Source>,
    mistake: Mistake,
}

impl ScenarioError {
    pub(crate) fn new(source: &Arc<Source>, mistake: Mistake) -> Self {
        Self { source: Arc::clone(source), mistake }
    }

    /// What is wrong.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.mistake.message
    }

    /// How it may be mended, where that is known.
    #[must_use]
    pub fn help(&self) -> Option<&str> {
        self.mistake.help.as_deref()
    }

    /// The name of the source, as it was given when the scenario was read.
    #[must_use]
    pub fn source_name(&self) -> &str {
        &self.source.name
    }

    /// The line, counted from 1.
    #[must_use]
    pub fn line(&self) -> usize {
        self.before().matches('\n').count() + 1
    }

    /// The column in characters, counted from 1.
    #[must_use]
    pub fn column(&self) -> usize {
        self.before().rsplit('\n').next().unwrap_or_default().chars().count() + 1
    }

    /// The text before the place.
    fn before(&self) -> &str {
        self.source.text.get(..self.mistake.span.start).unwrap_or(&self.source.text)
    }
}

impl std::error::Error for ScenarioError {}

/// As [`Display`](fmt::Display): the source as a whole is of no use where an error is unwrapped.
impl fmt::Debug for ScenarioError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// Characters of a source line that are shown before the place and from it on.
const SHOWN: (usize, usize) = (80, 80);

impl fmt::Display for ScenarioError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Mistake { span, message, help } = &self.mistake;
        let (line, column) = (self.line(), self.column());
        let text = self.source.text.lines().nth(line - 1).unwrap_or_default();
        // Of a line of any length no more than a window is shown.
        let skipped = (column - 1).saturating_sub(SHOWN.0);
        let shown: String = text.chars().skip(skipped).take(SHOWN.0 + SHOWN.1).map(plain).collect();
        let marked = self.source.text.get(span.start..span.end).unwrap_or_default();
        let left = shown.chars().count().saturating_sub(column - 1 - skipped);
        let carets = marked.lines().next().unwrap_or_default().trim_end().chars().count().clamp(1, left.max(1));
        let gutter = line.to_string().len();
        writeln!(f, "error: {message}")?;
        writeln!(f, "{:gutter$} --> {}:{line}:{column}", "", self.source.name)?;
        writeln!(f, " {:gutter$} |", "")?;
        writeln!(f, " {line} | {shown}")?;
        write!(f, " {:gutter$} | {}{}", "", " ".repeat(column - 1 - skipped), "^".repeat(carets))?;
        if let Some(help) = help {
            write!(f, "\n {:gutter$} = help: {help}", "")?;
        }
        writeln!(f)
    }
}

/// A character that takes one column.
fn plain(found: char) -> char {
    if found.is_control() { ' ' } else { found }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn show(text: &str, start: usize, end: usize) -> String {
        let source = Arc::new(Source { name: "a.ron".to_owned(), text: text.to_owned() });
        let mistake = Mistake::new(Span { start, end }, "wrong").nearest("crad", ["card", "leaf"]);
        ScenarioError::new(&source, mistake).to_string()
    }

    #[test]
    fn the_line_is_shown_with_a_caret() {
        insta::assert_snapshot!(show("one\n\ttwo (three)\nfour", 9, 16), @r#"
        error: wrong
          --> a.ron:2:6
           |
         2 |  two (three)
           |      ^^^^^^^
           = help: did you mean "card"? There are "card" and "leaf"
        "#);
    }

    #[test]
    fn places_that_are_none_are_shown_too() {
        for (start, end) in [(0, 0), (3, 3), (99, 100), (5, 2), (0, 100)] {
            assert!(show("é\nb", start, end).starts_with("error: wrong\n"));
        }
        assert!(show("", 0, 0).contains("a.ron:1:1"));
        let long = "x".repeat(100_000);
        assert!(show(&long, 50_000, 90_000).len() < 1000);
    }
}
