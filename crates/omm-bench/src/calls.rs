//! Valid calls for a validator to look at, and the program that leads up to them.

use omm_model::call::{Call, Output};
use omm_model::memory::MemoryRange;
use omm_model::profile::DeviceProfile;
use omm_model::vk;
use omm_validate::Validator;

const DEVICE: vk::Device = vk::Device(1);
const QUEUE: vk::Queue = vk::Queue(2);
const POOL: vk::CommandPool = vk::CommandPool(3);
const COMMAND_BUFFER: vk::CommandBuffer = vk::CommandBuffer(4);
const INPUT: vk::Buffer = vk::Buffer(5);
const STORAGE: vk::Buffer = vk::Buffer(6);
const SCRATCH: vk::Buffer = vk::Buffer(7);
const ATTACHED: vk::AccelerationStructure = vk::AccelerationStructure(0x10);
const ATTACHED_EXT: vk::Micromap = vk::Micromap(0x11);
const OBJECT_EXT: vk::Micromap = vk::Micromap(0x12);
/// Handles from here on are those of structures that calls build.
const FIRST_TARGET: u64 = 0x100;

/// Buffers are so far apart.
const SPACING: u64 = 1 << 32;
/// Bytes of an acceleration structure, of a micromap object and of scratch memory.
const OBJECT: u64 = 1 << 16;
/// Structures that there are to build.
const TARGETS: u64 = 64;

/// A validator that has seen a program, and the input that the program's calls read.
///
/// The program has created buffers and structures, built a micromap of each extension, and records into a command buffer.
#[derive(Debug)]
pub struct Program {
    /// Has seen all that leads up to the next call.
    pub validator: Validator,
    input: Vec<u8>,
    triangles: u32,
}

/// Where the parts of the input begin.
#[derive(Clone, Copy, Debug)]
struct Input {
    data: u64,
    indices: u64,
    vertices: u64,
    end: u64,
}

impl Input {
    /// Eight bytes for each entry of the triangle array, one of opacity, four of index; vertices are not read.
    fn of(triangles: u32) -> Self {
        let triangles = u64::from(triangles);
        let data = (8 * triangles).next_multiple_of(256);
        let indices = (data + triangles).next_multiple_of(256);
        let vertices = (indices + 4 * triangles).next_multiple_of(256);
        Self { data, indices, vertices, end: vertices + 36 * triangles }
    }
}

const fn address_of(buffer: vk::Buffer) -> u64 {
    SPACING * buffer.0
}

impl Program {
    /// A program whose micromaps have that many triangles, all of level 1 with four states, and whose meshes have as many.
    #[must_use]
    pub fn new(triangles: u32) -> Self {
        let place = Input::of(triangles);
        let mut input = vec![0; place.end as usize];
        for (index, entry) in (0..triangles).zip(input.chunks_exact_mut(8)) {
            let entry: &mut [u8] = entry;
            entry[..4].copy_from_slice(&index.to_le_bytes());
            entry[4..].copy_from_slice(&[1, 0, 2, 0]);
        }
        let indices = &mut input[place.indices as usize..place.vertices as usize];
        for (index, entry) in (0..triangles).zip(indices.chunks_exact_mut(4)) {
            entry.copy_from_slice(&index.to_le_bytes());
        }
        let mut program = Self { validator: Validator::new(DeviceProfile::reference()), input, triangles };
        program.make();
        program
    }

    /// The memory that calls read.
    #[must_use]
    pub fn memory(&self) -> MemoryRange<'_> {
        MemoryRange { address: vk::DeviceAddress(address_of(INPUT)), bytes: &self.input }
    }

    /// A call of each kind, with its name.
    #[must_use]
    pub fn calls(&self) -> [(&'static str, Call); 5] {
        [
            ("micromap, 1 geometry, 1 usage", self.build_micromap()),
            ("EXT micromap, 1 usage", self.build_micromap_ext()),
            ("mesh with micromap", self.build_mesh()),
            ("mesh with EXT micromap", self.build_mesh_ext()),
            ("16 meshes of 8 geometries", self.build_meshes(16, 8)),
        ]
    }

    /// Builds a micromap of the KHR extension: one geometry, one usage.
    #[must_use]
    pub fn build_micromap(&self) -> Call {
        let target = vk::AccelerationStructure(FIRST_TARGET);
        Self::build(vec![(self.micromap_info(target), None)])
    }

    /// Builds a micromap object of the EXT extension: one usage.
    #[must_use]
    pub fn build_micromap_ext(&self) -> Call {
        Call::CmdBuildMicromaps { command_buffer: COMMAND_BUFFER, infos: vec![self.micromap_info_ext(OBJECT_EXT)] }
    }

    /// Builds a mesh with a micromap of the KHR extension attached.
    #[must_use]
    pub fn build_mesh(&self) -> Call {
        Self::build(vec![self.mesh(1, 1, &self.attached())])
    }

    /// Builds a mesh with a micromap object of the EXT extension attached.
    #[must_use]
    pub fn build_mesh_ext(&self) -> Call {
        Self::build(vec![self.mesh(1, 1, &self.attached_ext())])
    }

    /// Builds that many meshes of that many geometries each, every one with the micromap attached.
    ///
    /// There are structures for 63 meshes, one less than can be built.
    #[must_use]
    pub fn build_meshes(&self, meshes: u64, geometries: usize) -> Call {
        Self::build((1..=meshes.min(TARGETS - 1)).map(|mesh| self.mesh(mesh, geometries, &self.attached())).collect())
    }

    fn build(builds: Vec<(vk::BuildGeometryInfo, Option<Vec<vk::BuildRangeInfo>>)>) -> Call {
        let (infos, build_range_infos) = builds.into_iter().unzip();
        Call::CmdBuildAccelerationStructures { command_buffer: COMMAND_BUFFER, infos, build_range_infos }
    }

    fn input_at(&self, offset: impl FnOnce(Input) -> u64) -> vk::DeviceAddress {
        vk::DeviceAddress(address_of(INPUT) + offset(Input::of(self.triangles)))
    }

    fn micromap_info(&self, target: vk::AccelerationStructure) -> vk::BuildGeometryInfo {
        let usage = vk::MicromapUsage {
            count: self.triangles,
            subdivision_level: 1,
            format: vk::OpacityMicromapFormat::FOUR_STATE,
        };
        let data = vk::GeometryMicromapData {
            usage_counts: Some(vec![usage]),
            data: self.input_at(|input| input.data),
            triangle_array: self.input_at(|_| 0),
            triangle_array_stride: 8,
            ..Default::default()
        };
        let geometry =
            vk::Geometry { next: vec![data.into()], geometry_type: vk::GeometryType::MICROMAP, ..Default::default() };
        vk::BuildGeometryInfo {
            ty: vk::AccelerationStructureType::OPACITY_MICROMAP,
            dst_acceleration_structure: target,
            geometries: Some(vec![geometry]),
            scratch_data: vk::DeviceAddress(address_of(SCRATCH)).into(),
            ..Default::default()
        }
    }

    fn usage_ext(&self) -> vk::MicromapUsageExt {
        vk::MicromapUsageExt { count: self.triangles, subdivision_level: 1, format: 2 }
    }

    fn micromap_info_ext(&self, dst_micromap: vk::Micromap) -> vk::MicromapBuildInfo {
        vk::MicromapBuildInfo {
            dst_micromap,
            usage_counts: Some(vec![self.usage_ext()]),
            data: self.input_at(|input| input.data).into(),
            scratch_data: vk::DeviceAddress(address_of(SCRATCH)).into(),
            triangle_array: self.input_at(|_| 0).into(),
            triangle_array_stride: 8,
            ..Default::default()
        }
    }

    fn attached(&self) -> vk::ChainStructure {
        let attached = vk::TrianglesOpacityMicromap {
            index_type: vk::IndexType::UINT32,
            index_buffer: self.input_at(|input| input.indices),
            index_stride: 4,
            micromap: ATTACHED,
            ..Default::default()
        };
        attached.into()
    }

    fn attached_ext(&self) -> vk::ChainStructure {
        let attached = vk::TrianglesOpacityMicromapExt {
            index_type: vk::IndexType::UINT32,
            index_buffer: self.input_at(|input| input.indices).into(),
            index_stride: 4,
            usage_counts: Some(vec![self.usage_ext()]),
            micromap: ATTACHED_EXT,
            ..Default::default()
        };
        attached.into()
    }

    /// A mesh for the target of that number.
    fn mesh(
        &self,
        target: u64,
        geometries: usize,
        attached: &vk::ChainStructure,
    ) -> (vk::BuildGeometryInfo, Option<Vec<vk::BuildRangeInfo>>) {
        let triangles = vk::GeometryTrianglesData {
            next: vec![attached.clone()],
            vertex_format: vk::Format::R32G32B32_SFLOAT,
            vertex_data: self.input_at(|input| input.vertices).into(),
            vertex_stride: 12,
            max_vertex: (3 * self.triangles).saturating_sub(1),
            index_type: vk::IndexType::NONE,
            ..Default::default()
        };
        let geometry = vk::Geometry {
            geometry_type: vk::GeometryType::TRIANGLES,
            geometry: vk::GeometryData::Triangles(triangles),
            ..Default::default()
        };
        let info = vk::BuildGeometryInfo {
            ty: vk::AccelerationStructureType::BOTTOM_LEVEL,
            dst_acceleration_structure: vk::AccelerationStructure(FIRST_TARGET + target),
            geometries: Some(vec![geometry; geometries]),
            scratch_data: vk::DeviceAddress(address_of(SCRATCH) + OBJECT * target).into(),
            ..Default::default()
        };
        let range = vk::BuildRangeInfo { primitive_count: self.triangles, ..Default::default() };
        (info, Some(vec![range; geometries]))
    }

    fn track(&mut self, call: &Call) {
        self.validator.track(call, &Output::None);
    }

    /// The program up to the call.
    fn make(&mut self) {
        use vk::BufferUsageFlags as Usage;
        let input = Usage::MICROMAP_BUILD_INPUT_READ_ONLY | Usage::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY;
        let storage = Usage::MICROMAP_STORAGE | Usage::ACCELERATION_STRUCTURE_STORAGE;
        self.make_buffer(INPUT, self.input.len() as u64, input);
        self.make_buffer(STORAGE, (TARGETS + 3) * OBJECT, storage);
        self.make_buffer(SCRATCH, TARGETS * OBJECT, Usage::STORAGE_BUFFER);
        let ty = vk::AccelerationStructureType::OPACITY_MICROMAP;
        self.make_structure(ATTACHED, TARGETS, ty);
        self.make_structure(vk::AccelerationStructure(FIRST_TARGET), 0, ty);
        for target in 1..TARGETS {
            let handle = vk::AccelerationStructure(FIRST_TARGET + target);
            self.make_structure(handle, target, vk::AccelerationStructureType::BOTTOM_LEVEL);
        }
        for (place, micromap) in [(TARGETS + 1, ATTACHED_EXT), (TARGETS + 2, OBJECT_EXT)] {
            let create_info =
                vk::MicromapCreateInfo { buffer: STORAGE, offset: place * OBJECT, size: OBJECT, ..Default::default() };
            self.track(&Call::CreateMicromap { device: DEVICE, create_info, micromap });
        }
        self.make_command_buffer();
        self.begin();
        self.track(&Self::build(vec![(self.micromap_info(ATTACHED), None)]));
        let infos = vec![self.micromap_info_ext(ATTACHED_EXT)];
        self.track(&Call::CmdBuildMicromaps { command_buffer: COMMAND_BUFFER, infos });
        self.track(&Call::EndCommandBuffer { command_buffer: COMMAND_BUFFER });
        self.track(&Call::QueueSubmit { queue: QUEUE, command_buffers: vec![COMMAND_BUFFER] });
        self.begin();
    }

    fn make_buffer(&mut self, buffer: vk::Buffer, size: u64, usage: vk::BufferUsageFlags) {
        let usage = usage | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let create_info = vk::BufferCreateInfo { size, usage, ..Default::default() };
        self.track(&Call::CreateBuffer { device: DEVICE, create_info, buffer });
        let memory = vk::DeviceMemory(0x1000 + buffer.0);
        let allocate_info = vk::MemoryAllocateInfo { allocation_size: size, ..Default::default() };
        self.track(&Call::AllocateMemory { device: DEVICE, allocate_info, memory });
        self.track(&Call::BindBufferMemory { device: DEVICE, buffer, memory, memory_offset: 0 });
        let info = vk::BufferDeviceAddressInfo { buffer, ..Default::default() };
        let address = Output::DeviceAddress(vk::DeviceAddress(address_of(buffer)));
        self.validator.track(&Call::GetBufferDeviceAddress { device: DEVICE, info }, &address);
    }

    fn make_structure(
        &mut self,
        acceleration_structure: vk::AccelerationStructure,
        place: u64,
        ty: vk::AccelerationStructureType,
    ) {
        let address = vk::DeviceAddress(address_of(STORAGE) + OBJECT * place);
        let address_range = vk::DeviceAddressRange { address, size: OBJECT };
        let create_info = vk::AccelerationStructureCreateInfo2 { address_range, ty, ..Default::default() };
        self.track(&Call::CreateAccelerationStructure2 { device: DEVICE, create_info, acceleration_structure });
    }

    fn make_command_buffer(&mut self) {
        self.track(&Call::GetDeviceQueue { device: DEVICE, queue_family_index: 0, queue_index: 0, queue: QUEUE });
        let create_info = vk::CommandPoolCreateInfo::default();
        self.track(&Call::CreateCommandPool { device: DEVICE, create_info, command_pool: POOL });
        let allocate_info =
            vk::CommandBufferAllocateInfo { command_pool: POOL, command_buffer_count: 1, ..Default::default() };
        let command_buffers = vec![COMMAND_BUFFER];
        self.track(&Call::AllocateCommandBuffers { device: DEVICE, allocate_info, command_buffers });
    }

    fn begin(&mut self) {
        let begin_info = vk::CommandBufferBeginInfo::default();
        self.track(&Call::BeginCommandBuffer { command_buffer: COMMAND_BUFFER, begin_info });
    }
}

#[cfg(test)]
mod tests {
    use omm_model::memory::NoMemory;

    use super::*;

    #[test]
    fn the_calls_are_valid_and_their_contents_are_looked_at() {
        let mut program = Program::new(1000);
        let calls = program.calls();
        for (_, call) in &calls {
            assert_eq!(program.validator.check(call, &program.memory()).to_string(), "");
        }
        // The last entry's format and the last index are wrong: seen where there is memory to look at.
        let last_entry = 8 * 1000 - 2;
        let last_index = Input::of(1000).indices as usize + 4 * 999;
        program.input[last_entry] = 9;
        program.input[last_index + 1] = 7;
        // No rule of the EXT extension is about the values of indices.
        for ((name, call), violations) in calls.iter().zip([1, 1, 1, 0, 16 * 8]) {
            assert_eq!(program.validator.check(call, &program.memory()).len(), violations, "{name}");
            assert!(program.validator.check(call, &NoMemory).is_empty());
        }
    }
}
