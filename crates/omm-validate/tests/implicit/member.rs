//! Members and parameters: values, arrays, objects and whose they are.

use omm_validate::RuleId;
use serde_json::json;

use crate::case::Case;
use crate::world::{GONE, MICROMAP, NEVER, OTHER_MICROMAP, OTHER_OPERATION, OTHER_POOL, TARGET};

const KHR_ATTACHED: &str = "/infos/0/geometries/0/geometry/Triangles/next/0/TrianglesOpacityMicromap";
const EXT_ATTACHED: &str = "/infos/0/geometries/0/geometry/Triangles/next/0/TrianglesOpacityMicromapExt";

pub(crate) fn cases() -> Vec<Case> {
    [values(), arrays(), handles(), parents()].into_iter().flatten().collect()
}

/// A pointer into an attached micromap.
fn within(parent: &str, member: &str) -> &'static str {
    Box::leak(format!("{parent}/{member}").into_boxed_str())
}

fn values() -> Vec<Case> {
    let khr = "pInfos[0].pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapKHR>.indexType";
    let ext = "pInfos[0].pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapEXT>.indexType";
    vec![
        Case::new(
            RuleId::AccelerationStructureTrianglesOpacityMicromapKhrIndexTypeParameter,
            "KHR",
            within(KHR_ATTACHED, "index_type"),
            -7,
            khr,
        )
        .also(RuleId::IndexType11570, khr),
        Case::new(
            RuleId::AccelerationStructureTrianglesOpacityMicromapExtIndexTypeParameter,
            "EXT",
            within(EXT_ATTACHED, "index_type"),
            -7,
            ext,
        ),
        Case::new(
            RuleId::MicromapUsageFormatParameter,
            "micromap",
            "/infos/0/geometries/0/next/0/GeometryMicromapData/usage_counts/0/format",
            0,
            "pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.pUsageCounts[0].format",
        )
        .good(1),
        Case::new(
            RuleId::MicromapBuildInfoTypeParameter,
            "GetMicromapBuildSizes",
            "/build_info/ty",
            7,
            "pBuildInfo->type",
        ),
        Case::new(RuleId::MicromapCreateInfoTypeParameter, "CreateMicromap", "/create_info/ty", 7, "pCreateInfo->type")
            .good(1_000_397_000),
        Case::new(
            RuleId::CopyMicromapToMemoryInfoModeParameter,
            "CmdCopyMicromapToMemory",
            "/info/mode",
            9,
            "pInfo->mode",
        ),
        Case::new(
            RuleId::CopyMemoryToMicromapInfoModeParameter,
            "CopyMemoryToMicromap",
            "/info/mode",
            9,
            "pInfo->mode",
        ),
        Case::new(
            RuleId::AccelerationStructureCreateInfo2TypeParameter,
            "CreateAccelerationStructure2",
            "/create_info/ty",
            -1,
            "pCreateInfo->type",
        )
        .good(2),
        Case::new(
            RuleId::GetMicromapBuildSizesBuildTypeParameter,
            "GetMicromapBuildSizes",
            "/build_type",
            3,
            "buildType",
        )
        .good(2),
        Case::new(
            RuleId::WriteMicromapsPropertiesQueryTypeParameter,
            "WriteMicromapsProperties",
            "/query_type",
            99,
            "queryType",
        ),
        Case::new(
            RuleId::MicromapBuildInfoFlagsParameter,
            "CmdBuildMicromaps",
            "/infos/0/flags",
            "ALLOW_COMPACTION | 0x80",
            "pInfos[0].flags",
        )
        .good("ALLOW_COMPACTION"),
        Case::new(
            RuleId::MicromapCreateInfoCreateFlagsParameter,
            "CreateMicromap",
            "/create_info/create_flags",
            "0x80",
            "pCreateInfo->createFlags",
        )
        .good("DEVICE_ADDRESS_CAPTURE_REPLAY"),
        Case::new(
            RuleId::AccelerationStructureCreateInfo2CreateFlagsParameter,
            "CreateAccelerationStructure2",
            "/create_info/create_flags",
            "0x2",
            "pCreateInfo->createFlags",
        ),
        Case::new(
            RuleId::AccelerationStructureCreateInfo2AddressFlagsParameter,
            "CreateAccelerationStructure2",
            "/create_info/address_flags",
            "0x40",
            "pCreateInfo->addressFlags",
        )
        .good("FULLY_BOUND"),
    ]
}

fn arrays() -> Vec<Case> {
    vec![
        Case::new(RuleId::CmdBuildMicromapsInfoCount, "CmdBuildMicromaps", "/infos", json!([]), "infoCount"),
        Case::new(RuleId::BuildMicromapsInfoCount, "BuildMicromaps", "/infos", json!([]), "infoCount"),
        Case::new(
            RuleId::CmdWriteMicromapsPropertiesMicromapCount,
            "CmdWriteMicromapsProperties",
            "/micromaps",
            json!([]),
            "micromapCount",
        ),
        Case::new(
            RuleId::WriteMicromapsPropertiesMicromapCount,
            "WriteMicromapsProperties",
            "/micromaps",
            json!([]),
            "micromapCount",
        ),
        Case::new(RuleId::WriteMicromapsPropertiesDataSize, "WriteMicromapsProperties", "/data_size", 0, "dataSize")
            .also(RuleId::DataSize07576, "dataSize"),
        Case::new(
            RuleId::MicromapVersionInfoVersionDataParameter,
            "GetDeviceMicromapCompatibility",
            "/version_info/version_data",
            vec![0; 31],
            "pVersionInfo->pVersionData",
        )
        .good(vec![0; 33]),
    ]
}

fn handles() -> Vec<Case> {
    let (khr, ext) = (
        "pInfos[0].pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapKHR>.micromap",
        "pInfos[0].pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapEXT>.micromap",
    );
    // The rule, where it applies, and whether the handle may be null.
    let members = [
        (
            RuleId::AccelerationStructureTrianglesOpacityMicromapKhrMicromapParameter,
            "KHR",
            within(KHR_ATTACHED, "micromap"),
            khr,
            true,
        ),
        (
            RuleId::AccelerationStructureTrianglesOpacityMicromapExtMicromapParameter,
            "EXT",
            within(EXT_ATTACHED, "micromap"),
            ext,
            true,
        ),
        (RuleId::DstMicromap07463, "CmdBuildMicromaps", "/infos/0/dst_micromap", "pInfos[0].dstMicromap", false),
        (RuleId::HostDstMicromap07463, "BuildMicromaps", "/infos/0/dst_micromap", "pInfos[0].dstMicromap", false),
        (
            RuleId::MicromapCreateInfoBufferParameter,
            "CreateMicromap",
            "/create_info/buffer",
            "pCreateInfo->buffer",
            false,
        ),
        (RuleId::CopyMicromapInfoSrcParameter, "CmdCopyMicromap", "/info/src", "pInfo->src", false),
        (RuleId::CopyMicromapInfoDstParameter, "CopyMicromap", "/info/dst", "pInfo->dst", false),
        (RuleId::CopyMicromapToMemoryInfoSrcParameter, "CopyMicromapToMemory", "/info/src", "pInfo->src", false),
        (RuleId::CopyMemoryToMicromapInfoDstParameter, "CmdCopyMemoryToMicromap", "/info/dst", "pInfo->dst", false),
        (
            RuleId::CmdWriteMicromapsPropertiesMicromapsParameter,
            "CmdWriteMicromapsProperties",
            "/micromaps/0",
            "pMicromaps[0]",
            false,
        ),
        (
            RuleId::CmdWriteMicromapsPropertiesQueryPoolParameter,
            "CmdWriteMicromapsProperties",
            "/query_pool",
            "queryPool",
            false,
        ),
        (
            RuleId::WriteMicromapsPropertiesMicromapsParameter,
            "WriteMicromapsProperties",
            "/micromaps/0",
            "pMicromaps[0]",
            false,
        ),
        (RuleId::DestroyMicromapMicromapParameter, "DestroyMicromap", "/micromap", "micromap", true),
        (
            RuleId::DestroyDeferredOperationOperationParameter,
            "DestroyDeferredOperation",
            "/operation",
            "operation",
            true,
        ),
        (
            RuleId::GetDeferredOperationMaxConcurrencyOperationParameter,
            "GetDeferredOperationMaxConcurrency",
            "/operation",
            "operation",
            false,
        ),
        (
            RuleId::GetDeferredOperationResultOperationParameter,
            "GetDeferredOperationResult",
            "/operation",
            "operation",
            false,
        ),
        (RuleId::DeferredOperationJoinOperationParameter, "DeferredOperationJoin", "/operation", "operation", false),
    ];
    let cases = members.into_iter().flat_map(|(rule, base, pointer, path, or_null)| {
        let case = move |handle: u64| Case::new(rule, base, pointer, handle, path);
        let with_good = move |case: Case| if or_null { case.good(0) } else { case };
        [with_good(case(GONE)), with_good(case(NEVER))].into_iter().chain((!or_null).then(|| case(0)))
    });
    cases.collect()
}

fn parents() -> Vec<Case> {
    let operation = |rule, base| Case::new(rule, base, "/operation", OTHER_OPERATION.0, "operation");
    vec![
        Case::new(RuleId::DestroyMicromapMicromapParent, "DestroyMicromap", "/micromap", OTHER_MICROMAP.0, "micromap")
            .good(MICROMAP.0),
        operation(RuleId::DestroyDeferredOperationOperationParent, "DestroyDeferredOperation"),
        operation(RuleId::GetDeferredOperationMaxConcurrencyOperationParent, "GetDeferredOperationMaxConcurrency"),
        operation(RuleId::GetDeferredOperationResultOperationParent, "GetDeferredOperationResult"),
        operation(RuleId::DeferredOperationJoinOperationParent, "DeferredOperationJoin"),
        Case::new(
            RuleId::WriteMicromapsPropertiesMicromapsParent,
            "WriteMicromapsProperties",
            "/micromaps/0",
            OTHER_MICROMAP.0,
            "pMicromaps[0]",
        )
        .also(RuleId::HostPropertiesSource11671, "pMicromaps[0]"),
        Case::new(RuleId::CopyMicromapInfoCommonParent, "CopyMicromap", "/info/dst", OTHER_MICROMAP.0, "pInfo->dst")
            .good(TARGET.0),
        Case::new(RuleId::CopyMicromapInfoCommonParent, "CmdCopyMicromap", "/info/dst", OTHER_MICROMAP.0, "pInfo->dst"),
        Case::new(
            RuleId::CmdWriteMicromapsPropertiesCommonParent,
            "CmdWriteMicromapsProperties",
            "/query_pool",
            OTHER_POOL.0,
            "queryPool",
        ),
        Case::new(
            RuleId::CmdWriteMicromapsPropertiesCommonParent,
            "CmdWriteMicromapsProperties",
            "/micromaps",
            json!([MICROMAP.0, OTHER_MICROMAP.0]),
            "pMicromaps[1]",
        )
        .good(json!([MICROMAP.0, MICROMAP.0])),
    ]
}
