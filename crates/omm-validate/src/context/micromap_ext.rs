//! What rules on micromap objects of the EXT extension see.

use omm_model::call::Call;
use omm_model::profile::Limits;
use omm_model::vk;

use super::GeometryContext;
use crate::location::At;

/// What a command wants with a `VkMicromapBuildInfoEXT`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MicromapPurpose {
    /// Build from it when the command buffer executes.
    Device,
    /// Build from it on the host.
    Host,
    /// Tell how much memory a build would take. Addresses, handles and mode are ignored.
    Sizes,
}

/// One `VkMicromapBuildInfoEXT`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MicromapBuildContext<'a> {
    pub(crate) at: At<'a>,
    pub(crate) info: &'a vk::MicromapBuildInfo,
    /// The infos of the same command that stand before this one.
    pub(crate) earlier: &'a [vk::MicromapBuildInfo],
    /// All infos of the command.
    pub(crate) infos: &'a [vk::MicromapBuildInfo],
    pub(crate) purpose: MicromapPurpose,
    pub(crate) limits: &'a Limits,
}

/// Usage counts of the EXT extension, in either of two arrays.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UsagesExt<'a> {
    /// The structure that has the two pointers.
    pub(crate) at: &'a At<'a>,
    pub(crate) direct: Option<&'a [vk::MicromapUsageExt]>,
    pub(crate) pointers: Option<&'a [vk::MicromapUsageExt]>,
}

/// A micromap object attached to triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OpacityMicromapExtContext<'a> {
    pub(crate) geometry: &'a GeometryContext<'a>,
    pub(crate) at: At<'a>,
    pub(crate) attached: &'a vk::TrianglesOpacityMicromapExt,
}

/// Visits every micromap build structure that a call takes.
pub(crate) fn each_micromap_build(call: &Call, limits: &Limits, mut visit: impl FnMut(&MicromapBuildContext<'_>)) {
    let (object, infos, purpose) = match call {
        Call::CmdBuildMicromaps { command_buffer, infos } => {
            let object = (vk::CommandBuffer::OBJECT_TYPE, command_buffer.0);
            (object, infos, MicromapPurpose::Device)
        }
        Call::BuildMicromaps { device, infos, .. } => {
            ((vk::Device::OBJECT_TYPE, device.0), infos, MicromapPurpose::Host)
        }
        Call::GetMicromapBuildSizes { device, build_info: info, .. } => {
            let command = At::command(call.command(), (vk::Device::OBJECT_TYPE, device.0));
            let (at, purpose) = (command.pointer("pBuildInfo"), MicromapPurpose::Sizes);
            visit(&MicromapBuildContext { at, info, earlier: &[], infos: &[], purpose, limits });
            return;
        }
        _ => return,
    };
    let command = At::command(call.command(), object);
    for (index, info) in infos.iter().enumerate() {
        let at = command.element("pInfos", index).about_micromap(info.dst_micromap);
        let earlier = infos.get(..index).unwrap_or_default();
        visit(&MicromapBuildContext { at, info, earlier, infos, purpose, limits });
    }
}

impl MicromapBuildContext<'_> {
    /// The one rule of twins that belongs to the command: of `vkCmdBuildMicromapsEXT`, otherwise of `vkBuildMicromapsEXT`.
    pub(crate) fn twin<T>(&self, device: T, host: T) -> T {
        if self.purpose == MicromapPurpose::Host { host } else { device }
    }

    /// The usage counts.
    pub(crate) fn usages(&self) -> UsagesExt<'_> {
        let vk::MicromapBuildInfo { usage_counts, usage_count_pointers, .. } = self.info;
        UsagesExt { at: &self.at, direct: usage_counts.as_deref(), pointers: usage_count_pointers.as_deref() }
    }

    /// The triangles of all usages of the array that a driver reads: the direct one where both are given.
    pub(crate) fn triangle_count(&self) -> u64 {
        self.info.usages().fold(0, |sum, usage| sum.saturating_add(usage.count.into()))
    }
}

impl UsagesExt<'_> {
    /// Visits every usage of whichever array is given, of both where both are.
    pub(crate) fn each(&self, mut visit: impl FnMut(&At<'_>, &vk::MicromapUsageExt)) {
        for (index, usage) in self.direct.into_iter().flatten().enumerate() {
            visit(&self.at.element("pUsageCounts", index), usage);
        }
        for (index, usage) in self.pointers.into_iter().flatten().enumerate() {
            visit(&self.at.element_pointer("ppUsageCounts", index), usage);
        }
    }
}

impl GeometryContext<'_> {
    /// Visits every micromap object attached to triangles; there should be at most one.
    pub(crate) fn each_opacity_micromap_ext(&self, mut visit: impl FnMut(&OpacityMicromapExtContext<'_>)) {
        self.with_triangles(|at, triangles| {
            for structure in &triangles.next {
                if let vk::ChainStructure::TrianglesOpacityMicromapExt(attached) = structure {
                    let at = at.chained("VkAccelerationStructureTrianglesOpacityMicromapEXT");
                    let at = at.about_micromap(attached.micromap);
                    visit(&OpacityMicromapExtContext { geometry: self, at, attached });
                }
            }
        });
    }
}

impl OpacityMicromapExtContext<'_> {
    /// The usage counts.
    pub(crate) fn usages(&self) -> UsagesExt<'_> {
        let vk::TrianglesOpacityMicromapExt { usage_counts, usage_count_pointers, .. } = self.attached;
        UsagesExt { at: &self.at, direct: usage_counts.as_deref(), pointers: usage_count_pointers.as_deref() }
    }
}
