//! Commands: the objects that they are called on, and where they may be recorded.

use crate::rule::RuleId;

/// The rules of a command.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Command {
    /// The command.
    pub(crate) name: &'static str,
    /// Its device lives.
    pub(crate) device: Option<RuleId>,
    /// Its device has a queue.
    pub(crate) queue_count: Option<RuleId>,
    /// What holds of the operation that it may be deferred on.
    pub(crate) deferred: Option<Deferred>,
    /// What holds of the command buffer that it is recorded into.
    pub(crate) recorded: Option<Recorded>,
}

/// The rules on a deferred operation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deferred {
    /// It lives.
    pub(crate) handle: RuleId,
    /// It is of the device.
    pub(crate) parent: RuleId,
}

/// The rules on a command buffer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Recorded {
    /// It lives.
    pub(crate) handle: RuleId,
    /// It is being recorded.
    pub(crate) recording: RuleId,
    /// Its queues compute.
    pub(crate) queue: RuleId,
    /// No render pass instance is open.
    pub(crate) render_pass: RuleId,
    /// None is suspended.
    pub(crate) suspended: RuleId,
}

const fn on_device(name: &'static str, device: RuleId) -> Command {
    Command { name, device: Some(device), queue_count: None, deferred: None, recorded: None }
}

const fn creating(name: &'static str, device: RuleId, queue_count: RuleId) -> Command {
    Command { queue_count: Some(queue_count), ..on_device(name, device) }
}

const fn deferrable(name: &'static str, device: RuleId, handle: RuleId, parent: RuleId) -> Command {
    Command { deferred: Some(Deferred { handle, parent }), ..on_device(name, device) }
}

/// The rules in the order handle, recording, queue, render pass, suspended.
const fn recorded(name: &'static str, rules: [RuleId; 5]) -> Command {
    let [handle, recording, queue, render_pass, suspended] = rules;
    let recorded = Recorded { handle, recording, queue, render_pass, suspended };
    Command { name, device: None, queue_count: None, deferred: None, recorded: Some(recorded) }
}

pub(crate) const COMMANDS: &[Command] = &[
    recorded(
        "vkCmdBuildMicromapsEXT",
        [
            RuleId::CmdBuildMicromapsCommandBufferParameter,
            RuleId::CmdBuildMicromapsRecording,
            RuleId::CmdBuildMicromapsQueue,
            RuleId::CmdBuildMicromapsRenderPass,
            RuleId::CmdBuildMicromapsSuspended,
        ],
    ),
    recorded(
        "vkCmdCopyMicromapEXT",
        [
            RuleId::CmdCopyMicromapCommandBufferParameter,
            RuleId::CmdCopyMicromapRecording,
            RuleId::CmdCopyMicromapQueue,
            RuleId::CmdCopyMicromapRenderPass,
            RuleId::CmdCopyMicromapSuspended,
        ],
    ),
    recorded(
        "vkCmdCopyMicromapToMemoryEXT",
        [
            RuleId::CmdCopyMicromapToMemoryCommandBufferParameter,
            RuleId::CmdCopyMicromapToMemoryRecording,
            RuleId::CmdCopyMicromapToMemoryQueue,
            RuleId::CmdCopyMicromapToMemoryRenderPass,
            RuleId::CmdCopyMicromapToMemorySuspended,
        ],
    ),
    recorded(
        "vkCmdCopyMemoryToMicromapEXT",
        [
            RuleId::CmdCopyMemoryToMicromapCommandBufferParameter,
            RuleId::CmdCopyMemoryToMicromapRecording,
            RuleId::CmdCopyMemoryToMicromapQueue,
            RuleId::CmdCopyMemoryToMicromapRenderPass,
            RuleId::CmdCopyMemoryToMicromapSuspended,
        ],
    ),
    recorded(
        "vkCmdWriteMicromapsPropertiesEXT",
        [
            RuleId::CmdWriteMicromapsPropertiesCommandBufferParameter,
            RuleId::CmdWriteMicromapsPropertiesRecording,
            RuleId::CmdWriteMicromapsPropertiesQueue,
            RuleId::CmdWriteMicromapsPropertiesRenderPass,
            RuleId::CmdWriteMicromapsPropertiesSuspended,
        ],
    ),
    deferrable(
        "vkBuildMicromapsEXT",
        RuleId::BuildMicromapsDeviceParameter,
        RuleId::BuildMicromapsDeferredOperationParameter,
        RuleId::BuildMicromapsDeferredOperationParent,
    ),
    deferrable(
        "vkCopyMicromapEXT",
        RuleId::CopyMicromapDeviceParameter,
        RuleId::CopyMicromapDeferredOperationParameter,
        RuleId::CopyMicromapDeferredOperationParent,
    ),
    deferrable(
        "vkCopyMicromapToMemoryEXT",
        RuleId::CopyMicromapToMemoryDeviceParameter,
        RuleId::CopyMicromapToMemoryDeferredOperationParameter,
        RuleId::CopyMicromapToMemoryDeferredOperationParent,
    ),
    deferrable(
        "vkCopyMemoryToMicromapEXT",
        RuleId::CopyMemoryToMicromapDeviceParameter,
        RuleId::CopyMemoryToMicromapDeferredOperationParameter,
        RuleId::CopyMemoryToMicromapDeferredOperationParent,
    ),
    on_device("vkWriteMicromapsPropertiesEXT", RuleId::WriteMicromapsPropertiesDeviceParameter),
    creating("vkCreateMicromapEXT", RuleId::CreateMicromapDeviceParameter, RuleId::CreateMicromapQueueCount),
    on_device("vkDestroyMicromapEXT", RuleId::DestroyMicromapDeviceParameter),
    on_device("vkGetDeviceMicromapCompatibilityEXT", RuleId::GetDeviceMicromapCompatibilityDeviceParameter),
    on_device("vkGetMicromapBuildSizesEXT", RuleId::GetMicromapBuildSizesDeviceParameter),
    creating(
        "vkCreateAccelerationStructure2KHR",
        RuleId::CreateAccelerationStructure2DeviceParameter,
        RuleId::CreateAccelerationStructure2DeviceQueuecount,
    ),
    creating(
        "vkCreateDeferredOperationKHR",
        RuleId::CreateDeferredOperationDeviceParameter,
        RuleId::CreateDeferredOperationDeviceQueuecount,
    ),
    on_device("vkDestroyDeferredOperationKHR", RuleId::DestroyDeferredOperationDeviceParameter),
    on_device("vkGetDeferredOperationMaxConcurrencyKHR", RuleId::GetDeferredOperationMaxConcurrencyDeviceParameter),
    on_device("vkGetDeferredOperationResultKHR", RuleId::GetDeferredOperationResultDeviceParameter),
    on_device("vkDeferredOperationJoinKHR", RuleId::DeferredOperationJoinDeviceParameter),
];
