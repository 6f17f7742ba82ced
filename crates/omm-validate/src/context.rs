//! What a rule sees: a part of a call with its path, and the walk over a call that makes these parts.
//!
//! Every context borrows the call and its parent context, so that walking a call allocates nothing. One walk serves every command
//! that takes the same structures.

pub(crate) mod micromap_ext;

use omm_model::call::Call;
use omm_model::profile::{Features, Limits};
use omm_model::vk;

use crate::location::At;
use crate::state::State;

/// What a command wants with a build structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// Build from it, `vkCmdBuildAccelerationStructuresKHR`.
    Build {
        /// The command buffer that the build is recorded into.
        command_buffer: vk::CommandBuffer,
    },
    /// Build from it with ranges in device memory, `vkCmdBuildAccelerationStructuresIndirectKHR`.
    Indirect {
        /// The command buffer that the build is recorded into.
        command_buffer: vk::CommandBuffer,
        /// Where the first range is.
        ranges: vk::DeviceAddress,
        /// Bytes from one range to the next.
        stride: u32,
    },
    /// Build from it on the host, `vkBuildAccelerationStructuresKHR`.
    Host,
    /// Tell how much memory a build would take. Addresses, source, destination and mode are ignored.
    Sizes,
}

/// One `VkAccelerationStructureBuildGeometryInfoKHR`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BuildContext<'a> {
    pub(crate) at: At<'a>,
    pub(crate) info: &'a vk::BuildGeometryInfo,
    /// The builds of the command, this one among them.
    pub(crate) infos: &'a [vk::BuildGeometryInfo],
    /// Where the build ranges are, for a build: the parameter and the ranges or null pointer that it has for this build.
    pub(crate) ranges: Option<(At<'a>, Option<&'a [vk::BuildRangeInfo]>)>,
    /// For an indirect build: the most primitives of each geometry.
    pub(crate) announced: Option<&'a [u32]>,
    pub(crate) purpose: Purpose,
    pub(crate) limits: &'a Limits,
    pub(crate) features: &'a Features,
}

/// One geometry of a build.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GeometryContext<'a> {
    pub(crate) build: &'a BuildContext<'a>,
    pub(crate) at: At<'a>,
    /// Which geometry of the build it is.
    pub(crate) index: usize,
    pub(crate) geometry: &'a vk::Geometry,
    /// How many primitives of it are built, if a range says so.
    pub(crate) primitive_count: Option<u32>,
    /// How many there may be at most, if the build is indirect.
    pub(crate) announced: Option<u32>,
}

/// The input of a micromap build.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MicromapDataContext<'a> {
    pub(crate) build: &'a BuildContext<'a>,
    pub(crate) at: At<'a>,
    pub(crate) data: &'a vk::GeometryMicromapData,
}

/// A micromap attached to triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OpacityMicromapContext<'a> {
    pub(crate) geometry: &'a GeometryContext<'a>,
    pub(crate) at: At<'a>,
    pub(crate) attached: &'a vk::TrianglesOpacityMicromap,
}

/// Where every path of a call begins.
pub(crate) fn command_at(call: &Call) -> At<'static> {
    let command_buffer = call.recorded_into().map(|it| (vk::CommandBuffer::OBJECT_TYPE, it.0));
    let device = call.device().map(|it| (vk::Device::OBJECT_TYPE, it.0));
    At::command(call.command(), command_buffer.or(device).unwrap_or((vk::Device::OBJECT_TYPE, 0)))
}

/// Visits every build structure that a call takes.
pub(crate) fn each_build(call: &Call, limits: &Limits, features: &Features, mut visit: impl FnMut(&BuildContext<'_>)) {
    match call {
        Call::CmdBuildAccelerationStructures { command_buffer, infos, build_range_infos } => {
            let command = At::command(call.command(), (vk::CommandBuffer::OBJECT_TYPE, command_buffer.0));
            for (index, info) in infos.iter().enumerate() {
                let ranges_at = command.element("ppBuildRangeInfos", index).about(info.dst_acceleration_structure);
                let ranges = build_range_infos.get(index).map(|ranges| (ranges_at, ranges.as_deref()));
                let at = command.element("pInfos", index).about(info.dst_acceleration_structure);
                let purpose = Purpose::Build { command_buffer: *command_buffer };
                visit(&BuildContext { at, info, infos, ranges, announced: None, purpose, limits, features });
            }
        }
        Call::CmdBuildAccelerationStructuresIndirect {
            command_buffer,
            infos,
            indirect_device_addresses,
            indirect_strides,
            max_primitive_counts,
        } => {
            let command = At::command(call.command(), (vk::CommandBuffer::OBJECT_TYPE, command_buffer.0));
            for (index, info) in infos.iter().enumerate() {
                let at = command.element("pInfos", index).about(info.dst_acceleration_structure);
                let purpose = Purpose::Indirect {
                    command_buffer: *command_buffer,
                    ranges: indirect_device_addresses.get(index).copied().unwrap_or_default(),
                    stride: indirect_strides.get(index).copied().unwrap_or_default(),
                };
                let announced = max_primitive_counts.get(index).map(|counts| counts.as_deref().unwrap_or_default());
                visit(&BuildContext { at, info, infos, ranges: None, announced, purpose, limits, features });
            }
        }
        Call::BuildAccelerationStructures { device, infos, build_range_infos, .. } => {
            let command = At::command(call.command(), (vk::Device::OBJECT_TYPE, device.0));
            for (index, info) in infos.iter().enumerate() {
                let ranges_at = command.element("ppBuildRangeInfos", index).about(info.dst_acceleration_structure);
                let ranges = build_range_infos.get(index).map(|ranges| (ranges_at, ranges.as_deref()));
                let at = command.element("pInfos", index).about(info.dst_acceleration_structure);
                let purpose = Purpose::Host;
                visit(&BuildContext { at, info, infos, ranges, announced: None, purpose, limits, features });
            }
        }
        Call::GetAccelerationStructureBuildSizes { device, build_info, .. } => {
            let command = At::command(call.command(), (vk::Device::OBJECT_TYPE, device.0));
            let at = command.pointer("pBuildInfo");
            let infos = std::slice::from_ref(build_info);
            let purpose = Purpose::Sizes;
            visit(&BuildContext {
                at,
                info: build_info,
                infos,
                ranges: None,
                announced: None,
                purpose,
                limits,
                features,
            });
        }
        _ => {}
    }
}

impl BuildContext<'_> {
    /// The command buffer that the build is recorded into; `None` on the host and where sizes are asked for.
    pub(crate) const fn command_buffer(&self) -> Option<vk::CommandBuffer> {
        match self.purpose {
            Purpose::Build { command_buffer } | Purpose::Indirect { command_buffer, .. } => Some(command_buffer),
            Purpose::Host | Purpose::Sizes => None,
        }
    }

    /// Whether the flags allow lossy storage of a micromap.
    pub(crate) fn is_lossy(&self) -> bool {
        self.info.flags.contains(vk::BuildAccelerationStructureFlags::MICROMAP_LOSSY)
    }

    /// Whether the device has micromaps of either extension.
    pub(crate) const fn has_micromaps(&self) -> bool {
        self.features.micromap || self.features.micromap_ext
    }

    /// Whether a micromap is to be built.
    pub(crate) fn is_micromap(&self) -> bool {
        self.info.ty == vk::AccelerationStructureType::OPACITY_MICROMAP
    }

    /// Visits every geometry of whichever array is given, of both where both are.
    pub(crate) fn each_geometry(&self, mut visit: impl FnMut(&GeometryContext<'_>)) {
        let ranges = self.ranges.and_then(|(_, ranges)| ranges).unwrap_or_default();
        let range = |index: usize| ranges.get(index).map(|range| range.primitive_count);
        let announced = |index: usize| self.announced?.get(index).copied();
        for (index, geometry) in self.info.geometries.iter().flatten().enumerate() {
            let at = self.at.element("pGeometries", index);
            let (primitive_count, announced) = (range(index), announced(index));
            visit(&GeometryContext { build: self, at, index, geometry, primitive_count, announced });
        }
        for (index, geometry) in self.info.geometry_pointers.iter().flatten().enumerate() {
            let at = self.at.element_pointer("ppGeometries", index);
            let (primitive_count, announced) = (range(index), announced(index));
            visit(&GeometryContext { build: self, at, index, geometry, primitive_count, announced });
        }
    }
}

impl GeometryContext<'_> {
    /// Visits every micromap input in the chain; there should be at most one.
    pub(crate) fn each_micromap_data(&self, mut visit: impl FnMut(&MicromapDataContext<'_>)) {
        for structure in &self.geometry.next {
            if let vk::ChainStructure::GeometryMicromapData(data) = structure {
                let at = self.at.chained("VkAccelerationStructureGeometryMicromapDataKHR");
                visit(&MicromapDataContext { build: self.build, at, data });
            }
        }
    }

    /// The triangles, with their path. Geometry of another type has none, whatever the union holds.
    pub(crate) fn with_triangles(&self, visit: impl FnOnce(&At<'_>, &vk::GeometryTrianglesData)) {
        let vk::GeometryData::Triangles(triangles) = &self.geometry.geometry else { return };
        if self.geometry.geometry_type == vk::GeometryType::TRIANGLES {
            let at = self.at.field("geometry");
            visit(&at.field("triangles"), triangles);
        }
    }

    /// Visits every micromap attached to triangles; there should be at most one.
    pub(crate) fn each_opacity_micromap(&self, mut visit: impl FnMut(&OpacityMicromapContext<'_>)) {
        self.with_triangles(|at, triangles| {
            for structure in &triangles.next {
                if let vk::ChainStructure::TrianglesOpacityMicromap(attached) = structure {
                    let at = at.chained("VkAccelerationStructureTrianglesOpacityMicromapKHR").about(attached.micromap);
                    visit(&OpacityMicromapContext { geometry: self, at, attached });
                }
            }
        });
    }
}

impl MicromapDataContext<'_> {
    /// Visits every usage of whichever array is given, of both where both are.
    pub(crate) fn each_usage(&self, mut visit: impl FnMut(&At<'_>, &vk::MicromapUsage)) {
        for (index, usage) in self.data.usage_counts.iter().flatten().enumerate() {
            visit(&self.at.element("pUsageCounts", index), usage);
        }
        for (index, usage) in self.data.usage_count_pointers.iter().flatten().enumerate() {
            visit(&self.at.element_pointer("ppUsageCounts", index), usage);
        }
    }

    /// The path of the usage counts as a whole.
    pub(crate) fn usages_at(&self) -> At<'_> {
        let only_pointers = self.data.usage_counts.is_none() && self.data.usage_count_pointers.is_some();
        self.at.field(if only_pointers { "ppUsageCounts" } else { "pUsageCounts" })
    }

    /// The triangles of all usages of the array that a driver reads: the direct one where both are given.
    pub(crate) fn triangle_count(&self) -> u64 {
        self.data.usages().fold(0, |sum, usage| sum.saturating_add(usage.count.into()))
    }
}

impl OpacityMicromapContext<'_> {
    /// How many triangles the micromap will have when the build executes, as far as is known while it is recorded.
    pub(crate) fn micromap_triangles(&self, state: &State) -> Option<u64> {
        let command_buffer = self.geometry.build.command_buffer()?;
        state.built(command_buffer, self.attached.micromap)?.micromap_triangles()
    }
}
