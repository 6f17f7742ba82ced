//! What the device says about itself, and objects that it only keeps: devices, queues, pipelines, shaders.

use std::collections::BTreeMap;

use omm_model::call::Output;
use omm_model::profile::DeviceProfile;
use omm_model::vk;

use crate::undefined::{At, Reason, Stop};

/// Fills in the features and limits that the structures of a chain ask for. What a profile does not know is 0.
pub(crate) fn filled(profile: &DeviceProfile, chain: &[vk::ChainStructure]) -> Output {
    let (features, limits) = (&profile.features, &profile.limits);
    let mut chain = chain.to_vec();
    for structure in &mut chain {
        match structure {
            vk::ChainStructure::OpacityMicromapFeatures(found) => found.micromap = features.micromap.into(),
            vk::ChainStructure::OpacityMicromapFeaturesExt(found) => {
                found.micromap = features.micromap_ext.into();
                found.micromap_capture_replay = features.micromap_capture_replay.into();
                found.micromap_host_commands = features.micromap_host_commands.into();
            }
            vk::ChainStructure::AccelerationStructureFeatures(found) => {
                found.acceleration_structure = features.acceleration_structure.into();
                found.acceleration_structure_capture_replay = features.acceleration_structure_capture_replay.into();
                found.acceleration_structure_indirect_build = features.acceleration_structure_indirect_build.into();
                found.acceleration_structure_host_commands = features.acceleration_structure_host_commands.into();
                found.descriptor_binding_acceleration_structure_update_after_bind = vk::Bool32::FALSE;
            }
            vk::ChainStructure::RayTracingMotionBlurFeatures(found) => {
                found.ray_tracing_motion_blur = features.ray_tracing_motion_blur.into();
                found.ray_tracing_motion_blur_pipeline_trace_rays_indirect = vk::Bool32::FALSE;
            }
            vk::ChainStructure::OpacityMicromapProperties(found) => {
                found.max_opacity2_state_subdivision_level = limits.max_opacity2_state_subdivision_level;
                found.max_opacity4_state_subdivision_level = limits.max_opacity4_state_subdivision_level;
                found.max_opacity_lossy4_state_subdivision_level = limits.max_opacity_lossy4_state_subdivision_level;
                found.max_micromap_triangles = limits.max_micromap_triangles;
            }
            vk::ChainStructure::OpacityMicromapPropertiesExt(found) => {
                found.max_opacity2_state_subdivision_level = limits.max_opacity2_state_subdivision_level;
                found.max_opacity4_state_subdivision_level = limits.max_opacity4_state_subdivision_level;
            }
            vk::ChainStructure::AccelerationStructureProperties(found) => {
                found.max_geometry_count = limits.max_geometry_count;
                found.max_instance_count = limits.max_instance_count;
                found.max_primitive_count = limits.max_primitive_count;
                found.min_acceleration_structure_scratch_offset_alignment =
                    limits.min_acceleration_structure_scratch_offset_alignment;
            }
            _ => {}
        }
    }
    Output::Structures(chain)
}

/// Objects of one kind of which only a few flags are kept.
#[derive(Debug)]
pub(crate) struct Kept<T> {
    object: &'static str,
    by_handle: BTreeMap<u64, T>,
}

impl<T> Kept<T> {
    pub(crate) const fn new(object: &'static str) -> Self {
        Self { object, by_handle: BTreeMap::new() }
    }

    /// Creates objects: all or none. `at` is the parameter that takes the handles.
    pub(crate) fn create(
        &mut self,
        handles: impl ExactSizeIterator<Item = u64> + Clone,
        kept: impl ExactSizeIterator<Item = T>,
        at: &str,
    ) -> Result<Output, Stop> {
        let (found, required) = (handles.len() as u64, kept.len() as u64);
        if found != required {
            return Err(Reason::CountMismatch { found, required }).at(at);
        }
        let mut new = BTreeMap::new();
        for (handle, kept) in handles.zip(kept) {
            if handle == 0 || self.by_handle.contains_key(&handle) || new.insert(handle, kept).is_some() {
                return Err(Reason::HandleTaken { object: self.object, handle }).at(at);
            }
        }
        self.by_handle.extend(new);
        Ok(Output::None)
    }

    pub(crate) fn destroy(&mut self, handle: u64, at: &str) -> Result<Output, Stop> {
        if handle != 0 {
            self.get(handle).at(at)?;
            self.by_handle.remove(&handle);
        }
        Ok(Output::None)
    }

    pub(crate) fn get(&self, handle: u64) -> Result<&T, Reason> {
        self.by_handle.get(&handle).ok_or(Reason::UnknownHandle { object: self.object, handle })
    }
}
