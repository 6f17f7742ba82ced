//! Host commands, at once and deferred.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::{bytes, device, floats, triangle};
use omm_device::app::{App, MicromapExt, MicromapInput};
use omm_device::{Device, Reason};
use omm_layout::object::{Object, TlasObject};
use omm_model::call::{Call, Output};
use omm_model::format::OpacityMicromapFormat;
use omm_model::memory::MemoryView;
use omm_model::vk;

const DEVICE: vk::Device = vk::Device(1);
const NULL: vk::DeferredOperation = vk::DeferredOperation::NULL;

fn result(result: vk::Result) -> Output {
    Output::Result(result)
}

/// The input of a micromap; every `seed` makes another.
fn with_input<R>(seed: u8, with: impl FnOnce(&MicromapInput<'_>) -> R) -> R {
    let data: Vec<u8> = (0..=255_u8).map(|byte| byte.wrapping_mul(0x5d) ^ seed).collect();
    let triangles = [3, 4, 2].map(|level| triangle(0, level, OpacityMicromapFormat::FourState));
    let flags = vk::BuildAccelerationStructureFlags::ALLOW_COMPACTION;
    with(&MicromapInput { data: &data, triangles: &triangles, flags })
}

fn held(device: &Device, micromap: &MicromapExt) -> Vec<u8> {
    let all = device.read(micromap.buffer.address, micromap.size).unwrap();
    Object::read(all).map(|object| object.as_bytes().to_vec()).unwrap_or_default()
}

#[test]
fn host_and_device_build_the_same() {
    let (mut device, mut observer) = (device(), ());
    let mut app = App::new(&mut device, &mut observer);
    let (info, host) = with_input(1, |input| app.host_micromap_info(input).unwrap());
    let built = with_input(1, |input| app.build_micromap_ext(input).unwrap());
    let call = Call::BuildMicromaps { device: DEVICE, deferred_operation: NULL, infos: vec![info] };
    assert_eq!(app.call(&call).unwrap(), Output::None);
    assert_eq!(held(app.device(), &host), held(app.device(), &built));

    // Copies and serialized data likewise.
    let copy = app.create_micromap_ext(host.size).unwrap();
    let mode = vk::CopyMicromapMode::COMPACT;
    let info = vk::CopyMicromapInfo { src: host.handle, dst: copy.handle, mode, ..Default::default() };
    app.call(&Call::CopyMicromap { device: DEVICE, deferred_operation: NULL, info }).unwrap();
    let other = app.copy_micromap_ext(&built, mode).unwrap();
    assert_eq!(held(app.device(), &copy), held(app.device(), &other));
    let blob = app.serialize_micromap_ext(&other).unwrap();
    let dst = app.upload_host(&vec![0; blob.len()]).unwrap();
    let mode = vk::CopyMicromapMode::SERIALIZE;
    let info = vk::CopyMicromapToMemoryInfo { src: copy.handle, dst: dst.into(), mode, ..Default::default() };
    app.call(&Call::CopyMicromapToMemory { device: DEVICE, deferred_operation: NULL, info }).unwrap();
    assert_eq!(app.device().read_host(dst, blob.len() as u64).unwrap(), blob);
    let mode = vk::CopyMicromapMode::DESERIALIZE;
    let info = vk::CopyMemoryToMicromapInfo { src: dst.into(), dst: host.handle, mode, ..Default::default() };
    app.call(&Call::CopyMemoryToMicromap { device: DEVICE, deferred_operation: NULL, info }).unwrap();
    assert_eq!(held(app.device(), &host), held(app.device(), &other));
}

#[test]
fn acceleration_structures_are_built_from_host_memory() {
    let (mut device, mut observer) = (device(), ());
    let mut app = App::new(&mut device, &mut observer);
    let vertices = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let mut triangles = vk::GeometryTrianglesData {
        vertex_format: vk::Format::R32G32B32_SFLOAT,
        vertex_data: app.upload_input(&vertices).unwrap().address.into(),
        vertex_stride: 12,
        max_vertex: 2,
        index_type: vk::IndexType::NONE,
        index_data: vk::HostAddress(0).into(),
        transform_data: vk::HostAddress(0).into(),
        ..Default::default()
    };
    let ranges = vec![vk::BuildRangeInfo { primitive_count: 1, ..Default::default() }];
    let info = common::bottom_level(vec![common::triangles_geometry(triangles.clone())]);
    let on_device = app.build(info, Some(ranges.clone())).unwrap();
    triangles.vertex_data = app.upload_host(&vertices).unwrap().into();
    let info = common::bottom_level(vec![common::triangles_geometry(triangles)]);
    let (bottom, address) = build(&mut app, info, ranges.clone());
    let built = app.device().read(address, 4096).unwrap();
    assert_eq!(Object::read(built).unwrap().as_bytes(), bytes(&app, &on_device));

    // Instances in host memory name structures by handle.
    let instance = vk::Instance { acceleration_structure_reference: bottom.0, ..Default::default() };
    let instance = omm_layout::instance::encode(&instance).unwrap();
    let data = app.upload_host(&instance).unwrap().into();
    let geometry = vk::Geometry {
        geometry_type: vk::GeometryType::INSTANCES,
        geometry: vk::GeometryData::Instances(vk::GeometryInstancesData { data, ..Default::default() }),
        ..Default::default()
    };
    let geometries = Some(vec![geometry]);
    let info = vk::BuildGeometryInfo { ty: vk::AccelerationStructureType::TOP_LEVEL, geometries, ..Default::default() };
    let (_, top) = build(&mut app, info, ranges);
    let top = TlasObject::read(app.device().read(top, 4096).unwrap()).unwrap();
    assert_eq!(top.references().collect::<Vec<_>>(), [address.0]);
}

/// Builds into a new generic structure on the host.
fn build(
    app: &mut App<'_>,
    mut info: vk::BuildGeometryInfo,
    ranges: Vec<vk::BuildRangeInfo>,
) -> (vk::AccelerationStructure, vk::DeviceAddress) {
    let buffer = app.host_buffer(4096, vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE).unwrap();
    let acceleration_structure = vk::AccelerationStructure(app.device().unused_handle());
    let create_info = vk::AccelerationStructureCreateInfo {
        buffer: buffer.buffer,
        size: 4096,
        ty: vk::AccelerationStructureType::GENERIC,
        ..Default::default()
    };
    app.call(&Call::CreateAccelerationStructure { device: DEVICE, create_info, acceleration_structure }).unwrap();
    info.dst_acceleration_structure = acceleration_structure;
    info.scratch_data = app.upload_host(&[0; 1024]).unwrap().into();
    let (infos, build_range_infos) = (vec![info], vec![Some(ranges)]);
    let call = Call::BuildAccelerationStructures { device: DEVICE, deferred_operation: NULL, infos, build_range_infos };
    app.call(&call).unwrap();
    (acceleration_structure, buffer.address)
}

/// A device with deferred builds of `builds` micromaps on one operation.
fn deferred(builds: u8) -> (Device, vk::DeferredOperation, Vec<MicromapExt>) {
    let (mut device, mut observer) =
        (Device::with_heap_size(omm_model::profile::DeviceProfile::reference(), 1 << 26), ());
    let mut app = App::new(&mut device, &mut observer);
    let new = (0..builds).map(|seed| with_input(seed, |input| app.host_micromap_info(input).unwrap()));
    let (infos, micromaps): (Vec<_>, Vec<_>) = new.unzip();
    let operation = vk::DeferredOperation(app.device().unused_handle());
    app.call(&Call::CreateDeferredOperation { device: DEVICE, deferred_operation: operation }).unwrap();
    let call = Call::BuildMicromaps { device: DEVICE, deferred_operation: operation, infos };
    assert_eq!(app.call(&call).unwrap(), result(vk::Result::OPERATION_DEFERRED));
    (device, operation, micromaps)
}

#[test]
fn an_operation_goes_from_free_to_pending_to_complete() {
    let (mut device, operation, micromaps) = deferred(3);
    let mut call = |call: Call| device.execute(&call).unwrap();
    let concurrency = || Call::GetDeferredOperationMaxConcurrency { device: DEVICE, operation };
    let asked = || Call::GetDeferredOperationResult { device: DEVICE, operation };
    assert_eq!(call(concurrency()), Output::MaxConcurrency(3));
    assert_eq!(call(asked()), result(vk::Result::NOT_READY));
    assert_eq!(call(Call::DeferredOperationJoin { device: DEVICE, operation }), Output::None);
    assert_eq!(call(concurrency()), Output::MaxConcurrency(0));
    assert_eq!(call(asked()), Output::None);
    assert_eq!(call(Call::DeferredOperationJoin { device: DEVICE, operation }), Output::None);
    let nothing = Call::BuildMicromaps { device: DEVICE, deferred_operation: operation, infos: Vec::new() };
    assert_eq!(call(nothing), result(vk::Result::OPERATION_NOT_DEFERRED));
    assert_eq!(call(Call::DestroyDeferredOperation { device: DEVICE, operation }), Output::None);
    assert!(micromaps.iter().all(|micromap| !held(&device, micromap).is_empty()));
}

#[test]
fn threads_that_join_make_the_same_bytes() {
    let (mut alone, operation, micromaps) = deferred(12);
    alone.join(operation).unwrap();
    alone.settle();
    let expected: Vec<_> = micromaps.iter().map(|micromap| held(&alone, micromap)).collect();
    assert!(expected.iter().all(|bytes| !bytes.is_empty()));
    for _ in 0..8 {
        let (mut device, operation, micromaps) = deferred(12);
        let results: Vec<Output> = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..4).map(|_| scope.spawn(|| device.join(operation).unwrap())).collect();
            threads.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        assert!(results.contains(&Output::None), "{results:?}");
        device.settle();
        assert_eq!(micromaps.iter().map(|micromap| held(&device, micromap)).collect::<Vec<_>>(), expected);
    }
}

#[test]
fn a_deferred_command_stops_while_it_is_joined() {
    let (mut device, operation, micromaps) = deferred(2);
    let gone = micromaps[1].handle;
    device.execute(&Call::DestroyMicromap { device: DEVICE, micromap: gone }).unwrap();
    for _ in 0..2 {
        let undefined = device.execute(&Call::DeferredOperationJoin { device: DEVICE, operation }).unwrap_err();
        assert_eq!((undefined.command, undefined.at.as_str()), ("vkBuildMicromapsEXT", "pInfos[1].dstMicromap"));
        assert_eq!(undefined.why, Reason::UnknownHandle { object: "micromap", handle: gone.0 });
        assert!(held(&device, &micromaps[0]).is_empty());
    }
    let asked = device.execute(&Call::GetDeferredOperationResult { device: DEVICE, operation });
    assert_eq!(asked, Ok(result(vk::Result::NOT_READY)));
}

#[test]
fn what_one_build_writes_no_other_touches() {
    let (mut device, mut observer) = (device(), ());
    let mut app = App::new(&mut device, &mut observer);
    let (info, _) = with_input(1, |input| app.host_micromap_info(input).unwrap());
    let infos = vec![info.clone(), info];
    let error = app.call(&Call::BuildMicromaps { device: DEVICE, deferred_operation: NULL, infos });
    let text = "vkBuildMicromapsEXT: pInfos[1].dstMicromap: its memory overlaps that of pInfos[0].dstMicromap";
    assert_eq!(error.unwrap_err().to_string(), text);
}
