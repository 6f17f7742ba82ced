//! The handles that a recorded command names: they must exist while it is recorded, and their objects until it has executed.

use std::fmt;

use omm_model::call::Call;
use omm_model::vk;

use crate::build::attached;
use crate::device::Device;
use crate::holder::Holder;
use crate::undefined::{At, Stop};
use crate::work::Work;

/// Calls `see` with every acceleration structure and micromap that a recorded command names, and the parameter that names it.
fn holders<E>(call: &Call, mut see: impl FnMut(Holder, fmt::Arguments<'_>) -> Result<(), E>) -> Result<(), E> {
    match Work::of(call) {
        Some(Work::Build(infos, _) | Work::BuildIndirect(infos, _)) => {
            for (i, info) in infos.iter().enumerate() {
                see(info.dst_acceleration_structure.into(), format_args!("pInfos[{i}].dstAccelerationStructure"))?;
                if info.mode == vk::BuildAccelerationStructureMode::UPDATE {
                    see(info.src_acceleration_structure.into(), format_args!("pInfos[{i}].srcAccelerationStructure"))?;
                }
                let array = crate::build::geometry::array_name(info);
                for (j, geometry) in info.geometries_iter().enumerate() {
                    let vk::GeometryData::Triangles(triangles) = &geometry.geometry else {
                        continue;
                    };
                    if let Some((micromap, structure)) = attached::holder(triangles)
                        && geometry.geometry_type == vk::GeometryType::TRIANGLES
                    {
                        see(
                            micromap,
                            format_args!("pInfos[{i}].{array}[{j}].geometry.triangles.{structure}.micromap"),
                        )?;
                    }
                }
            }
        }
        Some(Work::BuildMicromaps(infos)) => {
            for (i, info) in infos.iter().enumerate() {
                see(info.dst_micromap.into(), format_args!("pInfos[{i}].dstMicromap"))?;
            }
        }
        Some(Work::Copy { src, dst, form: _ }) => {
            see(src, format_args!("pInfo->src"))?;
            see(dst, format_args!("pInfo->dst"))?;
        }
        Some(Work::Serialize { src, .. }) => see(src, format_args!("pInfo->src"))?,
        Some(Work::Deserialize { dst, .. }) => see(dst, format_args!("pInfo->dst"))?,
        None => match call {
            Call::CmdWriteAccelerationStructuresProperties { acceleration_structures, .. } => {
                for (i, &structure) in acceleration_structures.iter().enumerate() {
                    see(structure.into(), format_args!("pAccelerationStructures[{i}]"))?;
                }
            }
            Call::CmdWriteMicromapsProperties { micromaps, .. } => {
                for (i, &micromap) in micromaps.iter().enumerate() {
                    see(micromap.into(), format_args!("pMicromaps[{i}]"))?;
                }
            }
            _ => {}
        },
    }
    Ok(())
}

/// The query pool that a recorded command names.
fn query_pool(call: &Call) -> Option<vk::QueryPool> {
    match call {
        Call::CmdWriteAccelerationStructuresProperties { query_pool, .. }
        | Call::CmdWriteMicromapsProperties { query_pool, .. }
        | Call::CmdResetQueryPool { query_pool, .. } => Some(*query_pool),
        _ => None,
    }
}

/// Requires everything that a command names to exist.
pub(crate) fn check(device: &Device, call: &Call) -> Result<(), Stop> {
    holders(call, |holder, at| device.range(holder).map(drop).at(at))?;
    if let Some(pool) = query_pool(call) {
        device.queries.check(pool).at("queryPool")?;
    }
    match call {
        Call::CmdTraceRays { pipeline, .. } => device.pipelines.get(pipeline.0).map(drop).at("pipeline"),
        Call::CmdDispatch { shader, .. } => device.shaders.get(shader.0).map(drop).at("shader"),
        Call::CmdExecuteCommands { command_buffer, command_buffers } => {
            device.command_buffers.check_execution(*command_buffer, command_buffers)
        }
        _ => Ok(()),
    }
}

/// Whether a command names an acceleration structure or micromap.
pub(crate) fn names_holder(call: &Call, holder: Holder) -> bool {
    holders(call, |found, _| if found == holder { Err(()) } else { Ok(()) }).is_err()
}

/// Whether a command names a query pool.
pub(crate) fn names_query_pool(call: &Call, pool: vk::QueryPool) -> bool {
    query_pool(call) == Some(pool)
}
