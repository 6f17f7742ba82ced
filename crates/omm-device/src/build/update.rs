//! Updates: a build into the destination, from a full description that may differ from the source only where it is allowed to.

use omm_layout::object::{BlasObject, Object, ObjectHeader};
use omm_model::call::Timeline;
use omm_model::vk;

use super::access::Access;
use crate::device::Device;
use crate::undefined::{At, Reason, Stop};

impl Device {
    /// Requires the source of an update to differ from `built`, which the update makes, in nothing but what may change.
    pub(crate) fn check_update(
        &self,
        info: &vk::BuildGeometryInfo,
        built: &[u8],
        timeline: Timeline,
        access: &mut Access,
    ) -> Result<(), Stop> {
        let (src, dst) = (info.src_acceleration_structure, info.dst_acceleration_structure);
        let at = "srcAccelerationStructure";
        let source = self.object(timeline, src).at(at)?;
        let address = self.range(src.into()).at(at)?.address;
        access.update(self.memory.place(address, source.header().size).at(at)?, src == dst);

        let (old, flags) = (*source.header(), info.flags.bits());
        if old.flags != flags || !info.flags.contains(vk::BuildAccelerationStructureFlags::ALLOW_UPDATE) {
            let required = flags | vk::BuildAccelerationStructureFlags::ALLOW_UPDATE.bits();
            return Err(Reason::Update { what: "flags", found: old.flags.into(), required: required.into() }).at(at);
        }
        // What was just built reads back.
        let update = Object::read(built)?;
        let required = update.header().kind;
        if old.kind != required {
            let (object, handle) = ("acceleration structure", src.0);
            return Err(Reason::WrongKind { object, handle, found: old.kind, required }).at(at);
        }
        same("primitives", old.primitive_count, update.header().primitive_count).at(at)?;
        match (source, update) {
            (Object::BottomLevel(source), Object::BottomLevel(update)) => {
                same_geometries(info, &source, &update).at(at)?;
                let free = vk::BuildAccelerationStructureFlags::ALLOW_OPACITY_MICROMAP_UPDATE
                    | vk::BuildAccelerationStructureFlags::ALLOW_OPACITY_MICROMAP_DATA_UPDATE;
                let free = info.flags.intersects(free);
                if free { Ok(()) } else { self.same_micromaps(&source, &update).at(at) }
            }
            (Object::TopLevel(source), Object::TopLevel(update)) => {
                let active =
                    |instance: vk::MotionInstanceData| u64::from(instance.acceleration_structure_reference() != 0);
                let pairs = source.instances().map(active).zip(update.instances().map(active));
                pairs.into_iter().try_for_each(|(old, new)| same("active instances", old, new)).at(at)
            }
            _ => Err(Reason::WrongCommand { what: "an update of a micromap" }).at("mode"),
        }
    }

    /// Requires every geometry to have the micromap that it had, or one that holds the same, as after a deserialization.
    fn same_micromaps(&self, source: &BlasObject<'_>, update: &BlasObject<'_>) -> Result<(), Reason> {
        for (old, new) in source.geometries().zip(update.geometries()) {
            let (old, new) = (old.micromap().unwrap_or_default(), new.micromap().unwrap_or_default());
            if old != new && self.micromap_at(old)? != self.micromap_at(new)? {
                return Err(Reason::Update { what: "the micromap at", found: old, required: new });
            }
        }
        Ok(())
    }

    /// What the micromap at an address holds, compacted; nothing if there is none.
    fn micromap_at(&self, address: u64) -> Result<Option<Vec<u8>>, Reason> {
        let header =
            self.memory.read(address, ObjectHeader::SIZE).ok().and_then(|bytes| ObjectHeader::read(bytes).ok());
        let Some(header) = header else {
            return Ok(None);
        };
        Ok(match Object::read(self.memory.read(address, header.size)?) {
            Ok(Object::Micromap(micromap)) => Some(micromap.compact()),
            _ => None,
        })
    }
}

fn same_geometries(
    info: &vk::BuildGeometryInfo,
    source: &BlasObject<'_>,
    update: &BlasObject<'_>,
) -> Result<(), Reason> {
    same("geometries", source.geometry_count().into(), update.geometry_count().into())?;
    for ((old, new), geometry) in source.geometries().zip(update.geometries()).zip(info.geometries_iter()) {
        same("a geometry type", old.kind() as u64, new.kind() as u64)?;
        same("geometry flags", old.flags().bits().into(), new.flags().bits().into())?;
        same("a primitive count", old.primitive_count().into(), new.primitive_count().into())?;
        let full = info.flags.contains(vk::BuildAccelerationStructureFlags::ALLOW_OPACITY_MICROMAP_UPDATE);
        let (was, is) = (attached(old.micromap()), attached(new.micromap()));
        // The KHR extension forbids to exchange a null micromap for another in any case.
        if !(full && is_ext(geometry) && was.min(is) > 0) {
            same("a micromap", was, is)?;
        }
        let boxes = old.aabbs().map(|aabb| aabb.primitive_index).eq(new.aabbs().map(|aabb| aabb.primitive_index));
        let triangles = old.triangles().map(|triangle| triangle.primitive_index);
        let triangles = triangles.eq(new.triangles().map(|triangle| triangle.primitive_index));
        let active = |boxes: usize, triangles: usize| (boxes + triangles) as u64;
        if !(boxes && triangles) {
            let found = active(old.aabbs().count(), old.triangles().count());
            let required = active(new.aabbs().count(), new.triangles().count());
            return Err(Reason::Update { what: "active primitives", found, required });
        }
    }
    Ok(())
}

/// Whether a geometry has a micromap object of the EXT extension, null or not.
fn is_ext(geometry: &vk::Geometry) -> bool {
    matches!(&geometry.geometry, vk::GeometryData::Triangles(found) if found.opacity_micromap_ext().is_some())
}

/// Whether a geometry has no micromap (0), a null one (1) or another (2).
fn attached(micromap: Option<u64>) -> u64 {
    micromap.map_or(0, |address| if address == 0 { 1 } else { 2 })
}

fn same(what: &'static str, found: u64, required: u64) -> Result<(), Reason> {
    if found == required { Ok(()) } else { Err(Reason::Update { what, found, required }) }
}
