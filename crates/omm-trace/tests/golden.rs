//! Traversal against what a driver did: outcomes of flag combinations, and the elements that hits read.
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use omm_model::curve::{Corner, MicroTriangle, TieBreak};
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

/// A point, and the element that the driver read there.
struct Lookup {
    at: [f32; 2],
    level: u32,
    kind: u32,
    element: u32,
}

fn lookups(bytes: &[u8]) -> impl Iterator<Item = Lookup> + '_ {
    bytes.as_chunks::<20>().0.iter().map(|record| {
        let word = |at: usize| <[u8; 4]>::try_from(&record[4 * at..4 * at + 4]).unwrap();
        let at = [0, 1].map(|at| f32::from_le_bytes(word(at)));
        let [level, kind, element] = [2, 3, 4].map(|at| u32::from_le_bytes(word(at)));
        Lookup { at, level, kind, element }
    })
}

/// A state for each element that looks random, so that a neighbour is likely to differ.
fn state(element: u32) -> OpacityState {
    OpacityState::from_value((element.wrapping_mul(0x9e37_79b9) >> 30) as u8).unwrap()
}

/// The unit triangle with a micromap of these states. All states but transparent end in a hit that shows them.
fn scene_of_level(level: SubdivisionLevel) -> Scene {
    let states: Vec<_> = (0..level.microtriangles()).map(state).collect();
    let mut memory = Memory::default();
    let micromap = memory.micromap(&[(level.get(), OpacityMicromapFormat::FourState, states)]);
    let triangle = [(unit_triangle(0.0), TriangleMap::Triangle(0))];
    let blas = memory.blas(vec![mapped(GeometryFlags::empty(), micromap, &triangle)]);
    memory.scene(vec![instance(blas)])
}

/// The state that a hit at a point reads, if the ray down to it meets the triangle.
fn state_read(scene: &Scene, [u, v]: [f32; 2]) -> Option<OpacityState> {
    let mut counters = Counters::default();
    let ray = Ray::unbounded([u, v, 1.0], [0.0, 0.0, -1.0]).unwrap();
    let hit = scene.trace(&ray, &TraceOptions::default(), &mut NoShaders, &mut counters);
    (counters.candidates == 1).then(|| {
        hit.map_or(OpacityState::Transparent, |hit| {
            assert_eq!(hit.barycentrics, [u, v]);
            hit.micromap.unwrap()
        })
    })
}

#[test]
fn hits_read_the_driver_s_elements_away_from_edges() {
    let Some(bytes) = golden("traversal/lookup.bin") else { return };
    let mut records = 0;
    for level in SubdivisionLevel::all() {
        let scene = scene_of_level(level);
        let away = |it: &Lookup| it.level == level.get() && matches!(it.kind, 0 | 1 | 4);
        for Lookup { at, element, .. } in lookups(&bytes).filter(away) {
            records += 1;
            assert_eq!(state_read(&scene, at), Some(state(element)), "{at:?} level {level}");
        }
    }
    assert_eq!(records, 29_618);
}

/// Whether a microtriangle's closed area comes within `tolerance` (in barycentrics) of a point.
fn touches(level: SubdivisionLevel, index: u32, [u, v]: [f32; 2], tolerance: f64) -> bool {
    let corners = MicroTriangle::new(level, index).unwrap().corners();
    let (unit, [u, v]) = (f64::from(level.segments()), [u, v].map(f64::from));
    let within = |at: f64, of: fn(&Corner) -> u32| {
        let ends = corners.iter().map(|corner| f64::from(of(corner)) / unit);
        let (low, high) = ends.fold((f64::INFINITY, 0.0_f64), |(low, high), end| (low.min(end), high.max(end)));
        at >= low - tolerance && at <= high + tolerance
    };
    // The three slabs between parallel edges; corners are exact, and so is everything at a tolerance of 0 but u + v.
    within(u, |corner| corner.u) && within(v, |corner| corner.v) && within(u + v, |corner| corner.u + corner.v)
}

#[test]
fn hits_on_edges_read_an_element_that_touches_the_point() {
    let Some(bytes) = golden("traversal/lookup.bin") else { return };
    // What a driver interpolates in f32, what the appendix's code adds in it, and what is exact.
    for (tie_break, tolerance, as_the_driver) in
        [(TieBreak::Reference, 1e-7, 22_401), (TieBreak::LowestIndex, 0.0, 18_804)]
    {
        let (mut records, mut hits, mut equal) = (0, 0, 0);
        for level in SubdivisionLevel::all() {
            let scene = scene_of_level(level).with_tie_break(tie_break);
            let on_edge = |it: &Lookup| it.level == level.get() && matches!(it.kind, 2 | 3);
            for Lookup { at, element, .. } in lookups(&bytes).filter(on_edge) {
                let ours = tie_break.index(at[0], at[1], level);
                records += 1;
                equal += usize::from(ours == element);
                assert!(touches(level, element, at, 1e-6), "{at:?} level {level}: {element}");
                assert!(touches(level, ours, at, tolerance), "{at:?} level {level}: {ours}");
                if let Some(found) = state_read(&scene, at) {
                    hits += 1;
                    assert_eq!(found, state(ours), "{at:?} level {level}");
                }
            }
        }
        // On the border of the triangle 111 rays miss. No setting breaks all ties as the driver does.
        assert_eq!((records, hits, equal), (24_891, 24_780, as_the_driver));
    }
}
