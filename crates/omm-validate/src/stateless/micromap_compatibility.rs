//! Rules of `vkGetDeviceMicromapCompatibilityEXT` on its parameters.

use omm_model::call::Call;
use omm_model::profile::Features;

use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::ViolationKind;

pub(super) fn check(call: &Call, command: &At<'_>, features: &Features, report: &mut Report) {
    if matches!(call, Call::GetDeviceMicromapCompatibility { .. }) {
        compatibility_feature_11666(command, features, report);
    }
}

/// The command belongs to a feature.
///
/// VUID-vkGetDeviceMicromapCompatibilityEXT-micromap-11666
fn compatibility_feature_11666(command: &At<'_>, features: &Features, report: &mut Report) {
    micromap_feature(command, features, RuleId::CompatibilityFeature11666, report);
}

/// Micromap objects have a feature, which is not that of the KHR extension.
pub(super) fn micromap_feature(command: &At<'_>, features: &Features, rule: RuleId, report: &mut Report) {
    if !features.micromap_ext {
        let feature = "VkPhysicalDeviceOpacityMicromapFeaturesEXT::micromap";
        report.push(rule, &command.field("device"), ViolationKind::FeatureDisabled { feature });
    }
}
