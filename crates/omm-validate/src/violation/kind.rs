//! The ways in which a value can be wrong.

use omm_model::profile::Uuid;
use omm_model::vk;

use super::Origin;
use crate::state::{Liveness, RecordingState};
use crate::value::{Constant, Flags, Found};

/// What is wrong with a value: what was found and what was required, as data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ViolationKind {
    /// A number is too large.
    AboveLimit {
        /// The number.
        found: u64,
        /// The largest number allowed.
        limit: u64,
        /// Where the limit comes from: the name of a device limit, or a word on what it is.
        from: &'static str,
    },
    /// A number is too small.
    BelowLimit {
        /// The number.
        found: u64,
        /// The smallest number allowed.
        limit: u64,
    },
    /// There are too many or too few of something.
    WrongCount {
        /// How many there are.
        found: u64,
        /// How many there have to be.
        required: u64,
    },
    /// A number of bytes is not a multiple of what it has to be.
    NotMultiple {
        /// The number.
        found: u64,
        /// What it has to be a multiple of.
        of: u64,
    },
    /// An address is not aligned.
    Misaligned {
        /// The address.
        found: u64,
        /// What it has to be a multiple of.
        alignment: u64,
    },
    /// An enumerant has none of the values allowed here.
    UnexpectedValue {
        /// The value.
        found: Constant,
        /// The names of the values allowed.
        allowed: &'static [&'static str],
    },
    /// An enumerant has a value that is not allowed here.
    ForbiddenValue {
        /// The value.
        found: Constant,
    },
    /// Flags include bits that are not allowed here.
    ForbiddenFlags {
        /// All the flags.
        found: Flags,
        /// Those not allowed.
        forbidden: Flags,
    },
    /// Both of two pointers are given of which only one may be.
    BothPointers {
        /// The two members.
        members: [&'static str; 2],
    },
    /// A pointer has to be null and is not.
    PointerNotNull,
    /// A handle has to be null and is not.
    HandleNotNull {
        /// The handle.
        found: u64,
    },
    /// A handle must not be null and is.
    HandleNull,
    /// An address has to be 0 and is not.
    AddressNotNull {
        /// The address.
        found: u64,
    },
    /// An address lies in no buffer.
    InvalidAddress {
        /// The address.
        found: u64,
    },
    /// A range of addresses reaches beyond the buffer that it begins in.
    BeyondBuffer {
        /// First address of the range.
        start: u64,
        /// Bytes in the range.
        size: u128,
        /// Bytes of the buffer from `start` on.
        available: u64,
    },
    /// A micromap triangle's data reaches beyond the buffer that the opacity data begins in.
    DataBeyondBuffer {
        /// Where the triangle's data begins, counted from the start of the opacity data.
        offset: u64,
        /// Bytes of it.
        size: u64,
        /// Bytes of the buffer from the start of the opacity data on.
        available: u64,
    },
    /// A geometry's triangle names a micromap triangle that the micromap does not have.
    TriangleOutOfRange {
        /// The index, before the base triangle is added.
        index: u64,
        /// The base triangle.
        base_triangle: u64,
        /// How many triangles the micromap has.
        triangles: u64,
    },
    /// A feature is not enabled on the device.
    FeatureDisabled {
        /// The structure and member of the feature.
        feature: &'static str,
    },
    /// A device is made of several physical devices, which needs a feature that is not enabled.
    SeveralPhysicalDevices {
        /// How many.
        found: u64,
        /// The structure and member of the feature.
        feature: &'static str,
    },
    /// Flags lack bits that are needed here.
    MissingFlags {
        /// All the flags.
        found: Flags,
        /// Those needed.
        required: Flags,
    },
    /// An enumerant has another value than the one that an object has.
    WrongValue {
        /// The value.
        found: Constant,
        /// The object's.
        required: Constant,
    },
    /// An object lies in a buffer that has no memory, or none there.
    NotBound {
        /// The buffer.
        buffer: u64,
    },
    /// An object lies in memory that the host cannot reach.
    NotHostVisible {
        /// What the type of the memory can do; `None` if no memory is bound.
        found: Option<Flags>,
    },
    /// An object lies in memory that has an instance on each of several physical devices.
    MultipleInstances {
        /// How many.
        found: u64,
    },
    /// Two ranges of memory overlap that must not.
    Overlap {
        /// Where the range begins: an address, or an offset in memory.
        start: u64,
        /// Bytes in the range.
        size: u64,
        /// The array and member that the other range is given by.
        other: [&'static str; 2],
        /// The element of the array.
        index: u64,
    },
    /// An address has to be one of host memory and is not: it is null, or of device memory, or nothing is known there.
    InvalidHostAddress {
        /// The address.
        found: u64,
    },
    /// A range of host memory ends too early.
    BeyondHostMemory {
        /// First address of the range.
        start: u64,
        /// Bytes in the range.
        size: u64,
        /// Bytes that are readable from `start` on.
        available: u64,
    },
    /// A query has to be reset before it is written and is not.
    QueryState {
        /// The query.
        query: u32,
        /// Whether it holds a result; if not, it was never reset.
        available: bool,
    },
    /// Serialized data was written by another driver or for another device.
    Incompatible {
        /// Driver and compatibility identities of the data.
        found: [Uuid; 2],
        /// Those of the device.
        required: [Uuid; 2],
    },
    /// Bytes are not the serialized data that they should be.
    NotSerialized {
        /// The first byte that is missing or makes no sense, counted from the start of the data.
        offset: u64,
        /// Whether the data ends there.
        truncated: bool,
        /// The command that writes such data.
        writer: &'static str,
    },
    /// A value needs a feature that the device does not have, or has not enabled.
    NeedsFeature {
        /// The value; `None` where the command itself needs the feature.
        found: Option<Found>,
        /// The features, of which one is needed.
        features: &'static [&'static str],
    },
    /// Flags have none of some bits, one of which is needed.
    MissingOneOfFlags {
        /// All the flags.
        found: Flags,
        /// Those of which one is needed.
        required: Flags,
    },
    /// A pointer to an array is null.
    ArrayNull {
        /// How many elements the array has to have.
        required: u64,
    },
    /// An object that is written is referred to by the same command.
    Referenced {
        /// The object's handle.
        found: u64,
        /// The element of the command that refers to it.
        element: u64,
    },
    /// An object shares memory with one that it must not share with.
    OverlapsObject {
        /// Address of the object's first byte, 0 if it is not known.
        start: u64,
        /// Bytes of the object.
        size: u64,
        /// Handle of the other object.
        other: u64,
    },
    /// An object has no contents when they are needed.
    NotBuilt {
        /// The object's handle.
        found: u64,
    },
    /// A structure that the chain has to hold is not there.
    StructureMissing {
        /// The structure.
        structure: &'static str,
    },
    /// A structure is in the chain and must not be.
    StructureForbidden {
        /// The structure.
        structure: &'static str,
    },
    /// A handle is not the one that is needed.
    OtherHandle {
        /// The handle.
        found: u64,
        /// The handle needed.
        required: u64,
    },
    /// What an object holds has the wrong origin.
    WrongOrigin {
        /// The object's handle.
        found: u64,
        /// How it got its contents.
        origin: Origin,
    },
    /// An address is not that of a built micromap.
    NoMicromapAt {
        /// The address.
        found: u64,
        /// What is there.
        origin: Origin,
    },
    /// An operation is not complete.
    Pending {
        /// The command that was deferred.
        command: &'static str,
    },
    /// Some of the bytes of a range are not bound to memory.
    Unbound {
        /// The first such address.
        start: u64,
    },
    /// A number is one where another is needed, both of them numbers of bytes that a copy needs.
    TooSmallFor {
        /// Bytes there are.
        found: u64,
        /// Bytes needed.
        required: u64,
    },
    /// A component of a position is NaN and the first one is not.
    PartlyNan {
        /// The component.
        component: &'static str,
    },
    /// An enumerant has a value that the API does not name.
    UnknownEnumerant {
        /// The value.
        found: Constant,
    },
    /// A structure is in a chain that it does not belong to.
    UnexpectedStructure {
        /// Its type.
        found: Constant,
        /// The types and names of those that may be there.
        allowed: &'static [(vk::StructureType, &'static str)],
    },
    /// Two structures of one type are in a chain.
    DuplicateStructure {
        /// The type.
        found: Constant,
    },
    /// A handle names no object that lives.
    InvalidHandle {
        /// The handle.
        found: u64,
        /// The kind of object that it has to name.
        ty: vk::ObjectType,
        /// What is known of it.
        liveness: Liveness,
        /// Whether it may also be null.
        or_null: bool,
    },
    /// An object is of another device.
    WrongParent {
        /// Its device.
        found: u64,
        /// The device that it has to be of.
        required: u64,
    },
    /// A command buffer is not being recorded.
    NotRecording {
        /// Where it is in its life instead.
        found: RecordingState,
    },
    /// A command stands inside a render pass instance and must not.
    InsideRenderPass,
    /// A command stands between the two parts of a suspended render pass instance.
    SuspendedRenderPass,
    /// What only a rule of our own finds.
    Own(crate::own::finding::OwnFinding),
    /// An index has to be special and is not.
    NotSpecialIndex {
        /// The index as stored.
        found: u32,
        /// The lowest special index of its type; those above it are the other three.
        lowest: u32,
    },
}
