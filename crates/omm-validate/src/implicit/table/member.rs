//! Members and parameters: which values have a meaning, how long arrays are, which objects live and whose they are.

use omm_model::vk;

use crate::rule::RuleId;

/// A rule on a member of a structure or a parameter of a command.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Member {
    /// The structure or command.
    pub(crate) owner: &'static str,
    /// The member.
    pub(crate) member: &'static str,
    /// The rule.
    pub(crate) rule: RuleId,
}

const fn of(owner: &'static str, member: &'static str, rule: RuleId) -> Member {
    Member { owner, member, rule }
}

/// The row of a member.
pub(crate) fn find(table: &'static [Member], owner: &str, member: &str) -> Option<RuleId> {
    table.iter().find(|row| row.member == member && row.owner == owner).map(|row| row.rule)
}

/// Enumerants that have to be named in the API.
pub(crate) const ENUMERANTS: &[Member] = &[
    of(
        "VkAccelerationStructureTrianglesOpacityMicromapKHR",
        "indexType",
        RuleId::AccelerationStructureTrianglesOpacityMicromapKhrIndexTypeParameter,
    ),
    of(
        "VkAccelerationStructureTrianglesOpacityMicromapEXT",
        "indexType",
        RuleId::AccelerationStructureTrianglesOpacityMicromapExtIndexTypeParameter,
    ),
    of("VkMicromapUsageKHR", "format", RuleId::MicromapUsageFormatParameter),
    of("VkMicromapBuildInfoEXT", "type", RuleId::MicromapBuildInfoTypeParameter),
    of("VkMicromapCreateInfoEXT", "type", RuleId::MicromapCreateInfoTypeParameter),
    of("VkCopyMicromapToMemoryInfoEXT", "mode", RuleId::CopyMicromapToMemoryInfoModeParameter),
    of("VkCopyMemoryToMicromapInfoEXT", "mode", RuleId::CopyMemoryToMicromapInfoModeParameter),
    of("VkAccelerationStructureCreateInfo2KHR", "type", RuleId::AccelerationStructureCreateInfo2TypeParameter),
    of("vkGetMicromapBuildSizesEXT", "buildType", RuleId::GetMicromapBuildSizesBuildTypeParameter),
    of("vkWriteMicromapsPropertiesEXT", "queryType", RuleId::WriteMicromapsPropertiesQueryTypeParameter),
];

/// Query types of other extensions, which the model has no names for.
pub(crate) const OTHER_QUERY_TYPES: &[i64] = &[
    1_000_023_000,
    1_000_028_004,
    1_000_116_000,
    1_000_165_000,
    1_000_173_000,
    1_000_210_000,
    1_000_299_000,
    1_000_328_000,
    1_000_382_000,
];

/// Flags whose bits have to be named in the API.
pub(crate) const FLAGS: &[Member] = &[
    of("VkMicromapBuildInfoEXT", "flags", RuleId::MicromapBuildInfoFlagsParameter),
    of("VkMicromapCreateInfoEXT", "createFlags", RuleId::MicromapCreateInfoCreateFlagsParameter),
    of(
        "VkAccelerationStructureCreateInfo2KHR",
        "createFlags",
        RuleId::AccelerationStructureCreateInfo2CreateFlagsParameter,
    ),
    of(
        "VkAccelerationStructureCreateInfo2KHR",
        "addressFlags",
        RuleId::AccelerationStructureCreateInfo2AddressFlagsParameter,
    ),
];

/// Arrays that have a least length, and that length.
pub(crate) const COUNTS: &[(Member, u64)] = &[
    (of("vkCmdBuildMicromapsEXT", "infoCount", RuleId::CmdBuildMicromapsInfoCount), 1),
    (of("vkBuildMicromapsEXT", "infoCount", RuleId::BuildMicromapsInfoCount), 1),
    (of("vkCmdWriteMicromapsPropertiesEXT", "micromapCount", RuleId::CmdWriteMicromapsPropertiesMicromapCount), 1),
    (of("vkWriteMicromapsPropertiesEXT", "micromapCount", RuleId::WriteMicromapsPropertiesMicromapCount), 1),
    (of("vkWriteMicromapsPropertiesEXT", "dataSize", RuleId::WriteMicromapsPropertiesDataSize), 1),
    // Driver and compatibility identity; a pointer to all of the serialized data is fine.
    (
        of("VkMicromapVersionInfoEXT", "pVersionData", RuleId::MicromapVersionInfoVersionDataParameter),
        2 * vk::UUID_SIZE as u64,
    ),
];

/// Handles of objects that have to live, and whether they may be null.
pub(crate) const HANDLES: &[(Member, bool)] = &[
    (
        of(
            "VkAccelerationStructureTrianglesOpacityMicromapKHR",
            "micromap",
            RuleId::AccelerationStructureTrianglesOpacityMicromapKhrMicromapParameter,
        ),
        true,
    ),
    (
        of(
            "VkAccelerationStructureTrianglesOpacityMicromapEXT",
            "micromap",
            RuleId::AccelerationStructureTrianglesOpacityMicromapExtMicromapParameter,
        ),
        true,
    ),
    (of("vkCmdBuildMicromapsEXT", "dstMicromap", RuleId::DstMicromap07463), false),
    (of("vkBuildMicromapsEXT", "dstMicromap", RuleId::HostDstMicromap07463), false),
    (of("VkMicromapCreateInfoEXT", "buffer", RuleId::MicromapCreateInfoBufferParameter), false),
    (of("VkCopyMicromapInfoEXT", "src", RuleId::CopyMicromapInfoSrcParameter), false),
    (of("VkCopyMicromapInfoEXT", "dst", RuleId::CopyMicromapInfoDstParameter), false),
    (of("VkCopyMicromapToMemoryInfoEXT", "src", RuleId::CopyMicromapToMemoryInfoSrcParameter), false),
    (of("VkCopyMemoryToMicromapInfoEXT", "dst", RuleId::CopyMemoryToMicromapInfoDstParameter), false),
    (
        of("vkCmdWriteMicromapsPropertiesEXT", "pMicromaps", RuleId::CmdWriteMicromapsPropertiesMicromapsParameter),
        false,
    ),
    (of("vkCmdWriteMicromapsPropertiesEXT", "queryPool", RuleId::CmdWriteMicromapsPropertiesQueryPoolParameter), false),
    (of("vkWriteMicromapsPropertiesEXT", "pMicromaps", RuleId::WriteMicromapsPropertiesMicromapsParameter), false),
    (of("vkDestroyMicromapEXT", "micromap", RuleId::DestroyMicromapMicromapParameter), true),
    (of("vkDestroyDeferredOperationKHR", "operation", RuleId::DestroyDeferredOperationOperationParameter), true),
    (
        of(
            "vkGetDeferredOperationMaxConcurrencyKHR",
            "operation",
            RuleId::GetDeferredOperationMaxConcurrencyOperationParameter,
        ),
        false,
    ),
    (of("vkGetDeferredOperationResultKHR", "operation", RuleId::GetDeferredOperationResultOperationParameter), false),
    (of("vkDeferredOperationJoinKHR", "operation", RuleId::DeferredOperationJoinOperationParameter), false),
];

/// Objects that have to be of the device that the command is called on.
pub(crate) const PARENTS: &[Member] = &[
    of("vkDestroyMicromapEXT", "micromap", RuleId::DestroyMicromapMicromapParent),
    of("vkWriteMicromapsPropertiesEXT", "pMicromaps", RuleId::WriteMicromapsPropertiesMicromapsParent),
    of("vkDestroyDeferredOperationKHR", "operation", RuleId::DestroyDeferredOperationOperationParent),
    of(
        "vkGetDeferredOperationMaxConcurrencyKHR",
        "operation",
        RuleId::GetDeferredOperationMaxConcurrencyOperationParent,
    ),
    of("vkGetDeferredOperationResultKHR", "operation", RuleId::GetDeferredOperationResultOperationParent),
    of("vkDeferredOperationJoinKHR", "operation", RuleId::DeferredOperationJoinOperationParent),
];
