//! What a device is made of and can do: device groups, features and limits of the extensions in scope.

use super::chain::extensible;
use super::*;

extensible! {
    /// Features of the KHR micromap extension:
    /// [`VkPhysicalDeviceOpacityMicromapFeaturesKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkPhysicalDeviceOpacityMicromapFeaturesKHR.html).
    #[doc(alias = "VkPhysicalDeviceOpacityMicromapFeaturesKHR")]
    pub struct OpacityMicromapFeatures: PHYSICAL_DEVICE_OPACITY_MICROMAP_FEATURES {
        /// Micromaps can be built and attached.
        pub micromap: Bool32,
    }
}

extensible! {
    /// Features of the EXT micromap extension:
    /// [`VkPhysicalDeviceOpacityMicromapFeaturesEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkPhysicalDeviceOpacityMicromapFeaturesEXT.html).
    #[doc(alias = "VkPhysicalDeviceOpacityMicromapFeaturesEXT")]
    pub struct OpacityMicromapFeaturesExt: PHYSICAL_DEVICE_OPACITY_MICROMAP_FEATURES_EXT {
        /// Micromap objects can be built and attached.
        pub micromap: Bool32,
        /// Their device addresses can be saved and replayed.
        pub micromap_capture_replay: Bool32,
        /// Host commands can build and copy them.
        pub micromap_host_commands: Bool32,
    }
}

extensible! {
    /// Limits of the KHR micromap extension:
    /// [`VkPhysicalDeviceOpacityMicromapPropertiesKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkPhysicalDeviceOpacityMicromapPropertiesKHR.html).
    #[doc(alias = "VkPhysicalDeviceOpacityMicromapPropertiesKHR")]
    pub struct OpacityMicromapProperties: PHYSICAL_DEVICE_OPACITY_MICROMAP_PROPERTIES {
        /// Highest subdivision level of a triangle in 2-state format.
        pub max_opacity2_state_subdivision_level: u32,
        /// Highest subdivision level of a triangle in 4-state format.
        pub max_opacity4_state_subdivision_level: u32,
        /// Highest subdivision level of a triangle in 4-state format where the build may lose states.
        pub max_opacity_lossy4_state_subdivision_level: u32,
        /// The most triangles that one micromap can hold.
        pub max_micromap_triangles: u64,
    }
}

extensible! {
    /// Limits of the EXT micromap extension:
    /// [`VkPhysicalDeviceOpacityMicromapPropertiesEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkPhysicalDeviceOpacityMicromapPropertiesEXT.html).
    #[doc(alias = "VkPhysicalDeviceOpacityMicromapPropertiesEXT")]
    pub struct OpacityMicromapPropertiesExt: PHYSICAL_DEVICE_OPACITY_MICROMAP_PROPERTIES_EXT {
        /// Highest subdivision level of a triangle in 2-state format.
        pub max_opacity2_state_subdivision_level: u32,
        /// Highest subdivision level of a triangle in 4-state format.
        pub max_opacity4_state_subdivision_level: u32,
    }
}

extensible! {
    /// Features of acceleration structures:
    /// [`VkPhysicalDeviceAccelerationStructureFeaturesKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkPhysicalDeviceAccelerationStructureFeaturesKHR.html).
    #[doc(alias = "VkPhysicalDeviceAccelerationStructureFeaturesKHR")]
    pub struct AccelerationStructureFeatures: PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES {
        /// Acceleration structures can be made and built.
        pub acceleration_structure: Bool32,
        /// Their device addresses can be saved and replayed.
        pub acceleration_structure_capture_replay: Bool32,
        /// Build ranges can come from device memory.
        pub acceleration_structure_indirect_build: Bool32,
        /// Host commands can build and copy them.
        pub acceleration_structure_host_commands: Bool32,
        /// Descriptors that hold them can be updated after they were bound.
        pub descriptor_binding_acceleration_structure_update_after_bind: Bool32,
    }
}

extensible! {
    /// Limits of acceleration structures:
    /// [`VkPhysicalDeviceAccelerationStructurePropertiesKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkPhysicalDeviceAccelerationStructurePropertiesKHR.html).
    #[doc(alias = "VkPhysicalDeviceAccelerationStructurePropertiesKHR")]
    pub struct AccelerationStructureProperties: PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES {
        /// The most geometries in a bottom-level structure.
        pub max_geometry_count: u64,
        /// The most instances in a top-level structure.
        pub max_instance_count: u64,
        /// The most triangles or boxes in all geometries of a bottom-level structure.
        pub max_primitive_count: u64,
        /// The most such descriptors that one shader stage can use.
        pub max_per_stage_descriptor_acceleration_structures: u32,
        /// The same, counting descriptors that can be updated after they were bound.
        pub max_per_stage_descriptor_update_after_bind_acceleration_structures: u32,
        /// The most such descriptors in all sets of a pipeline layout.
        pub max_descriptor_set_acceleration_structures: u32,
        /// The same, counting descriptors that can be updated after they were bound.
        pub max_descriptor_set_update_after_bind_acceleration_structures: u32,
        /// What scratch addresses have to be a multiple of, in bytes.
        pub min_acceleration_structure_scratch_offset_alignment: u32,
    }
}

extensible! {
    /// Features of motion blur:
    /// [`VkPhysicalDeviceRayTracingMotionBlurFeaturesNV`](https://docs.vulkan.org/refpages/latest/refpages/source/VkPhysicalDeviceRayTracingMotionBlurFeaturesNV.html).
    #[doc(alias = "VkPhysicalDeviceRayTracingMotionBlurFeaturesNV")]
    pub struct RayTracingMotionBlurFeatures: PHYSICAL_DEVICE_RAY_TRACING_MOTION_BLUR_FEATURES {
        /// Structures with motion can be built and traced.
        pub ray_tracing_motion_blur: Bool32,
        /// They can also be traced by indirect commands.
        pub ray_tracing_motion_blur_pipeline_trace_rays_indirect: Bool32,
    }
}

extensible! {
    /// The physical devices that a logical device is made from:
    /// [`VkDeviceGroupDeviceCreateInfo`](https://docs.vulkan.org/refpages/latest/refpages/source/VkDeviceGroupDeviceCreateInfo.html).
    #[doc(alias = "VkDeviceGroupDeviceCreateInfo")]
    pub struct DeviceGroupDeviceCreateInfo: DEVICE_GROUP_DEVICE_CREATE_INFO {
        /// The physical devices, all of one group; none means only the one that the device is created from.
        pub physical_devices: Vec<PhysicalDevice>,
    }
}
