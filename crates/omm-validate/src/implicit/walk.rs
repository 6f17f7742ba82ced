//! The walk over a call that finds what implicit rules are about.

use omm_model::call::Call;
use omm_model::vk::{self, ChainStructure};

use crate::location::{At, Object};
use crate::value::{Constant, Flags};

/// Something in a call that an implicit rule may be about.
#[derive(Clone, Copy, Debug)]
pub(super) enum Item<'a> {
    /// A structure with type and chain; the path is that of the structure.
    Structure {
        /// What it claims to be.
        s_type: vk::StructureType,
        /// What it is.
        required: vk::StructureType,
        /// What extends it.
        next: &'a [ChainStructure],
    },
    /// An enumerant.
    Enumerant {
        /// The member.
        member: &'static str,
        /// Its value.
        value: Constant,
    },
    /// Flags.
    Flags {
        /// The member.
        member: &'static str,
        /// The bits.
        found: Flags,
        /// The bits that have names.
        known: u64,
    },
    /// An array's length.
    Count {
        /// The member that says how long it is.
        member: &'static str,
        /// The length.
        found: u64,
    },
    /// An object.
    Handle {
        /// The member.
        member: &'static str,
        /// The object.
        object: Object,
    },
}

/// Takes the path of an item, the structure or command that it belongs to, and the item.
pub(super) type Visit<'v> = &'v mut dyn FnMut(&At<'_>, &'static str, Item<'_>);

/// The bits that have names.
fn known(names: &[(&str, i64)]) -> u64 {
    names.iter().fold(0, |bits, (_, bit)| bits | bit.cast_unsigned())
}

/// What has to be looked at in a structure with type and chain.
macro_rules! structure {
    ($visit:expr, $at:expr, $name:expr, $structure:expr, $type:ident) => {
        $visit(
            $at,
            $name,
            Item::Structure { s_type: $structure.s_type, required: vk::$type::S_TYPE, next: &$structure.next },
        )
    };
}

fn enumerant(visit: Visit<'_>, at: &At<'_>, owner: &'static str, member: &'static str, value: impl Into<Constant>) {
    visit(&at.field(member), owner, Item::Enumerant { member, value: value.into() });
}

fn count(visit: Visit<'_>, at: &At<'_>, owner: &'static str, member: &'static str, found: usize) {
    let found = u64::try_from(found).unwrap_or(u64::MAX);
    visit(&at.field(member), owner, Item::Count { member, found });
}

fn handle(visit: Visit<'_>, at: &At<'_>, owner: &'static str, member: &'static str, object: Object) {
    visit(&at.about_object(object), owner, Item::Handle { member, object });
}

const fn micromap(handle: vk::Micromap) -> Object {
    (vk::Micromap::OBJECT_TYPE, handle.0)
}

/// The operation that a command may be deferred on, even if it is null.
pub(super) const fn deferred_operation(call: &Call) -> Option<Object> {
    match call.deferred_operation() {
        Some(operation) => Some((vk::DeferredOperation::OBJECT_TYPE, operation.0)),
        None => None,
    }
}

/// Visits all of a call.
pub(super) fn each_item(call: &Call, command: &At<'_>, visit: Visit<'_>) {
    let name = call.command();
    match call {
        Call::CreateDevice { create_info, .. } => {
            device_chain(&create_info.next, &command.pointer("pCreateInfo"), visit);
        }
        Call::GetPhysicalDeviceFeatures2 { features, .. } => {
            device_chain(&features.next, &command.pointer("pFeatures"), visit);
        }
        Call::GetPhysicalDeviceProperties2 { properties, .. } => {
            device_chain(&properties.next, &command.pointer("pProperties"), visit);
        }
        Call::CreateAccelerationStructure2 { create_info, .. } => {
            create_info_2(create_info, &command.pointer("pCreateInfo"), visit);
        }
        Call::CmdBuildAccelerationStructures { infos, .. }
        | Call::CmdBuildAccelerationStructuresIndirect { infos, .. }
        | Call::BuildAccelerationStructures { infos, .. } => {
            for (index, info) in infos.iter().enumerate() {
                geometries(info, &command.element("pInfos", index).about(info.dst_acceleration_structure), visit);
            }
        }
        Call::GetAccelerationStructureBuildSizes { build_info, .. } => {
            geometries(build_info, &command.pointer("pBuildInfo"), visit);
        }
        Call::CreateMicromap { create_info, .. } => {
            micromap_create_info(create_info, &command.pointer("pCreateInfo"), visit);
        }
        Call::DestroyMicromap { micromap: found, .. } => {
            handle(visit, &command.field("micromap"), name, "micromap", micromap(*found));
        }
        Call::GetMicromapBuildSizes { build_type, build_info, .. } => {
            enumerant(visit, command, name, "buildType", *build_type);
            micromap_build_info(build_info, &command.pointer("pBuildInfo"), visit);
        }
        Call::GetDeviceMicromapCompatibility { version_info, .. } => {
            let at = command.pointer("pVersionInfo");
            structure!(visit, &at, "VkMicromapVersionInfoEXT", version_info, MicromapVersionInfo);
            count(visit, &at, "VkMicromapVersionInfoEXT", "pVersionData", version_info.version_data.len());
        }
        Call::CmdBuildMicromaps { infos, .. } | Call::BuildMicromaps { infos, .. } => {
            count(visit, command, name, "infoCount", infos.len());
            for (index, info) in infos.iter().enumerate() {
                let at = command.element("pInfos", index).about_micromap(info.dst_micromap);
                micromap_build_info(info, &at, visit);
                handle(visit, &at.field("dstMicromap"), name, "dstMicromap", micromap(info.dst_micromap));
            }
        }
        Call::CmdCopyMicromap { info, .. } | Call::CopyMicromap { info, .. } => {
            let (at, owner) = (command.pointer("pInfo"), "VkCopyMicromapInfoEXT");
            structure!(visit, &at, "VkCopyMicromapInfoEXT", info, CopyMicromapInfo);
            handle(visit, &at.field("src"), owner, "src", micromap(info.src));
            handle(visit, &at.field("dst"), owner, "dst", micromap(info.dst));
        }
        Call::CmdCopyMicromapToMemory { info, .. } | Call::CopyMicromapToMemory { info, .. } => {
            let (at, owner) = (command.pointer("pInfo"), "VkCopyMicromapToMemoryInfoEXT");
            structure!(visit, &at, "VkCopyMicromapToMemoryInfoEXT", info, CopyMicromapToMemoryInfo);
            handle(visit, &at.field("src"), owner, "src", micromap(info.src));
            enumerant(visit, &at, owner, "mode", info.mode);
        }
        Call::CmdCopyMemoryToMicromap { info, .. } | Call::CopyMemoryToMicromap { info, .. } => {
            let (at, owner) = (command.pointer("pInfo"), "VkCopyMemoryToMicromapInfoEXT");
            structure!(visit, &at, "VkCopyMemoryToMicromapInfoEXT", info, CopyMemoryToMicromapInfo);
            handle(visit, &at.field("dst"), owner, "dst", micromap(info.dst));
            enumerant(visit, &at, owner, "mode", info.mode);
        }
        Call::CmdWriteMicromapsProperties { micromaps, query_pool, .. } => {
            count(visit, command, name, "micromapCount", micromaps.len());
            each_micromap(micromaps, command, name, visit);
            let pool = (vk::QueryPool::OBJECT_TYPE, query_pool.0);
            handle(visit, &command.field("queryPool"), name, "queryPool", pool);
        }
        Call::WriteMicromapsProperties { micromaps, query_type, data_size, .. } => {
            count(visit, command, name, "micromapCount", micromaps.len());
            each_micromap(micromaps, command, name, visit);
            enumerant(visit, command, name, "queryType", *query_type);
            visit(&command.field("dataSize"), name, Item::Count { member: "dataSize", found: *data_size });
        }
        Call::DestroyDeferredOperation { operation, .. }
        | Call::GetDeferredOperationMaxConcurrency { operation, .. }
        | Call::GetDeferredOperationResult { operation, .. }
        | Call::DeferredOperationJoin { operation, .. } => {
            let object = (vk::DeferredOperation::OBJECT_TYPE, operation.0);
            handle(visit, &command.field("operation"), name, "operation", object);
        }
        _ => {}
    }
}

fn each_micromap(micromaps: &[vk::Micromap], command: &At<'_>, owner: &'static str, visit: Visit<'_>) {
    for (index, found) in micromaps.iter().enumerate() {
        handle(visit, &command.element("pMicromaps", index), owner, "pMicromaps", micromap(*found));
    }
}

/// The structures of a chain that devices are created or asked with.
fn device_chain(next: &[ChainStructure], at: &At<'_>, visit: Visit<'_>) {
    for structure in next {
        match structure {
            ChainStructure::OpacityMicromapFeatures(found) => {
                let at = at.chained("VkPhysicalDeviceOpacityMicromapFeaturesKHR");
                structure!(visit, &at, "VkPhysicalDeviceOpacityMicromapFeaturesKHR", found, OpacityMicromapFeatures);
            }
            ChainStructure::OpacityMicromapFeaturesExt(found) => {
                let at = at.chained("VkPhysicalDeviceOpacityMicromapFeaturesEXT");
                structure!(visit, &at, "VkPhysicalDeviceOpacityMicromapFeaturesEXT", found, OpacityMicromapFeaturesExt);
            }
            ChainStructure::OpacityMicromapProperties(found) => {
                let at = at.chained("VkPhysicalDeviceOpacityMicromapPropertiesKHR");
                structure!(
                    visit,
                    &at,
                    "VkPhysicalDeviceOpacityMicromapPropertiesKHR",
                    found,
                    OpacityMicromapProperties
                );
            }
            ChainStructure::OpacityMicromapPropertiesExt(found) => {
                let at = at.chained("VkPhysicalDeviceOpacityMicromapPropertiesEXT");
                structure!(
                    visit,
                    &at,
                    "VkPhysicalDeviceOpacityMicromapPropertiesEXT",
                    found,
                    OpacityMicromapPropertiesExt
                );
            }
            _ => {}
        }
    }
}

fn create_info_2(info: &vk::AccelerationStructureCreateInfo2, at: &At<'_>, visit: Visit<'_>) {
    let owner = "VkAccelerationStructureCreateInfo2KHR";
    structure!(visit, at, "VkAccelerationStructureCreateInfo2KHR", info, AccelerationStructureCreateInfo2);
    let (member, known_bits) = ("createFlags", known(vk::AccelerationStructureCreateFlags::NAMES));
    visit(&at.field(member), owner, Item::Flags { member, found: info.create_flags.into(), known: known_bits });
    let (member, known_bits) = ("addressFlags", known(vk::AddressCommandFlags::NAMES));
    visit(&at.field(member), owner, Item::Flags { member, found: info.address_flags.into(), known: known_bits });
    enumerant(visit, at, owner, "type", info.ty);
}

fn micromap_create_info(info: &vk::MicromapCreateInfo, at: &At<'_>, visit: Visit<'_>) {
    let owner = "VkMicromapCreateInfoEXT";
    structure!(visit, at, "VkMicromapCreateInfoEXT", info, MicromapCreateInfo);
    let (member, known_bits) = ("createFlags", known(vk::MicromapCreateFlags::NAMES));
    visit(&at.field(member), owner, Item::Flags { member, found: info.create_flags.into(), known: known_bits });
    handle(visit, &at.field("buffer"), owner, "buffer", (vk::Buffer::OBJECT_TYPE, info.buffer.0));
    enumerant(visit, at, owner, "type", info.ty);
}

fn micromap_build_info(info: &vk::MicromapBuildInfo, at: &At<'_>, visit: Visit<'_>) {
    let owner = "VkMicromapBuildInfoEXT";
    structure!(visit, at, "VkMicromapBuildInfoEXT", info, MicromapBuildInfo);
    enumerant(visit, at, owner, "type", info.ty);
    let (member, known_bits) = ("flags", known(vk::BuildMicromapFlags::NAMES));
    visit(&at.field(member), owner, Item::Flags { member, found: info.flags.into(), known: known_bits });
}

/// The geometries of a build, of whichever array is given, of both where both are.
fn geometries(info: &vk::BuildGeometryInfo, at: &At<'_>, visit: Visit<'_>) {
    for (index, found) in info.geometries.iter().flatten().enumerate() {
        geometry(found, &at.element("pGeometries", index), visit);
    }
    for (index, found) in info.geometry_pointers.iter().flatten().enumerate() {
        geometry(found, &at.element_pointer("ppGeometries", index), visit);
    }
}

fn geometry(found: &vk::Geometry, at: &At<'_>, visit: Visit<'_>) {
    structure!(visit, at, "VkAccelerationStructureGeometryKHR", found, Geometry);
    for structure in &found.next {
        if let ChainStructure::GeometryMicromapData(data) = structure {
            let at = at.chained("VkAccelerationStructureGeometryMicromapDataKHR");
            structure!(visit, &at, "VkAccelerationStructureGeometryMicromapDataKHR", data, GeometryMicromapData);
            for (index, usage) in data.usage_counts.iter().flatten().enumerate() {
                enumerant(visit, &at.element("pUsageCounts", index), "VkMicromapUsageKHR", "format", usage.format);
            }
            for (index, usage) in data.usage_count_pointers.iter().flatten().enumerate() {
                let at = at.element_pointer("ppUsageCounts", index);
                enumerant(visit, &at, "VkMicromapUsageKHR", "format", usage.format);
            }
        }
    }
    let vk::GeometryData::Triangles(triangles_data) = &found.geometry else { return };
    if found.geometry_type == vk::GeometryType::TRIANGLES {
        let at = at.field("geometry");
        triangles(triangles_data, &at.field("triangles"), visit);
    }
}

fn triangles(found: &vk::GeometryTrianglesData, at: &At<'_>, visit: Visit<'_>) {
    structure!(visit, at, "VkAccelerationStructureGeometryTrianglesDataKHR", found, GeometryTrianglesData);
    for structure in &found.next {
        match structure {
            ChainStructure::TrianglesOpacityMicromap(attached) => {
                let owner = "VkAccelerationStructureTrianglesOpacityMicromapKHR";
                let at = at.chained(owner);
                structure!(
                    visit,
                    &at,
                    "VkAccelerationStructureTrianglesOpacityMicromapKHR",
                    attached,
                    TrianglesOpacityMicromap
                );
                enumerant(visit, &at, owner, "indexType", attached.index_type);
                let object = (vk::AccelerationStructure::OBJECT_TYPE, attached.micromap.0);
                handle(visit, &at.field("micromap"), owner, "micromap", object);
            }
            ChainStructure::TrianglesOpacityMicromapExt(attached) => {
                let owner = "VkAccelerationStructureTrianglesOpacityMicromapEXT";
                let at = at.chained(owner);
                structure!(
                    visit,
                    &at,
                    "VkAccelerationStructureTrianglesOpacityMicromapEXT",
                    attached,
                    TrianglesOpacityMicromapExt
                );
                enumerant(visit, &at, owner, "indexType", attached.index_type);
                handle(visit, &at.field("micromap"), owner, "micromap", micromap(attached.micromap));
            }
            _ => {}
        }
    }
}
