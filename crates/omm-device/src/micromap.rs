//! Micromap objects of the EXT extension: handles for ranges of buffers, like acceleration structures, but of a kind of their own.

use std::collections::BTreeMap;

use omm_model::call::Output;
use omm_model::vk;

use crate::memory::Memory;
use crate::undefined::{At, Reason, Stop};

/// What a micromap's handle stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Micromap {
    /// The device address of its first byte, by which bottom-level structures refer to it.
    pub address: vk::DeviceAddress,
    /// Bytes of the range.
    pub size: u64,
}

/// All micromap objects of a device.
#[derive(Debug, Default)]
pub(crate) struct Micromaps {
    by_handle: BTreeMap<vk::Micromap, Micromap>,
}

impl Micromaps {
    pub(crate) fn get(&self, handle: vk::Micromap) -> Result<&Micromap, Reason> {
        self.by_handle.get(&handle).ok_or(Reason::UnknownHandle { object: "micromap", handle: handle.0 })
    }

    /// Whether an address is a micromap's.
    pub(crate) fn has_address(&self, address: u64) -> bool {
        self.by_handle.values().any(|found| found.address.0 == address)
    }

    /// `vkCreateMicromapEXT`: a range of a buffer, which may be bound to memory later.
    pub(crate) fn create(
        &mut self,
        memory: &Memory,
        info: &vk::MicromapCreateInfo,
        handle: vk::Micromap,
    ) -> Result<Output, Stop> {
        if handle.is_null() || self.by_handle.contains_key(&handle) {
            return Err(Reason::HandleTaken { object: "micromap", handle: handle.0 }).at("pMicromap");
        }
        check_type(info.ty).at("pCreateInfo->type")?;
        memory.buffer(info.buffer).at("pCreateInfo->buffer")?;
        let address = memory.address_in(info.buffer, info.offset, info.size).at("pCreateInfo->offset")?;
        // Replay works as far as the same calls give the same addresses.
        if !info.device_address.is_null() && info.device_address.0 != address {
            return Ok(Output::Result(vk::Result::ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS));
        }
        self.by_handle.insert(handle, Micromap { address: vk::DeviceAddress(address), size: info.size });
        Ok(Output::None)
    }

    /// `vkDestroyMicromapEXT`. The bytes stay.
    pub(crate) fn destroy(&mut self, handle: vk::Micromap) -> Result<Output, Stop> {
        if !handle.is_null() {
            self.get(handle).at("micromap")?;
            self.by_handle.remove(&handle);
        }
        Ok(Output::None)
    }
}

/// Requires opacity.
pub(crate) fn check_type(ty: vk::MicromapType) -> Result<(), Reason> {
    match ty {
        vk::MicromapType::OPACITY_MICROMAP => Ok(()),
        vk::MicromapType::DISPLACEMENT_MICROMAP => Err(Reason::Unsupported { what: "displacement micromaps" }),
        vk::MicromapType(found) => Err(Reason::UnknownValue { found: found.into() }),
    }
}
