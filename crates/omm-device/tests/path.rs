//! The whole way: micromap, bottom level, top level, serialized, and back on a second device.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use std::collections::BTreeMap;

use common::{bytes, device, micromap};
use omm_device::app::{App, MicromapBinding, Observer, Structure, TriangleInput};
use omm_layout::index::IndexType;
use omm_layout::object::{Object, replace_references};
use omm_model::call::{Call, Output};
use omm_model::memory::MemoryView;
use omm_model::special_index::{OpacityMicromapSpecialIndex, TriangleMap};
use omm_model::vk;
use omm_serialize::ByteOrder;

const FLAGS: vk::BuildAccelerationStructureFlags = vk::BuildAccelerationStructureFlags::ALLOW_COMPACTION;

/// Two triangles with a micromap triangle each, one with a special index, one inactive; two instances of them and an inactive one.
fn scene(app: &mut App<'_>) -> [Structure; 3] {
    let micromap = micromap(app);
    let positions =
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [f32::NAN; 3]];
    let maps = [
        TriangleMap::Triangle(1),
        TriangleMap::SpecialIndex(OpacityMicromapSpecialIndex::FullyOpaque),
        TriangleMap::Triangle(3),
        TriangleMap::Triangle(0),
    ];
    let binding = MicromapBinding { micromap: Some(&micromap), maps: &maps, index_type: IndexType::Uint16 };
    let flags = vk::GeometryFlags::NO_DUPLICATE_ANY_HIT_INVOCATION;
    let indices = &[0, 1, 2, 1, 3, 2, 1, 4, 3, 1, 4, 5];
    let input = TriangleInput { positions: &positions, indices, flags, micromap: Some(binding) };
    let bottom = app.build_triangles(&[input], FLAGS).unwrap();
    let instance = |custom, reference| vk::Instance {
        transform: vk::TransformMatrix::IDENTITY,
        instance_custom_index: custom,
        mask: 0xff,
        acceleration_structure_reference: reference,
        ..Default::default()
    };
    let instances = [instance(1, bottom.address.0), instance(2, 0), instance(3, bottom.address.0)];
    let top = app.build_instances(&instances, FLAGS).unwrap();
    [micromap, bottom, top]
}

#[test]
fn a_scene_moves_to_another_device() {
    let mut first = device();
    let mut observer = ();
    let mut app = App::new(&mut first, &mut observer);
    let scene = scene(&mut app);
    let objects = scene.map(|structure| bytes(&app, &structure));
    let blobs = scene.map(|structure| app.serialize(&structure).unwrap());

    let mut second = device();
    let mut observer = ();
    let mut app = App::new(&mut second, &mut observer);
    // Whatever else lives there gives all that follows other addresses.
    app.buffer(100_000, vk::BufferUsageFlags::empty()).unwrap();
    let mut addresses = BTreeMap::new();
    for ((structure, object), mut blob) in scene.into_iter().zip(objects).zip(blobs) {
        let original = blob.clone();
        omm_serialize::replace_references(&mut blob, ByteOrder::Little, |old| addresses[&old]).unwrap();
        let copy = app.deserialize(&blob, structure.ty).unwrap();
        assert_ne!(copy.address, structure.address);
        let mut found = bytes(&app, &copy);
        addresses.insert(structure.address.0, copy.address.0);
        let back = |new: u64| *addresses.iter().find(|(_, found)| **found == new).unwrap().0;
        replace_references(&mut found, back).unwrap();
        assert_eq!(found, object);
        let mut again = app.serialize(&copy).unwrap();
        omm_serialize::replace_references(&mut again, ByteOrder::Little, back).unwrap();
        assert_eq!(again, original);
    }
}

#[test]
fn the_same_calls_give_the_same_bytes() {
    let run = || {
        let mut device = device();
        let mut observer = Calls::default();
        let mut app = App::new(&mut device, &mut observer);
        let scene = scene(&mut app);
        (scene.map(|structure| (structure, bytes(&app, &structure))), observer.0)
    };
    let (first, calls) = run();
    assert_eq!(run(), (first, calls.clone()));
    // Played back without the application, the calls do the same up to the first one that reads uploaded bytes.
    let mut device = device();
    for (call, output) in calls.iter().take_while(|(call, _)| !matches!(call, Call::QueueSubmit { .. })) {
        assert_eq!(device.execute(call).as_ref(), Ok(output));
    }
}

/// Writes down what it sees.
#[derive(Default)]
struct Calls(Vec<(Call, Output)>);

impl Observer for Calls {
    fn before(&mut self, call: &Call, memory: &dyn MemoryView) {
        assert!(memory.read(vk::DeviceAddress(0), 1).is_err());
        self.0.push((call.clone(), Output::None));
    }

    fn after(&mut self, call: &Call, output: &Output) {
        let (seen, found) = self.0.last_mut().unwrap();
        assert_eq!(seen, call);
        *found = output.clone();
    }
}

#[test]
fn what_is_compacted_is_smaller_and_means_the_same() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    for structure in scene(&mut app) {
        let all = [
            vk::QueryType::ACCELERATION_STRUCTURE_SIZE,
            vk::QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE,
            vk::QueryType::ACCELERATION_STRUCTURE_SERIALIZATION_SIZE,
        ];
        let [size, compacted_size, serialized_size] = all.map(|ty| app.query(&[&structure], ty).unwrap()[0]);
        let clone = app.copy(&structure, vk::CopyAccelerationStructureMode::CLONE).unwrap();
        assert_eq!(bytes(&app, &clone), bytes(&app, &structure));
        assert_eq!(size, structure.size);
        assert_eq!(serialized_size, app.serialize(&structure).unwrap().len() as u64);
        let compacted = app.copy(&structure, vk::CopyAccelerationStructureMode::COMPACT).unwrap();
        assert_eq!(compacted.size, compacted_size);
        assert!(compacted_size < size, "{compacted_size} of {size}");
        let (old, new) = (bytes(&app, &structure), bytes(&app, &compacted));
        match (Object::read(&old).unwrap(), Object::read(&new).unwrap()) {
            (Object::Micromap(old), Object::Micromap(new)) => {
                assert_eq!(old.contents(), new.contents());
            }
            (Object::BottomLevel(old), Object::BottomLevel(new)) => {
                assert_eq!(old.geometry_count(), new.geometry_count());
                for (old, new) in old.geometries().zip(new.geometries()) {
                    assert_eq!(
                        (old.flags(), old.micromap(), old.primitive_count()),
                        (new.flags(), new.micromap(), new.primitive_count())
                    );
                    assert!(old.triangles().eq(new.triangles()));
                }
            }
            (Object::TopLevel(old), Object::TopLevel(new)) => {
                assert!(old.instances().eq(new.instances()));
            }
            other => panic!("{other:?}"),
        }
        let again = app.copy(&compacted, vk::CopyAccelerationStructureMode::COMPACT).unwrap();
        assert_eq!(bytes(&app, &again), new);
        let blob = app.serialize(&compacted).unwrap();
        let back = app.deserialize(&blob, structure.ty).unwrap();
        assert_eq!(bytes(&app, &back), new);
    }
}

#[test]
fn pointers_are_counted_for_top_levels() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let [micromap, bottom, top] = scene(&mut app);
    let pointers = vk::QueryType::ACCELERATION_STRUCTURE_SERIALIZATION_BOTTOM_LEVEL_POINTERS;
    assert_eq!(app.query(&[&micromap, &bottom, &top], pointers).unwrap(), [0, 0, 2]);
    let compacted = app.copy(&top, vk::CopyAccelerationStructureMode::COMPACT).unwrap();
    assert_eq!(app.query(&[&compacted], pointers).unwrap(), [1]);
}

#[test]
fn only_data_of_the_same_driver_and_version_is_compatible() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let micromap = micromap(&mut app);
    let mut blob = app.serialize(&micromap).unwrap();
    assert!(app.is_compatible(&blob).unwrap());
    for byte in [0, 15, 16, 31] {
        blob[byte] ^= 1;
        assert!(!app.is_compatible(&blob).unwrap());
        let error = app.deserialize(&blob, micromap.ty).unwrap_err();
        assert_eq!(error.to_string(), "the serialized data is not compatible with the device");
        blob[byte] ^= 1;
    }
    assert!(app.is_compatible(&blob[..31]).is_err());
}
