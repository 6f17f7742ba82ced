//! The demo's way through two simulated devices: build on the first, serialize, deserialize on the second.
//!
//! Every call passes the validator before a device executes it.

use omm_bake::bake::BakeOutput;
use omm_device::Device;
use omm_device::app::{App, AppError, MicromapBinding, MicromapInput, Structure, TriangleInput};
use omm_layout::index::IndexType;
use omm_model::profile::DeviceProfile;
use omm_model::vk;
use omm_serialize::ByteOrder;
use omm_serialize::relocate::replace_references;
use omm_validate::Violation;

use super::scene::{self, Mesh, Transform};
use crate::watch::Watch;

/// The custom index of the ground's instance; every plant has [`PLANT`].
pub(super) const GROUND: u32 = 0;
/// The custom index of the plants' instances.
pub(super) const PLANT: u32 = 1;

/// What was built.
pub(super) struct Built {
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
    /// Bytes of the micromap as built and as compacted.
    pub(super) micromap_bytes: [u64; 2],
    /// API calls issued.
    pub(super) calls: u64,
    /// What the validator found.
    pub(super) violations: Vec<Violation>,
}

/// The structures of one device that refer to each other: micromap, plant, ground, and the scene of them all.
struct Structures {
    micromap: Structure,
    plant: Structure,
    ground: Structure,
    scene: Structure,
}

impl Structures {
    /// Those that are serialized, each after what it refers to.
    const fn in_order(&self) -> [&Structure; 4] {
        [&self.micromap, &self.plant, &self.ground, &self.scene]
    }
}

/// Builds the scene on one device and brings it to another.
pub(super) fn build(baked: &BakeOutput, plant: &Mesh) -> Result<Built, AppError> {
    let profile = DeviceProfile::reference();
    let mut first = Device::new(profile.clone());
    let mut watch = Watch::new(profile.clone());
    let mut app = App::new(&mut first, &mut watch);

    let compactable = vk::BuildAccelerationStructureFlags::ALLOW_COMPACTION;
    let built =
        app.build_micromap(&MicromapInput { data: &baked.array, triangles: &baked.triangles, flags: compactable })?;
    let micromap = app.copy(&built, vk::CopyAccelerationStructureMode::COMPACT)?;
    let plant = build_plant(&mut app, plant, &micromap, baked)?;
    let ground = build_ground(&mut app)?;
    let with = app.build_instances(&instances(&plant, &ground, vk::GeometryInstanceFlags::empty()), compactable)?;
    let disabled = vk::GeometryInstanceFlags::DISABLE_OPACITY_MICROMAPS;
    let without = app.build_instances(&instances(&plant, &ground, disabled), compactable)?.address;
    let micromap_bytes = [built.size, micromap.size];

    let sources = Structures { micromap, plant, ground, scene: with };
    let mut blobs = Vec::new();
    for structure in sources.in_order() {
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
    Ok(Built {
        first,
        without,
        second,
        with,
        serialized_bytes: blobs.iter().map(|(_, _, blob)| blob.len() as u64).sum(),
        roundtrip_identical,
        micromap_bytes,
        calls: first_calls + watch.calls,
        violations,
    })
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

/// A plant's bottom-level structure with the micromap attached, which instances may disable.
fn build_plant(
    app: &mut App<'_>,
    mesh: &Mesh,
    micromap: &Structure,
    baked: &BakeOutput,
) -> Result<Structure, AppError> {
    let maps: Vec<_> = baked.triangle_maps().collect();
    let index_type = if baked.triangles.len() < 0xfffc { IndexType::Uint16 } else { IndexType::Uint32 };
    let input = TriangleInput {
        positions: &mesh.positions,
        indices: mesh.triangles.as_flattened(),
        flags: vk::GeometryFlags::empty(),
        micromap: Some(MicromapBinding { micromap: Some(micromap), maps: &maps, index_type }),
    };
    app.build_triangles(&[input], vk::BuildAccelerationStructureFlags::ALLOW_DISABLE_OPACITY_MICROMAPS)
}

/// The ground's bottom-level structure. Its instance carries the same flags as the plants', so it allows the same.
fn build_ground(app: &mut App<'_>) -> Result<Structure, AppError> {
    let mesh = scene::ground();
    let input = TriangleInput {
        positions: &mesh.positions,
        indices: mesh.triangles.as_flattened(),
        flags: vk::GeometryFlags::OPAQUE,
        micromap: None,
    };
    app.build_triangles(&[input], vk::BuildAccelerationStructureFlags::ALLOW_DISABLE_OPACITY_MICROMAPS)
}

/// The scene: the ground and all plants.
fn instances(plant: &Structure, ground: &Structure, flags: vk::GeometryInstanceFlags) -> Vec<vk::Instance> {
    let instance = |matrix: Transform, structure: &Structure, instance_custom_index| vk::Instance {
        transform: vk::TransformMatrix { matrix },
        instance_custom_index,
        mask: 0xff,
        flags,
        acceleration_structure_reference: structure.address.0,
        ..Default::default()
    };
    let plants = scene::plants().into_iter().map(|matrix| instance(matrix, plant, PLANT));
    std::iter::once(instance(scene::IDENTITY, ground, GROUND)).chain(plants).collect()
}
