//! Rows of `VkMicromapVersionInfoEXT` and `vkGetDeviceMicromapCompatibilityEXT`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::ExtOpacityMicromap, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::MicromapVersionInfoSType,
        "With the type of the acceleration-structure version header, which looks just alike, the driver may compare \
         with the wrong version. Set the micromap one.",
    )
    .implicit(),
    row(
        RuleId::MicromapVersionInfoNext,
        "The version header is all that is asked about. Set pNext to NULL; a dangling pointer would be walked by \
         layers.",
    )
    .implicit(),
    row(
        RuleId::MicromapVersionInfoVersionDataParameter,
        "The driver compares two identifiers of 16 bytes each and reads beyond a shorter array. Pass the first 32 \
         bytes of the serialized data, or a pointer to all of it: what follows is not looked at.",
    )
    .implicit(),
    row(
        RuleId::CompatibilityFeature11666,
        "Only a driver that has micromaps switched on can say which serialized ones it reads. Enable the feature, or \
         treat every blob as incompatible on this device.",
    ),
    row(
        RuleId::GetDeviceMicromapCompatibilityDeviceParameter,
        "Whether data is compatible is a question to one device, and this is none. Calls dispatch through the \
         handle, so a wrong one usually crashes in the loader. Pass what vkCreateDevice returned. If it is unknown, \
         nothing else of the call is checked, as features and limits are unknown too.",
    )
    .implicit(),
    row(
        RuleId::GetDeviceMicromapCompatibilityVersionInfoParameter,
        "The version header is what the question is about; a null pointer crashes. Pass the address of a filled \
         VkMicromapVersionInfoEXT.",
    )
    .implicit()
    .structural(
        "A Call holds the structure itself and not a pointer to it, so the pointer is always there; what stands in \
         the structure is checked under its own rules.",
    ),
    row(
        RuleId::GetDeviceMicromapCompatibilityCompatibilityParameter,
        "The verdict is written here; through a bad pointer it overwrites something else. Pass the address of a \
         variable.",
    )
    .implicit()
    .structural("The pointer is where the driver puts its answer; a Call names the answer and has no such pointer."),
];
