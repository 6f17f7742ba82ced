//! Loading: what is read, how often, and what happens with bytes that are no scene.
#![allow(clippy::unwrap_used)]

mod support;

use std::cell::RefCell;

use omm_model::format::OpacityMicromapFormat;
use omm_model::memory::{MemoryError, MemoryView, NoMemory};
use omm_model::opacity::OpacityState;
use omm_model::special_index::TriangleMap;
use omm_model::vk::{DeviceAddress, GeometryFlags};
use omm_trace::{Counters, LoadErrorKind, NoShaders, Scene, TraceOptions};
use proptest::prelude::*;
use proptest::sample::Index;
use support::*;

const STATES: [OpacityState; 4] =
    [OpacityState::Opaque, OpacityState::UnknownOpaque, OpacityState::Opaque, OpacityState::UnknownTransparent];

/// A micromap, two bottom-level structures that share it, and instances that share those.
fn memory() -> (Memory, DeviceAddress) {
    let mut memory = Memory::default();
    let micromap = memory.micromap(&[
        (1, OpacityMicromapFormat::FourState, STATES.to_vec()),
        (0, OpacityMicromapFormat::TwoState, vec![OpacityState::Opaque]),
    ]);
    let map = [(unit_triangle(0.0), TriangleMap::Triangle(0)), (unit_triangle(-1.0), TriangleMap::Triangle(1))];
    let first =
        memory.blas(vec![mapped(GeometryFlags::empty(), micromap, &map), mapped(GeometryFlags::empty(), 0, &[])]);
    let boxes = aabbs(GeometryFlags::empty(), &[[[0.0; 3], [1.0; 3]]]);
    let second = memory.blas(vec![mapped(GeometryFlags::OPAQUE, micromap, &map[1..]), boxes]);
    let tlas = memory.tlas([first, 0, second, first].map(instance).to_vec());
    (memory, tlas)
}

/// Counts how often an address is read.
struct Counting<'a>(&'a Memory, RefCell<Vec<(u64, u64)>>);

impl MemoryView for Counting<'_> {
    fn read(&self, address: DeviceAddress, size: u64) -> Result<&[u8], MemoryError> {
        self.1.borrow_mut().push((address.0, size));
        self.0.read(address, size)
    }
}

#[test]
fn each_object_is_read_once() {
    let (memory, tlas) = memory();
    let counting = Counting(&memory, RefCell::default());
    let scene = Scene::load(&counting, tlas).unwrap();
    assert_eq!((scene.instance_count(), scene.triangle_count()), (3, 5));
    let mut reads = counting.1.into_inner();
    reads.sort_unstable();
    let sizes = memory.objects.iter().flat_map(|(&address, bytes)| [(address, 64), (address, bytes.len() as u64)]);
    assert_eq!(reads, sizes.collect::<Vec<_>>());
}

#[test]
fn compacted_objects_make_the_same_scene() {
    let (mut memory, tlas) = memory();
    let before = Scene::load(&memory, tlas).unwrap();
    for bytes in memory.objects.values_mut() {
        *bytes = omm_layout::object::compact(bytes).unwrap();
    }
    let after = Scene::load(&memory, tlas).unwrap();
    for (u, v) in [(0.1, 0.1), (0.4, 0.4), (0.8, 0.1), (0.1, 0.8), (0.3, 0.3)] {
        let ray = down(u, v);
        assert_eq!(closest(&before, &ray), closest(&after, &ray));
        assert!(closest(&before, &ray).unwrap().micromap.is_some());
    }
}

#[test]
fn errors_name_the_way() {
    let text = |memory: &dyn MemoryView, tlas| Scene::load(memory, tlas).unwrap_err().to_string();
    let at = DeviceAddress(0x1000);
    assert_eq!(
        text(&NoMemory, at),
        "tlas at 0x1000: 64 bytes from address 0x1000 are wanted, but 0 are readable there"
    );

    let (good, tlas) = memory();
    let (&micromap, _) = good.objects.first_key_value().unwrap();
    let error = text(&good, DeviceAddress(micromap));
    assert_eq!(error, "tlas at 0x1000: kind at byte 8: found 1, required 3");

    let mut cut = good.clone();
    cut.objects.get_mut(&micromap).unwrap().truncate(70);
    let error = text(&cut, tlas);
    let way = format!("tlas at {:#x} -> instances[0] -> blas at 0x1200 -> geometries[0] -> micromap at 0x1000", tlas.0);
    assert_eq!(error, format!("{way}: 112 bytes from address 0x1000 are wanted, but 70 are readable there"));

    let mut gone = good.clone();
    gone.objects.remove(&micromap);
    assert!(matches!(Scene::load(&gone, tlas).unwrap_err().kind, LoadErrorKind::Memory(_)));
}

#[test]
fn micromap_triangles_must_exist() {
    let load = |micromap: bool, found| {
        let mut memory = Memory::default();
        let state = (0, OpacityMicromapFormat::FourState, vec![OpacityState::Opaque]);
        let micromap = if micromap { memory.micromap(&[state.clone(), state]) } else { 0 };
        let map = [(unit_triangle(0.0), TriangleMap::Triangle(0)), (unit_triangle(0.0), TriangleMap::Triangle(found))];
        let blas = memory.blas(vec![mapped(GeometryFlags::empty(), micromap, &map)]);
        let tlas = memory.tlas(vec![instance(blas)]);
        Scene::load(&memory, tlas).map(|scene| scene.triangle_count()).map_err(|error| error.kind)
    };
    assert_eq!(load(true, 1), Ok(2));
    let error = |primitive, found, count| Err(LoadErrorKind::MicromapTriangle { geometry: 0, primitive, found, count });
    assert_eq!(load(true, 2), error(1, 2, 2));
    assert_eq!(load(false, 0), error(0, 0, 0));
    let text = LoadErrorKind::MicromapTriangle { geometry: 3, primitive: 1, found: 2, count: 2 }.to_string();
    assert_eq!(text, "geometries[3].primitives[1]: found micromap triangle 2, required less than 2");
}

#[test]
fn objects_may_not_overlap() {
    // A micromap whose elements are themselves a micromap.
    let mut memory = Memory::default();
    let inner = {
        let mut scratch = Memory::default();
        let address = scratch.micromap(&[(0, OpacityMicromapFormat::FourState, vec![OpacityState::Opaque])]);
        scratch.objects.remove(&address).unwrap()
    };
    let states = |bytes: &[u8]| -> Vec<_> {
        let mut bits: Vec<_> = bytes.iter().flat_map(|byte| (0..8).map(move |bit| byte >> bit & 1)).collect();
        bits.resize(4096, 0);
        bits.into_iter().map(|bit| OpacityState::from_value(bit).unwrap()).collect()
    };
    let outer = memory.micromap(&[(6, OpacityMicromapFormat::TwoState, states(&inner))]);
    let map = [(unit_triangle(0.0), TriangleMap::Triangle(0))];
    let blas = memory
        .blas(vec![mapped(GeometryFlags::empty(), outer, &map), mapped(GeometryFlags::empty(), outer + 64 + 16, &map)]);
    let tlas = memory.tlas(vec![instance(blas)]);
    let error = Scene::load(&memory, tlas).unwrap_err();
    assert_eq!(error.at.micromap, Some((1, DeviceAddress(outer + 80))));
    assert!(matches!(error.kind, LoadErrorKind::Overlap { other, .. } if other == outer), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    /// Damaged objects give an error or a scene, and rays through that scene end.
    #[test]
    fn damage_is_survived(
        hits in prop::collection::vec((any::<Index>(), any::<Index>(), any::<u8>()), 1..4),
        words in prop::collection::vec((any::<Index>(), any::<Index>(), any::<u32>()), 0..3),
    ) {
        let (mut memory, tlas) = memory();
        for (object, at, value) in hits {
            let mut objects: Vec<_> = memory.objects.values_mut().collect();
            let object = &mut objects[object.index(4)];
            let at = at.index(object.len());
            object[at] = value;
        }
        for (object, at, value) in words {
            let mut objects: Vec<_> = memory.objects.values_mut().collect();
            let object = &mut objects[object.index(4)];
            let at = at.index(object.len() / 4);
            object[4 * at..4 * at + 4].copy_from_slice(&value.to_le_bytes());
        }
        if let Ok(scene) = Scene::load(&memory, tlas) {
            for ray in [down(0.3, 0.2), down(0.0, 0.0), down(-1.0, 1e30)] {
                scene.trace(&ray, &TraceOptions::default(), &mut NoShaders, &mut Counters::default());
            }
        }
    }
}
