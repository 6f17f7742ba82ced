//! Rules of `vkCmdBuildMicromapsEXT` and `vkBuildMicromapsEXT` on memory that builds of one command share.

use omm_model::call::Timeline;
use omm_model::vk;

use crate::context::micromap_ext::MicromapBuildContext;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::{MemorySpan, State};
use crate::violation::ViolationKind;

pub(super) fn check(build: &MicromapBuildContext<'_>, timeline: Timeline, state: &State, report: &mut Report) {
    dst_micromap_overlap_11649(build, timeline, state, report);
    match timeline {
        Timeline::Device => {
            dst_micromap_scratch_overlap_11650(build, state, report);
            scratch_overlap_11651(build, state, report);
        }
        Timeline::Host => host_scratch_overlap_11669(build, state, report),
    }
}

/// Two builds of a command write two micromaps.
///
/// VUID-vkCmdBuildMicromapsEXT-dstMicromap-11649,
/// VUID-vkBuildMicromapsEXT-dstMicromap-11667
fn dst_micromap_overlap_11649(
    build: &MicromapBuildContext<'_>,
    timeline: Timeline,
    state: &State,
    report: &mut Report,
) {
    let dst = || dst_memory(build.info, timeline, state);
    let others = build.earlier.iter().map(|other| dst_memory(other, timeline, state));
    let rule = build.twin(RuleId::DstMicromapOverlap11649, RuleId::HostDstMicromapOverlap11667);
    let start = state.micromap_address(build.info.dst_micromap);
    overlap(build, ("dstMicromap", start, dst), ("dstMicromap", others), rule, report);
}

/// No build of a command writes scratch memory of any of them.
///
/// VUID-vkCmdBuildMicromapsEXT-dstMicromap-11650
fn dst_micromap_scratch_overlap_11650(build: &MicromapBuildContext<'_>, state: &State, report: &mut Report) {
    let dst = || dst_memory(build.info, Timeline::Device, state);
    let others = build.infos.iter().map(|other| scratch_memory(other, state));
    let rule = RuleId::DstMicromapScratchOverlap11650;
    let start = state.micromap_address(build.info.dst_micromap);
    overlap(build, ("dstMicromap", start, dst), ("scratchData", others), rule, report);
}

/// Two builds of a command have two pieces of scratch memory.
///
/// VUID-vkCmdBuildMicromapsEXT-scratchData-11651
fn scratch_overlap_11651(build: &MicromapBuildContext<'_>, state: &State, report: &mut Report) {
    let scratch = || scratch_memory(build.info, state);
    let others = build.earlier.iter().map(|other| scratch_memory(other, state));
    let start = Some(build.info.scratch_data.raw());
    overlap(build, ("scratchData", start, scratch), ("scratchData", others), RuleId::ScratchOverlap11651, report);
}

/// The same on the host.
///
/// VUID-vkBuildMicromapsEXT-scratchData-11669
fn host_scratch_overlap_11669(build: &MicromapBuildContext<'_>, state: &State, report: &mut Report) {
    let scratch = || host_scratch_memory(build.info, state);
    let others = build.earlier.iter().map(|other| host_scratch_memory(other, state));
    let start = Some(build.info.scratch_data.raw());
    overlap(build, ("scratchData", start, scratch), ("scratchData", others), RuleId::HostScratchOverlap11669, report);
}

/// Reports the first of `others`, the memory of the command's builds in order, that overlaps what the build has.
fn overlap<Spans: Iterator<Item = MemorySpan>, Others: Iterator<Item = MemorySpan>>(
    build: &MicromapBuildContext<'_>,
    (name, start, memory): (&'static str, Option<u64>, impl Fn() -> Spans),
    (other_name, others): (&'static str, impl Iterator<Item = Others>),
    rule: RuleId,
    report: &mut Report,
) {
    for (index, mut other) in (0..).zip(others) {
        let shared = other.find_map(|other| memory().find(|span| span.overlaps(&other)));
        if let Some(MemorySpan { offset, size, .. }) = shared {
            // Where no address was asked for, the place in memory is all that is known.
            let start = start.unwrap_or(offset);
            let kind = ViolationKind::Overlap { start, size, other: ["pInfos", other_name], index };
            report.push(rule, &build.at.field(name), kind);
            return;
        }
    }
}

/// The memory that a build writes: as much as the size query answered, or all of the object if it was not seen.
fn dst_memory(info: &vk::MicromapBuildInfo, timeline: Timeline, state: &State) -> impl Iterator<Item = MemorySpan> {
    state.micromap(info.dst_micromap).into_iter().flat_map(move |micromap| {
        let size = state.micromap_build_sizes(info, timeline).map_or(micromap.size, |sizes| sizes.micromap_size);
        state.buffer_memory(micromap.buffer, micromap.offset, size)
    })
}

/// The memory that a build on the device uses while it runs, if the size query was seen.
fn scratch_memory(info: &vk::MicromapBuildInfo, state: &State) -> impl Iterator<Item = MemorySpan> {
    let sizes = state.micromap_build_sizes(info, Timeline::Device);
    let range = sizes.zip(info.scratch_data.device_address());
    range.into_iter().flat_map(|(sizes, address)| {
        state.memory_behind(vk::DeviceAddressRange { address, size: sizes.build_scratch_size })
    })
}

/// The host memory that a build on the host uses while it runs, if the size query was seen.
fn host_scratch_memory(info: &vk::MicromapBuildInfo, state: &State) -> impl Iterator<Item = MemorySpan> {
    let sizes = state.micromap_build_sizes(info, Timeline::Host);
    let address = info.scratch_data.host_address().filter(|address| !address.is_null());
    // Host memory is one allocation, which has no handle.
    let memory = vk::DeviceMemory::NULL;
    let span = sizes.zip(address).map(|(sizes, address)| MemorySpan {
        memory,
        offset: address.0,
        size: sizes.build_scratch_size,
    });
    span.into_iter()
}
