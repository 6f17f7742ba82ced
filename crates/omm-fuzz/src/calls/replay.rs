//! What the device does by itself: what stops leaves no trace, and the same calls give the same bytes.

use omm_device::{Device, Undefined};
use omm_model::call::Output;
use omm_model::memory::MemoryView;
use omm_model::profile::DeviceProfile;
use omm_model::vk;

use super::program::HEAP;
use super::recorder::{Step, put_host};
use super::spoiled;

/// Takes a program without a mistake, spoils it as the bytes say, and shows it to two devices.
///
/// # Panics
/// If a call that stops leaves a trace, stops otherwise when it is called again, or the two devices differ in anything.
pub fn replay(bytes: &[u8]) {
    let steps: Vec<Step> = spoiled(bytes);
    assert_eq!(run(&steps), run(&steps), "the same calls");
}

/// What every call returned, and the memory at the end.
fn run(steps: &[Step]) -> (Vec<Result<Output, Undefined>>, Vec<u8>) {
    let mut device = Device::with_heap_size(DeviceProfile::reference(), HEAP);
    let mut results = Vec::new();
    for step in steps {
        match step {
            Step::Write(address, bytes) => drop(device.write(*address, bytes)),
            Step::Host(address, bytes) => drop(put_host(&mut device, *address, bytes)),
            Step::Call(call) => {
                let result = device.execute(call);
                if result.is_err() {
                    let before = contents(&device);
                    assert_eq!(device.execute(call), result, "called again");
                    assert!(contents(&device) == before, "{result:?} left a trace");
                }
                results.push(result);
            }
        }
    }
    (results, contents(&device))
}

/// What can be read at the addresses that buffers can have.
fn contents(device: &Device) -> Vec<u8> {
    let mut contents = Vec::new();
    for address in (0x1_0000_0000_u64..0x1_0100_0000).step_by(0x1_0000) {
        let size = device.read(vk::DeviceAddress(address), u64::MAX).err().map_or(0, |error| error.available);
        contents.extend_from_slice(device.read(vk::DeviceAddress(address), size).unwrap_or_default());
    }
    contents
}
