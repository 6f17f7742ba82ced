//! Rows of `VkPhysicalDeviceOpacityMicromapFeaturesKHR` and `VkPhysicalDeviceOpacityMicromapPropertiesKHR`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::KhrOpacityMicromap, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::PhysicalDeviceOpacityMicromapFeaturesKhrSType,
        "A driver that does not recognise the structure creates the device without micromaps, or with the EXT \
         extension's features where that type was written, and later calls fail for no visible reason. Write the KHR \
         structure's type.",
    )
    .implicit(),
    row(
        RuleId::PhysicalDeviceOpacityMicromapPropertiesKhrSType,
        "The driver passes over a structure it does not recognise, and the application reads limits that nobody \
         filled in; as the structure of the EXT extension it is shorter and lacks two limits. Write the KHR \
         structure's type before asking.",
    )
    .implicit(),
];
