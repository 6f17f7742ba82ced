//! Rows of `vkBuildMicromapsEXT`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::ExtOpacityMicromap, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::HostDstMicromapSize07461,
        "A host build writes as many bytes as the size query answers for these usages; in a smaller object it runs \
         over the end into its neighbour. Create the micromap with micromapSize of a query with the same type, flags \
         and usage counts. The validator compares with the answer that the application was given, and stays silent \
         if none was seen.",
    ),
    row(
        RuleId::HostMode07462,
        "Micromaps can only be built afresh, there is no update as acceleration structures have it; on the host an \
         unknown mode often falls through to doing nothing while success is returned. Set the mode to build.",
    ),
    row(
        RuleId::HostDstMicromap07463,
        "The host build writes through a dangling or empty handle at once, or in whichever thread joins it. Pass the \
         micromap that was created for this build, and keep it alive. The size query ignores the handle and is not \
         looked at.",
    ),
    row(
        RuleId::HostType07464,
        "The host builder writes one layout into an object that was sized and marked for another, and traversal \
         later decodes it wrongly. Create the micromap with the type that is built. Since our device simulates \
         opacity only, the other type appears here as a raw value and the scenario runs without it.",
    ),
    row(
        RuleId::HostDstMicromapMemory07552,
        "Host commands run on the CPU, which writes the result through a mapping of the micromap's memory; device- \
         local memory without host access has none. Bind the buffer to a host-visible memory type, or record the \
         device command instead.",
    ),
    row(
        RuleId::HostData07553,
        "A host build dereferences the pointer itself, and a bad one is a crash of the application. Pass a pointer \
         to opacity states that live until the build has ended, for a deferred build until it is joined.",
    ),
    row(
        RuleId::HostTriangleArray07554,
        "The CPU walks the triangle array from this pointer; a null, freed or device address ends in a segmentation \
         fault. Pass a pointer to all entries that the usage counts announce, alive until the build, deferred or \
         not, has ended.",
    ),
    row(
        RuleId::HostBuildFeature07555,
        "Building micromaps on the CPU is optional, and few drivers offer it; without the feature the function may \
         be a stub that crashes. Enable micromapHostCommands where the device supports it, or record the command of \
         the device timeline.",
    ),
    row(
        RuleId::HostScratch07556,
        "The host build writes its intermediate results to this pointer, as many bytes as the size query for host \
         builds answered. Allocate that much, and keep it until the build has ended; the answer for device builds \
         may be another.",
    ),
    row(
        RuleId::HostDstMicromapInstances07557,
        "Memory with several instances has one copy on each GPU of a device group, and the CPU cannot say which one \
         it is to write. Allocate from a heap without instances, or with a device mask of one bit.",
    ),
    row(
        RuleId::HostDstMicromapOverlap11667,
        "The elements of one host command may be built by several joining threads at once, and two that write the \
         same memory race. Give each its own micromap in its own range, or make two calls.",
    ),
    row(
        RuleId::HostDstMicromapScratchOverlap11668,
        "If scratch lies in the mapped memory of a micromap that the same call builds, the build eats its own \
         output. Take scratch from ordinary host memory, never from a mapped pointer of the destination. Not \
         checkable from the calls that we see, since none of them says where memory is mapped.",
    )
    .structural(
        "A host build has its scratch at a host pointer and its micromap in device memory; whether the two meet \
         depends on where the memory is mapped, and mapping memory is not in the vocabulary.",
    ),
    row(
        RuleId::HostScratchOverlap11669,
        "Builds of one command may run at the same time, and shared scratch lets one read the other's intermediate \
         results. Cut the scratch allocation into one piece for each element; joining threads take elements in any \
         order.",
    ),
    row(
        RuleId::BuildMicromapsDeviceParameter,
        "The builder that would do the work hangs from the device object, and this handle is none. Calls dispatch \
         through the handle, so a wrong one usually crashes in the loader. Pass what vkCreateDevice returned. If it \
         is unknown, nothing else of the call is checked, as features and limits are unknown too.",
    )
    .implicit(),
    row(
        RuleId::BuildMicromapsDeferredOperationParameter,
        "The build would park its work in an object that does not exist, and nobody could ever join it. Create the \
         operation with vkCreateDeferredOperationKHR and destroy it after it is complete, or pass VK_NULL_HANDLE to \
         do the work in the call.",
    )
    .implicit(),
    row(
        RuleId::BuildMicromapsInfosParameter,
        "The driver reads infoCount structures from here, for a deferred build as late as when it is joined. Keep \
         the array alive until the build is complete and its length in step with the count.",
    )
    .implicit()
    .structural(
        "A Call holds the elements themselves in a Vec; a pointer that is neither NULL nor valid, or an array \
         shorter than its count, cannot be written down.",
    ),
    row(
        RuleId::BuildMicromapsInfoCount,
        "A host build without elements still returns success and may complete or leave pending a deferred operation \
         without work, which drivers handle differently. Skip the call when there is nothing to build.",
    )
    .implicit(),
    row(
        RuleId::BuildMicromapsDeferredOperationParent,
        "Threads that join the operation would work with the state of one driver instance on the build of another. \
         Create one operation on each device that defers commands.",
    )
    .implicit(),
];
