//! Devices and their queues.

use omm_model::call::{Call, DeviceCreateInfo};
use omm_model::profile::Features;
use omm_model::vk;

use super::State;

/// A device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct DeviceState {
    /// The features that it was created with.
    pub features: Features,
    /// How many physical devices it is made of, at least 1.
    pub physical_devices: usize,
    /// Whether it has any queue.
    pub has_queue: bool,
}

impl State {
    /// A device, if its creation was seen.
    #[must_use]
    pub fn device(&self, device: vk::Device) -> Option<&DeviceState> {
        self.devices.get(&device)
    }

    /// The features of a device; those of the profile if its creation was not seen.
    #[must_use]
    pub fn features(&self, device: vk::Device) -> &Features {
        self.device(device).map_or(&self.profile.features, |device| &device.features)
    }

    /// How many physical devices a device is made of; 1 if its creation was not seen.
    #[must_use]
    pub fn physical_devices(&self, device: vk::Device) -> usize {
        self.device(device).map_or(1, |device| device.physical_devices)
    }

    /// The device that a call is made on: its parameter, or that of its command buffer or queue if it is known.
    #[must_use]
    pub fn device_of(&self, call: &Call) -> Option<vk::Device> {
        if let Some(command_buffer) = call.recorded_into() {
            return self.parent((vk::CommandBuffer::OBJECT_TYPE, command_buffer.0));
        }
        match call {
            Call::BeginCommandBuffer { command_buffer, .. }
            | Call::EndCommandBuffer { command_buffer }
            | Call::ResetCommandBuffer { command_buffer, .. } => {
                self.parent((vk::CommandBuffer::OBJECT_TYPE, command_buffer.0))
            }
            Call::QueueSubmit { queue, .. } | Call::QueueBindSparse { queue, .. } => {
                self.queues.get(queue).map(|(device, _)| *device)
            }
            _ => call.device(),
        }
    }

    /// The features of the device that a call is made on; those of the profile if it is not known.
    #[must_use]
    pub fn features_for(&self, call: &Call) -> &Features {
        self.device_of(call).map_or(&self.profile.features, |device| self.features(device))
    }

    /// The queue family of a queue, if it was asked for.
    #[must_use]
    pub fn family_of_queue(&self, queue: vk::Queue) -> Option<u32> {
        self.queues.get(&queue).map(|(_, family)| *family)
    }

    pub(super) fn create_device(&mut self, device: vk::Device, create_info: &DeviceCreateInfo) {
        let new = DeviceState {
            features: create_info.features(&self.profile.features),
            physical_devices: create_info.physical_device_count(),
            has_queue: create_info.has_queue(),
        };
        self.devices.insert(device, new);
        self.created((vk::Device::OBJECT_TYPE, device.0), None);
    }
}
