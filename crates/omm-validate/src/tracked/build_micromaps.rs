//! Rules of `vkCmdBuildMicromapsEXT`, `vkBuildMicromapsEXT` and `vkGetMicromapBuildSizesEXT` on objects and addresses.

use omm_model::call::{Call, Timeline};
use omm_model::vk;

use super::build_micromaps_memory;
use crate::context::micromap_ext::{MicromapBuildContext, MicromapPurpose};
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::{MemorySpan, State};
use crate::violation::ViolationKind;

/// Checks the command as a whole.
pub(super) fn check_command(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    if let Call::GetMicromapBuildSizes { device, .. } = call {
        multi_device_sizes_07440(command, *device, state, report);
    }
}

/// Checks one build. A query of build sizes ignores objects and addresses.
pub(super) fn check(build: &MicromapBuildContext<'_>, state: &State, report: &mut Report) {
    let Some(timeline) = build.timeline() else { return };
    dst_micromap_size_07461(build, timeline, state, report);
    type_07464(build, state, report);
    match timeline {
        Timeline::Device => {
            dst_micromap_memory_07508(build, state, report);
            scratch_range_07509(build, state, report);
            input_usage_07510(build, state, report);
            scratch_usage_07511(build, state, report);
            scratch_address_07512(build, state, report);
            data_address_10896(build, state, report);
            triangle_array_address_10897(build, state, report);
        }
        Timeline::Host => {
            host_dst_micromap_memory_07552(build, state, report);
            host_dst_micromap_instances_07557(build, state, report);
        }
    }
    build_micromaps_memory::check(build, timeline, state, report);
}

/// On several physical devices, sizes are the same only where addresses are.
///
/// VUID-vkGetMicromapBuildSizesEXT-device-07440
fn multi_device_sizes_07440(command: &At<'_>, device: vk::Device, state: &State, report: &mut Report) {
    multi_device(&command.field("device"), device, state, RuleId::MultiDeviceSizes07440, report);
}

/// A device is made of one physical device, or has the feature that lets addresses be used on several.
pub(super) fn multi_device(at: &At<'_>, device: vk::Device, state: &State, rule: RuleId, report: &mut Report) {
    let found = state.physical_devices(device);
    if found > 1 && !state.features(device).buffer_device_address_multi_device {
        let feature = "VkPhysicalDeviceBufferDeviceAddressFeatures::bufferDeviceAddressMultiDevice";
        report.push(rule, at, ViolationKind::SeveralPhysicalDevices { found: found as u64, feature });
    }
}

/// The micromap is as large as the size query answered.
///
/// VUID-vkCmdBuildMicromapsEXT-pInfos-07461,
/// VUID-vkBuildMicromapsEXT-pInfos-07461
fn dst_micromap_size_07461(build: &MicromapBuildContext<'_>, timeline: Timeline, state: &State, report: &mut Report) {
    let micromap = state.micromap(build.info.dst_micromap);
    let sizes = state.micromap_build_sizes(build.info, timeline);
    let (Some(micromap), Some(sizes)) = (micromap, sizes) else { return };
    if micromap.size < sizes.micromap_size {
        let kind = ViolationKind::BelowLimit { found: micromap.size, limit: sizes.micromap_size };
        let rule = build.twin(RuleId::DstMicromapSize07461, RuleId::HostDstMicromapSize07461);
        report.push(rule, &build.at.field("dstMicromap"), kind);
    }
}

/// A micromap is built as what it was created for.
///
/// VUID-vkCmdBuildMicromapsEXT-pInfos-07464,
/// VUID-vkBuildMicromapsEXT-pInfos-07464
fn type_07464(build: &MicromapBuildContext<'_>, state: &State, report: &mut Report) {
    let found = build.info.ty;
    if let Some(micromap) = state.micromap(build.info.dst_micromap).filter(|micromap| micromap.ty != found) {
        let kind = ViolationKind::WrongValue { found: found.into(), required: micromap.ty.into() };
        report.push(build.twin(RuleId::Type07464, RuleId::HostType07464), &build.at.field("type"), kind);
    }
}

/// The micromap lies in memory.
///
/// VUID-vkCmdBuildMicromapsEXT-pInfos-07508
fn dst_micromap_memory_07508(build: &MicromapBuildContext<'_>, state: &State, report: &mut Report) {
    let dst = build.info.dst_micromap;
    if let (Some(micromap), Some(false)) = (state.micromap(dst), state.micromap_is_bound(dst)) {
        let kind = ViolationKind::NotBound { buffer: micromap.buffer.0 };
        report.push(RuleId::DstMicromapMemory07508, &build.at.field("dstMicromap"), kind);
    }
}

/// The scratch memory that the size query asked for ends before its buffer does.
///
/// VUID-vkCmdBuildMicromapsEXT-pInfos-07509
fn scratch_range_07509(build: &MicromapBuildContext<'_>, state: &State, report: &mut Report) {
    let needed = build.scratch_size(state).filter(|_| build.info.mode == vk::BuildMicromapMode::BUILD);
    let (Some(needed), Some(start)) = (needed, build.info.scratch_data.device_address()) else { return };
    // In no buffer at all: another rule's business.
    if let Some(available) = state.bytes_from(start).filter(|available| *available < needed) {
        let kind = ViolationKind::BeyondBuffer { start: start.0, size: needed.into(), available };
        report.push(RuleId::ScratchRange07509, &build.at.field("scratchData"), kind);
    }
}

/// Data and triangle array lie in buffers made for such input.
///
/// VUID-vkCmdBuildMicromapsEXT-data-07510
fn input_usage_07510(build: &MicromapBuildContext<'_>, state: &State, report: &mut Report) {
    let required = vk::BufferUsageFlags::MICROMAP_BUILD_INPUT_READ_ONLY;
    for input in [("data", build.info.data), ("triangleArray", build.info.triangle_array)] {
        address_usage(build, input, required, state, RuleId::InputUsage07510, report);
    }
}

/// Scratch memory lies in a buffer made for storage.
///
/// VUID-vkCmdBuildMicromapsEXT-pInfos-07511
fn scratch_usage_07511(build: &MicromapBuildContext<'_>, state: &State, report: &mut Report) {
    let (scratch, required) = (("scratchData", build.info.scratch_data), vk::BufferUsageFlags::STORAGE_BUFFER);
    address_usage(build, scratch, required, state, RuleId::ScratchUsage07511, report);
}

/// Scratch memory, if any is needed, lies in a buffer.
///
/// VUID-vkCmdBuildMicromapsEXT-pInfos-07512
fn scratch_address_07512(build: &MicromapBuildContext<'_>, state: &State, report: &mut Report) {
    if build.scratch_size(state).is_some() {
        let scratch = ("scratchData", build.info.scratch_data);
        device_address(build, scratch, state, RuleId::ScratchAddress07512, report);
    }
}

/// The data lies in a buffer.
///
/// VUID-vkCmdBuildMicromapsEXT-pInfos-10896
fn data_address_10896(build: &MicromapBuildContext<'_>, state: &State, report: &mut Report) {
    device_address(build, ("data", build.info.data), state, RuleId::DataAddress10896, report);
}

/// The triangle array lies in a buffer.
///
/// VUID-vkCmdBuildMicromapsEXT-pInfos-10897
fn triangle_array_address_10897(build: &MicromapBuildContext<'_>, state: &State, report: &mut Report) {
    let array = ("triangleArray", build.info.triangle_array);
    device_address(build, array, state, RuleId::TriangleArrayAddress10897, report);
}

/// The micromap lies in memory that the host can reach.
///
/// VUID-vkBuildMicromapsEXT-pInfos-07552
fn host_dst_micromap_memory_07552(build: &MicromapBuildContext<'_>, state: &State, report: &mut Report) {
    let dst = build.info.dst_micromap;
    let at = build.at.field("dstMicromap");
    match state.micromap_is_bound(dst) {
        None => {}
        Some(false) => {
            report.push(RuleId::HostDstMicromapMemory07552, &at, ViolationKind::NotHostVisible { found: None });
        }
        Some(true) => {
            let flags = |span: MemorySpan| state.memory(span.memory)?.property_flags;
            if let Some(found) = dst_memory(build, state)
                .filter_map(flags)
                .find(|flags| !flags.contains(vk::MemoryPropertyFlags::HOST_VISIBLE))
            {
                let kind = ViolationKind::NotHostVisible { found: Some(found.into()) };
                report.push(RuleId::HostDstMicromapMemory07552, &at, kind);
            }
        }
    }
}

/// The micromap's memory is the same on every physical device.
///
/// VUID-vkBuildMicromapsEXT-pInfos-07557
fn host_dst_micromap_instances_07557(build: &MicromapBuildContext<'_>, state: &State, report: &mut Report) {
    let instances = |span: MemorySpan| Some(state.memory(span.memory)?.instances);
    let instances = dst_memory(build, state).filter_map(instances).max();
    if let Some(found) = instances.filter(|found| *found > 1) {
        let kind = ViolationKind::MultipleInstances { found: found as u64 };
        report.push(RuleId::HostDstMicromapInstances07557, &build.at.field("dstMicromap"), kind);
    }
}

/// The memory that the micromap lies in, as far as it is known.
fn dst_memory<'a>(build: &MicromapBuildContext<'_>, state: &'a State) -> impl Iterator<Item = MemorySpan> + use<'a> {
    let micromap = state.micromap(build.info.dst_micromap);
    micromap.into_iter().flat_map(|micromap| state.buffer_memory(micromap.buffer, micromap.offset, micromap.size))
}

/// The address of that name lies in a buffer, in one that has the usage.
fn address_usage(
    build: &MicromapBuildContext<'_>,
    (name, address): (&'static str, vk::DeviceOrHostAddress),
    required: vk::BufferUsageFlags,
    state: &State,
    rule: RuleId,
    report: &mut Report,
) {
    let Some(address) = address.device_address() else { return };
    let usages = || state.buffers_at(address).map(|(_, buffer, _, _)| buffer.usage);
    // In no buffer at all: another rule's business.
    if let Some(found) = usages().next().filter(|_| !usages().any(|usage| usage.contains(required))) {
        let kind = ViolationKind::MissingFlags { found: found.into(), required: required.into() };
        report.push(rule, &build.at.field(name), kind);
    }
}

/// The address of that name is one of device memory and lies in a buffer, as far as buffers are known.
fn device_address(
    build: &MicromapBuildContext<'_>,
    (name, found): (&'static str, vk::DeviceOrHostAddress),
    state: &State,
    rule: RuleId,
    report: &mut Report,
) {
    let address = found.device_address().filter(|address| !address.is_null());
    let is_valid = address.is_some_and(|address| !state.knows_addresses() || state.bytes_from(address).is_some());
    if !is_valid {
        report.push(rule, &build.at.field(name), ViolationKind::InvalidAddress { found: found.raw() });
    }
}

impl MicromapBuildContext<'_> {
    /// Where the build is done; `None` where sizes are asked for.
    pub(crate) const fn timeline(&self) -> Option<Timeline> {
        match self.purpose {
            MicromapPurpose::Device => Some(Timeline::Device),
            MicromapPurpose::Host => Some(Timeline::Host),
            MicromapPurpose::Sizes => None,
        }
    }

    /// How much scratch memory the build needs, if the size query was seen and it needs any.
    pub(crate) fn scratch_size(&self, state: &State) -> Option<u64> {
        let sizes = state.micromap_build_sizes(self.info, self.timeline()?)?;
        Some(sizes.build_scratch_size).filter(|size| *size > 0)
    }
}
