//! Reads `vk.xml` and takes from it what the coverage asks for.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::{Document, Node};

use super::coverage::{Coverage, Scope};
use super::extract::{Extract, Member};

/// Where a constant was found.
struct Found<'a> {
    enumeration: &'a str,
    name: &'a str,
    source: Source<'a>,
}

/// What brings a constant into the API.
#[derive(PartialEq)]
enum Source<'a> {
    Definition,
    CoreVersion,
    Extension { name: &'a str, depends: Option<&'a str> },
}

/// An extension in scope, and the one `depends` of its blocks that count, if not all do.
pub(crate) type InScope = (&'static str, Option<&'static str>);

pub(crate) fn extract(text: &str, extensions: &[InScope], coverage: &Coverage) -> Extract {
    let document = Document::parse(text).expect("well-formed XML");
    let root = document.root_element();
    let types = types(root);
    let (values, found) = constants(root);
    let in_scope = |source: &Source| match source {
        Source::Extension { name, depends } => {
            extensions.iter().any(|(extension, only)| extension == name && (only.is_none() || only == depends))
        }
        _ => false,
    };

    let mut extract = Extract::default();
    for block in root.descendants().filter(|node| node.has_tag_name("require")) {
        if !in_scope(&source(block)) {
            continue;
        }
        for node in block.children().filter(|node| node.has_tag_name("type")) {
            let name = node.attribute("name").expect("a name");
            extract.required.insert(name.into(), stands_for(&types, name).into());
        }
    }
    // A constant in scope requires its type, even where the type is older than the extension.
    for constant in found.iter().filter(|constant| in_scope(&constant.source)) {
        let name = constant.enumeration;
        extract.required.insert(name.into(), stands_for(&types, name).into());
    }

    for enumeration in &coverage.enumerations {
        let held: BTreeSet<&str> = enumeration.constants.iter().map(|(name, _)| *name).collect();
        let list = extract.constants.entry(enumeration.name.into()).or_default();
        for constant in found.iter().filter(|constant| constant.enumeration == enumeration.name) {
            let wanted = match (enumeration.scope, &constant.source) {
                (Scope::Whole, _) => true,
                (Scope::Own, Source::Definition | Source::CoreVersion) => true,
                (Scope::Own, Source::Extension { name, .. }) => {
                    extensions.iter().any(|(extension, _)| extension == name)
                }
                (Scope::Named, source) => in_scope(source),
            };
            if wanted || held.contains(constant.name) {
                list.insert(constant.name.into(), value(&values, constant.name));
            }
        }
    }
    for name in coverage.structures.iter().map(|(name, _)| name).chain(coverage.unions.iter().map(|(name, _)| name)) {
        let node = types.get(name).unwrap_or_else(|| panic!("{name} is not in the registry"));
        extract.members.insert((*name).into(), members(*node));
    }
    for (name, _) in &coverage.handles {
        let node = types.get(name).unwrap_or_else(|| panic!("{name} is not in the registry"));
        extract.handles.insert((*name).into(), node.attribute("objtypeenum").expect("an object type").into());
    }
    extract
}

/// Every type by name.
fn types<'a>(root: Node<'a, 'a>) -> BTreeMap<&'a str, Node<'a, 'a>> {
    let list = root.children().find(|node| node.has_tag_name("types")).expect("a list of types");
    let mut types = BTreeMap::new();
    for node in list.children().filter(|node| node.has_tag_name("type") && is_vulkan(*node)) {
        if let Some(name) = name(node) {
            types.insert(name, node);
        }
    }
    types
}

/// The type that stands for this one.
fn stands_for<'a>(types: &BTreeMap<&'a str, Node<'a, 'a>>, name: &'a str) -> &'a str {
    let node = types.get(name).unwrap_or_else(|| panic!("{name} is not in the registry"));
    let next = node.attribute("alias").or(match node.attribute("category") {
        Some("bitmask") => node.attribute("requires").or(node.attribute("bitvalues")),
        _ => None,
    });
    next.map_or(name, |next| stands_for(types, next))
}

/// Every constant's element by name, and all places where constants are brought in.
fn constants<'a>(root: Node<'a, 'a>) -> (BTreeMap<&'a str, Node<'a, 'a>>, Vec<Found<'a>>) {
    let mut values = BTreeMap::new();
    let mut found = Vec::new();
    for node in root.descendants().filter(|node| node.has_tag_name("enum")) {
        let (Some(name), Some(parent)) = (node.attribute("name"), node.parent()) else { continue };
        let enumeration = match node.attribute("extends") {
            None if parent.has_tag_name("enums") => parent.attribute("name"),
            extends => extends,
        };
        let Some(enumeration) = enumeration else { continue };
        let source = source(parent);
        if !node.ancestors().all(is_vulkan) {
            continue;
        }
        values.insert(name, node);
        found.push(Found { enumeration, name, source });
    }
    (values, found)
}

fn source<'a>(block: Node<'a, 'a>) -> Source<'a> {
    let Some(parent) = block.parent() else { return Source::Definition };
    match parent.tag_name().name() {
        "extension" => {
            Source::Extension { name: parent.attribute("name").expect("a name"), depends: block.attribute("depends") }
        }
        "feature" => Source::CoreVersion,
        _ => Source::Definition,
    }
}

/// Whether an element is for Vulkan, and not for Vulkan SC only or disabled.
fn is_vulkan(node: Node) -> bool {
    let listed = |list: &str| list.split(',').any(|api| api == "vulkan" || api == "vulkanbase");
    node.attribute("api").is_none_or(listed) && node.attribute("supported").is_none_or(listed)
}

/// The value of a constant.
fn value(values: &BTreeMap<&str, Node>, name: &str) -> i64 {
    let node = values.get(name).unwrap_or_else(|| panic!("{name} is not in the registry"));
    let number = |text: &str| match text.strip_prefix("0x") {
        Some(digits) => i64::from_str_radix(digits, 16).expect("a number"),
        None => text.parse::<i64>().expect("a number"),
    };
    if let Some(alias) = node.attribute("alias") {
        return value(values, alias);
    }
    if let Some(bit) = node.attribute("bitpos") {
        return 1 << number(bit);
    }
    if let Some(text) = node.attribute("value") {
        return number(text);
    }
    let extension = node
        .attribute("extnumber")
        .or_else(|| node.ancestors().find_map(|node| node.attribute("number")))
        .expect("an extension number");
    let offset = node.attribute("offset").expect("an offset");
    let value = 1_000_000_000 + (number(extension) - 1) * 1000 + number(offset);
    if node.attribute("dir") == Some("-") { -value } else { value }
}

/// The members of a structure or union.
fn members(node: Node) -> Vec<Member> {
    let list = node.children().filter(|node| node.has_tag_name("member") && is_vulkan(*node));
    list.map(|node| Member {
        name: name(node).expect("a name").into(),
        len: node.attribute("len").and_then(|len| len.split(',').next()).filter(|len| is_word(len)).map(Into::into),
        value: node.attribute("values").map(Into::into),
    })
    .collect()
}

/// Whether a length is the name of another member and not a formula.
fn is_word(text: &str) -> bool {
    text.chars().all(|c| c.is_ascii_alphanumeric())
}

/// The name of a type or member, an attribute or an element inside.
fn name<'a>(node: Node<'a, 'a>) -> Option<&'a str> {
    let inside = || node.children().find(|child| child.has_tag_name("name")).and_then(|child| child.text());
    node.attribute("name").or_else(inside)
}
