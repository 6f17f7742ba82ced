//! An engine that shows its calls to the validator before the driver gets them, and prints what is wrong with them.
//!
//! The engine calls `VK_EXT_opacity_micromap` through ash and keeps the structures that it fills for the driver. What the driver
//! would return, handles and an address, is made up here, since there need not be a GPU.
//!
//! ```sh
//! cargo run -p omm-validate --features ash --example engine
//! ```
#![allow(clippy::print_stdout)]

use std::error::Error;

use ::ash::vk::{self as ash, Handle};
use omm_model::ash::{
    BuildGeometryPointers, MicromapBuildPointers, TrianglesOpacityMicromapPointers, TrianglesPointers,
};
use omm_model::call::{Call, Output};
use omm_model::memory::NoMemory;
use omm_model::profile::DeviceProfile;
use omm_model::vk;
use omm_validate::{Report, Validator};

/// Bytes of each of the engine's buffers.
const SIZE: u64 = 1 << 16;

/// An engine that is being watched.
struct Engine {
    validator: Validator,
    device: ash::Device,
    command_buffer: ash::CommandBuffer,
    /// What was found so far.
    reports: Vec<Report>,
    /// The next handle that the driver will return.
    next_handle: u64,
}

impl Engine {
    fn new() -> Self {
        let mut engine = Self {
            // An engine fills the limits and features from what its physical device says.
            validator: Validator::new(DeviceProfile::reference()),
            device: ash::Device::from_raw(1),
            command_buffer: ash::CommandBuffer::from_raw(2),
            reports: Vec::new(),
            next_handle: 0x100,
        };
        let begin_info = vk::CommandBufferBeginInfo::default();
        engine.issue(&Call::BeginCommandBuffer { command_buffer: engine.command_buffer.into(), begin_info });
        engine
    }

    /// What the driver would do: return a handle.
    fn handle<T: Handle>(&mut self) -> T {
        self.next_handle += 1;
        T::from_raw(self.next_handle)
    }

    /// One call: looked at before the driver gets it, remembered after. Contents are not looked at; an engine whose memory is
    /// mapped passes a view of it instead of `NoMemory`.
    fn issue(&mut self, call: &Call) {
        self.issue_for(call, &Output::None);
    }

    fn issue_for(&mut self, call: &Call, output: &Output) {
        let report = self.validator.check_and_track(call, output, &NoMemory);
        if !report.is_empty() {
            self.reports.push(report);
        }
    }

    /// A buffer in memory of its own, and its address.
    fn create_buffer(&mut self, usage: ash::BufferUsageFlags) -> (ash::Buffer, vk::DeviceAddress) {
        let device = self.device.into();
        let (buffer, memory) = (self.handle::<ash::Buffer>(), self.handle::<ash::DeviceMemory>());
        let usage = (usage | ash::BufferUsageFlags::SHADER_DEVICE_ADDRESS).into();
        let create_info = vk::BufferCreateInfo { size: SIZE, usage, ..Default::default() };
        self.issue(&Call::CreateBuffer { device, create_info, buffer: buffer.into() });
        let allocate_info = vk::MemoryAllocateInfo { allocation_size: SIZE, ..Default::default() };
        self.issue(&Call::AllocateMemory { device, allocate_info, memory: memory.into() });
        let bind = Call::BindBufferMemory { device, buffer: buffer.into(), memory: memory.into(), memory_offset: 0 };
        self.issue(&bind);
        let address = vk::DeviceAddress(buffer.as_raw() << 32);
        let info = vk::BufferDeviceAddressInfo { buffer: buffer.into(), ..Default::default() };
        self.issue_for(&Call::GetBufferDeviceAddress { device, info }, &Output::DeviceAddress(address));
        (buffer, address)
    }

    /// `vkCreateMicromapEXT`
    fn create_micromap(&mut self, info: &ash::MicromapCreateInfoEXT<'_>) -> ash::MicromapEXT {
        let micromap = self.handle::<ash::MicromapEXT>();
        let device = self.device.into();
        self.issue(&Call::CreateMicromap { device, create_info: info.into(), micromap: micromap.into() });
        micromap
    }

    /// `vkCreateAccelerationStructureKHR`
    fn create_structure(
        &mut self,
        info: &ash::AccelerationStructureCreateInfoKHR<'_>,
    ) -> ash::AccelerationStructureKHR {
        let structure = self.handle::<ash::AccelerationStructureKHR>();
        let (device, create_info) = (self.device.into(), info.into());
        let acceleration_structure = structure.into();
        self.issue(&Call::CreateAccelerationStructure { device, create_info, acceleration_structure });
        structure
    }

    /// `vkCmdBuildMicromapsEXT`
    fn cmd_build_micromap(
        &mut self,
        info: &ash::MicromapBuildInfoEXT<'_>,
        pointers: MicromapBuildPointers<'_>,
    ) -> Result<(), Box<dyn Error>> {
        let infos = vec![vk::MicromapBuildInfo::from_ash(info, pointers)?];
        self.issue(&Call::CmdBuildMicromaps { command_buffer: self.command_buffer.into(), infos });
        Ok(())
    }

    /// `vkCmdBuildAccelerationStructuresKHR`
    fn cmd_build_structure(
        &mut self,
        info: &ash::AccelerationStructureBuildGeometryInfoKHR<'_>,
        pointers: BuildGeometryPointers,
        ranges: &[ash::AccelerationStructureBuildRangeInfoKHR],
    ) -> Result<(), Box<dyn Error>> {
        let infos = vec![vk::BuildGeometryInfo::from_ash(info, pointers)?];
        let build_range_infos = vec![Some(ranges.iter().copied().map(Into::into).collect())];
        let command_buffer = self.command_buffer.into();
        self.issue(&Call::CmdBuildAccelerationStructures { command_buffer, infos, build_range_infos });
        Ok(())
    }
}

/// Bakes a leaf, attaches it to a card, and gets two numbers wrong on the way.
fn frame(engine: &mut Engine) -> Result<(), Box<dyn Error>> {
    use ash::BufferUsageFlags as Usage;
    let input = Usage::MICROMAP_BUILD_INPUT_READ_ONLY_EXT | Usage::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR;
    let (_, input) = engine.create_buffer(input);
    let (_, scratch) = engine.create_buffer(Usage::STORAGE_BUFFER);
    let (micromaps, _) = engine.create_buffer(Usage::MICROMAP_STORAGE_EXT);
    let (structures, _) = engine.create_buffer(Usage::ACCELERATION_STRUCTURE_STORAGE_KHR);
    let at = |offset| vk::DeviceOrHostAddress::from(vk::DeviceAddress(input.0 + offset));

    let create_info = ash::MicromapCreateInfoEXT::default().buffer(micromaps).size(SIZE);
    let leaf = engine.create_micromap(&create_info);
    let usage_counts = [ash::MicromapUsageEXT { count: 2, subdivision_level: 4, format: 2 }];
    let build =
        ash::MicromapBuildInfoEXT::default().dst_micromap(leaf).usage_counts(&usage_counts).triangle_array_stride(8);
    let pointers = MicromapBuildPointers {
        usage_counts: &usage_counts,
        // Wrong: hardware wants a multiple of 256.
        data: at(0x1010),
        scratch_data: scratch.into(),
        triangle_array: at(0),
    };
    engine.cmd_build_micromap(&build, pointers)?;

    let create_info = ash::AccelerationStructureCreateInfoKHR::default()
        .buffer(structures)
        .size(SIZE)
        .ty(ash::AccelerationStructureTypeKHR::BOTTOM_LEVEL);
    let card = engine.create_structure(&create_info);
    let attached = ash::AccelerationStructureTrianglesOpacityMicromapEXT::default()
        .index_type(ash::IndexType::UINT32)
        // Wrong: indices of 32 bits are multiples of four bytes apart.
        .index_stride(2)
        .usage_counts(&usage_counts)
        .micromap(leaf);
    let pointers = TrianglesOpacityMicromapPointers { index_buffer: at(0x2000), usage_counts: &usage_counts };
    let attached = vk::TrianglesOpacityMicromapExt::from_ash(&attached, pointers)?;
    let triangles = ash::AccelerationStructureGeometryTrianglesDataKHR::default()
        .vertex_format(ash::Format::R32G32B32_SFLOAT)
        .vertex_stride(12)
        .max_vertex(5)
        .index_type(ash::IndexType::NONE_KHR);
    let pointers = TrianglesPointers { vertex_data: at(0x3000), ..TrianglesPointers::default() };
    // The chain cannot be followed without unsafe code, so what the engine chained is pushed.
    let mut ours = vk::GeometryTrianglesData::from_ash(&triangles, pointers);
    ours.next.push(attached.into());
    let geometries = [ash::AccelerationStructureGeometryKHR::default()
        .geometry_type(ash::GeometryTypeKHR::TRIANGLES)
        .geometry(ash::AccelerationStructureGeometryDataKHR { triangles })];
    let build = ash::AccelerationStructureBuildGeometryInfoKHR::default()
        .ty(ash::AccelerationStructureTypeKHR::BOTTOM_LEVEL)
        .dst_acceleration_structure(card)
        .geometries(&geometries);
    let geometry = vk::Geometry::from_ash(&geometries[0], vk::GeometryData::Triangles(ours));
    let pointers = BuildGeometryPointers {
        geometries: vec![geometry],
        scratch_data: vk::DeviceAddress(scratch.0 + 0x8000).into(),
    };
    let ranges = [ash::AccelerationStructureBuildRangeInfoKHR::default().primitive_count(2)];
    engine.cmd_build_structure(&build, pointers, &ranges)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut engine = Engine::new();
    frame(&mut engine)?;
    for report in &engine.reports {
        println!("{report}");
    }
    Ok(())
}

#[test]
fn both_mistakes_are_reported() {
    let mut engine = Engine::new();
    frame(&mut engine).unwrap();
    let found: Vec<_> = engine.reports.iter().flatten().map(omm_validate::Violation::summary).collect();
    assert_eq!(
        found,
        [
            "vkCmdBuildMicromapsEXT(): pInfos[0].data: found 0x10100001010, required a multiple of 256",
            "vkCmdBuildAccelerationStructuresKHR(): pInfos[0].pGeometries[0].geometry.triangles\
             .pNext<VkAccelerationStructureTrianglesOpacityMicromapEXT>.indexStride: found 2, required a multiple of 4",
        ]
    );
}
