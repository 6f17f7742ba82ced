//! Objects that are not built: empty structures, serialized data, buffers, pools, and whatever else a command creates.

use omm_model::call::{Call, Output};
use omm_model::vk;

use crate::change::Changes;
use crate::command;
use crate::error::Mistake;
use crate::node::{Arguments, Node};
use crate::objects::Object;
use crate::tree::Tree;
use crate::world::{BufferRequest, DEVICE, INPUT, Preparation, World};

impl World {
    /// `structure(type, size)` and `structure_ext(size)`: created, and nothing in it.
    pub(super) fn empty_structure(
        &mut self,
        name: &str,
        node: &Node,
        wanted: Preparation,
        is_ext: bool,
    ) -> Result<String, Mistake> {
        let names: &[&str] = if is_ext { &["size"] } else { &["type", "size"] };
        let arguments = Arguments::of(node, names)?;
        let ty = match is_ext {
            true => vk::AccelerationStructureType::OPACITY_MICROMAP,
            false => self.typed(arguments.need("type")?)?,
        };
        let size = arguments.get("size").map_or(Ok(4096), Node::integer)?;
        self.make_empty(name, ty, is_ext, size, wanted.min(Preparation::Created), node)?;
        Ok(format!("empty {} of {size} bytes", if is_ext { "EXT micromap" } else { "structure" }))
    }

    /// `blob(of)`: the serialized form of a structure, in a buffer.
    pub(super) fn blob(&mut self, name: &str, node: &Node) -> Result<String, Mistake> {
        let arguments = Arguments::of(node, &["of"])?;
        let of = arguments.need("of")?;
        let source = of.text()?;
        let Some(object) = self.built(source, of)? else {
            return Err(of.mistake(format!("\"{source}\" holds nothing to serialize")));
        };
        let profile = self.profile();
        let bytes = omm_serialize::serialize_object(object.as_bytes(), profile.driver_uuid, profile.compatibility_uuid);
        let bytes = bytes.map_err(|error| of.mistake(error.to_string()))?;
        let request = BufferRequest::new(name, bytes.len() as u64, INPUT);
        let range = self.make_buffer(&request, node)?;
        self.write(range.address, &bytes, node)?;
        Ok(format!("{source} serialized"))
    }

    /// `buffer(size, bytes, usage, flags, memory_type, bound)`
    pub(super) fn buffer(&mut self, name: &str, node: &Node) -> Result<String, Mistake> {
        let arguments = Arguments::of(node, &["size", "bytes", "usage", "flags", "memory_type", "bound"])?;
        let bytes = arguments.get("bytes").map(|node| super::bytes(node, &self.objects)).transpose()?;
        let length = bytes.as_ref().map_or(0, |bytes| bytes.len() as u64);
        let size = arguments.get("size").map_or(Ok(if length == 0 { 256 } else { length }), Node::integer)?;
        let usual = INPUT
            | vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::TRANSFER_SRC
            | vk::BufferUsageFlags::TRANSFER_DST
            | vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE
            | vk::BufferUsageFlags::MICROMAP_STORAGE
            | vk::BufferUsageFlags::INDIRECT_BUFFER;
        let usage = arguments.get("usage").map_or(Ok(usual), |node| self.typed(node))?;
        let flags = self.typed_or_default(arguments.get("flags"))?;
        let memory_type = arguments.get("memory_type").map(Node::integer).transpose()?;
        let bound = arguments.get("bound").map_or(Ok(true), Node::boolean)?;
        let range = self.make_buffer(&BufferRequest { name, size, usage, flags, memory_type, bound }, node)?;
        if let Some(bytes) = bytes {
            self.write(range.address, &bytes, node)?;
        }
        Ok(format!("buffer of {size} bytes{}", if bound { "" } else { ", not bound" }))
    }

    /// `host_memory(bytes)`: memory of the application, which host commands read and write.
    pub(super) fn host_memory(&mut self, name: &str, node: &Node) -> Result<String, Mistake> {
        let bytes = super::bytes(Arguments::of(node, &["bytes"])?.need("bytes")?, &self.objects)?;
        self.host_memory_of(name, &bytes, node)?;
        Ok(format!("{} in host memory", super::counted(bytes.len(), "byte", "bytes")))
    }

    /// `query_pool(type, count)`
    pub(super) fn query_pool(&mut self, name: &str, node: &Node) -> Result<String, Mistake> {
        let arguments = Arguments::of(node, &["type", "count"])?;
        let usual = vk::QueryType::ACCELERATION_STRUCTURE_SIZE;
        let query_type = arguments.get("type").map_or(Ok(usual), |node| self.typed(node))?;
        let query_count: u32 = arguments.get("count").map_or(Ok(1), Node::integer)?;
        let query_pool = vk::QueryPool(self.handle());
        let create_info = vk::QueryPoolCreateInfo { query_type, query_count, ..Default::default() };
        self.prepare(&Call::CreateQueryPool { device: DEVICE, create_info, query_pool }, node)?;
        self.objects.insert(Object { name: name.to_owned(), handles: vec![("QueryPool", query_pool.0)], place: None });
        Ok(format!("pool of {}", super::counted(query_count as usize, "query", "queries")))
    }

    /// `command_buffer(level, queue_family, recording)`
    pub(super) fn command_buffer(&mut self, name: &str, node: &Node) -> Result<String, Mistake> {
        let arguments = Arguments::of(node, &["level", "queue_family", "recording"])?;
        let level: vk::CommandBufferLevel = self.typed_or_default(arguments.get("level"))?;
        let queue_family_index = arguments.get("queue_family").map_or(Ok(0), Node::integer)?;
        let recording = arguments.get("recording").map_or(Ok(false), Node::boolean)?;
        let command_pool = vk::CommandPool(self.handle());
        let flags = vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER;
        let create_info = vk::CommandPoolCreateInfo { flags, queue_family_index, ..Default::default() };
        self.prepare(&Call::CreateCommandPool { device: DEVICE, create_info, command_pool }, node)?;
        let command_buffer = vk::CommandBuffer(self.handle());
        let allocate_info =
            vk::CommandBufferAllocateInfo { command_pool, level, command_buffer_count: 1, ..Default::default() };
        let command_buffers = vec![command_buffer];
        self.prepare(&Call::AllocateCommandBuffers { device: DEVICE, allocate_info, command_buffers }, node)?;
        if recording {
            let secondary = level == vk::CommandBufferLevel::SECONDARY;
            let inheritance_info = secondary.then(vk::CommandBufferInheritanceInfo::default);
            let begin_info = vk::CommandBufferBeginInfo { inheritance_info, ..Default::default() };
            self.prepare(&Call::BeginCommandBuffer { command_buffer, begin_info }, node)?;
        }
        let handles = vec![("CommandBuffer", command_buffer.0), ("CommandPool", command_pool.0)];
        self.objects.insert(Object { name: name.to_owned(), handles, place: None });
        Ok(format!("command buffer{}", if recording { ", recording" } else { "" }))
    }

    /// `vkCreate…({"path": value})`: what the command creates.
    pub(super) fn created_by(&mut self, name: &str, node: &Node) -> Result<String, Mistake> {
        let (call, handle) = self.raw_call(node, vk::CommandBuffer::NULL)?;
        let output = self.prepare(&call, node)?;
        self.name_created(name, &call, handle, &output);
        Ok(format!("made by {}", call.command()))
    }

    /// The call of `vkCommand({"path": value})`, and the handle that a new object gets. Changes are part of the record.
    pub(crate) fn raw_call(&mut self, node: &Node, command_buffer: vk::CommandBuffer) -> Result<(Call, u64), Mistake> {
        let head = node.head().unwrap_or_default();
        let handle = self.handle();
        let call = command::named(head, handle, command_buffer)
            .ok_or_else(|| node.mistake(format!("there is no command {head}")).nearest(head, command::names()))?;
        let arguments = Arguments::of(node, &["set", "name"])?;
        Ok((self.changed(call, arguments.get("set"), node)?, handle))
    }

    /// A call with changes; what they change in memory is written.
    pub(crate) fn changed(&mut self, call: Call, changes: Option<&Node>, node: &Node) -> Result<Call, Mistake> {
        let Some(changes) = changes else { return Ok(call) };
        let tree = Tree::of(&call).map_err(|error| node.mistake(error.to_string()))?;
        let changed = Changes::read(changes)?.apply::<Call>(tree, &self.objects)?;
        self.group.changes.extend(changed.notes);
        for write in changed.writes {
            self.write(write.address, &write.bytes, changes)?;
        }
        Ok(changed.value)
    }

    /// Remembers what a command created under a name: the object whose handle is new.
    pub(crate) fn name_created(&mut self, name: &str, call: &Call, handle: u64, output: &Output) {
        fn type_of(tree: &Tree, handle: u64) -> Option<&'static str> {
            match tree {
                Tree::Newtype(type_name, inner) if inner.integer() == Some(handle.into()) => Some(type_name),
                Tree::List(items) => items.iter().find_map(|item| type_of(item, handle)),
                _ => None,
            }
        }
        if matches!(output, Output::Result(result) if result.is_error()) {
            return;
        }
        let Ok(tree) = Tree::of(call) else { return };
        let Tree::Struct(_, fields) = tree.body() else { return };
        if let Some(type_name) = fields.iter().find_map(|(_, field)| type_of(field, handle)) {
            self.objects.insert(Object { name: name.to_owned(), handles: vec![(type_name, handle)], place: None });
        }
    }
}
