//! Rows of `VkMicromapCreateInfoEXT`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::ExtOpacityMicromap, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::ReplayAddress07433,
        "A wished-for address is honoured only for objects that are part of capture and replay; without the flag a \
         driver places the micromap where it likes or fails. Set the flag, or leave the address 0. The extension has \
         no command that tells a micromap's address, so few programs have a use for this.",
    ),
    row(
        RuleId::CaptureReplay11616,
        "Without the feature the driver has not reserved an address range that it can restore, and the object's \
         address in the next run is another. Enable micromapCaptureReplay when the device is created, or drop the \
         flag.",
    ),
    row(
        RuleId::MultiDeviceReplay11617,
        "On a device made of several GPUs each has its own address space; that an address means the same on all of \
         them is what bufferDeviceAddressMultiDevice promises. Enable it, or create the device from one physical \
         device.",
    ),
    row(
        RuleId::BufferUsage07435,
        "Drivers choose alignment, caching and memory types of a buffer by its usage, and ray-tracing units may not \
         reach one that was not meant for micromaps. Create the buffer with \
         VK_BUFFER_USAGE_MICROMAP_STORAGE_BIT_EXT.",
    ),
    row(
        RuleId::SparseBuffer07436,
        "A sparse-resident buffer may have holes, and traversal that reads a micromap has no way to survive one. Put \
         micromaps into a buffer that is bound as a whole; sparse binding without residency is allowed.",
    ),
    row(
        RuleId::Range07437,
        "The micromap would reach beyond its buffer, and a build writes into whatever lies there. Enlarge the buffer \
         or correct offset and size. The sum is taken without wrapping, so that sizes near 2 to the 64th are caught.",
    ),
    row(
        RuleId::Offset07438,
        "Hardware refers to a micromap with the lowest address bits left out; a place in between cannot be named and \
         is rounded down into another object. Align the offset to 256.",
    ),
    row(
        RuleId::MicromapCreateInfoSType,
        "The driver expects the creation of a micromap, and a layer below you may take the structure for something \
         else and drop it. Fill in the type of a micromap creation.",
    )
    .implicit(),
    row(
        RuleId::MicromapCreateInfoNext,
        "A micromap is created from the members alone; chained structures such as those for acceleration structures \
         with motion do nothing here. Set pNext to NULL.",
    )
    .implicit(),
    row(
        RuleId::MicromapCreateInfoCreateFlagsParameter,
        "A micromap has one create flag; others come from acceleration structures or from memory that was not \
         cleared, and a later driver may give them a meaning. Clear them.",
    )
    .implicit(),
    row(
        RuleId::MicromapCreateInfoBufferParameter,
        "A micromap lives in a range of a buffer; without a living one it has no memory, now or later. Create the \
         buffer first and destroy it last.",
    )
    .implicit(),
    row(
        RuleId::MicromapCreateInfoTypeParameter,
        "An object of a type that the driver does not know can never be built, since the build must have the same \
         type. Use VK_MICROMAP_TYPE_OPACITY_MICROMAP_EXT. Displacement is a known type and passes this rule; our \
         device refuses it as out of its scope.",
    )
    .implicit(),
    row(
        RuleId::MicromapCreateInfoDeviceAddressParameter,
        "An address that no earlier run of the same driver gave out cannot be honoured, and creation fails or places \
         the micromap over something else. Leave it 0. The extension kept the member but has no command that tells \
         the address, so there is nothing to compare with.",
    )
    .implicit()
    .structural(
        "Valid would be an address that an earlier run was given for an identical micromap, but no command of the \
         extension gives out a micromap's address, so the calls cannot tell a valid one.",
    ),
];
