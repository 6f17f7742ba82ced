//! Commands that trace rays. Which rays they trace is not told, so what they do is to reach everything that a ray could reach.

use std::collections::BTreeSet;

use omm_layout::object::{BlasObject, GeometryKind, MicromapObject, Object, ObjectHeader, ObjectKind};
use omm_model::memory::{MemoryError, MemoryView};
use omm_model::special_index::TriangleMap;
use omm_model::vk;

use crate::device::Device;
use crate::undefined::{At, Reason, Stop};

/// The memory of a device as rays see it: what lies at the addresses of acceleration structures and micromaps that exist.
///
/// Bytes outlive the structure that they were built for, but nothing may be traced through a structure that was destroyed.
#[derive(Clone, Copy, Debug)]
pub struct StructureMemory<'d> {
    device: &'d Device,
}

impl MemoryView for StructureMemory<'_> {
    fn read(&self, address: vk::DeviceAddress, size: u64) -> Result<&[u8], MemoryError> {
        match self.device.check_address(address.0) {
            Ok(()) => self.device.read(address, size),
            Err(_) => Err(MemoryError { address: address.0, size, available: 0 }),
        }
    }
}

impl Device {
    /// The memory that rays can read, to trace what the device built.
    #[must_use]
    pub const fn structure_memory(&self) -> StructureMemory<'_> {
        StructureMemory { device: self }
    }

    /// `vkCmdTraceRaysKHR` and `vkCmdDispatch` against the structure at an address. `mixed` says whether geometries may mix
    /// special indices with others.
    pub(crate) fn trace(&self, top_level: vk::DeviceAddress, mixed: bool) -> Result<(), Stop> {
        let Object::TopLevel(top) = self.built(top_level.0, ObjectKind::TopLevel).at("topLevel")? else {
            return Ok(());
        };
        let instances = top.instances().map(|instance| instance.acceleration_structure_reference());
        for address in instances.filter(|&address| address != 0).collect::<BTreeSet<_>>() {
            if let Object::BottomLevel(bottom) = self.built(address, ObjectKind::BottomLevel).at("topLevel")? {
                self.reach(&bottom, address, mixed).at("topLevel")?;
            }
        }
        Ok(())
    }

    fn reach(&self, bottom: &BlasObject<'_>, address: u64, mixed: bool) -> Result<(), Reason> {
        for (index, geometry) in (0..).zip(bottom.geometries()) {
            if geometry.kind() != GeometryKind::Triangles {
                continue;
            }
            let micromap = match geometry.micromap() {
                None | Some(0) => None,
                Some(address) => match self.built(address, ObjectKind::Micromap)? {
                    Object::Micromap(micromap) => Some(micromap),
                    _ => None,
                },
            };
            let (mut special, mut other) = (false, false);
            for map in geometry.triangles().filter_map(|triangle| triangle.map) {
                match map {
                    TriangleMap::SpecialIndex(_) => special = true,
                    TriangleMap::Triangle(index) => {
                        other = true;
                        in_micromap(micromap.as_ref(), index)?;
                    }
                }
            }
            if special && other && !mixed {
                return Err(Reason::MixedSpecialIndices { address, geometry: index });
            }
        }
        Ok(())
    }

    /// What was built at the address of a structure.
    fn built(&self, address: u64, required: ObjectKind) -> Result<Object<'_>, Reason> {
        self.check_address(address)?;
        let header = ObjectHeader::read(self.memory.read(address, ObjectHeader::SIZE)?)?;
        let object = Object::read(self.memory.read(address, header.size)?)?;
        let found = object.header().kind;
        if found == required {
            Ok(object)
        } else {
            Err(Reason::WrongKind { object: "address", handle: address, found, required })
        }
    }
}

/// Requires a micromap to have a triangle. It may have been built anew, with fewer, since it was attached.
fn in_micromap(micromap: Option<&MicromapObject<'_>>, index: u32) -> Result<(), Reason> {
    let Some(micromap) = micromap else {
        return Err(Reason::NoMicromap { index });
    };
    let count = micromap.triangle_count();
    if index < count { Ok(()) } else { Err(Reason::NoMicromapTriangle { index, base_triangle: 0, count }) }
}
