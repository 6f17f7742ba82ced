//! Cutting the text into values.

use std::fmt;

use ron::value::RawValue;
use serde::de::{self, Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};

use super::{Kind, Node};
use crate::error::{Mistake, Span, Spanned};
use crate::limits;

/// Reads all of a text as one value.
pub(crate) fn read(text: &str) -> Result<Node, Mistake> {
    if text.len() > limits::SOURCE {
        let message = format!("the text has {} bytes, at most {} are read", text.len(), limits::SOURCE);
        return Err(Mistake::new(Span::default(), message));
    }
    let value: &RawValue = ron::from_str(text).map_err(|error| mistake(text, text, &error))?;
    Reader { text }.node(value.get_ron())
}

/// An error of `ron`, which counts lines and columns from the start of `part`.
fn mistake(text: &str, part: &str, error: &ron::error::SpannedError) -> Mistake {
    let base = part.as_ptr().addr().saturating_sub(text.as_ptr().addr());
    let at = |position: ron::error::Position| {
        let lines = part.split_inclusive('\n').take(position.line.saturating_sub(1));
        let line: usize = lines.map(str::len).sum();
        let rest = part.get(line..).unwrap_or_default();
        let column: usize = rest.chars().take(position.col.saturating_sub(1)).map(char::len_utf8).sum();
        base + line + column
    };
    let span = Span { start: at(error.span.start), end: at(error.span.end) };
    let found = text.get(span.start..).unwrap_or_default();
    let mistake = Mistake::new(span, error.code.to_string());
    if found.trim_start().starts_with(':') {
        return mistake.help("in one pair of parentheses all values have names, or none has");
    }
    mistake
}

struct Reader<'t> {
    text: &'t str,
}

impl<'t> Reader<'t> {
    /// Where a part of the text begins.
    fn offset(&self, part: &str) -> usize {
        part.as_ptr().addr().saturating_sub(self.text.as_ptr().addr())
    }

    fn parse<T: Deserialize<'t>>(&self, part: &'t str) -> Result<T, Mistake> {
        ron::from_str(part).map_err(|error| mistake(self.text, part, &error))
    }

    /// The value that a part of the text holds, amid blanks and comments. The whole text was read once, so nesting is bounded.
    fn node(&self, part: &'t str) -> Result<Node, Mistake> {
        let part = skip(part).trim_end();
        let start = self.offset(part);
        let name = identifier(part);
        let rest = skip(part.get(name.len()..).unwrap_or_default());
        let (kind, length) = match part.chars().next() {
            // A comment may follow; the value itself ends with its last letter.
            Some('0'..='9' | '+' | '-' | '.') => {
                let number = |letter: char| letter.is_ascii_alphanumeric() || "+-._".contains(letter);
                (self.number(part)?, part.find(|letter| !number(letter)))
            }
            Some('"' | '\'') => (Kind::Text(self.quoted(part)?), None),
            _ if rest.starts_with(['"', '#', '\'']) && name.len() <= 2 => (Kind::Text(self.quoted(part)?), None),
            _ if !name.is_empty() && !rest.starts_with('(') => match name {
                "inf" | "NaN" => (self.number(part)?, Some(name.len())),
                _ => (Kind::Name(name.to_owned()), Some(name.len())),
            },
            _ if name == "Some" => return self.some(part),
            _ => (self.compound(part, name)?, None),
        };
        let end = start + length.unwrap_or(part.len());
        Ok(Node { span: Span { start, end }, kind })
    }

    fn number(&self, part: &'t str) -> Result<Kind, Mistake> {
        if let Ok(number) = ron::from_str::<i64>(part) {
            return Ok(Kind::Integer(number.into()));
        }
        match ron::from_str::<u64>(part) {
            Ok(number) => Ok(Kind::Integer(number.into())),
            Err(_) => self.parse(part).map(Kind::Float),
        }
    }

    fn quoted(&self, part: &'t str) -> Result<String, Mistake> {
        match ron::from_str::<char>(part) {
            Ok(letter) => Ok(letter.to_string()),
            Err(_) => self.parse(part),
        }
    }

    /// `Some(x)` is x.
    fn some(&self, part: &'t str) -> Result<Node, Mistake> {
        let value: Option<&'t RawValue> = self.parse(part)?;
        self.node(value.map_or("None", RawValue::get_ron))
    }

    fn compound(&self, part: &'t str, name: &str) -> Result<Kind, Mistake> {
        let mut source = ron::Deserializer::from_str(part).map_err(|error| mistake(self.text, part, &error))?;
        let braces = part.starts_with('{');
        let parts = source.deserialize_any(PartsVisitor { braces });
        let parts = parts.map_err(|error| mistake(self.text, part, &source.span_error(error)))?;
        let name = (!name.is_empty()).then(|| name.to_owned());
        Ok(match parts {
            Parts::Values(values) => {
                let nodes = values.into_iter().map(|value| self.node(value)).collect::<Result<_, _>>()?;
                if part.starts_with('[') { Kind::List(nodes) } else { Kind::Tuple(name, nodes) }
            }
            Parts::Entries(entries) => {
                let entries = entries.into_iter().map(|(key, value)| Ok((self.node(key)?, self.node(value)?)));
                Kind::Map(entries.collect::<Result<_, _>>()?)
            }
            Parts::Fields(fields) => {
                let field = |(name, value): (&'t str, &'t str)| {
                    let start = self.offset(name);
                    let span = Span { start, end: start + name.len() };
                    Ok((Spanned { value: name.to_owned(), span }, self.node(value)?))
                };
                Kind::Struct(name, fields.into_iter().map(field).collect::<Result<_, _>>()?)
            }
        })
    }
}

/// The pieces of a list, map or group.
enum Parts<'t> {
    Values(Vec<&'t str>),
    Entries(Vec<(&'t str, &'t str)>),
    Fields(Vec<(&'t str, &'t str)>),
}

struct PartsVisitor {
    braces: bool,
}

impl<'t> Visitor<'t> for PartsVisitor {
    type Value = Parts<'t>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list, a map or a group in parentheses")
    }

    fn visit_unit<E: de::Error>(self) -> Result<Self::Value, E> {
        Ok(Parts::Values(Vec::new()))
    }

    fn visit_seq<A: SeqAccess<'t>>(self, mut values: A) -> Result<Self::Value, A::Error> {
        let mut parts = Vec::new();
        while let Some(value) = values.next_element::<&RawValue>()? {
            parts.push(value.get_ron());
        }
        Ok(Parts::Values(parts))
    }

    fn visit_map<A: MapAccess<'t>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut parts = Vec::new();
        if self.braces {
            while let Some((key, value)) = map.next_entry::<&RawValue, &RawValue>()? {
                parts.push((key.get_ron(), value.get_ron()));
            }
            return Ok(Parts::Entries(parts));
        }
        while let Some((key, value)) = map.next_entry::<&str, &RawValue>()? {
            parts.push((key, value.get_ron()));
        }
        Ok(Parts::Fields(parts))
    }
}

/// The text behind leading blanks and comments.
fn skip(mut text: &str) -> &str {
    loop {
        let start = text.trim_start();
        text = if let Some(comment) = start.strip_prefix("//") {
            comment.split_once('\n').map_or("", |(_, rest)| rest)
        } else if start.starts_with("/*") {
            block_comment(start)
        } else {
            return start;
        };
    }
}

/// The text behind a block comment, which may hold others.
fn block_comment(text: &str) -> &str {
    let (mut depth, mut at) = (0_usize, 0);
    while let Some(found) = text.get(at..).and_then(|rest| rest.find(['/', '*'])) {
        at += found;
        let rest = text.get(at..).unwrap_or_default();
        if rest.starts_with("/*") {
            depth += 1;
            at += 2;
        } else if rest.starts_with("*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                return text.get(at..).unwrap_or_default();
            }
        } else {
            at += 1;
        }
    }
    ""
}

/// The name at the start of a text, if there is one.
fn identifier(text: &str) -> &str {
    let end = text.find(|letter: char| !(letter.is_alphanumeric() || letter == '_')).unwrap_or(text.len());
    text.get(..end).filter(|name| !name.starts_with(|letter: char| letter.is_ascii_digit())).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The tree as text, each value with what its span marks.
    fn show(text: &str) -> String {
        fn write(text: &str, node: &Node, depth: usize, out: &mut String) {
            let marked = text.get(node.span.start..node.span.end).unwrap_or("?").replace('\n', "⏎");
            out.push_str(&format!("{:depth$}{}: {marked}\n", "", node.describe()));
            let children: Vec<&Node> = match &node.kind {
                Kind::List(nodes) | Kind::Tuple(_, nodes) => nodes.iter().collect(),
                Kind::Map(entries) => entries.iter().flat_map(|(key, value)| [key, value]).collect(),
                Kind::Struct(_, fields) => fields.iter().map(|(_, value)| value).collect(),
                _ => Vec::new(),
            };
            children.into_iter().for_each(|child| write(text, child, depth + 2, out));
        }
        let mut out = String::new();
        match read(text) {
            Ok(node) => write(text, &node, 0, &mut out),
            Err(Mistake { span, message, .. }) => out = format!("{}..{}: {message}", span.start, span.end),
        }
        out
    }

    #[test]
    fn values_know_their_places() {
        let text = r##"// first
(
    title: "a (b", /* not /* this */ */ number: -0x1F, // eleven
    list: [1.5, inf, A | true],
)"##;
        assert!(show(text).contains("Expected"), "{}", show(text));
        let text = r##"// first
(
    title: "a (b", /* not /* this */ */ number: -0x1F, // eleven
    list: [1.5, inf // here
        , VK_A, true, Some(4), r#"raw"#, 'c', null, ()],
    map: { "x.y": f(1, "two"), g(): (a: [], b: h(c: 18446744073709551615,)) },
)"##;
        insta::assert_snapshot!(show(text), @r##"
        a group in parentheses: (⏎    title: "a (b", /* not /* this */ */ number: -0x1F, // eleven⏎    list: [1.5, inf // here⏎        , VK_A, true, Some(4), r#"raw"#, 'c', null, ()],⏎    map: { "x.y": f(1, "two"), g(): (a: [], b: h(c: 18446744073709551615,)) },⏎)
          "a (b": "a (b"
          -31: -0x1F
          a list: [1.5, inf // here⏎        , VK_A, true, Some(4), r#"raw"#, 'c', null, ()]
            1.5: 1.5
            inf: inf
            VK_A: VK_A
            true: true
            4: 4
            "raw": r#"raw"#
            "c": 'c'
            null: null
            a group in parentheses: ()
          a map: { "x.y": f(1, "two"), g(): (a: [], b: h(c: 18446744073709551615,)) }
            "x.y": "x.y"
            f(…): f(1, "two")
              1: 1
              "two": "two"
            g(…): g()
            a group in parentheses: (a: [], b: h(c: 18446744073709551615,))
              a list: []
              h(…): h(c: 18446744073709551615,)
                18446744073709551615: 18446744073709551615
        "##);
    }

    #[test]
    fn mistakes_have_places() {
        insta::assert_snapshot!(show("(\n  a: [1, 2\n)"), @"13..13: Expected comma");
        insta::assert_snapshot!(show("(a: \"open"), @"4..5: Expected end of string");
        insta::assert_snapshot!(show(""), @"0..0: Unexpected end of RON");
        insta::assert_snapshot!(show("(a: 1) b"), @"7..7: Non-whitespace trailing characters");
        assert!(show(&"[".repeat(10_000)).contains("recursion"), "{}", show(&"[".repeat(10_000)));
        assert!(read(&" ".repeat(limits::SOURCE + 1)).is_err());
    }

    #[test]
    fn nesting_costs_little() {
        for (open, close) in [("[", "]"), ("(", ")"), ("f(", ")"), ("(a: ", ")"), ("{1: ", "}"), ("Some(", ")")] {
            let text = format!("{}1{}", open.repeat(40), close.repeat(40));
            assert!(read(&text).is_ok(), "{text}");
        }
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in r#"([-a-z0-9.:,"'#/*\\ \n(){}\[\]éA_]|Some\(|//|/\*|r#"){0,60}"#) {
            let _ = show(&text);
        }
    }
}
