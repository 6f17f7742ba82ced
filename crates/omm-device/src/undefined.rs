//! Why the device stopped: what a call leaves undefined, or what the device does not simulate.

use std::fmt;

use omm_layout::error::ReadError;
use omm_layout::object::ObjectKind;
use omm_model::level::SubdivisionLevelError;
use omm_model::memory::MemoryError;
use omm_model::profile::Uuid;
use omm_model::triangle::MicromapTriangleError;
use omm_model::vk;

mod stop;

pub(crate) use stop::{At, Stop};

/// A call to which the device cannot give a meaning, because the specification gives it none.
///
/// The device is as it was before the call: a submission that stops at its third command leaves no trace of the first two.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Undefined {
    /// The command that could not be executed, such as `vkCmdBuildAccelerationStructuresKHR`. For a recorded command it is that
    /// command, not the submission.
    pub command: &'static str,
    /// Which of the submitted commands it was; `None` for a command that acts at once or was only being recorded.
    pub submitted: Option<Submitted>,
    /// The parameter at fault under its name in the API, such as `pInfos[0].pGeometries[1].geometry.triangles.indexData`; empty
    /// where the command as a whole is.
    pub at: String,
    /// What is wrong, with the values.
    pub why: Reason,
}

/// The place of a recorded command in a submission, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Submitted {
    /// Which of the submitted command buffers.
    pub command_buffer: usize,
    /// Which of the commands recorded into it.
    pub command: usize,
}

impl Undefined {
    /// Whether the call is meaningful to the specification and only this device does not simulate it.
    #[must_use]
    pub const fn is_unsupported(&self) -> bool {
        matches!(self.why, Reason::Unsupported { .. })
    }
}

impl fmt::Display for Undefined {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { command, submitted, at, why } = self;
        write!(f, "{command}")?;
        if let Some(Submitted { command_buffer, command }) = submitted {
            write!(f, " (command {command} of pCommandBuffers[{command_buffer}])")?;
        }
        if !at.is_empty() {
            write!(f, ": {at}")?;
        }
        write!(f, ": {why}")
    }
}

impl std::error::Error for Undefined {}

/// What a call leaves undefined.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Reason {
    /// A handle that names no object, null included where an object is needed.
    #[error("there is no {object} {handle:#x}")]
    UnknownHandle {
        /// The kind of object.
        object: &'static str,
        /// The handle.
        handle: u64,
    },
    /// A command that creates an object names a handle that is taken, or null.
    #[error("a new {object} cannot have the handle {handle:#x}, which is null or taken")]
    HandleTaken {
        /// The kind of object.
        object: &'static str,
        /// The handle.
        handle: u64,
    },
    /// An enumerant without a meaning here.
    #[error("the value {found} has no meaning here")]
    UnknownValue {
        /// The value.
        found: i64,
    },
    /// A null pointer, or a structure missing from a chain, where something has to be read.
    #[error("{what} is missing")]
    Missing {
        /// What should be there.
        what: &'static str,
    },
    /// Arrays of different lengths where one belongs to the other.
    #[error("{found} elements where {required} are needed")]
    CountMismatch {
        /// Elements given.
        found: u64,
        /// Elements needed.
        required: u64,
    },
    /// A buffer is bound a second time.
    #[error("buffer {buffer:#x} is already bound to memory")]
    AlreadyBound {
        /// The buffer.
        buffer: u64,
    },
    /// The address of a buffer without memory.
    #[error("buffer {buffer:#x} is not bound to memory")]
    NotBound {
        /// The buffer.
        buffer: u64,
    },
    /// A range that does not lie within the object it is a range of.
    #[error("{size} bytes from offset {offset} on do not fit into {limit} bytes")]
    OutsideObject {
        /// First byte of the range.
        offset: u64,
        /// Bytes of the range.
        size: u64,
        /// Bytes of the buffer or memory.
        limit: u64,
    },
    /// An indirect build with more primitives than it was announced to have.
    #[error("{found} primitives where at most {limit} were announced")]
    TooManyPrimitives {
        /// Primitives in the build range.
        found: u32,
        /// Primitives announced.
        limit: u32,
    },
    /// A device address in no buffer, or too close to a buffer's end.
    #[error(transparent)]
    Memory(#[from] MemoryError),
    /// Address and offsets add up to more than 64 bits.
    #[error("{offset} bytes beyond address {address:#x} the address space has ended")]
    AddressOverflow {
        /// The address.
        address: u64,
        /// What is added to it.
        offset: u64,
    },
    /// An address in host memory given to a command that runs on the device.
    #[error("{address:#x} is an address in host memory, which the device cannot reach")]
    HostAddress {
        /// The address.
        address: u64,
    },
    /// A device address given to a command that runs on the host.
    #[error("{address:#x} is an address in device memory, which a host command cannot reach")]
    DeviceAddress {
        /// The address.
        address: u64,
    },
    /// A host command on an object in memory that the host cannot map.
    #[error("memory {memory:#x} is not visible to the host, which would have to access it")]
    NotHostVisible {
        /// The memory.
        memory: u64,
    },
    /// A command that cannot build what it is asked for, though another can.
    #[error("this command cannot build {what}")]
    WrongCommand {
        /// What would have to be built.
        what: &'static str,
    },
    /// An operation that is needed for something else while a command is still deferred on it.
    #[error("a command is still pending on deferred operation {operation:#x}")]
    OperationPending {
        /// The operation.
        operation: u64,
    },
    /// A primary command buffer where a secondary one is needed, or the other way round.
    #[error("command buffer {command_buffer:#x} has level {}, not {}", named(found.name(), found.0), named(required.name(), required.0))]
    CommandBufferLevel {
        /// The command buffer.
        command_buffer: u64,
        /// Its level.
        found: vk::CommandBufferLevel,
        /// The level that the command needs.
        required: vk::CommandBufferLevel,
    },
    /// A pipeline or shader made for geometry without a mixture traces against a geometry whose micromap indices are special
    /// for some triangles and not for others.
    #[error("geometry {geometry} of the structure at {address:#x} mixes special indices with others")]
    MixedSpecialIndices {
        /// Address of the bottom-level structure.
        address: u64,
        /// The geometry in it.
        geometry: u32,
    },
    /// A command buffer in the wrong state of its life cycle.
    #[error("command buffer {command_buffer:#x} is in the {found} state, not in the {required} state")]
    CommandBufferState {
        /// The command buffer.
        command_buffer: u64,
        /// Its state.
        found: crate::CommandBufferState,
        /// The state that the command needs.
        required: crate::CommandBufferState,
    },
    /// A range of queries that goes beyond the pool.
    #[error("queries {first} to {first}+{count} of a pool of {limit}")]
    OutsideQueryPool {
        /// First query.
        first: u32,
        /// Number of queries.
        count: u64,
        /// Queries in the pool.
        limit: u32,
    },
    /// The pool's queries are of another type than the command writes.
    #[error("the pool's queries are of type {}, those of the command of type {}", named(found.name(), found.0), named(required.name(), required.0))]
    QueryType {
        /// The pool's type.
        found: vk::QueryType,
        /// The command's type.
        required: vk::QueryType,
    },
    /// A query in the wrong state: written before it was reset, or read before it was ever reset.
    #[error("query {query} {found}")]
    QueryState {
        /// The query.
        query: u32,
        /// What is wrong with its state, in words.
        found: &'static str,
    },
    /// Waiting for a query that nothing pending will write.
    #[error("query {query} is waited for, but no submitted command writes it")]
    WaitsForever {
        /// The query.
        query: u32,
    },
    /// What is written does not fit where it goes.
    #[error("{required} bytes are needed, {available} are there")]
    TooSmall {
        /// Bytes needed.
        required: u64,
        /// Bytes there.
        available: u64,
    },
    /// An acceleration structure or micromap that nothing was ever built or copied into, or whose bytes were overwritten.
    #[error("{object} {handle:#x} holds nothing built: {error}")]
    NotConstructed {
        /// The kind of object that the handle names.
        object: &'static str,
        /// The structure.
        handle: u64,
        /// What its bytes lack.
        error: Box<ReadError>,
    },
    /// A structure of one kind where another is needed.
    #[error("{object} {handle:#x} holds a {}, not a {}", name(*.found), name(*.required))]
    WrongKind {
        /// The kind of object that the handle names.
        object: &'static str,
        /// The structure.
        handle: u64,
        /// What it holds.
        found: ObjectKind,
        /// What is needed.
        required: ObjectKind,
    },
    /// A structure that was created to hold another kind of object.
    #[error("{object} {handle:#x} was created as a {} and cannot become a {}", name(*.found), name(*.required))]
    CreatedAs {
        /// The kind of object that the handle names.
        object: &'static str,
        /// The structure.
        handle: u64,
        /// What it was created to hold.
        found: ObjectKind,
        /// What is to be written into it.
        required: ObjectKind,
    },
    /// Geometry of a type that the structure cannot be built from, or a union and a type that contradict each other.
    #[error("geometry of type {} cannot be built into this structure, or its data is of another type", named(found.name(), found.0))]
    GeometryType {
        /// The type given.
        found: vk::GeometryType,
    },
    /// Two ranges of memory, at least one of them written, overlap where no order of accesses is defined.
    #[error("its memory overlaps that of {other}")]
    Overlap {
        /// The other user of the memory, as a path.
        other: String,
    },
    /// A field of the triangle array without a meaning.
    #[error(transparent)]
    MicromapTriangle(#[from] MicromapTriangleError),
    /// A level that no micromap can have.
    #[error(transparent)]
    SubdivisionLevel(#[from] SubdivisionLevelError),
    /// A level beyond the device's limit for the format.
    #[error("subdivision level {found} is beyond the device's limit of {limit}")]
    LevelLimit {
        /// The level.
        found: u32,
        /// The device's limit.
        limit: u32,
    },
    /// An index, with the base triangle added, beyond the micromap.
    #[error("{index} plus baseTriangle {base_triangle} is beyond the micromap's {count} triangles")]
    NoMicromapTriangle {
        /// The index as it stands in the index buffer, or the triangle's own number without one.
        index: u32,
        /// What is added to it.
        base_triangle: u32,
        /// Triangles in the micromap.
        count: u32,
    },
    /// An index that is not special where no micromap is attached.
    #[error("{index} is no special index, and there is no micromap to look it up in")]
    NoMicromap {
        /// The index.
        index: u32,
    },
    /// NaN in a component other than the first.
    #[error("component {component} is not a number though the first component is")]
    NotANumber {
        /// The component, 1 for y or 2 for z (3 to 5 for the upper corner of a box).
        component: u32,
    },
    /// An address that is no acceleration structure's or micromap's.
    #[error("{address:#x} is the address of no acceleration structure or micromap")]
    UnknownReference {
        /// The address.
        address: u64,
    },
    /// Input bytes that cannot be read.
    #[error(transparent)]
    Read(Box<ReadError>),
    /// Serialized data of another driver or of an incompatible version.
    #[error("written by driver {driver}, compatibility {compatibility}: not compatible with this device")]
    Incompatible {
        /// The driver UUID found.
        driver: Uuid,
        /// The compatibility UUID found.
        compatibility: Uuid,
    },
    /// An update that changes what an update must leave alone, or of a structure that was not built for updates.
    #[error("the update's source was built with {what} {}, the update needs {}", differing(what, *.found), differing(what, *.required))]
    Update {
        /// What differs.
        what: &'static str,
        /// Of the source.
        found: u64,
        /// Of the update.
        required: u64,
    },
    /// Nothing is undefined: the call has a meaning that this device does not simulate.
    #[error("this device does not simulate {what}")]
    Unsupported {
        /// What is not simulated.
        what: &'static str,
    },
}

impl From<ReadError> for Reason {
    fn from(error: ReadError) -> Self {
        Self::Read(Box::new(error))
    }
}

/// An enumerant by its name, where it has one.
fn named(name: Option<&str>, value: i32) -> String {
    name.map_or_else(|| value.to_string(), str::to_owned)
}

/// What differs: flags and addresses in hexadecimal, all else as numbers.
fn differing(what: &str, value: u64) -> String {
    if what.ends_with("flags") || what.ends_with("at") { format!("{value:#x}") } else { value.to_string() }
}

/// The kind in words.
const fn name(kind: ObjectKind) -> &'static str {
    match kind {
        ObjectKind::Micromap => "micromap",
        ObjectKind::BottomLevel => "bottom-level structure",
        ObjectKind::TopLevel => "top-level structure",
    }
}

#[cfg(test)]
mod tests;
