//! What a scenario writes down as the value that belongs at a place. What the place holds says of which type it is.

use crate::constant::{self, Constants};
use crate::error::Mistake;
use crate::node::{Kind, Node};
use crate::objects::{Objects, Unknown};
use crate::path::{self, Pattern};
use crate::structure;
use crate::tree::Tree;

/// What a value may refer to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Context<'a> {
    /// The call.
    pub(crate) root: &'a Tree,
    pub(crate) objects: &'a Objects,
}

/// The value of a node in a place that holds `like`.
pub(crate) fn value(node: &Node, like: &Tree, context: &Context<'_>) -> Result<Tree, Mistake> {
    if let Some(tree) = special(node, context)? {
        return Ok(match like {
            // Behind a pointer the structure itself is named.
            Tree::None | Tree::Some(_) if !matches!(tree, Tree::None | Tree::Some(_)) => Tree::Some(Box::new(tree)),
            _ => tree,
        });
    }
    match like {
        Tree::Bool(_) => node.boolean().map(Tree::Bool),
        Tree::Integer(_) => integer(node),
        Tree::Float(_) => node.float().map(Tree::Float),
        Tree::Text(_) => node.text().map(|text| Tree::Text(text.to_owned())),
        Tree::None | Tree::Some(_) if node.is_null() => Ok(Tree::None),
        Tree::None => untyped(node, context).map(|tree| Tree::Some(Box::new(tree))),
        Tree::Some(inner) => value(node, inner, context).map(|tree| Tree::Some(Box::new(tree))),
        Tree::List(items) => list(node, items, context),
        Tree::Newtype(name, _) => newtype(node, name, context),
        Tree::Struct(..) => fields(node, like.clone(), context),
        Tree::Variant("DeviceOrHostAddress", variant, _) => address(node, variant, context),
        Tree::Variant("GeometryData", ..) => geometry(node, context),
        Tree::Variant("TieBreak", ..) => tie_break(node),
        Tree::Variant(..) => Err(node.mistake(format!("{} has no place here", node.describe()))),
    }
}

/// Values that say themselves what they are.
fn special(node: &Node, context: &Context<'_>) -> Result<Option<Tree>, Mistake> {
    let (Some(head), Kind::Tuple(..) | Kind::Struct(..)) = (node.head(), &node.kind) else { return Ok(None) };
    let only = || match &node.kind {
        Kind::Tuple(_, values) if values.len() == 1 => values.first().ok_or_else(|| node.mistake("")),
        _ => Err(node.mistake(format!("{head} takes one value"))),
    };
    Ok(Some(match head {
        "same" => same(only()?, context)?,
        "address" => number_of(context.objects.address(only()?.text()?).map(|found| found.value), only()?)?,
        "handle" => {
            let name = only()?.text()?;
            let object = context.objects.get(name).map_err(|unknown| mistake(only_span(node), unknown))?;
            let handle = object.handles.first().map(|(_, handle)| *handle);
            let handle = handle.ok_or_else(|| node.mistake(format!("\"{name}\" has no handle")))?;
            Tree::Integer(handle.into())
        }
        "unknown" => {
            let like = Tree::Newtype("StructureType", Box::new(Tree::Integer(0)));
            let found = value(only()?, &like, context)?.integer().and_then(|number| i32::try_from(number).ok());
            let tree = found.and_then(structure::unknown);
            tree.ok_or_else(|| node.mistake("a structure type has 32 bits"))?
        }
        _ if head.starts_with("Vk") => {
            let empty = structure::named(head).ok_or_else(|| {
                node.mistake(format!("there is no structure {head}")).nearest(head, structure::names())
            })?;
            fields(node, empty, context)?
        }
        _ => return Ok(None),
    }))
}

fn only_span(node: &Node) -> &Node {
    match &node.kind {
        Kind::Tuple(_, values) => values.first().unwrap_or(node),
        _ => node,
    }
}

pub(crate) fn mistake(node: &Node, unknown: Unknown) -> Mistake {
    Mistake { span: node.span, message: unknown.message, help: unknown.help }
}

fn number_of(found: Result<u64, Unknown>, node: &Node) -> Result<Tree, Mistake> {
    found.map(|number| Tree::Integer(number.into())).map_err(|unknown| mistake(node, unknown))
}

/// What another place of the same call holds.
fn same(node: &Node, context: &Context<'_>) -> Result<Tree, Mistake> {
    let (pattern, places) = (Pattern::new(node.text()?), path::places(context.root));
    let found: Vec<_> = places.iter().filter(|place| pattern.matches(&place.path)).collect();
    let [place] = found.as_slice() else {
        let message = format!("{} parameters match", found.len());
        return Err(node.mistake(message).nearest(node.text()?, places.iter().map(|place| place.path.as_str())));
    };
    context.root.at(&place.route).cloned().ok_or_else(|| node.mistake("the call has no such parameter"))
}

fn integer(node: &Node) -> Result<Tree, Mistake> {
    if let Some(name) = node.name() {
        let number = match name {
            "true" => Some(1),
            "false" => Some(0),
            _ => constant::of_any_type(name),
        };
        return number.map(|number| Tree::Integer(number.into())).ok_or_else(|| node.mistake("a number is needed"));
    }
    node.integer().map(Tree::Integer)
}

fn list(node: &Node, items: &[Tree], context: &Context<'_>) -> Result<Tree, Mistake> {
    let element = |node: &Node| match items.first() {
        Some(like) => value(node, like, context),
        None => match special(node, context)? {
            Some(tree) => Ok(tree),
            None => untyped(node, context),
        },
    };
    node.list()?.iter().map(element).collect::<Result<_, _>>().map(Tree::List)
}

/// A value in a place that says nothing of its type.
fn untyped(node: &Node, context: &Context<'_>) -> Result<Tree, Mistake> {
    match &node.kind {
        Kind::Integer(number) => Ok(Tree::Integer(*number)),
        Kind::Float(number) => Ok(Tree::Float(*number)),
        Kind::List(_) => list(node, &[], context),
        Kind::Name(_) if node.is_null() => Ok(Tree::None),
        Kind::Name(_) => integer(node),
        _ => {
            let message = format!("nothing says what {} is here", node.describe());
            Err(node.mistake(message).help("write VkStructure(…), handle(\"…\"), address(\"…\") or same(\"path\")"))
        }
    }
}

/// A handle, an address, an enumerant or flags.
fn newtype(node: &Node, name: &'static str, context: &Context<'_>) -> Result<Tree, Mistake> {
    if let Some(constants) = constant::of_type(name) {
        return enumerant(node, constants).map(|number| wrap(name, number));
    }
    let number: i128 = match (&node.kind, name) {
        (Kind::Integer(number), _) => *number,
        (_, "Bool32") => node.boolean()?.into(),
        (Kind::Name(_), _) if node.is_null() => 0,
        (Kind::Text(text), "DeviceAddress" | "HostAddress") => {
            let found = context.objects.address(text).map_err(|unknown| mistake(node, unknown))?;
            if found.host != (name == "HostAddress") {
                let (is, needed) = if found.host { ("host", "device") } else { ("device", "host") };
                return Err(node.mistake(format!("this lies in {is} memory, an address in {needed} memory is needed")));
            }
            found.value.into()
        }
        (Kind::Text(text), _) => context.objects.handle(name, text).map_err(|unknown| mistake(node, unknown))?.into(),
        _ => return Err(node.mistake(format!("{} is no Vk{name}", node.describe()))),
    };
    Ok(wrap(name, number))
}

/// How a device profile breaks ties between microtriangles.
fn tie_break(node: &Node) -> Result<Tree, Mistake> {
    let names = ["reference", "lowest_index"];
    let found = names.into_iter().find(|name| node.name() == Some(*name));
    let mistake = || node.mistake(format!("{} breaks no ties", node.describe())).nearest(&node.describe(), names);
    found.map(|name| Tree::Variant("TieBreak", name, None)).ok_or_else(mistake)
}

fn wrap(name: &'static str, number: i128) -> Tree {
    Tree::Newtype(name, Box::new(Tree::Integer(number)))
}

/// The value of an enumerant or of flags: a name, names joined by `|` in quotes, a list of names, or a number.
pub(crate) fn enumerant(node: &Node, constants: &Constants) -> Result<i128, Mistake> {
    let named = |name: &str| {
        let value = constants.value(name);
        value.map(i128::from).ok_or_else(|| {
            node.mistake(format!("{name} is no {}", constants.type_name)).nearest(name, constants.short_names())
        })
    };
    match &node.kind {
        Kind::Integer(number) => Ok(*number),
        Kind::Name(name) => named(name),
        Kind::Text(text) if constants.is_flags => {
            text.split('|').map(|part| named(part.trim())).try_fold(0, |all, bit| Ok(all | bit?))
        }
        Kind::Text(text) => named(text),
        Kind::List(nodes) if constants.is_flags => {
            nodes.iter().map(|node| enumerant(node, constants)).try_fold(0, |all, bit| Ok(all | bit?))
        }
        _ => Err(node.mistake(format!("{} is no {}", node.describe(), constants.type_name))),
    }
}

/// An address in either memory; a number stays in the one where the place was.
fn address(node: &Node, variant: &'static str, context: &Context<'_>) -> Result<Tree, Mistake> {
    let (variant, name, number): (_, _, i128) = match (&node.kind, node.head()) {
        (Kind::Tuple(_, values), Some(head @ ("host" | "device"))) => {
            let [number] = values.as_slice() else { return Err(node.mistake(format!("{head} takes one number"))) };
            let variant = if head == "host" { "HostAddress" } else { "DeviceAddress" };
            (variant, variant, number.integer()?)
        }
        (Kind::Text(text), _) => {
            let found = context.objects.address(text).map_err(|unknown| mistake(node, unknown))?;
            let variant = if found.host { "HostAddress" } else { "DeviceAddress" };
            (variant, variant, found.value.into())
        }
        (Kind::Name(_), _) if node.is_null() => (variant, variant, 0),
        _ => (variant, variant, node.integer()?),
    };
    Ok(Tree::Variant("DeviceOrHostAddress", variant, Some(Box::new(wrap(name, number)))))
}

/// The body of a geometry: `none`, `triangles(…)`, `aabbs(…)` or `instances(…)`.
fn geometry(node: &Node, context: &Context<'_>) -> Result<Tree, Mistake> {
    let (variant, structure) = match node.head() {
        Some("none") => return Ok(Tree::Variant("GeometryData", "None", None)),
        Some("triangles") => ("Triangles", "VkAccelerationStructureGeometryTrianglesDataKHR"),
        Some("aabbs") => ("Aabbs", "VkAccelerationStructureGeometryAabbsDataKHR"),
        Some("instances") => ("Instances", "VkAccelerationStructureGeometryInstancesDataKHR"),
        _ => return Err(node.mistake("a geometry is none, triangles(…), aabbs(…) or instances(…)")),
    };
    let empty = structure::named(structure).ok_or_else(|| node.mistake("there is no such structure"))?;
    let body = if node.name().is_some() { empty } else { fields(node, empty, context)? };
    Ok(Tree::Variant("GeometryData", variant, Some(Box::new(body))))
}

/// A structure with some fields changed.
fn fields(node: &Node, mut structure: Tree, context: &Context<'_>) -> Result<Tree, Mistake> {
    let given = match &node.kind {
        Kind::Struct(_, fields) => fields.as_slice(),
        Kind::Tuple(_, values) if values.is_empty() => &[],
        _ => return Err(node.mistake(format!("{} stands where (name: value, …) is needed", node.describe()))),
    };
    for (name, new) in given {
        let Tree::Struct(_, known) = structure.body_mut() else {
            return Err(node.mistake("this is no structure with fields"));
        };
        let is_meant = |(field, old): &&mut (&'static str, Tree)| {
            *field == name.value || path::field_name(field, old) == name.value
        };
        if let Some((_, field)) = known.iter_mut().find(is_meant) {
            *field = value(new, field, context)?;
            continue;
        }
        let names: Vec<String> = known.iter().map(|(field, old)| path::field_name(field, old)).collect();
        let mistake = Mistake::new(name.span, format!("the structure has no \"{}\"", name.value));
        return Err(mistake.nearest(&name.value, names.iter().map(String::as_str)));
    }
    Ok(structure)
}
