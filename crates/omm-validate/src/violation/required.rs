//! What was required, in words.

use super::ViolationKind;
use super::found::uuids;
use crate::value::object_type_name;

impl ViolationKind {
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
            // One flag alone is no choice.
            Self::MissingOneOfFlags { required, .. } if required.bits().is_power_of_two() => {
                format!("flags with {required}")
            }
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

/// `A`, `A or B`, `A, B or C`.
fn alternatives(names: &[&str]) -> String {
    match names {
        [] => "nothing".to_owned(),
        [only] => (*only).to_owned(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}
