//! The simulated device's packed form of built objects, specified byte by byte in `docs/device-layout.md`.
//!
//! A micromap, a bottom-level and a top-level acceleration structure lie in device memory as one run of bytes each:
//!
//! | part | bytes |
//! |---|---|
//! | header | 64: [`ObjectHeader`] |
//! | reference table | 8 each: device addresses of the micromaps or bottom-level structures that the object refers to |
//! | body | records, then the data they point to |
//! | padding | zeros up to the size that the build sizes promised; none in a compacted object |
//!
//! All numbers are little-endian. Each kind has a contents structure that is written ([`MicromapContents`], [`BlasContents`],
//! [`TlasContents`] or [`MotionTlasContents`]) and a view that is read without copying ([`MicromapObject`], [`BlasObject`], [`TlasObject`]). A view proves
//! the structure when it is made — every size, count, offset, level and index in range, everything reserved zero — so that what
//! comes after it needs no further checks.

use crate::error::{ReadError, ReadErrorKind};

mod blas;
mod describe;
mod header;
mod micromap;
mod references;
mod tlas;

pub use blas::{
    BlasContents, BlasGeometry, BlasGeometrySize, BlasObject, BlasPrimitives, GeometryKind, GeometryView,
    MappedTriangle, MovingMappedTriangle, MovingVertices, StoredAabb, StoredTriangle, TriangleVertices, blas_size,
};
pub use describe::Field;
pub use header::{MAGIC, ObjectForm, ObjectHeader, ObjectKind};
pub use micromap::{MicromapContents, MicromapObject, MicromapTriangleData, micromap_size};
pub use references::{references, replace_references};
pub use tlas::{MotionTlasContents, TlasContents, TlasObject, tlas_size};

/// A built object of whichever kind, its structure proved.
#[derive(Clone, Copy, Debug)]
pub enum Object<'a> {
    /// A micromap.
    Micromap(MicromapObject<'a>),
    /// A bottom-level acceleration structure.
    BottomLevel(BlasObject<'a>),
    /// A top-level acceleration structure.
    TopLevel(TlasObject<'a>),
}

impl<'a> Object<'a> {
    /// Reads the object at the start of `bytes`, which may go on behind it.
    ///
    /// # Errors
    /// The first field that is not as `docs/device-layout.md` wants it.
    pub fn read(bytes: &'a [u8]) -> Result<Self, ReadError> {
        Ok(match ObjectHeader::read(bytes)?.kind {
            ObjectKind::Micromap => Self::Micromap(MicromapObject::read(bytes)?),
            ObjectKind::BottomLevel => Self::BottomLevel(BlasObject::read(bytes)?),
            ObjectKind::TopLevel => Self::TopLevel(TlasObject::read(bytes)?),
        })
    }

    /// The header.
    #[must_use]
    pub const fn header(&self) -> &ObjectHeader {
        match self {
            Self::Micromap(object) => object.header(),
            Self::BottomLevel(object) => object.header(),
            Self::TopLevel(object) => object.header(),
        }
    }

    /// The object's bytes, from its header to the end of its padding.
    #[must_use]
    pub const fn as_bytes(&self) -> &'a [u8] {
        match self {
            Self::Micromap(object) => object.as_bytes(),
            Self::BottomLevel(object) => object.as_bytes(),
            Self::TopLevel(object) => object.as_bytes(),
        }
    }

    /// The device addresses in the reference table.
    pub fn references(&self) -> impl ExactSizeIterator<Item = u64> + Clone + use<'a> {
        let table = match self {
            Self::Micromap(_) => &[][..],
            Self::BottomLevel(object) => object.parts().references,
            Self::TopLevel(object) => object.parts().references,
        };
        table.iter().map(|address| u64::from_le_bytes(*address))
    }

    /// The compacted form: as long as [`ObjectHeader::compacted_size`] said, and the same object if this one is compacted.
    #[must_use]
    pub fn compact(&self) -> Vec<u8> {
        match self {
            Self::Micromap(object) => object.compact(),
            Self::BottomLevel(object) => object.compact(),
            Self::TopLevel(object) => object.compact(),
        }
    }
}

/// The compacted form of the object at the start of `bytes`; see [`Object::compact`].
///
/// # Errors
/// As [`Object::read`].
pub fn compact(bytes: &[u8]) -> Result<Vec<u8>, ReadError> {
    Object::read(bytes).map(|object| object.compact())
}

/// What all kinds have in common.
#[derive(Clone, Copy, Debug)]
struct Parts<'a> {
    header: ObjectHeader,
    /// The whole object.
    bytes: &'a [u8],
    /// The reference table.
    references: &'a [[u8; 8]],
}

impl<'a> Parts<'a> {
    /// Cuts an object of `kind` off `bytes`.
    fn read(bytes: &'a [u8], kind: ObjectKind) -> Result<Self, ReadError> {
        let header = ObjectHeader::read(bytes)?;
        let (found, required) = (header.kind.value(), kind.value());
        crate::bytes::equal("kind", ObjectHeader::KIND_AT, found.into(), required.into())?;
        let (bytes, references) = references::split(&header, bytes)?;
        Ok(Self { header, bytes, references })
    }

    /// What follows the reference table.
    fn body(&self) -> &'a [u8] {
        let start = usize::try_from(self.header.body_offset()).ok();
        start.and_then(|start| self.bytes.get(start..)).unwrap_or_default()
    }

    /// Requires the object to end after `used` bytes if it is compacted, and to go on with zeros if it is built.
    fn check_end(&self, used: u64) -> Result<(), ReadError> {
        let size = self.header.size;
        let error = |kind| Err(ReadError::new("size", ObjectHeader::SIZE_AT, kind));
        match self.header.form {
            _ if size < used => error(ReadErrorKind::Below { found: size, least: used }),
            ObjectForm::Compacted if size > used => error(ReadErrorKind::Above { found: size, limit: used }),
            ObjectForm::Compacted => Ok(()),
            ObjectForm::Built => {
                let padding = usize::try_from(used).ok().and_then(|used| self.bytes.get(used..));
                crate::bytes::zeros("padding", used, padding.unwrap_or_default())
            }
        }
    }
}

#[cfg(test)]
mod tests;
