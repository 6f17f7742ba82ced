//! Rules of `vkCreateAccelerationStructure2KHR` and `VkAccelerationStructureCreateInfo2KHR` on their members.

use omm_model::call::Call;
use omm_model::profile::Features;
use omm_model::vk;
use vk::{AccelerationStructureCreateFlags as CreateFlags, AddressCommandFlags as AddressFlags};

use super::micromap_feature;
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::value::Found;
use crate::violation::ViolationKind;

/// Bytes that the address of an acceleration structure is aligned to.
const ADDRESS_ALIGNMENT: u64 = 256;
/// `VK_STRUCTURE_TYPE_OPAQUE_CAPTURE_DESCRIPTOR_DATA_CREATE_INFO_EXT`, a structure that the vocabulary has no more of.
const OPAQUE_CAPTURE_DESCRIPTOR_DATA_CREATE_INFO: vk::StructureType = vk::StructureType(1_000_316_010);

pub(super) fn check(call: &Call, command: &At<'_>, features: &Features, report: &mut Report) {
    let Call::CreateAccelerationStructure2 { create_info, .. } = call else { return };
    feature_03611(command, features, report);
    feature_13086(command, features, report);
    let create = Create { at: command.pointer("pCreateInfo"), info: create_info, features };
    create.address_range_11602(report);
    create.address_range_11605(report);
    create.address_range_11608(report);
    create.storage_usage_13100(report);
    create.transform_feedback_usage_13101(report);
    create.feature_11609(report);
    create.create_flags_11610(report);
    create.create_flags_11611(report);
    create.feature_03613(report);
    create.feature_08108(report);
    create.opaque_capture_08109(report);
    create.motion_info_04954(report);
}

/// The command needs acceleration structures.
///
/// VUID-vkCreateAccelerationStructure2KHR-accelerationStructure-03611
fn feature_03611(at: &At<'_>, features: &Features, report: &mut Report) {
    if !features.acceleration_structure {
        let features = &["accelerationStructure"];
        report.push(RuleId::Feature03611, at, ViolationKind::NeedsFeature { found: None, features });
    }
}

/// The command takes addresses.
///
/// VUID-vkCreateAccelerationStructure2KHR-deviceAddressCommands-13086
fn feature_13086(at: &At<'_>, features: &Features, report: &mut Report) {
    if !features.device_address_commands {
        let features = &["deviceAddressCommands"];
        report.push(RuleId::Feature13086, at, ViolationKind::NeedsFeature { found: None, features });
    }
}

/// One creation.
struct Create<'a> {
    at: At<'a>,
    info: &'a vk::AccelerationStructureCreateInfo2,
    features: &'a Features,
}

impl Create<'_> {
    fn is_micromap(&self) -> bool {
        self.info.ty == vk::AccelerationStructureType::OPACITY_MICROMAP
    }

    /// Reports `forbidden` among the create flags.
    fn forbid(&self, forbidden: CreateFlags, rule: RuleId, report: &mut Report) {
        let kind = ViolationKind::ForbiddenFlags { found: self.info.create_flags.into(), forbidden: forbidden.into() };
        report.push(rule, &self.at.field("createFlags"), kind);
    }

    /// Reports a create flag that needs a feature.
    fn feature_of_flag(&self, features: &'static [&'static str], rule: RuleId, report: &mut Report) {
        let found = Some(Found::Flags(self.info.create_flags.into()));
        report.push(rule, &self.at.field("createFlags"), ViolationKind::NeedsFeature { found, features });
    }

    /// Reports the second of two address flags that exclude each other.
    fn exclusive(&self, flag: AddressFlags, unknown: AddressFlags, rule: RuleId, report: &mut Report) {
        let found = self.info.address_flags;
        if found.contains(flag.union(unknown)) {
            let kind = ViolationKind::ForbiddenFlags { found: found.into(), forbidden: unknown.into() };
            report.push(rule, &self.at.field("addressFlags"), kind);
        }
    }

    /// There is an address. The tracked part of the rule looks for its buffer.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-11602
    fn address_range_11602(&self, report: &mut Report) {
        if self.info.address_range.address.is_null() {
            let range = self.at.field("addressRange");
            report.push(RuleId::AddressRange11602, &range.field("address"), ViolationKind::InvalidAddress { found: 0 });
        }
    }

    /// The address is aligned.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-11605
    fn address_range_11605(&self, report: &mut Report) {
        let address = self.info.address_range.address;
        if !address.is_aligned_to(ADDRESS_ALIGNMENT) {
            let kind = ViolationKind::Misaligned { found: address.0, alignment: ADDRESS_ALIGNMENT };
            let range = self.at.field("addressRange");
            report.push(RuleId::AddressRange11605, &range.field("address"), kind);
        }
    }

    /// The range is not empty.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-11608
    fn address_range_11608(&self, report: &mut Report) {
        if self.info.address_range.size == 0 {
            let range = self.at.field("addressRange");
            let kind = ViolationKind::BelowLimit { found: 0, limit: 1 };
            report.push(RuleId::AddressRange11608, &range.field("size"), kind);
        }
    }

    /// Storage usage is known or unknown.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-addressFlags-13100
    fn storage_usage_13100(&self, report: &mut Report) {
        let (flag, unknown) = (AddressFlags::STORAGE_BUFFER_USAGE, AddressFlags::UNKNOWN_STORAGE_BUFFER_USAGE);
        self.exclusive(flag, unknown, RuleId::StorageUsage13100, report);
    }

    /// Transform feedback usage is known or unknown.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-addressFlags-13101
    fn transform_feedback_usage_13101(&self, report: &mut Report) {
        let flag = AddressFlags::TRANSFORM_FEEDBACK_BUFFER_USAGE;
        let unknown = AddressFlags::UNKNOWN_TRANSFORM_FEEDBACK_BUFFER_USAGE;
        self.exclusive(flag, unknown, RuleId::TransformFeedbackUsage13101, report);
    }

    /// Micromaps are created on devices that have them.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-micromap-11609
    fn feature_11609(&self, report: &mut Report) {
        micromap_feature(self.info.ty, self.features, &self.at.field("type"), RuleId::Feature11609, report);
    }

    /// Micromaps have no descriptors.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-11610
    fn create_flags_11610(&self, report: &mut Report) {
        let flag = CreateFlags::DESCRIPTOR_BUFFER_CAPTURE_REPLAY;
        if self.is_micromap() && self.info.create_flags.contains(flag) {
            self.forbid(flag, RuleId::CreateFlags11610, report);
        }
    }

    /// Micromaps have no motion.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-11611
    fn create_flags_11611(&self, report: &mut Report) {
        if self.is_micromap() && self.info.create_flags.contains(CreateFlags::MOTION) {
            self.forbid(CreateFlags::MOTION, RuleId::CreateFlags11611, report);
        }
    }

    /// Addresses are captured on devices that can.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-03613
    fn feature_03613(&self, report: &mut Report) {
        let flag = CreateFlags::DEVICE_ADDRESS_CAPTURE_REPLAY;
        if self.info.create_flags.contains(flag) && !self.features.acceleration_structure_capture_replay {
            self.feature_of_flag(&["accelerationStructureCaptureReplay"], RuleId::Feature03613, report);
        }
    }

    /// Descriptors are captured on devices that can.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-08108
    fn feature_08108(&self, report: &mut Report) {
        let flag = CreateFlags::DESCRIPTOR_BUFFER_CAPTURE_REPLAY;
        if self.info.create_flags.contains(flag) && !self.features.descriptor_buffer_capture_replay {
            self.feature_of_flag(&["descriptorBufferCaptureReplay"], RuleId::Feature08108, report);
        }
    }

    /// Captured descriptor data comes with its flag.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-pNext-08109
    fn opaque_capture_08109(&self, report: &mut Report) {
        let flag = CreateFlags::DESCRIPTOR_BUFFER_CAPTURE_REPLAY;
        let found = self.info.create_flags;
        let mut chain = self.info.next.iter();
        if chain.any(|it| it.s_type() == OPAQUE_CAPTURE_DESCRIPTOR_DATA_CREATE_INFO) && !found.contains(flag) {
            let kind = ViolationKind::MissingFlags { found: found.into(), required: flag.into() };
            report.push(RuleId::OpaqueCapture08109, &self.at.field("createFlags"), kind);
        }
    }

    /// A top-level structure with motion says how many instances move.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-04954
    fn motion_info_04954(&self, report: &mut Report) {
        let is_info = |it: &vk::ChainStructure| matches!(it, vk::ChainStructure::AccelerationStructureMotionInfo(_));
        let has_motion = self.info.create_flags.contains(CreateFlags::MOTION);
        let is_top_level = self.info.ty == vk::AccelerationStructureType::TOP_LEVEL;
        if has_motion && is_top_level && !self.info.next.iter().any(is_info) {
            let kind = ViolationKind::StructureMissing { structure: "VkAccelerationStructureMotionInfoNV" };
            report.push(RuleId::MotionInfo04954, &self.at.field("pNext"), kind);
        }
    }
}
