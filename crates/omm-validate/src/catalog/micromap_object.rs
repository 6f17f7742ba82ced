//! Rows of `vkCreateMicromapEXT` and `vkDestroyMicromapEXT`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::ExtOpacityMicromap, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::CreateFeature11615,
        "Enabling the extension is not enough: until the feature is switched on in the chain of VkDeviceCreateInfo, \
         the driver need not have what micromaps need. Chain VkPhysicalDeviceOpacityMicromapFeaturesEXT with \
         micromap true.",
    ),
    row(
        RuleId::CreateMicromapDeviceParameter,
        "A new micromap has to belong to a device; this handle was never given out, or the device is gone. Calls \
         dispatch through the handle, so a wrong one usually crashes in the loader. Pass what vkCreateDevice \
         returned. If it is unknown, nothing else of the call is checked, as features and limits are unknown too.",
    )
    .implicit(),
    row(
        RuleId::CreateMicromapCreateInfoParameter,
        "Without parameters there is nothing to create, and a null pointer crashes. Pass the address of a filled \
         VkMicromapCreateInfoEXT.",
    )
    .implicit()
    .structural(
        "A Call holds the structure itself and not a pointer to it, so the pointer is always there; what stands in \
         the structure is checked under its own rules.",
    ),
    row(
        RuleId::CreateMicromapAllocatorParameter,
        "Callbacks that are not functions of the application crash at the first allocation. Pass NULL, or a filled \
         VkAllocationCallbacks that outlives the micromap.",
    )
    .implicit()
    .structural("Allocation callbacks are function pointers, which a Call does not carry."),
    row(
        RuleId::CreateMicromapMicromapParameter,
        "The handle of the new micromap is written here, and with a bad pointer the object exists but nobody can use \
         or destroy it, if the program survives. Pass the address of a variable.",
    )
    .implicit()
    .structural("The pointer is where the driver puts its answer; a Call names the answer and has no such pointer."),
    row(
        RuleId::CreateMicromapQueueCount,
        "A device without queues can execute nothing, so its micromaps could never be built, and drivers skip what \
         such objects need. Ask for a queue when the device is created.",
    )
    .implicit(),
    row(
        RuleId::DestroyFeature11619,
        "A device without the feature can have no micromap to destroy, and its entry point may be empty. Guard the \
         clean-up with the same condition as the creation. The rule makes no exception for the null handle.",
    ),
    row(
        RuleId::Pending07441,
        "If the GPU still reads or writes the micromap while its object goes away, commands run into freed \
         bookkeeping of the driver. Wait for the fence of the last submission that uses the micromap, builds of \
         bottom-level structures included unless the sizes said discardable. Our calls cannot tell a finished \
         submission from an unfinished one.",
    )
    .structural(
        "The vocabulary has neither fences nor waits, and a submission counts as complete when the call returns, so \
         no submitted command can be unfinished.",
    ),
    row(
        RuleId::AllocatorMissing07442,
        "Memory that came from your callbacks would be handed to the driver's own allocator, which frees a pointer \
         it never gave out. Pass callbacks compatible with those of the creation.",
    )
    .structural("Allocation callbacks are function pointers, which a Call does not carry."),
    row(
        RuleId::AllocatorUnexpected07443,
        "The driver's own memory would be handed to callbacks that never allocated it. Pass NULL where the micromap \
         was created with NULL.",
    )
    .structural("Allocation callbacks are function pointers, which a Call does not carry."),
    row(
        RuleId::DestroyMicromapDeviceParameter,
        "Objects die before their device: after vkDestroyDevice there is nobody left to destroy the micromap. Calls \
         dispatch through the handle, so a wrong one usually crashes in the loader. Pass what vkCreateDevice \
         returned. If it is unknown, nothing else of the call is checked, as features and limits are unknown too.",
    )
    .implicit(),
    row(
        RuleId::DestroyMicromapMicromapParameter,
        "Destroying twice frees the same memory twice, which brings down the driver sometimes and much later. Set \
         the variable to VK_NULL_HANDLE after destroying; null is ignored.",
    )
    .implicit(),
    row(
        RuleId::DestroyMicromapAllocatorParameter,
        "The driver calls the free function that it finds here, and garbage is no function. Pass NULL, or the \
         callbacks of the creation.",
    )
    .implicit()
    .structural("Allocation callbacks are function pointers, which a Call does not carry."),
    row(
        RuleId::DestroyMicromapMicromapParent,
        "The wrong device would give the object back to an allocator that never gave it out, and the right one keeps \
         a leak. Destroy with the device that created.",
    )
    .implicit(),
];
