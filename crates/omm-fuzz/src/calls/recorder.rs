//! Writes down what an application does, so that it can be done again, spoiled.

use std::collections::BTreeMap;

use omm_device::Device;
use omm_device::app::Observer;
use omm_model::call::{Call, Output};
use omm_model::memory::MemoryView;
use omm_model::vk;

/// What a program does: calls, and writes to memory.
#[derive(Clone, Debug)]
pub(crate) enum Step {
    Call(Box<Call>),
    /// Writes through the mapping of device memory.
    Write(vk::DeviceAddress, Vec<u8>),
    /// Puts bytes into host memory, which is allocated if there is none.
    Host(vk::HostAddress, Vec<u8>),
}

/// The first address of host memory, and how far its pieces, and buffers, lie apart at least.
const HOST: u64 = 0x7f00_0000_0000;
const APART: u64 = 0x1_0000;

/// Writes down calls and uploads.
#[derive(Default)]
pub(crate) struct Recorder {
    pub(crate) steps: Vec<Step>,
    /// Sizes of buffers that the application may write.
    sizes: BTreeMap<vk::Buffer, u64>,
    /// Where those lie, and what was written to them last.
    inputs: BTreeMap<vk::Buffer, (vk::DeviceAddress, Vec<u8>)>,
    /// Pieces of host memory seen.
    host_pieces: u64,
}

impl Recorder {
    fn uploads(&mut self, memory: &dyn MemoryView) {
        for (address, known) in self.inputs.values_mut() {
            let found = memory.read(*address, known.len() as u64).unwrap_or_default();
            if found != known.as_slice() {
                *known = found.to_vec();
                self.steps.push(Step::Write(*address, known.clone()));
            }
        }
        loop {
            let address = vk::HostAddress(HOST + self.host_pieces * APART);
            let size = memory.read_host(address, u64::MAX).err().map_or(0, |error| error.available);
            let Some(bytes) = memory.read_host(address, size).ok().filter(|_| size > 0) else { return };
            self.steps.push(Step::Host(address, bytes.to_vec()));
            self.host_pieces += size.div_ceil(APART) + 1;
        }
    }
}

impl Observer for Recorder {
    fn before(&mut self, call: &Call, memory: &dyn MemoryView) {
        self.uploads(memory);
        match call {
            Call::CreateBuffer { create_info, buffer, .. } => {
                let storage = vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE
                    | vk::BufferUsageFlags::MICROMAP_STORAGE
                    | vk::BufferUsageFlags::TRANSFER_DST;
                if !create_info.usage.intersects(storage) {
                    self.sizes.insert(*buffer, create_info.size);
                }
            }
            Call::DestroyBuffer { buffer, .. } => drop(self.inputs.remove(buffer)),
            _ => {}
        }
        self.steps.push(Step::Call(Box::new(call.clone())));
    }

    fn after(&mut self, call: &Call, output: &Output) {
        if let (Call::GetBufferDeviceAddress { info, .. }, Output::DeviceAddress(address)) = (call, output)
            && let Some(size) = self.sizes.get(&info.buffer).and_then(|size| usize::try_from(*size).ok())
        {
            self.inputs.insert(info.buffer, (*address, vec![0; size]));
        }
    }
}

/// Allocates host memory until there is some at an address, and fills it. Tells whether that succeeded.
pub(crate) fn put_host(device: &mut Device, address: vk::HostAddress, bytes: &[u8]) -> bool {
    device.write_host(address, bytes).is_ok()
        || device.allocate_host(bytes.len() as u64) == Some(address) && device.write_host(address, bytes).is_ok()
}
