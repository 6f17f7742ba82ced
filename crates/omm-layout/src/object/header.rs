//! The first 64 bytes of every built object.

use crate::bytes::{self, Reader};
use crate::error::{ReadError, ReadErrorKind};

/// The first eight bytes of every built object; the last two are the version of the layout.
pub const MAGIC: [u8; 8] = *b"ommobj02";

/// What an object is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ObjectKind {
    /// 1: an opacity micromap.
    Micromap,
    /// 2: a bottom-level acceleration structure.
    BottomLevel,
    /// 3: a top-level acceleration structure.
    TopLevel,
}

impl ObjectKind {
    /// The value in the header: 1, 2 or 3. (0 is no kind, so that cleared memory is no object.)
    #[must_use]
    pub const fn value(self) -> u32 {
        match self {
            Self::Micromap => 1,
            Self::BottomLevel => 2,
            Self::TopLevel => 3,
        }
    }

    /// The kind of value `value`, if there is one.
    #[must_use]
    pub const fn from_value(value: u32) -> Option<Self> {
        match value {
            1 => Some(Self::Micromap),
            2 => Some(Self::BottomLevel),
            3 => Some(Self::TopLevel),
            _ => None,
        }
    }
}

/// How an object came to be, which decides how its body is laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ObjectForm {
    /// 0: written by a build. Its size follows from counts alone.
    Built,
    /// 1: written by a compacting copy. Nothing is stored that nobody reads.
    Compacted,
}

impl ObjectForm {
    /// The value in the header: 0 or 1.
    #[must_use]
    pub const fn value(self) -> u32 {
        match self {
            Self::Built => 0,
            Self::Compacted => 1,
        }
    }
}

/// The fields of the header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ObjectHeader {
    /// What the object is.
    pub kind: ObjectKind,
    /// How its body is laid out.
    pub form: ObjectForm,
    /// Bytes of the whole object, this header and any padding included: what the size query answers.
    pub size: u64,
    /// Bytes of the object's compacted form, at most `size`: what the compacted-size query answers.
    pub compacted_size: u64,
    /// The flags of the build, as the build command gave them.
    pub flags: u32,
    /// Entries of the reference table.
    pub reference_count: u32,
    /// Micromap triangles, primitives of all geometries, or instances; inactive ones included.
    pub primitive_count: u64,
    /// Geometries of a bottom-level structure; 0 in other kinds.
    pub geometry_count: u32,
}

impl ObjectHeader {
    /// Bytes of the header, and so the offset of the reference table.
    pub const SIZE: u64 = 64;

    pub(super) const KIND_AT: u64 = 8;
    pub(super) const SIZE_AT: u64 = 16;
    pub(super) const REFERENCE_COUNT_AT: u64 = 36;
    pub(super) const PRIMITIVE_COUNT_AT: u64 = 40;
    pub(super) const GEOMETRY_COUNT_AT: u64 = 48;

    /// Reads the header at the start of `bytes`. What follows it is not looked at.
    ///
    /// # Errors
    /// The first field that is truncated, has no meaning, or contradicts one before it.
    pub fn read(bytes: &[u8]) -> Result<Self, ReadError> {
        let mut input = Reader::new(bytes);
        let found = *input.array("magic")?;
        if found != MAGIC {
            return Err(ReadError::new("magic", 0, ReadErrorKind::Magic { found, required: MAGIC }));
        }
        let unknown = |field, offset, found: u32, required| {
            ReadError::new(field, offset, ReadErrorKind::Unknown { found: found.into(), required })
        };
        let kind = input.u32("kind")?;
        let kind = ObjectKind::from_value(kind).ok_or_else(|| unknown("kind", 8, kind, "1, 2 or 3"))?;
        let form = match input.u32("form")? {
            0 => ObjectForm::Built,
            1 => ObjectForm::Compacted,
            form => return Err(unknown("form", 12, form, "0 (built) or 1 (compacted)")),
        };
        let header = Self {
            kind,
            form,
            size: input.u64("size")?,
            compacted_size: input.u64("compacted_size")?,
            flags: input.u32("flags")?,
            reference_count: input.u32("reference_count")?,
            primitive_count: input.u64("primitive_count")?,
            geometry_count: input.u32("geometry_count")?,
        };
        input.reserved_u32("reserved0")?;
        let reserved = input.u64("reserved1")?;
        bytes::equal("reserved1", 56, reserved, 0)?;
        header.check()?;
        Ok(header)
    }

    /// What the fields require of each other.
    fn check(&self) -> Result<(), ReadError> {
        let least = self.body_offset();
        if self.size < least {
            return Err(ReadError::new("size", Self::SIZE_AT, ReadErrorKind::Below { found: self.size, least }));
        }
        match self.form {
            ObjectForm::Compacted => {
                bytes::equal("compacted_size", 24, self.compacted_size, self.size)?;
            }
            ObjectForm::Built if self.compacted_size > self.size => {
                let kind = ReadErrorKind::Above { found: self.compacted_size, limit: self.size };
                return Err(ReadError::new("compacted_size", 24, kind));
            }
            ObjectForm::Built => {}
        }
        if self.kind == ObjectKind::Micromap {
            bytes::equal("reference_count", Self::REFERENCE_COUNT_AT, self.reference_count.into(), 0)?;
        }
        if self.kind != ObjectKind::BottomLevel {
            bytes::equal("geometry_count", Self::GEOMETRY_COUNT_AT, self.geometry_count.into(), 0)?;
        }
        Ok(())
    }

    /// Bytes from the start of the object to its body: header and reference table.
    #[must_use]
    pub const fn body_offset(&self) -> u64 {
        // At most 64 + 8 * (2^32 - 1).
        Self::SIZE + 8 * self.reference_count as u64
    }

    /// The header's bytes.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; 64] {
        let Self { kind, form, size, compacted_size, flags, reference_count, primitive_count, geometry_count } = *self;
        let mut bytes = [0; 64];
        bytes[0..8].copy_from_slice(&MAGIC);
        bytes[8..12].copy_from_slice(&kind.value().to_le_bytes());
        bytes[12..16].copy_from_slice(&form.value().to_le_bytes());
        bytes[16..24].copy_from_slice(&size.to_le_bytes());
        bytes[24..32].copy_from_slice(&compacted_size.to_le_bytes());
        bytes[32..36].copy_from_slice(&flags.to_le_bytes());
        bytes[36..40].copy_from_slice(&reference_count.to_le_bytes());
        bytes[40..48].copy_from_slice(&primitive_count.to_le_bytes());
        bytes[48..52].copy_from_slice(&geometry_count.to_le_bytes());
        bytes
    }
}
