//! Traversal against what a driver did: outcomes of flag combinations, and the elements that hits read.
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use omm_model::curve::MicroTriangle;
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;
use omm_model::special_index::{OpacityMicromapSpecialIndex, TriangleMap};
use omm_model::vk::{GeometryFlags, GeometryInstanceFlags};
use omm_trace::{Counters, NoShaders, Ray, RayFlags, Scene, TraceOptions};
use serde_json::Value;
use support::*;

/// One element of a case: which triangle to aim at, and where.
struct Target {
    triangle: usize,
    barycentrics: [f32; 2],
}

/// A case of the file: what to attach to the geometry, and what to aim at.
struct Case {
    name: String,
    /// The micromap's triangles: level, format and states.
    micromaps: Vec<(u32, OpacityMicromapFormat, Vec<OpacityState>)>,
    /// What each triangle of the mesh maps to; `None` without a micromap.
    maps: Vec<Option<TriangleMap>>,
    targets: Vec<Target>,
}

/// Reads `4-state: micromap 0 level 2 element 5 state 1`, `special index -1` and `no micromap`.
fn read_case(case: &Value) -> Case {
    let name = case["case"].as_str().unwrap().to_owned();
    let mut read = Case { name, micromaps: Vec::new(), maps: Vec::new(), targets: Vec::new() };
    for element in case["elements"].as_array().unwrap() {
        let element = element.as_str().unwrap();
        let mut whole = |map| {
            read.maps.push(map);
            read.targets.push(Target { triangle: read.maps.len() - 1, barycentrics: [0.25, 0.25] });
        };
        if element == "no micromap" {
            whole(None);
            continue;
        }
        if let Some(index) = element.strip_prefix("special index ") {
            let index = OpacityMicromapSpecialIndex::from_value(index.parse().unwrap()).unwrap();
            whole(Some(TriangleMap::SpecialIndex(index)));
            continue;
        }
        let (format, rest) = element.split_once(": ").unwrap();
        let format = match format {
            "2-state" => OpacityMicromapFormat::TwoState,
            "4-state" => OpacityMicromapFormat::FourState,
            other => panic!("format {other}"),
        };
        let words: Vec<_> = rest.split(' ').collect();
        let ["micromap", micromap, "level", level, "element", index, "state", state] = words[..] else {
            panic!("{rest}")
        };
        let number = |text: &str| text.parse::<u32>().unwrap();
        if number(micromap) as usize == read.micromaps.len() {
            read.micromaps.push((number(level), format, Vec::new()));
            read.maps.push(Some(TriangleMap::Triangle(number(micromap))));
        }
        let states = &mut read.micromaps.last_mut().unwrap().2;
        assert_eq!(states.len(), number(index) as usize);
        states.push(OpacityState::from_value(number(state) as u8).unwrap());
        let level = SubdivisionLevel::new(number(level)).unwrap();
        let barycentrics = MicroTriangle::new(level, number(index)).unwrap().centroid();
        read.targets.push(Target { triangle: read.maps.len() - 1, barycentrics });
    }
    read
}

/// The unit triangle, moved two to the right for each one before it.
fn place(triangle: usize) -> Vertices {
    unit_triangle(0.0).map(|[x, y, z]| [x + 2.0 * triangle as f32, y, z])
}

impl Case {
    fn scene(&self, geometry: GeometryFlags, instance: GeometryInstanceFlags) -> Scene {
        let mut memory = Memory::default();
        let primitives = if self.maps.contains(&None) {
            triangles(geometry, (0..self.maps.len()).map(place))
        } else {
            // A case that only has special indices comes with a null micromap, or with one that no triangle uses.
            let null = self.name.starts_with("special_null");
            let unused = [(0, OpacityMicromapFormat::FourState, vec![OpacityState::UnknownOpaque])];
            let micromaps = if self.micromaps.is_empty() { &unused[..] } else { &self.micromaps };
            let micromap = if null { 0 } else { memory.micromap(micromaps) };
            let maps = self.maps.iter().enumerate().map(|(at, map)| (place(at), map.unwrap()));
            mapped(geometry, micromap, &maps.collect::<Vec<_>>())
        };
        let blas = memory.blas(vec![primitives]);
        memory.scene(vec![with_flags(blas, instance)])
    }
}

fn flag(row: &Value, name: &str) -> bool {
    row[name].as_bool().unwrap()
}

#[test]
fn outcomes_equal_the_driver_s() {
    let Some(bytes) = golden("traversal/semantics.json") else { return };
    let file: Value = serde_json::from_slice(&bytes).unwrap();
    let cases: Vec<_> = file["cases"].as_array().unwrap().iter().map(read_case).collect();
    let mut outcomes = 0;
    let rows = file["rows"].as_array().unwrap();
    for row in rows {
        let case = cases.iter().find(|case| case.name == row["case"].as_str().unwrap()).unwrap();
        let mut geometry = GeometryFlags::empty();
        geometry.set(GeometryFlags::OPAQUE, flag(row, "geometry_opaque"));
        let mut instance = match row["instance_opacity"].as_str() {
            None => GeometryInstanceFlags::empty(),
            Some("force_opaque") => GeometryInstanceFlags::FORCE_OPAQUE,
            Some("force_no_opaque") => GeometryInstanceFlags::FORCE_NO_OPAQUE,
            Some(other) => panic!("instance_opacity {other}"),
        };
        let two_state = GeometryInstanceFlags::FORCE_OPACITY_MICROMAP_2_STATE;
        instance.set(two_state, flag(row, "instance_force_2_state"));
        let disable = GeometryInstanceFlags::DISABLE_OPACITY_MICROMAPS;
        instance.set(disable, flag(row, "instance_disable_micromaps"));
        let mut ray = match row["ray_opacity"].as_str() {
            None => RayFlags::empty(),
            Some("opaque") => RayFlags::OPAQUE,
            Some("no_opaque") => RayFlags::NO_OPAQUE,
            Some("cull_opaque") => RayFlags::CULL_OPAQUE,
            Some("cull_no_opaque") => RayFlags::CULL_NO_OPAQUE,
            Some(other) => panic!("ray_opacity {other}"),
        };
        ray.set(RayFlags::FORCE_OPACITY_MICROMAP_2_STATE, flag(row, "ray_force_2_state"));

        let scene = case.scene(geometry, instance);
        let outcome = |target: &Target| {
            let [u, v] = target.barycentrics;
            let (hit, counters, record) = trace(&scene, &down(2.0 * target.triangle as f32 + u, v), ray);
            assert_eq!(counters.candidates, 1);
            match (hit, record.seen.len()) {
                (None, 0) => 'T',
                (Some(hit), 0) if hit.opaque => 'O',
                (Some(hit), 1) if !hit.opaque => 'A',
                other => panic!("{other:?}"),
            }
        };
        let found: String = case.targets.iter().map(outcome).collect();
        assert_eq!(found, row["outcome"].as_str().unwrap(), "{row}");
        outcomes += found.len();
    }
    assert_eq!((rows.len(), outcomes), (1560, 19_065));
}

#[test]
fn hits_read_the_driver_s_elements_away_from_edges() {
    let Some(bytes) = golden("traversal/lookup.bin") else { return };
    // A state for each element that looks random, so that a neighbour is likely to differ.
    let state = |index: u32| OpacityState::from_value((index.wrapping_mul(0x9e37_79b9) >> 30) as u8).unwrap();
    let mut records = 0;
    for level in SubdivisionLevel::all() {
        let states: Vec<_> = (0..level.microtriangles()).map(state).collect();
        let mut memory = Memory::default();
        let micromap = memory.micromap(&[(level.get(), OpacityMicromapFormat::FourState, states)]);
        let triangle = [(unit_triangle(0.0), TriangleMap::Triangle(0))];
        let blas = memory.blas(vec![mapped(GeometryFlags::empty(), micromap, &triangle)]);
        // All states but transparent end in a hit that shows them.
        let scene = memory.scene(vec![instance(blas)]);
        for record in bytes.as_chunks::<20>().0 {
            let word = |at: usize| <[u8; 4]>::try_from(&record[4 * at..4 * at + 4]).unwrap();
            let [u, v] = [0, 1].map(|at| f32::from_le_bytes(word(at)));
            let [of_level, kind, expected] = [2, 3, 4].map(|at| u32::from_le_bytes(word(at)));
            if of_level != level.get() || !matches!(kind, 0 | 1 | 4) {
                continue;
            }
            records += 1;
            let mut counters = Counters::default();
            let ray = Ray::unbounded([u, v, 1.0], [0.0, 0.0, -1.0]).unwrap();
            let hit = scene.trace(&ray, &TraceOptions::default(), &mut NoShaders, &mut counters);
            assert_eq!(counters.candidates, 1, "u {u:e} v {v:e}");
            let found = hit.map_or(OpacityState::Transparent, |hit| {
                assert_eq!(hit.barycentrics, [u, v]);
                hit.micromap.unwrap()
            });
            assert_eq!(found, state(expected), "u {u:e} v {v:e} level {level}");
        }
    }
    assert_eq!(records, 29_618);
}
