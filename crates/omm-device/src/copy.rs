//! Copies of what was built: clone, compact, serialize, deserialize, and the sizes of all of these. Acceleration structures and
//! micromap objects are copied alike, on either timeline.

use omm_layout::object::{self, Object, ObjectHeader};
use omm_model::call::Timeline;
use omm_model::vk;
use omm_serialize::blob::Prefix;
use omm_serialize::{ByteOrder, header};

use crate::build::access::Access;
use crate::device::Device;
use crate::holder::Holder;
use crate::memory::Address;
use crate::undefined::{At, Reason, Stop};
use crate::work::Unit;

/// How a copy changes what it copies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    Same,
    Compacted,
}

impl Device {
    /// A clone or compaction.
    pub(crate) fn copy(&self, src: Holder, dst: Holder, form: Form, timeline: Timeline) -> Result<Unit, Stop> {
        let source = self.object(timeline, src).at("src")?;
        let bytes = match form {
            Form::Same => source.as_bytes().to_vec(),
            Form::Compacted => source.compact(),
        };
        let header = *source.header();
        let read = self.memory.place(self.range(src).at("src")?.address, header.size).at("src")?;
        let dst = self.destination(timeline, dst, header.kind, bytes.len() as u64).at("dst")?.address;
        if self.memory.place(dst, bytes.len() as u64).at("dst")?.overlaps(&read) {
            return Err(Reason::Overlap { other: "pInfo->src".to_owned() }).at("dst");
        }
        Ok(Unit { address: dst.into(), bytes, access: Access::new(0) })
    }

    /// A serialization.
    pub(crate) fn serialize(
        &self,
        src: Holder,
        dst: vk::DeviceOrHostAddress,
        timeline: Timeline,
    ) -> Result<Unit, Stop> {
        let source = self.object(timeline, src).at("src")?;
        let profile = &self.profile;
        let bytes = omm_serialize::serialize_object(source.as_bytes(), profile.driver_uuid, profile.compatibility_uuid);
        let bytes = bytes.at("src")?;
        let address = Address::of(timeline, dst).at("dst")?;
        self.memory.place(address, bytes.len() as u64).at("dst")?;
        Ok(Unit { address, bytes, access: Access::new(0) })
    }

    /// A deserialization.
    pub(crate) fn deserialize(
        &self,
        src: vk::DeviceOrHostAddress,
        dst: Holder,
        timeline: Timeline,
    ) -> Result<Unit, Stop> {
        let src = Address::of(timeline, src).at("src")?;
        let prefix = Prefix::read(self.memory.read(src, header::FIXED_SIZE).at("src")?, ByteOrder::Little).at("src")?;
        let Prefix { driver_uuid: driver, compatibility_uuid: compatibility, .. } = prefix;
        if driver != self.profile.driver_uuid || compatibility != self.profile.compatibility_uuid {
            return Err(Reason::Incompatible { driver, compatibility }).at("src");
        }
        let blob = self.memory.read(src, prefix.serialized_size).at("src")?;
        let bytes = omm_serialize::deserialize_object(blob).at("src")?;
        for address in object::references(&bytes).at("src")? {
            self.check_address(address).at("src")?;
        }
        let kind = ObjectHeader::read(&bytes).at("src")?.kind;
        let dst = self.destination(timeline, dst, kind, bytes.len() as u64).at("dst")?.address;
        Ok(Unit { address: dst.into(), bytes, access: Access::new(0) })
    }

    /// `vkGetDeviceAccelerationStructureCompatibilityKHR` and `vkGetDeviceMicromapCompatibilityEXT`.
    pub(crate) fn compatibility(&self, version_data: &[u8]) -> Result<vk::AccelerationStructureCompatibility, Stop> {
        let (required, available) = (2 * vk::UUID_SIZE as u64, version_data.len() as u64);
        if available < required {
            return Err(Reason::TooSmall { required, available }).at("pVersionInfo->pVersionData");
        }
        Ok(if omm_serialize::compatibility(version_data, &self.profile) {
            vk::AccelerationStructureCompatibility::COMPATIBLE
        } else {
            vk::AccelerationStructureCompatibility::INCOMPATIBLE
        })
    }

    /// One size of each of some objects.
    pub(crate) fn properties<H: Copy + Into<Holder>>(
        &self,
        holders: &[H],
        query_type: vk::QueryType,
        timeline: Timeline,
    ) -> Result<Vec<u64>, Stop> {
        let mut values = Vec::with_capacity(holders.len());
        for (index, &holder) in holders.iter().enumerate() {
            let holder = holder.into();
            let array = match holder {
                Holder::Structure(_) => "pAccelerationStructures",
                Holder::Micromap(_) => "pMicromaps",
            };
            let object = self.object(timeline, holder).at(format_args!("{array}[{index}]"))?;
            values.push(property(&object, query_type, holder).at("queryType")?);
        }
        Ok(values)
    }

    /// The sizes that a host command writes to an array of `data_size` bytes.
    pub(crate) fn host_properties<H: Copy + Into<Holder>>(
        &self,
        holders: &[H],
        query_type: vk::QueryType,
        data_size: u64,
        stride: u64,
    ) -> Result<Vec<u64>, Stop> {
        let last = (holders.len() as u64).checked_sub(1);
        let required = last.map_or(0, |last| last.saturating_mul(stride).saturating_add(8));
        if required > data_size {
            return Err(Reason::TooSmall { required, available: data_size }).at("dataSize");
        }
        self.properties(holders, query_type, Timeline::Host)
    }
}

fn property(object: &Object<'_>, query_type: vk::QueryType, holder: Holder) -> Result<u64, Reason> {
    let header = object.header();
    Ok(match (holder, query_type) {
        (Holder::Structure(_), vk::QueryType::ACCELERATION_STRUCTURE_SIZE) => header.size,
        (Holder::Structure(_), vk::QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE)
        | (Holder::Micromap(_), vk::QueryType::MICROMAP_COMPACTED_SIZE) => header.compacted_size,
        (Holder::Structure(_), vk::QueryType::ACCELERATION_STRUCTURE_SERIALIZATION_SIZE)
        | (Holder::Micromap(_), vk::QueryType::MICROMAP_SERIALIZATION_SIZE) => omm_serialize::serialized_size(header),
        // What a bottom-level structure refers to are micromaps, which are counted in blocks.
        (Holder::Structure(_), vk::QueryType::ACCELERATION_STRUCTURE_SERIALIZATION_BOTTOM_LEVEL_POINTERS) => {
            match object {
                Object::TopLevel(_) => header.reference_count.into(),
                Object::BottomLevel(_) | Object::Micromap(_) => 0,
            }
        }
        (_, vk::QueryType(found)) => return Err(Reason::UnknownValue { found: found.into() }),
    })
}
