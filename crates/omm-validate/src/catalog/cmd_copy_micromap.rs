//! Rows of `vkCmdCopyMemoryToMicromapEXT`, `vkCmdCopyMicromapEXT` and `vkCmdCopyMicromapToMemoryEXT`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::ExtOpacityMicromap, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::DeserializeAddress07543,
        "The GPU reads the serialized bytes from an address that belongs to no buffer: a page fault, or foreign data \
         taken for a micromap. Pass what vkGetBufferDeviceAddress gave for a living buffer, plus an offset inside \
         it.",
    ),
    row(
        RuleId::DeserializeAlignment07544,
        "Drivers read the header and blocks of serialized data with wide aligned loads. Copy the data to an offset \
         that is a multiple of 256 in its buffer; files that pack several blobs have to pad between them.",
    ),
    row(
        RuleId::DeserializeDstMemory07546,
        "The buffer under the micromap has no memory, so the GPU unpacks the data to an address that nothing is \
         mapped to. Bind the buffer before the command is recorded; creating the micromap does not bind it.",
    ),
    row(
        RuleId::CmdCopyMemoryToMicromapCommandBufferParameter,
        "There is no command buffer that could take the deserializing copy. Destroying a pool frees all that were \
         allocated from it, so a handle kept longer is dead. Allocate the command buffer, and let its pool live.",
    )
    .implicit(),
    row(
        RuleId::CmdCopyMemoryToMicromapInfoParameter,
        "Drivers read the parameters of the copy at once and without a test for null, so a bad pointer crashes while \
         recording. Pass the address of a filled VkCopyMemoryToMicromapInfoEXT.",
    )
    .implicit()
    .structural(
        "A Call holds the structure itself and not a pointer to it, so the pointer is always there; what stands in \
         the structure is checked under its own rules.",
    ),
    row(
        RuleId::CmdCopyMemoryToMicromapRecording,
        "Commands can be added only between begin and end; a deserialization recorded later is not part of what \
         executes. Move it before vkEndCommandBuffer.",
    )
    .implicit(),
    row(
        RuleId::CmdCopyMemoryToMicromapQueue,
        "Unpacking serialized data is done by compute shaders of the driver, which a transfer queue cannot run, \
         although the command is called a copy. Allocate the command buffer from a pool of a compute-capable family.",
    )
    .implicit(),
    row(
        RuleId::CmdCopyMemoryToMicromapRenderPass,
        "Compute work cannot run while attachments are held on chip. Deserialize before rendering begins.",
    )
    .implicit(),
    row(
        RuleId::CmdCopyMemoryToMicromapSuspended,
        "A suspended instance is still open for the hardware, which merges both halves into one pass; a \
         deserialization has no place between them. Record the command before the first half or after the last.",
    )
    .implicit(),
    row(
        RuleId::CmdCopyMemoryToMicromapVideoCoding,
        "Inside a video coding scope the queue talks to the video unit, which knows nothing of micromaps. Record the \
         deserialization before vkCmdBeginVideoCodingKHR or after vkCmdEndVideoCodingKHR. Video commands are outside \
         what this project models.",
    )
    .implicit()
    .structural(
        "The vocabulary has no video sessions and no command that begins a video coding scope, so a command can \
         never stand inside one.",
    ),
    row(
        RuleId::CopySrcMemory07529,
        "The buffer under the micromap has no memory, so the GPU reads from an address that nothing is mapped to. \
         Bind the buffer before the command is recorded; creating the micromap does not bind it.",
    ),
    row(
        RuleId::CopyDstMemory07530,
        "The buffer under the micromap has no memory, so the GPU writes the copy to an address that nothing is \
         mapped to. Bind the buffer before the command is recorded; creating the micromap does not bind it.",
    ),
    row(
        RuleId::CopySource07532,
        "The copy reads sizes and data of a micromap that holds only what its memory happened to hold. Build the \
         source before, in this or an earlier submission, with a barrier between. Judged at submission, because a \
         command buffer may be recorded before the one that builds.",
    )
    .noted("Judged when the command executes: a recorded one at each submission, with the path of the command itself."),
    row(
        RuleId::CmdCopyMicromapCommandBufferParameter,
        "There is no command buffer that could take the copy. Destroying a pool frees all that were allocated from \
         it, so a handle kept longer is dead. Allocate the command buffer, and let its pool live.",
    )
    .implicit(),
    row(
        RuleId::CmdCopyMicromapInfoParameter,
        "A null or stale pointer to the parameters crashes while recording. Pass the address of a filled \
         VkCopyMicromapInfoEXT; it may go out of scope after the call.",
    )
    .implicit()
    .structural(
        "A Call holds the structure itself and not a pointer to it, so the pointer is always there; what stands in \
         the structure is checked under its own rules.",
    ),
    row(
        RuleId::CmdCopyMicromapRecording,
        "A copy recorded outside of begin and end goes nowhere, or damages the memory of a finished command buffer. \
         Begin the command buffer first.",
    )
    .implicit(),
    row(
        RuleId::CmdCopyMicromapQueue,
        "A micromap is copied by compute work that understands its layout; a plain transfer queue cannot, although \
         the command is called a copy. Allocate the command buffer from a pool of a compute-capable family.",
    )
    .implicit(),
    row(
        RuleId::CmdCopyMicromapRenderPass,
        "The copy is compute work, and inside a render pass the GPU would have to leave its tiles for it. Copy \
         before or after rendering.",
    )
    .implicit(),
    row(
        RuleId::CmdCopyMicromapSuspended,
        "Drivers join the halves of a suspended instance into one pass, and a copy recorded between them ends up in \
         an undefined place. Record the command before the first half or after the last.",
    )
    .implicit(),
    row(
        RuleId::CmdCopyMicromapVideoCoding,
        "Inside a video coding scope the queue talks to the video unit, which knows nothing of micromaps. Record the \
         copy before vkCmdBeginVideoCodingKHR or after vkCmdEndVideoCodingKHR. Video commands are outside what this \
         project models.",
    )
    .implicit()
    .structural(
        "The vocabulary has no video sessions and no command that begins a video coding scope, so a command can \
         never stand inside one.",
    ),
    row(
        RuleId::SerializeAddress07536,
        "The GPU writes the serialized bytes to an address that belongs to no buffer: a page fault, or damage to \
         foreign memory. Pass what vkGetBufferDeviceAddress gave for a living buffer, plus an offset inside it.",
    ),
    row(
        RuleId::SerializeAlignment07537,
        "The serialized form is written in wide aligned stores. Choose a destination that is a multiple of 256; when \
         several micromaps go into one buffer, round each size up.",
    ),
    row(
        RuleId::SerializeSrcMemory07539,
        "The buffer under the micromap has no memory, so the GPU reads the micromap from an address that nothing is \
         mapped to. Bind the buffer before the command is recorded; creating the micromap does not bind it.",
    ),
    row(
        RuleId::CmdCopyMicromapToMemoryCommandBufferParameter,
        "There is no command buffer that could take the serializing copy. Destroying a pool frees all that were \
         allocated from it, so a handle kept longer is dead. Allocate the command buffer, and let its pool live.",
    )
    .implicit(),
    row(
        RuleId::CmdCopyMicromapToMemoryInfoParameter,
        "The parameters are read during the call, and a bad pointer to them crashes there. Pass the address of a \
         filled VkCopyMicromapToMemoryInfoEXT.",
    )
    .implicit()
    .structural(
        "A Call holds the structure itself and not a pointer to it, so the pointer is always there; what stands in \
         the structure is checked under its own rules.",
    ),
    row(
        RuleId::CmdCopyMicromapToMemoryRecording,
        "Outside of begin and end the driver has no place to write the command to, and many do not check. Record the \
         serialization between them.",
    )
    .implicit(),
    row(
        RuleId::CmdCopyMicromapToMemoryQueue,
        "Serializing walks through the micromap in compute work, which a transfer queue does not have. Allocate the \
         command buffer from a pool of a compute-capable family.",
    )
    .implicit(),
    row(
        RuleId::CmdCopyMicromapToMemoryRenderPass,
        "Serialization cannot be woven into the tiles of a render pass. End the rendering first.",
    )
    .implicit(),
    row(
        RuleId::CmdCopyMicromapToMemorySuspended,
        "The halves of a suspended instance are executed as one, so a serialization between them would run in the \
         middle of it. Record the command before the first half or after the last.",
    )
    .implicit(),
    row(
        RuleId::CmdCopyMicromapToMemoryVideoCoding,
        "Inside a video coding scope the queue talks to the video unit, which knows nothing of micromaps. Record the \
         serialization before vkCmdBeginVideoCodingKHR or after vkCmdEndVideoCodingKHR. Video commands are outside \
         what this project models.",
    )
    .implicit()
    .structural(
        "The vocabulary has no video sessions and no command that begins a video coding scope, so a command can \
         never stand inside one.",
    ),
];
