//! A chain holds what may extend its structure, and where that is asked, nothing twice.

use omm_model::vk;
use omm_model::vk::ChainStructure;

use super::table::structure::Structure;
use crate::location::At;
use crate::report::Report;
use crate::violation::ViolationKind;

pub(super) fn check(row: &Structure, at: &At<'_>, next: &[ChainStructure], report: &mut Report) {
    if let Some((rule, allowed)) = row.next {
        for structure in next {
            let found = true_type(structure);
            if allowed.iter().any(|(ty, _)| *ty == found) {
                continue;
            }
            let kind = ViolationKind::UnexpectedStructure { found: found.into(), allowed };
            if allowed.is_empty() {
                // All of the chain is too much.
                report.push(rule, &at.field("pNext"), kind);
                break;
            }
            report.push(rule, &at.chained_type(found), kind);
        }
    }
    if let Some(rule) = row.unique {
        for (position, structure) in next.iter().enumerate() {
            let found = structure.s_type();
            if next.iter().take(position).any(|earlier| earlier.s_type() == found) {
                let kind = ViolationKind::DuplicateStructure { found: found.into() };
                report.push(rule, &at.chained_type(true_type(structure)), kind);
            }
        }
    }
}

/// What a structure is, whatever it claims to be.
fn true_type(structure: &ChainStructure) -> vk::StructureType {
    match structure {
        ChainStructure::GeometryMicromapData(_) => vk::GeometryMicromapData::S_TYPE,
        ChainStructure::TrianglesOpacityMicromap(_) => vk::TrianglesOpacityMicromap::S_TYPE,
        ChainStructure::TrianglesOpacityMicromapExt(_) => vk::TrianglesOpacityMicromapExt::S_TYPE,
        ChainStructure::GeometryMotionTrianglesData(_) => vk::GeometryMotionTrianglesData::S_TYPE,
        ChainStructure::AccelerationStructureMotionInfo(_) => vk::AccelerationStructureMotionInfo::S_TYPE,
        ChainStructure::MemoryAllocateFlagsInfo(_) => vk::MemoryAllocateFlagsInfo::S_TYPE,
        ChainStructure::WriteDescriptorSetAccelerationStructure(_) => {
            vk::WriteDescriptorSetAccelerationStructure::S_TYPE
        }
        ChainStructure::OpacityMicromapFeatures(_) => vk::OpacityMicromapFeatures::S_TYPE,
        ChainStructure::OpacityMicromapFeaturesExt(_) => vk::OpacityMicromapFeaturesExt::S_TYPE,
        ChainStructure::AccelerationStructureFeatures(_) => vk::AccelerationStructureFeatures::S_TYPE,
        ChainStructure::RayTracingMotionBlurFeatures(_) => vk::RayTracingMotionBlurFeatures::S_TYPE,
        ChainStructure::DeviceGroupDeviceCreateInfo(_) => vk::DeviceGroupDeviceCreateInfo::S_TYPE,
        ChainStructure::OpacityMicromapProperties(_) => vk::OpacityMicromapProperties::S_TYPE,
        ChainStructure::OpacityMicromapPropertiesExt(_) => vk::OpacityMicromapPropertiesExt::S_TYPE,
        ChainStructure::AccelerationStructureProperties(_) => vk::AccelerationStructureProperties::S_TYPE,
        ChainStructure::Unknown(s_type) => *s_type,
    }
}
