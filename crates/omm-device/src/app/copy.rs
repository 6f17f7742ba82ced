//! Sizes, copies and serialized data.

use omm_model::call::{Call, Output};
use omm_model::vk;
use omm_serialize::ByteOrder;
use omm_serialize::blob::Prefix;

use super::structure::Structure;
use super::{App, AppError, DEVICE};

impl App<'_> {
    /// Asks for one size of each of some built structures.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn query(&mut self, structures: &[&Structure], query_type: vk::QueryType) -> Result<Vec<u64>, AppError> {
        let found = structures.len();
        let query_count = u32::try_from(found).map_err(|_| AppError::Count { what: "structures", found })?;
        let query_pool = vk::QueryPool(self.handle());
        let create_info = vk::QueryPoolCreateInfo { query_type, query_count, ..Default::default() };
        self.call(&Call::CreateQueryPool { device: DEVICE, create_info, query_pool })?;
        let acceleration_structures = structures.iter().map(|structure| structure.handle).collect();
        let first_query = 0;
        self.submit(|command_buffer| {
            vec![
                Call::CmdResetQueryPool { command_buffer, query_pool, first_query, query_count },
                Call::CmdWriteAccelerationStructuresProperties {
                    command_buffer,
                    acceleration_structures,
                    query_type,
                    query_pool,
                    first_query,
                },
            ]
        })?;
        let stride = 8;
        let flags = vk::QueryResultFlags::RESULT_64 | vk::QueryResultFlags::WAIT;
        let data_size = u64::from(query_count) * stride;
        let call = Call::GetQueryPoolResults {
            device: DEVICE,
            query_pool,
            first_query,
            query_count,
            data_size,
            stride,
            flags,
        };
        let values = match self.call(&call)? {
            Output::QueryResults(values) => values,
            found => return Err(AppError::Output { command: call.command(), found }),
        };
        self.call(&Call::DestroyQueryPool { device: DEVICE, query_pool })?;
        Ok(values)
    }

    /// One size of one built structure.
    fn query_one(&mut self, structure: &Structure, query_type: vk::QueryType) -> Result<u64, AppError> {
        Ok(self.query(&[structure], query_type)?.first().copied().unwrap_or_default())
    }

    /// Clones or compacts a structure into a new one that is as large as it must be.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn copy(&mut self, source: &Structure, mode: vk::CopyAccelerationStructureMode) -> Result<Structure, AppError> {
        let size = match mode {
            vk::CopyAccelerationStructureMode::COMPACT => vk::QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE,
            _ => vk::QueryType::ACCELERATION_STRUCTURE_SIZE,
        };
        let size = self.query_one(source, size)?;
        let copy = self.create(source.ty, size)?;
        let info =
            vk::CopyAccelerationStructureInfo { src: source.handle, dst: copy.handle, mode, ..Default::default() };
        self.submit(|command_buffer| vec![Call::CmdCopyAccelerationStructure { command_buffer, info }])?;
        Ok(copy)
    }

    /// A structure's serialized form.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn serialize(&mut self, source: &Structure) -> Result<Vec<u8>, AppError> {
        let size = self.query_one(source, vk::QueryType::ACCELERATION_STRUCTURE_SERIALIZATION_SIZE)?;
        let target = self.buffer(size, vk::BufferUsageFlags::TRANSFER_DST)?;
        let info = vk::CopyAccelerationStructureToMemoryInfo {
            src: source.handle,
            dst: target.address.into(),
            mode: vk::CopyAccelerationStructureMode::SERIALIZE,
            ..Default::default()
        };
        self.submit(|command_buffer| vec![Call::CmdCopyAccelerationStructureToMemory { command_buffer, info }])?;
        let blob = self.download(&target)?;
        self.destroy(target)?;
        Ok(blob)
    }

    /// Whether the device can read serialized data.
    ///
    /// # Errors
    /// As [`App::call`], for data shorter than the two UUIDs too.
    pub fn is_compatible(&mut self, blob: &[u8]) -> Result<bool, AppError> {
        let version_data = blob.get(..2 * vk::UUID_SIZE).unwrap_or(blob).to_vec();
        let version_info = vk::AccelerationStructureVersionInfo { version_data, ..Default::default() };
        let call = Call::GetDeviceAccelerationStructureCompatibility { device: DEVICE, version_info };
        match self.call(&call)? {
            Output::Compatibility(found) => Ok(found == vk::AccelerationStructureCompatibility::COMPATIBLE),
            found => Err(AppError::Output { command: call.command(), found }),
        }
    }

    /// Makes a structure of serialized data. References in it have to be those of this device already.
    ///
    /// # Errors
    /// Data of another driver or version; otherwise as [`App::call`].
    pub fn deserialize(&mut self, blob: &[u8], ty: vk::AccelerationStructureType) -> Result<Structure, AppError> {
        if !self.is_compatible(blob)? {
            return Err(AppError::Incompatible);
        }
        let size = Prefix::read(blob, ByteOrder::Little)?.deserialized_size;
        let structure = self.create(ty, size)?;
        let source = self.upload(blob, vk::BufferUsageFlags::TRANSFER_SRC)?;
        let info = vk::CopyMemoryToAccelerationStructureInfo {
            src: source.address.into(),
            dst: structure.handle,
            mode: vk::CopyAccelerationStructureMode::DESERIALIZE,
            ..Default::default()
        };
        self.submit(|command_buffer| vec![Call::CmdCopyMemoryToAccelerationStructure { command_buffer, info }])?;
        self.destroy(source)?;
        Ok(structure)
    }
}
