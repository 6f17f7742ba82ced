//! The text as a tree of values that know where they stand.
//!
//! `ron` reads the text; it cuts every value out of it, unread, and this room puts the pieces together with their places. So the
//! grammar is RON's, and whatever is found to be wrong later can still be shown in the source. A name without parentheses may
//! stand for a value, so that enumerants are written as in C.

mod arguments;
mod read;

pub(crate) use arguments::Arguments;
pub(crate) use read::read;

use crate::error::{Mistake, Span, Spanned};

/// A value in the text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) span: Span,
    pub(crate) kind: Kind,
}

/// What a value is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Kind {
    Integer(i128),
    Float(f64),
    /// Text in quotes.
    Text(String),
    /// A name by itself, `true` and `None` included.
    Name(String),
    /// `[…]`
    List(Vec<Node>),
    /// `{…: …}`
    Map(Vec<(Node, Node)>),
    /// `(…)` or `name(…)`, with values in order.
    Tuple(Option<String>, Vec<Node>),
    /// `(…: …)` or `name(…: …)`, with values by name.
    Struct(Option<String>, Vec<(Spanned<String>, Node)>),
}

impl Node {
    pub(crate) fn mistake(&self, message: impl Into<String>) -> Mistake {
        Mistake::new(self.span, message)
    }

    /// What the value is, for people.
    pub(crate) fn describe(&self) -> String {
        match &self.kind {
            Kind::Integer(number) => number.to_string(),
            Kind::Float(number) => number.to_string(),
            Kind::Text(text) => format!("\"{text}\""),
            Kind::Name(name) => name.clone(),
            Kind::List(_) => "a list".to_owned(),
            Kind::Map(_) => "a map".to_owned(),
            Kind::Tuple(None, _) | Kind::Struct(None, _) => "a group in parentheses".to_owned(),
            Kind::Tuple(Some(name), _) | Kind::Struct(Some(name), _) => format!("{name}(…)"),
        }
    }

    fn wanted(&self, what: &str) -> Mistake {
        self.mistake(format!("{} stands where {what} is needed", self.describe()))
    }

    /// Text in quotes.
    pub(crate) fn text(&self) -> Result<&str, Mistake> {
        match &self.kind {
            Kind::Text(text) => Ok(text),
            _ => Err(self.wanted("text in quotes")),
        }
    }

    /// A whole number of a range, which `T` has.
    pub(crate) fn integer<T: TryFrom<i128>>(&self) -> Result<T, Mistake> {
        let Kind::Integer(number) = self.kind else { return Err(self.wanted("a whole number")) };
        let bits = 8 * size_of::<T>();
        T::try_from(number).map_err(|_| self.mistake(format!("{number} does not fit into {bits} bits")))
    }

    /// A number.
    pub(crate) fn float(&self) -> Result<f64, Mistake> {
        match &self.kind {
            Kind::Integer(number) => Ok(*number as f64),
            Kind::Float(number) => Ok(*number),
            _ => Err(self.wanted("a number")),
        }
    }

    /// `true` or `false`.
    pub(crate) fn boolean(&self) -> Result<bool, Mistake> {
        match self.name() {
            Some("true") => Ok(true),
            Some("false") => Ok(false),
            _ => Err(self.wanted("true or false")),
        }
    }

    /// A name by itself.
    pub(crate) fn name(&self) -> Option<&str> {
        match &self.kind {
            Kind::Name(name) => Some(name),
            _ => None,
        }
    }

    /// Whether this is a word for nothing.
    pub(crate) fn is_null(&self) -> bool {
        matches!(self.name(), Some("null" | "NULL" | "None" | "VK_NULL_HANDLE"))
    }

    /// The elements of a list.
    pub(crate) fn list(&self) -> Result<&[Node], Mistake> {
        match &self.kind {
            Kind::List(elements) => Ok(elements),
            _ => Err(self.wanted("a list")),
        }
    }

    /// The elements of a list, or the one value that stands for a list of one.
    pub(crate) fn one_or_more(&self) -> &[Node] {
        match &self.kind {
            Kind::List(elements) => elements,
            _ => std::slice::from_ref(self),
        }
    }

    /// The entries of a map.
    pub(crate) fn map(&self) -> Result<&[(Node, Node)], Mistake> {
        match &self.kind {
            Kind::Map(entries) => Ok(entries),
            _ => Err(self.wanted("a map")),
        }
    }

    /// The word before the parentheses, or the name itself.
    pub(crate) fn head(&self) -> Option<&str> {
        match &self.kind {
            Kind::Name(name) | Kind::Tuple(Some(name), _) | Kind::Struct(Some(name), _) => Some(name),
            _ => None,
        }
    }
}
