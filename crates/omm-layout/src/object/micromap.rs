//! Built micromaps: triangle records and packed opacity.

use std::collections::HashMap;

use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;
use omm_model::triangle::MicromapTriangle;
use omm_model::usage::{self, MicromapUsage};

use super::Parts;
use super::header::{ObjectForm, ObjectHeader, ObjectKind};
use crate::bytes::{self, u16_at, u32_at, u64_at};
use crate::error::{ReadError, ReadErrorKind, WriteError, WriteErrorKind};
use crate::packed;

/// Bytes of a triangle record.
const RECORD: usize = 16;
/// In a built micromap each triangle's data begins at a multiple of this, counted from the start of the data section.
const ALIGNMENT: u64 = 8;

/// What a micromap holds, as a build collects it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MicromapContents<'a> {
    /// The flags of the build.
    pub flags: u32,
    /// The triangles in order.
    pub triangles: Vec<MicromapTriangleData<'a>>,
}

/// One triangle of a micromap and its packed elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MicromapTriangleData<'a> {
    /// Level of subdivision.
    pub subdivision_level: SubdivisionLevel,
    /// Format of the elements.
    pub format: OpacityMicromapFormat,
    /// The elements, exactly [`OpacityMicromapFormat::data_size`] bytes.
    pub data: &'a [u8],
}

impl MicromapTriangleData<'_> {
    /// The state of one microtriangle, if the level has so many.
    #[must_use]
    pub fn state(&self, microtriangle: u32) -> Option<OpacityState> {
        (microtriangle < self.subdivision_level.microtriangles())
            .then(|| self.format.state(self.data, microtriangle.into()))
            .flatten()
    }
}

/// Bytes of a built micromap with these usage counts; `None` if it would not fit into 64 bits.
#[must_use]
pub fn micromap_size<'a>(usages: impl IntoIterator<Item = &'a MicromapUsage>) -> Option<u64> {
    usages.into_iter().try_fold(ObjectHeader::SIZE, |size, usage| {
        let data = u64::from(usage.format.data_size(usage.subdivision_level)).next_multiple_of(ALIGNMENT);
        size.checked_add((RECORD as u64 + data).checked_mul(usage.count.into())?)
    })
}

impl MicromapContents<'_> {
    /// The built form, [`micromap_size`] bytes. Bits of a triangle's last byte that belong to no element become 0.
    ///
    /// # Errors
    /// Data of the wrong size for its level and format; more than `u32::MAX` triangles.
    pub fn encode(&self) -> Result<Vec<u8>, WriteError> {
        let Self { flags, triangles } = self;
        crate::error::fits("triangles", triangles.len() as u64, u32::MAX.into())?;
        let padded = |triangle: &MicromapTriangleData<'_>| triangle.data.len().next_multiple_of(ALIGNMENT as usize);
        let mut records = Vec::with_capacity(triangles.len() * RECORD);
        let mut data = Vec::with_capacity(triangles.iter().map(padded).sum());
        let mut offsets = Vec::with_capacity(triangles.len());
        for (index, triangle) in triangles.iter().enumerate() {
            let (found, required) =
                (triangle.data.len() as u64, triangle.format.data_size(triangle.subdivision_level).into());
            if found != required {
                let field = format!("triangles[{index}].data");
                return Err(WriteError::new(field, WriteErrorKind::NotEqual { found, required }));
            }
            offsets.push(data.len());
            push_record(&mut records, data.len() as u64, triangle);
            push_block(&mut data, triangle);
            data.resize(data.len().next_multiple_of(ALIGNMENT as usize), 0);
        }
        // Blocks are compared as they were written, with unused bits cleared.
        let written = triangles.iter().zip(offsets).map(|(triangle, offset)| MicromapTriangleData {
            data: data.get(offset..offset + triangle.data.len()).unwrap_or_default(),
            ..*triangle
        });
        let (_, blocks) = merge(written);
        let header = ObjectHeader {
            kind: ObjectKind::Micromap,
            form: ObjectForm::Built,
            size: ObjectHeader::SIZE + (records.len() + data.len()) as u64,
            compacted_size: compacted_size(triangles.len(), &blocks),
            flags: *flags,
            reference_count: 0,
            primitive_count: triangles.len() as u64,
            geometry_count: 0,
        };
        Ok([header.to_bytes().as_slice(), &records, &data].concat())
    }
}

/// The offset of each triangle's data once equal blocks are stored once, and these blocks in the order of their offsets.
fn merge<'a>(triangles: impl Iterator<Item = MicromapTriangleData<'a>>) -> (Vec<u64>, Vec<&'a [u8]>) {
    let (mut known, mut blocks, mut end) = (HashMap::new(), Vec::new(), 0);
    let offsets = triangles.map(|triangle| {
        *known.entry(triangle).or_insert_with(|| {
            let offset = end;
            end += triangle.data.len() as u64;
            blocks.push(triangle.data);
            offset
        })
    });
    (offsets.collect(), blocks)
}

/// Bytes of a compacted micromap with so many triangles and these blocks.
fn compacted_size(triangles: usize, blocks: &[&[u8]]) -> u64 {
    ObjectHeader::SIZE + (triangles * RECORD + blocks.iter().map(|block| block.len()).sum::<usize>()) as u64
}

fn push_record(records: &mut Vec<u8>, offset: u64, triangle: &MicromapTriangleData<'_>) {
    records.extend_from_slice(&offset.to_le_bytes());
    // A level is at most 12.
    records.extend_from_slice(&(triangle.subdivision_level.get() as u16).to_le_bytes());
    records.extend_from_slice(&triangle.format.value().to_le_bytes());
    records.extend_from_slice(&[0; 4]);
}

fn push_block(data: &mut Vec<u8>, triangle: &MicromapTriangleData<'_>) {
    data.extend_from_slice(triangle.data);
    if let Some(last) = data.last_mut().filter(|_| !triangle.data.is_empty()) {
        *last &= packed::last_byte_mask(triangle.format, triangle.subdivision_level);
    }
}

/// A built or compacted micromap, its structure proved.
#[derive(Clone, Copy, Debug)]
pub struct MicromapObject<'a> {
    parts: Parts<'a>,
    records: &'a [[u8; RECORD]],
    data: &'a [u8],
}

impl<'a> MicromapObject<'a> {
    /// Reads the micromap at the start of `bytes`, which may go on behind it.
    ///
    /// # Errors
    /// The first field that is not as it should be.
    pub fn read(bytes: &'a [u8]) -> Result<Self, ReadError> {
        let parts = Parts::read(bytes, ObjectKind::Micromap)?;
        let header = parts.header;
        let body = parts.body();
        let limit = (body.len() / RECORD).min(u32::MAX as usize);
        let count = usize::try_from(header.primitive_count).ok().filter(|&count| count <= limit).ok_or_else(|| {
            let kind = ReadErrorKind::Above { found: header.primitive_count, limit: limit as u64 };
            ReadError::new("primitive_count", ObjectHeader::PRIMITIVE_COUNT_AT, kind)
        })?;
        // `count * RECORD` is at most the body's length.
        let (records, data) = body.split_at_checked(count * RECORD).unwrap_or_default();
        let object = Self { parts, records: records.as_chunks().0, data };
        let used = object.check_records()?;
        object.parts.check_end(ObjectHeader::SIZE + (count * RECORD) as u64 + used)?;
        Ok(object)
    }

    /// Proves every record and says how many bytes of the data section they use.
    fn check_records(&self) -> Result<u64, ReadError> {
        let mut end = 0;
        for (index, record) in self.records.iter().enumerate() {
            let at = ObjectHeader::SIZE + (index * RECORD) as u64;
            self.check_record(record, at, &mut end)
                .map_err(|error| error.within(format_args!("triangles[{index}]")))?;
        }
        Ok(end)
    }

    fn check_record(&self, record: &[u8; RECORD], at: u64, end: &mut u64) -> Result<(), ReadError> {
        let offset = u64_at::<0, RECORD>(record);
        let level = u16_at::<8, RECORD>(record);
        let level = SubdivisionLevel::try_from(level).map_err(|_| {
            let limit = SubdivisionLevel::MAX.get().into();
            ReadError::new("subdivision_level", at + 8, ReadErrorKind::Above { found: level.into(), limit })
        })?;
        let format = u16_at::<10, RECORD>(record);
        let format = OpacityMicromapFormat::from_value(format.into()).ok_or_else(|| {
            let kind = ReadErrorKind::Unknown { found: format.into(), required: "1 (2-state) or 2 (4-state)" };
            ReadError::new("format", at + 10, kind)
        })?;
        bytes::equal("reserved", at + 12, u32_at::<12, RECORD>(record).into(), 0)?;

        self.check_block(format, level, offset, at, end)
    }

    /// Proves that a block begins where the form of the object allows, and moves `end` behind it if it is a new one.
    ///
    /// In a built micromap every block follows the one before it; in a compacted one it may also lie among those before it. So
    /// blocks are never longer, taken together, than the object's bytes.
    fn check_block(
        &self,
        format: OpacityMicromapFormat,
        level: SubdivisionLevel,
        offset: u64,
        at: u64,
        end: &mut u64,
    ) -> Result<(), ReadError> {
        let size = u64::from(format.data_size(level));
        let above = |field, found, limit| Err(ReadError::new(field, at, ReadErrorKind::Above { found, limit }));
        let known = offset < *end && self.parts.header.form == ObjectForm::Compacted;
        if !known {
            bytes::equal("data_offset", at, offset, *end)?;
        }
        let (stop, limit) = (offset.saturating_add(size), self.data.len() as u64);
        if known && stop > *end {
            return above("data_end", stop, *end);
        }
        if stop > limit {
            return above("data_end", stop, limit);
        }
        // The block's end is at most `data.len()`, so the conversions below lose nothing.
        let data_at = ObjectHeader::SIZE + self.records.as_flattened().len() as u64;
        let last = self.data.get((stop - 1) as usize).copied().unwrap_or_default();
        let unused = last & !packed::last_byte_mask(format, level);
        bytes::equal("unused_bits", data_at + stop - 1, unused.into(), 0)?;
        *end = stop.max(*end);
        if self.parts.header.form == ObjectForm::Built {
            *end = stop.next_multiple_of(ALIGNMENT);
            let padding = self.data.get(stop as usize..(*end).min(limit) as usize).unwrap_or_default();
            bytes::zeros("data_padding", data_at + stop, padding)?;
        }
        Ok(())
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

    /// Number of triangles.
    #[must_use]
    pub const fn triangle_count(&self) -> u32 {
        // Proved when the view was made.
        self.records.len() as u32
    }

    /// One triangle, if there are so many.
    #[must_use]
    pub fn triangle(&self, index: u32) -> Option<MicromapTriangleData<'a>> {
        let record = self.records.get(usize::try_from(index).ok()?)?;
        let subdivision_level = SubdivisionLevel::try_from(u16_at::<8, RECORD>(record)).ok()?;
        let format = OpacityMicromapFormat::from_value(u16_at::<10, RECORD>(record).into())?;
        let data = self.data.get(usize::try_from(u64_at::<0, RECORD>(record)).ok()?..)?;
        let data = data.get(..usize::try_from(format.data_size(subdivision_level)).ok()?)?;
        Some(MicromapTriangleData { subdivision_level, format, data })
    }

    /// All triangles in order.
    pub fn triangles(&self) -> impl ExactSizeIterator<Item = MicromapTriangleData<'a>> + Clone {
        let object = *self;
        let empty = MicromapTriangleData {
            subdivision_level: SubdivisionLevel::ZERO,
            format: OpacityMicromapFormat::TwoState,
            data: &[],
        };
        // Every record was proved, so the default is never taken.
        (0..self.records.len()).map(move |index| object.triangle(index as u32).unwrap_or(empty))
    }

    /// The state of a microtriangle of a triangle, if there is such a one.
    #[must_use]
    pub fn state(&self, triangle: u32, microtriangle: u32) -> Option<OpacityState> {
        self.triangle(triangle)?.state(microtriangle)
    }

    /// How many triangles there are of each level and format.
    #[must_use]
    pub fn usage(&self) -> Vec<MicromapUsage> {
        usage::histogram(self.triangles().map(|triangle| MicromapTriangle {
            data_offset: 0,
            subdivision_level: triangle.subdivision_level,
            format: triangle.format,
        }))
    }

    /// What the micromap holds.
    #[must_use]
    pub fn contents(&self) -> MicromapContents<'a> {
        MicromapContents { flags: self.parts.header.flags, triangles: self.triangles().collect() }
    }

    /// The compacted form: blocks without gaps, those of equal level, format and bytes stored once.
    #[must_use]
    pub fn compact(&self) -> Vec<u8> {
        if self.parts.header.form == ObjectForm::Compacted {
            return self.parts.bytes.to_vec();
        }
        let (offsets, blocks) = merge(self.triangles());
        let mut records = Vec::with_capacity(offsets.len() * RECORD);
        for (offset, triangle) in offsets.into_iter().zip(self.triangles()) {
            push_record(&mut records, offset, &triangle);
        }
        let size = compacted_size(self.records.len(), &blocks);
        let header = ObjectHeader { form: ObjectForm::Compacted, size, compacted_size: size, ..self.parts.header };
        let mut bytes = [header.to_bytes().as_slice(), &records].concat();
        blocks.into_iter().for_each(|block| bytes.extend_from_slice(block));
        bytes
    }
}
