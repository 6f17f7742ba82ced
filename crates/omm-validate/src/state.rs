//! What earlier calls made, as far as rules need to know it.
//!
//! A program may show its calls from the middle on. What was not seen is not known: a query method then answers `None` or
//! [`Liveness::Unknown`], and a rule stays silent. An object is known once its creation was seen; a handle can be called invalid
//! once the creation of any object of its kind was.
//!
//! | question | method |
//! |---|---|
//! | Does the object live? Of which device is it? | [`liveness`](State::liveness), [`parent`](State::parent) |
//! | What can the device do? | [`features`](State::features), [`features_for`](State::features_for), [`device`](State::device) |
//! | What lies at an address? | [`buffers_at`](State::buffers_at), [`bytes_from`](State::bytes_from), [`memory_behind`](State::memory_behind) |
//! | Is memory bound? Of which kind? | [`is_bound`](State::is_bound), [`buffer_memory`](State::buffer_memory), [`memory`](State::memory) |
//! | What does a structure or micromap hold? | [`AccelerationStructureState::contents`], [`MicromapState::contents`] |
//! | What sizes did the device name? | [`micromap_build_sizes`](State::micromap_build_sizes), [`MicromapContents::serialization_size`] |
//! | Where is a command buffer in its life? | [`command_buffer`](State::command_buffer), [`queue_family`](State::queue_family) |
//! | Is a query available? | [`QueryPoolState::status`] |
//! | Is a deferred command complete? | [`DeferredOperationState::pending`] |
//!
//! Commands recorded into a command buffer act when it is submitted. Rules on what they find then are checked at the submission,
//! each command with the state that those before it leave; rules that ask while a command is recorded use [`State::built`].

mod change;
mod command_buffer;
mod deferred;
mod device;
mod execute;
mod memory;
mod micromap;
mod object;
mod query;
mod sizes;
mod structure;
mod track;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use omm_model::profile::DeviceProfile;
use omm_model::vk;

use crate::location::Object;

pub(crate) use change::Age;
pub use command_buffer::{CommandBufferState, CommandPoolState, RecordingState};
pub use deferred::DeferredOperationState;
pub use device::DeviceState;
pub use memory::{Binding, BufferState, MemorySpan, MemoryState};
pub use micromap::{MicromapBuilt, MicromapContents, MicromapState};
pub use object::Liveness;
pub use query::{QueryPoolState, QueryStatus};
pub use structure::{AccelerationStructureState, Attachment, Built, BuiltGeometry, Contents, Deserialized, Storage};

/// All objects that the calls seen so far have made.
///
/// A submission is looked at on a copy, so what no command changes is shared with it.
#[derive(Clone, Debug)]
pub struct State {
    profile: Arc<DeviceProfile>,
    objects: Arc<BTreeMap<Object, object::ObjectState>>,
    /// The kinds of which a creation was seen.
    seen: BTreeSet<vk::ObjectType>,
    devices: BTreeMap<vk::Device, DeviceState>,
    queues: BTreeMap<vk::Queue, (vk::Device, u32)>,
    buffers: Arc<BTreeMap<vk::Buffer, BufferState>>,
    /// The buffers whose address is known, by address.
    addresses: Arc<BTreeMap<(vk::DeviceAddress, vk::Buffer), u64>>,
    /// Size of the largest buffer that ever had an address: how far back from an address its buffer can begin.
    largest_buffer: u64,
    memories: Arc<BTreeMap<vk::DeviceMemory, MemoryState>>,
    acceleration_structures: BTreeMap<vk::AccelerationStructure, AccelerationStructureState>,
    micromaps: BTreeMap<vk::Micromap, MicromapState>,
    micromap_sizes: Arc<micromap::BuildSizes>,
    structure_sizes: Arc<sizes::StructureSizes>,
    command_pools: BTreeMap<vk::CommandPool, CommandPoolState>,
    command_buffers: BTreeMap<vk::CommandBuffer, CommandBufferState>,
    query_pools: BTreeMap<vk::QueryPool, QueryPoolState>,
    operations: BTreeMap<vk::DeferredOperation, DeferredOperationState>,
    /// What was serialized, by where to.
    serialized: BTreeMap<execute::Place, execute::Serialized>,
    /// Numbers given to contents, so that a query knows whether its object still holds what was measured.
    contents_count: u64,
    /// What was serialized by the submission that is being looked at.
    just_serialized: BTreeSet<execute::Place>,
    /// Number of the call tracked last, and of the last one that changed what recorded commands may find.
    serial: u64,
    changed_at: u64,
    sees_addresses: bool,
    sees_bindings: bool,
}

impl State {
    /// Nothing made yet, on a device like this.
    pub(crate) fn new(profile: &DeviceProfile) -> Self {
        Self {
            profile: Arc::new(profile.clone()),
            objects: Arc::default(),
            seen: BTreeSet::new(),
            devices: BTreeMap::new(),
            queues: BTreeMap::new(),
            buffers: Arc::default(),
            addresses: Arc::default(),
            largest_buffer: 0,
            memories: Arc::default(),
            acceleration_structures: BTreeMap::new(),
            micromaps: BTreeMap::new(),
            micromap_sizes: Arc::default(),
            structure_sizes: Arc::default(),
            command_pools: BTreeMap::new(),
            command_buffers: BTreeMap::new(),
            query_pools: BTreeMap::new(),
            operations: BTreeMap::new(),
            serialized: BTreeMap::new(),
            contents_count: 0,
            just_serialized: BTreeSet::new(),
            serial: 0,
            changed_at: 0,
            sees_addresses: false,
            sees_bindings: false,
        }
    }

    /// The device's limits, features, queues and memory.
    #[must_use]
    pub fn profile(&self) -> &DeviceProfile {
        &self.profile
    }

    /// A buffer.
    #[must_use]
    pub fn buffer(&self, buffer: vk::Buffer) -> Option<&BufferState> {
        self.buffers.get(&buffer)
    }

    /// A memory allocation.
    #[must_use]
    pub fn memory(&self, memory: vk::DeviceMemory) -> Option<&MemoryState> {
        self.memories.get(&memory)
    }

    /// Bytes in a memory allocation.
    #[must_use]
    pub fn memory_size(&self, memory: vk::DeviceMemory) -> Option<u64> {
        self.memory(memory).map(|memory| memory.size)
    }

    /// An acceleration structure.
    #[must_use]
    pub fn acceleration_structure(&self, handle: vk::AccelerationStructure) -> Option<&AccelerationStructureState> {
        self.acceleration_structures.get(&handle)
    }

    /// A micromap object of the EXT extension.
    #[must_use]
    pub fn micromap(&self, handle: vk::Micromap) -> Option<&MicromapState> {
        self.micromaps.get(&handle)
    }

    /// A command pool.
    #[must_use]
    pub fn command_pool(&self, command_pool: vk::CommandPool) -> Option<&CommandPoolState> {
        self.command_pools.get(&command_pool)
    }

    /// A command buffer.
    #[must_use]
    pub fn command_buffer(&self, command_buffer: vk::CommandBuffer) -> Option<&CommandBufferState> {
        self.command_buffers.get(&command_buffer)
    }

    /// A query pool.
    #[must_use]
    pub fn query_pool(&self, query_pool: vk::QueryPool) -> Option<&QueryPoolState> {
        self.query_pools.get(&query_pool)
    }

    /// A deferred operation.
    #[must_use]
    pub fn deferred_operation(&self, operation: vk::DeferredOperation) -> Option<&DeferredOperationState> {
        self.operations.get(&operation)
    }
}
