//! Top-level builds: instances, moving or not, are stored as they are given; which structures they refer to is looked at, not into.

use std::collections::BTreeSet;

use omm_layout::object::{MotionTlasContents, ObjectHeader, TlasContents};
use omm_layout::{instance, motion_instance};
use omm_model::call::Timeline;
use omm_model::vk::{self, MotionInstanceData};

use super::access::Access;
use super::geometry::{self, Body, Items};
use crate::device::Device;
use crate::memory::Address;
use crate::undefined::{At, Reason, Stop};

impl Device {
    /// The bytes of a top-level structure.
    pub(crate) fn build_top_level(
        &self,
        info: &vk::BuildGeometryInfo,
        ranges: &[vk::BuildRangeInfo],
        timeline: Timeline,
        access: &mut Access,
    ) -> Result<Vec<u8>, Stop> {
        let (geometry, at) = geometry::only(info)?;
        let Body::Instances(data) = geometry::body(geometry).at(&at)? else {
            return Err(Reason::GeometryType { found: geometry.geometry_type }).at("geometryType").at(at);
        };
        let range = ranges.first().copied().unwrap_or_default();
        let motion = info.flags.contains(vk::BuildAccelerationStructureFlags::MOTION);
        let instances = self.instances(data, range, timeline, motion).at("geometry.instances").at(at)?;
        let referenced: BTreeSet<u64> =
            instances.iter().map(MotionInstanceData::acceleration_structure_reference).collect();
        for address in referenced {
            // What is not built yet has only its address in common with others.
            let size =
                self.memory.read(address, ObjectHeader::SIZE).ok().and_then(|bytes| ObjectHeader::read(bytes).ok());
            if let Ok(place) = self.memory.place(address, size.map_or(1, |header| header.size)) {
                access.read(place, format!("pGeometries[0].geometry.instances.data<{address:#x}>"));
            }
        }
        let flags = info.flags.bits();
        let statics = || {
            let only_static = |instance| match instance {
                MotionInstanceData::StaticInstance(found) => Some(found),
                _ => None,
            };
            instances.iter().copied().filter_map(only_static).collect()
        };
        let bytes = match motion {
            true => MotionTlasContents { flags, instances }.encode(),
            false => TlasContents { flags, instances: statics() }.encode(),
        };
        Ok(bytes.map_err(super::too_large)?)
    }

    fn instances(
        &self,
        data: &vk::GeometryInstancesData,
        range: vk::BuildRangeInfo,
        timeline: Timeline,
        motion: bool,
    ) -> Result<Vec<MotionInstanceData>, Stop> {
        let count = u64::from(range.primitive_count);
        if count == 0 {
            return Ok(Vec::new());
        }
        let address = Address::of(timeline, data.data).at("data")?;
        let pointers = data.array_of_pointers.is_true();
        let (stride, size) = match (pointers, motion) {
            (true, _) => (8, 8),
            (false, true) => (motion_instance::STRIDE, motion_instance::SIZE as u64),
            (false, false) => (instance::SIZE as u64, instance::SIZE as u64),
        };
        let items =
            Items::new(&self.memory, (address, range.primitive_offset.into()), (stride, size), count).at("data")?;
        let mut instances = Vec::new();
        for index in 0..count {
            let at = format_args!("data[{index}]");
            let item = items.get(index).at(at)?;
            let found = match (pointers, motion) {
                (true, _) => self.pointed_to(address, item, motion).at(at)?,
                (false, true) => {
                    let ty = item.first_chunk().map_or(0, |bytes| i32::from_le_bytes(*bytes));
                    data_size(vk::MotionInstanceType(ty)).at(at)?;
                    motion_instance::read(item).at(at)?
                }
                (false, false) => MotionInstanceData::StaticInstance(instance::read(item).at(at)?),
            };
            instances.push(self.referring(found, timeline).at(at)?);
        }
        Ok(instances)
    }

    /// The instance that an entry of an array of pointers leads to; with motion the pointer's lowest bits are its type.
    fn pointed_to(&self, array: Address, entry: &[u8], motion: bool) -> Result<MotionInstanceData, Stop> {
        let pointer = entry.first_chunk().map_or(0, |bytes| u64::from_le_bytes(*bytes));
        let ty = if motion { pointer & motion_instance::POINTER_TYPE } else { 0 };
        let ty = vk::MotionInstanceType(ty as i32);
        let size = data_size(ty)?;
        let pointer = if motion { pointer & !motion_instance::POINTER_TYPE } else { pointer };
        Ok(motion_instance::read_data(ty, self.memory.read(array.same(pointer), size)?)?)
    }

    /// The instance with the device address of what it refers to.
    fn referring(&self, found: MotionInstanceData, timeline: Timeline) -> Result<MotionInstanceData, Stop> {
        let reference = found.acceleration_structure_reference();
        match timeline {
            _ if reference == 0 => Ok(found),
            Timeline::Device if self.structures.has_address(reference) => Ok(found),
            Timeline::Device => {
                Err(Reason::UnknownReference { address: reference }).at("accelerationStructureReference")
            }
            // Instances in host memory name structures by handle.
            Timeline::Host => {
                let range = self.range(vk::AccelerationStructure(reference).into());
                Ok(found.with_reference(range.at("accelerationStructureReference")?.address))
            }
        }
    }
}

/// Bytes of an instance of a type.
fn data_size(ty: vk::MotionInstanceType) -> Result<u64, Stop> {
    let size = motion_instance::data_size(ty).ok_or(Reason::UnknownValue { found: ty.0.into() });
    Ok(size.at("type")? as u64)
}
