//! Rules of `vkBuildMicromapsEXT` on host memory.

use omm_model::memory::MemoryView;
use omm_model::triangle::MicromapTriangle;
use omm_model::vk;

use super::{micromap_build_info, span};
use crate::context::micromap_ext::{MicromapBuildContext, MicromapPurpose};
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::violation::ViolationKind;

/// Bytes of an entry of the triangle array.
const TRIANGLE_SIZE: u64 = 8;

pub(super) fn check(build: &MicromapBuildContext<'_>, state: &State, memory: &dyn MemoryView, report: &mut Report) {
    if build.purpose == MicromapPurpose::Host {
        host_data_07553(build, memory, report);
        host_triangle_array_07554(build, memory, report);
        host_scratch_07556(build, state, memory, report);
    }
}

/// The data of all triangles is in host memory.
///
/// VUID-vkBuildMicromapsEXT-pInfos-07553
fn host_data_07553(build: &MicromapBuildContext<'_>, memory: &dyn MemoryView, report: &mut Report) {
    if build.triangle_count() == 0 {
        return;
    }
    // Without a readable triangle array there is at least a first byte.
    let needed = micromap_build_info::read(build, memory).and_then(|triangles| {
        let known = triangles.iter().filter_map(|triangle| MicromapTriangle::try_from(triangle).ok());
        known.map(|triangle| triangle.data_range().end).max()
    });
    let data = ("data", build.info.data);
    host_memory(build, data, needed.unwrap_or(1), memory, RuleId::HostData07553, report);
}

/// The triangle array is in host memory.
///
/// VUID-vkBuildMicromapsEXT-pInfos-07554
fn host_triangle_array_07554(build: &MicromapBuildContext<'_>, memory: &dyn MemoryView, report: &mut Report) {
    let count = build.triangle_count();
    if count == 0 {
        return;
    }
    let needed = span(count, build.info.triangle_array_stride, TRIANGLE_SIZE).unwrap_or(u64::MAX);
    let array = ("triangleArray", build.info.triangle_array);
    host_memory(build, array, needed, memory, RuleId::HostTriangleArray07554, report);
}

/// The scratch memory that the size query asked for is in host memory.
///
/// VUID-vkBuildMicromapsEXT-pInfos-07556
fn host_scratch_07556(build: &MicromapBuildContext<'_>, state: &State, memory: &dyn MemoryView, report: &mut Report) {
    let needed = build.scratch_size(state).filter(|_| build.info.mode == vk::BuildMicromapMode::BUILD);
    if let Some(needed) = needed {
        let scratch = ("scratchData", build.info.scratch_data);
        host_memory(build, scratch, needed, memory, RuleId::HostScratch07556, report);
    }
}

/// An address is one of host memory, with that many bytes behind it as far as the view knows.
fn host_memory(
    build: &MicromapBuildContext<'_>,
    (name, address): (&'static str, vk::DeviceOrHostAddress),
    size: u64,
    memory: &dyn MemoryView,
    rule: RuleId,
    report: &mut Report,
) {
    let kind = match address.host_address().filter(|address| !address.is_null()) {
        None => ViolationKind::InvalidHostAddress { found: address.raw() },
        Some(_) if !memory.knows_host_memory() => return,
        Some(start) => match memory.read_host(start, size) {
            Ok(_) => return,
            Err(error) if error.available == 0 => ViolationKind::InvalidHostAddress { found: start.0 },
            Err(error) => ViolationKind::BeyondHostMemory { start: start.0, size, available: error.available },
        },
    };
    report.push(rule, &build.at.field(name), kind);
}
