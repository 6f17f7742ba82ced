//! Submissions: what was recorded is executed.

use omm_model::call::{Call, Output, Timeline};
use omm_model::vk;

use super::Device;
use crate::undefined::{At, Stop, Submitted, Undefined};
use crate::work::Work;

impl Device {
    /// `vkQueueSubmit`: all of it or nothing.
    pub(super) fn submit(&mut self, command_buffers: &[vk::CommandBuffer]) -> Result<Output, Undefined> {
        self.command_buffers.check_submission(command_buffers).map_err(|stop| stop.of("vkQueueSubmit"))?;
        self.memory.begin();
        self.queries.begin();
        let result =
            (0..).zip(command_buffers).try_for_each(|(index, &buffer)| self.execute_command_buffer(index, buffer));
        if let Err(undefined) = result {
            self.memory.roll_back();
            self.queries.roll_back();
            return Err(undefined);
        }
        self.memory.commit();
        self.queries.commit();
        command_buffers.iter().for_each(|&buffer| self.command_buffers.executed(buffer));
        Ok(Output::None)
    }

    /// Executes the commands of a command buffer. Those of a secondary one count as part of the command that executes it.
    fn execute_command_buffer(&mut self, index: usize, buffer: vk::CommandBuffer) -> Result<(), Undefined> {
        let commands = self.command_buffers.take(buffer);
        let result = commands.iter().enumerate().try_for_each(|(command, call)| {
            let submitted = Some(Submitted { command_buffer: index, command });
            match call {
                Call::CmdExecuteCommands { command_buffer: _, command_buffers } => {
                    let mut secondary = command_buffers.iter();
                    let result = secondary.try_for_each(|&buffer| self.execute_command_buffer(index, buffer));
                    result.map_err(|undefined| Undefined { submitted, ..undefined })
                }
                _ => self.execute_recorded(call).map_err(|stop| Undefined { submitted, ..stop.of(call.command()) }),
            }
        });
        self.command_buffers.put_back(buffer, commands);
        result
    }

    /// What a recorded command does once it is submitted.
    fn execute_recorded(&mut self, call: &Call) -> Result<(), Stop> {
        if let Some(work) = Work::of(call) {
            return self.perform(&work, Timeline::Device);
        }
        match call {
            &Call::CmdWriteAccelerationStructuresProperties {
                command_buffer: _,
                ref acceleration_structures,
                query_type,
                query_pool,
                first_query,
            } => {
                let values = self.properties(acceleration_structures, query_type, Timeline::Device)?;
                self.queries.write(query_pool, query_type, first_query, &values)
            }
            &Call::CmdWriteMicromapsProperties {
                command_buffer: _,
                ref micromaps,
                query_type,
                query_pool,
                first_query,
            } => {
                let values = self.properties(micromaps, query_type, Timeline::Device)?;
                self.queries.write(query_pool, query_type, first_query, &values)
            }
            Call::CmdResetQueryPool { command_buffer: _, query_pool, first_query, query_count } => {
                self.queries.reset(*query_pool, *first_query, *query_count).map(drop)
            }
            Call::CmdTraceRays { command_buffer: _, pipeline, top_level } => {
                let flags = *self.pipelines.get(pipeline.0).at("pipeline")?;
                let disallowed = vk::PipelineCreateFlags2::OPACITY_MICROMAP_DISALLOW_MIXED_SPECIAL_INDEX;
                self.trace(*top_level, !flags.contains(disallowed))
            }
            Call::CmdDispatch { command_buffer: _, shader, top_level } => {
                let flags = *self.shaders.get(shader.0).at("shader")?;
                let disallowed = vk::ShaderCreateFlags::OPACITY_MICROMAP_DISALLOW_MIXED_SPECIAL_INDEX;
                self.trace(*top_level, !flags.contains(disallowed))
            }
            _ => Ok(()),
        }
    }
}
