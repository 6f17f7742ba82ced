//! What an application builds from: opacity data, meshes, instances.

use omm_layout::index::IndexType;
use omm_layout::{index_buffer, instance, triangle};
use omm_model::special_index::TriangleMap;
use omm_model::triangle::MicromapTriangle;
use omm_model::usage;
use omm_model::vk;

use super::ext::MicromapBindingExt;
use super::structure::Structure;
use super::{App, AppError, Buffer};

/// What a micromap is built from. Usage counts follow from the triangles.
#[derive(Clone, Copy, Debug)]
pub struct MicromapInput<'a> {
    /// Packed elements.
    pub data: &'a [u8],
    /// Level, format and place of each triangle's elements.
    pub triangles: &'a [MicromapTriangle],
    /// Flags of the build.
    pub flags: vk::BuildAccelerationStructureFlags,
}

/// One geometry of indexed triangles.
#[derive(Clone, Copy, Debug)]
pub struct TriangleInput<'a> {
    /// Vertices.
    pub positions: &'a [[f32; 3]],
    /// Three for each triangle.
    pub indices: &'a [u32],
    /// Flags of the geometry.
    pub flags: vk::GeometryFlags,
    /// The micromap, if any.
    pub micromap: Option<MicromapBinding<'a>>,
}

/// A micromap attached to a geometry.
#[derive(Clone, Copy, Debug)]
pub struct MicromapBinding<'a> {
    /// The micromap; `None` where every triangle has a special index.
    pub micromap: Option<&'a Structure>,
    /// What each triangle has.
    pub maps: &'a [TriangleMap],
    /// How indices are stored.
    pub index_type: IndexType,
}

impl App<'_> {
    /// Uploads and builds a micromap. The uploaded input is freed again.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn build_micromap(&mut self, input: &MicromapInput<'_>) -> Result<Structure, AppError> {
        let &MicromapInput { data, triangles, flags } = input;
        let array: Vec<u8> = triangles.iter().flat_map(|&entry| triangle::encode(&entry.into())).collect();
        let data = self.upload_input(data)?;
        let array = self.upload_input(&array)?;
        let usages = usage::histogram(triangles.iter().copied());
        let micromap_data = vk::GeometryMicromapData {
            usage_counts: Some(usages.into_iter().map(Into::into).collect()),
            data: data.address,
            triangle_array: array.address,
            triangle_array_stride: triangle::SIZE as u64,
            ..Default::default()
        };
        let geometry = vk::Geometry {
            next: vec![micromap_data.into()],
            geometry_type: vk::GeometryType::MICROMAP,
            ..Default::default()
        };
        let info = vk::BuildGeometryInfo {
            ty: vk::AccelerationStructureType::OPACITY_MICROMAP,
            flags,
            geometries: Some(vec![geometry]),
            ..Default::default()
        };
        let structure = self.build(info, None)?;
        self.destroy(data)?;
        self.destroy(array)?;
        Ok(structure)
    }

    /// Uploads and builds a bottom-level structure of triangles. The uploaded input is freed again.
    ///
    /// # Errors
    /// A micromap index that its type cannot hold; otherwise as [`App::call`].
    pub fn build_triangles(
        &mut self,
        inputs: &[TriangleInput<'_>],
        flags: vk::BuildAccelerationStructureFlags,
    ) -> Result<Structure, AppError> {
        let inputs: Vec<_> = inputs.iter().map(|&input| (input, None)).collect();
        self.build_triangles_ext(&inputs, flags)
    }

    /// Uploads and builds a bottom-level structure of triangles, to some of which micromap objects of the EXT extension are
    /// attached. The uploaded input is freed again.
    ///
    /// # Errors
    /// A micromap index that its type cannot hold; otherwise as [`App::call`].
    pub fn build_triangles_ext(
        &mut self,
        inputs: &[(TriangleInput<'_>, Option<MicromapBindingExt<'_>>)],
        flags: vk::BuildAccelerationStructureFlags,
    ) -> Result<Structure, AppError> {
        let mut uploaded = Vec::new();
        let (info, ranges) = self.triangles_info(inputs, flags, &mut uploaded)?;
        let structure = self.build(info, Some(ranges))?;
        uploaded.into_iter().try_for_each(|buffer| self.destroy(buffer))?;
        Ok(structure)
    }

    /// What such a build is called with, but for destination and scratch memory. Buffers with its input are added to `uploaded`.
    ///
    /// # Errors
    /// A micromap index that its type cannot hold; otherwise as [`App::call`].
    pub fn triangles_info(
        &mut self,
        inputs: &[(TriangleInput<'_>, Option<MicromapBindingExt<'_>>)],
        flags: vk::BuildAccelerationStructureFlags,
        uploaded: &mut Vec<Buffer>,
    ) -> Result<(vk::BuildGeometryInfo, Vec<vk::BuildRangeInfo>), AppError> {
        let (mut geometries, mut ranges) = (Vec::new(), Vec::new());
        for (input, ext) in inputs {
            let &TriangleInput { positions, indices, flags, micromap } = input;
            let vertices: Vec<u8> = positions.as_flattened().iter().flat_map(|number| number.to_le_bytes()).collect();
            let vertices = self.upload_input(&vertices)?;
            let index_bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
            let index_data = self.upload_input(&index_bytes)?;
            uploaded.extend([vertices, index_data]);
            let mut next = vk::Chain::new();
            if let Some(binding) = micromap {
                let MicromapBinding { micromap, maps, index_type } = binding;
                let mut attached = vk::TrianglesOpacityMicromap {
                    index_type: index_type.into(),
                    index_stride: index_type.size().into(),
                    micromap: micromap.map_or(vk::AccelerationStructure::NULL, |micromap| micromap.handle),
                    ..Default::default()
                };
                if index_type != IndexType::None {
                    let buffer = self.upload_input(&index_buffer::write(maps, index_type, 0)?)?;
                    attached.index_buffer = buffer.address;
                    uploaded.push(buffer);
                }
                next.push(attached.into());
            }
            if let Some(binding) = ext {
                next.push(self.attached(binding, uploaded)?.into());
            }
            let triangles = vk::GeometryTrianglesData {
                next,
                vertex_format: vk::Format::R32G32B32_SFLOAT,
                vertex_data: vertices.address.into(),
                vertex_stride: 12,
                max_vertex: count("vertices", positions.len())?.saturating_sub(1),
                index_type: vk::IndexType::UINT32,
                index_data: index_data.address.into(),
                ..Default::default()
            };
            let geometry = vk::GeometryData::Triangles(triangles);
            geometries.push(vk::Geometry {
                geometry_type: vk::GeometryType::TRIANGLES,
                geometry,
                flags,
                ..Default::default()
            });
            let primitive_count = count("triangles", indices.len() / 3)?;
            ranges.push(vk::BuildRangeInfo { primitive_count, ..Default::default() });
        }
        let info = vk::BuildGeometryInfo {
            ty: vk::AccelerationStructureType::BOTTOM_LEVEL,
            flags,
            geometries: Some(geometries),
            ..Default::default()
        };
        Ok((info, ranges))
    }

    /// Uploads and builds a top-level structure. The uploaded input is freed again.
    ///
    /// # Errors
    /// An instance with a field that has no room in its bytes; otherwise as [`App::call`].
    pub fn build_instances(
        &mut self,
        instances: &[vk::Instance],
        flags: vk::BuildAccelerationStructureFlags,
    ) -> Result<Structure, AppError> {
        let mut bytes = Vec::with_capacity(instances.len() * instance::SIZE);
        for (index, found) in instances.iter().enumerate() {
            let encoded = instance::encode(found).map_err(|error| error.within(format_args!("instances[{index}]")))?;
            bytes.extend_from_slice(&encoded);
        }
        let uploaded = self.upload_input(&bytes)?;
        let data = vk::GeometryInstancesData { data: uploaded.address.into(), ..Default::default() };
        let geometry = vk::Geometry {
            geometry_type: vk::GeometryType::INSTANCES,
            geometry: vk::GeometryData::Instances(data),
            ..Default::default()
        };
        let info = vk::BuildGeometryInfo {
            ty: vk::AccelerationStructureType::TOP_LEVEL,
            flags,
            geometries: Some(vec![geometry]),
            ..Default::default()
        };
        let primitive_count = count("instances", instances.len())?;
        let structure = self.build(info, Some(vec![vk::BuildRangeInfo { primitive_count, ..Default::default() }]))?;
        self.destroy(uploaded)?;
        Ok(structure)
    }
}

fn count(what: &'static str, found: usize) -> Result<u32, AppError> {
    u32::try_from(found).map_err(|_| AppError::Count { what, found })
}
