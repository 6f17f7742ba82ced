//! Built top-level acceleration structures: instances.

use std::collections::HashMap;

use omm_model::vk;

use super::Parts;
use super::header::{ObjectForm, ObjectHeader, ObjectKind};
use crate::bytes::{self, u32_at};
use crate::error::{ReadError, ReadErrorKind, WriteError, fits};
use crate::instance;

/// Bytes of an instance record.
const RECORD: usize = 64;

/// What a top-level acceleration structure holds, as a build collects it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TlasContents {
    /// The flags of the build.
    pub flags: u32,
    /// The instances in order, which refer to bottom-level structures by device address; 0 makes an instance inactive.
    pub instances: Vec<vk::Instance>,
}

/// Bytes of a built top-level acceleration structure with so many instances.
#[must_use]
pub const fn tlas_size(instance_count: u32) -> u64 {
    // Every instance has room for a reference, needed or not.
    ObjectHeader::SIZE + (8 + RECORD as u64) * instance_count as u64
}

impl TlasContents {
    /// The built form, [`tlas_size`] bytes, with a reference for each active instance.
    ///
    /// # Errors
    /// More than `u32::MAX` instances, or one with a field that has no room; see [`instance::encode`].
    pub fn encode(&self) -> Result<Vec<u8>, WriteError> {
        let Self { flags, instances } = self;
        fits("instances", instances.len() as u64, u32::MAX.into())?;
        let (mut references, mut records) = (Vec::new(), Vec::with_capacity(instances.len() * RECORD));
        for (index, instance) in instances.iter().enumerate() {
            let within = |error: WriteError| error.within(format_args!("instances[{index}]"));
            let address = instance.acceleration_structure_reference;
            // No more references than instances, so the entry's number fits.
            let entry = (address != 0).then_some(references.len() as u32);
            references.extend(entry.map(|_| address));
            records.extend_from_slice(&record(instance, entry).map_err(within)?);
        }
        let unique = references.iter().collect::<std::collections::BTreeSet<_>>().len();
        let size = tlas_size(instances.len() as u32);
        let header = ObjectHeader {
            kind: ObjectKind::TopLevel,
            form: ObjectForm::Built,
            size,
            compacted_size: ObjectHeader::SIZE + (8 * unique + records.len()) as u64,
            flags: *flags,
            reference_count: references.len() as u32,
            primitive_count: instances.len() as u64,
            geometry_count: 0,
        };
        let padding = vec![0; 8 * (instances.len() - references.len())];
        let references: Vec<u8> = references.into_iter().flat_map(u64::to_le_bytes).collect();
        Ok([header.to_bytes().as_slice(), &references, &records, &padding].concat())
    }
}

/// An instance's record: as in an instance buffer, but for the reference.
fn record(instance: &vk::Instance, entry: Option<u32>) -> Result<[u8; RECORD], WriteError> {
    let reference = entry.map_or(0, |entry| u64::from(entry) | 1 << 32);
    instance::encode(&vk::Instance { acceleration_structure_reference: reference, ..*instance })
}

/// A built or compacted top-level acceleration structure, its structure proved.
#[derive(Clone, Copy, Debug)]
pub struct TlasObject<'a> {
    parts: Parts<'a>,
    records: &'a [[u8; RECORD]],
}

impl<'a> TlasObject<'a> {
    /// Reads the top-level acceleration structure at the start of `bytes`, which may go on behind it.
    ///
    /// # Errors
    /// The first field that is not as it should be.
    pub fn read(bytes: &'a [u8]) -> Result<Self, ReadError> {
        let parts = Parts::read(bytes, ObjectKind::TopLevel)?;
        let header = parts.header;
        let body = parts.body();
        let limit = (body.len() / RECORD).min(u32::MAX as usize);
        let count = usize::try_from(header.primitive_count).ok().filter(|&count| count <= limit).ok_or_else(|| {
            let kind = ReadErrorKind::Above { found: header.primitive_count, limit: limit as u64 };
            ReadError::new("primitive_count", ObjectHeader::PRIMITIVE_COUNT_AT, kind)
        })?;
        let records = body.as_chunks().0.get(..count).unwrap_or_default();
        let object = Self { parts, records };
        for (index, record) in records.iter().enumerate() {
            let at = header.body_offset() + (index * RECORD) as u64;
            let within = |error: ReadError| error.within(format_args!("instances[{index}]"));
            object.check_record(record, at).map_err(within)?;
        }
        object.parts.check_end(header.body_offset() + (count * RECORD) as u64)?;
        Ok(object)
    }

    fn check_record(&self, record: &[u8; RECORD], at: u64) -> Result<(), ReadError> {
        let (entry, references) = (u32_at::<56, RECORD>(record), self.parts.header.reference_count);
        match u32_at::<60, RECORD>(record) {
            0 => bytes::equal("reference", at + 56, entry.into(), 0),
            1 if entry < references => Ok(()),
            1 => {
                let kind = ReadErrorKind::Above { found: entry.into(), limit: u64::from(references).saturating_sub(1) };
                Err(ReadError::new("reference", at + 56, kind))
            }
            found => {
                let kind = ReadErrorKind::Unknown { found: found.into(), required: "0 (inactive) or 1 (active)" };
                Err(ReadError::new("active", at + 60, kind))
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

    /// Number of instances, inactive ones included.
    #[must_use]
    pub const fn instance_count(&self) -> u32 {
        // Proved when the view was made.
        self.records.len() as u32
    }

    /// The entry of the reference table that a record names, if the instance is active.
    fn entry(record: &[u8; RECORD]) -> Option<u32> {
        (u32_at::<60, RECORD>(record) == 1).then_some(u32_at::<56, RECORD>(record))
    }

    /// The instance that a record holds, with the device address in the place of the entry.
    fn decode(&self, record: &[u8; RECORD]) -> vk::Instance {
        let address = Self::entry(record).and_then(|entry| self.parts.references.get(entry as usize));
        let acceleration_structure_reference = address.map_or(0, |address| u64::from_le_bytes(*address));
        vk::Instance { acceleration_structure_reference, ..instance::decode(record) }
    }

    /// One instance, if there are so many; its reference is a device address, or 0 if it is inactive.
    #[must_use]
    pub fn instance(&self, index: u32) -> Option<vk::Instance> {
        self.records.get(usize::try_from(index).ok()?).map(|record| self.decode(record))
    }

    /// All instances in order; see [`instance`](Self::instance).
    pub fn instances(&self) -> impl ExactSizeIterator<Item = vk::Instance> + Clone + 'a {
        let object = *self;
        self.records.iter().map(move |record| object.decode(record))
    }

    /// Device addresses of the bottom-level structures, as the reference table lists them.
    pub fn references(&self) -> impl ExactSizeIterator<Item = u64> + Clone + 'a {
        self.parts.references.iter().map(|address| u64::from_le_bytes(*address))
    }

    /// What the structure holds.
    #[must_use]
    pub fn contents(&self) -> TlasContents {
        TlasContents { flags: self.parts.header.flags, instances: self.instances().collect() }
    }

    /// The compacted form: every bottom-level structure once in the reference table, and no padding.
    #[must_use]
    pub fn compact(&self) -> Vec<u8> {
        if self.parts.header.form == ObjectForm::Compacted {
            return self.parts.bytes.to_vec();
        }
        let (mut known, mut table) = (HashMap::new(), Vec::new());
        let mut records = self.records.to_vec();
        for record in &mut records {
            let Some(address) = Self::entry(record).and_then(|entry| self.parts.references.get(entry as usize)) else {
                continue;
            };
            let entry = *known.entry(address).or_insert_with(|| {
                table.extend_from_slice(address);
                (table.len() / 8) as u32 - 1
            });
            record[56..60].copy_from_slice(&entry.to_le_bytes());
        }
        let size = ObjectHeader::SIZE + (table.len() + records.as_flattened().len()) as u64;
        // No more references than there were, so the count fits.
        let reference_count = (table.len() / 8) as u32;
        let header = ObjectHeader {
            form: ObjectForm::Compacted,
            size,
            compacted_size: size,
            reference_count,
            ..self.parts.header
        };
        [header.to_bytes().as_slice(), &table, records.as_flattened()].concat()
    }
}
