//! Geometry records, 32 bytes each, and how long a primitive's record is.

use omm_model::vk;

use super::GeometryKind;
use crate::bytes::{u32_at, u64_at};
use crate::error::{ReadError, ReadErrorKind};

/// Stands where a primitive's index would: the primitive is inactive.
pub(super) const INACTIVE: u32 = u32::MAX;
/// Stands where an entry of the reference table would be named: the geometry has no micromap.
const NO_MICROMAP: u32 = u32::MAX;
/// Stands there too: the geometry has a null micromap.
const NULL_MICROMAP: u32 = u32::MAX - 1;

/// How the records of a geometry's primitives are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layout {
    /// u32 index, nine f32.
    Triangles,
    /// u32 index, nine f32, i32 map.
    MappedTriangles,
    /// u32 index, nine f32, nine f32 at time 1.
    MovingTriangles,
    /// u32 index, nine f32, i32 map, nine f32 at time 1.
    MovingMappedTriangles,
    /// u32 index, six f32.
    Aabbs,
}

impl Layout {
    /// Bytes of one record.
    pub(super) const fn stride(self) -> u64 {
        match self {
            Self::Triangles => 40,
            Self::MappedTriangles => 44,
            Self::MovingTriangles => 76,
            Self::MovingMappedTriangles => 80,
            Self::Aabbs => 28,
        }
    }

    pub(super) const fn kind(self) -> GeometryKind {
        match self {
            Self::Aabbs => GeometryKind::Aabbs,
            _ => GeometryKind::Triangles,
        }
    }

    /// That of triangles.
    pub(super) const fn of_triangles(micromap: bool, motion: bool) -> Self {
        match (micromap, motion) {
            (false, false) => Self::Triangles,
            (true, false) => Self::MappedTriangles,
            (false, true) => Self::MovingTriangles,
            (true, true) => Self::MovingMappedTriangles,
        }
    }

    /// Whether triangles have a map.
    pub(super) const fn is_mapped(self) -> bool {
        matches!(self, Self::MappedTriangles | Self::MovingMappedTriangles)
    }

    /// Bytes from the start of a record to the vertices at time 1, if there are any.
    pub(super) const fn end_at(self) -> Option<usize> {
        match self {
            Self::MovingTriangles => Some(40),
            Self::MovingMappedTriangles => Some(44),
            _ => None,
        }
    }
}

/// Which micromap a geometry has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Binding {
    /// None: the geometry flag decides.
    None,
    /// A null one: every entry is a special index.
    Null,
    /// The one at this entry of the reference table.
    Reference(u32),
}

impl Binding {
    /// The binding to the micromap at `address`, which gets an entry in `references` unless it is null.
    ///
    /// Entries are one for each geometry at most, so their number fits.
    pub(super) fn add(references: &mut Vec<u64>, address: u64) -> Self {
        if address == 0 {
            return Self::Null;
        }
        references.push(address);
        Self::Reference(references.len() as u32 - 1)
    }
}

/// The fields of a geometry record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct GeometryRecord {
    pub(super) layout: Layout,
    pub(super) flags: vk::GeometryFlags,
    /// Primitives, inactive ones included.
    pub(super) count: u32,
    /// Primitive records: all in a built object, those of active primitives in a compacted one.
    pub(super) stored: u32,
    pub(super) binding: Binding,
    /// Bytes from the end of the geometry records to the first primitive record.
    pub(super) offset: u64,
}

impl GeometryRecord {
    pub(super) const SIZE: usize = 32;
    pub(super) const STORED_AT: u64 = 12;
    pub(super) const BINDING_AT: u64 = 16;
    pub(super) const OFFSET_AT: u64 = 24;

    /// The record that 32 bytes hold, which lie at `at`.
    pub(super) fn read(bytes: &[u8; Self::SIZE], at: u64) -> Result<Self, ReadError> {
        let unknown = |field, offset, found: u32, required| {
            ReadError::new(field, at + offset, ReadErrorKind::Unknown { found: found.into(), required })
        };
        let binding = match u32_at::<16, { Self::SIZE }>(bytes) {
            NO_MICROMAP => Binding::None,
            NULL_MICROMAP => Binding::Null,
            entry => Binding::Reference(entry),
        };
        let motion = match u32_at::<20, { Self::SIZE }>(bytes) {
            0 => false,
            1 => true,
            found => return Err(unknown("motion", 20, found, "0 (none) or 1 (vertices at time 1)")),
        };
        let layout = match (u32_at::<0, { Self::SIZE }>(bytes), binding) {
            (0, Binding::None) if motion => Layout::MovingTriangles,
            (0, _) if motion => Layout::MovingMappedTriangles,
            (0, Binding::None) => Layout::Triangles,
            (0, _) => Layout::MappedTriangles,
            (1, _) if motion => return Err(unknown("motion", 20, 1, "0 (none), these being boxes")),
            (1, Binding::None) => Layout::Aabbs,
            (1, Binding::Null) => {
                return Err(unknown(
                    "micromap",
                    Self::BINDING_AT,
                    NULL_MICROMAP,
                    "no micromap (4294967295), these being boxes",
                ));
            }
            (1, Binding::Reference(entry)) => {
                return Err(unknown(
                    "micromap",
                    Self::BINDING_AT,
                    entry,
                    "no micromap (4294967295), these being boxes",
                ));
            }
            (found, _) => return Err(unknown("type", 0, found, "0 (triangles) or 1 (boxes)")),
        };
        Ok(Self {
            layout,
            flags: vk::GeometryFlags::from_bits_retain(u32_at::<4, { Self::SIZE }>(bytes)),
            count: u32_at::<8, { Self::SIZE }>(bytes),
            stored: u32_at::<12, { Self::SIZE }>(bytes),
            binding,
            offset: u64_at::<24, { Self::SIZE }>(bytes),
        })
    }

    pub(super) fn to_bytes(self) -> [u8; Self::SIZE] {
        let Self { layout, flags, count, stored, binding, offset } = self;
        let binding = match binding {
            Binding::None => NO_MICROMAP,
            Binding::Null => NULL_MICROMAP,
            Binding::Reference(entry) => entry,
        };
        let kind: u32 = match layout.kind() {
            GeometryKind::Triangles => 0,
            GeometryKind::Aabbs => 1,
        };
        let mut bytes = [0; Self::SIZE];
        bytes[0..4].copy_from_slice(&kind.to_le_bytes());
        bytes[4..8].copy_from_slice(&flags.bits().to_le_bytes());
        bytes[8..12].copy_from_slice(&count.to_le_bytes());
        bytes[12..16].copy_from_slice(&stored.to_le_bytes());
        bytes[16..20].copy_from_slice(&binding.to_le_bytes());
        bytes[20..24].copy_from_slice(&u32::from(layout.end_at().is_some()).to_le_bytes());
        bytes[24..32].copy_from_slice(&offset.to_le_bytes());
        bytes
    }

    /// Bytes of all primitive records.
    pub(super) fn data_size(self) -> u64 {
        self.layout.stride() * u64::from(self.stored)
    }
}
