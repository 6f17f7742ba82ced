//! Values as text, short and with names.

use crate::constant;
use crate::objects::Objects;
use crate::structure;
use crate::tree::Tree;

/// A value as a scenario would write it, cut where it gets long.
pub(crate) fn value(tree: &Tree, objects: &Objects) -> String {
    let mut text = full(tree, objects, 0);
    const LONGEST: usize = 160;
    if let Some((end, _)) = text.char_indices().nth(LONGEST) {
        text.truncate(end);
        text.push('…');
    }
    text
}

fn full(tree: &Tree, objects: &Objects, depth: usize) -> String {
    // Nothing is nested as deep as this.
    if depth > 16 {
        return "…".to_owned();
    }
    let inner = |tree: &Tree| full(tree, objects, depth + 1);
    match tree {
        Tree::Bool(value) => value.to_string(),
        Tree::Integer(number) => number.to_string(),
        Tree::Float(number) => number.to_string(),
        Tree::Text(text) => format!("\"{text}\""),
        Tree::None => "null".to_owned(),
        Tree::Some(body) => inner(body),
        Tree::List(items) => format!("[{}]", items.iter().map(inner).collect::<Vec<_>>().join(", ")),
        Tree::Newtype(name, _) => newtype(name, tree.integer().unwrap_or_default(), objects),
        Tree::Struct(_, fields) => format!("({})", shown(fields, &inner)),
        Tree::Variant("DeviceOrHostAddress", variant, Some(body)) => match (*variant, body.is_zero()) {
            (_, true) => "null".to_owned(),
            ("HostAddress", _) if inner(body).starts_with(|letter: char| letter.is_ascii_digit()) => {
                format!("host({})", inner(body))
            }
            _ => inner(body),
        },
        Tree::Variant(_, variant, body) => {
            let name = structure::chained_name(tree).unwrap_or(variant);
            match body.as_deref() {
                Some(Tree::Struct(_, fields)) => format!("{name}({})", shown(fields, &inner)),
                Some(body) => format!("{name}({})", inner(body)),
                None => name.to_lowercase(),
            }
        }
    }
}

/// The fields of a structure that are not zero.
fn shown(fields: &[(&'static str, Tree)], inner: &dyn Fn(&Tree) -> String) -> String {
    let shown = fields.iter().filter(|(name, field)| *name != "s_type" && !field.is_zero());
    let shown = shown.map(|(name, field)| format!("{}: {}", crate::path::field_name(name, field), inner(field)));
    shown.collect::<Vec<_>>().join(", ")
}

/// A handle, an address, an enumerant or flags.
fn newtype(name: &str, number: i128, objects: &Objects) -> String {
    if let Some(constants) = constant::of_type(name) {
        return constants.show(number);
    }
    let value = u64::try_from(number).unwrap_or_default();
    let named = match name {
        "Bool32" => return number.to_string(),
        _ if number == 0 => return "null".to_owned(),
        "DeviceAddress" => objects.name_of_address(value, false),
        "HostAddress" => objects.name_of_address(value, true),
        _ => objects.name_of_handle(name, value).map(str::to_owned),
    };
    named.unwrap_or_else(|| format!("{value:#x}"))
}
