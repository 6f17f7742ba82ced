//! The objects that a call names, of whatever kind.

use omm_model::call::Call;
use omm_model::vk;

use crate::location::{At, Object};

/// Takes the path of a handle, the object, and whether it may be null.
pub(crate) type Visit<'v> = &'v mut dyn FnMut(&At<'_>, Object, bool);

macro_rules! object {
    ($type:ident, $handle:expr) => {
        (vk::$type::OBJECT_TYPE, $handle.0)
    };
}

/// Visits every object that a call needs, but for devices and queues: not those that it creates.
pub(crate) fn each_object(call: &Call, command: &At<'_>, visit: Visit<'_>) {
    if let Some(command_buffer) = call.recorded_into() {
        visit(&command.field("commandBuffer"), object!(CommandBuffer, command_buffer), false);
    }
    if let Some(operation) = call.deferred_operation() {
        visit(&command.field("deferredOperation"), object!(DeferredOperation, operation), false);
    }
    match call {
        Call::DestroyBuffer { buffer, .. } => visit(&command.field("buffer"), object!(Buffer, buffer), true),
        Call::FreeMemory { memory, .. } => visit(&command.field("memory"), object!(DeviceMemory, memory), true),
        Call::BindBufferMemory { buffer, memory, .. } => {
            visit(&command.field("buffer"), object!(Buffer, buffer), false);
            visit(&command.field("memory"), object!(DeviceMemory, memory), false);
        }
        Call::QueueBindSparse { buffer_binds, .. } => each_sparse(buffer_binds, command, visit),
        Call::GetBufferDeviceAddress { info, .. } => {
            visit(&command.pointer("pInfo").field("buffer"), object!(Buffer, info.buffer), false);
        }
        Call::CreateAccelerationStructure { create_info, .. } => {
            visit(&command.pointer("pCreateInfo").field("buffer"), object!(Buffer, create_info.buffer), false);
        }
        Call::CreateMicromap { create_info, .. } => {
            visit(&command.pointer("pCreateInfo").field("buffer"), object!(Buffer, create_info.buffer), false);
        }
        Call::DestroyPipeline { pipeline, .. } => {
            visit(&command.field("pipeline"), object!(Pipeline, pipeline), true);
        }
        Call::DestroyShader { shader, .. } => visit(&command.field("shader"), object!(Shader, shader), true),
        Call::CmdTraceRays { pipeline, .. } => visit(&command.field("pipeline"), object!(Pipeline, pipeline), false),
        Call::CmdDispatch { shader, .. } => visit(&command.field("shader"), object!(Shader, shader), false),
        Call::DestroyDeferredOperation { operation, .. } => {
            visit(&command.field("operation"), object!(DeferredOperation, operation), true);
        }
        Call::GetDeferredOperationMaxConcurrency { operation, .. }
        | Call::GetDeferredOperationResult { operation, .. }
        | Call::DeferredOperationJoin { operation, .. } => {
            visit(&command.field("operation"), object!(DeferredOperation, operation), false);
        }
        _ => {
            command_buffers(call, command, visit);
            query_pool(call, command, visit);
            structures(call, command, visit);
            micromaps(call, command, visit);
        }
    }
}

fn each_sparse(infos: &[vk::SparseBufferMemoryBindInfo], command: &At<'_>, visit: Visit<'_>) {
    for (index, info) in infos.iter().enumerate() {
        let at = command.element("pBufferBinds", index);
        visit(&at.field("buffer"), object!(Buffer, info.buffer), false);
        for (index, bind) in info.binds.iter().enumerate() {
            visit(&at.element("pBinds", index).field("memory"), object!(DeviceMemory, bind.memory), true);
        }
    }
}

fn command_buffers(call: &Call, command: &At<'_>, visit: Visit<'_>) {
    let (handles, or_null) = match call {
        Call::DestroyCommandPool { command_pool, .. } => {
            return visit(&command.field("commandPool"), object!(CommandPool, command_pool), true);
        }
        Call::AllocateCommandBuffers { allocate_info, .. } => {
            let at = command.pointer("pAllocateInfo");
            return visit(&at.field("commandPool"), object!(CommandPool, allocate_info.command_pool), false);
        }
        Call::BeginCommandBuffer { command_buffer, .. }
        | Call::EndCommandBuffer { command_buffer }
        | Call::ResetCommandBuffer { command_buffer, .. } => {
            return visit(&command.field("commandBuffer"), object!(CommandBuffer, command_buffer), false);
        }
        Call::FreeCommandBuffers { command_pool, command_buffers, .. } => {
            visit(&command.field("commandPool"), object!(CommandPool, command_pool), false);
            (command_buffers, true)
        }
        Call::QueueSubmit { command_buffers, .. } | Call::CmdExecuteCommands { command_buffers, .. } => {
            (command_buffers, false)
        }
        _ => return,
    };
    for (index, handle) in handles.iter().enumerate() {
        visit(&command.element("pCommandBuffers", index), object!(CommandBuffer, handle), or_null);
    }
}

fn query_pool(call: &Call, command: &At<'_>, visit: Visit<'_>) {
    let (pool, or_null) = match call {
        Call::DestroyQueryPool { query_pool, .. } => (query_pool, true),
        Call::ResetQueryPool { query_pool, .. }
        | Call::CmdResetQueryPool { query_pool, .. }
        | Call::GetQueryPoolResults { query_pool, .. }
        | Call::CmdWriteAccelerationStructuresProperties { query_pool, .. }
        | Call::CmdWriteMicromapsProperties { query_pool, .. } => (query_pool, false),
        _ => return,
    };
    visit(&command.field("queryPool"), object!(QueryPool, pool), or_null);
}

fn structures(call: &Call, command: &At<'_>, visit: Visit<'_>) {
    let info = command.pointer("pInfo");
    let mut one = |at: &At<'_>, handle: vk::AccelerationStructure, or_null: bool| {
        visit(at, object!(AccelerationStructure, handle), or_null);
    };
    match call {
        Call::DestroyAccelerationStructure { acceleration_structure, .. } => {
            one(&command.field("accelerationStructure"), *acceleration_structure, true);
        }
        Call::GetAccelerationStructureDeviceAddress { info: asked, .. } => {
            one(&info.field("accelerationStructure"), asked.acceleration_structure, false);
        }
        Call::CmdBuildAccelerationStructures { infos, .. }
        | Call::CmdBuildAccelerationStructuresIndirect { infos, .. }
        | Call::BuildAccelerationStructures { infos, .. } => {
            for (index, info) in infos.iter().enumerate() {
                build(info, &command.element("pInfos", index), visit);
            }
        }
        Call::CmdCopyAccelerationStructure { info: copy, .. } | Call::CopyAccelerationStructure { info: copy, .. } => {
            one(&info.field("src"), copy.src, false);
            one(&info.field("dst"), copy.dst, false);
        }
        Call::CmdCopyAccelerationStructureToMemory { info: copy, .. }
        | Call::CopyAccelerationStructureToMemory { info: copy, .. } => one(&info.field("src"), copy.src, false),
        Call::CmdCopyMemoryToAccelerationStructure { info: copy, .. }
        | Call::CopyMemoryToAccelerationStructure { info: copy, .. } => one(&info.field("dst"), copy.dst, false),
        Call::CmdWriteAccelerationStructuresProperties { acceleration_structures, .. }
        | Call::WriteAccelerationStructuresProperties { acceleration_structures, .. } => {
            for (index, handle) in acceleration_structures.iter().enumerate() {
                one(&command.element("pAccelerationStructures", index), *handle, false);
            }
        }
        _ => {}
    }
}

fn build(info: &vk::BuildGeometryInfo, at: &At<'_>, visit: Visit<'_>) {
    let (src, dst) = (info.src_acceleration_structure, info.dst_acceleration_structure);
    if info.mode == vk::BuildAccelerationStructureMode::UPDATE {
        visit(&at.field("srcAccelerationStructure"), object!(AccelerationStructure, src), false);
    }
    visit(&at.field("dstAccelerationStructure"), object!(AccelerationStructure, dst), false);
    for (index, geometry) in info.geometries_iter().enumerate() {
        let vk::GeometryData::Triangles(triangles) = &geometry.geometry else { continue };
        if geometry.geometry_type != vk::GeometryType::TRIANGLES {
            continue;
        }
        let at = at.element("pGeometries", index);
        if let Some(attached) = triangles.opacity_micromap() {
            let at = at.chained("VkAccelerationStructureTrianglesOpacityMicromapKHR");
            visit(&at.field("micromap"), object!(AccelerationStructure, attached.micromap), true);
        }
        if let Some(attached) = triangles.opacity_micromap_ext() {
            let at = at.chained("VkAccelerationStructureTrianglesOpacityMicromapEXT");
            visit(&at.field("micromap"), object!(Micromap, attached.micromap), true);
        }
    }
}

fn micromaps(call: &Call, command: &At<'_>, visit: Visit<'_>) {
    let info = command.pointer("pInfo");
    let mut one = |at: &At<'_>, handle: vk::Micromap, or_null: bool| visit(at, object!(Micromap, handle), or_null);
    match call {
        Call::DestroyMicromap { micromap, .. } => one(&command.field("micromap"), *micromap, true),
        Call::CmdBuildMicromaps { infos, .. } | Call::BuildMicromaps { infos, .. } => {
            for (index, info) in infos.iter().enumerate() {
                one(&command.element("pInfos", index).field("dstMicromap"), info.dst_micromap, false);
            }
        }
        Call::CmdCopyMicromap { info: copy, .. } | Call::CopyMicromap { info: copy, .. } => {
            one(&info.field("src"), copy.src, false);
            one(&info.field("dst"), copy.dst, false);
        }
        Call::CmdCopyMicromapToMemory { info: copy, .. } | Call::CopyMicromapToMemory { info: copy, .. } => {
            one(&info.field("src"), copy.src, false);
        }
        Call::CmdCopyMemoryToMicromap { info: copy, .. } | Call::CopyMemoryToMicromap { info: copy, .. } => {
            one(&info.field("dst"), copy.dst, false);
        }
        Call::CmdWriteMicromapsProperties { micromaps, .. } | Call::WriteMicromapsProperties { micromaps, .. } => {
            for (index, handle) in micromaps.iter().enumerate() {
                one(&command.element("pMicromaps", index), *handle, false);
            }
        }
        _ => {}
    }
}
