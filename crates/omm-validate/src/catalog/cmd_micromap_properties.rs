//! Rows of `vkCmdWriteMicromapsPropertiesEXT`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::ExtOpacityMicromap, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::QueryPoolType07525,
        "Slots of a pool are laid out for the pool's type; another kind of value overwrites neighbours or is read \
         back wrongly. Create one pool for compacted sizes and one for serialization sizes.",
    ),
    row(
        RuleId::QueriesUnavailable12417,
        "A query that still holds a result is not written again reliably: the host may read the old size and \
         allocate too little. Reset the queries with vkCmdResetQueryPool or vkResetQueryPool first; a fresh pool \
         needs that too, unless created with the reset flag. The rule speaks of no particular parameter; we point at \
         firstQuery.",
    )
    .noted(
        "Judged when the command executes: a recorded one at each submission, with the path of the command itself. \
         The first query that breaks the rule is reported.",
    ),
    row(
        RuleId::PropertiesMemory07527,
        "The buffer under the micromap has no memory, so the GPU reads the size from an address that nothing is \
         mapped to. Bind the buffer before the command is recorded; creating the micromap does not bind it.",
    ),
    row(
        RuleId::QueryRange07528,
        "The results would be written behind the end of the pool, into memory that the driver uses for something \
         else. Create a larger pool, or start at an earlier query. The sum is formed in 64 bits.",
    ),
    row(
        RuleId::PropertiesSource11662,
        "Sizes are read from the micromap itself, and one that was never built holds none. Let the build execute \
         first, with a barrier before this command. Judged when the command buffer is submitted.",
    )
    .noted("Judged when the command executes: a recorded one at each submission, with the path of the command itself."),
    row(
        RuleId::CompactedSizeFlag07502,
        "A build without the flag stores no compacted size, so what comes back is stale or zero, and a micromap \
         created from it is too small. Build with VK_BUILD_MICROMAP_ALLOW_COMPACTION_BIT_EXT, or ask for the \
         serialization size.",
    )
    .noted(
        "Judged when the command executes: a recorded one at each submission, with the path of the command itself. A \
         clone is taken to be built as its source was; after a deserialization the flags are not known, and the rule \
         is silent.",
    ),
    row(
        RuleId::QueryType07503,
        "A micromap object has two sizes to ask for; the query types of acceleration structures mean other objects, \
         and the driver would read a micromap as one. Use one of the two micromap types, in the pool as well.",
    ),
    row(
        RuleId::CmdWriteMicromapsPropertiesCommandBufferParameter,
        "There is no command buffer that could take the query. Destroying a pool frees all that were allocated from \
         it, so a handle kept longer is dead. Allocate the command buffer, and let its pool live.",
    )
    .implicit(),
    row(
        RuleId::CmdWriteMicromapsPropertiesMicromapsParameter,
        "One of the micromaps asked about does not exist, so its query is filled from freed memory. Ask only about \
         living ones. Whether the pointer itself is good cannot be seen in a call; its elements are.",
    )
    .implicit(),
    row(
        RuleId::CmdWriteMicromapsPropertiesQueryPoolParameter,
        "The sizes need a place to be written to; a destroyed pool is memory that the driver has given to somebody \
         else. Create the pool, and keep it until the results were read.",
    )
    .implicit(),
    row(
        RuleId::CmdWriteMicromapsPropertiesRecording,
        "A query recorded into a command buffer that is not open never executes, and whoever waits for its result \
         waits forever. Record it between begin and end.",
    )
    .implicit(),
    row(
        RuleId::CmdWriteMicromapsPropertiesQueue,
        "Sizes are fetched by the same compute work that builds micromaps, which a transfer queue does not have. \
         Allocate the command buffer from a pool of a compute-capable family.",
    )
    .implicit(),
    row(
        RuleId::CmdWriteMicromapsPropertiesRenderPass,
        "This query writes a value of its own and is not one of those that a render pass may hold. Write properties \
         before or after rendering.",
    )
    .implicit(),
    row(
        RuleId::CmdWriteMicromapsPropertiesSuspended,
        "The halves of a suspended instance are executed as one, so the sizes would be written in the middle of \
         rendering. Record the command before the first half or after the last.",
    )
    .implicit(),
    row(
        RuleId::CmdWriteMicromapsPropertiesVideoCoding,
        "Inside a video coding scope the queue talks to the video unit, which knows nothing of micromaps. Record the \
         query before vkCmdBeginVideoCodingKHR or after vkCmdEndVideoCodingKHR. Video commands are outside what this \
         project models.",
    )
    .implicit()
    .structural(
        "The vocabulary has no video sessions and no command that begins a video coding scope, so a command can \
         never stand inside one.",
    ),
    row(
        RuleId::CmdWriteMicromapsPropertiesMicromapCount,
        "Without micromaps no query is written, and one that is waited for never becomes available. Skip the command \
         for an empty list.",
    )
    .implicit(),
    row(
        RuleId::CmdWriteMicromapsPropertiesCommonParent,
        "Command buffer, pool and micromaps have to live in one address space, because one GPU command touches all \
         three. Create the query pool on the device that owns the micromaps.",
    )
    .implicit(),
];
