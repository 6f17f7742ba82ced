//! Built top-level acceleration structures: instances, with motion or without.

use std::collections::{BTreeSet, HashMap};

use omm_model::vk::{self, MotionInstanceData};

use super::Parts;
use super::header::{ObjectForm, ObjectHeader, ObjectKind};
use crate::bytes;
use crate::error::{ReadError, ReadErrorKind, WriteError, fits};
use crate::{instance, motion_instance};

/// Set in the second word of a record's reference if the instance is active; the first is the entry.
const ACTIVE: u64 = 1 << 32;

/// What a top-level acceleration structure holds, as a build collects it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TlasContents {
    /// The flags of the build.
    pub flags: u32,
    /// The instances in order, which refer to bottom-level structures by device address; 0 makes an instance inactive.
    pub instances: Vec<vk::Instance>,
}

/// The same with motion: what a build with [`MOTION`](vk::BuildAccelerationStructureFlags::MOTION) collects.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MotionTlasContents {
    /// The flags of the build; `MOTION` is added to them.
    pub flags: u32,
    /// The instances in order, as in [`TlasContents`].
    pub instances: Vec<MotionInstanceData>,
}

/// Whether these build flags are those of a structure with motion.
const fn has_motion(flags: u32) -> bool {
    flags & vk::BuildAccelerationStructureFlags::MOTION.bits() != 0
}

/// Bytes of an instance record.
const fn record_size(motion: bool) -> usize {
    if motion { motion_instance::SIZE } else { instance::SIZE }
}

/// Bytes of a built top-level acceleration structure with so many instances and these build flags.
#[must_use]
pub const fn tlas_size(instance_count: u32, flags: vk::BuildAccelerationStructureFlags) -> u64 {
    // Every instance has room for a reference, needed or not.
    ObjectHeader::SIZE + (8 + record_size(has_motion(flags.bits())) as u64) * instance_count as u64
}

impl TlasContents {
    /// The built form, [`tlas_size`] bytes, with a reference for each active instance.
    ///
    /// # Errors
    /// More than `u32::MAX` instances, or one with a field that has no room; see [`instance::encode`].
    pub fn encode(&self) -> Result<Vec<u8>, WriteError> {
        let Self { flags, instances } = self;
        encode(*flags, instances.iter().map(|instance| MotionInstanceData::StaticInstance(*instance)))
    }
}

impl MotionTlasContents {
    /// The built form, [`tlas_size`] bytes, with a reference for each active instance.
    ///
    /// # Errors
    /// As [`TlasContents::encode`].
    pub fn encode(&self) -> Result<Vec<u8>, WriteError> {
        let Self { flags, instances } = self;
        encode(flags | vk::BuildAccelerationStructureFlags::MOTION.bits(), instances.iter().copied())
    }
}

fn encode(flags: u32, instances: impl ExactSizeIterator<Item = MotionInstanceData>) -> Result<Vec<u8>, WriteError> {
    fits("instances", instances.len() as u64, u32::MAX.into())?;
    let count = instances.len() as u32;
    let motion = has_motion(flags);
    let (mut references, mut records) = (Vec::new(), Vec::with_capacity(instances.len() * record_size(motion)));
    for (index, instance) in instances.enumerate() {
        let within = |error: WriteError| error.within(format_args!("instances[{index}]"));
        let address = instance.acceleration_structure_reference();
        // No more references than instances, so the entry's number fits.
        let reference = if address == 0 { 0 } else { references.len() as u64 | ACTIVE };
        references.extend((address != 0).then_some(address));
        let instance = instance.with_reference(reference);
        if motion {
            records.extend_from_slice(&motion_instance::encode(&instance).map_err(within)?);
        } else {
            records.extend_from_slice(&motion_instance::encode_data(&instance).map_err(within)?);
        }
    }
    let unique = references.iter().collect::<BTreeSet<_>>().len();
    let header = ObjectHeader {
        kind: ObjectKind::TopLevel,
        form: ObjectForm::Built,
        size: tlas_size(count, vk::BuildAccelerationStructureFlags::from_bits_retain(flags)),
        compacted_size: ObjectHeader::SIZE + (8 * unique + records.len()) as u64,
        flags,
        reference_count: references.len() as u32,
        primitive_count: count.into(),
        geometry_count: 0,
    };
    let padding = vec![0; 8 * (count as usize - references.len())];
    let references: Vec<u8> = references.into_iter().flat_map(u64::to_le_bytes).collect();
    Ok([header.to_bytes().as_slice(), &references, &records, &padding].concat())
}

/// A built or compacted top-level acceleration structure, its structure proved.
#[derive(Clone, Copy, Debug)]
pub struct TlasObject<'a> {
    parts: Parts<'a>,
    /// Whole records only.
    records: &'a [u8],
}

impl<'a> TlasObject<'a> {
    /// Reads the top-level acceleration structure at the start of `bytes`, which may go on behind it.
    ///
    /// # Errors
    /// The first field that is not as it should be.
    pub fn read(bytes: &'a [u8]) -> Result<Self, ReadError> {
        let parts = Parts::read(bytes, ObjectKind::TopLevel)?;
        let header = parts.header;
        let (body, size) = (parts.body(), record_size(has_motion(header.flags)));
        let limit = (body.len() / size).min(u32::MAX as usize);
        let count = usize::try_from(header.primitive_count).ok().filter(|&count| count <= limit).ok_or_else(|| {
            let kind = ReadErrorKind::Above { found: header.primitive_count, limit: limit as u64 };
            ReadError::new("primitive_count", ObjectHeader::PRIMITIVE_COUNT_AT, kind)
        })?;
        let records = body.get(..count * size).unwrap_or_default();
        let object = Self { parts, records };
        for (index, record) in records.chunks_exact(size).enumerate() {
            let at = header.body_offset() + (index * size) as u64;
            let within = |error: ReadError| error.within(format_args!("instances[{index}]"));
            object.check_record(record, at).map_err(within)?;
        }
        object.parts.check_end(header.body_offset() + records.len() as u64)?;
        Ok(object)
    }

    fn check_record(&self, record: &[u8], at: u64) -> Result<(), ReadError> {
        let instance = self.stored(record).map_err(|error| error.moved_by(at))?;
        let end = self.reference_at(&instance) + 8;
        if self.has_motion() {
            bytes::zeros("flags", at + 4, record.get(4..motion_instance::HEADER).unwrap_or_default())?;
            bytes::zeros("reserved", at + end as u64, record.get(end..).unwrap_or_default())?;
        }
        let reference = instance.acceleration_structure_reference();
        let (entry, references) = (reference & (ACTIVE - 1), u64::from(self.parts.header.reference_count));
        let at = at + end as u64 - 8;
        match reference / ACTIVE {
            0 => bytes::equal("reference", at, entry, 0),
            1 if entry < references => Ok(()),
            1 => {
                let kind = ReadErrorKind::Above { found: entry, limit: references.saturating_sub(1) };
                Err(ReadError::new("reference", at, kind))
            }
            found => {
                let found = found.cast_signed();
                let kind = ReadErrorKind::Unknown { found, required: "0 (inactive) or 1 (active)" };
                Err(ReadError::new("active", at + 4, kind))
            }
        }
    }

    pub(in crate::object) const fn parts(&self) -> &Parts<'a> {
        &self.parts
    }

    /// The header.
    #[must_use]
    pub const fn header(&self) -> &ObjectHeader {
        &self.parts.header
    }

    /// The object's bytes.
    #[must_use]
    pub const fn as_bytes(&self) -> &'a [u8] {
        self.parts.bytes
    }

    /// Whether the structure was built with [`MOTION`](vk::BuildAccelerationStructureFlags::MOTION), so that its
    /// instances may move.
    #[must_use]
    pub const fn has_motion(&self) -> bool {
        has_motion(self.parts.header.flags)
    }

    const fn record_size(&self) -> usize {
        record_size(self.has_motion())
    }

    /// Number of instances, inactive ones included.
    #[must_use]
    pub const fn instance_count(&self) -> u32 {
        // Proved when the view was made.
        (self.records.len() / self.record_size()) as u32
    }

    /// The instance that a record holds, its reference as it is stored.
    fn stored(&self, record: &[u8]) -> Result<MotionInstanceData, ReadError> {
        if self.has_motion() {
            motion_instance::read(record)
        } else {
            instance::read(record).map(MotionInstanceData::StaticInstance)
        }
    }

    /// Bytes from the start of an instance's record to its reference.
    fn reference_at(&self, instance: &MotionInstanceData) -> usize {
        let header = if self.has_motion() { motion_instance::HEADER } else { 0 };
        header + motion_instance::data_size(instance.ty()).unwrap_or(8) - 8
    }

    /// The address that a stored reference stands for, if the instance is active.
    fn address(&self, instance: &MotionInstanceData) -> Option<&'a [u8; 8]> {
        let reference = instance.acceleration_structure_reference();
        let entry = (reference >= ACTIVE).then_some(reference & (ACTIVE - 1))?;
        self.parts.references.get(usize::try_from(entry).ok()?)
    }

    /// The instance that a record holds, with the device address in the place of the entry.
    fn decode(&self, record: &[u8]) -> MotionInstanceData {
        // Proved when the view was made.
        let instance = self.stored(record).unwrap_or_default();
        instance.with_reference(self.address(&instance).map_or(0, |address| u64::from_le_bytes(*address)))
    }

    /// One instance, if there are so many; its reference is a device address, or 0 if it is inactive. Without motion
    /// all of them are static.
    #[must_use]
    pub fn instance(&self, index: u32) -> Option<MotionInstanceData> {
        let record = self.records.chunks_exact(self.record_size()).nth(usize::try_from(index).ok()?);
        record.map(|record| self.decode(record))
    }

    /// All instances in order; see [`instance`](Self::instance).
    pub fn instances(&self) -> impl ExactSizeIterator<Item = MotionInstanceData> + Clone + 'a {
        let object = *self;
        self.records.chunks_exact(self.record_size()).map(move |record| object.decode(record))
    }

    /// Device addresses of the bottom-level structures, as the reference table lists them.
    pub fn references(&self) -> impl ExactSizeIterator<Item = u64> + Clone + 'a {
        self.parts.references.iter().map(|address| u64::from_le_bytes(*address))
    }

    /// The compacted form: every bottom-level structure once in the reference table, and no padding.
    #[must_use]
    pub fn compact(&self) -> Vec<u8> {
        if self.parts.header.form == ObjectForm::Compacted {
            return self.parts.bytes.to_vec();
        }
        let (mut known, mut table) = (HashMap::new(), Vec::new());
        let mut records = self.records.to_vec();
        for record in records.chunks_exact_mut(self.record_size()) {
            let Ok(instance) = self.stored(record) else { continue };
            let Some(address) = self.address(&instance) else { continue };
            let entry = *known.entry(address).or_insert_with(|| {
                table.extend_from_slice(address);
                (table.len() / 8) as u32 - 1
            });
            let at = self.reference_at(&instance);
            if let Some(slot) = record.get_mut(at..at + 4) {
                slot.copy_from_slice(&entry.to_le_bytes());
            }
        }
        let size = ObjectHeader::SIZE + (table.len() + records.len()) as u64;
        // No more references than there were, so the count fits.
        let reference_count = (table.len() / 8) as u32;
        let header = ObjectHeader {
            form: ObjectForm::Compacted,
            size,
            compacted_size: size,
            reference_count,
            ..self.parts.header
        };
        [header.to_bytes().as_slice(), &table, &records].concat()
    }
}
