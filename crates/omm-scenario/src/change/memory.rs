//! Paths that go on behind an address, as those of reports on the contents of memory do: `…triangleArray[2].format`.

use super::{Action, Change, Note, find};
use crate::error::{Mistake, Spanned};
use crate::node::{Kind, Node};
use crate::objects::Objects;
use crate::path::Place;
use crate::tree::Tree;

/// Bytes that a buffer holds instead of what it held.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Write {
    /// The device address of the first.
    pub(crate) address: u64,
    pub(crate) bytes: Vec<u8>,
}

/// Where in memory the elements of an array lie.
struct Layout {
    /// Bytes from one to the next.
    stride: u64,
    /// Offset and size of what is meant in an element.
    offset: u64,
    size: usize,
}

/// The bytes that a change means, if its path leads to an array in memory, and the change as text.
pub(super) fn element(
    tree: &Tree,
    places: &[Place],
    change: &Change,
    objects: &Objects,
) -> Result<Option<(Write, Note)>, Mistake> {
    let path = &change.path.value;
    let mistake = |message: &str| Mistake::new(change.path.span, message);
    for (at, _) in path.match_indices('[').collect::<Vec<_>>().into_iter().rev() {
        let (array, rest) = path.split_at(at);
        let array = Spanned { value: array.to_owned(), span: change.path.span };
        let Ok(place) = find(places, &array) else { continue };
        let Some(address) = tree.at(&place.route).filter(|tree| is_address(tree)).and_then(Tree::integer) else {
            continue;
        };
        let Some((index, member)) = rest.strip_prefix('[').and_then(|rest| rest.split_once(']')) else { continue };
        let index: u64 = index.parse().map_err(|_| mistake("an index is a number"))?;
        let Action::Set(node) = &change.action else { return Err(mistake("memory can only be set")) };
        let name = place.path.rsplit('.').next().unwrap_or_default();
        let parent = place.route.split_last().and_then(|(_, parent)| tree.at(parent));
        let layout = parent.and_then(|parent| layout(parent, name, member.trim_start_matches(['.', '-', '>'])));
        let layout = layout.ok_or_else(|| mistake("nothing is known about these elements"))?;
        let offset = index.checked_mul(layout.stride).and_then(|offset| offset.checked_add(layout.offset));
        let address = u64::try_from(address).ok().zip(offset).and_then(|(address, offset)| address.checked_add(offset));
        let address = address.ok_or_else(|| mistake("this is no address of 64 bits"))?;
        let value = number(node, layout.size, objects)?;
        let mut bytes = value.to_le_bytes().to_vec();
        bytes.truncate(layout.size);
        let note = (format!("{}{rest}", place.path), node.describe());
        return Ok(Some((Write { address, bytes }, note)));
    }
    Ok(None)
}

fn is_address(tree: &Tree) -> bool {
    match tree {
        Tree::Newtype("DeviceAddress", _) => true,
        Tree::Variant("DeviceOrHostAddress", variant, _) => *variant == "DeviceAddress",
        _ => false,
    }
}

/// Where the elements of the array in field `name` of a structure lie, and one member of theirs.
fn layout(parent: &Tree, name: &str, member: &str) -> Option<Layout> {
    let field = |name: &str| parent.field(name).and_then(Tree::integer).and_then(|number| u64::try_from(number).ok());
    let index_size = || {
        let ty = field("index_type").and_then(|ty| i32::try_from(ty).ok())?;
        omm_model::vk::IndexType(ty).size().filter(|size| *size > 0)
    };
    let (stride, offset, size) = match (name, member) {
        ("triangleArray", "dataOffset") => (field("triangle_array_stride")?, 0, 4),
        ("triangleArray", "subdivisionLevel") => (field("triangle_array_stride")?, 4, 2),
        ("triangleArray", "format") => (field("triangle_array_stride")?, 6, 2),
        ("indexBuffer", "") => (field("index_stride")?, 0, index_size()?),
        ("indexData", "") => (index_size()?.into(), 0, index_size()?),
        // Of instances, whose structure has this field; other data is bytes.
        ("data", "accelerationStructureReference") => (64, 56, 8),
        ("data", "") if field("array_of_pointers").is_none() && field("stride").is_none() => (1, 0, 1),
        _ => return None,
    };
    Some(Layout { stride, offset, size: size as usize })
}

/// A number of so many bytes: itself, the letter of a special index, or an object's address.
fn number(node: &Node, size: usize, objects: &Objects) -> Result<i128, Mistake> {
    let bits = 8 * size as u32;
    let number = match &node.kind {
        Kind::Name(name) => match name.as_str() {
            "T" => -1,
            "O" => -2,
            "u" => -3,
            "U" => -4,
            name => match crate::constant::of_any_type(name) {
                Some(number) => number.into(),
                None => return Err(node.mistake("this is a number, or one of the special indices T, O, u and U")),
            },
        },
        Kind::Text(text) => {
            let found = objects.address(text).map_err(|unknown| super::value::mistake(node, unknown))?;
            found.value.into()
        }
        _ => node.integer()?,
    };
    if !(-(1_i128 << (bits - 1))..1 << bits).contains(&number) {
        return Err(node.mistake(format!("{number} does not fit into {bits} bits")));
    }
    Ok(number)
}
