//! What was found, in words.

use omm_model::profile::Uuid;

use super::ViolationKind;
use crate::state::Liveness;

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
}

/// The identities that serialized data begins with.
pub(super) fn uuids(driver: Uuid, compatibility: Uuid) -> String {
    format!("driver {driver} and compatibility {compatibility}")
}
