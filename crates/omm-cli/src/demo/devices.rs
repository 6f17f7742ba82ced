//! The demo's way through two simulated devices: build on the first, serialize, deserialize on the second.
//!
//! Every call passes the validator before a device executes it.

use omm_device::Device;
use omm_device::app::{App, AppError};
use omm_model::profile::DeviceProfile;
use omm_model::vk;
use omm_render::{Baked, Built, RenderError, RenderScene};
use omm_serialize::ByteOrder;
use omm_serialize::relocate::replace_references;
use omm_validate::Violation;

use crate::watch::Watch;

/// What was built, and what it took.
pub(super) struct Path {
    /// The device on which everything was built.
    pub(super) first: Device,
    /// The scene on the first device with all micromaps disabled by instance flags.
    pub(super) without: vk::DeviceAddress,
    /// The device on which everything was deserialized.
    pub(super) second: Device,
    /// The scene on the second device, micromaps at work.
    pub(super) with: vk::DeviceAddress,
    /// Bytes of all that was serialized.
    pub(super) serialized_bytes: u64,
    /// Whether serializing once more on the second device gives the same bytes, but for the addresses.
    pub(super) roundtrip_identical: bool,
    /// Bytes of all micromaps as built and as compacted.
    pub(super) micromap_bytes: [u64; 2],
    /// API calls issued.
    pub(super) calls: u64,
    /// What the validator found.
    pub(super) violations: Vec<Violation>,
}

impl Path {
    /// Builds the scene on one device and brings it to another.
    pub(super) fn walk(scene: &RenderScene, baked: &Baked) -> Result<Self, RenderError> {
        let profile = DeviceProfile::reference();
        let mut first = Device::new(profile.clone());
        let mut watch = Watch::new(profile.clone());
        let mut app = App::new(&mut first, &mut watch);
        let built = Built::new(&mut app, scene, baked)?;
        let mut blobs = Vec::new();
        for structure in built.in_order() {
            blobs.push((structure.ty, structure.address, app.serialize(structure)?));
        }
        let Watch { calls: first_calls, mut violations, .. } = watch;

        let mut second = Device::new(profile.clone());
        let mut watch = Watch::new(profile);
        let mut app = App::new(&mut second, &mut watch);
        // Something that is already there, so that no structure gets the address that it had on the first device.
        app.upload_input(&[0; 1])?;
        let (with, roundtrip_identical) = bring_over(&mut app, &blobs)?;
        violations.extend(watch.violations);
        let compacted = built.micromaps.iter().map(|(micromap, _)| micromap.size).sum();
        Ok(Self {
            first,
            without: built.without.address,
            second,
            with,
            serialized_bytes: blobs.iter().map(|(_, _, blob)| blob.len() as u64).sum(),
            roundtrip_identical,
            micromap_bytes: [built.micromaps.iter().map(|(_, before)| before).sum(), compacted],
            calls: first_calls + watch.calls,
            violations,
        })
    }
}

/// Deserializes each blob, whose references are to earlier ones, and says where the last one is and whether serializing again gives
/// the same bytes.
fn bring_over(
    app: &mut App<'_>,
    blobs: &[(vk::AccelerationStructureType, vk::DeviceAddress, Vec<u8>)],
) -> Result<(vk::DeviceAddress, bool), AppError> {
    // From the addresses on the first device to those on the second.
    let mut moved: Vec<(u64, u64)> = Vec::new();
    let mut identical = true;
    let mut last = vk::DeviceAddress::NULL;
    for (ty, old_address, blob) in blobs {
        let forth = |address| moved.iter().find(|(old, _)| *old == address).map_or(address, |(_, new)| *new);
        let mut patched = blob.clone();
        replace_references(&mut patched, ByteOrder::Little, forth)?;
        let structure = app.deserialize(&patched, *ty)?;
        let back = |address| moved.iter().find(|(_, new)| *new == address).map_or(address, |(old, _)| *old);
        let mut again = app.serialize(&structure)?;
        replace_references(&mut again, ByteOrder::Little, back)?;
        identical &= again == *blob;
        moved.push((old_address.0, structure.address.0));
        last = structure.address;
    }
    Ok((last, identical))
}
