//! Rows of `vkCmdBuildMicromapsEXT`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::ExtOpacityMicromap, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::DstMicromapSize07461,
        "The build writes as many bytes as the size query answers for these usages; in a smaller object it runs over \
         the end into its neighbour. Create the micromap with micromapSize of a query with the same type, flags and \
         usage counts. The validator compares with the answer that the application was given, and stays silent if \
         none was seen.",
    ),
    row(
        RuleId::Mode07462,
        "Micromaps can only be built afresh, there is no update as acceleration structures have it; a driver that \
         does not know the mode may skip the build silently. Set the mode to build.",
    ),
    row(
        RuleId::DstMicromap07463,
        "The command would write through a dangling or empty handle when it executes on the GPU, long after the \
         mistake. Pass the micromap that was created for this build, and keep it alive. The size query ignores the \
         handle and is not looked at.",
    ),
    row(
        RuleId::Type07464,
        "Opacity and displacement have different layouts, and the object was sized and marked for one of them. Build \
         the type that it was created for. Since our device simulates opacity only, the other type appears here as a \
         raw value and the scenario runs without it.",
    ),
    row(
        RuleId::BuildFeature11648,
        "Without the feature the driver has not loaded what builds micromaps, and the entry point may be empty or \
         crash. Enable micromap in the chain of VkDeviceCreateInfo. The feature of the KHR extension of the same \
         name does not count.",
    ),
    row(
        RuleId::DstMicromapMemory07508,
        "The micromap's buffer has no memory behind it, so the GPU writes to an address that is not mapped: a page \
         fault, or the loss of the device. Bind the buffer with vkBindBufferMemory before the build is recorded.",
    ),
    row(
        RuleId::ScratchRange07509,
        "The build uses as much scratch memory as the size query said, from this address on, and the buffer ends \
         before: it scribbles over what follows. Enlarge the buffer, or move the address towards its start; space \
         for aligning the address must be added on top. Two buffers side by side do not count as one.",
    ),
    row(
        RuleId::InputUsage07510,
        "The build reads its input as memory of a kind that the buffer was not created for, which on some drivers \
         means an unmapped or compressed range. Create the buffers of opacity data and triangle array with \
         VK_BUFFER_USAGE_MICROMAP_BUILD_INPUT_READ_ONLY_BIT_EXT. Where buffers share memory, one with the flag \
         suffices.",
    ),
    row(
        RuleId::ScratchUsage07511,
        "Scratch memory is written by shaders of the driver as a storage buffer would be, and a buffer without that \
         usage may lie in memory that shaders cannot write. Add VK_BUFFER_USAGE_STORAGE_BUFFER_BIT. Asked of any \
         scratch address that lies in a buffer, even if the build needs none.",
    ),
    row(
        RuleId::ScratchAddress07512,
        "The build needs scratch memory and got an address that belongs to none, so its intermediate results go to a \
         page fault or to a stranger. Pass the address of a scratch buffer that still exists. Where the size query \
         answered 0 no address is needed and 0 is fine.",
    ),
    row(
        RuleId::DataAddress10896,
        "The build reads the opacity states from an address that belongs to no buffer, which ends in a page fault or \
         in somebody else's bytes. Pass what vkGetBufferDeviceAddress gave for a living buffer, plus an offset \
         inside it. The rule makes no exception for a build without triangles, and neither do we.",
    ),
    row(
        RuleId::TriangleArrayAddress10897,
        "The build reads the triangle array from an address that belongs to no buffer, which ends in a page fault or \
         in somebody else's bytes. Pass what vkGetBufferDeviceAddress gave for a living buffer, plus an offset \
         inside it. The rule makes no exception for a build without triangles, and neither do we.",
    ),
    row(
        RuleId::ScratchAlignment07514,
        "The build splits its scratch memory into blocks of the device's alignment; from an odd start the blocks \
         straddle cache lines that atomic operations need whole. Round the address up to the limit of the \
         acceleration-structure properties, which serves micromaps too, and allocate that much more.",
    ),
    row(
        RuleId::InputAlignment07515,
        "Hardware loads the input of a micromap build in aligned blocks of 256 bytes. Move the array to an aligned \
         offset in its buffer. Mind that the KHR extension is content with 128 and that host builds have no such \
         rule.",
    ),
    row(
        RuleId::DstMicromapOverlap11649,
        "The builds of one command run side by side on the GPU in no order; two that write the same memory leave a \
         mixture of both. Give each its own micromap in its own range, or build in two commands with a barrier \
         between.",
    ),
    row(
        RuleId::DstMicromapScratchOverlap11650,
        "Scratch memory is overwritten until the last moment of a build; where it is also a destination, finished \
         micromap data is destroyed. Place scratch outside every micromap that the command builds, that of the same \
         element included.",
    ),
    row(
        RuleId::ScratchOverlap11651,
        "Builds of one command may run at the same time, and shared scratch lets one read the other's intermediate \
         results. Cut the scratch buffer into one aligned piece for each element, or put a barrier between two \
         commands that share it.",
    ),
    row(
        RuleId::CmdBuildMicromapsCommandBufferParameter,
        "There is no command buffer that could take the build. Destroying a pool frees all that were allocated from \
         it, so a handle kept longer is dead. Allocate the command buffer, and let its pool live.",
    )
    .implicit(),
    row(
        RuleId::CmdBuildMicromapsInfosParameter,
        "The driver reads infoCount structures while recording; a shorter array gives it garbage for builds. Keep \
         the length in step with the count.",
    )
    .implicit()
    .structural(
        "A Call holds the elements themselves in a Vec; a pointer that is neither NULL nor valid, or an array \
         shorter than its count, cannot be written down.",
    ),
    row(
        RuleId::CmdBuildMicromapsRecording,
        "The build would be appended to a list that is closed or was never opened, and is lost or corrupts it. Call \
         vkBeginCommandBuffer before and vkEndCommandBuffer after.",
    )
    .implicit(),
    row(
        RuleId::CmdBuildMicromapsQueue,
        "Micromaps are built by compute work; a queue family for transfers or video only has no unit that could run \
         it. Allocate the command buffer from a pool of a compute-capable family.",
    )
    .implicit(),
    row(
        RuleId::CmdBuildMicromapsRenderPass,
        "A tile-based GPU runs a render pass tile by tile and would have to repeat or break it for the build. Build \
         micromaps before rendering begins.",
    )
    .implicit(),
    row(
        RuleId::CmdBuildMicromapsSuspended,
        "Between suspending and resuming the attachments stay on chip as if rendering went on, and a build there \
         forces them out or is lost. Record the command before the first half or after the last.",
    )
    .implicit(),
    row(
        RuleId::CmdBuildMicromapsVideoCoding,
        "Inside a video coding scope the queue talks to the video unit, which knows nothing of micromaps. Record the \
         build before vkCmdBeginVideoCodingKHR or after vkCmdEndVideoCodingKHR. Video commands are outside what this \
         project models.",
    )
    .implicit()
    .structural(
        "The vocabulary has no video sessions and no command that begins a video coding scope, so a command can \
         never stand inside one.",
    ),
    row(
        RuleId::CmdBuildMicromapsInfoCount,
        "A dispatch of zero builds is an error in some drivers and a barrier without need in others. Skip the \
         command when there is nothing to build.",
    )
    .implicit(),
];
