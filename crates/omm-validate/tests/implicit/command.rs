//! Commands: their device, operation and command buffer.

use omm_model::call::Call;
use omm_model::vk;
use omm_validate::RuleId;

use crate::case::Case;
use crate::world::{COMMAND_BUFFER, GONE, IDLE_DEVICE, NEVER, OTHER_OPERATION, TRANSFER_COMMAND_BUFFER, World};

pub(crate) fn cases() -> Vec<Case> {
    [devices(), operations(), recorded()].into_iter().flatten().collect()
}

fn devices() -> Vec<Case> {
    let mut cases = Vec::new();
    for (rule, base) in [
        (RuleId::BuildMicromapsDeviceParameter, "BuildMicromaps"),
        (RuleId::CopyMicromapDeviceParameter, "CopyMicromap"),
        (RuleId::CopyMicromapToMemoryDeviceParameter, "CopyMicromapToMemory"),
        (RuleId::CopyMemoryToMicromapDeviceParameter, "CopyMemoryToMicromap"),
        (RuleId::WriteMicromapsPropertiesDeviceParameter, "WriteMicromapsProperties"),
        (RuleId::CreateMicromapDeviceParameter, "CreateMicromap"),
        (RuleId::DestroyMicromapDeviceParameter, "DestroyMicromap"),
        (RuleId::GetMicromapBuildSizesDeviceParameter, "GetMicromapBuildSizes"),
        (RuleId::GetDeviceMicromapCompatibilityDeviceParameter, "GetDeviceMicromapCompatibility"),
        (RuleId::CreateAccelerationStructure2DeviceParameter, "CreateAccelerationStructure2"),
        (RuleId::CreateDeferredOperationDeviceParameter, "CreateDeferredOperation"),
        (RuleId::DestroyDeferredOperationDeviceParameter, "DestroyDeferredOperation"),
        (RuleId::GetDeferredOperationMaxConcurrencyDeviceParameter, "GetDeferredOperationMaxConcurrency"),
        (RuleId::GetDeferredOperationResultDeviceParameter, "GetDeferredOperationResult"),
        (RuleId::DeferredOperationJoinDeviceParameter, "DeferredOperationJoin"),
    ] {
        cases.extend([0, GONE, NEVER].map(|device| Case::new(rule, base, "/device", device, "device")));
    }
    for (rule, base) in [
        (RuleId::CreateMicromapQueueCount, "CreateMicromap"),
        (RuleId::CreateAccelerationStructure2DeviceQueuecount, "CreateAccelerationStructure2"),
        (RuleId::CreateDeferredOperationDeviceQueuecount, "CreateDeferredOperation"),
    ] {
        cases.push(Case::new(rule, base, "/device", IDLE_DEVICE.0, "device"));
    }
    cases
}

fn operations() -> Vec<Case> {
    let mut cases = Vec::new();
    for (handle, parent, base) in [
        (
            RuleId::BuildMicromapsDeferredOperationParameter,
            RuleId::BuildMicromapsDeferredOperationParent,
            "BuildMicromaps",
        ),
        (RuleId::CopyMicromapDeferredOperationParameter, RuleId::CopyMicromapDeferredOperationParent, "CopyMicromap"),
        (
            RuleId::CopyMicromapToMemoryDeferredOperationParameter,
            RuleId::CopyMicromapToMemoryDeferredOperationParent,
            "CopyMicromapToMemory",
        ),
        (
            RuleId::CopyMemoryToMicromapDeferredOperationParameter,
            RuleId::CopyMemoryToMicromapDeferredOperationParent,
            "CopyMemoryToMicromap",
        ),
    ] {
        let case = |rule, found: u64| Case::new(rule, base, "/deferred_operation", found, "deferredOperation").good(0);
        cases.extend([case(handle, GONE), case(handle, NEVER), case(parent, OTHER_OPERATION.0)]);
    }
    cases
}

fn recorded() -> Vec<Case> {
    let mut cases = Vec::new();
    for (base, [handle, recording, queue, render_pass, suspended]) in [
        (
            "CmdBuildMicromaps",
            [
                RuleId::CmdBuildMicromapsCommandBufferParameter,
                RuleId::CmdBuildMicromapsRecording,
                RuleId::CmdBuildMicromapsQueue,
                RuleId::CmdBuildMicromapsRenderPass,
                RuleId::CmdBuildMicromapsSuspended,
            ],
        ),
        (
            "CmdCopyMicromap",
            [
                RuleId::CmdCopyMicromapCommandBufferParameter,
                RuleId::CmdCopyMicromapRecording,
                RuleId::CmdCopyMicromapQueue,
                RuleId::CmdCopyMicromapRenderPass,
                RuleId::CmdCopyMicromapSuspended,
            ],
        ),
        (
            "CmdCopyMicromapToMemory",
            [
                RuleId::CmdCopyMicromapToMemoryCommandBufferParameter,
                RuleId::CmdCopyMicromapToMemoryRecording,
                RuleId::CmdCopyMicromapToMemoryQueue,
                RuleId::CmdCopyMicromapToMemoryRenderPass,
                RuleId::CmdCopyMicromapToMemorySuspended,
            ],
        ),
        (
            "CmdCopyMemoryToMicromap",
            [
                RuleId::CmdCopyMemoryToMicromapCommandBufferParameter,
                RuleId::CmdCopyMemoryToMicromapRecording,
                RuleId::CmdCopyMemoryToMicromapQueue,
                RuleId::CmdCopyMemoryToMicromapRenderPass,
                RuleId::CmdCopyMemoryToMicromapSuspended,
            ],
        ),
        (
            "CmdWriteMicromapsProperties",
            [
                RuleId::CmdWriteMicromapsPropertiesCommandBufferParameter,
                RuleId::CmdWriteMicromapsPropertiesRecording,
                RuleId::CmdWriteMicromapsPropertiesQueue,
                RuleId::CmdWriteMicromapsPropertiesRenderPass,
                RuleId::CmdWriteMicromapsPropertiesSuspended,
            ],
        ),
    ] {
        let at = "commandBuffer";
        cases.extend([0, GONE, NEVER].map(|found| Case::new(handle, base, "/command_buffer", found, at)));
        cases.push(Case::new(queue, base, "/command_buffer", TRANSFER_COMMAND_BUFFER.0, at));
        cases.extend([
            Case::after(recording, base, at, end),
            Case::after(recording, base, at, reset),
            Case::after(render_pass, base, at, |world| world.render(vk::RenderingFlags::empty())),
            Case::after(suspended, base, at, |world| {
                world.render(vk::RenderingFlags::SUSPENDING);
                world.track(&Call::CmdEndRendering { command_buffer: COMMAND_BUFFER });
            }),
        ]);
    }
    cases
}

fn end(world: &mut World) {
    world.track(&Call::EndCommandBuffer { command_buffer: COMMAND_BUFFER });
}

fn reset(world: &mut World) {
    let flags = vk::CommandBufferResetFlags::empty();
    world.track(&Call::ResetCommandBuffer { command_buffer: COMMAND_BUFFER, flags });
}
