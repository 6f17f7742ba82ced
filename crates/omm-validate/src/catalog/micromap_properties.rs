//! Rows of `vkWriteMicromapsPropertiesEXT`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::ExtOpacityMicromap, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::HostCompactedSizeFlag07502,
        "A build without the flag stores no compacted size, so what comes back is stale or zero, and a micromap \
         created from it is too small. Set VK_BUILD_MICROMAP_ALLOW_COMPACTION_BIT_EXT in the build, on whichever \
         timeline it ran, or do not compact.",
    ),
    row(
        RuleId::HostQueryType07503,
        "A micromap object has two sizes to ask for; the query types of acceleration structures mean other objects, \
         and the driver would read a micromap as one. Use one of the two micromap types.",
    ),
    row(
        RuleId::Stride10071,
        "Each size is a 64-bit number, and with such a stride the second is stored across an alignment boundary. Use \
         8, or a multiple of it. A stride of 0 passes the words, and then each size overwrites the one before.",
    ),
    row(
        RuleId::Data10072,
        "The driver stores 64-bit sizes at pData, and an array of fewer than 8 bytes has room for none, so it writes \
         over what follows. Pass an array of uint64_t. What type the pointer has in the program cannot be seen; we \
         read the rule as: there is room for one VkDeviceSize, which dataSize tells.",
    ),
    row(
        RuleId::DataSize07576,
        "The sizes are written one stride apart, and the last ones would land behind the array. Allocate count times \
         stride bytes. The rule asks for a whole stride behind the last size too, although only 8 bytes of it are \
         written; we ask what it asks.",
    ),
    row(
        RuleId::HostPropertiesMemory07577,
        "Host commands run on the CPU, which reads the size through a mapping of the micromap's memory; device-local \
         memory without host access has none. Bind the buffer to a host-visible memory type, or record the device \
         command instead.",
    ),
    row(
        RuleId::HostPropertiesFeature07578,
        "Reading sizes of micromaps on the CPU is optional, and few drivers offer it; without the feature the \
         function may be a stub that crashes. Enable micromapHostCommands where the device supports it, or record \
         the command of the device timeline.",
    ),
    row(
        RuleId::HostPropertiesInstances07579,
        "Memory with several instances has one copy on each GPU of a device group, and the CPU cannot say which one \
         it is to ask for the size. Allocate from a heap without instances, or with a device mask of one bit.",
    ),
    row(
        RuleId::HostPropertiesSource11671,
        "The host reads the sizes out of the micromap, and an unbuilt one holds none. Build it first; if the build \
         was deferred, join it to its end, and if it was submitted, wait for it.",
    ),
    row(
        RuleId::WriteMicromapsPropertiesDeviceParameter,
        "Sizes are read through the device that owns the micromaps, and this handle names none. Calls dispatch \
         through the handle, so a wrong one usually crashes in the loader. Pass what vkCreateDevice returned. If it \
         is unknown, nothing else of the call is checked, as features and limits are unknown too.",
    )
    .implicit(),
    row(
        RuleId::WriteMicromapsPropertiesMicromapsParameter,
        "The host reads the size of a micromap that is gone or never was, through a pointer hidden in the handle. \
         Ask only about living ones. Of the array we see its elements, not its address.",
    )
    .implicit(),
    row(
        RuleId::WriteMicromapsPropertiesQueryTypeParameter,
        "A query type that does not exist asks for nothing, and what stands in the array afterwards is undefined. \
         Use one of the two micromap sizes. Types that exist but are of other objects are reported under 07503.",
    )
    .implicit(),
    row(
        RuleId::WriteMicromapsPropertiesDataParameter,
        "The sizes are written into an array of dataSize bytes, and into whatever lies there if the array is smaller \
         or gone. Pass the array whose length you give. The length itself is checked under 07576 and 10072.",
    )
    .implicit()
    .structural("The pointer is where the driver puts its answer; a Call names the answer and has no such pointer."),
    row(
        RuleId::WriteMicromapsPropertiesMicromapCount,
        "With an empty list nothing is written, and the array keeps what it held, which is then taken for sizes. \
         Skip the call for an empty list.",
    )
    .implicit(),
    row(
        RuleId::WriteMicromapsPropertiesDataSize,
        "An array of no bytes cannot take a size, and the driver writes at its address all the same. Pass room for \
         one 64-bit number per micromap.",
    )
    .implicit(),
    row(
        RuleId::WriteMicromapsPropertiesMicromapsParent,
        "The device looks the micromap up among its own objects and finds a stranger. Ask each device about its own \
         micromaps.",
    )
    .implicit(),
];
