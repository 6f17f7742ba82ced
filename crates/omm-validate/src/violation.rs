//! One finding: which rule, where, what was found and what was required.

use std::fmt;

use omm_model::profile::Uuid;
use omm_model::vk;
use serde::Serialize;
use serde::ser::{SerializeSeq, SerializeStruct, Serializer};

use crate::location::{Location, Object};
use crate::rule::RuleId;
use crate::state::{Liveness, RecordingState};
use crate::value::{Constant, Flags, Found, object_type_name, write_objects};

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Severity {
    /// Valid usage is broken: a driver may do anything.
    Error,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Error => "Error",
        })
    }
}

/// A rule that a call breaks.
///
/// [`Display`](fmt::Display) writes it as the messages of a validation layer read: the rule's identifier, the objects, the path,
/// found and required, what it means, a link. `Serialize` writes an object of `vuid`, `severity`, `command`, `path`, `found`,
/// `required`, `objects` (each `type` and `handle`, the latter in hexadecimal) and `message`, all of them strings but `objects`.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Violation {
    /// The rule.
    pub rule: RuleId,
    /// How bad it is.
    pub severity: Severity,
    /// The command's name, such as `vkCmdBuildAccelerationStructuresKHR`.
    pub command: &'static str,
    /// The path to the offending value.
    pub location: Location,
    /// What was found there and what was required.
    pub kind: ViolationKind,
    /// The objects concerned, the one that the command was called on first.
    pub objects: Vec<Object>,
}

impl Violation {
    /// The finding in one line: command, path, found and required.
    #[must_use]
    pub fn summary(&self) -> String {
        let Self { command, location, kind, .. } = self;
        format!("{command}(): {location}: found {}, required {}", kind.found(), kind.required())
    }
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Validation {}: [ {} ]", self.severity, self.rule)?;
        if !self.objects.is_empty() {
            f.write_str("Objects: ")?;
            write_objects(f, &self.objects)?;
            writeln!(f)?;
        }
        writeln!(f, "{}", self.summary())?;
        writeln!(f, "{}", self.rule.explanation())?;
        writeln!(f, "{}", self.rule.url())
    }
}

impl Serialize for Violation {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("Violation", 8)?;
        object.serialize_field("vuid", self.rule.vuid())?;
        object.serialize_field("severity", &self.severity)?;
        object.serialize_field("command", self.command)?;
        object.serialize_field("path", &self.location)?;
        object.serialize_field("found", &self.kind.found())?;
        object.serialize_field("required", &self.kind.required())?;
        object.serialize_field("objects", &ObjectList(&self.objects))?;
        object.serialize_field("message", &format!("{}. {}", self.summary(), self.rule.explanation()))?;
        object.end()
    }
}

struct ObjectList<'a>(&'a [Object]);

impl Serialize for ObjectList<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Entry {
            r#type: String,
            handle: String,
        }
        let mut list = serializer.serialize_seq(Some(self.0.len()))?;
        for (ty, handle) in self.0 {
            list.serialize_element(&Entry { r#type: object_type_name(*ty), handle: format!("{handle:#x}") })?;
        }
        list.end()
    }
}

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

impl ViolationKind {
    /// The value found, as text.
    #[must_use]
    pub fn found(&self) -> String {
        match *self {
            Self::AboveLimit { found, .. }
            | Self::BelowLimit { found, .. }
            | Self::WrongCount { found, .. }
            | Self::NotMultiple { found, .. } => found.to_string(),
            Self::UnexpectedValue { found, .. } | Self::ForbiddenValue { found } => found.to_string(),
            Self::ForbiddenFlags { found, .. } => found.to_string(),
            Self::BothPointers { members: [first, second] } => format!("{first} and {second}"),
            Self::PointerNotNull => "a pointer".to_owned(),
            Self::HandleNull => "VK_NULL_HANDLE".to_owned(),
            Self::Misaligned { found, .. }
            | Self::HandleNotNull { found }
            | Self::AddressNotNull { found }
            | Self::InvalidAddress { found } => format!("{found:#x}"),
            Self::BeyondBuffer { start, size, .. } => format!("{size} bytes from {start:#x}"),
            Self::DataBeyondBuffer { offset, size, .. } => format!("{size} bytes at offset {offset}"),
            Self::TriangleOutOfRange { index, .. } => index.to_string(),
            Self::FeatureDisabled { .. } => "a device without the feature".to_owned(),
            Self::SeveralPhysicalDevices { found, .. } => format!("a device of {found} physical devices"),
            Self::MissingFlags { found, .. } => found.to_string(),
            Self::WrongValue { found, .. } => found.to_string(),
            Self::NotBound { buffer } => format!("an object in buffer {buffer:#x}, without memory there"),
            Self::NotHostVisible { found } => {
                found.map_or_else(|| "no memory".to_owned(), |found| format!("memory with {found}"))
            }
            Self::MultipleInstances { found } => format!("memory with {found} instances"),
            Self::Overlap { start, size, other: [array, member], index } => {
                format!("{size} bytes from {start:#x}, which overlap those of {array}[{index}].{member}")
            }
            Self::InvalidHostAddress { found } => format!("{found:#x}"),
            Self::BeyondHostMemory { start, size, .. } => format!("{size} bytes from {start:#x}"),
            Self::QueryState { query, available: true } => format!("query {query}, which holds a result"),
            Self::QueryState { query, available: false } => format!("query {query}, which was never reset"),
            Self::Incompatible { found: [driver, compatibility], .. } => uuids(driver, compatibility),
            Self::NotSerialized { offset, truncated: true, .. } => format!("data that ends at byte {offset}"),
            Self::NotSerialized { offset, truncated: false, .. } => {
                format!("data that makes no sense from byte {offset} on")
            }
            Self::NeedsFeature { found: None, .. } => "the feature disabled".to_owned(),
            Self::NeedsFeature { found: Some(found), .. } => found.to_string(),
            Self::MissingOneOfFlags { found, .. } => found.to_string(),
            Self::ArrayNull { .. } => "NULL".to_owned(),
            Self::Referenced { found, element } => format!("{found:#x}, which pInfos[{element}] refers to"),
            Self::OverlapsObject { start, size, other } => {
                format!("{size} bytes from {start:#x}, which overlap those of {other:#x}")
            }
            Self::NotBuilt { found } => format!("{found:#x}, which is not built"),
            Self::StructureMissing { .. } => "none".to_owned(),
            Self::StructureForbidden { structure } => structure.to_owned(),
            Self::OtherHandle { found, .. } => format!("{found:#x}"),
            Self::WrongOrigin { found, origin } => format!("{found:#x}, {origin}"),
            Self::NoMicromapAt { found, origin } => format!("{found:#x}, {origin}"),
            Self::Pending { command } => format!("{command} deferred and not complete"),
            Self::Unbound { start } => format!("no memory at {start:#x}"),
            Self::PartlyNan { component } => format!("NaN in {component} and a number in x"),
            Self::TooSmallFor { found, .. } => found.to_string(),
            Self::UnknownEnumerant { found }
            | Self::UnexpectedStructure { found, .. }
            | Self::DuplicateStructure { found } => found.to_string(),
            Self::InvalidHandle { found: 0, .. } => "VK_NULL_HANDLE".to_owned(),
            Self::InvalidHandle { found, liveness: Liveness::Destroyed, .. } => {
                format!("{found:#x}, which was destroyed")
            }
            Self::InvalidHandle { found, .. } => format!("{found:#x}, which was never created"),
            Self::WrongParent { found, .. } => format!("an object of VkDevice {found:#x}"),
            Self::NotRecording { found } => format!("a command buffer in the {found} state"),
            Self::InsideRenderPass => "a render pass instance".to_owned(),
            Self::SuspendedRenderPass => "a suspended render pass instance".to_owned(),
            Self::Own(finding) => finding.found(),
            Self::NotSpecialIndex { found, .. } => found.to_string(),
        }
    }

    /// What was required, as text.
    #[must_use]
    pub fn required(&self) -> String {
        match *self {
            Self::AboveLimit { limit, from, .. } => format!("at most {limit} ({from})"),
            Self::BelowLimit { limit, .. } => format!("at least {limit}"),
            Self::WrongCount { required, .. } => format!("exactly {required}"),
            Self::NotMultiple { of, .. } => format!("a multiple of {of}"),
            Self::Misaligned { alignment, .. } => format!("a multiple of {alignment}"),
            Self::UnexpectedValue { allowed, .. } => alternatives(allowed),
            Self::ForbiddenValue { .. } => "any other value".to_owned(),
            Self::ForbiddenFlags { forbidden, .. } => format!("flags without {forbidden}"),
            Self::BothPointers { .. } => "only one of them".to_owned(),
            Self::PointerNotNull => "NULL".to_owned(),
            Self::HandleNotNull { .. } => "VK_NULL_HANDLE".to_owned(),
            Self::HandleNull => "an object".to_owned(),
            Self::AddressNotNull { .. } => "0".to_owned(),
            Self::InvalidAddress { .. } => "an address inside a buffer".to_owned(),
            Self::BeyondBuffer { available, .. } => {
                format!("at most {available} bytes, where the buffer ends")
            }
            Self::DataBeyondBuffer { available, .. } => {
                format!("an end at {available} at most, where the buffer ends")
            }
            Self::TriangleOutOfRange { base_triangle, triangles, .. } => {
                let why = format!("the micromap has {triangles} triangles, baseTriangle is {base_triangle}");
                match triangles.checked_sub(base_triangle).and_then(|above_base| above_base.checked_sub(1)) {
                    Some(highest) => format!("at most {highest} ({why})"),
                    None => format!("no index at all ({why})"),
                }
            }
            Self::FeatureDisabled { feature } => format!("{feature} to be enabled"),
            Self::SeveralPhysicalDevices { feature, .. } => format!("one physical device, or {feature} to be enabled"),
            Self::MissingFlags { required, .. } => format!("flags with {required}"),
            Self::WrongValue { required, .. } => required.to_string(),
            Self::NotBound { .. } => "memory bound to all of the object".to_owned(),
            Self::NotHostVisible { .. } => "memory with VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT".to_owned(),
            Self::MultipleInstances { .. } => "memory with one instance".to_owned(),
            Self::Overlap { .. } => "memory of its own".to_owned(),
            Self::InvalidHostAddress { .. } => "an address of host memory".to_owned(),
            Self::BeyondHostMemory { available, .. } => {
                format!("at most {available} bytes, all that are readable there")
            }
            Self::QueryState { .. } => "queries that were reset".to_owned(),
            Self::Incompatible { required: [driver, compatibility], .. } => uuids(driver, compatibility),
            Self::NotSerialized { writer, .. } => format!("data as {writer} writes it"),
            Self::NeedsFeature { features, .. } => format!("feature {}", alternatives(features)),
            Self::MissingOneOfFlags { required, .. } => format!("flags with one of {required}"),
            Self::ArrayNull { required } => format!("an array of {required}"),
            Self::Referenced { .. } => "an object that no element refers to".to_owned(),
            Self::OverlapsObject { .. } => "memory of its own".to_owned(),
            Self::NotBuilt { .. } => "one that is built before the command executes".to_owned(),
            Self::StructureMissing { structure } => structure.to_owned(),
            Self::StructureForbidden { .. } => "none".to_owned(),
            Self::OtherHandle { required, .. } => format!("{required:#x}"),
            Self::WrongOrigin { .. } => "contents deserialized from those of the original micromap".to_owned(),
            Self::NoMicromapAt { .. } => "the address of a built micromap".to_owned(),
            Self::Pending { .. } => "a completed operation".to_owned(),
            Self::Unbound { .. } => "memory bound to the whole range".to_owned(),
            Self::TooSmallFor { required, .. } => format!("at least {required}"),
            Self::PartlyNan { .. } => "numbers, or NaN in x".to_owned(),
            Self::UnknownEnumerant { found } => format!("a value of {}", found.type_name),
            Self::UnexpectedStructure { allowed: [], .. } => "NULL".to_owned(),
            Self::UnexpectedStructure { allowed, .. } => {
                let names: Vec<&str> = allowed.iter().map(|(_, name)| *name).collect();
                alternatives(&names)
            }
            Self::DuplicateStructure { .. } => "each structure once".to_owned(),
            Self::InvalidHandle { ty, or_null, .. } => {
                let or_null = if or_null { " or VK_NULL_HANDLE" } else { "" };
                format!("a living {}{or_null}", object_type_name(ty))
            }
            Self::WrongParent { required, .. } => format!("one of VkDevice {required:#x}"),
            Self::NotRecording { .. } => "one that is being recorded".to_owned(),
            Self::InsideRenderPass | Self::SuspendedRenderPass => "none".to_owned(),
            Self::Own(finding) => finding.required(),
            Self::NotSpecialIndex { lowest, .. } => {
                format!("a special index, {lowest} to {}", lowest.saturating_add(3))
            }
        }
    }
}

/// The identities that serialized data begins with.
fn uuids(driver: Uuid, compatibility: Uuid) -> String {
    format!("driver {driver} and compatibility {compatibility}")
}

/// How an object got its contents, or why it has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Origin {
    /// There is no object.
    Nothing,
    /// It was created, and has no contents.
    NotBuilt,
    /// It was built.
    Built,
    /// It was built as something else than a micromap.
    NotMicromap,
    /// It was deserialized from what another object held.
    Other,
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Nothing => "where no structure is",
            Self::NotBuilt => "which is not built",
            Self::Built => "which was built anew",
            Self::NotMicromap => "which is no micromap",
            Self::Other => "which was deserialized from the data of another",
        })
    }
}

/// `A`, `A or B`, `A, B or C`.
fn alternatives(names: &[&str]) -> String {
    match names {
        [] => "nothing".to_owned(),
        [only] => (*only).to_owned(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}
