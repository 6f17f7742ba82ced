//! Top-level builds: instances are stored as they are given; which structures they refer to is looked at, not into.

use std::collections::BTreeSet;

use omm_layout::instance;
use omm_layout::object::{ObjectHeader, TlasContents};
use omm_model::call::Timeline;
use omm_model::vk;

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
        let instances = self.instances(data, range, timeline).at("geometry.instances").at(at)?;
        let referenced: BTreeSet<u64> =
            instances.iter().map(|instance| instance.acceleration_structure_reference).collect();
        for address in referenced {
            // What is not built yet has only its address in common with others.
            let size =
                self.memory.read(address, ObjectHeader::SIZE).ok().and_then(|bytes| ObjectHeader::read(bytes).ok());
            if let Ok(place) = self.memory.place(address, size.map_or(1, |header| header.size)) {
                access.read(place, format!("pGeometries[0].geometry.instances.data<{address:#x}>"));
            }
        }
        Ok(TlasContents { flags: info.flags.bits(), instances }.encode().map_err(super::too_large)?)
    }

    fn instances(
        &self,
        data: &vk::GeometryInstancesData,
        range: vk::BuildRangeInfo,
        timeline: Timeline,
    ) -> Result<Vec<vk::Instance>, Stop> {
        let count = u64::from(range.primitive_count);
        if count == 0 {
            return Ok(Vec::new());
        }
        let address = Address::of(timeline, data.data).at("data")?;
        let pointers = data.array_of_pointers.is_true();
        let size = if pointers { 8 } else { instance::SIZE as u64 };
        let items =
            Items::new(&self.memory, (address, range.primitive_offset.into()), (size, size), count).at("data")?;
        let mut instances = Vec::new();
        for index in 0..count {
            let at = format_args!("data[{index}]");
            let item = items.get(index).at(at)?;
            let item = if pointers {
                let pointer = item.first_chunk().map_or(0, |bytes| u64::from_le_bytes(*bytes));
                self.memory.read(address.same(pointer), instance::SIZE as u64).at(at)?
            } else {
                item
            };
            let mut found = instance::read(item).at(at)?;
            let reference = &mut found.acceleration_structure_reference;
            if *reference != 0 {
                let at = format_args!("{at}.accelerationStructureReference");
                match timeline {
                    Timeline::Device if self.structures.has_address(*reference) => {}
                    Timeline::Device => return Err(Reason::UnknownReference { address: *reference }).at(at),
                    // Instances in host memory name structures by handle.
                    Timeline::Host => {
                        *reference = self.range(vk::AccelerationStructure(*reference).into()).at(at)?.address;
                    }
                }
            }
            instances.push(found);
        }
        Ok(instances)
    }
}
