//! Names that are like another one.

use std::collections::BTreeSet;

/// Names listed in a message besides the nearest one.
const LISTED: usize = 8;

/// The names that `found` may have been meant to be, the nearest first.
///
/// ```
/// let commands = ["build", "built", "copy"];
/// assert_eq!(omm_scenario::names_like("biuld", commands), ["build", "built"]);
/// assert!(omm_scenario::names_like("serialize", commands).is_empty());
/// ```
#[must_use]
pub fn names_like<'a>(found: &str, names: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let names = by_distance(found, names);
    names.into_iter().filter(|(distance, _)| *distance <= tolerance(found)).map(|(_, name)| name).collect()
}

/// How many letters may be wrong.
fn tolerance(found: &str) -> usize {
    2 + found.chars().count() / 3
}

/// Each name once with its distance from `found`, the nearest first.
fn by_distance<'a>(found: &str, names: impl IntoIterator<Item = &'a str>) -> Vec<(usize, &'a str)> {
    let mut names: Vec<(usize, &str)> = names.into_iter().map(|name| (distance(found, name), name)).collect();
    // The names come in an order that means something; sorting keeps it among equals.
    names.sort_by_key(|(distance, _)| *distance);
    let mut seen = BTreeSet::new();
    names.retain(|(_, name)| seen.insert(*name));
    names
}

/// A sentence that offers the name nearest to `found`, and lists the others; `None` if there are none.
pub(crate) fn among<'a>(found: &str, names: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let names = by_distance(found, names);
    let (nearest, name) = *names.first()?;
    let mut text = String::new();
    if nearest <= tolerance(found) {
        text = format!("did you mean \"{name}\"? ");
    }
    let listed: Vec<_> = names.iter().take(LISTED).map(|(_, name)| format!("\"{name}\"")).collect();
    let more = names.len().saturating_sub(LISTED);
    text += &match (listed.as_slice(), more) {
        ([only], 0) => format!("There is {only}"),
        ([first @ .., last], 0) => format!("There are {} and {last}", first.join(", ")),
        (all, more) => format!("There are {} and {more} more", all.join(", ")),
    };
    Some(text)
}

/// How many letters have to be put in, left out or replaced to make one of the other. Long texts are compared by their ends.
fn distance(a: &str, b: &str) -> usize {
    const COMPARED: usize = 100;
    let letters = |text: &str| -> Vec<char> { text.chars().rev().take(COMPARED).collect() };
    let (a, b) = (letters(a), letters(b));
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        let mut diagonal = i;
        let mut left = i + 1;
        for (cell, y) in row.iter_mut().skip(1).zip(&b) {
            let value = (diagonal + usize::from(x != y)).min(left + 1).min(*cell + 1);
            diagonal = *cell;
            left = value;
            *cell = value;
        }
        if let Some(first) = row.first_mut() {
            *first = i + 1;
        }
    }
    row.last().copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances() {
        assert_eq!(distance("", ""), 0);
        assert_eq!(distance("", "abc"), 3);
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(distance("crad", "card"), 2);
    }

    #[test]
    fn what_is_offered() {
        assert_eq!(among("x", []), None);
        assert_eq!(among("build", ["built"]).unwrap(), "did you mean \"built\"? There is \"built\"");
        assert_eq!(among("zzzzzz", ["a", "b"]).unwrap(), "There are \"a\" and \"b\"");
        let many: Vec<String> = (0..20).map(|number| format!("name {number}")).collect();
        assert!(among("name", many.iter().map(String::as_str)).unwrap().ends_with("and 12 more"));
    }
}
