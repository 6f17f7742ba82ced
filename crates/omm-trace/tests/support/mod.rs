//! Scenes written straight into a small memory, without a device.
#![allow(dead_code, reason = "each test binary uses a part of it")]

use std::collections::BTreeMap;
use std::path::PathBuf;

use omm_layout::object::{
    BlasContents, BlasGeometry, BlasPrimitives, MappedTriangle, MicromapContents, MicromapTriangleData,
    MotionTlasContents, TlasContents,
};
use omm_layout::packed;
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::memory::{MemoryError, MemoryView};
use omm_model::opacity::OpacityState;
use omm_model::special_index::{OpacityMicromapSpecialIndex, TriangleMap};
use omm_model::vk::{
    AabbPositions, DeviceAddress, GeometryFlags, GeometryInstanceFlags, Instance, MotionInstanceData, TransformMatrix,
};
use omm_trace::{Candidate, Counters, Hit, Ray, RayFlags, Scene, Shaders, TraceOptions};

pub(crate) type Vertices = [[f32; 3]; 3];

/// Objects, each at an address of its own.
#[derive(Clone, Debug, Default)]
pub(crate) struct Memory {
    pub(crate) objects: BTreeMap<u64, Vec<u8>>,
    next: u64,
}

impl MemoryView for Memory {
    fn read(&self, address: DeviceAddress, size: u64) -> Result<&[u8], MemoryError> {
        let object = self.objects.range(..=address.0).next_back();
        let rest = object.and_then(|(at, bytes)| bytes.get((address.0 - at) as usize..)).unwrap_or_default();
        let error = MemoryError { address: address.0, size, available: rest.len() as u64 };
        usize::try_from(size).ok().and_then(|size| rest.get(..size)).ok_or(error)
    }
}

impl Memory {
    pub(crate) fn add(&mut self, bytes: Vec<u8>) -> u64 {
        let address = 0x1000 + self.next;
        self.next += (bytes.len() as u64).next_multiple_of(256) + 256;
        self.objects.insert(address, bytes);
        address
    }

    /// A micromap with these triangles, each a level and its states.
    pub(crate) fn micromap(&mut self, triangles: &[(u32, OpacityMicromapFormat, Vec<OpacityState>)]) -> u64 {
        let data: Vec<_> = triangles.iter().map(|(_, format, states)| packed::pack(*format, states).unwrap()).collect();
        let triangles = triangles.iter().zip(&data).map(|((level, format, _), data)| MicromapTriangleData {
            subdivision_level: SubdivisionLevel::new(*level).unwrap(),
            format: *format,
            data,
        });
        self.add(MicromapContents { flags: 0, triangles: triangles.collect() }.encode().unwrap())
    }

    pub(crate) fn blas(&mut self, geometries: Vec<BlasGeometry>) -> u64 {
        self.add(BlasContents { flags: 0, geometries }.encode().unwrap())
    }

    pub(crate) fn tlas(&mut self, instances: Vec<Instance>) -> DeviceAddress {
        DeviceAddress(self.add(TlasContents { flags: 0, instances }.encode().unwrap()))
    }

    /// The scene of these instances, which may move.
    pub(crate) fn motion_scene(mut self, instances: Vec<MotionInstanceData>) -> Scene {
        let tlas = self.add(MotionTlasContents { flags: 0, instances }.encode().unwrap());
        Scene::load(&self, DeviceAddress(tlas)).unwrap()
    }

    /// The scene of these instances.
    pub(crate) fn scene(mut self, instances: Vec<Instance>) -> Scene {
        let tlas = self.tlas(instances);
        Scene::load(&self, tlas).unwrap()
    }
}

fn geometry(flags: GeometryFlags, primitives: BlasPrimitives) -> BlasGeometry {
    BlasGeometry { flags, primitives }
}

pub(crate) fn triangles(flags: GeometryFlags, triangles: impl IntoIterator<Item = Vertices>) -> BlasGeometry {
    geometry(flags, BlasPrimitives::Triangles(triangles.into_iter().map(Some).collect()))
}

pub(crate) fn mapped(flags: GeometryFlags, micromap: u64, triangles: &[(Vertices, TriangleMap)]) -> BlasGeometry {
    let triangle = |&(vertices, map): &(Vertices, TriangleMap)| Some(MappedTriangle { vertices, map });
    let triangles = triangles.iter().map(triangle).collect();
    geometry(flags, BlasPrimitives::MicromapTriangles { micromap, triangles })
}

pub(crate) fn aabbs(flags: GeometryFlags, boxes: &[[[f32; 3]; 2]]) -> BlasGeometry {
    let positions = |&[[min_x, min_y, min_z], [max_x, max_y, max_z]]: &[[f32; 3]; 2]| {
        Some(AabbPositions { min_x, min_y, min_z, max_x, max_y, max_z })
    };
    geometry(flags, BlasPrimitives::Aabbs(boxes.iter().map(positions).collect()))
}

/// An instance visible to every ray, at the origin.
pub(crate) fn instance(blas: u64) -> Instance {
    Instance {
        transform: TransformMatrix::IDENTITY,
        mask: 0xff,
        acceleration_structure_reference: blas,
        ..Instance::default()
    }
}

pub(crate) fn with_flags(blas: u64, flags: GeometryInstanceFlags) -> Instance {
    Instance { flags, ..instance(blas) }
}

pub(crate) fn with_transform(blas: u64, matrix: [[f32; 4]; 3]) -> Instance {
    Instance { transform: TransformMatrix { matrix }, ..instance(blas) }
}

/// One instance of one geometry.
pub(crate) fn scene_of(geometry: BlasGeometry) -> Scene {
    let mut memory = Memory::default();
    let blas = memory.blas(vec![geometry]);
    memory.scene(vec![instance(blas)])
}

/// The triangle (0, 0), (1, 0), (0, 1) at height z: barycentrics are x and y, and its front is up.
pub(crate) fn unit_triangle(z: f32) -> Vertices {
    [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]]
}

/// The unit triangle at a height.
pub(crate) fn plain(z: f32) -> BlasGeometry {
    triangles(GeometryFlags::empty(), [unit_triangle(z)])
}

/// Triangles at heights 0, -1, … with these states for the whole of each.
pub(crate) fn stack(states: &[OpacityState]) -> Scene {
    let special = |state| TriangleMap::SpecialIndex(OpacityMicromapSpecialIndex::of_state(state));
    let list: Vec<_> =
        (0_u8..).zip(states).map(|(at, &state)| (unit_triangle(-f32::from(at)), special(state))).collect();
    scene_of(mapped(GeometryFlags::empty(), 0, &list))
}

/// The ray down to (x, y) from a height of 1, which takes t = 1 to a height of 0.
pub(crate) fn down(x: f32, y: f32) -> Ray {
    Ray::unbounded([x, y, 1.0], [0.0, 0.0, -1.0]).unwrap()
}

/// Any-hit shaders that write down what they see.
#[derive(Debug, Default)]
pub(crate) struct Record {
    pub(crate) seen: Vec<Candidate>,
}

impl Shaders for Record {
    fn any_hit(&mut self, candidate: &Candidate) -> omm_trace::AnyHit {
        self.seen.push(*candidate);
        omm_trace::AnyHit::Accept
    }
}

pub(crate) fn trace(scene: &Scene, ray: &Ray, flags: RayFlags) -> (Option<Hit>, Counters, Record) {
    let (mut record, mut counters) = (Record::default(), Counters::default());
    let hit = scene.trace(ray, &TraceOptions::from(flags), &mut record, &mut counters);
    assert_eq!(
        counters.candidates,
        counters.ignored + counters.culled() + counters.opaque + counters.any_hit_calls,
        "every candidate ends in one way"
    );
    assert_eq!(counters.any_hit_calls as usize, record.seen.len());
    assert_eq!((counters.rays, counters.hits), (1, u64::from(hit.is_some())));
    (hit, counters, record)
}

pub(crate) fn closest(scene: &Scene, ray: &Ray) -> Option<Hit> {
    trace(scene, ray, RayFlags::empty()).0
}

/// A file of the golden data; says so and answers `None` where there is none.
#[allow(clippy::print_stderr)]
pub(crate) fn golden(name: &str) -> Option<Vec<u8>> {
    let folder = std::env::var_os("OMM_GOLDEN")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/golden"), PathBuf::from);
    match std::fs::read(folder.join(name)) {
        Ok(bytes) => Some(bytes),
        Err(error) => {
            eprintln!("skipped: golden data absent ({name}: {error})");
            None
        }
    }
}
