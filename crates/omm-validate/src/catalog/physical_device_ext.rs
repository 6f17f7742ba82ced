//! Rows of `VkPhysicalDeviceOpacityMicromapFeaturesEXT` and `VkPhysicalDeviceOpacityMicromapPropertiesEXT`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::ExtOpacityMicromap, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::PhysicalDeviceOpacityMicromapFeaturesExtSType,
        "An unknown number in the chain of device creation is skipped, so the features are asked for and never \
         enabled, and everything later fails for no visible reason. Set the EXT type; the KHR feature structure has \
         another number.",
    )
    .implicit(),
    row(
        RuleId::PhysicalDeviceOpacityMicromapPropertiesExtSType,
        "With a wrong type the driver skips the structure, and the limits stay at what the memory held, often 0. Set \
         the EXT type before asking for properties.",
    )
    .implicit(),
];
