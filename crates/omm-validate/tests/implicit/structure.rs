//! Structures: types and chains.

use omm_validate::RuleId;
use serde_json::json;

use crate::case::Case;

/// A structure type that none of the structures has.
const OTHER_TYPE: i32 = 0;

pub(crate) fn cases() -> Vec<Case> {
    let mut cases = types();
    cases.extend(chains());
    cases
}

fn types() -> Vec<Case> {
    let case = |rule, base, pointer, path| Case::new(rule, base, pointer, OTHER_TYPE, path);
    vec![
        case(RuleId::CopyMicromapInfoSType, "CmdCopyMicromap", "/info/s_type", "pInfo->sType"),
        case(RuleId::CopyMicromapInfoSType, "CopyMicromap", "/info/s_type", "pInfo->sType"),
        case(RuleId::CopyMicromapToMemoryInfoSType, "CmdCopyMicromapToMemory", "/info/s_type", "pInfo->sType"),
        case(RuleId::CopyMemoryToMicromapInfoSType, "CopyMemoryToMicromap", "/info/s_type", "pInfo->sType"),
        case(RuleId::MicromapBuildInfoSType, "CmdBuildMicromaps", "/infos/0/s_type", "pInfos[0].sType"),
        case(RuleId::MicromapBuildInfoSType, "GetMicromapBuildSizes", "/build_info/s_type", "pBuildInfo->sType"),
        case(RuleId::MicromapCreateInfoSType, "CreateMicromap", "/create_info/s_type", "pCreateInfo->sType"),
        case(
            RuleId::MicromapVersionInfoSType,
            "GetDeviceMicromapCompatibility",
            "/version_info/s_type",
            "pVersionInfo->sType",
        ),
        case(
            RuleId::AccelerationStructureCreateInfo2SType,
            "CreateAccelerationStructure2",
            "/create_info/s_type",
            "pCreateInfo->sType",
        ),
        case(
            RuleId::PhysicalDeviceOpacityMicromapFeaturesKhrSType,
            "CreateDevice",
            "/create_info/next/0/OpacityMicromapFeatures/s_type",
            "pCreateInfo->pNext<VkPhysicalDeviceOpacityMicromapFeaturesKHR>.sType",
        ),
        case(
            RuleId::PhysicalDeviceOpacityMicromapFeaturesKhrSType,
            "GetPhysicalDeviceFeatures2",
            "/features/next/0/OpacityMicromapFeatures/s_type",
            "pFeatures->pNext<VkPhysicalDeviceOpacityMicromapFeaturesKHR>.sType",
        ),
        case(
            RuleId::PhysicalDeviceOpacityMicromapFeaturesExtSType,
            "CreateDevice",
            "/create_info/next/1/OpacityMicromapFeaturesExt/s_type",
            "pCreateInfo->pNext<VkPhysicalDeviceOpacityMicromapFeaturesEXT>.sType",
        ),
        case(
            RuleId::PhysicalDeviceOpacityMicromapPropertiesKhrSType,
            "GetPhysicalDeviceProperties2",
            "/properties/next/0/OpacityMicromapProperties/s_type",
            "pProperties->pNext<VkPhysicalDeviceOpacityMicromapPropertiesKHR>.sType",
        ),
        case(
            RuleId::PhysicalDeviceOpacityMicromapPropertiesExtSType,
            "GetPhysicalDeviceProperties2",
            "/properties/next/1/OpacityMicromapPropertiesExt/s_type",
            "pProperties->pNext<VkPhysicalDeviceOpacityMicromapPropertiesEXT>.sType",
        ),
        case(
            RuleId::AccelerationStructureGeometryMicromapDataSType,
            "micromap",
            "/infos/0/geometries/0/next/0/GeometryMicromapData/s_type",
            "pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.sType",
        ),
        case(
            RuleId::AccelerationStructureTrianglesOpacityMicromapKhrSType,
            "KHR",
            "/infos/0/geometries/0/geometry/Triangles/next/0/TrianglesOpacityMicromap/s_type",
            "pInfos[0].pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapKHR>.sType",
        ),
        case(
            RuleId::AccelerationStructureTrianglesOpacityMicromapExtSType,
            "EXT",
            "/infos/0/geometries/0/geometry/Triangles/next/0/TrianglesOpacityMicromapExt/s_type",
            "pInfos[0].pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapEXT>.sType",
        ),
    ]
}

fn chains() -> Vec<Case> {
    let stray = || json!([{ "Unknown": 77 }]);
    let alone = |rule, base, pointer, path| Case::new(rule, base, pointer, stray(), path);
    let opaque = || json!({ "Unknown": 1_000_316_010 });
    let with_chain = |structures: serde_json::Value| {
        let call = crate::calls::base("CreateAccelerationStructure2");
        let text = serde_json::to_value(call).unwrap();
        let mut create_info = text["CreateAccelerationStructure2"]["create_info"].clone();
        create_info["create_flags"] = json!("DESCRIPTOR_BUFFER_CAPTURE_REPLAY");
        // Of a micromap descriptors cannot be saved.
        create_info["ty"] = json!(1);
        create_info["next"] = structures;
        create_info
    };
    vec![
        alone(RuleId::CopyMicromapInfoNext, "CopyMicromap", "/info/next", "pInfo->pNext"),
        alone(RuleId::CopyMicromapToMemoryInfoNext, "CopyMicromapToMemory", "/info/next", "pInfo->pNext"),
        alone(RuleId::CopyMemoryToMicromapInfoNext, "CmdCopyMemoryToMicromap", "/info/next", "pInfo->pNext"),
        alone(RuleId::MicromapBuildInfoNext, "BuildMicromaps", "/infos/0/next", "pInfos[0].pNext"),
        alone(RuleId::MicromapCreateInfoNext, "CreateMicromap", "/create_info/next", "pCreateInfo->pNext"),
        alone(
            RuleId::MicromapVersionInfoNext,
            "GetDeviceMicromapCompatibility",
            "/version_info/next",
            "pVersionInfo->pNext",
        ),
        Case::new(
            RuleId::AccelerationStructureCreateInfo2PNext,
            "CreateAccelerationStructure2",
            "/create_info",
            with_chain(json!([opaque(), { "Unknown": 77 }])),
            "pCreateInfo->pNext<VkStructureType(77)>",
        )
        .good(with_chain(json!([opaque()]))),
        Case::new(
            RuleId::AccelerationStructureCreateInfo2Unique,
            "CreateAccelerationStructure2",
            "/create_info",
            with_chain(json!([opaque(), opaque()])),
            "pCreateInfo->pNext<VkStructureType(1000316010)>",
        )
        .good(with_chain(json!([opaque()]))),
        Case::new(
            RuleId::AccelerationStructureGeometryPNext,
            "KHR",
            "/infos/0/geometries/0/next",
            stray(),
            "pInfos[0].pGeometries[0].pNext<VkStructureType(77)>",
        )
        .good(json!([{ "Unknown": 1_000_429_009 }])),
        Case::new(
            RuleId::AccelerationStructureGeometryTrianglesDataPNext,
            "KHR",
            "/infos/0/geometries/0/geometry/Triangles/next",
            stray(),
            "pInfos[0].pGeometries[0].geometry.triangles.pNext<VkStructureType(77)>",
        )
        .good(json!([{ "Unknown": 1_000_397_002 }])),
    ]
}
