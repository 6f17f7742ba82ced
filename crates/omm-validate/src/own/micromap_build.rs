//! Builds of micromaps of either extension read memory that is there, and triangles that make sense.

use omm_layout::triangle;
use omm_model::format::OpacityMicromapFormat;
use omm_model::triangle::MicromapTriangle;
use omm_model::vk;

use super::finding::OwnFinding;
use super::memory::Executed;
use crate::context::MicromapDataContext;
use crate::context::micromap_ext::MicromapBuildContext;
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::ViolationKind;

/// OMM-memory-01, OMM-value-01
pub(super) fn check(build: &MicromapBuildContext<'_>, executed: &Executed<'_>, report: &mut Report) {
    let info = build.info;
    if info.mode != vk::BuildMicromapMode::BUILD {
        let kind = ViolationKind::Own(OwnFinding::Meaningless { found: info.mode.0.into() });
        report.push(RuleId::Value01, &build.at.field("mode"), kind);
    }
    executed.object(&build.at.field("dstMicromap"), (vk::Micromap::OBJECT_TYPE, info.dst_micromap.0), report);
    if let Some(size) = build.scratch_size(executed.state) {
        executed.reach(&build.at.field("scratchData"), info.scratch_data, size, report);
    }
    let input = Input {
        array: info.triangle_array,
        stride: info.triangle_array_stride,
        count: build.triangle_count(),
        data: info.data,
        is_lossy: false,
    };
    input.check(&build.at, executed, report);
}

/// The same for micromaps of the KHR extension.
pub(super) fn check_khr(data: &MicromapDataContext<'_>, executed: &Executed<'_>, report: &mut Report) {
    let input = Input {
        array: data.data.triangle_array.into(),
        stride: data.data.triangle_array_stride,
        count: data.triangle_count(),
        data: data.data.data.into(),
        is_lossy: data.build.is_lossy(),
    };
    input.check(&data.at, executed, report);
}

/// What a micromap is built from.
struct Input {
    array: vk::DeviceOrHostAddress,
    stride: u64,
    count: u64,
    data: vk::DeviceOrHostAddress,
    is_lossy: bool,
}

impl Input {
    fn check(&self, at: &At<'_>, executed: &Executed<'_>, report: &mut Report) {
        let (count, size) = (self.count, triangle::SIZE as u64);
        if count == 0 {
            return;
        }
        let items = (self.stride, size, count);
        let Some(start) = executed.reach_items(&at.field("triangleArray"), (self.array, 0), items, report) else {
            return;
        };
        let length = (count - 1).saturating_mul(self.stride).saturating_add(size);
        let Ok(bytes) = executed.memory.read_either(start, length) else { return };
        let mut needed = 1;
        for index in 0..count {
            let entry = usize::try_from(index * self.stride).ok().and_then(|start| bytes.get(start..)?.first_chunk());
            let Some(raw) = entry.map(triangle::decode) else { return };
            let at = at.element("triangleArray", usize::try_from(index).unwrap_or(usize::MAX));
            // Entries that overlap are no business of the rules on formats and levels.
            match MicromapTriangle::try_from(raw).ok().filter(|triangle| self.is_within_limits(triangle, executed)) {
                Some(triangle) => needed = needed.max(triangle.data_range().end),
                None => {
                    let kind = ViolationKind::Own(OwnFinding::Meaningless { found: raw.format.into() });
                    report.push(RuleId::Value01, &at, kind);
                    return;
                }
            }
        }
        executed.reach(&at.field("data"), self.data, needed, report);
    }

    fn is_within_limits(&self, triangle: &MicromapTriangle, executed: &Executed<'_>) -> bool {
        let limits = &executed.state.profile().limits;
        let limit = match triangle.format {
            OpacityMicromapFormat::TwoState => limits.max_opacity2_state_subdivision_level,
            OpacityMicromapFormat::FourState if self.is_lossy => limits.max_opacity_lossy4_state_subdivision_level,
            OpacityMicromapFormat::FourState => limits.max_opacity4_state_subdivision_level,
        };
        triangle.subdivision_level.get() <= limit
    }
}
