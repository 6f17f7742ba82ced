//! Rows of `VkMicromapBuildInfoEXT`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::ExtOpacityMicromap, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::UsageCounts07516,
        "The usage counts of a build come as an array or as an array of pointers. Given both, the size query and the \
         build may each believe another, and the micromap overruns its memory. Set one of the two pointers to NULL.",
    ),
    row(
        RuleId::UsageFormat11652,
        "How many bits a microtriangle takes follows from the format; for an unknown one the size query answers \
         nonsense and the build writes past it. Store 1 for 2-state or 2 for 4-state; 0 is often a field that was \
         forgotten.",
    ),
    row(
        RuleId::DisplacementUsageFormat11653,
        "Displacement blocks come in three formats, and each has its own size; another number leaves the size open. \
         Use one of the three. Displacement is not simulated by our device, which refuses the type; the rule is \
         checked on the raw numbers.",
    ),
    row(
        RuleId::UsageTwoStateLevel11654,
        "The usage counts announce 2-state triangles that are divided more finely than the device can store, so that \
         sizes derived from them overflow or are cut off. Bake at a coarser level, or split the mesh triangle. Holds \
         for the size query too, which is where it is found earliest.",
    ),
    row(
        RuleId::UsageFourStateLevel11655,
        "The usage counts announce 4-state triangles that are divided more finely than the device can store, so that \
         sizes derived from them overflow or are cut off. Bake at a coarser level, or split the mesh triangle. Holds \
         for the size query too, which is where it is found earliest.",
    ),
    row(
        RuleId::DisplacementUsageLevel11656,
        "The counts announce displacement triangles of a level that the device does not have. Lower it. Displacement \
         is outside what our device simulates; the number is compared with the limit in the profile.",
    ),
    row(
        RuleId::TriangleFormat11657,
        "An entry of the triangle array names a format without a meaning, so it is open how many bits its states \
         take; often a wrong stride, swapped 16-bit fields or memory not yet written. Store 1 or 2 behind the level. \
         The first such entry is reported, as memory is when the build is recorded or called.",
    ),
    row(
        RuleId::DisplacementTriangleFormat11658,
        "An entry of a displacement triangle array has a format outside the three of the NV extension, and its block \
         cannot be located. Correct the entry. Our device does not simulate displacement and refuses the build; the \
         bytes are checked all the same.",
    ),
    row(
        RuleId::TriangleTwoStateLevel11659,
        "An entry of the triangle array is a 2-state triangle finer than the device can look up, whatever the usage \
         counts say; traversal would address microtriangles that were never stored. Bake the triangle at a coarser \
         level. The first such entry is reported.",
    ),
    row(
        RuleId::TriangleFourStateLevel11660,
        "An entry of the triangle array is a 4-state triangle finer than the device can look up, whatever the usage \
         counts say; traversal would address microtriangles that were never stored. Bake the triangle at a coarser \
         level. The first such entry is reported.",
    ),
    row(
        RuleId::DisplacementTriangleLevel11661,
        "An entry of a displacement triangle array is finer than the device displaces. Lower its level. Displacement \
         is not simulated by our device; the bytes are compared with the limit in the profile.",
    ),
    row(
        RuleId::MicromapBuildInfoSType,
        "A build structure that is zeroed but never given its type has type 0, which is that of another structure. \
         Fill in the type of a micromap build.",
    )
    .implicit(),
    row(
        RuleId::MicromapBuildInfoNext,
        "The input of a micromap build stands in its own members; in contrast to the KHR extension nothing is \
         chained, and a chained structure has no effect. Set pNext to NULL.",
    )
    .implicit(),
    row(
        RuleId::MicromapBuildInfoTypeParameter,
        "The type decides how every byte of the input is read, and for an unknown one there is no reading. Use \
         VK_MICROMAP_TYPE_OPACITY_MICROMAP_EXT. Displacement is a known type and passes here; our device says \
         clearly that it does not simulate it.",
    )
    .implicit(),
    row(
        RuleId::MicromapBuildInfoFlagsParameter,
        "Bits without a meaning may get one in a later driver, and then the same program builds something else. \
         Clear them; flags of acceleration-structure builds do not carry over, their bits mean other things here.",
    )
    .implicit(),
    row(
        RuleId::MicromapBuildInfoUsageCountsParameter,
        "The driver reads as many counts as announced; from an array that is shorter, or a pointer that has gone \
         stale, it reads garbage and sizes the micromap by it. Keep the array alive during the call and its length \
         in step with usageCountsCount.",
    )
    .implicit()
    .structural(
        "A Call holds the elements themselves in a Vec; a pointer that is neither NULL nor valid, or an array \
         shorter than its count, cannot be written down.",
    ),
    row(
        RuleId::MicromapBuildInfoUsageCountPointersParameter,
        "Each of the announced pointers is followed, and a null or stale one among them crashes the driver in the \
         middle of a build. Fill all usageCountsCount elements with pointers to living counts.",
    )
    .implicit()
    .structural(
        "A Call holds the elements themselves in a Vec; a pointer that is neither NULL nor valid, or an array \
         shorter than its count, cannot be written down.",
    ),
];
