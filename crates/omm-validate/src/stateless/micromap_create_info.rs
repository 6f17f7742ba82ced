//! Rules of `VkMicromapCreateInfoEXT` and `vkCreateMicromapEXT` on their parameters.

use omm_model::call::Call;
use omm_model::profile::Features;
use omm_model::vk;
use vk::MicromapCreateFlags as CreateFlags;

use super::micromap_compatibility::micromap_feature;
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::ViolationKind;

/// What the place of a micromap in its buffer is a multiple of.
const OFFSET_ALIGNMENT: u64 = 256;

pub(super) fn check(call: &Call, command: &At<'_>, features: &Features, report: &mut Report) {
    let Call::CreateMicromap { create_info, .. } = call else { return };
    let at = command.pointer("pCreateInfo");
    create_feature_11615(command, features, report);
    replay_address_07433(&at, create_info, report);
    offset_07438(&at, create_info, report);
    capture_replay_11616(&at, create_info, features, report);
}

/// Micromap objects belong to a feature.
///
/// VUID-vkCreateMicromapEXT-micromap-11615
fn create_feature_11615(command: &At<'_>, features: &Features, report: &mut Report) {
    micromap_feature(command, features, RuleId::CreateFeature11615, report);
}

/// An address is wished for only where addresses are replayed.
///
/// VUID-VkMicromapCreateInfoEXT-deviceAddress-07433
fn replay_address_07433(at: &At<'_>, create_info: &vk::MicromapCreateInfo, report: &mut Report) {
    let found = create_info.device_address;
    if !found.is_null() && !create_info.create_flags.contains(CreateFlags::DEVICE_ADDRESS_CAPTURE_REPLAY) {
        let kind = ViolationKind::AddressNotNull { found: found.0 };
        report.push(RuleId::ReplayAddress07433, &at.field("deviceAddress"), kind);
    }
}

/// A micromap begins at a multiple of 256 bytes.
///
/// VUID-VkMicromapCreateInfoEXT-offset-07438
fn offset_07438(at: &At<'_>, create_info: &vk::MicromapCreateInfo, report: &mut Report) {
    let found = create_info.offset;
    if !found.is_multiple_of(OFFSET_ALIGNMENT) {
        let kind = ViolationKind::NotMultiple { found, of: OFFSET_ALIGNMENT };
        report.push(RuleId::Offset07438, &at.field("offset"), kind);
    }
}

/// Replaying addresses has a feature of its own.
///
/// VUID-VkMicromapCreateInfoEXT-micromapCaptureReplay-11616
fn capture_replay_11616(at: &At<'_>, create_info: &vk::MicromapCreateInfo, features: &Features, report: &mut Report) {
    let replay = create_info.create_flags.contains(CreateFlags::DEVICE_ADDRESS_CAPTURE_REPLAY);
    if replay && !features.micromap_capture_replay {
        let feature = "VkPhysicalDeviceOpacityMicromapFeaturesEXT::micromapCaptureReplay";
        let kind = ViolationKind::FeatureDisabled { feature };
        report.push(RuleId::CaptureReplay11616, &at.field("createFlags"), kind);
    }
}
