//! Creating and building acceleration structures.

use omm_model::call::{Call, Output};
use omm_model::vk;

use super::{App, AppError, Buffer, DEVICE};

/// An acceleration structure with a buffer of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Structure {
    /// The structure.
    pub handle: vk::AccelerationStructure,
    /// The address by which instances and serialized data refer to it.
    pub address: vk::DeviceAddress,
    /// Bytes that it was created with.
    pub size: u64,
    /// Its type.
    pub ty: vk::AccelerationStructureType,
    /// What it lies in.
    pub buffer: Buffer,
}

impl App<'_> {
    /// The sizes that a build needs; one count for each geometry, none for a micromap.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn build_sizes(
        &mut self,
        build_info: &vk::BuildGeometryInfo,
        max_primitive_counts: Option<Vec<u32>>,
    ) -> Result<vk::BuildSizesInfo, AppError> {
        let call = Call::GetAccelerationStructureBuildSizes {
            device: DEVICE,
            build_type: vk::AccelerationStructureBuildType::DEVICE,
            build_info: build_info.clone(),
            max_primitive_counts,
        };
        match self.call(&call)? {
            Output::BuildSizes(sizes) => Ok(sizes),
            found => Err(AppError::Output { command: call.command(), found }),
        }
    }

    /// Creates a structure in a new buffer: a micromap by address, all others by buffer.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn create(&mut self, ty: vk::AccelerationStructureType, size: u64) -> Result<Structure, AppError> {
        let buffer = self.buffer(size, vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE)?;
        let handle = vk::AccelerationStructure(self.handle());
        let size = buffer.size;
        self.call(&if ty == vk::AccelerationStructureType::OPACITY_MICROMAP {
            let address_range = vk::DeviceAddressRange { address: buffer.address, size };
            let create_info = vk::AccelerationStructureCreateInfo2 { address_range, ty, ..Default::default() };
            Call::CreateAccelerationStructure2 { device: DEVICE, create_info, acceleration_structure: handle }
        } else {
            let create_info =
                vk::AccelerationStructureCreateInfo { buffer: buffer.buffer, size, ty, ..Default::default() };
            Call::CreateAccelerationStructure { device: DEVICE, create_info, acceleration_structure: handle }
        })?;
        let info = vk::AccelerationStructureDeviceAddressInfo { acceleration_structure: handle, ..Default::default() };
        let address = self.address(&Call::GetAccelerationStructureDeviceAddress { device: DEVICE, info })?;
        Ok(Structure { handle, address, size, ty, buffer })
    }

    /// Destroys a structure and its buffer.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn destroy_structure(&mut self, structure: Structure) -> Result<(), AppError> {
        let acceleration_structure = structure.handle;
        self.call(&Call::DestroyAccelerationStructure { device: DEVICE, acceleration_structure })?;
        self.destroy(structure.buffer)
    }

    /// Asks for sizes, creates a structure and scratch memory, builds and submits. `info` says what to build from; destination
    /// and scratch memory are filled in. `ranges` has one range for each geometry, and is `None` for a micromap.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn build(
        &mut self,
        mut info: vk::BuildGeometryInfo,
        ranges: Option<Vec<vk::BuildRangeInfo>>,
    ) -> Result<Structure, AppError> {
        let counts = ranges.as_ref().map(|ranges| ranges.iter().map(|range| range.primitive_count).collect());
        let sizes = self.build_sizes(&info, counts)?;
        let structure = self.create(info.ty, sizes.acceleration_structure_size)?;
        let scratch = self.buffer(sizes.build_scratch_size, vk::BufferUsageFlags::STORAGE_BUFFER)?;
        info.dst_acceleration_structure = structure.handle;
        info.scratch_data = scratch.address.into();
        self.submit(|command_buffer| {
            vec![Call::CmdBuildAccelerationStructures {
                command_buffer,
                infos: vec![info],
                build_range_infos: vec![ranges],
            }]
        })?;
        self.destroy(scratch)?;
        Ok(structure)
    }
}
