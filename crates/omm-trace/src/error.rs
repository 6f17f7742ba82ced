//! Why a scene cannot be loaded, and from where on.

use std::fmt;

use omm_layout::error::ReadError;
use omm_model::memory::MemoryError;
use omm_model::vk::DeviceAddress;

/// Memory that holds no scene: which object on the way from the top-level structure, and what is wrong with it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{at}: {kind}")]
pub struct LoadError {
    /// The object.
    pub at: ObjectPath,
    /// What is wrong with it.
    pub kind: LoadErrorKind,
}

/// What is wrong with an object.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LoadErrorKind {
    /// Its bytes cannot be read.
    #[error(transparent)]
    Memory(#[from] MemoryError),
    /// Its bytes are not an object of the kind that is wanted here; offsets count from the object's address.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// It lies in the same bytes as an object that was loaded before it.
    #[error("bytes {start:#x}..{end:#x} overlap those of the object at {other:#x}")]
    Overlap {
        /// The first address of this object.
        start: u64,
        /// The first address behind it.
        end: u64,
        /// The address of the other object.
        other: u64,
    },
    /// A primitive names a micromap triangle that its geometry's micromap does not have.
    #[error(
        "geometries[{geometry}].primitives[{primitive}]: found micromap triangle {found}, required less than {count}"
    )]
    MicromapTriangle {
        /// The geometry.
        geometry: u32,
        /// The primitive.
        primitive: u32,
        /// The micromap triangle that it names.
        found: u32,
        /// How many triangles the micromap has; none if it is null.
        count: u64,
    },
    /// It has more primitives or instances than a hierarchy can be built over.
    #[error("found {found} active primitives or instances, required less than 2^30")]
    TooMany {
        /// How many it has.
        found: u64,
    },
}

/// The way to an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ObjectPath {
    /// The top-level structure.
    pub tlas: DeviceAddress,
    /// The first instance that refers to the bottom-level structure, and that structure.
    pub blas: Option<(u32, DeviceAddress)>,
    /// The first geometry of it that refers to the micromap, and that micromap.
    pub micromap: Option<(u32, DeviceAddress)>,
}

impl fmt::Display for ObjectPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "tlas at {:#x}", self.tlas.0)?;
        if let Some((instance, address)) = self.blas {
            write!(f, " -> instances[{instance}] -> blas at {:#x}", address.0)?;
        }
        if let Some((geometry, address)) = self.micromap {
            write!(f, " -> geometries[{geometry}] -> micromap at {:#x}", address.0)?;
        }
        Ok(())
    }
}
