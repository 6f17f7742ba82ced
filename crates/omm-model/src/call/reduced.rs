//! What is kept of structures that matter here for a part of what they say.
//!
//! They live beside [`Call`](super::Call) and not in [`vk`], whose structures are complete.

use serde::{Deserialize, Serialize};

use crate::profile::Features;
use crate::vk;

/// Reduced form of
/// [`VkPhysicalDeviceFeatures2`](https://docs.vulkan.org/refpages/latest/refpages/source/VkPhysicalDeviceFeatures2.html): the chain.
#[doc(alias = "VkPhysicalDeviceFeatures2")]
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PhysicalDeviceFeatures2 {
    /// The structures that extend this one.
    pub next: vk::Chain,
}

/// Reduced form of
/// [`VkPhysicalDeviceProperties2`](https://docs.vulkan.org/refpages/latest/refpages/source/VkPhysicalDeviceProperties2.html): the
/// chain.
#[doc(alias = "VkPhysicalDeviceProperties2")]
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PhysicalDeviceProperties2 {
    /// The structures that extend this one.
    pub next: vk::Chain,
}

/// Reduced form of
/// [`VkDeviceQueueCreateInfo`](https://docs.vulkan.org/refpages/latest/refpages/source/VkDeviceQueueCreateInfo.html): without flags
/// and priorities.
#[doc(alias = "VkDeviceQueueCreateInfo")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct DeviceQueueCreateInfo {
    /// The family of the queues, an index into those of the profile.
    pub queue_family_index: u32,
    /// How many queues of the family.
    pub queue_count: u32,
}

/// Reduced form of [`VkDeviceCreateInfo`](https://docs.vulkan.org/refpages/latest/refpages/source/VkDeviceCreateInfo.html): without
/// layers and extensions, and with all features by the names of a profile.
#[doc(alias = "VkDeviceCreateInfo")]
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DeviceCreateInfo {
    /// The structures that extend this one: [`vk::DeviceGroupDeviceCreateInfo`] and feature structures.
    pub next: vk::Chain,
    /// The queues to create.
    pub queue_create_infos: Vec<DeviceQueueCreateInfo>,
    /// The features to enable; `None` for those of the profile. Feature structures of the chain have the last word.
    pub enabled_features: Option<Features>,
}

impl DeviceCreateInfo {
    /// The features that the device has, if those of the profile are `profile`.
    ///
    /// A feature structure counts for what it is, even if its `s_type` lies.
    #[must_use]
    pub fn features(&self, profile: &Features) -> Features {
        let mut features = self.enabled_features.unwrap_or(*profile);
        for structure in &self.next {
            match structure {
                vk::ChainStructure::OpacityMicromapFeatures(found) => {
                    features.micromap = found.micromap.is_true();
                }
                vk::ChainStructure::OpacityMicromapFeaturesExt(found) => {
                    features.micromap_ext = found.micromap.is_true();
                    features.micromap_capture_replay = found.micromap_capture_replay.is_true();
                    features.micromap_host_commands = found.micromap_host_commands.is_true();
                }
                vk::ChainStructure::AccelerationStructureFeatures(found) => {
                    features.acceleration_structure = found.acceleration_structure.is_true();
                    features.acceleration_structure_capture_replay =
                        found.acceleration_structure_capture_replay.is_true();
                    features.acceleration_structure_indirect_build =
                        found.acceleration_structure_indirect_build.is_true();
                    features.acceleration_structure_host_commands =
                        found.acceleration_structure_host_commands.is_true();
                }
                vk::ChainStructure::RayTracingMotionBlurFeatures(found) => {
                    features.ray_tracing_motion_blur = found.ray_tracing_motion_blur.is_true();
                }
                _ => {}
            }
        }
        features
    }

    /// How many physical devices the device is made from: those of the first [`vk::DeviceGroupDeviceCreateInfo`], otherwise 1.
    #[must_use]
    pub fn physical_device_count(&self) -> usize {
        let group = self.next.iter().find_map(|structure| match structure {
            vk::ChainStructure::DeviceGroupDeviceCreateInfo(group) => Some(group.physical_devices.len()),
            _ => None,
        });
        group.unwrap_or(1).max(1)
    }

    /// Whether any queue is created; nearly every command needs a device with one.
    #[must_use]
    pub fn has_queue(&self) -> bool {
        self.queue_create_infos.iter().any(|info| info.queue_count > 0)
    }
}

/// Reduced form of [`VkRenderingInfo`](https://docs.vulkan.org/refpages/latest/refpages/source/VkRenderingInfo.html): the flags.
#[doc(alias = "VkRenderingInfo")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct RenderingInfo {
    /// Whether the instance resumes one and will be suspended.
    pub flags: vk::RenderingFlags,
}

/// Reduced form of
/// [`VkRayTracingPipelineCreateInfoKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkRayTracingPipelineCreateInfoKHR.html):
/// the flags.
#[doc(alias = "VkRayTracingPipelineCreateInfoKHR")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct RayTracingPipelineCreateInfo {
    /// The flags in force: of a chained `VkPipelineCreateFlags2CreateInfo` if there is one, otherwise of the structure itself.
    pub flags: vk::PipelineCreateFlags2,
}

/// Reduced form of
/// [`VkShaderCreateInfoEXT`](https://docs.vulkan.org/refpages/latest/refpages/source/VkShaderCreateInfoEXT.html): the flags.
#[doc(alias = "VkShaderCreateInfoEXT")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct ShaderCreateInfo {
    /// How the shader is made.
    pub flags: vk::ShaderCreateFlags,
}
