//! Structures: what they claim to be and what may extend them.

use omm_model::vk;

use crate::rule::RuleId;

/// The rules of a structure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Structure {
    /// The structure.
    pub(crate) name: &'static str,
    /// It says what it is.
    pub(crate) s_type: Option<RuleId>,
    /// Only some structures extend it.
    pub(crate) next: Option<(RuleId, &'static [Extension])>,
    /// No two of a kind do.
    pub(crate) unique: Option<RuleId>,
}

/// A structure that may extend another: its type and its name.
pub(crate) type Extension = (vk::StructureType, &'static str);

const fn typed(name: &'static str, s_type: RuleId) -> Structure {
    Structure { name, s_type: Some(s_type), next: None, unique: None }
}

/// A structure that nothing extends.
const fn alone(name: &'static str, s_type: RuleId, next: RuleId) -> Structure {
    Structure { next: Some((next, &[])), ..typed(name, s_type) }
}

/// What extends a geometry.
const GEOMETRY: &[Extension] = &[
    (vk::GeometryMicromapData::S_TYPE, "VkAccelerationStructureGeometryMicromapDataKHR"),
    (vk::StructureType(1_000_478_001), "VkAccelerationStructureDenseGeometryFormatTrianglesDataAMDX"),
    (vk::StructureType(1_000_429_009), "VkAccelerationStructureGeometryLinearSweptSpheresDataNV"),
    (vk::StructureType(1_000_429_010), "VkAccelerationStructureGeometrySpheresDataNV"),
];

/// What extends triangles.
const TRIANGLES: &[Extension] = &[
    (vk::GeometryMotionTrianglesData::S_TYPE, "VkAccelerationStructureGeometryMotionTrianglesDataNV"),
    (vk::TrianglesOpacityMicromap::S_TYPE, "VkAccelerationStructureTrianglesOpacityMicromapKHR"),
    (vk::TrianglesOpacityMicromapExt::S_TYPE, "VkAccelerationStructureTrianglesOpacityMicromapEXT"),
    (vk::StructureType(1_000_397_002), "VkAccelerationStructureTrianglesDisplacementMicromapNV"),
];

/// What extends the creation of an acceleration structure. The registry lists the first only; the second is demanded by a rule on
/// motion.
const CREATE_INFO_2: &[Extension] = &[
    (vk::StructureType(1_000_316_010), "VkOpaqueCaptureDescriptorDataCreateInfoEXT"),
    (vk::AccelerationStructureMotionInfo::S_TYPE, "VkAccelerationStructureMotionInfoNV"),
];

pub(crate) const STRUCTURES: &[Structure] = &[
    Structure {
        name: "VkAccelerationStructureGeometryKHR",
        s_type: None,
        next: Some((RuleId::AccelerationStructureGeometryPNext, GEOMETRY)),
        unique: None,
    },
    Structure {
        name: "VkAccelerationStructureGeometryTrianglesDataKHR",
        s_type: None,
        next: Some((RuleId::AccelerationStructureGeometryTrianglesDataPNext, TRIANGLES)),
        unique: None,
    },
    typed("VkAccelerationStructureGeometryMicromapDataKHR", RuleId::AccelerationStructureGeometryMicromapDataSType),
    typed(
        "VkAccelerationStructureTrianglesOpacityMicromapKHR",
        RuleId::AccelerationStructureTrianglesOpacityMicromapKhrSType,
    ),
    typed(
        "VkAccelerationStructureTrianglesOpacityMicromapEXT",
        RuleId::AccelerationStructureTrianglesOpacityMicromapExtSType,
    ),
    typed("VkPhysicalDeviceOpacityMicromapFeaturesKHR", RuleId::PhysicalDeviceOpacityMicromapFeaturesKhrSType),
    typed("VkPhysicalDeviceOpacityMicromapPropertiesKHR", RuleId::PhysicalDeviceOpacityMicromapPropertiesKhrSType),
    typed("VkPhysicalDeviceOpacityMicromapFeaturesEXT", RuleId::PhysicalDeviceOpacityMicromapFeaturesExtSType),
    typed("VkPhysicalDeviceOpacityMicromapPropertiesEXT", RuleId::PhysicalDeviceOpacityMicromapPropertiesExtSType),
    Structure {
        next: Some((RuleId::AccelerationStructureCreateInfo2PNext, CREATE_INFO_2)),
        unique: Some(RuleId::AccelerationStructureCreateInfo2Unique),
        ..typed("VkAccelerationStructureCreateInfo2KHR", RuleId::AccelerationStructureCreateInfo2SType)
    },
    alone("VkMicromapCreateInfoEXT", RuleId::MicromapCreateInfoSType, RuleId::MicromapCreateInfoNext),
    alone("VkMicromapBuildInfoEXT", RuleId::MicromapBuildInfoSType, RuleId::MicromapBuildInfoNext),
    alone("VkMicromapVersionInfoEXT", RuleId::MicromapVersionInfoSType, RuleId::MicromapVersionInfoNext),
    alone("VkCopyMicromapInfoEXT", RuleId::CopyMicromapInfoSType, RuleId::CopyMicromapInfoNext),
    alone("VkCopyMicromapToMemoryInfoEXT", RuleId::CopyMicromapToMemoryInfoSType, RuleId::CopyMicromapToMemoryInfoNext),
    alone("VkCopyMemoryToMicromapInfoEXT", RuleId::CopyMemoryToMicromapInfoSType, RuleId::CopyMemoryToMicromapInfoNext),
];
