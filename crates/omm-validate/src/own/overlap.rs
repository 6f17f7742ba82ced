//! Builds of one command share no memory that one of them writes.

use omm_model::call::{Call, Timeline};
use omm_model::vk;

use super::instance::{each_reference, referenced};
use super::memory::Executed;
use crate::content::range;
use crate::context::{BuildContext, each_build};
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::MemorySpan;
use crate::violation::ViolationKind;

const SRC: &str = "srcAccelerationStructure";
const DST: &str = "dstAccelerationStructure";

/// Memory that a build uses.
struct Use {
    info: usize,
    member: &'static str,
    /// The first address, if it is known.
    start: Option<u64>,
    spans: Vec<MemorySpan>,
    written: bool,
    /// Source or destination of an update in place, which may be each other.
    in_place: bool,
}

/// OMM-overlap-01
pub(super) fn check(call: &Call, command: &At<'_>, executed: &Executed<'_>, report: &mut Report) {
    let (mut uses, mut info, state) = (Vec::new(), 0, executed.state);
    each_build(call, &state.profile().limits, state.features_for(call), |build| {
        each_use(build, info, executed, &mut uses);
        info += 1;
    });
    for (position, used) in uses.iter().enumerate() {
        let both = |other: &&Use| other.info == used.info && other.in_place && used.in_place;
        let earlier = uses.iter().take(position).filter(|other| (other.written || used.written) && !both(other));
        for other in earlier {
            let shared = used.spans.iter().find(|span| other.spans.iter().any(|other| span.overlaps(other)));
            if let Some(&MemorySpan { offset, size, .. }) = shared {
                let start = used.start.unwrap_or(offset);
                let kind =
                    ViolationKind::Overlap { start, size, other: ["pInfos", other.member], index: other.info as u64 };
                report.push(RuleId::Overlap01, &command.element("pInfos", used.info).field(used.member), kind);
                return;
            }
        }
    }
}

fn each_use(build: &BuildContext<'_>, index: usize, executed: &Executed<'_>, uses: &mut Vec<Use>) {
    let (info, state) = (build.info, executed.state);
    let is_update = info.mode == vk::BuildAccelerationStructureMode::UPDATE;
    let in_place = is_update && info.src_acceleration_structure == info.dst_acceleration_structure;
    let mut push = |member, start, spans, written| {
        let in_place = in_place && (member == SRC || member == DST);
        uses.push(Use { info: index, member, start, spans, written, in_place });
    };
    let address = |handle| state.address_range(handle).map(|range| range.address.0);
    let (src, dst) = (info.src_acceleration_structure, info.dst_acceleration_structure);
    push(DST, address(dst), state.structure_memory(dst).collect(), true);
    if is_update {
        push(SRC, address(src), state.structure_memory(src).collect(), false);
    }
    push("scratchData", Some(info.scratch_data.raw()), scratch(build, executed), true);
    build.each_geometry(|geometry| {
        geometry.each_opacity_micromap(|attached| {
            let micromap = attached.attached.micromap;
            push("pGeometries", address(micromap), state.structure_memory(micromap).collect(), false);
        });
        geometry.each_opacity_micromap_ext(|attached| {
            let micromap = attached.attached.micromap;
            push("pGeometries", state.micromap_address(micromap), state.micromap_memory(micromap).collect(), false);
        });
        if let (vk::GeometryData::Instances(data), Some(range)) =
            (&geometry.geometry.geometry, range(geometry, executed.memory))
        {
            let mut known = |_: &At<'_>, reference, _: &mut Report| {
                if let Some(handle) = referenced(reference, executed.timeline, state).filter(|_| reference != 0) {
                    push("pGeometries", address(handle), state.structure_memory(handle).collect(), false);
                }
                true
            };
            // Whether the instances can be read was looked at before.
            each_reference(geometry, data, range, executed, (&mut known, &mut Report::default()));
        }
    });
}

/// The scratch memory of a build, if its sizes were asked for.
fn scratch(build: &BuildContext<'_>, executed: &Executed<'_>) -> Vec<MemorySpan> {
    let Some(size) = build.scratch_size(executed.state, executed.timeline) else { return Vec::new() };
    match (executed.timeline, build.info.scratch_data) {
        (Timeline::Device, vk::DeviceOrHostAddress::DeviceAddress(address)) => {
            executed.state.memory_behind(vk::DeviceAddressRange { address, size }).collect()
        }
        // Host memory is one allocation, which has no handle.
        (Timeline::Host, vk::DeviceOrHostAddress::HostAddress(address)) => {
            vec![MemorySpan { memory: vk::DeviceMemory::NULL, offset: address.0, size }]
        }
        _ => Vec::new(),
    }
}
