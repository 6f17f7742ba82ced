//! Acceleration structures: handles for ranges of addresses. What a structure holds are the bytes at that range and nothing else.

use std::collections::BTreeMap;

use omm_layout::object::ObjectKind;
use omm_model::call::Output;
use omm_model::vk;

use crate::memory::Memory;
use crate::undefined::{At, Reason, Stop};

/// What a handle stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AccelerationStructure {
    /// The structure's device address, which is the first of its range.
    pub address: vk::DeviceAddress,
    /// Bytes of the range.
    pub size: u64,
    /// The type given at creation, "generic" included.
    pub ty: vk::AccelerationStructureType,
    /// Whether memory was promised behind all of the range whenever it is accessed.
    pub fully_bound: bool,
}

/// All acceleration structures of a device.
#[derive(Debug, Default)]
pub(crate) struct AccelerationStructures {
    by_handle: BTreeMap<vk::AccelerationStructure, AccelerationStructure>,
    /// How many structures have each address: ranges may be shared.
    addresses: BTreeMap<u64, u64>,
}

impl AccelerationStructures {
    pub(crate) fn get(&self, handle: vk::AccelerationStructure) -> Result<&AccelerationStructure, Reason> {
        self.by_handle.get(&handle).ok_or(Reason::UnknownHandle { object: "acceleration structure", handle: handle.0 })
    }

    /// Whether an address is a structure's.
    pub(crate) fn has_address(&self, address: u64) -> bool {
        self.addresses.contains_key(&address)
    }

    fn insert(&mut self, handle: vk::AccelerationStructure, new: AccelerationStructure) -> Output {
        *self.addresses.entry(new.address.0).or_default() += 1;
        self.by_handle.insert(handle, new);
        Output::None
    }

    fn check_new(&self, handle: vk::AccelerationStructure, ty: vk::AccelerationStructureType) -> Result<(), Stop> {
        if handle.is_null() || self.by_handle.contains_key(&handle) {
            let why = Reason::HandleTaken { object: "acceleration structure", handle: handle.0 };
            return Err(why).at("pAccelerationStructure");
        }
        if ty.name().is_none() {
            return Err(Reason::UnknownValue { found: ty.0.into() }).at("pCreateInfo->type");
        }
        Ok(())
    }

    /// `vkCreateAccelerationStructureKHR`: a range of a buffer, which may be bound to memory later.
    pub(crate) fn create(
        &mut self,
        memory: &Memory,
        info: &vk::AccelerationStructureCreateInfo,
        handle: vk::AccelerationStructure,
    ) -> Result<Output, Stop> {
        self.check_new(handle, info.ty)?;
        memory.buffer(info.buffer).at("pCreateInfo->buffer")?;
        let address = memory.address_in(info.buffer, info.offset, info.size).at("pCreateInfo->offset")?;
        // Replay works as far as the same calls give the same addresses.
        if !info.device_address.is_null() && info.device_address.0 != address {
            return Ok(Output::Result(vk::Result::ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS));
        }
        let address = vk::DeviceAddress(address);
        Ok(self.insert(handle, AccelerationStructure { address, size: info.size, ty: info.ty, fully_bound: false }))
    }

    /// `vkCreateAccelerationStructure2KHR`: a range of a buffer's addresses, which may be bound to memory later.
    pub(crate) fn create2(
        &mut self,
        memory: &Memory,
        info: &vk::AccelerationStructureCreateInfo2,
        handle: vk::AccelerationStructure,
    ) -> Result<Output, Stop> {
        self.check_new(handle, info.ty)?;
        let vk::DeviceAddressRange { address, size } = info.address_range;
        memory.in_buffer(address.0, size).at("pCreateInfo->addressRange")?;
        let fully_bound = info.address_flags.contains(vk::AddressCommandFlags::FULLY_BOUND);
        Ok(self.insert(handle, AccelerationStructure { address, size, ty: info.ty, fully_bound }))
    }

    /// `vkDestroyAccelerationStructureKHR`. The bytes stay.
    pub(crate) fn destroy(&mut self, handle: vk::AccelerationStructure) -> Result<Output, Stop> {
        if !handle.is_null() {
            let address = self.get(handle).at("accelerationStructure")?.address.0;
            self.by_handle.remove(&handle);
            let left = self.addresses.remove(&address).unwrap_or_default().saturating_sub(1);
            if left > 0 {
                self.addresses.insert(address, left);
            }
        }
        Ok(Output::None)
    }

    /// `vkGetAccelerationStructureDeviceAddressKHR`.
    pub(crate) fn device_address(&self, memory: &Memory, handle: vk::AccelerationStructure) -> Result<Output, Stop> {
        let found = self.get(handle).at("pInfo->accelerationStructure")?;
        memory.place(found.address.0, found.size).at("pInfo->accelerationStructure")?;
        Ok(Output::DeviceAddress(found.address))
    }
}

/// The kind of object that a structure of a type holds; `None` for "generic".
pub(crate) fn kind_of(ty: vk::AccelerationStructureType) -> Option<ObjectKind> {
    match ty {
        vk::AccelerationStructureType::TOP_LEVEL => Some(ObjectKind::TopLevel),
        vk::AccelerationStructureType::BOTTOM_LEVEL => Some(ObjectKind::BottomLevel),
        vk::AccelerationStructureType::OPACITY_MICROMAP => Some(ObjectKind::Micromap),
        _ => None,
    }
}
