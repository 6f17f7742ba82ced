//! The values between a word's parentheses.

use super::{Kind, Node};
use crate::error::{Mistake, Span};

/// The arguments of one word, by name: `word(a, b)` and `word(first: a, second: b)` are the same.
#[derive(Debug)]
pub(crate) struct Arguments<'a> {
    /// The word.
    what: String,
    span: Span,
    values: Vec<(&'static str, &'a Node)>,
}

impl<'a> Arguments<'a> {
    /// The arguments of `node`, of which those without a name get `names` in order.
    pub(crate) fn of(node: &'a Node, names: &'static [&'static str]) -> Result<Self, Mistake> {
        let what = node.head().unwrap_or("this").to_owned();
        let mut values: Vec<(&'static str, &Node)> = Vec::new();
        match &node.kind {
            Kind::Name(_) => {}
            Kind::Tuple(_, nodes) => {
                for (index, value) in nodes.iter().enumerate() {
                    let name = names.get(index).ok_or_else(|| {
                        value.mistake(format!("{what} takes {} values, this is one more", names.len()))
                    })?;
                    values.push((name, value));
                }
            }
            Kind::Struct(_, fields) => {
                for (field, value) in fields {
                    let found = field.value.as_str();
                    let name = names.iter().find(|name| **name == found).ok_or_else(|| {
                        let mistake = Mistake::new(field.span, format!("{what} knows no \"{found}\""));
                        mistake.nearest(found, names.iter().copied())
                    })?;
                    if values.iter().any(|(known, _)| known == name) {
                        return Err(Mistake::new(field.span, format!("\"{found}\" is given twice")));
                    }
                    values.push((name, value));
                }
            }
            _ => return Err(node.mistake(format!("{} stands where a group in parentheses is needed", node.describe()))),
        }
        Ok(Self { what, span: node.span, values })
    }

    /// The value of that name.
    pub(crate) fn get(&self, name: &str) -> Option<&'a Node> {
        self.values.iter().find(|(known, _)| *known == name).map(|(_, value)| *value)
    }

    /// The value of that name, which has to be there.
    pub(crate) fn need(&self, name: &str) -> Result<&'a Node, Mistake> {
        self.get(name).ok_or_else(|| Mistake::new(self.span, format!("{} needs \"{name}\"", self.what)))
    }

    /// Refuses one value if the other is there too.
    pub(crate) fn exclusive(&self, first: &str, second: &str) -> Result<(), Mistake> {
        match (self.get(first), self.get(second)) {
            (Some(_), Some(value)) => Err(value.mistake(format!("\"{second}\" contradicts \"{first}\""))),
            _ => Ok(()),
        }
    }
}
