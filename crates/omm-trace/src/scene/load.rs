//! Reading a scene out of memory.

use std::collections::BTreeMap;
use std::ops::Range;

use omm_layout::object::{
    BlasObject, GeometryView, MicromapObject, ObjectHeader, StoredTriangle, TlasObject, TriangleVertices,
};
use omm_model::memory::MemoryView;
use omm_model::special_index::TriangleMap;
use omm_model::vk::{self, DeviceAddress, GeometryFlags};

use super::{Aabb, Blas, Geometry, Instance, Scene, Triangle};
use crate::bvh::{Bounds, Bvh, unit};
use crate::error::{LoadError, LoadErrorKind, ObjectPath};
use crate::opacity::{Micromap, TriangleOpacity};
use crate::placement::Placement;
use crate::transform::WorldToObject;
use crate::triangle::Packet;

/// Triangles in a leaf of a hierarchy, at most. A packet has room for no more. Boxes and parts of
/// instances are dearer to visit: they are alone.
const TRIANGLES_IN_LEAF: u32 = 4;

/// What was read so far.
struct Loader<'a> {
    view: &'a dyn MemoryView,
    scene: Scene,
    /// Positions in the scene, by address.
    blases: BTreeMap<u64, u32>,
    micromaps: BTreeMap<u64, u32>,
    /// The first address behind each object, by its first one. Objects may not overlap, or a few bytes could pass
    /// for many.
    ranges: BTreeMap<u64, u64>,
}

pub(super) fn load(view: &dyn MemoryView, tlas: DeviceAddress) -> Result<Scene, LoadError> {
    let mut loader = Loader {
        view,
        scene: Scene::default(),
        blases: BTreeMap::new(),
        micromaps: BTreeMap::new(),
        ranges: BTreeMap::new(),
    };
    let path = ObjectPath { tlas, blas: None, micromap: None };
    let at = |kind| LoadError { at: path, kind };
    let bytes = loader.read(tlas).map_err(at)?;
    let object = TlasObject::read(bytes).map_err(|error| at(error.into()))?;

    let mut instances = Vec::new();
    for (instance_id, instance) in (0..).zip(object.instances()) {
        let address = DeviceAddress(instance.acceleration_structure_reference());
        if address.is_null() {
            continue;
        }
        let blas = loader.blas(ObjectPath { blas: Some((instance_id, address)), ..path }, address)?;
        let placement = Placement::from(&instance);
        let to_object = if placement.moves() { None } else { WorldToObject::new(&placement.at(0.0)) };
        if to_object.is_none() && !placement.moves() {
            continue;
        }
        let Some(bounds) = loader.scene.blases.get(blas as usize).and_then(|blas| blas.bounds) else { continue };
        let rest = instance.at_rest();
        let reachable = Instance {
            to_object,
            blas,
            instance_id,
            custom_index: rest.instance_custom_index,
            sbt_record_offset: rest.instance_shader_binding_table_record_offset,
            mask: rest.mask,
            flags: rest.flags,
        };
        let bounds = placement.bounds(&bounds).filter(|_| placement.is_well_conditioned());
        instances.push((reachable, placement, bounds));
    }

    let mut scene = loader.scene;
    scene.slots = vec![u32::MAX; object.instance_count() as usize];
    scene.bounds = instances.iter().map(|(.., bounds)| *bounds).reduce(|a, b| Some(a?.union(b?))).flatten();
    for (slot, (instance, placement, _)) in (0..).zip(instances) {
        if let Some(known) = scene.slots.get_mut(instance.instance_id as usize) {
            *known = slot;
        }
        scene.instances.push(instance);
        scene.placements.push(placement);
    }
    scene.refer().map_err(at)?;
    Ok(scene)
}

impl<'a> Loader<'a> {
    /// The bytes of the object at `address`: as many as its header says.
    fn read(&mut self, address: DeviceAddress) -> Result<&'a [u8], LoadErrorKind> {
        let header = ObjectHeader::read(self.view.read(address, ObjectHeader::SIZE)?)?;
        let bytes = self.view.read(address, header.size)?;
        let (start, end) = (address.0, address.0.saturating_add(header.size));
        let before = self.ranges.range(..end).next_back();
        if let Some((&other, _)) = before.filter(|(_, other_end)| **other_end > start) {
            return Err(LoadErrorKind::Overlap { start, end, other });
        }
        self.ranges.insert(start, end);
        Ok(bytes)
    }

    /// The position in the scene of the bottom-level structure at `address`, to which `path` leads.
    fn blas(&mut self, path: ObjectPath, address: DeviceAddress) -> Result<u32, LoadError> {
        if let Some(&known) = self.blases.get(&address.0) {
            return Ok(known);
        }
        let at = |kind| LoadError { at: path, kind };
        let object = BlasObject::read(self.read(address).map_err(at)?).map_err(|error| at(error.into()))?;
        let (mut blas, mut triangles, mut aabbs, mut moves) = (Blas::default(), Vec::new(), Vec::new(), false);
        for (index, view) in (0..).zip(object.geometries()) {
            let micromap = match view.micromap().map(DeviceAddress) {
                None | Some(DeviceAddress::NULL) => None,
                Some(address) => Some(self.micromap(ObjectPath { micromap: Some((index, address)), ..path }, address)?),
            };
            blas.geometries.push(Geometry { opaque: view.flags().contains(GeometryFlags::OPAQUE), micromap });
            let micromap = micromap.and_then(|micromap| self.scene.micromaps.get(micromap as usize));
            for triangle in view.triangles() {
                triangles.extend(read_triangle(index, &triangle, micromap).map_err(at)?);
            }
            moves |= view.has_motion();
            aabbs.extend(read_aabbs(index, &view));
        }
        blas.fill(&triangles, &aabbs, moves).map_err(at)?;
        Ok(insert(&mut self.scene.blases, &mut self.blases, address, blas))
    }

    /// The position in the scene of the micromap at `address`, to which `path` leads.
    fn micromap(&mut self, path: ObjectPath, address: DeviceAddress) -> Result<u32, LoadError> {
        if let Some(&known) = self.micromaps.get(&address.0) {
            return Ok(known);
        }
        let at = |kind| LoadError { at: path, kind };
        let object = MicromapObject::read(self.read(address).map_err(at)?).map_err(|error| at(error.into()))?;
        Ok(insert(&mut self.scene.micromaps, &mut self.micromaps, address, Micromap::new(&object)))
    }
}

/// Adds an object to the scene. 2^32 of them would not fit into memory: each takes at least 64 bytes there, and
/// more here.
fn insert<T>(objects: &mut Vec<T>, known: &mut BTreeMap<u64, u32>, address: DeviceAddress, object: T) -> u32 {
    let index = objects.len() as u32;
    objects.push(object);
    known.insert(address.0, index);
    index
}

/// The triangle and its vertices at time 1, if rays can reach it.
fn read_triangle(
    geometry: u32,
    triangle: &StoredTriangle,
    micromap: Option<&Micromap>,
) -> Result<Option<(Triangle, TriangleVertices)>, LoadErrorKind> {
    let StoredTriangle { primitive_index: primitive, vertices, vertices_t1, map } = *triangle;
    let opacity = match map {
        None => TriangleOpacity::Geometry,
        Some(TriangleMap::SpecialIndex(index)) => TriangleOpacity::Whole(index.state()),
        Some(TriangleMap::Triangle(found)) => {
            let count = micromap.map_or(0, Micromap::triangle_count) as u64;
            if u64::from(found) >= count {
                return Err(LoadErrorKind::MicromapTriangle { geometry, primitive, found, count });
            }
            TriangleOpacity::Micromap(found)
        }
    };
    let end = vertices_t1.unwrap_or(vertices);
    let finite = vertices.iter().chain(&end).flatten().all(|x| x.is_finite());
    Ok(finite.then_some((Triangle { vertices, geometry, primitive, opacity }, end)))
}

/// The boxes of a geometry that rays can reach. Infinite ends are moved to the largest number.
fn read_aabbs(geometry: u32, view: &GeometryView<'_>) -> impl Iterator<Item = Aabb> {
    view.aabbs().filter_map(move |stored| {
        let vk::AabbPositions { min_x, min_y, min_z, max_x, max_y, max_z } = stored.positions;
        let finite = |corner: [f32; 3]| corner.map(|x| x.clamp(f32::MIN, f32::MAX));
        let (min, max) = (finite([min_x, min_y, min_z]), finite([max_x, max_y, max_z]));
        let proper = min.iter().zip(&max).all(|(min, max)| min <= max);
        let primitive = stored.primitive_index;
        proper.then_some(Aabb { min, max, planes: Default::default(), geometry, primitive })
    })
}

impl Blas {
    /// Takes the primitives in and builds hierarchies over them. Each triangle comes with its vertices at time 1, which
    /// are kept if it `moves`.
    fn fill(
        &mut self,
        triangles: &[(Triangle, TriangleVertices)],
        aabbs: &[Aabb],
        moves: bool,
    ) -> Result<(), LoadErrorKind> {
        let around =
            |corners: &mut dyn Iterator<Item = &[f32; 3]>| Bounds::around(corners.map(|corner| corner.map(f64::from)));
        // All of them are finite, so none is left out. What moves stays between its ends.
        let triangle_boxes: Vec<_> =
            triangles.iter().filter_map(|(start, end)| around(&mut start.vertices.iter().chain(end))).collect();
        let aabb_box = |aabb: &Aabb| around(&mut [aabb.min, aabb.max].iter());
        let aabb_boxes: Vec<_> = aabbs.iter().filter_map(aabb_box).collect();
        // One unit for both trees, so that a ray is made ready for both at once.
        let scale = unit(triangle_boxes.iter().chain(&aabb_boxes));
        let build = |boxes: &[Bounds], leaf| {
            Bvh::build(boxes, leaf, scale).ok_or(LoadErrorKind::TooMany { found: boxes.len() as u64 })
        };
        self.triangle_bvh = build(&triangle_boxes, TRIANGLES_IN_LEAF)?;
        for (triangle, end) in self.triangle_bvh.in_order(triangles) {
            self.triangles.push(triangle);
            self.ends.extend(moves.then_some(end));
        }
        let packet = |slots: Range<usize>| {
            self.triangles.get(slots).unwrap_or_default().iter().map(|triangle| &triangle.vertices)
        };
        let packets = self.triangle_bvh.leaves().map(|slots| Packet::new(packet(slots)));
        self.packets = packets.filter(|_| !moves).collect();
        self.largest = triangle_boxes.iter().fold(0.0, |largest, bounds| bounds.largest().max(largest));
        self.aabb_bvh = build(&aabb_boxes, 1)?;
        self.aabbs = self.aabb_bvh.in_order(aabbs);
        for aabb in &mut self.aabbs {
            if let Some(bounds) = aabb_box(aabb) {
                aabb.planes = self.aabb_bvh.planes_of(&bounds);
            }
        }
        self.bounds = triangle_boxes.into_iter().chain(aabb_boxes).reduce(Bounds::union);
        Ok(())
    }
}
