//! What many commands have in common.

use super::Call;
use crate::vk;

/// Where a command's work is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Timeline {
    /// On the host, at the call or, if it is deferred, while its operation is joined.
    Host,
    /// On the device, when the command buffer that the command is recorded into executes.
    Device,
}

impl Call {
    /// The command buffer that the command is recorded into; `None` for commands that act at once.
    #[must_use]
    pub const fn recorded_into(&self) -> Option<vk::CommandBuffer> {
        match self {
            Self::CmdExecuteCommands { command_buffer, .. }
            | Self::CmdBeginRendering { command_buffer, .. }
            | Self::CmdEndRendering { command_buffer }
            | Self::CmdResetQueryPool { command_buffer, .. }
            | Self::CmdBuildAccelerationStructures { command_buffer, .. }
            | Self::CmdBuildAccelerationStructuresIndirect { command_buffer, .. }
            | Self::CmdCopyAccelerationStructure { command_buffer, .. }
            | Self::CmdCopyAccelerationStructureToMemory { command_buffer, .. }
            | Self::CmdCopyMemoryToAccelerationStructure { command_buffer, .. }
            | Self::CmdWriteAccelerationStructuresProperties { command_buffer, .. }
            | Self::CmdBuildMicromaps { command_buffer, .. }
            | Self::CmdCopyMicromap { command_buffer, .. }
            | Self::CmdCopyMicromapToMemory { command_buffer, .. }
            | Self::CmdCopyMemoryToMicromap { command_buffer, .. }
            | Self::CmdWriteMicromapsProperties { command_buffer, .. }
            | Self::CmdTraceRays { command_buffer, .. }
            | Self::CmdDispatch { command_buffer, .. } => Some(*command_buffer),
            _ => None,
        }
    }

    /// The device that the command is given or creates; `None` for commands that are given a queue, a command buffer or a
    /// physical device only.
    #[must_use]
    pub const fn device(&self) -> Option<vk::Device> {
        match self {
            Self::CreateDevice { device, .. }
            | Self::DestroyDevice { device }
            | Self::GetDeviceQueue { device, .. }
            | Self::CreateBuffer { device, .. }
            | Self::DestroyBuffer { device, .. }
            | Self::AllocateMemory { device, .. }
            | Self::FreeMemory { device, .. }
            | Self::BindBufferMemory { device, .. }
            | Self::GetBufferDeviceAddress { device, .. }
            | Self::CreateCommandPool { device, .. }
            | Self::DestroyCommandPool { device, .. }
            | Self::AllocateCommandBuffers { device, .. }
            | Self::FreeCommandBuffers { device, .. }
            | Self::CreateQueryPool { device, .. }
            | Self::DestroyQueryPool { device, .. }
            | Self::ResetQueryPool { device, .. }
            | Self::GetQueryPoolResults { device, .. }
            | Self::CreateAccelerationStructure { device, .. }
            | Self::CreateAccelerationStructure2 { device, .. }
            | Self::DestroyAccelerationStructure { device, .. }
            | Self::GetAccelerationStructureDeviceAddress { device, .. }
            | Self::GetAccelerationStructureBuildSizes { device, .. }
            | Self::GetDeviceAccelerationStructureCompatibility { device, .. }
            | Self::BuildAccelerationStructures { device, .. }
            | Self::CopyAccelerationStructure { device, .. }
            | Self::CopyAccelerationStructureToMemory { device, .. }
            | Self::CopyMemoryToAccelerationStructure { device, .. }
            | Self::WriteAccelerationStructuresProperties { device, .. }
            | Self::CreateMicromap { device, .. }
            | Self::DestroyMicromap { device, .. }
            | Self::GetMicromapBuildSizes { device, .. }
            | Self::GetDeviceMicromapCompatibility { device, .. }
            | Self::BuildMicromaps { device, .. }
            | Self::CopyMicromap { device, .. }
            | Self::CopyMicromapToMemory { device, .. }
            | Self::CopyMemoryToMicromap { device, .. }
            | Self::WriteMicromapsProperties { device, .. }
            | Self::CreateDeferredOperation { device, .. }
            | Self::DestroyDeferredOperation { device, .. }
            | Self::GetDeferredOperationMaxConcurrency { device, .. }
            | Self::GetDeferredOperationResult { device, .. }
            | Self::DeferredOperationJoin { device, .. }
            | Self::CreateRayTracingPipelines { device, .. }
            | Self::DestroyPipeline { device, .. }
            | Self::CreateShaders { device, .. }
            | Self::DestroyShader { device, .. } => Some(*device),
            _ => None,
        }
    }

    /// Where the command's work is done: on the device exactly if it is [recorded](Self::recorded_into).
    ///
    /// Of a command that exists for both, such as `vkCmdBuildMicromapsEXT` and `vkBuildMicromapsEXT`, this tells the form.
    #[must_use]
    pub const fn timeline(&self) -> Timeline {
        match self.recorded_into() {
            Some(_) => Timeline::Device,
            None => Timeline::Host,
        }
    }

    /// The operation that the command may be deferred on; `None` where that is null and for commands that cannot be deferred.
    #[must_use]
    pub const fn deferred_operation(&self) -> Option<vk::DeferredOperation> {
        match self {
            Self::BuildAccelerationStructures { deferred_operation, .. }
            | Self::CopyAccelerationStructure { deferred_operation, .. }
            | Self::CopyAccelerationStructureToMemory { deferred_operation, .. }
            | Self::CopyMemoryToAccelerationStructure { deferred_operation, .. }
            | Self::BuildMicromaps { deferred_operation, .. }
            | Self::CopyMicromap { deferred_operation, .. }
            | Self::CopyMicromapToMemory { deferred_operation, .. }
            | Self::CopyMemoryToMicromap { deferred_operation, .. }
                if !deferred_operation.is_null() =>
            {
                Some(*deferred_operation)
            }
            _ => None,
        }
    }
}
