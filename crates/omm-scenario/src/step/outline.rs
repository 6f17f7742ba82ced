//! Steps looked at from outside: their titles, how many there are, what they make.

use super::OBJECT;
use crate::node::{Arguments, Kind, Node};

/// The changes of a step.
pub(super) fn set(node: &Node) -> Option<&Node> {
    match &node.kind {
        // A map among the values in order can be nothing else.
        Kind::Tuple(_, values) => values.iter().find(|value| matches!(value.kind, Kind::Map(_))),
        Kind::Struct(_, fields) => fields.iter().find(|(name, _)| name.value == "set").map(|(_, value)| value),
        _ => None,
    }
}

/// A step in short: the word and the objects that it names.
pub(super) fn title(node: &Node) -> String {
    let mut words = vec![node.head().unwrap_or_default().to_owned()];
    let mut add = |value: &Node| match &value.kind {
        Kind::Text(text) => words.push(text.clone()),
        Kind::Name(name) => words.push(name.clone()),
        Kind::List(nodes) if nodes.iter().all(|node| node.text().is_ok()) => {
            words.extend(nodes.iter().filter_map(|node| node.text().ok()).map(str::to_owned));
        }
        Kind::List(nodes) => words.push(nodes.iter().map(title).collect::<Vec<_>>().join(", ")),
        Kind::Tuple(Some(_), _) | Kind::Struct(Some(_), _) => words.push(title(value)),
        _ => {}
    };
    match &node.kind {
        Kind::Tuple(_, values) => values.iter().take(4).for_each(&mut add),
        Kind::Struct(_, fields) => fields.iter().take(4).for_each(|(_, value)| add(value)),
        _ => {}
    }
    words.join(" ")
}

/// The steps inside a step.
fn inner(step: &Node) -> &[Node] {
    let (names, first): (&'static [&'static str], _) = match step.head() {
        Some("record") => (&["steps"], "steps"),
        Some("only" | "indirect") => (&["step"], "step"),
        Some("host") => (&["step", "operation"], "step"),
        _ => return &[],
    };
    let arguments = Arguments::of(step, names).ok();
    arguments.and_then(|arguments| arguments.get(first)).map(Node::one_or_more).unwrap_or_default()
}

/// The objects that the steps create or build, which are then not made before.
pub(crate) fn made_by(steps: &[Node], found: &mut Vec<(String, &'static str)>) {
    for step in steps {
        made_by(inner(step), found);
        let word = match step.head() {
            Some("build") => "build",
            Some("create") => "create",
            _ => continue,
        };
        let Some(names) = Arguments::of(step, OBJECT).ok().and_then(|arguments| arguments.get("object")) else {
            continue;
        };
        let names = names.one_or_more().iter().filter_map(|name| name.text().ok());
        found.extend(names.map(|name| (name.to_owned(), word)));
    }
}

/// How many steps there are, those inside others included.
pub(crate) fn count(steps: &[Node]) -> usize {
    steps.iter().map(|step| 1 + count(inner(step))).sum()
}
