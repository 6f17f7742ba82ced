//! Reading a bottom-level acceleration structure in place.

use omm_model::special_index::{OpacityMicromapSpecialIndex, TriangleMap};
use omm_model::vk;

use super::record::{Binding, GeometryRecord, INACTIVE, Layout};
use super::{GeometryKind, TriangleVertices};
use crate::bytes::{self, f32s};
use crate::error::{ReadError, ReadErrorKind};
use crate::object::Parts;
use crate::object::header::{ObjectForm, ObjectHeader, ObjectKind};

/// A built or compacted bottom-level acceleration structure, its structure proved.
#[derive(Clone, Copy, Debug)]
pub struct BlasObject<'a> {
    parts: Parts<'a>,
    records: &'a [[u8; GeometryRecord::SIZE]],
    data: &'a [u8],
}

/// One geometry of a [`BlasObject`].
#[derive(Clone, Copy, Debug)]
pub struct GeometryView<'a> {
    record: GeometryRecord,
    form: ObjectForm,
    micromap: Option<u64>,
    /// Whole primitive records only.
    data: &'a [u8],
}

/// An active triangle as it is stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredTriangle {
    /// Its index in the geometry, inactive triangles counted.
    pub primitive_index: u32,
    /// The vertices; those at time 0 if the geometry has motion.
    pub vertices: TriangleVertices,
    /// The vertices at time 1, if the geometry has motion.
    pub vertices_t1: Option<TriangleVertices>,
    /// The special index, or the triangle of the geometry's micromap; `None` if the geometry has no micromap, null or not.
    pub map: Option<TriangleMap>,
}

/// An active box as it is stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredAabb {
    /// Its index in the geometry, inactive boxes counted.
    pub primitive_index: u32,
    /// The box.
    pub positions: vk::AabbPositions,
}

impl<'a> BlasObject<'a> {
    /// Reads the bottom-level acceleration structure at the start of `bytes`, which may go on behind it.
    ///
    /// # Errors
    /// The first field that is not as it should be.
    pub fn read(bytes: &'a [u8]) -> Result<Self, ReadError> {
        let parts = Parts::read(bytes, ObjectKind::BottomLevel)?;
        let header = parts.header;
        let body = parts.body();
        let limit = body.len() / GeometryRecord::SIZE;
        let count = usize::try_from(header.geometry_count).ok().filter(|&count| count <= limit).ok_or_else(|| {
            let kind = ReadErrorKind::Above { found: header.geometry_count.into(), limit: limit as u64 };
            ReadError::new("geometry_count", ObjectHeader::GEOMETRY_COUNT_AT, kind)
        })?;
        // `count * SIZE` is at most the body's length.
        let (records, data) = body.split_at_checked(count * GeometryRecord::SIZE).unwrap_or_default();
        let object = Self { parts, records: records.as_chunks().0, data };
        let (mut used, mut primitive_count) = (0, 0_u64);
        for index in 0..count {
            let within = |error: ReadError| error.within(format_args!("geometries[{index}]"));
            let record = object.check_geometry(index, used).map_err(within)?;
            used += record.data_size();
            primitive_count += u64::from(record.count);
        }
        let found = header.primitive_count;
        bytes::equal("primitive_count", ObjectHeader::PRIMITIVE_COUNT_AT, found, primitive_count)?;
        object.parts.check_end(object.data_offset() + used)?;
        Ok(object)
    }

    /// Bytes from the start of the object to the first primitive record.
    fn data_offset(&self) -> u64 {
        self.parts.header.body_offset() + self.records.as_flattened().len() as u64
    }

    /// Proves one geometry, whose primitive records must begin at `offset` in the data.
    fn check_geometry(&self, index: usize, offset: u64) -> Result<GeometryRecord, ReadError> {
        let at = self.parts.header.body_offset() + (index * GeometryRecord::SIZE) as u64;
        let empty = [0; GeometryRecord::SIZE];
        let record = GeometryRecord::read(self.records.get(index).unwrap_or(&empty), at)?;
        let above = |field, offset, found, limit| {
            Err(ReadError::new(field, at + offset, ReadErrorKind::Above { found, limit }))
        };
        if let Binding::Reference(entry) = record.binding
            && entry >= self.parts.header.reference_count
        {
            let limit = u64::from(self.parts.header.reference_count).saturating_sub(1);
            return above("micromap", GeometryRecord::BINDING_AT, entry.into(), limit);
        }
        let (stored, count) = (u64::from(record.stored), u64::from(record.count));
        if self.parts.header.form == ObjectForm::Built {
            bytes::equal("stored_count", at + GeometryRecord::STORED_AT, stored, count)?;
        } else if stored > count {
            return above("stored_count", GeometryRecord::STORED_AT, stored, count);
        }
        bytes::equal("data_offset", at + GeometryRecord::OFFSET_AT, record.offset, offset)?;
        let (end, limit) = (offset.saturating_add(record.data_size()), self.data.len() as u64);
        if end > limit {
            return above("data_end", GeometryRecord::OFFSET_AT, end, limit);
        }
        let view = self.view(record);
        let data_offset = self.data_offset() + offset;
        match record.layout {
            Layout::Triangles => check_primitives(view.chunks::<40>(), &view, data_offset)?,
            Layout::MappedTriangles => check_primitives(view.chunks::<44>(), &view, data_offset)?,
            Layout::MovingTriangles => check_primitives(view.chunks::<76>(), &view, data_offset)?,
            Layout::MovingMappedTriangles => check_primitives(view.chunks::<80>(), &view, data_offset)?,
            Layout::Aabbs => check_primitives(view.chunks::<28>(), &view, data_offset)?,
        }
        Ok(record)
    }

    /// The view of a geometry whose record was proved.
    fn view(&self, record: GeometryRecord) -> GeometryView<'a> {
        let start = usize::try_from(record.offset).ok();
        let rest = start.and_then(|start| self.data.get(start..)).unwrap_or_default();
        let data = usize::try_from(record.data_size()).ok().and_then(|size| rest.get(..size)).unwrap_or_default();
        let micromap = match record.binding {
            Binding::None => None,
            Binding::Null => Some(0),
            Binding::Reference(entry) => {
                self.parts.references.get(entry as usize).map(|address| u64::from_le_bytes(*address))
            }
        };
        GeometryView { record, form: self.parts.header.form, micromap, data }
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

    /// Number of geometries.
    #[must_use]
    pub const fn geometry_count(&self) -> u32 {
        self.parts.header.geometry_count
    }

    /// One geometry, if there are so many.
    #[must_use]
    pub fn geometry(&self, index: u32) -> Option<GeometryView<'a>> {
        let record = self.records.get(usize::try_from(index).ok()?)?;
        GeometryRecord::read(record, 0).ok().map(|record| self.view(record))
    }

    /// All geometries in order.
    pub fn geometries(&self) -> impl Iterator<Item = GeometryView<'a>> + Clone {
        let object = *self;
        (0..self.parts.header.geometry_count).filter_map(move |index| object.geometry(index))
    }

    /// Device addresses of the micromaps, as the reference table lists them; 0 is null.
    pub fn references(&self) -> impl ExactSizeIterator<Item = u64> + Clone + 'a {
        self.parts.references.iter().map(|address| u64::from_le_bytes(*address))
    }

    /// The compacted form: no records of inactive primitives and no padding.
    #[must_use]
    pub fn compact(&self) -> Vec<u8> {
        if self.parts.header.form == ObjectForm::Compacted {
            return self.parts.bytes.to_vec();
        }
        let (mut records, mut data) = (Vec::new(), Vec::new());
        for view in self.geometries() {
            let (offset, stride) = (data.len() as u64, view.record.layout.stride());
            let active = view.data.chunks_exact(stride as usize).filter(|record| index(record) != INACTIVE);
            active.for_each(|record| data.extend_from_slice(record));
            // No more than there were, so the count fits.
            let stored = ((data.len() as u64 - offset) / stride) as u32;
            records.extend_from_slice(&GeometryRecord { stored, offset, ..view.record }.to_bytes());
        }
        let references = self.parts.references.as_flattened();
        let size = ObjectHeader::SIZE + (references.len() + records.len() + data.len()) as u64;
        let header = ObjectHeader { form: ObjectForm::Compacted, size, compacted_size: size, ..self.parts.header };
        [header.to_bytes().as_slice(), references, &records, &data].concat()
    }
}

/// The primitive's index at the start of its record.
fn index(record: &[u8]) -> u32 {
    record.first_chunk().map_or(INACTIVE, |bytes| u32::from_le_bytes(*bytes))
}

/// Proves the primitive records of one geometry, the first of which lies at `at`.
fn check_primitives<const N: usize>(records: &[[u8; N]], view: &GeometryView<'_>, at: u64) -> Result<(), ReadError> {
    let mut least = 0;
    for (position, (record, at)) in records.iter().zip((at..).step_by(N)).enumerate() {
        let check = || -> Result<u64, ReadError> {
            let found = u64::from(index(record));
            if view.form == ObjectForm::Built {
                if index(record) == INACTIVE {
                    bytes::zeros("payload", at + 4, record.get(4..).unwrap_or_default())?;
                    return Ok(least + 1);
                }
                bytes::equal("index", at, found, position as u64)?;
            } else if found < least {
                return Err(ReadError::new("index", at, ReadErrorKind::Below { found, least }));
            } else if found >= u64::from(view.record.count) {
                let limit = u64::from(view.record.count).saturating_sub(1);
                return Err(ReadError::new("index", at, ReadErrorKind::Above { found, limit }));
            }
            if view.record.layout.is_mapped() {
                let found = map_value(record);
                if triangle_map(found).is_none() {
                    let kind = ReadErrorKind::Unknown { found: found.into(), required: "-4 to -1 or an index" };
                    return Err(ReadError::new("map", at + 40, kind));
                }
            }
            Ok(found + 1)
        };
        least = check().map_err(|error| error.within(format_args!("primitives[{position}]")))?;
    }
    Ok(())
}

fn map_value(record: &[u8]) -> i32 {
    record.get(40..).and_then(<[u8]>::first_chunk).map_or(0, |bytes| i32::from_le_bytes(*bytes))
}

fn triangle_map(value: i32) -> Option<TriangleMap> {
    match u32::try_from(value) {
        Ok(index) => Some(TriangleMap::Triangle(index)),
        Err(_) => OpacityMicromapSpecialIndex::from_value(value).map(TriangleMap::SpecialIndex),
    }
}

impl<'a> GeometryView<'a> {
    fn chunks<const N: usize>(&self) -> &'a [[u8; N]] {
        self.data.as_chunks().0
    }

    /// What the geometry consists of.
    #[must_use]
    pub const fn kind(&self) -> GeometryKind {
        self.record.layout.kind()
    }

    /// The flags of the geometry.
    #[must_use]
    pub const fn flags(&self) -> vk::GeometryFlags {
        self.record.flags
    }

    /// Number of primitives, inactive ones included.
    ///
    /// In a compacted object inactive primitives take no bytes, so this is not bounded by the size of the object.
    #[must_use]
    pub const fn primitive_count(&self) -> u32 {
        self.record.count
    }

    /// Primitives that are stored: all of a built object, active ones of a compacted one.
    #[must_use]
    pub const fn stored_count(&self) -> u32 {
        self.record.stored
    }

    /// Device address of the micromap, 0 for a null one; `None` if the geometry has none.
    #[must_use]
    pub const fn micromap(&self) -> Option<u64> {
        self.micromap
    }

    /// Whether the triangles have vertices at time 1 too.
    #[must_use]
    pub const fn has_motion(&self) -> bool {
        self.record.layout.end_at().is_some()
    }

    /// The records of active primitives.
    fn active(&self) -> impl Iterator<Item = &'a [u8]> + Clone + 'a {
        self.data.chunks_exact(self.record.layout.stride() as usize).filter(|record| index(record) != INACTIVE)
    }

    /// The record of primitive `primitive_index`, if it is active.
    fn record(&self, primitive_index: u32) -> Option<&'a [u8]> {
        let stride = self.record.layout.stride() as usize;
        let record = |at: usize| self.data.get(at * stride..)?.get(..stride);
        let at = match self.form {
            ObjectForm::Built => {
                usize::try_from(primitive_index).ok().filter(|_| primitive_index < self.record.count)?
            }
            ObjectForm::Compacted => {
                let (mut low, mut high) = (0, self.record.stored as usize);
                while low < high {
                    let middle = low.midpoint(high);
                    if index(record(middle)?) < primitive_index {
                        low = middle + 1;
                    } else {
                        high = middle;
                    }
                }
                low
            }
        };
        record(at).filter(|record| index(record) == primitive_index)
    }

    fn stored_triangle(&self, record: &[u8]) -> StoredTriangle {
        let vertices = |start: usize| [0, 12, 24].map(|at| f32s(record.get(start + at..).unwrap_or_default()));
        let layout = self.record.layout;
        let map = layout.is_mapped().then(|| triangle_map(map_value(record))).flatten();
        StoredTriangle {
            primitive_index: index(record),
            vertices: vertices(4),
            vertices_t1: layout.end_at().map(vertices),
            map,
        }
    }

    /// The active triangles in order; nothing if the geometry consists of boxes.
    pub fn triangles(&self) -> impl Iterator<Item = StoredTriangle> + Clone + 'a {
        let view = *self;
        let records = (self.kind() == GeometryKind::Triangles).then(|| self.active());
        records.into_iter().flatten().map(move |record| view.stored_triangle(record))
    }

    /// The triangle of that index, if it is active.
    #[must_use]
    pub fn triangle(&self, primitive_index: u32) -> Option<StoredTriangle> {
        let record = self.record(primitive_index).filter(|_| self.kind() == GeometryKind::Triangles)?;
        Some(self.stored_triangle(record))
    }

    /// The active boxes in order; nothing if the geometry consists of triangles.
    pub fn aabbs(&self) -> impl Iterator<Item = StoredAabb> + Clone + 'a {
        let records = (self.kind() == GeometryKind::Aabbs).then(|| self.active());
        records.into_iter().flatten().map(stored_aabb)
    }

    /// The box of that index, if it is active.
    #[must_use]
    pub fn aabb(&self, primitive_index: u32) -> Option<StoredAabb> {
        self.record(primitive_index).filter(|_| self.kind() == GeometryKind::Aabbs).map(stored_aabb)
    }
}

fn stored_aabb(record: &[u8]) -> StoredAabb {
    let [min_x, min_y, min_z, max_x, max_y, max_z] = f32s(record.get(4..).unwrap_or_default());
    let positions = vk::AabbPositions { min_x, min_y, min_z, max_x, max_y, max_z };
    StoredAabb { primitive_index: index(record), positions }
}
