//! Inputs to begin with, made of our own output.

use std::path::Path;

use omm_layout::object::{BlasContents, BlasGeometry, BlasPrimitives, MappedTriangle, MicromapContents};
use omm_layout::object::{MicromapTriangleData, MotionTlasContents, TlasContents};
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::profile::Uuid;
use omm_model::special_index::TriangleMap;
use omm_model::triangle::MicromapTriangle;
use omm_model::usage::histogram;
use omm_model::vk;
use omm_scenario::{Library, Scenario, record};
use omm_serialize::bundle::{BundleData, MicromapData, Source};
use omm_serialize::{Block, ByteOrder, Header, References, serialize_object};

/// How many scenarios are seeds.
const SCENARIOS: usize = 40;

/// Serialized objects of every kind, built and compacted; headers in both byte orders.
#[must_use]
pub fn blobs() -> Vec<Vec<u8>> {
    let mut seeds = vec![Vec::new()];
    for object in objects() {
        let compacted = omm_layout::object::compact(&object).unwrap_or_default();
        for object in [object, compacted] {
            seeds.extend(serialize_object(&object, Uuid([1; 16]), Uuid([2; 16])));
        }
    }
    let blocks = [(0, vec![1, 2]), (7, vec![]), (0, vec![3])];
    let block = |(block_type, addresses)| Block { block_type, reserved: 5, addresses };
    for references in [References::Handles(vec![8, 9]), References::Blocks(blocks.map(block).to_vec())] {
        let header = Header::for_payload(Uuid([3; 16]), Uuid([4; 16]), 99, references, 4);
        seeds.extend([ByteOrder::Little, ByteOrder::Big].map(|order| header.write(order, b"body")));
    }
    seeds
}

/// The same behind a byte that cuts them into pieces.
#[must_use]
pub fn blobs_in_pieces() -> Vec<Vec<u8>> {
    blobs().iter().map(|seed| [&[6], seed.as_slice()].concat()).collect()
}

/// Bundles of nothing and of two micromaps.
#[must_use]
pub fn bundles() -> Vec<Vec<u8>> {
    vec![BundleData::default().write(), BundleData { micromaps: vec![micromap(), MicromapData::default()] }.write()]
}

/// The scenarios of `spec-tests` that are shortest, as many as tests have time for.
#[must_use]
pub fn scenarios() -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../spec-tests");
    let Ok(library) = Library::read(&folder) else { return Vec::new() };
    let mut seeds: Vec<_> = library.iter().map(|(_, scenario)| scenario.text().as_bytes().to_vec()).collect();
    seeds.sort_by_key(Vec::len);
    seeds.truncate(SCENARIOS);
    seeds
}

/// What those scenarios do, in both forms.
#[must_use]
pub fn traces() -> Vec<Vec<u8>> {
    let mut seeds = Vec::new();
    for text in scenarios().iter().filter_map(|text| std::str::from_utf8(text).ok()).step_by(4) {
        if let Ok((_, trace)) = Scenario::parse("seed.ron", text).and_then(|scenario| record(&scenario)) {
            seeds.push(trace.write());
            seeds.extend(trace.to_text().map(String::into_bytes));
        }
    }
    seeds
}

/// Bytes without a meaning of their own, for targets that make choices of them.
#[must_use]
pub fn numbers() -> Vec<Vec<u8>> {
    let mut state = 1_u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    };
    [0, 1, 8, 40, 200, 1000].iter().map(|&length| (0..length).map(|_| next()).collect()).collect()
}

fn objects() -> Vec<Vec<u8>> {
    let triangle = MicromapTriangleData {
        subdivision_level: SubdivisionLevel::ZERO,
        format: OpacityMicromapFormat::FourState,
        data: &[2],
    };
    let leaf = MicromapContents { flags: 2, triangles: vec![triangle; 2] }.encode();
    let mapped = MappedTriangle { vertices: [[0.5; 3]; 3], map: TriangleMap::Triangle(1) };
    let geometry = |primitives| BlasGeometry { flags: vk::GeometryFlags::OPAQUE, primitives };
    let geometries = vec![
        geometry(BlasPrimitives::MicromapTriangles { micromap: 0x100, triangles: vec![None, Some(mapped)] }),
        geometry(BlasPrimitives::MicromapTriangles { micromap: 0, triangles: vec![] }),
        geometry(BlasPrimitives::Triangles(vec![Some([[1.0; 3]; 3])])),
        geometry(BlasPrimitives::Aabbs(vec![None])),
        geometry(BlasPrimitives::MovingTriangles(vec![Some([[[1.0; 3]; 3], [[2.0; 3]; 3]])])),
    ];
    let card = BlasContents { flags: 2, geometries }.encode();
    let instance =
        |acceleration_structure_reference| vk::Instance { acceleration_structure_reference, ..vk::Instance::default() };
    let scene = TlasContents { flags: 2, instances: [7, 0, 7].map(instance).to_vec() }.encode();
    let moving = vk::SrtMotionInstance { acceleration_structure_reference: 7, ..vk::SrtMotionInstance::default() };
    let instances = vec![vk::MotionInstanceData::SrtMotionInstance(moving), vk::MotionInstanceData::default()];
    let moving = MotionTlasContents { flags: 2, instances }.encode();
    [leaf, card, scene, moving].into_iter().flatten().collect()
}

fn micromap() -> MicromapData {
    let triangle = MicromapTriangle {
        data_offset: 1,
        subdivision_level: SubdivisionLevel::ZERO,
        format: OpacityMicromapFormat::TwoState,
    };
    MicromapData {
        name: "leaf".to_owned(),
        array: vec![0, 1],
        triangles: vec![triangle],
        indices: vec![0, -4],
        usage_counts: histogram([triangle]),
        index_usage_counts: histogram([triangle]),
        settings: "{}".to_owned(),
        sources: vec![Source { name: "leaf.png".to_owned(), length: 3, sha256: [7; 32] }],
        statistics: "{}".to_owned(),
    }
}
