//! Every command that is not submitted work: it acts when it is called, or is recorded.

use omm_model::call::{Call, Output};

use super::Device;
use super::info::filled;
use crate::build::sizes;
use crate::names::names_holder;
use crate::query::Results;
use crate::undefined::{Reason, Stop};
use crate::work::Work;

impl Device {
    /// Every command but `vkQueueSubmit`.
    pub(super) fn at_once(&mut self, call: &Call) -> Result<Output, Stop> {
        match call {
            Call::CreateBuffer { device: _, create_info, buffer } => self.memory.create_buffer(create_info, *buffer),
            Call::DestroyBuffer { device: _, buffer } => self.memory.destroy_buffer(*buffer),
            Call::AllocateMemory { device: _, allocate_info, memory } => self.memory.allocate(allocate_info, *memory),
            Call::FreeMemory { device: _, memory } => self.memory.free(*memory),
            Call::BindBufferMemory { device: _, buffer, memory, memory_offset } => {
                self.memory.bind_buffer(*buffer, *memory, *memory_offset)
            }
            Call::GetBufferDeviceAddress { device: _, info } => self.memory.buffer_address(info.buffer),
            Call::CreateCommandPool { device: _, create_info, command_pool } => {
                self.command_buffers.create_pool(create_info, *command_pool)
            }
            Call::DestroyCommandPool { device: _, command_pool } => self.command_buffers.destroy_pool(*command_pool),
            Call::AllocateCommandBuffers { device: _, allocate_info, command_buffers } => {
                self.command_buffers.allocate(allocate_info, command_buffers)
            }
            Call::BeginCommandBuffer { command_buffer, begin_info } => {
                self.command_buffers.begin(*command_buffer, begin_info)
            }
            Call::FreeCommandBuffers { device: _, command_pool, command_buffers } => {
                self.command_buffers.free(*command_pool, command_buffers)
            }
            Call::ResetCommandBuffer { command_buffer, flags: _ } => self.command_buffers.reset(*command_buffer),
            Call::QueueBindSparse { queue: _, buffer_binds } => self.memory.bind_sparse(buffer_binds),
            Call::EndCommandBuffer { command_buffer } => self.command_buffers.end(*command_buffer),
            Call::CreateQueryPool { device: _, create_info, query_pool } => {
                self.queries.create(create_info, *query_pool)
            }
            Call::DestroyQueryPool { device: _, query_pool } => {
                let output = self.queries.destroy(*query_pool)?;
                self.command_buffers.invalidate(|call| crate::names::names_query_pool(call, *query_pool));
                Ok(output)
            }
            Call::ResetQueryPool { device: _, query_pool, first_query, query_count } => {
                self.queries.reset(*query_pool, *first_query, *query_count)
            }
            &Call::GetQueryPoolResults {
                device: _,
                query_pool,
                first_query,
                query_count,
                data_size,
                stride,
                flags,
            } => self.queries.results(&Results { query_pool, first_query, query_count, data_size, stride, flags }),
            Call::CreateAccelerationStructure { device: _, create_info, acceleration_structure } => {
                self.structures.create(&self.memory, create_info, *acceleration_structure)
            }
            Call::CreateAccelerationStructure2 { device: _, create_info, acceleration_structure } => {
                self.structures.create2(&self.memory, create_info, *acceleration_structure)
            }
            Call::DestroyAccelerationStructure { device: _, acceleration_structure } => {
                let output = self.structures.destroy(*acceleration_structure)?;
                self.command_buffers.invalidate(|call| names_holder(call, (*acceleration_structure).into()));
                Ok(output)
            }
            Call::GetAccelerationStructureDeviceAddress { device: _, info } => {
                self.structures.device_address(&self.memory, info.acceleration_structure)
            }
            Call::GetAccelerationStructureBuildSizes { device: _, build_type, build_info, max_primitive_counts } => {
                sizes::query(&self.profile.limits, *build_type, build_info, max_primitive_counts.as_deref())
                    .map(Output::BuildSizes)
            }
            Call::GetDeviceAccelerationStructureCompatibility { device: _, version_info } => {
                self.compatibility(&version_info.version_data).map(Output::Compatibility)
            }
            &Call::WriteAccelerationStructuresProperties {
                device: _,
                ref acceleration_structures,
                query_type,
                data_size,
                stride,
            } => self.host_properties(acceleration_structures, query_type, data_size, stride).map(Output::Properties),
            _ => self.other(call),
        }
    }

    /// Commands of other extensions, those that are only kept, and those that write memory.
    fn other(&mut self, call: &Call) -> Result<Output, Stop> {
        match call {
            Call::CreateMicromap { device: _, create_info, micromap } => {
                self.micromaps.create(&self.memory, create_info, *micromap)
            }
            Call::DestroyMicromap { device: _, micromap } => {
                let output = self.micromaps.destroy(*micromap)?;
                self.command_buffers.invalidate(|call| names_holder(call, (*micromap).into()));
                Ok(output)
            }
            Call::GetMicromapBuildSizes { device: _, build_type, build_info } => {
                sizes::query_micromap(*build_type, build_info).map(Output::MicromapBuildSizes)
            }
            Call::GetDeviceMicromapCompatibility { device: _, version_info } => {
                self.compatibility(&version_info.version_data).map(Output::Compatibility)
            }
            &Call::WriteMicromapsProperties { device: _, ref micromaps, query_type, data_size, stride } => {
                self.host_properties(micromaps, query_type, data_size, stride).map(Output::Properties)
            }
            Call::CreateDeferredOperation { device: _, deferred_operation } => {
                self.operations.create(*deferred_operation)
            }
            Call::DestroyDeferredOperation { device: _, operation } => self.operations.destroy(*operation),
            Call::GetDeferredOperationMaxConcurrency { device: _, operation } => {
                self.operations.max_concurrency(*operation)
            }
            Call::GetDeferredOperationResult { device: _, operation } => self.operations.result(*operation),
            Call::GetPhysicalDeviceFeatures2 { physical_device: _, features } => {
                Ok(filled(&self.profile, &features.next))
            }
            Call::GetPhysicalDeviceProperties2 { physical_device: _, properties } => {
                Ok(filled(&self.profile, &properties.next))
            }
            // Whatever device and queues there are, they are this one.
            Call::CreateDevice { .. } | Call::DestroyDevice { .. } | Call::GetDeviceQueue { .. } => Ok(Output::None),
            Call::CreateRayTracingPipelines { device: _, create_infos, pipelines } => {
                let handles = pipelines.iter().map(|pipeline| pipeline.0);
                self.pipelines.create(handles, create_infos.iter().map(|info| info.flags), "pPipelines")
            }
            Call::DestroyPipeline { device: _, pipeline } => {
                let output = self.pipelines.destroy(pipeline.0, "pipeline")?;
                self.command_buffers
                    .invalidate(|call| matches!(call, Call::CmdTraceRays { pipeline: named, .. } if named == pipeline));
                Ok(output)
            }
            Call::CreateShaders { device: _, create_infos, shaders } => {
                let handles = shaders.iter().map(|shader| shader.0);
                self.shaders.create(handles, create_infos.iter().map(|info| info.flags), "pShaders")
            }
            Call::DestroyShader { device: _, shader } => {
                let output = self.shaders.destroy(shader.0, "shader")?;
                self.command_buffers
                    .invalidate(|call| matches!(call, Call::CmdDispatch { shader: named, .. } if named == shader));
                Ok(output)
            }
            _ => match (call.recorded_into(), Work::of(call)) {
                (Some(command_buffer), _) => {
                    crate::names::check(self, call)?;
                    self.command_buffers.record(command_buffer, call)
                }
                (None, Some(work)) => self.host_work(call, &work),
                (None, None) => Err(Reason::Unsupported { what: "the command" }.into()),
            },
        }
    }
}
