//! A call in one line.

use omm_model::call::{Call, Output};
use omm_model::vk;

use crate::objects::Objects;
use crate::show;
use crate::tree::Tree;

/// What a command is given, as far as it matters to a reader: objects, types, counts, what is not zero.
pub(crate) fn call(call: &Call, objects: &Objects) -> String {
    match call {
        Call::CmdBuildAccelerationStructures { infos, build_range_infos, .. }
        | Call::BuildAccelerationStructures { infos, build_range_infos, .. } => {
            let ranges = |index: usize| build_range_infos.get(index).and_then(Option::as_deref).unwrap_or_default();
            let infos = infos.iter().enumerate().map(|(index, info)| build(info, ranges(index), objects));
            infos.collect::<Vec<_>>().join("; ")
        }
        Call::CmdBuildAccelerationStructuresIndirect { infos, max_primitive_counts, .. } => {
            let range = |count: &u32| vk::BuildRangeInfo { primitive_count: *count, ..Default::default() };
            let ranges = |counts: &Option<Vec<u32>>| counts.iter().flatten().map(range).collect::<Vec<_>>();
            let infos = infos.iter().zip(max_primitive_counts);
            let infos = infos.map(|(info, counts)| format!("at most {}", build(info, &ranges(counts), objects)));
            infos.collect::<Vec<_>>().join("; ")
        }
        Call::GetAccelerationStructureBuildSizes { build_info, .. } => build(build_info, &[], objects),
        Call::CmdBuildMicromaps { infos, .. } | Call::BuildMicromaps { infos, .. } => {
            infos.iter().map(|info| build_micromap(info, objects)).collect::<Vec<_>>().join("; ")
        }
        Call::GetMicromapBuildSizes { build_info, .. } => build_micromap(build_info, objects),
        call => plain(call, objects),
    }
}

/// All parameters but those that every command has.
fn plain(call: &Call, objects: &Objects) -> String {
    let Ok(tree) = Tree::of(call) else { return String::new() };
    let Tree::Struct(_, fields) = tree.body() else { return String::new() };
    let skipped = ["device", "physical_device", "command_buffer", "queue"];
    let mut fields: Vec<_> =
        fields.iter().filter(|(name, field)| !skipped.contains(name) && !field.is_zero()).collect();
    // A structure that is the only parameter shows its members.
    if let [(_, structure @ Tree::Struct(_, members))] = fields.as_slice() {
        let _ = structure;
        fields = members.iter().filter(|(name, member)| *name != "s_type" && !member.is_zero()).collect();
    }
    let shown = fields
        .iter()
        .map(|(name, field)| format!("{}: {}", crate::path::field_name(name, field), show::value(field, objects)));
    shown.collect::<Vec<_>>().join(", ")
}

fn constant(type_name: &str, value: i32) -> String {
    crate::constant::of_type(type_name).map_or_else(|| value.to_string(), |constants| constants.show(value.into()))
}

/// `card = BOTTOM_LEVEL of 2 triangles with leaf by UINT16`
fn build(info: &vk::BuildGeometryInfo, ranges: &[vk::BuildRangeInfo], objects: &Objects) -> String {
    let name = |handle: vk::AccelerationStructure| {
        let name = objects.name_of_handle("AccelerationStructure", handle.0);
        name.map_or_else(
            || if handle.is_null() { "null".to_owned() } else { format!("{:#x}", handle.0) },
            str::to_owned,
        )
    };
    let mut text = name(info.dst_acceleration_structure);
    if info.mode == vk::BuildAccelerationStructureMode::UPDATE {
        text += &format!(" updated from {}", name(info.src_acceleration_structure));
    }
    text += &format!(" = {}", constant("AccelerationStructureType", info.ty.0));
    let geometry = |(index, geometry): (usize, &vk::Geometry)| {
        let count = ranges.get(index).map(|range| format!("{} ", range.primitive_count)).unwrap_or_default();
        match &geometry.geometry {
            vk::GeometryData::Triangles(triangles) => {
                let attached =
                    triangles.opacity_micromap().map(|attached| (name(attached.micromap), attached.index_type));
                let attached = attached.or_else(|| {
                    let attached = triangles.opacity_micromap_ext()?;
                    let found = objects.name_of_handle("Micromap", attached.micromap.0).unwrap_or("null");
                    Some((found.to_owned(), attached.index_type))
                });
                let attached = attached.map(|(name, ty)| format!(" with {name} by {}", constant("IndexType", ty.0)));
                format!("{count}triangles{}", attached.unwrap_or_default())
            }
            vk::GeometryData::Aabbs(_) => format!("{count}boxes"),
            vk::GeometryData::Instances(_) => format!("{count}instances"),
            vk::GeometryData::None => match geometry.micromap_data() {
                Some(data) => usages(data.usages().map(|usage| (usage.count, usage.subdivision_level, usage.format.0))),
                None => "nothing".to_owned(),
            },
        }
    };
    let geometries: Vec<_> = info.geometries_iter().enumerate().map(geometry).collect();
    if !geometries.is_empty() {
        text += &format!(" of {}", geometries.join(" and "));
    }
    if !info.flags.is_empty() {
        let flags = crate::constant::of_type("BuildAccelerationStructureFlags");
        text += &format!(", {}", flags.map_or_else(String::new, |flags| flags.show(info.flags.bits().into())));
    }
    text
}

/// `leaf = OPACITY_MICROMAP of 2 × level 1 4_STATE`
fn build_micromap(info: &vk::MicromapBuildInfo, objects: &Objects) -> String {
    let name = objects.name_of_handle("Micromap", info.dst_micromap.0).unwrap_or("null");
    let usages = usages(info.usages().map(|usage| (usage.count, usage.subdivision_level, usage.format as i32)));
    let mut text = format!("{name} = {} of {usages}", constant("MicromapType", info.ty.0));
    if !info.flags.is_empty() {
        let flags = crate::constant::of_type("BuildMicromapFlags");
        text += &format!(", {}", flags.map_or_else(String::new, |flags| flags.show(info.flags.bits().into())));
    }
    text
}

/// Usage counts: so many triangles of a level and format.
fn usages(usages: impl Iterator<Item = (u32, u32, i32)>) -> String {
    let usage = |(count, level, format): (u32, u32, i32)| {
        format!("{count} × level {level} {}", constant("OpacityMicromapFormat", format))
    };
    let all: Vec<String> = usages.map(usage).collect();
    if all.is_empty() { "no triangles".to_owned() } else { all.join(" and ") }
}

/// What a command returned; `None` where that is nothing.
pub(crate) fn output(output: &Output, objects: &Objects) -> Option<String> {
    let values = |values: &[u64]| values.iter().map(u64::to_string).collect::<Vec<_>>().join(", ");
    Some(match output {
        Output::None => return None,
        Output::Result(result) => result.name().map_or_else(|| result.0.to_string(), str::to_owned),
        Output::DeviceAddress(address) => {
            objects.name_of_address(address.0, false).unwrap_or_else(|| format!("{:#x}", address.0))
        }
        Output::BuildSizes(sizes) => format!(
            "structure {}, build scratch {}, update scratch {}",
            sizes.acceleration_structure_size, sizes.build_scratch_size, sizes.update_scratch_size
        ),
        Output::MicromapBuildSizes(sizes) => {
            let discardable = if sizes.discardable.is_true() { ", discardable" } else { "" };
            format!("micromap {}, build scratch {}{discardable}", sizes.micromap_size, sizes.build_scratch_size)
        }
        Output::Compatibility(found) => constant("AccelerationStructureCompatibility", found.0).to_lowercase(),
        Output::QueryResults(found) | Output::Properties(found) => values(found),
        Output::MaxConcurrency(count) => count.to_string(),
        Output::Structures(chain) => {
            let tree = Tree::of(chain).ok()?;
            show::value(&tree, objects)
        }
        other => format!("{other:?}"),
    })
}
