//! How calls change the state.

use std::sync::Arc;

use omm_model::call::{Call, Output};
use omm_model::vk;

use super::{
    AccelerationStructureState, Built, CommandBufferState, CommandPoolState, DeferredOperationState, MicromapState,
    QueryPoolState, RecordingState, State, Storage,
};

/// The kind of an object and its handle, of any handle.
macro_rules! object {
    ($type:ident, $handle:expr) => {
        (vk::$type::OBJECT_TYPE, $handle.0)
    };
}

impl State {
    /// Records what `call` did. A command that returned an error did nothing, but for what it tells of an earlier one.
    pub(crate) fn track(&mut self, call: &Call, output: &Output) {
        self.serial = self.serial.wrapping_add(1);
        if super::change::changes(call) {
            self.changed_at = self.serial;
        }
        if let Some(device) = call.device() {
            self.adopt_device(device);
        }
        self.just_serialized.clear();
        if let Call::GetDeferredOperationResult { operation, .. } | Call::DeferredOperationJoin { operation, .. } = call
        {
            self.deferred_result(*operation, output);
            return;
        }
        if matches!(output, Output::Result(result) if result.is_error()) {
            return;
        }
        self.track_objects(call);
        self.track_recording(call);
        self.track_answer(call, output);
        match call {
            Call::BindBufferMemory { buffer, memory, memory_offset, .. } => {
                self.sees_bindings = true;
                if let Some(state) = Arc::make_mut(&mut self.buffers).get_mut(buffer) {
                    state.memory = Some((*memory, *memory_offset));
                }
            }
            Call::QueueBindSparse { buffer_binds, .. } => self.bind_sparse(buffer_binds),
            Call::ResetQueryPool { query_pool, first_query, query_count, .. } => {
                self.reset_queries(*query_pool, *first_query, *query_count);
            }
            Call::BuildAccelerationStructures { .. }
            | Call::CopyAccelerationStructure { .. }
            | Call::CopyAccelerationStructureToMemory { .. }
            | Call::CopyMemoryToAccelerationStructure { .. }
            | Call::BuildMicromaps { .. }
            | Call::CopyMicromap { .. }
            | Call::CopyMicromapToMemory { .. }
            | Call::CopyMemoryToMicromap { .. } => self.host_command(call, output),
            _ => {}
        }
    }

    /// Creation and destruction.
    fn track_objects(&mut self, call: &Call) {
        match call {
            Call::CreateDevice { create_info, device, .. } => self.create_device(*device, create_info),
            Call::DestroyDevice { device } => self.destroy_device(*device),
            Call::GetDeviceQueue { device, queue_family_index, queue, .. } => {
                self.queues.insert(*queue, (*device, *queue_family_index));
                self.created(object!(Queue, queue), Some(*device));
            }
            Call::CreateBuffer { device, create_info, buffer } => {
                self.create_buffer(create_info, *buffer);
                self.created(object!(Buffer, buffer), Some(*device));
            }
            Call::DestroyBuffer { buffer, .. } => {
                self.destroy_buffer(*buffer);
                self.destroyed(object!(Buffer, buffer));
            }
            Call::AllocateMemory { device, allocate_info, memory } => {
                self.allocate_memory(*device, allocate_info, *memory);
                self.created(object!(DeviceMemory, memory), Some(*device));
            }
            Call::FreeMemory { memory, .. } => {
                Arc::make_mut(&mut self.memories).remove(memory);
                self.destroyed(object!(DeviceMemory, memory));
            }
            Call::CreateQueryPool { device, create_info, query_pool } => {
                self.query_pools.insert(*query_pool, QueryPoolState::new(create_info));
                self.created(object!(QueryPool, query_pool), Some(*device));
            }
            Call::DestroyQueryPool { query_pool, .. } => {
                self.query_pools.remove(query_pool);
                self.destroyed(object!(QueryPool, query_pool));
            }
            Call::CreateAccelerationStructure { device, create_info, acceleration_structure: handle } => {
                let vk::AccelerationStructureCreateInfo { buffer, offset, size, ty, create_flags, .. } = *create_info;
                let storage = Storage::Buffer { buffer, offset, size };
                let new = AccelerationStructureState {
                    ty,
                    create_flags,
                    address_flags: None,
                    storage,
                    address: None,
                    contents: None,
                };
                self.acceleration_structures.insert(*handle, new);
                self.created(object!(AccelerationStructure, handle), Some(*device));
            }
            Call::CreateAccelerationStructure2 { device, create_info, acceleration_structure: handle } => {
                let vk::AccelerationStructureCreateInfo2 { address_range, address_flags, ty, create_flags, .. } =
                    *create_info;
                let storage = Storage::AddressRange(address_range);
                let address_flags = Some(address_flags);
                let new = AccelerationStructureState {
                    ty,
                    create_flags,
                    address_flags,
                    storage,
                    address: None,
                    contents: None,
                };
                self.acceleration_structures.insert(*handle, new);
                self.created(object!(AccelerationStructure, handle), Some(*device));
            }
            Call::DestroyAccelerationStructure { acceleration_structure, .. } => {
                self.acceleration_structures.remove(acceleration_structure);
                self.destroyed(object!(AccelerationStructure, acceleration_structure));
            }
            Call::CreateMicromap { device, create_info, micromap } => {
                let vk::MicromapCreateInfo { ty, buffer, offset, size, .. } = *create_info;
                self.micromaps.insert(*micromap, MicromapState { ty, buffer, offset, size, contents: None });
                self.created(object!(Micromap, micromap), Some(*device));
            }
            Call::DestroyMicromap { micromap, .. } => {
                self.micromaps.remove(micromap);
                self.destroyed(object!(Micromap, micromap));
            }
            Call::CreateDeferredOperation { device, deferred_operation } => {
                self.operations.insert(*deferred_operation, DeferredOperationState::default());
                self.created(object!(DeferredOperation, deferred_operation), Some(*device));
            }
            Call::DestroyDeferredOperation { operation, .. } => {
                self.operations.remove(operation);
                self.destroyed(object!(DeferredOperation, operation));
            }
            Call::CreateCommandPool { device, create_info, command_pool } => {
                let queue_family_index = create_info.queue_family_index;
                self.command_pools.insert(*command_pool, CommandPoolState { queue_family_index });
                self.created(object!(CommandPool, command_pool), Some(*device));
            }
            Call::DestroyCommandPool { command_pool, .. } if !command_pool.is_null() => {
                let of_pool = |state: &CommandBufferState| state.command_pool == Some(*command_pool);
                let freed = self.command_buffers.iter().filter(|(_, state)| of_pool(state));
                let freed: Vec<_> = freed.map(|(handle, _)| *handle).collect();
                for handle in freed {
                    self.command_buffers.remove(&handle);
                    self.destroyed(object!(CommandBuffer, handle));
                }
                self.command_pools.remove(command_pool);
                self.destroyed(object!(CommandPool, command_pool));
            }
            Call::AllocateCommandBuffers { device, allocate_info, command_buffers } => {
                let vk::CommandBufferAllocateInfo { command_pool, level, .. } = *allocate_info;
                for handle in command_buffers {
                    self.command_buffers.insert(*handle, CommandBufferState::allocated(command_pool, level));
                    self.created(object!(CommandBuffer, handle), Some(*device));
                }
            }
            Call::FreeCommandBuffers { command_buffers, .. } => {
                for handle in command_buffers {
                    self.command_buffers.remove(handle);
                    self.destroyed(object!(CommandBuffer, handle));
                }
            }
            Call::CreateRayTracingPipelines { device, pipelines, .. } => {
                pipelines.iter().for_each(|it| self.created(object!(Pipeline, it), Some(*device)));
            }
            Call::DestroyPipeline { pipeline, .. } => self.destroyed(object!(Pipeline, pipeline)),
            Call::CreateShaders { device, shaders, .. } => {
                shaders.iter().for_each(|it| self.created(object!(Shader, it), Some(*device)));
            }
            Call::DestroyShader { shader, .. } => self.destroyed(object!(Shader, shader)),
            _ => {}
        }
    }

    /// The life of command buffers, and what is recorded into them.
    fn track_recording(&mut self, call: &Call) {
        match call {
            Call::BeginCommandBuffer { command_buffer, begin_info } => {
                self.recorded_into(*command_buffer).begin(begin_info.flags);
                self.invalidate(object!(CommandBuffer, command_buffer));
            }
            Call::EndCommandBuffer { command_buffer } => {
                self.recorded_into(*command_buffer).recording = RecordingState::Executable;
            }
            Call::ResetCommandBuffer { command_buffer, .. } => {
                self.recorded_into(*command_buffer).reset();
                self.invalidate(object!(CommandBuffer, command_buffer));
            }
            Call::QueueSubmit { command_buffers, .. } => {
                self.replay(command_buffers, &mut |_, _, _| {});
                command_buffers.iter().for_each(|it| self.executed(*it));
            }
            Call::CmdBeginRendering { command_buffer, rendering_info } => {
                self.recorded_into(*command_buffer).begin_rendering(rendering_info);
            }
            Call::CmdEndRendering { command_buffer } => self.recorded_into(*command_buffer).end_rendering(),
            _ => {
                let Some(command_buffer) = call.recorded_into() else { return };
                let serial = self.serial;
                let state = self.recorded_into(command_buffer);
                state.record_call(call, serial);
                record_effects(state, call);
            }
        }
    }

    /// What the program was told.
    fn track_answer(&mut self, call: &Call, output: &Output) {
        match (call, output) {
            (Call::GetBufferDeviceAddress { info, .. }, Output::DeviceAddress(address)) => {
                self.set_buffer_address(info.buffer, *address);
            }
            (Call::GetAccelerationStructureDeviceAddress { info, .. }, Output::DeviceAddress(address)) => {
                if let Some(object) = self.acceleration_structures.get_mut(&info.acceleration_structure) {
                    object.address = Some(*address);
                }
            }
            (Call::GetMicromapBuildSizes { build_type, build_info, .. }, Output::MicromapBuildSizes(sizes)) => {
                self.learn_build_sizes(*build_type, build_info, sizes);
            }
            (
                Call::GetAccelerationStructureBuildSizes { build_type, build_info, max_primitive_counts, .. },
                Output::BuildSizes(sizes),
            ) => {
                let counts = max_primitive_counts.as_deref().unwrap_or_default();
                self.learn_structure_sizes(*build_type, build_info, counts, sizes);
            }
            (Call::GetQueryPoolResults { query_pool, first_query, flags, .. }, Output::QueryResults(values)) => {
                self.read_queries(*query_pool, *first_query, *flags, values);
            }
            (
                Call::WriteAccelerationStructuresProperties { acceleration_structures, query_type, .. },
                Output::Properties(values),
            ) => {
                for (handle, value) in acceleration_structures.iter().zip(values) {
                    self.learn_size(object!(AccelerationStructure, handle), *query_type, *value);
                }
            }
            (Call::WriteMicromapsProperties { micromaps, query_type, .. }, Output::Properties(values)) => {
                for (handle, value) in micromaps.iter().zip(values) {
                    self.learn_size(object!(Micromap, handle), *query_type, *value);
                }
            }
            _ => {}
        }
    }

    /// The command buffer, known from now on if its allocation was not seen.
    fn recorded_into(&mut self, command_buffer: vk::CommandBuffer) -> &mut CommandBufferState {
        self.command_buffers.entry(command_buffer).or_insert_with(CommandBufferState::midway)
    }
}

/// What a command recorded next finds in the acceleration structures that this one fills.
fn record_effects(state: &mut CommandBufferState, call: &Call) {
    let mut build = |info: &vk::BuildGeometryInfo, ranges: &[vk::BuildRangeInfo]| {
        let dst = info.dst_acceleration_structure;
        if info.mode == vk::BuildAccelerationStructureMode::UPDATE {
            state.record_update(info.src_acceleration_structure, dst);
        } else {
            state.record_build(dst, Built::new(info, ranges));
        }
    };
    match call {
        Call::CmdBuildAccelerationStructures { infos, build_range_infos, .. } => {
            for (index, info) in infos.iter().enumerate() {
                build(info, build_range_infos.get(index).and_then(Option::as_deref).unwrap_or_default());
            }
        }
        Call::CmdBuildAccelerationStructuresIndirect { infos, .. } => infos.iter().for_each(|info| build(info, &[])),
        Call::CmdCopyAccelerationStructure { info, .. } => state.record_copy(info.src, info.dst),
        Call::CmdCopyMemoryToAccelerationStructure { info, .. } => state.record_deserialize(info.dst),
        _ => {}
    }
}
