//! Rules on the contents of memory that a build reads. They run last.
//!
//! Memory is looked at when the build is checked, that is when it is recorded; what is written between then and the execution is
//! not seen. Memory that cannot be read is passed over. Each rule reports the first element that breaks it, so that a buffer of
//! garbage gives one finding and not a million.

mod build_micromaps;
mod copy_acceleration_structure;
mod copy_memory_to_micromap;
mod copy_micromap_to_memory;
mod instance;
mod micromap_build_info;
mod micromap_data;
mod triangle_array;
mod triangles_data;
mod triangles_opacity_micromap;

use omm_layout::build_range;
use omm_model::call::Call;
use omm_model::memory::MemoryView;
use omm_model::vk;

use crate::context::micromap_ext::MicromapBuildContext;
use crate::context::{BuildContext, GeometryContext, Purpose, command_at};
use crate::location::At;
use crate::report::Report;
use crate::state::State;

pub(crate) use triangles_data::offset_by;

/// Checks what one build structure refers to. A query of build sizes reads no memory.
pub(crate) fn check_build(build: &BuildContext<'_>, state: &State, memory: &dyn MemoryView, report: &mut Report) {
    if build.purpose == Purpose::Sizes {
        return;
    }
    let by_command = matches!(build.purpose, Purpose::Build { .. });
    build.each_geometry(|geometry| {
        instance::check(geometry, state, memory, report);
        triangles_data::check(geometry, memory, report);
        // The other commands build no micromaps, and their rules do not speak of indices.
        if by_command {
            geometry.each_micromap_data(|data| micromap_data::check(data, state, memory, report));
            geometry.each_opacity_micromap(|attached| {
                triangles_opacity_micromap::check(attached, state, memory, report);
            });
        }
    });
}

/// Checks what a command refers to when it executes, with the state that it finds.
pub(crate) fn check_executed(call: &Call, state: &State, memory: &dyn MemoryView, report: &mut Report) {
    copy_acceleration_structure::check_executed(call, &command_at(call), state, memory, report);
}

/// Checks what one build structure of a micromap object refers to.
pub(crate) fn check_micromap_build(
    build: &MicromapBuildContext<'_>,
    state: &State,
    memory: &dyn MemoryView,
    report: &mut Report,
) {
    micromap_build_info::check(build, memory, report);
    build_micromaps::check(build, state, memory, report);
}

/// Checks what a copy of a micromap object reads from memory or writes to it.
pub(crate) fn check_call(call: &Call, command: &At<'_>, state: &State, memory: &dyn MemoryView, report: &mut Report) {
    copy_acceleration_structure::check(call, command, state.features_for(call), memory, report);
    copy_micromap_to_memory::check(call, command, state, memory, report);
    copy_memory_to_micromap::check(call, command, state, memory, report);
}

/// The range that is built of a geometry: from the command or, for an indirect build, from device memory as it is now.
pub(crate) fn range(geometry: &GeometryContext<'_>, memory: &dyn MemoryView) -> Option<vk::BuildRangeInfo> {
    let Purpose::Indirect { ranges, stride, .. } = geometry.build.purpose else {
        let (_, ranges) = geometry.build.ranges?;
        return ranges?.get(geometry.index).copied();
    };
    let address = ranges.checked_add((geometry.index as u64).checked_mul(stride.into())?)?;
    let bytes = memory.read(address, build_range::SIZE as u64).ok()?;
    bytes.first_chunk().map(build_range::decode)
}

/// Bytes from the start of the first of `count` items of `size` bytes to the end of the last; `None` for no items, or more bytes
/// than there are addresses.
fn span(count: u64, stride: u64, size: u64) -> Option<u64> {
    count.checked_sub(1)?.checked_mul(stride)?.checked_add(size)
}

#[cfg(test)]
mod tests {
    use super::span;

    #[test]
    fn a_span_ends_with_its_last_item() {
        assert_eq!(span(0, 8, 8), None);
        assert_eq!(span(1, 100, 8), Some(8));
        assert_eq!(span(3, 12, 8), Some(32));
        assert_eq!(span(u64::MAX, 2, 1), None);
        assert_eq!(span(2, u64::MAX, 1), None);
    }
}
