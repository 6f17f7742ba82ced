//! Changes to a call, by path: a valid call and one change break one rule.

mod memory;
mod value;

use serde::de::DeserializeOwned;

use crate::error::{Mistake, Span, Spanned};
use crate::node::{Kind, Node};
use crate::objects::Objects;
use crate::path::{self, Pattern, Place};
use crate::show;
use crate::tree::Tree;

pub(crate) use memory::Write;
pub(crate) use value::{Context, enumerant, mistake as unknown, value};

/// A change to one place.
#[derive(Clone, Debug, PartialEq)]
struct Change {
    path: Spanned<String>,
    action: Action,
    /// Where the new value stands.
    span: Span,
}

/// What to do at a place.
#[derive(Clone, Debug, PartialEq)]
enum Action {
    Set(Node),
    Remove,
    Push(Node),
}

/// Changes in the order in which they are made.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Changes(Vec<Change>);

/// A call after its changes.
#[derive(Clone, Debug)]
pub(crate) struct Changed<T> {
    pub(crate) value: T,
    /// What memory holds instead, from changes that went on behind an address.
    pub(crate) writes: Vec<Write>,
    /// Each change.
    pub(crate) notes: Vec<Note>,
}

/// A full path and the new value as text.
pub(crate) type Note = (String, String);

impl Changes {
    /// The changes of a map `{"path": value, "path": remove, "path": push(value)}`.
    pub(crate) fn read(node: &Node) -> Result<Self, Mistake> {
        let change = |(key, value): &(Node, Node)| {
            let path = Spanned { value: key.text()?.to_owned(), span: key.span };
            let action = match (&value.kind, value.head()) {
                (Kind::Name(_), Some("remove")) => Action::Remove,
                (Kind::Tuple(_, values), Some("push")) => match values.as_slice() {
                    [pushed] => Action::Push(pushed.clone()),
                    _ => return Err(value.mistake("push takes one value")),
                },
                _ => Action::Set(value.clone()),
            };
            Ok(Change { path, action, span: value.span })
        };
        node.map()?.iter().map(change).collect::<Result<_, _>>().map(Self)
    }

    /// Makes the changes to the tree of a `T`.
    pub(crate) fn apply<T: DeserializeOwned>(&self, mut tree: Tree, objects: &Objects) -> Result<Changed<T>, Mistake> {
        let (mut writes, mut notes) = (Vec::new(), Vec::new());
        for change in &self.0 {
            let places = path::places(&tree);
            let place = match find(&places, &change.path) {
                Ok(place) => place,
                Err(no_place) => {
                    // The path may go on behind an address.
                    let Some((write, note)) = memory::element(&tree, &places, change, objects)? else {
                        return Err(no_place);
                    };
                    writes.push(write);
                    notes.push(note);
                    continue;
                }
            };
            let shown = change.make(&mut tree, place, objects)?;
            if let Err(error) = tree.to::<T>() {
                return Err(Mistake::new(change.span, format!("this has no place there: {error}")));
            }
            notes.push((place.path.clone(), shown));
        }
        let span = self.0.first().map_or_else(Span::default, |change| change.span);
        let value = tree.to().map_err(|error| Mistake::new(span, error.to_string()))?;
        Ok(Changed { value, writes, notes })
    }
}

/// The one place that is meant.
fn find<'p>(places: &'p [Place], path: &Spanned<String>) -> Result<&'p Place, Mistake> {
    let pattern = Pattern::new(&path.value);
    let found: Vec<&Place> = places.iter().filter(|place| pattern.matches(&place.path)).collect();
    match found.as_slice() {
        [only] => Ok(only),
        [] => {
            let mistake = Mistake::new(path.span, "the call has no such parameter");
            if path.value.ends_with("Count") {
                return Err(mistake.help("counts are the lengths of their arrays: change the array"));
            }
            let last = |path: &str| path.rsplit(['.', '…']).next().unwrap_or_default().to_owned();
            if pattern.is_exact() {
                return Err(mistake.nearest(&path.value, places.iter().map(|place| place.path.as_str())));
            }
            let names: Vec<String> = places.iter().map(|place| last(&place.path)).collect();
            let mistake = mistake.nearest(&last(&path.value), names.iter().map(String::as_str));
            Err(mistake)
        }
        [first, second, ..] => {
            let message = format!("{} parameters match", found.len());
            Err(Mistake::new(path.span, message).help(format!("such as {} and {}", first.path, second.path)))
        }
    }
}

impl Change {
    /// Makes the change; says what the place holds now.
    fn make(&self, tree: &mut Tree, place: &Place, objects: &Objects) -> Result<String, Mistake> {
        let lost = || Mistake::new(self.path.span, "the call has no such parameter");
        let context = Context { root: tree, objects };
        let old = tree.at(&place.route).ok_or_else(lost)?;
        match &self.action {
            Action::Set(node) => {
                let new = value(node, old, &context)?;
                let shown = show::value(&new, objects);
                *tree.at_mut(&place.route).ok_or_else(lost)? = new;
                Ok(shown)
            }
            Action::Push(node) => {
                let new = match old.body() {
                    Tree::List(items) => match items.last() {
                        Some(last) => value(node, last, &context)?,
                        None => value(node, &Tree::None, &context)?,
                    },
                    Tree::None => value(node, &Tree::None, &context)?,
                    _ => return Err(Mistake::new(self.path.span, "only an array can be pushed to")),
                };
                let shown = format!("one more: {}", show::value(&new, objects));
                let new = match new {
                    // A value without a type came with a pointer to it.
                    Tree::Some(inner) if matches!(old.body(), Tree::List(_) | Tree::None) => *inner,
                    new => new,
                };
                let slot = tree.at_mut(&place.route).ok_or_else(lost)?;
                match slot.body_mut() {
                    Tree::List(items) => items.push(new),
                    none => *none = Tree::Some(Box::new(Tree::List(vec![new]))),
                }
                Ok(shown)
            }
            Action::Remove => {
                let (last, parent) = place.route.split_last().ok_or_else(lost)?;
                if let Some(Tree::List(items)) = tree.at_mut(parent).map(Tree::body_mut) {
                    if *last < items.len() {
                        items.remove(*last);
                    }
                } else {
                    match tree.at_mut(&place.route).ok_or_else(lost)? {
                        Tree::List(items) => items.clear(),
                        optional @ (Tree::Some(_) | Tree::None) => *optional = Tree::None,
                        _ => {
                            let message = "only pointers, arrays and their elements can be removed";
                            return Err(Mistake::new(self.path.span, message));
                        }
                    }
                }
                Ok("removed".to_owned())
            }
        }
    }
}

#[cfg(test)]
mod tests;
