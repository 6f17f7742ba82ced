//! Builds: everything that a command builds is worked out first, from memory as it was before the command, then written.

use omm_layout::build_range;
use omm_layout::error::WriteError;
use omm_layout::object::ObjectKind;
use omm_model::call::Timeline;
use omm_model::vk;

use crate::acceleration_structure::kind_of;
use crate::device::Device;
use crate::memory::Address;
use crate::micromap::check_type;
use crate::undefined::{At, Reason, Stop};
use crate::work::Unit;

pub(crate) mod access;
pub(crate) mod attached;
pub(crate) mod bottom_level;
pub(crate) mod geometry;
pub(crate) mod lossy;
pub(crate) mod micromap;
pub(crate) mod sizes;
pub(crate) mod top_level;
pub(crate) mod update;

use access::Access;

/// Where the ranges of a build's geometries are.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Ranges<'a> {
    /// In the call; `None` is a null pointer.
    Direct(Option<&'a [vk::BuildRangeInfo]>),
    /// In device memory: the address of the first, bytes from one to the next, and the most primitives of each geometry.
    Indirect(vk::DeviceAddress, u32, Option<&'a [u32]>),
}

impl Device {
    /// Works out one element of `pInfos`.
    pub(crate) fn build(
        &self,
        info: &vk::BuildGeometryInfo,
        ranges: Ranges<'_>,
        index: usize,
        timeline: Timeline,
    ) -> Result<Unit, Stop> {
        let within = format_args!("pInfos[{index}]");
        let kind = kind(info).at(within)?;
        if kind == ObjectKind::Micromap && (timeline == Timeline::Host || matches!(ranges, Ranges::Indirect(..))) {
            return Err(Reason::WrongCommand { what: "a micromap" }).at("type").at(within);
        }
        let ranges = match ranges {
            Ranges::Direct(ranges) => {
                direct(info, kind, ranges).at(format_args!("ppBuildRangeInfos[{index}]"))?.to_vec()
            }
            Ranges::Indirect(address, stride, counts) => self.indirect(info, address, stride, counts, index)?,
        };
        self.build_kind(info, kind, &ranges, Access::new(index), timeline).at(within)
    }

    fn build_kind(
        &self,
        info: &vk::BuildGeometryInfo,
        kind: ObjectKind,
        ranges: &[vk::BuildRangeInfo],
        mut access: Access,
        timeline: Timeline,
    ) -> Result<Unit, Stop> {
        let counts: Vec<u32> = ranges.iter().map(|range| range.primitive_count).collect();
        let size = sizes::structure_size(&self.profile.limits, info, kind, &counts)?;
        let dst = info.dst_acceleration_structure.into();
        let range = self.destination(timeline, dst, kind, size).at("dstAccelerationStructure")?;
        let update = info.mode == vk::BuildAccelerationStructureMode::UPDATE;
        let scratch_size =
            if update { sizes::update_scratch_size(info, size) } else { sizes::build_scratch_size(size) };
        self.scratch(info.scratch_data, scratch_size, timeline, &mut access)?;
        let bytes = match kind {
            ObjectKind::Micromap => self.build_micromap(info, range.size)?,
            ObjectKind::BottomLevel => self.build_bottom_level(info, ranges, timeline, &mut access)?,
            ObjectKind::TopLevel => self.build_top_level(info, ranges, timeline, &mut access)?,
        };
        let place = self.memory.place(range.address, bytes.len() as u64).at("dstAccelerationStructure")?;
        access.write(place, "dstAccelerationStructure");
        if update {
            self.check_update(info, &bytes, timeline, &mut access)?;
        }
        Ok(Unit { address: Address::Device(range.address), bytes, access })
    }

    /// Works out one element of `pInfos` of a command that builds micromap objects of the EXT extension.
    pub(crate) fn build_object(
        &self,
        info: &vk::MicromapBuildInfo,
        index: usize,
        timeline: Timeline,
    ) -> Result<Unit, Stop> {
        self.build_object_at(info, Access::new(index), timeline).at(format_args!("pInfos[{index}]"))
    }

    fn build_object_at(
        &self,
        info: &vk::MicromapBuildInfo,
        mut access: Access,
        timeline: Timeline,
    ) -> Result<Unit, Stop> {
        check_type(info.ty).at("type")?;
        if info.mode != vk::BuildMicromapMode::BUILD {
            return Err(Reason::UnknownValue { found: info.mode.0.into() }).at("mode");
        }
        let size = sizes::micromap_object_size(info)?;
        let dst = info.dst_micromap.into();
        let range = self.destination(timeline, dst, ObjectKind::Micromap, size).at("dstMicromap")?;
        self.scratch(info.scratch_data, sizes::build_scratch_size(size), timeline, &mut access)?;
        let bytes = self.build_micromap_object(info, timeline, range.size)?;
        let place = self.memory.place(range.address, bytes.len() as u64).at("dstMicromap")?;
        access.write(place, "dstMicromap");
        Ok(Unit { address: Address::Device(range.address), bytes, access })
    }

    /// Takes scratch memory.
    fn scratch(
        &self,
        address: vk::DeviceOrHostAddress,
        size: u64,
        timeline: Timeline,
        access: &mut Access,
    ) -> Result<(), Stop> {
        if size > 0 {
            let address = Address::of(timeline, address).at("scratchData")?;
            access.write(self.memory.place(address, size).at("scratchData")?, "scratchData");
        }
        Ok(())
    }

    /// The ranges of a build that lie in device memory.
    fn indirect(
        &self,
        info: &vk::BuildGeometryInfo,
        address: vk::DeviceAddress,
        stride: u32,
        counts: Option<&[u32]>,
        index: usize,
    ) -> Result<Vec<vk::BuildRangeInfo>, Stop> {
        let required = info.geometries_iter().count() as u64;
        let at = format_args!("ppMaxPrimitiveCounts[{index}]");
        let counts = match counts {
            None if required > 0 => return Err(Reason::Missing { what: "the array of primitive counts" }).at(at),
            counts => counts.unwrap_or_default(),
        };
        let found = counts.len() as u64;
        if found != required {
            return Err(Reason::CountMismatch { found, required }).at(at);
        }
        let at = format!("pIndirectDeviceAddresses[{index}]");
        let item = (u64::from(stride), build_range::SIZE as u64);
        let items = geometry::Items::new(&self.memory, (address.0.into(), 0), item, required).at(&at)?;
        let mut ranges = Vec::with_capacity(counts.len());
        for (geometry, &most) in (0..).zip(counts) {
            let bytes = items.get(geometry).at(format_args!("{at}[{geometry}]"))?;
            let range = bytes.first_chunk().map(build_range::decode).unwrap_or_default();
            if range.primitive_count > most {
                let why = Reason::TooManyPrimitives { found: range.primitive_count, limit: most };
                return Err(why).at(format_args!("{at}[{geometry}].primitiveCount"));
            }
            ranges.push(range);
        }
        Ok(ranges)
    }
}

/// What is built, if it can be built at all.
fn kind(info: &vk::BuildGeometryInfo) -> Result<ObjectKind, Stop> {
    let kind = kind_of(info.ty).ok_or(Reason::UnknownValue { found: info.ty.0.into() }).at("type")?;
    match info.mode {
        vk::BuildAccelerationStructureMode::BUILD | vk::BuildAccelerationStructureMode::UPDATE => Ok(kind),
        vk::BuildAccelerationStructureMode(found) => Err(Reason::UnknownValue { found: found.into() }).at("mode"),
    }
}

/// What a structure that the packed form has no numbers for is to the device: with counts of 32 bits, one of tens of gibibytes.
fn too_large(_: WriteError) -> Reason {
    Reason::Unsupported { what: "structures of that size" }
}

/// The ranges of a build's geometries; none for a micromap, which ignores them.
fn direct<'a>(
    info: &vk::BuildGeometryInfo,
    kind: ObjectKind,
    ranges: Option<&'a [vk::BuildRangeInfo]>,
) -> Result<&'a [vk::BuildRangeInfo], Reason> {
    let required = info.geometries_iter().count() as u64;
    match ranges {
        _ if kind == ObjectKind::Micromap => Ok(&[]),
        Some(ranges) if ranges.len() as u64 == required => Ok(ranges),
        Some(ranges) => Err(Reason::CountMismatch { found: ranges.len() as u64, required }),
        None if required == 0 => Ok(&[]),
        None => Err(Reason::Missing { what: "the array of build ranges" }),
    }
}
