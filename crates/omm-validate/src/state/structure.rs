//! Acceleration structures and what they hold.

use std::sync::Arc;

use omm_model::vk;

use super::{State, command_buffer};

/// Where an acceleration structure lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// In a range of a buffer.
    Buffer {
        /// The buffer.
        buffer: vk::Buffer,
        /// Offset of the first byte.
        offset: u64,
        /// Bytes.
        size: u64,
    },
    /// In a range of addresses.
    AddressRange(vk::DeviceAddressRange),
}

/// An acceleration structure, a KHR micromap included.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct AccelerationStructureState {
    /// The type that it was created for.
    pub ty: vk::AccelerationStructureType,
    /// How it was made.
    pub create_flags: vk::AccelerationStructureCreateFlags,
    /// What was said about its memory; `None` if it was made in a buffer, by `vkCreateAccelerationStructureKHR`.
    pub address_flags: Option<vk::AddressCommandFlags>,
    /// Where it lies.
    pub storage: Storage,
    /// The address by which others refer to it, once it was asked for.
    pub address: Option<vk::DeviceAddress>,
    /// What submitted work and host commands left in it; `None` if it was not constructed.
    pub contents: Option<Contents>,
}

impl AccelerationStructureState {
    /// How its contents were built, as far as that is known.
    #[must_use]
    pub fn built(&self) -> Option<&Built> {
        self.contents.as_ref()?.built.as_deref()
    }

    /// Whether it was constructed: built, or filled with a constructed or deserialized structure.
    #[must_use]
    pub const fn is_constructed(&self) -> bool {
        self.contents.is_some()
    }
}

/// What an acceleration structure holds.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Contents {
    /// The original build, in build mode, behind them, through updates, copies and serialization; `None` if it was not seen.
    pub built: Option<Arc<Built>>,
    /// Set if they were deserialized, also if they were copied or updated since.
    pub deserialized: Option<Deserialized>,
    /// The micromap of each geometry as the last build or update attached it.
    pub attachments: Arc<[Attachment]>,
    /// Whether they were updated since they were built or deserialized.
    pub updated: bool,
    /// Bytes that they take when serialized, once the program was told.
    pub serialization_size: Option<u64>,
    /// Bytes that they take when compacted, once the program was told.
    pub compacted_size: Option<u64>,
    /// Differs for all contents.
    pub(super) number: u64,
}

/// Where deserialized data came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Deserialized {
    /// The handle of the object that was serialized, if the data still lies where it was serialized to. The object may have been
    /// destroyed since.
    pub origin: Option<u64>,
    /// Where the data was when it was deserialized.
    pub address: vk::DeviceOrHostAddress,
}

/// A micromap attached to a geometry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Attachment {
    /// The geometry has no micromap structure.
    #[default]
    None,
    /// A KHR micromap, or null.
    Khr(vk::AccelerationStructure),
    /// A micromap object of the EXT extension, or null.
    Ext(vk::Micromap),
}

impl Attachment {
    /// What is attached to a geometry: the first micromap structure of its chain.
    #[must_use]
    pub fn of(geometry: &vk::Geometry) -> Self {
        let vk::GeometryData::Triangles(triangles) = &geometry.geometry else { return Self::None };
        if geometry.geometry_type != vk::GeometryType::TRIANGLES {
            return Self::None;
        }
        let attached = triangles.next.iter().find_map(|structure| match structure {
            vk::ChainStructure::TrianglesOpacityMicromap(found) => Some(Self::Khr(found.micromap)),
            vk::ChainStructure::TrianglesOpacityMicromapExt(found) => Some(Self::Ext(found.micromap)),
            _ => None,
        });
        attached.unwrap_or_default()
    }
}

/// How the contents of an acceleration structure were built.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Built {
    /// What was built.
    pub ty: vk::AccelerationStructureType,
    /// The flags of the build.
    pub flags: vk::BuildAccelerationStructureFlags,
    /// For a micromap: its usage counts.
    pub usage_counts: Vec<vk::MicromapUsage>,
    /// For other structures: how many primitives each geometry has, as far as the call says so.
    pub primitive_counts: Vec<u32>,
    /// The geometries.
    pub geometries: Vec<BuiltGeometry>,
}

/// What is kept of a geometry that was built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct BuiltGeometry {
    /// Its type.
    pub ty: vk::GeometryType,
    /// Its flags.
    pub flags: vk::GeometryFlags,
    /// The micromap attached to it.
    pub attachment: Attachment,
}

impl Built {
    pub(super) fn new(info: &vk::BuildGeometryInfo, ranges: &[vk::BuildRangeInfo]) -> Self {
        let usages =
            info.geometries_iter().filter_map(vk::Geometry::micromap_data).flat_map(vk::GeometryMicromapData::usages);
        let geometry =
            |it: &vk::Geometry| BuiltGeometry { ty: it.geometry_type, flags: it.flags, attachment: Attachment::of(it) };
        Self {
            ty: info.ty,
            flags: info.flags,
            usage_counts: usages.copied().collect(),
            primitive_counts: ranges.iter().map(|range| range.primitive_count).collect(),
            geometries: info.geometries_iter().map(geometry).collect(),
        }
    }

    /// How many triangles a micromap has; `None` if this is not a micromap.
    #[must_use]
    pub fn micromap_triangles(&self) -> Option<u64> {
        let sum = || self.usage_counts.iter().fold(0, |sum: u64, usage| sum.saturating_add(usage.count.into()));
        (self.ty == vk::AccelerationStructureType::OPACITY_MICROMAP).then(sum)
    }
}

impl State {
    /// The addresses at which an acceleration structure lies, if they are known.
    #[must_use]
    pub fn address_range(&self, handle: vk::AccelerationStructure) -> Option<vk::DeviceAddressRange> {
        match self.acceleration_structure(handle)?.storage {
            Storage::AddressRange(range) => Some(range),
            Storage::Buffer { buffer, offset, size } => {
                let address = self.buffer(buffer)?.address?.checked_add(offset)?;
                Some(vk::DeviceAddressRange { address, size })
            }
        }
    }

    /// The acceleration structure that has that address: the one for which the address was told, else one whose range of
    /// addresses begins there.
    #[must_use]
    pub fn acceleration_structure_at(&self, address: vk::DeviceAddress) -> Option<vk::AccelerationStructure> {
        let begins = |storage: Storage| matches!(storage, Storage::AddressRange(range) if range.address == address);
        let structures = || self.acceleration_structures.iter();
        let told = structures().find(|(_, structure)| structure.address == Some(address));
        let found = told.or_else(|| structures().find(|(_, structure)| begins(structure.storage)));
        found.map(|(handle, _)| *handle)
    }

    /// How an acceleration structure will have been built when a command recorded next into `command_buffer` executes: by what
    /// the command buffer holds already, otherwise by what was submitted.
    #[must_use]
    pub fn built(&self, command_buffer: vk::CommandBuffer, handle: vk::AccelerationStructure) -> Option<&Built> {
        let recorded = self
            .command_buffer(command_buffer)
            .map_or(command_buffer::Recorded::Elsewhere(handle), |buffer| buffer.contents(handle));
        match recorded {
            command_buffer::Recorded::Built(built) => Some(built),
            command_buffer::Recorded::Unknown => None,
            command_buffer::Recorded::Elsewhere(source) => self.acceleration_structure(source)?.built(),
        }
    }
}
