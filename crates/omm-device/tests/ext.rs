//! Micromap objects of the EXT extension, from creation to the bottom-level structure that uses them.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::{bytes, device, stopped, triangle};
use omm_device::Device;
use omm_device::app::{
    App, AppError, MicromapBinding, MicromapBindingExt, MicromapExt, MicromapInput, Structure, TriangleInput,
};
use omm_layout::index::IndexType;
use omm_layout::object::{BlasObject, MicromapObject, Object};
use omm_model::call::{Call, Output};
use omm_model::format::OpacityMicromapFormat;
use omm_model::memory::MemoryView;
use omm_model::special_index::{OpacityMicromapSpecialIndex, TriangleMap};
use omm_model::usage;
use omm_model::vk;

const DEVICE: vk::Device = vk::Device(1);
type Flags = vk::BuildAccelerationStructureFlags;

/// Runs `with` on a new device.
fn with<R>(with: impl FnOnce(&mut App<'_>) -> R) -> R {
    let (mut device, mut observer): (Device, ()) = (device(), ());
    with(&mut App::new(&mut device, &mut observer))
}

const DATA: [u8; 6] = [0b0110, 0x1b, 0xe4, 0x00, 0xff, 0b01];

/// Four triangles: levels 1, 2, 0 and 1, the last with the data of the first.
fn triangles() -> [omm_model::triangle::MicromapTriangle; 4] {
    let (two, four) = (OpacityMicromapFormat::TwoState, OpacityMicromapFormat::FourState);
    [triangle(0, 1, two), triangle(1, 2, four), triangle(5, 0, four), triangle(0, 1, two)]
}

fn micromap_of(app: &mut App<'_>, data: &[u8]) -> MicromapExt {
    let flags = Flags::ALLOW_COMPACTION;
    app.build_micromap_ext(&MicromapInput { data, triangles: &triangles(), flags }).unwrap()
}

fn held(app: &App<'_>, micromap: &MicromapExt) -> Vec<u8> {
    let all = app.device().read(micromap.buffer.address, micromap.size).unwrap();
    Object::read(all).unwrap().as_bytes().to_vec()
}

const POSITIONS: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
const SPECIAL: TriangleMap = TriangleMap::SpecialIndex(OpacityMicromapSpecialIndex::FullyUnknownOpaque);
const MAPS: [TriangleMap; 2] = [TriangleMap::Triangle(3), SPECIAL];

fn input<'a>() -> TriangleInput<'a> {
    let flags = vk::GeometryFlags::empty();
    TriangleInput { positions: &POSITIONS, indices: &[0, 1, 2, 1, 2, 3], flags, micromap: None }
}

fn attach<'a>(micromap: Option<&'a MicromapExt>, maps: &'a [TriangleMap]) -> MicromapBindingExt<'a> {
    MicromapBindingExt { micromap, maps, index_type: IndexType::Uint32, usages: &[] }
}

#[test]
fn both_extensions_build_the_same_object() {
    with(|app| {
        let flags = Flags::ALLOW_COMPACTION | Flags::PREFER_FAST_TRACE;
        let input = MicromapInput { data: &DATA, triangles: &triangles(), flags };
        let khr = app.build_micromap(&input).unwrap();
        let ext = app.build_micromap_ext(&input).unwrap();
        assert_eq!(held(app, &ext), bytes(app, &khr));
        assert_eq!(app.device().micromap(ext.handle).unwrap().address, ext.buffer.address);
    });
}

#[test]
fn copies_of_a_micromap_hold_the_same() {
    with(|app| {
        let source = micromap_of(app, &DATA);
        let clone = app.copy_micromap_ext(&source, vk::CopyMicromapMode::CLONE).unwrap();
        assert_eq!(held(app, &clone), held(app, &source));
        let compacted = app.copy_micromap_ext(&source, vk::CopyMicromapMode::COMPACT).unwrap();
        let found = held(app, &compacted);
        assert_eq!(found, MicromapObject::read(&held(app, &source)).unwrap().compact());
        assert_eq!(app.micromap_property(&source, vk::QueryType::MICROMAP_COMPACTED_SIZE).unwrap(), found.len() as u64);

        let blob = app.serialize_micromap_ext(&compacted).unwrap();
        let serialized = app.micromap_property(&compacted, vk::QueryType::MICROMAP_SERIALIZATION_SIZE).unwrap();
        assert_eq!(serialized, blob.len() as u64);
        let again = app.deserialize_micromap_ext(&blob).unwrap();
        assert_eq!(held(app, &again), found);
        // Both extensions have one serialized form.
        let khr = app.deserialize(&blob, vk::AccelerationStructureType::OPACITY_MICROMAP).unwrap();
        assert_eq!(bytes(app, &khr), found);
        let version_info = vk::MicromapVersionInfo { version_data: blob[..32].to_vec(), ..Default::default() };
        let call = Call::GetDeviceMicromapCompatibility { device: DEVICE, version_info };
        let compatible = vk::AccelerationStructureCompatibility::COMPATIBLE;
        assert_eq!(app.call(&call).unwrap(), Output::Compatibility(compatible));
    });
}

#[test]
fn sizes_are_written_by_the_device_too() {
    with(|app| {
        let micromap = micromap_of(app, &DATA);
        let query_type = vk::QueryType::MICROMAP_SERIALIZATION_SIZE;
        let query_pool = vk::QueryPool(app.device().unused_handle());
        let create_info = vk::QueryPoolCreateInfo { query_type, query_count: 1, ..Default::default() };
        app.call(&Call::CreateQueryPool { device: DEVICE, create_info, query_pool }).unwrap();
        let (first_query, query_count, data_size, stride) = (0, 1, 8, 8);
        let micromaps = vec![micromap.handle];
        app.submit(|command_buffer| {
            vec![
                Call::CmdResetQueryPool { command_buffer, query_pool, first_query, query_count },
                Call::CmdWriteMicromapsProperties { command_buffer, micromaps, query_type, query_pool, first_query },
            ]
        })
        .unwrap();
        let flags = vk::QueryResultFlags::RESULT_64;
        let results = Call::GetQueryPoolResults {
            device: DEVICE,
            query_pool,
            first_query,
            query_count,
            data_size,
            stride,
            flags,
        };
        let expected = app.micromap_property(&micromap, query_type).unwrap();
        assert_eq!(app.call(&results).unwrap(), Output::QueryResults(vec![expected]));
    });
}

#[test]
fn an_attached_micromap_is_referred_to_like_one_of_the_other_extension() {
    with(|app| {
        let ext = micromap_of(app, &DATA);
        let usages = usage::histogram(triangles());
        let binding = MicromapBindingExt { usages: &usages, ..attach(Some(&ext), &MAPS) };
        let found = app.build_triangles_ext(&[(input(), Some(binding))], Flags::empty()).unwrap();
        let flags = Flags::ALLOW_COMPACTION;
        let khr = app.build_micromap(&MicromapInput { data: &DATA, triangles: &triangles(), flags }).unwrap();
        let binding = MicromapBinding { micromap: Some(&khr), maps: &MAPS, index_type: IndexType::Uint16 };
        let other = TriangleInput { micromap: Some(binding), ..input() };
        let other = app.build_triangles(&[other], Flags::empty()).unwrap();
        let (found, mut other) = (bytes(app, &found), bytes(app, &other));
        omm_layout::object::replace_references(&mut other, |_| ext.buffer.address.0).unwrap();
        assert_eq!(found, other);
        let view = BlasObject::read(&found).unwrap();
        let maps: Vec<_> = view.geometry(0).unwrap().triangles().map(|triangle| triangle.map.unwrap()).collect();
        assert_eq!(maps, MAPS);

        // Serialized data can refer to it as well.
        let structure = app.build_triangles_ext(&[(input(), Some(attach(Some(&ext), &MAPS)))], flags).unwrap();
        let blob = app.serialize(&structure).unwrap();
        let again = app.deserialize(&blob, vk::AccelerationStructureType::BOTTOM_LEVEL).unwrap();
        assert_eq!(bytes(app, &again), bytes(app, &structure));
        app.destroy_micromap_ext(ext).unwrap();
        let error = app.deserialize(&blob, vk::AccelerationStructureType::BOTTOM_LEVEL);
        assert!(stopped(error).ends_with("is the address of no acceleration structure or micromap"));
    });
}

#[test]
fn a_null_micromap_has_special_indices_only() {
    with(|app| {
        let null = |maps| [(input(), Some(attach(None, maps)))];
        let found = app.build_triangles_ext(&null(&[SPECIAL, SPECIAL]), Flags::empty()).unwrap();
        let found = bytes(app, &found);
        assert_eq!(BlasObject::read(&found).unwrap().geometry(0).unwrap().micromap(), Some(0));
        let error = app.build_triangles_ext(&null(&MAPS), Flags::empty());
        assert!(stopped(error).contains("MicromapEXT>.indexBuffer[0]: 3 is no special index"));
    });
}

#[test]
fn displacement_is_not_simulated() {
    with(|app| {
        let build_info = vk::MicromapBuildInfo { ty: vk::MicromapType::DISPLACEMENT_MICROMAP, ..Default::default() };
        let error = app.micromap_build_sizes(vk::AccelerationStructureBuildType::DEVICE, &build_info).unwrap_err();
        let AppError::Undefined(undefined) = error else { panic!("{error}") };
        assert!(undefined.is_unsupported());
        let text = "vkGetMicromapBuildSizesEXT: pBuildInfo->type: this device does not simulate displacement micromaps";
        assert_eq!(undefined.to_string(), text);
    });
}

/// Updates a structure in place from the same triangles with other micromaps.
fn update(
    app: &mut App<'_>,
    structure: &Structure,
    flags: Flags,
    binding: MicromapBindingExt<'_>,
) -> Result<(), AppError> {
    let mut uploaded = Vec::new();
    let (mut info, ranges) = app.triangles_info(&[(input(), Some(binding))], flags, &mut uploaded).unwrap();
    info.mode = vk::BuildAccelerationStructureMode::UPDATE;
    info.src_acceleration_structure = structure.handle;
    info.dst_acceleration_structure = structure.handle;
    info.scratch_data = app.buffer(4096, vk::BufferUsageFlags::STORAGE_BUFFER).unwrap().address.into();
    let (infos, build_range_infos) = (vec![info], vec![Some(ranges)]);
    app.submit(|command_buffer| vec![Call::CmdBuildAccelerationStructures { command_buffer, infos, build_range_infos }])
}

#[test]
fn flags_say_which_micromaps_an_update_may_bring() {
    let neither = Flags::ALLOW_UPDATE;
    let data = neither | Flags::ALLOW_OPACITY_MICROMAP_DATA_UPDATE;
    let full = neither | Flags::ALLOW_OPACITY_MICROMAP_UPDATE;
    for (flags, other, null) in [(neither, false, false), (data, true, false), (full, true, true)] {
        with(|app| {
            let first = micromap_of(app, &DATA);
            let same = micromap_of(app, &DATA);
            let second = micromap_of(app, &[0b1001, 0x1b, 0xe4, 0x00, 0xff, 0b10]);
            let structure = app.build_triangles_ext(&[(input(), Some(attach(Some(&first), &MAPS)))], flags).unwrap();
            let maps = [SPECIAL, TriangleMap::Triangle(0)];
            update(app, &structure, flags, attach(Some(&first), &maps)).unwrap();
            update(app, &structure, flags, attach(Some(&same), &MAPS)).unwrap();
            let result = update(app, &structure, flags, attach(Some(&second), &MAPS));
            assert_eq!(result.is_ok(), other, "{flags:?}: {result:?}");
            let result = update(app, &structure, flags, attach(None, &[SPECIAL, SPECIAL]));
            assert_eq!(result.is_ok(), null, "{flags:?}: {result:?}");
        });
    }
}
