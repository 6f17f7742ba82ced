//! Rows of `vkCreateDeferredOperationKHR`, `vkDeferredOperationJoinKHR`, `vkDestroyDeferredOperationKHR`,
//! `vkGetDeferredOperationMaxConcurrencyKHR` and `vkGetDeferredOperationResultKHR`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::DeferredHostOperations, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::CreateDeferredOperationDeviceParameter,
        "A deferred operation belongs to a device, and a stale handle makes the loader call into an unloaded driver. \
         Create it while the device lives.",
    )
    .implicit(),
    row(
        RuleId::CreateDeferredOperationAllocatorParameter,
        "The driver allocates the operation with these functions, and a broken table crashes it at once or when the \
         operation is destroyed. Pass NULL or a complete table.",
    )
    .implicit()
    .structural("Allocation callbacks are functions of the host program and no part of a Call."),
    row(
        RuleId::CreateDeferredOperationDeferredOperationParameter,
        "The driver stores the handle where this points to, also if that is a null pointer. Pass the address of a \
         VkDeferredOperationKHR variable.",
    )
    .implicit()
    .structural("A Call names the handle that was returned instead of the place it was written to."),
    row(
        RuleId::CreateDeferredOperationDeviceQueuecount,
        "Deferred operations serve work whose results a queue will use, and a device without queues need not support \
         them. Create the device with at least one queue.",
    )
    .implicit(),
    row(
        RuleId::DeferredOperationJoinDeviceParameter,
        "A worker thread that joins after the device was destroyed runs code of a driver that has gone. Let every \
         worker finish before the device is destroyed.",
    )
    .implicit(),
    row(
        RuleId::DeferredOperationJoinOperationParameter,
        "The thread offers itself to an operation that does not exist, mostly because another thread saw it complete \
         and destroyed it. Destroy an operation only when no thread will join it any more.",
    )
    .implicit(),
    row(
        RuleId::DeferredOperationJoinOperationParent,
        "The worker joins through another device than the one whose work it is, and the driver looks for it among \
         the wrong operations. Keep operation and device together in what is handed to workers.",
    )
    .implicit(),
    row(
        RuleId::DestroyDeferredOperationAllocator03434,
        "Memory has to return to the allocator that it came from; freeing it with another corrupts both heaps. Pass \
         the callbacks that the operation was created with, or compatible ones.",
    )
    .structural("Allocation callbacks are functions of the host program and no part of a Call."),
    row(
        RuleId::DestroyDeferredOperationAllocator03435,
        "The driver's own allocator made the operation, and foreign callbacks cannot free that memory. Pass NULL, as \
         at creation.",
    )
    .structural("Allocation callbacks are functions of the host program and no part of a Call."),
    row(
        RuleId::Operation03436,
        "Worker threads may still be building with state that belongs to the operation, which is freed under their \
         hands. Join until one thread gets VK_SUCCESS, or ask for the result until it is no longer VK_NOT_READY, and \
         destroy then. That a thread was told to leave does not mean that the others are done.",
    ),
    row(
        RuleId::DestroyDeferredOperationDeviceParameter,
        "Objects are given back to the device that made them, and that device is gone or was never there. Destroy \
         its operations before the device.",
    )
    .implicit(),
    row(
        RuleId::DestroyDeferredOperationOperationParameter,
        "The operation is destroyed a second time, or was never created, and the driver frees memory that may belong \
         to another object by now. Forget a handle when its object is destroyed; null is fine.",
    )
    .implicit(),
    row(
        RuleId::DestroyDeferredOperationAllocatorParameter,
        "The driver frees the operation through these functions and follows whatever the pointer leads to. Pass \
         NULL, or the table used at creation while it is still alive.",
    )
    .implicit()
    .structural("Allocation callbacks are functions of the host program and no part of a Call."),
    row(
        RuleId::DestroyDeferredOperationOperationParent,
        "One device frees what another allocated, which corrupts the memory of both. Destroy the operation through \
         the device that created it.",
    )
    .implicit(),
    row(
        RuleId::GetDeferredOperationMaxConcurrencyDeviceParameter,
        "The question how many threads may help goes to a driver that is no longer there. Ask while the device \
         lives.",
    )
    .implicit(),
    row(
        RuleId::GetDeferredOperationMaxConcurrencyOperationParameter,
        "The number of helpers is read from an object that does not exist, so a thread pool may be sized from \
         garbage. Ask before the operation is destroyed.",
    )
    .implicit(),
    row(
        RuleId::GetDeferredOperationMaxConcurrencyOperationParent,
        "Another device does not know this operation, and what it answers is no advice on how many threads to start. \
         Ask the device that created the operation.",
    )
    .implicit(),
    row(
        RuleId::GetDeferredOperationResultDeviceParameter,
        "The result is asked of a device that is gone, and with it the work. Fetch results before destroying the \
         device.",
    )
    .implicit(),
    row(
        RuleId::GetDeferredOperationResultOperationParameter,
        "The result lies in the operation, and reading it from a destroyed one may report success for a build that \
         never finished. Ask first, destroy afterwards.",
    )
    .implicit(),
    row(
        RuleId::GetDeferredOperationResultOperationParent,
        "The device has no such operation, so the result it reports belongs to nothing that the application \
         deferred. Ask the device on which the command was deferred.",
    )
    .implicit(),
];
