//! Enumerants and flags by their names.

use omm_model::vk;

/// The names of one type's values.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Constants {
    /// The type's name in the model.
    pub(crate) type_name: &'static str,
    /// Names and values; the names of one value stand together, the canonical one first.
    names: &'static [(&'static str, i64)],
    /// Whether values are put together from bits.
    pub(crate) is_flags: bool,
}

const fn enumerants(type_name: &'static str, names: &'static [(&'static str, i64)]) -> Constants {
    Constants { type_name, names, is_flags: false }
}

const fn flags(type_name: &'static str, names: &'static [(&'static str, i64)]) -> Constants {
    Constants { type_name, names, is_flags: true }
}

const TYPES: &[Constants] = &[
    enumerants("AccelerationStructureBuildType", vk::AccelerationStructureBuildType::NAMES),
    enumerants("AccelerationStructureCompatibility", vk::AccelerationStructureCompatibility::NAMES),
    enumerants("AccelerationStructureType", vk::AccelerationStructureType::NAMES),
    enumerants("BuildAccelerationStructureMode", vk::BuildAccelerationStructureMode::NAMES),
    enumerants("BuildMicromapMode", vk::BuildMicromapMode::NAMES),
    enumerants("CommandBufferLevel", vk::CommandBufferLevel::NAMES),
    enumerants("CopyAccelerationStructureMode", vk::CopyAccelerationStructureMode::NAMES),
    enumerants("CopyMicromapMode", vk::CopyMicromapMode::NAMES),
    enumerants("DescriptorType", vk::DescriptorType::NAMES),
    enumerants("Format", vk::Format::NAMES),
    enumerants("GeometryType", vk::GeometryType::NAMES),
    enumerants("IndexType", vk::IndexType::NAMES),
    enumerants("MicromapType", vk::MicromapType::NAMES),
    enumerants("OpacityMicromapFormat", vk::OpacityMicromapFormat::NAMES),
    enumerants("QueryType", vk::QueryType::NAMES),
    enumerants("Result", vk::Result::NAMES),
    enumerants("SharingMode", vk::SharingMode::NAMES),
    enumerants("StructureType", vk::StructureType::NAMES),
    flags("AccelerationStructureCreateFlags", vk::AccelerationStructureCreateFlags::NAMES),
    flags("AccelerationStructureMotionInfoFlags", vk::AccelerationStructureMotionInfoFlags::NAMES),
    flags("AddressCommandFlags", vk::AddressCommandFlags::NAMES),
    flags("BufferCreateFlags", vk::BufferCreateFlags::NAMES),
    flags("BufferUsageFlags", vk::BufferUsageFlags::NAMES),
    flags("BufferUsageFlags2", vk::BufferUsageFlags2::NAMES),
    flags("BuildAccelerationStructureFlags", vk::BuildAccelerationStructureFlags::NAMES),
    flags("BuildMicromapFlags", vk::BuildMicromapFlags::NAMES),
    flags("CommandBufferResetFlags", vk::CommandBufferResetFlags::NAMES),
    flags("CommandBufferUsageFlags", vk::CommandBufferUsageFlags::NAMES),
    flags("CommandPoolCreateFlags", vk::CommandPoolCreateFlags::NAMES),
    flags("GeometryFlags", vk::GeometryFlags::NAMES),
    flags("GeometryInstanceFlags", vk::GeometryInstanceFlags::NAMES),
    flags("MemoryAllocateFlags", vk::MemoryAllocateFlags::NAMES),
    flags("MemoryHeapFlags", vk::MemoryHeapFlags::NAMES),
    flags("MemoryPropertyFlags", vk::MemoryPropertyFlags::NAMES),
    flags("MicromapCreateFlags", vk::MicromapCreateFlags::NAMES),
    flags("PipelineCreateFlags2", vk::PipelineCreateFlags2::NAMES),
    flags("QueryControlFlags", vk::QueryControlFlags::NAMES),
    flags("QueryPipelineStatisticFlags", vk::QueryPipelineStatisticFlags::NAMES),
    flags("QueryPoolCreateFlags", vk::QueryPoolCreateFlags::NAMES),
    flags("QueryResultFlags", vk::QueryResultFlags::NAMES),
    flags("QueueFlags", vk::QueueFlags::NAMES),
    flags("RenderingFlags", vk::RenderingFlags::NAMES),
    flags("ShaderCreateFlags", vk::ShaderCreateFlags::NAMES),
    flags("SparseMemoryBindFlags", vk::SparseMemoryBindFlags::NAMES),
];

/// The names of a type's values, if the type is one of enumerants or flags.
pub(crate) fn of_type(type_name: &str) -> Option<&'static Constants> {
    TYPES.iter().find(|found| found.type_name == type_name)
}

/// The value of a name, whatever its type. `EXT` usages store a format as a plain number.
pub(crate) fn of_any_type(name: &str) -> Option<i64> {
    TYPES.iter().flat_map(|found| found.names).find(|(found, _)| *found == name).map(|(_, value)| *value)
}

impl Constants {
    /// The value of a name, full or without what all names of the type have in common.
    pub(crate) fn value(&self, name: &str) -> Option<i64> {
        let of_type = format!("VK_{}_", screaming(self.type_name.trim_end_matches('2').trim_end_matches("Flags")));
        let same = |found: &&(&'static str, i64)| {
            // A type of one name has all of it in common; there the name of the type tells what is left out.
            let alone = self.names.len() < 2 && without_author(found.0).strip_prefix(&of_type) == Some(name);
            found.0 == name || self.short(found.0) == name || alone
        };
        self.names.iter().find(same).map(|(_, value)| *value)
    }

    /// All short names.
    pub(crate) fn short_names(&self) -> impl Iterator<Item = &'static str> {
        self.names.iter().map(|(name, _)| self.short(name))
    }

    /// A name without what all names of the type have in common, the author and the word that flags end in.
    fn short(&self, name: &'static str) -> &'static str {
        let first = self.names.first().map_or("", |(first, _)| *first);
        let common = |prefix: &str| self.names.iter().all(|(name, _)| name.starts_with(prefix));
        let starts = first.match_indices('_').map(|(at, _)| first.get(..=at).unwrap_or_default());
        let prefix = starts.rev().find(|prefix| common(prefix)).unwrap_or("VK_");
        // A type of one name has all of it in common.
        let prefix = if self.names.len() < 2 { "VK_" } else { prefix };
        let short = name.strip_prefix(prefix).unwrap_or(name);
        let value = |name: &str| self.names.iter().find(|(found, _)| *found == name).map(|(_, value)| *value);
        // What two authors named alike keeps its author.
        let alike =
            |(other, found): &(&str, i64)| without_author(other) == without_author(name) && Some(*found) != value(name);
        if self.names.iter().any(alike) { short } else { without_author(short) }
    }

    /// A value as text: the short names of its parts, what has none as a number.
    pub(crate) fn show(&self, value: i128) -> String {
        let named = |wanted: i128| self.names.iter().find(|(_, found)| i128::from(*found) == wanted);
        if !self.is_flags {
            return named(value).map_or_else(|| value.to_string(), |(name, _)| self.short(name).to_owned());
        }
        let (mut rest, mut parts) = (value, Vec::new());
        for (name, bit) in self.names {
            let bit = i128::from(*bit);
            if bit != 0 && rest & bit == bit {
                parts.push(self.short(name).to_owned());
                rest &= !bit;
            }
        }
        if rest != 0 || parts.is_empty() {
            parts.push(if rest == 0 { "0".to_owned() } else { format!("{rest:#x}") });
        }
        parts.join(" | ")
    }
}

/// `QueryControl` as `QUERY_CONTROL`.
fn screaming(name: &str) -> String {
    let mut out = String::new();
    for letter in name.chars() {
        if letter.is_ascii_uppercase() && !out.is_empty() {
            out.push('_');
        }
        out.push(letter.to_ascii_uppercase());
    }
    out
}

/// A name without its author and the word that flags end in.
fn without_author(name: &str) -> &str {
    ["_KHR", "_EXT", "_NV", "_BIT"].iter().fold(name, |name, suffix| name.strip_suffix(suffix).unwrap_or(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_in_full_and_in_short() {
        let types = of_type("IndexType").unwrap();
        assert_eq!(types.value("VK_INDEX_TYPE_NONE_KHR"), Some(1_000_165_000));
        assert_eq!(types.value("NONE"), types.value("VK_INDEX_TYPE_NONE_KHR"));
        assert_eq!(types.value("UINT8"), types.value("VK_INDEX_TYPE_UINT8_EXT"));
        assert_eq!(types.value("UINT64"), None);
        assert_eq!((types.show(0), types.show(7)), ("UINT16".to_owned(), "7".to_owned()));
        let flags = of_type("BuildAccelerationStructureFlags").unwrap();
        assert_eq!(flags.value("ALLOW_UPDATE"), Some(1));
        assert_eq!(flags.show(0x8000_0003), "ALLOW_UPDATE | ALLOW_COMPACTION | 0x80000000");
        assert_eq!(flags.show(0), "0");
        let ty = of_type("AccelerationStructureType").unwrap();
        assert_eq!(ty.show(1_000_623_000), "OPACITY_MICROMAP");
        assert_eq!(of_type("MicromapCreateFlags").unwrap().show(1), "MICROMAP_CREATE_DEVICE_ADDRESS_CAPTURE_REPLAY");
        assert_eq!(of_type("BuildMicromapMode").unwrap().value("BUILD"), Some(0));
        assert_eq!(of_any_type("VK_OPACITY_MICROMAP_FORMAT_4_STATE_EXT"), Some(2));
        assert!(of_type("Buffer").is_none());
    }

    #[test]
    fn short_names_are_unique_in_their_type() {
        for constants in TYPES {
            let values: std::collections::BTreeSet<_> = constants.names.iter().map(|(_, value)| *value).collect();
            for value in values {
                let name = constants.show(value.into());
                assert_eq!(constants.value(&name), Some(value), "{name} of {}", constants.type_name);
            }
        }
    }
}
