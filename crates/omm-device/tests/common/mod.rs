//! Small scenes that several tests build.

#![allow(dead_code)]

use omm_device::Device;
use omm_device::app::{App, AppError, MicromapInput, Structure};
use omm_layout::object::Object;
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::memory::MemoryView;
use omm_model::profile::DeviceProfile;
use omm_model::triangle::MicromapTriangle;
use omm_model::vk;

/// A heap that a test can fill.
pub(crate) fn device() -> Device {
    Device::with_heap_size(DeviceProfile::reference(), 1 << 26)
}

pub(crate) fn triangle(data_offset: u32, level: u32, format: OpacityMicromapFormat) -> MicromapTriangle {
    MicromapTriangle { data_offset, subdivision_level: SubdivisionLevel::new(level).unwrap(), format }
}

/// Four triangles: levels 1, 2, 0 and 1, the last with the data of the first.
pub(crate) fn micromap(app: &mut App<'_>) -> Structure {
    let (two, four) = (OpacityMicromapFormat::TwoState, OpacityMicromapFormat::FourState);
    let triangles = [triangle(0, 1, two), triangle(1, 2, four), triangle(5, 0, four), triangle(0, 1, two)];
    let data = [0b0110, 0x1b, 0xe4, 0x00, 0xff, 0b01];
    let flags = vk::BuildAccelerationStructureFlags::ALLOW_COMPACTION;
    app.build_micromap(&MicromapInput { data: &data, triangles: &triangles, flags }).unwrap()
}

/// The bytes of what a structure holds.
pub(crate) fn bytes(app: &App<'_>, structure: &Structure) -> Vec<u8> {
    let all = app.device().read(structure.address, structure.size).unwrap();
    Object::read(all).unwrap().as_bytes().to_vec()
}

/// One geometry of triangles.
pub(crate) fn triangles_geometry(triangles: vk::GeometryTrianglesData) -> vk::Geometry {
    vk::Geometry {
        geometry_type: vk::GeometryType::TRIANGLES,
        geometry: vk::GeometryData::Triangles(triangles),
        ..Default::default()
    }
}

/// The input of a bottom-level build.
pub(crate) fn bottom_level(geometries: Vec<vk::Geometry>) -> vk::BuildGeometryInfo {
    vk::BuildGeometryInfo {
        ty: vk::AccelerationStructureType::BOTTOM_LEVEL,
        geometries: Some(geometries),
        ..Default::default()
    }
}

/// The bytes of 32-bit floats.
pub(crate) fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// Tightly packed vertices of three floats.
pub(crate) fn vertices(app: &mut App<'_>, numbers: &[f32]) -> vk::GeometryTrianglesData {
    let address = app.upload_input(&floats(numbers)).unwrap().address;
    vk::GeometryTrianglesData {
        vertex_format: vk::Format::R32G32B32_SFLOAT,
        vertex_data: address.into(),
        vertex_stride: 12,
        max_vertex: (numbers.len() as u32 / 3).saturating_sub(1),
        index_type: vk::IndexType::NONE,
        ..Default::default()
    }
}

/// Why a build stopped, as text.
pub(crate) fn stopped(result: Result<Structure, AppError>) -> String {
    match result.unwrap_err() {
        AppError::Undefined(undefined) => undefined.to_string(),
        other => panic!("{other}"),
    }
}
