//! What a device is and can do: identities, limits, features, queues and memory.

use serde::{Deserialize, Serialize};

use crate::curve::TieBreak;
use crate::vk;

/// Bytes of a UUID, `VK_UUID_SIZE`.
pub const UUID_SIZE: usize = 16;

/// A 16-byte identity, shown as 32 hexadecimal digits.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Uuid(pub [u8; UUID_SIZE]);

impl std::fmt::Display for Uuid {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl std::fmt::Debug for Uuid {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Uuid({self})")
    }
}

/// Everything about a device on which the outcome of a call may depend.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeviceProfile {
    /// A name for people.
    pub name: String,
    /// `VkPhysicalDeviceIDProperties::driverUUID`, the first field of everything serialized.
    pub driver_uuid: Uuid,
    /// The second field of everything serialized; data of another value is incompatible.
    pub compatibility_uuid: Uuid,
    /// Limits.
    pub limits: Limits,
    /// Features: those of a device whose creation asks for no others, or was not seen.
    pub features: Features,
    /// Queue families, by index.
    pub queue_families: Vec<QueueFamily>,
    /// Memory types, by index; each names a heap of [`memory_heaps`](Self::memory_heaps).
    pub memory_types: Vec<vk::MemoryType>,
    /// Memory heaps, by index.
    pub memory_heaps: Vec<vk::MemoryHeap>,
    /// Which microtriangle a hit on an edge between several reads; [`TieBreak::Reference`] where a file says nothing.
    #[serde(default)]
    pub micromap_tie_break: TieBreak,
}

/// What is kept of
/// [`VkQueueFamilyProperties`](https://docs.vulkan.org/refpages/latest/refpages/source/VkQueueFamilyProperties.html).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct QueueFamily {
    /// What its queues can do.
    pub queue_flags: vk::QueueFlags,
    /// How many queues it has.
    pub queue_count: u32,
}

/// Limits of `VkPhysicalDeviceOpacityMicromapPropertiesKHR` and `VkPhysicalDeviceAccelerationStructurePropertiesKHR`, with the
/// members of other property structures that rules ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Finest level of 2-state micromaps.
    pub max_opacity2_state_subdivision_level: u32,
    /// Finest level of 4-state micromaps that are not built lossy.
    pub max_opacity4_state_subdivision_level: u32,
    /// Finest level of micromaps built lossy.
    pub max_opacity_lossy4_state_subdivision_level: u32,
    /// Finest level of displacement micromaps, `VkPhysicalDeviceDisplacementMicromapPropertiesNV::maxDisplacementMicromapSubdivisionLevel`.
    pub max_displacement_micromap_subdivision_level: u32,
    /// Most triangles in a micromap.
    pub max_micromap_triangles: u64,
    /// Most geometries in a bottom-level acceleration structure.
    pub max_geometry_count: u64,
    /// Most instances in a top-level acceleration structure.
    pub max_instance_count: u64,
    /// Most triangles or boxes in a bottom-level acceleration structure.
    pub max_primitive_count: u64,
    /// Alignment in bytes of scratch addresses, a power of two.
    pub min_acceleration_structure_scratch_offset_alignment: u32,
    /// `VkPhysicalDeviceProtectedMemoryProperties::protectedNoFault`: mixing protected and other memory does not end the process.
    pub protected_no_fault: bool,
}

/// Features that the rules of the extensions ask for; all are `VkBool32` members of the feature structures named.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Features {
    /// `VkPhysicalDeviceAccelerationStructureFeaturesKHR::accelerationStructure`.
    pub acceleration_structure: bool,
    /// `VkPhysicalDeviceAccelerationStructureFeaturesKHR::accelerationStructureCaptureReplay`.
    pub acceleration_structure_capture_replay: bool,
    /// `VkPhysicalDeviceAccelerationStructureFeaturesKHR::accelerationStructureIndirectBuild`.
    pub acceleration_structure_indirect_build: bool,
    /// `VkPhysicalDeviceAccelerationStructureFeaturesKHR::accelerationStructureHostCommands`.
    pub acceleration_structure_host_commands: bool,
    /// `VkPhysicalDeviceDeviceAddressCommandsFeaturesKHR::deviceAddressCommands`.
    pub device_address_commands: bool,
    /// `VkPhysicalDeviceOpacityMicromapFeaturesKHR::micromap`.
    pub micromap: bool,
    /// `VkPhysicalDeviceOpacityMicromapFeaturesEXT::micromap`.
    pub micromap_ext: bool,
    /// `VkPhysicalDeviceOpacityMicromapFeaturesEXT::micromapCaptureReplay`.
    pub micromap_capture_replay: bool,
    /// `VkPhysicalDeviceOpacityMicromapFeaturesEXT::micromapHostCommands`.
    pub micromap_host_commands: bool,
    /// `VkPhysicalDeviceRayTracingMotionBlurFeaturesNV::rayTracingMotionBlur`.
    pub ray_tracing_motion_blur: bool,
    /// `VkPhysicalDeviceBufferDeviceAddressFeatures::bufferDeviceAddressMultiDevice`.
    pub buffer_device_address_multi_device: bool,
    /// `VkPhysicalDeviceDescriptorBufferFeaturesEXT::descriptorBufferCaptureReplay`.
    pub descriptor_buffer_capture_replay: bool,
}

impl Features {
    /// Every feature enabled.
    pub const ALL: Self = Self {
        acceleration_structure: true,
        acceleration_structure_capture_replay: true,
        acceleration_structure_indirect_build: true,
        acceleration_structure_host_commands: true,
        device_address_commands: true,
        micromap: true,
        micromap_ext: true,
        micromap_capture_replay: true,
        micromap_host_commands: true,
        ray_tracing_motion_blur: true,
        buffer_device_address_multi_device: true,
        descriptor_buffer_capture_replay: true,
    };
}

/// What every queue that computes can do.
const COMPUTE: vk::QueueFlags = vk::QueueFlags::COMPUTE.union(vk::QueueFlags::TRANSFER);

/// Memory that the host can use without further ado.
const HOST: vk::MemoryPropertyFlags =
    vk::MemoryPropertyFlags::HOST_VISIBLE.union(vk::MemoryPropertyFlags::HOST_COHERENT);

impl DeviceProfile {
    /// A generous device: every feature, level 12 in both formats; queue families for everything, for compute and for transfer;
    /// memory near the device, memory of the host, and memory that is both.
    #[must_use]
    pub fn reference() -> Self {
        Self {
            name: "reference".to_owned(),
            driver_uuid: Uuid(*b"omm sim. device."),
            compatibility_uuid: Uuid(*b"reference, v0002"),
            limits: Limits {
                max_opacity2_state_subdivision_level: 12,
                max_opacity4_state_subdivision_level: 12,
                max_opacity_lossy4_state_subdivision_level: 12,
                max_displacement_micromap_subdivision_level: 5,
                max_micromap_triangles: 1 << 29,
                max_geometry_count: (1 << 24) - 1,
                max_instance_count: (1 << 24) - 1,
                max_primitive_count: (1 << 29) - 1,
                min_acceleration_structure_scratch_offset_alignment: 128,
                protected_no_fault: true,
            },
            features: Features::ALL,
            queue_families: vec![
                QueueFamily {
                    queue_flags: COMPUTE | vk::QueueFlags::GRAPHICS | vk::QueueFlags::SPARSE_BINDING,
                    queue_count: 4,
                },
                QueueFamily { queue_flags: COMPUTE, queue_count: 2 },
                QueueFamily { queue_flags: vk::QueueFlags::TRANSFER, queue_count: 1 },
            ],
            // A type with fewer properties comes before one with more, as the API has it.
            memory_types: vec![
                vk::MemoryType { property_flags: vk::MemoryPropertyFlags::DEVICE_LOCAL, heap_index: 0 },
                vk::MemoryType { property_flags: HOST, heap_index: 1 },
                vk::MemoryType { property_flags: HOST | vk::MemoryPropertyFlags::DEVICE_LOCAL, heap_index: 0 },
            ],
            memory_heaps: vec![
                vk::MemoryHeap {
                    size: 1 << 35,
                    flags: vk::MemoryHeapFlags::DEVICE_LOCAL | vk::MemoryHeapFlags::MULTI_INSTANCE,
                },
                vk::MemoryHeap { size: 1 << 35, flags: vk::MemoryHeapFlags::empty() },
            ],
            micromap_tie_break: TieBreak::Reference,
        }
    }

    /// A device that offers no more than it must: the lowest limits that the specification's table of required limits allows
    /// (level 3; 2<sup>24</sup>-1 geometries and instances; 2<sup>29</sup>-1 primitives; scratch aligned to 256 bytes) and only the
    /// features that the KHR extension needs, one queue, and one memory type, which the host can map.
    ///
    /// The sources at hand state no lower bound for `maxMicromapTriangles` and `maxOpacityLossy4StateSubdivisionLevel`: ours are
    /// the primitive limit, so that each triangle of the largest geometry can have its own, and the level without loss. For
    /// displacement micromaps, which the device does not have, the level is 0.
    #[must_use]
    pub fn minimum() -> Self {
        Self {
            name: "minimum".to_owned(),
            compatibility_uuid: Uuid(*b"minimum,   v0002"),
            limits: Limits {
                max_opacity2_state_subdivision_level: 3,
                max_opacity4_state_subdivision_level: 3,
                max_opacity_lossy4_state_subdivision_level: 3,
                max_displacement_micromap_subdivision_level: 0,
                max_micromap_triangles: (1 << 29) - 1,
                min_acceleration_structure_scratch_offset_alignment: 256,
                protected_no_fault: false,
                ..Self::reference().limits
            },
            features: Features {
                acceleration_structure: true,
                device_address_commands: true,
                micromap: true,
                ..Features::default()
            },
            queue_families: vec![QueueFamily { queue_flags: COMPUTE, queue_count: 1 }],
            memory_types: vec![vk::MemoryType {
                property_flags: HOST | vk::MemoryPropertyFlags::DEVICE_LOCAL,
                heap_index: 0,
            }],
            memory_heaps: vec![vk::MemoryHeap { size: 1 << 32, flags: vk::MemoryHeapFlags::DEVICE_LOCAL }],
            ..Self::reference()
        }
    }

    /// The preset of that name: `reference` or `minimum`.
    #[must_use]
    pub fn preset(name: &str) -> Option<Self> {
        [Self::reference(), Self::minimum()].into_iter().find(|profile| profile.name == name)
    }

    /// The queue family with that index.
    #[must_use]
    pub fn queue_family(&self, index: u32) -> Option<&QueueFamily> {
        usize::try_from(index).ok().and_then(|index| self.queue_families.get(index))
    }

    /// The memory type with that index.
    #[must_use]
    pub fn memory_type(&self, index: u32) -> Option<&vk::MemoryType> {
        usize::try_from(index).ok().and_then(|index| self.memory_types.get(index))
    }

    /// The heap that memory of the type with that index is taken from.
    #[must_use]
    pub fn memory_heap_of_type(&self, index: u32) -> Option<&vk::MemoryHeap> {
        let heap = self.memory_type(index)?.heap_index;
        usize::try_from(heap).ok().and_then(|heap| self.memory_heaps.get(heap))
    }

    /// The index of the first memory type that has all these properties, the way applications choose one.
    #[must_use]
    pub fn find_memory_type(&self, properties: vk::MemoryPropertyFlags) -> Option<u32> {
        let found = self.memory_types.iter().position(|ty| ty.property_flags.contains(properties));
        found.and_then(|index| u32::try_from(index).ok())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_are_found_by_name_and_incompatible() {
        let (reference, minimum) = (DeviceProfile::reference(), DeviceProfile::minimum());
        assert_eq!(DeviceProfile::preset("minimum").as_ref(), Some(&minimum));
        assert_eq!(DeviceProfile::preset("other"), None);
        assert_eq!(reference.driver_uuid, minimum.driver_uuid);
        assert_ne!(reference.compatibility_uuid, minimum.compatibility_uuid);
        assert_eq!(reference.memory_heap_of_type(3), None);
        assert_eq!(Uuid(*b"0123456789abcdef").to_string(), "30313233343536373839616263646566");
    }

    #[test]
    fn presets_have_queues_and_memory_as_the_api_wants_them() {
        for profile in [DeviceProfile::reference(), DeviceProfile::minimum()] {
            assert!(profile.queue_family(0).is_some_and(|family| family.queue_flags.contains(COMPUTE)));
            assert_eq!(profile.queue_family(7), None);
            assert!(profile.find_memory_type(HOST).is_some());
            assert!(profile.find_memory_type(vk::MemoryPropertyFlags::DEVICE_LOCAL).is_some());
            assert_eq!(profile.find_memory_type(vk::MemoryPropertyFlags::PROTECTED), None);
            for (index, ty) in (0..).zip(&profile.memory_types) {
                assert!(profile.memory_heap_of_type(index).is_some());
                let before = profile.memory_types.iter().take_while(|other| *other != ty);
                assert!(before.map(|other| other.property_flags).all(|flags| !flags.contains(ty.property_flags)));
            }
        }
    }

    #[test]
    fn a_profile_survives_its_text_form_and_knows_its_fields() {
        let text = serde_json::to_string(&DeviceProfile::reference()).unwrap();
        assert_eq!(serde_json::from_str::<DeviceProfile>(&text).unwrap(), DeviceProfile::reference());
        assert!(serde_json::from_str::<DeviceProfile>(&text.replace("queue_count", "queues")).is_err());
    }
}
