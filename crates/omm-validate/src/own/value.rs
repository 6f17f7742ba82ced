//! Enumerants have a value that the command understands, and arrays that belong together are as long.

use omm_layout::index::IndexType;
use omm_model::call::Call;
use omm_model::vk;
use vk::{
    AccelerationStructureBuildType as BuildType, AccelerationStructureType as Type,
    BuildAccelerationStructureMode as BuildMode, CopyAccelerationStructureMode as CopyMode, QueryType,
};

use super::finding::OwnFinding;
use crate::context::BuildContext;
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::ViolationKind;

const PROPERTIES: [QueryType; 4] = [
    QueryType::ACCELERATION_STRUCTURE_SIZE,
    QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE,
    QueryType::ACCELERATION_STRUCTURE_SERIALIZATION_SIZE,
    QueryType::ACCELERATION_STRUCTURE_SERIALIZATION_BOTTOM_LEVEL_POINTERS,
];

/// OMM-value-01
pub(super) fn check(call: &Call, command: &At<'_>, report: &mut Report) {
    let info = command.pointer("pInfo");
    match call {
        Call::AllocateCommandBuffers { allocate_info, command_buffers, .. } => {
            let required = allocate_info.command_buffer_count.into();
            count(&command.field("pCommandBuffers"), command_buffers.len(), required, report);
        }
        Call::CreateRayTracingPipelines { create_infos, pipelines, .. } => {
            count(&command.field("pPipelines"), pipelines.len(), create_infos.len() as u64, report);
        }
        Call::CreateShaders { create_infos, shaders, .. } => {
            count(&command.field("pShaders"), shaders.len(), create_infos.len() as u64, report);
        }
        Call::CmdBuildAccelerationStructures { infos, build_range_infos, .. }
        | Call::BuildAccelerationStructures { infos, build_range_infos, .. } => {
            count(&command.field("ppBuildRangeInfos"), build_range_infos.len(), infos.len() as u64, report);
            for (index, (info, ranges)) in infos.iter().zip(build_range_infos).enumerate() {
                if info.ty != Type::OPACITY_MICROMAP {
                    let at = command.element("ppBuildRangeInfos", index);
                    let found = ranges.as_ref().map_or(0, Vec::len);
                    count(&at, found, info.geometries_iter().count() as u64, report);
                }
            }
        }
        Call::CmdBuildAccelerationStructuresIndirect {
            infos,
            indirect_device_addresses,
            indirect_strides,
            max_primitive_counts,
            ..
        } => {
            let required = infos.len() as u64;
            count(&command.field("pIndirectDeviceAddresses"), indirect_device_addresses.len(), required, report);
            count(&command.field("pIndirectStrides"), indirect_strides.len(), required, report);
            count(&command.field("ppMaxPrimitiveCounts"), max_primitive_counts.len(), required, report);
            for (index, (info, counts)) in infos.iter().zip(max_primitive_counts).enumerate() {
                let at = command.element("ppMaxPrimitiveCounts", index);
                let found = counts.as_ref().map_or(0, Vec::len);
                count(&at, found, info.geometries_iter().count() as u64, report);
            }
        }
        Call::CreateAccelerationStructure { create_info, .. } => {
            let at = command.pointer("pCreateInfo");
            named(&at.field("type"), create_info.ty.0, create_info.ty.name().is_some(), report);
        }
        Call::GetAccelerationStructureBuildSizes { build_type, build_info, max_primitive_counts, .. } => {
            if build_info.ty != Type::OPACITY_MICROMAP {
                let (found, required) = (max_primitive_counts.as_ref(), build_info.geometries_iter().count() as u64);
                count(&command.field("pMaxPrimitiveCounts"), found.map_or(0, Vec::len), required, report);
            }
            let is_known = *build_type == BuildType::HOST
                || *build_type == BuildType::DEVICE
                || *build_type == BuildType::HOST_OR_DEVICE;
            named(&command.field("buildType"), build_type.0, is_known, report);
        }
        Call::GetDeviceAccelerationStructureCompatibility { version_info, .. } => {
            let (found, limit) = (version_info.version_data.len() as u64, 2 * vk::UUID_SIZE as u64);
            if found < limit {
                let at = command.pointer("pVersionInfo");
                report.push(RuleId::Value01, &at.field("pVersionData"), ViolationKind::BelowLimit { found, limit });
            }
        }
        Call::CmdCopyAccelerationStructure { info: copy, .. } | Call::CopyAccelerationStructure { info: copy, .. } => {
            let is_known = [CopyMode::CLONE, CopyMode::COMPACT].contains(&copy.mode);
            named(&info.field("mode"), copy.mode.0, is_known, report);
        }
        Call::CmdCopyAccelerationStructureToMemory { info: copy, .. }
        | Call::CopyAccelerationStructureToMemory { info: copy, .. } => {
            named(&info.field("mode"), copy.mode.0, copy.mode == CopyMode::SERIALIZE, report);
        }
        Call::CmdCopyMemoryToAccelerationStructure { info: copy, .. }
        | Call::CopyMemoryToAccelerationStructure { info: copy, .. } => {
            named(&info.field("mode"), copy.mode.0, copy.mode == CopyMode::DESERIALIZE, report);
        }
        Call::CmdWriteAccelerationStructuresProperties { query_type, .. }
        | Call::WriteAccelerationStructuresProperties { query_type, .. } => {
            named(&command.field("queryType"), query_type.0, PROPERTIES.contains(query_type), report);
        }
        _ => {}
    }
}

/// The values in a build structure.
pub(super) fn check_build(build: &BuildContext<'_>, is_sizes: bool, report: &mut Report) {
    let info = build.info;
    let is_built = [Type::TOP_LEVEL, Type::BOTTOM_LEVEL, Type::OPACITY_MICROMAP].contains(&info.ty);
    named(&build.at.field("type"), info.ty.0, is_built, report);
    if !is_sizes {
        let is_known = [BuildMode::BUILD, BuildMode::UPDATE].contains(&info.mode);
        named(&build.at.field("mode"), info.mode.0, is_known, report);
    }
    if info.ty == Type::TOP_LEVEL {
        count(&build.at.field("geometryCount"), info.geometries_iter().count(), 1, report);
    }
    build.each_geometry(|geometry| {
        let (ty, data) = (geometry.geometry.geometry_type, &geometry.geometry.geometry);
        let fits = match info.ty {
            Type::TOP_LEVEL => ty == vk::GeometryType::INSTANCES && matches!(data, vk::GeometryData::Instances(_)),
            Type::BOTTOM_LEVEL => match data {
                vk::GeometryData::Triangles(_) => ty == vk::GeometryType::TRIANGLES,
                vk::GeometryData::Aabbs(_) => ty == vk::GeometryType::AABBS,
                _ => false,
            },
            _ => true,
        };
        if !fits {
            let kind = ViolationKind::Own(OwnFinding::Geometry);
            report.push(RuleId::Value01, &geometry.at.field("geometryType"), kind);
        }
        geometry.with_triangles(|at, triangles| {
            if triangles.opacity_micromap().is_some() && triangles.opacity_micromap_ext().is_some() {
                count(&at.field("pNext"), 2, 1, report);
            }
            if !is_sizes {
                // Which others there are is the device's own affair.
                let is_format = triangles.vertex_format != vk::Format::UNDEFINED;
                named(&at.field("vertexFormat"), triangles.vertex_format.0, is_format, report);
                let index_type = IndexType::try_from(triangles.index_type);
                named(&at.field("indexType"), triangles.index_type.0, index_type.is_ok(), report);
            }
        });
    });
}

/// Reports an array that is not as long as another.
fn count(at: &At<'_>, found: usize, required: u64, report: &mut Report) {
    let found = found as u64;
    if found != required {
        report.push(RuleId::Value01, at, ViolationKind::WrongCount { found, required });
    }
}

/// Reports a value without a meaning.
fn named(at: &At<'_>, found: i32, is_known: bool, report: &mut Report) {
    if !is_known {
        let kind = ViolationKind::Own(OwnFinding::Meaningless { found: found.into() });
        report.push(RuleId::Value01, at, kind);
    }
}
