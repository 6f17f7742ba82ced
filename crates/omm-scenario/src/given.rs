//! Objects as a scenario declares them: one line each, with defaults that make everything valid.

mod bottom_level;
mod bytes;
mod micromap;
mod other;
mod top_level;

use omm_model::vk;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::change::{Context, value};
use crate::error::Mistake;
use crate::node::{Arguments, Node};
use crate::tree::Tree;
use crate::world::{Preparation, Storage, World};

pub(crate) use bytes::bytes;
pub(crate) use micromap::MicromapTriangles;

/// The words that declare objects.
pub(crate) const KINDS: &[&str] = &[
    "micromap",
    "micromap_ext",
    "blas",
    "tlas",
    "structure",
    "structure_ext",
    "blob",
    "buffer",
    "host_memory",
    "query_pool",
    "command_buffer",
];

impl World {
    /// Makes a declared object, as far as `wanted` if it is a structure. Says what it is.
    pub(crate) fn declare(&mut self, name: &str, node: &Node, wanted: Preparation) -> Result<String, Mistake> {
        match node.head() {
            Some("micromap") => self.micromap(name, node, wanted, false),
            Some("micromap_ext") => self.micromap(name, node, wanted, true),
            Some("blas") => self.bottom_level(name, node, wanted),
            Some("tlas") => self.top_level(name, node, wanted),
            Some("structure") => self.empty_structure(name, node, wanted, false),
            Some("structure_ext") => self.empty_structure(name, node, wanted, true),
            Some("blob") => self.blob(name, node),
            Some("buffer") => self.buffer(name, node),
            Some("host_memory") => self.host_memory(name, node),
            Some("query_pool") => self.query_pool(name, node),
            Some("command_buffer") => self.command_buffer(name, node),
            Some(head) if head.starts_with("vk") => self.created_by(name, node),
            head => {
                let message = format!("{} declares no object", node.describe());
                let mistake = node.mistake(message);
                Err(match head {
                    Some(head) => mistake.nearest(head, KINDS.iter().copied()),
                    None => mistake.help("such as micromap([\"TOUu\"])"),
                })
            }
        }
    }

    /// A value of type `T`, written as in a change to a call.
    pub(crate) fn typed<T: Default + Serialize + DeserializeOwned>(&self, node: &Node) -> Result<T, Mistake> {
        self.typed_like(node, &T::default())
    }

    /// The same, where members left out are those of `like`.
    fn typed_like<T: Serialize + DeserializeOwned>(&self, node: &Node, like: &T) -> Result<T, Mistake> {
        let like = Tree::of(like).map_err(|error| node.mistake(error.to_string()))?;
        let context = Context { root: &like, objects: &self.objects };
        value(node, &like, &context)?.to().map_err(|error| node.mistake(error.to_string()))
    }

    /// A value of type `T`, or its default where there is none.
    fn typed_or_default<T: Default + Serialize + DeserializeOwned>(&self, node: Option<&Node>) -> Result<T, Mistake> {
        node.map_or_else(|| Ok(T::default()), |node| self.typed(node))
    }

    /// What a structure's declaration says besides what it is built from: `created_as`, `size` and how far it is prepared.
    fn storage(&self, arguments: &Arguments<'_>, wanted: Preparation) -> Result<(Storage, Preparation), Mistake> {
        let storage = Storage {
            ty: arguments.get("created_as").map(|node| self.typed(node)).transpose()?,
            size: arguments.get("size").map(Node::integer).transpose()?,
        };
        let mut wanted = wanted;
        if let Some(node) = arguments.get("built") {
            wanted = if node.boolean()? { Preparation::Built } else { wanted.min(Preparation::Created) };
        }
        Ok((storage, wanted))
    }

    /// The handle of an acceleration structure of that name; null for none.
    fn acceleration_structure(&self, node: &Node) -> Result<vk::AccelerationStructure, Mistake> {
        self.typed(node)
    }
}

/// `count` of something, with a word that follows the number.
fn counted(count: usize, one: &str, more: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { more })
}
