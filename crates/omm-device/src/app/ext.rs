//! Micromap objects of the EXT extension: built, copied, serialized and attached, on the device and on the host.

use omm_layout::index::IndexType;
use omm_layout::{index_buffer, triangle};
use omm_model::call::{Call, Output};
use omm_model::special_index::TriangleMap;
use omm_model::usage::{self, MicromapUsage};
use omm_model::vk;
use omm_serialize::ByteOrder;
use omm_serialize::blob::Prefix;

use super::{App, AppError, Buffer, DEVICE, MicromapInput};

/// A micromap object with a buffer of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MicromapExt {
    /// The micromap.
    pub handle: vk::Micromap,
    /// Bytes that it was created with.
    pub size: u64,
    /// What it lies in, from the first byte on.
    pub buffer: Buffer,
}

/// A micromap object attached to a geometry.
#[derive(Clone, Copy, Debug)]
pub struct MicromapBindingExt<'a> {
    /// The micromap; `None` where every triangle has a special index.
    pub micromap: Option<&'a MicromapExt>,
    /// What each triangle has.
    pub maps: &'a [TriangleMap],
    /// How indices are stored.
    pub index_type: IndexType,
    /// How many triangles of the geometry use which level and format.
    pub usages: &'a [MicromapUsage],
}

fn raw_usages(usages: &[MicromapUsage]) -> Vec<vk::MicromapUsageExt> {
    let raw = |usage: &MicromapUsage| vk::MicromapUsageExt {
        count: usage.count,
        subdivision_level: usage.subdivision_level.get(),
        format: usage.format.value().into(),
    };
    usages.iter().map(raw).collect()
}

/// The flags of a micromap build, which the two extensions number differently.
fn build_flags(flags: vk::BuildAccelerationStructureFlags) -> vk::BuildMicromapFlags {
    use vk::{BuildAccelerationStructureFlags as Khr, BuildMicromapFlags as Ext};
    let pairs = [
        (Khr::PREFER_FAST_TRACE, Ext::PREFER_FAST_TRACE),
        (Khr::PREFER_FAST_BUILD, Ext::PREFER_FAST_BUILD),
        (Khr::ALLOW_COMPACTION, Ext::ALLOW_COMPACTION),
    ];
    pairs.into_iter().filter(|(khr, _)| flags.contains(*khr)).map(|(_, ext)| ext).collect()
}

impl App<'_> {
    /// Creates a micromap object in a new buffer, which the host can map.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn create_micromap_ext(&mut self, size: u64) -> Result<MicromapExt, AppError> {
        let buffer = self.host_buffer(size, vk::BufferUsageFlags::MICROMAP_STORAGE)?;
        let (handle, size) = (vk::Micromap(self.handle()), buffer.size);
        let create_info = vk::MicromapCreateInfo { buffer: buffer.buffer, size, ..Default::default() };
        self.call(&Call::CreateMicromap { device: DEVICE, create_info, micromap: handle })?;
        Ok(MicromapExt { handle, size, buffer })
    }

    /// Destroys a micromap object and its buffer.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn destroy_micromap_ext(&mut self, micromap: MicromapExt) -> Result<(), AppError> {
        self.call(&Call::DestroyMicromap { device: DEVICE, micromap: micromap.handle })?;
        self.destroy(micromap.buffer)
    }

    /// The sizes that a micromap build needs.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn micromap_build_sizes(
        &mut self,
        build_type: vk::AccelerationStructureBuildType,
        build_info: &vk::MicromapBuildInfo,
    ) -> Result<vk::MicromapBuildSizesInfo, AppError> {
        let call = Call::GetMicromapBuildSizes { device: DEVICE, build_type, build_info: build_info.clone() };
        match self.call(&call)? {
            Output::MicromapBuildSizes(sizes) => Ok(sizes),
            found => Err(AppError::Output { command: call.command(), found }),
        }
    }

    /// Uploads and builds a micromap object on the device. The uploaded input is freed again.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn build_micromap_ext(&mut self, input: &MicromapInput<'_>) -> Result<MicromapExt, AppError> {
        let &MicromapInput { data, triangles, flags } = input;
        let array: Vec<u8> = triangles.iter().flat_map(|&entry| triangle::encode(&entry.into())).collect();
        let usage = vk::BufferUsageFlags::MICROMAP_BUILD_INPUT_READ_ONLY;
        let (data, array) = (self.upload(data, usage)?, self.upload(&array, usage)?);
        let mut info = vk::MicromapBuildInfo {
            flags: build_flags(flags),
            usage_counts: Some(raw_usages(&usage::histogram(triangles.iter().copied()))),
            data: data.address.into(),
            triangle_array: array.address.into(),
            triangle_array_stride: triangle::SIZE as u64,
            ..Default::default()
        };
        let sizes = self.micromap_build_sizes(vk::AccelerationStructureBuildType::DEVICE, &info)?;
        let micromap = self.create_micromap_ext(sizes.micromap_size)?;
        let scratch = self.buffer(sizes.build_scratch_size, vk::BufferUsageFlags::STORAGE_BUFFER)?;
        info.dst_micromap = micromap.handle;
        info.scratch_data = scratch.address.into();
        self.submit(|command_buffer| vec![Call::CmdBuildMicromaps { command_buffer, infos: vec![info] }])?;
        for buffer in [scratch, data, array] {
            self.destroy(buffer)?;
        }
        Ok(micromap)
    }

    /// What a build of a micromap object by a host command is called with: input in host memory, a new micromap, and scratch
    /// memory. The host memory stays.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn host_micromap_info(
        &mut self,
        input: &MicromapInput<'_>,
    ) -> Result<(vk::MicromapBuildInfo, MicromapExt), AppError> {
        let &MicromapInput { data, triangles, flags } = input;
        let array: Vec<u8> = triangles.iter().flat_map(|&entry| triangle::encode(&entry.into())).collect();
        let mut info = vk::MicromapBuildInfo {
            flags: build_flags(flags),
            usage_counts: Some(raw_usages(&usage::histogram(triangles.iter().copied()))),
            data: self.upload_host(data)?.into(),
            triangle_array: self.upload_host(&array)?.into(),
            triangle_array_stride: triangle::SIZE as u64,
            ..Default::default()
        };
        let sizes = self.micromap_build_sizes(vk::AccelerationStructureBuildType::HOST, &info)?;
        let micromap = self.create_micromap_ext(sizes.micromap_size)?;
        info.dst_micromap = micromap.handle;
        let size = usize::try_from(sizes.build_scratch_size).unwrap_or_default();
        info.scratch_data = self.upload_host(&vec![0; size])?.into();
        Ok((info, micromap))
    }

    /// One size of a built micromap object, asked for on the host.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn micromap_property(&mut self, micromap: &MicromapExt, query_type: vk::QueryType) -> Result<u64, AppError> {
        let (data_size, stride) = (8, 8);
        let micromaps = vec![micromap.handle];
        let call = Call::WriteMicromapsProperties { device: DEVICE, micromaps, query_type, data_size, stride };
        match self.call(&call)? {
            Output::Properties(values) => Ok(values.first().copied().unwrap_or_default()),
            found => Err(AppError::Output { command: call.command(), found }),
        }
    }

    /// Clones or compacts a micromap object, on the device, into a new one that is as large as it must be.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn copy_micromap_ext(
        &mut self,
        source: &MicromapExt,
        mode: vk::CopyMicromapMode,
    ) -> Result<MicromapExt, AppError> {
        let size = match mode {
            vk::CopyMicromapMode::COMPACT => self.micromap_property(source, vk::QueryType::MICROMAP_COMPACTED_SIZE)?,
            _ => source.size,
        };
        let copy = self.create_micromap_ext(size)?;
        let info = vk::CopyMicromapInfo { src: source.handle, dst: copy.handle, mode, ..Default::default() };
        self.submit(|command_buffer| vec![Call::CmdCopyMicromap { command_buffer, info }])?;
        Ok(copy)
    }

    /// A micromap object's serialized form, made on the device.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn serialize_micromap_ext(&mut self, source: &MicromapExt) -> Result<Vec<u8>, AppError> {
        let size = self.micromap_property(source, vk::QueryType::MICROMAP_SERIALIZATION_SIZE)?;
        let target = self.buffer(size, vk::BufferUsageFlags::TRANSFER_DST)?;
        let info = vk::CopyMicromapToMemoryInfo {
            src: source.handle,
            dst: target.address.into(),
            mode: vk::CopyMicromapMode::SERIALIZE,
            ..Default::default()
        };
        self.submit(|command_buffer| vec![Call::CmdCopyMicromapToMemory { command_buffer, info }])?;
        let blob = self.download(&target)?;
        self.destroy(target)?;
        Ok(blob)
    }

    /// Makes a micromap object of serialized data, on the device.
    ///
    /// # Errors
    /// Data of another driver or version; otherwise as [`App::call`].
    pub fn deserialize_micromap_ext(&mut self, blob: &[u8]) -> Result<MicromapExt, AppError> {
        if !self.is_compatible(blob)? {
            return Err(AppError::Incompatible);
        }
        let micromap = self.create_micromap_ext(Prefix::read(blob, ByteOrder::Little)?.deserialized_size)?;
        let source = self.upload(blob, vk::BufferUsageFlags::TRANSFER_SRC)?;
        let info = vk::CopyMemoryToMicromapInfo {
            src: source.address.into(),
            dst: micromap.handle,
            mode: vk::CopyMicromapMode::DESERIALIZE,
            ..Default::default()
        };
        self.submit(|command_buffer| vec![Call::CmdCopyMemoryToMicromap { command_buffer, info }])?;
        self.destroy(source)?;
        Ok(micromap)
    }

    /// The structure that attaches a micromap object; its index buffer is uploaded.
    pub(super) fn attached(
        &mut self,
        binding: &MicromapBindingExt<'_>,
        uploaded: &mut Vec<Buffer>,
    ) -> Result<vk::TrianglesOpacityMicromapExt, AppError> {
        let &MicromapBindingExt { micromap, maps, index_type, usages } = binding;
        let mut attached = vk::TrianglesOpacityMicromapExt {
            index_type: index_type.into(),
            index_stride: index_type.size().into(),
            usage_counts: Some(raw_usages(usages)),
            micromap: micromap.map_or(vk::Micromap::NULL, |micromap| micromap.handle),
            ..Default::default()
        };
        if index_type != IndexType::None {
            let buffer = self.upload_input(&index_buffer::write(maps, index_type, 0)?)?;
            attached.index_buffer = buffer.address.into();
            uploaded.push(buffer);
        }
        Ok(attached)
    }
}
