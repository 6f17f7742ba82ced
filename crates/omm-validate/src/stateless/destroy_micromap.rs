//! Rules of `vkDestroyMicromapEXT` on its parameters.

use omm_model::call::Call;
use omm_model::profile::Features;

use super::micromap_compatibility::micromap_feature;
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;

pub(super) fn check(call: &Call, command: &At<'_>, features: &Features, report: &mut Report) {
    if matches!(call, Call::DestroyMicromap { .. }) {
        destroy_feature_11619(command, features, report);
    }
}

/// The command belongs to a feature, whatever handle it is given.
///
/// VUID-vkDestroyMicromapEXT-micromap-11619
fn destroy_feature_11619(command: &At<'_>, features: &Features, report: &mut Report) {
    micromap_feature(command, features, RuleId::DestroyFeature11619, report);
}
