//! What a scenario does to memory, and writing down all that it does.

use omm_model::memory::MemoryError;
use omm_model::vk;
use omm_serialize::trace::Event;

use super::World;

impl World {
    /// Writes down what is about to be done, where somebody wants to know. Nothing is done behind the place where the device stops.
    pub(super) fn note(&mut self, event: impl FnOnce() -> Event) {
        if let Some(events) = self.events.as_mut().filter(|_| !self.stopped) {
            events.push(event());
        }
    }

    /// Writes bytes through the host's mapping of the memory.
    pub(crate) fn write_mapped(&mut self, address: vk::DeviceAddress, bytes: &[u8]) -> Result<(), MemoryError> {
        self.note(|| Event::Write { address, bytes: bytes.to_vec() });
        let size = bytes.len() as u64;
        self.validator.track_write(vk::DeviceAddressRange { address, size });
        self.device.write(address, bytes)
    }

    /// Memory of the application that holds some bytes; `None` where there is not so much.
    pub(crate) fn new_host_memory(&mut self, bytes: &[u8]) -> Option<vk::HostAddress> {
        let size = bytes.len() as u64;
        let address = self.device.allocate_host(size)?;
        self.note(|| Event::AllocateHost { address, size });
        self.note(|| Event::WriteHost { address, bytes: bytes.to_vec() });
        self.device.write_host(address, bytes).ok()?;
        Some(address)
    }
}
