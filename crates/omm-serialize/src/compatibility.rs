//! Whether a device can read serialized data.

use omm_model::profile::{DeviceProfile, UUID_SIZE};

/// Whether `version_data`, the first 32 bytes of serialized data or more, names the driver and the compatibility of `profile`:
/// what `vkGetDeviceAccelerationStructureCompatibilityKHR` answers for it. Fewer bytes name nothing.
#[must_use]
pub fn compatibility(version_data: &[u8], profile: &DeviceProfile) -> bool {
    let mut uuids = version_data.as_chunks::<UUID_SIZE>().0.iter();
    uuids.next() == Some(&profile.driver_uuid.0) && uuids.next() == Some(&profile.compatibility_uuid.0)
}
