//! Rows of `vkCreateAccelerationStructure2KHR`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::CreateAccelerationStructure2, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::Feature03611,
        "Without the feature the command may not even have a body, and calling it jumps to nowhere. Enable \
         accelerationStructure when creating the device.",
    ),
    row(
        RuleId::Feature13086,
        "The command came with the device-address commands, and a device created without their feature need not \
         provide it; yet no other command can make a micromap. Enable deviceAddressCommands beside the micromap \
         feature.",
    ),
    row(
        RuleId::CreateAccelerationStructure2DeviceParameter,
        "The object is made by a device, and through a stale or foreign handle the loader jumps into freed memory. \
         Create it before the device is destroyed, on the device that will build it.",
    )
    .implicit(),
    row(
        RuleId::CreateAccelerationStructure2CreateInfoParameter,
        "The driver reads the structure through this pointer and crashes on a null or stale one. Pass the address of \
         a filled VkAccelerationStructureCreateInfo2KHR that lives until the call returns.",
    )
    .implicit()
    .structural(
        "A Call holds the creation structure itself, so a pointer to nothing cannot be written down; what is wrong \
         inside it has rules of its own.",
    ),
    row(
        RuleId::CreateAccelerationStructure2AllocatorParameter,
        "The driver calls these functions for its own memory, and a stale table sends it anywhere. Pass NULL, or a \
         table of callbacks that outlives the acceleration structure.",
    )
    .implicit()
    .structural("Allocation callbacks are functions of the host program and no part of a Call."),
    row(
        RuleId::CreateAccelerationStructure2AccelerationStructureParameter,
        "The new handle is written through this pointer, over whatever it points to. Pass the address of a \
         VkAccelerationStructureKHR variable.",
    )
    .implicit()
    .structural("A Call names the handle that was returned instead of the place it was written to."),
    row(
        RuleId::CreateAccelerationStructure2DeviceQueuecount,
        "A device without queues can execute nothing, and drivers leave out what objects for execution need. Create \
         the device with at least one queue before creating acceleration structures on it.",
    )
    .implicit(),
];
