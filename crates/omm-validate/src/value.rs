//! Enumerants and flags as values of a finding: with the names that the C interface gives them.

use std::fmt;

use omm_model::vk;

use crate::location::Object;

/// An enumerant's value, named where it has a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Constant {
    /// The type's name in the API, such as `VkIndexType`.
    pub type_name: &'static str,
    /// The constant's name in the API, if the value has one.
    pub name: Option<&'static str>,
    /// The value.
    pub value: i64,
}

impl fmt::Display for Constant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.name {
            Some(name) => f.write_str(name),
            None => write!(f, "{}({})", self.type_name, self.value),
        }
    }
}

macro_rules! constants {
    ($($type:ident as $name:literal;)*) => {$(
        impl From<vk::$type> for Constant {
            fn from(value: vk::$type) -> Self {
                Self { type_name: $name, name: value.name(), value: value.0.into() }
            }
        }
    )*};
}

constants! {
    StructureType as "VkStructureType";
    AccelerationStructureSerializedBlockType as "VkAccelerationStructureSerializedBlockTypeKHR";
    AccelerationStructureBuildType as "VkAccelerationStructureBuildTypeKHR";
    AccelerationStructureType as "VkAccelerationStructureTypeKHR";
    BuildAccelerationStructureMode as "VkBuildAccelerationStructureModeKHR";
    GeometryType as "VkGeometryTypeKHR";
    IndexType as "VkIndexType";
    MicromapType as "VkMicromapTypeEXT";
    BuildMicromapMode as "VkBuildMicromapModeEXT";
    CopyMicromapMode as "VkCopyMicromapModeEXT";
    QueryType as "VkQueryType";
    OpacityMicromapFormat as "VkOpacityMicromapFormatKHR";
}

/// Flag bits with the names of their type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Flags {
    /// The names of the type's bits; names of one bit stand together, the canonical one first.
    names: &'static [(&'static str, i64)],
    /// The bits.
    bits: u64,
}

impl Flags {
    /// The bits.
    #[must_use]
    pub const fn bits(self) -> u64 {
        self.bits
    }

    /// Other bits of the same type.
    pub(crate) const fn with_bits(self, bits: u64) -> Self {
        Self { names: self.names, bits }
    }
}

/// Names joined by ` | `, what has no name as a hexadecimal number, `no flags` where no bit is set.
impl fmt::Display for Flags {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut rest = self.bits;
        let mut separator = "";
        for (name, value) in self.names {
            let bit = value.cast_unsigned();
            if bit != 0 && rest & bit == bit {
                write!(f, "{separator}{name}")?;
                rest &= !bit;
                separator = " | ";
            }
        }
        match rest {
            0 if separator.is_empty() => f.write_str("no flags"),
            0 => Ok(()),
            _ => write!(f, "{separator}{rest:#x}"),
        }
    }
}

macro_rules! flags {
    ($($type:ident;)*) => {$(
        impl From<vk::$type> for Flags {
            fn from(flags: vk::$type) -> Self {
                Self { names: vk::$type::NAMES, bits: flags.bits().into() }
            }
        }
    )*};
}

flags! {
    MicromapCreateFlags;
    QueueFlags;
    GeometryInstanceFlags;
    AddressCommandFlags;
    AccelerationStructureCreateFlags;
    BuildAccelerationStructureFlags;
    BuildMicromapFlags;
    BufferCreateFlags;
    BufferUsageFlags;
    MemoryPropertyFlags;
    GeometryFlags;
}

/// A value of one kind or another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Found {
    /// An enumerant.
    Constant(Constant),
    /// Flags.
    Flags(Flags),
    /// A number.
    Number(u64),
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(value) => value.fmt(f),
            Self::Flags(value) => value.fmt(f),
            Self::Number(value) => value.fmt(f),
        }
    }
}

/// The name of a kind of object as a handle type, such as `VkAccelerationStructureKHR`, made from the enumerant's name.
pub(crate) fn object_type_name(ty: vk::ObjectType) -> String {
    let Some(words) = ty.name().and_then(|name| name.strip_prefix("VK_OBJECT_TYPE_")) else {
        return format!("VkObjectType({})", ty.0);
    };
    let mut name = "Vk".to_owned();
    for word in words.split('_') {
        match word.split_at_checked(1) {
            Some((first, rest)) if !matches!(word, "KHR" | "EXT" | "NV") => {
                name.push_str(first);
                name.push_str(&rest.to_ascii_lowercase());
            }
            _ => name.push_str(word),
        }
    }
    name
}

/// Writes `VkCommandBuffer 0x7, VkAccelerationStructureKHR 0x12`.
pub(crate) fn write_objects(f: &mut fmt::Formatter<'_>, objects: &[Object]) -> fmt::Result {
    for (position, (ty, handle)) in objects.iter().enumerate() {
        let separator = if position == 0 { "" } else { ", " };
        write!(f, "{separator}{} {handle:#x}", object_type_name(*ty))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_and_flags_show_their_names() {
        let text = |ty| Constant::from(ty).to_string();
        assert_eq!(text(vk::IndexType::UINT8), "VK_INDEX_TYPE_UINT8");
        assert_eq!(text(vk::IndexType(-3)), "VkIndexType(-3)");
        let text = |bits| Flags::from(vk::GeometryFlags::from_bits_retain(bits)).to_string();
        assert_eq!(text(0), "no flags");
        assert_eq!(text(0x10), "0x10");
        assert_eq!(text(0x101), "VK_GEOMETRY_OPAQUE_BIT_KHR | 0x100");
        let flags = vk::BuildAccelerationStructureFlags::ALLOW_OPACITY_MICROMAP_UPDATE;
        assert_eq!(
            Flags::from(flags).to_string(),
            "VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_OPACITY_MICROMAP_UPDATE_BIT_KHR"
        );
    }

    #[test]
    fn objects_show_their_handle_type() {
        assert_eq!(object_type_name(vk::CommandBuffer::OBJECT_TYPE), "VkCommandBuffer");
        assert_eq!(object_type_name(vk::AccelerationStructure::OBJECT_TYPE), "VkAccelerationStructureKHR");
        assert_eq!(object_type_name(vk::Micromap::OBJECT_TYPE), "VkMicromapEXT");
        assert_eq!(object_type_name(vk::ObjectType(-1)), "VkObjectType(-1)");
    }
}
