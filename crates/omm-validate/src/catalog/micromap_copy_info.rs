//! Rows of `VkCopyMemoryToMicromapInfoEXT`, `VkCopyMicromapInfoEXT` and `VkCopyMicromapToMemoryInfoEXT`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::ExtOpacityMicromap, id, explanation)
}

const WHEN_RECORDED: &str = "Memory is read when the command is recorded, or called on the host; not where the same command \
     buffer serializes to that address before.";

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::SerializedData07547,
        "The copy takes sizes and offsets from the data itself and trusts them; other bytes send it through memory \
         at random, on many drivers up to a lost device. Pass data that a serializing copy wrote, complete and \
         unchanged. The text names the device command only; data of the host command is accepted as well, as the \
         description of the commands says. The header that the EXT extension documents ends after the two \
         identifiers, so behind them only data of our own device can be judged.",
    )
    .noted(WHEN_RECORDED),
    row(
        RuleId::DeserializeMode07548,
        "This command can only deserialize; drivers that switch on the mode do something else or nothing, and the \
         micromap stays undefined. Set the mode to deserialize. Mind that these numbers are not those of the \
         acceleration-structure copy modes.",
    ),
    row(
        RuleId::SerializedFormat07549,
        "Serialized micromaps are in a driver's own layout; read by another driver or version they give wrong \
         opacity or hang the unit that walks them. Ask vkGetDeviceMicromapCompatibilityEXT about the first 32 bytes, \
         and bake or build again where it says incompatible.",
    )
    .noted(WHEN_RECORDED),
    row(
        RuleId::DeserializedSize07550,
        "The data unpacks to as many bytes as the micromap had that was serialized, and beyond a smaller destination \
         it overwrites its neighbours in the buffer. Keep the size beside the data and create the destination with \
         it. Unlike acceleration structures, the EXT extension documents no size in the header, so for data of real \
         drivers this is known only where the validator saw it being written.",
    )
    .noted(WHEN_RECORDED),
    row(
        RuleId::CopyMemoryToMicromapInfoSType,
        "Layers and drivers that dispatch on the type see another structure here and read fields at the wrong \
         offsets. Set the type of a copy from memory; the three copy structures are easily confused.",
    )
    .implicit(),
    row(
        RuleId::CopyMemoryToMicromapInfoNext,
        "No structure extends a deserializing copy, so whatever hangs here is ignored or, by a later driver, \
         misunderstood. Set pNext to NULL.",
    )
    .implicit(),
    row(
        RuleId::CopyMemoryToMicromapInfoDstParameter,
        "Serialized data needs a living object to be unpacked into; a dead handle makes the driver write into memory \
         that it has given back. Create the destination first.",
    )
    .implicit(),
    row(
        RuleId::CopyMemoryToMicromapInfoModeParameter,
        "A mode that does not exist is often the sign of an uninitialised structure. Set it to deserialize. Modes \
         that exist but do not fit are reported under 07548.",
    )
    .implicit(),
    row(
        RuleId::CopyMode07531,
        "From micromap to micromap data is cloned or compacted; to serialize or deserialize, one side is plain \
         memory, which this structure cannot name. Use the command for that direction, or correct the mode; beware \
         of numbers taken from the acceleration-structure copy modes, which differ.",
    ),
    row(
        RuleId::CompactionFlag07533,
        "Without the flag a build keeps no record of how small the micromap can become, and a compacting copy may \
         write more than the destination holds or garbage. Build the source with \
         VK_BUILD_MICROMAP_ALLOW_COMPACTION_BIT_EXT, or clone it.",
    )
    .noted(
        "Judged when the command executes: a recorded one at each submission, with the path of the command itself. A \
         clone is taken to be built as its source was; after a deserialization the flags are not known, and the rule \
         is silent.",
    ),
    row(
        RuleId::CopyMicromapInfoSType,
        "The number tells layers, captures and drivers what they hold; with a wrong one a capture replays another \
         structure. Set the type of a copy between micromaps.",
    )
    .implicit(),
    row(
        RuleId::CopyMicromapInfoNext,
        "A copy between micromaps has no extensions; a chained structure is a leftover of reused memory or meant for \
         another call. Set pNext to NULL.",
    )
    .implicit(),
    row(
        RuleId::CopyMicromapInfoSrcParameter,
        "There is no object to copy from; a destroyed one often still works in a test and fails when its memory is \
         reused. Destroy the original only after the copy has completed.",
    )
    .implicit(),
    row(
        RuleId::CopyMicromapInfoDstParameter,
        "A copy does not create its destination. Create a micromap of the size of the source, or of the queried \
         compacted size, and pass it.",
    )
    .implicit(),
    row(
        RuleId::CopyMicromapInfoCommonParent,
        "Two logical devices share no addresses, even on one GPU, and a copy between their objects reads or writes \
         an address that means something else. To move a micromap, serialize it on one device and deserialize it on \
         the other, if compatible.",
    )
    .implicit(),
    row(
        RuleId::SerializeSource07540,
        "A micromap that was created but never built holds whatever its memory held, and the copy follows sizes and \
         offsets found there. Build the micromap first, and let the copy wait for the build with a barrier. For \
         recorded commands this is judged when they are submitted, in the order of execution.",
    )
    .noted("Judged when the command executes: a recorded one at each submission, with the path of the command itself."),
    row(
        RuleId::SerializeRoom07541,
        "The copy writes as many bytes as the serialization-size query says, and behind the end of a smaller buffer \
         it overwrites foreign memory. Ask for the size first and allocate so much from the address on. Known to the \
         validator once the application has asked.",
    )
    .noted("Judged once the program was told the serialization size of what the source holds."),
    row(
        RuleId::SerializeMode07542,
        "To memory a micromap can only be serialized; with another mode the bytes that come out are of no use, if \
         any come. Set the mode to serialize.",
    ),
    row(
        RuleId::CopyMicromapToMemoryInfoSType,
        "Tools that record or deep-copy calls trust the type and would copy the wrong number of bytes. Set the type \
         of a copy to memory.",
    )
    .implicit(),
    row(
        RuleId::CopyMicromapToMemoryInfoNext,
        "Nothing extends a serializing copy. A pointer left uninitialised here is followed by layers that walk \
         chains, and they crash. Set pNext to NULL.",
    )
    .implicit(),
    row(
        RuleId::CopyMicromapToMemoryInfoSrcParameter,
        "What is to be serialized does not exist, so the bytes written are those of whatever took its place. \
         Serialize before the micromap is destroyed.",
    )
    .implicit(),
    row(
        RuleId::CopyMicromapToMemoryInfoModeParameter,
        "A mode that does not exist leaves open what is written to memory. Set it to serialize. Modes that exist but \
         do not fit are reported under 07542.",
    )
    .implicit(),
];
