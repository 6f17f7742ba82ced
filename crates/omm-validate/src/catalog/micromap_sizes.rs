//! Rows of `VkMicromapBuildSizesInfoEXT` and `vkGetMicromapBuildSizesEXT`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::ExtOpacityMicromap, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::MicromapBuildSizesInfoSType,
        "The driver looks at the type of the structure that it is to fill; with another one it may write nothing, \
         and the application allocates by leftovers. Initialise the type before the call. Our vocabulary shows only \
         the sizes that came back.",
    )
    .implicit()
    .structural(
        "pSizeInfo is filled by the driver; a Call carries no output structures, only what comes back in them.",
    ),
    row(
        RuleId::MicromapBuildSizesInfoNext,
        "Nothing extends the answer, and an uninitialised pointer in it is followed by layers. Zero the structure \
         before the call. Our vocabulary shows only the sizes that came back.",
    )
    .implicit()
    .structural(
        "pSizeInfo is filled by the driver; a Call carries no output structures, only what comes back in them.",
    ),
    row(
        RuleId::BuildSizesFeature11618,
        "Sizes come from the builder that the feature switches on; without it the numbers are whatever the output \
         held. Enable micromap before asking.",
    ),
    row(
        RuleId::MultiDeviceSizes07440,
        "Builds take device addresses, which on a group of GPUs mean the same everywhere only with \
         bufferDeviceAddressMultiDevice; without it there is no build whose size could be told. Enable the feature, \
         or use one physical device. The rule stands at the size query and not at the builds; we check it there \
         only.",
    ),
    row(
        RuleId::GetMicromapBuildSizesDeviceParameter,
        "Sizes differ from device to device, and this handle names none. Calls dispatch through the handle, so a \
         wrong one usually crashes in the loader. Pass what vkCreateDevice returned. If it is unknown, nothing else \
         of the call is checked, as features and limits are unknown too.",
    )
    .implicit(),
    row(
        RuleId::GetMicromapBuildSizesBuildTypeParameter,
        "Sizes differ between host and device builds, and for an unknown build type the answer fits neither. Name \
         where the build will run.",
    )
    .implicit(),
    row(
        RuleId::GetMicromapBuildSizesBuildInfoParameter,
        "The sizes depend on the build that this points to; a null pointer crashes. Pass the build structure, whose \
         handle, mode and addresses may still be empty.",
    )
    .implicit()
    .structural(
        "A Call holds the structure itself and not a pointer to it, so the pointer is always there; what stands in \
         the structure is checked under its own rules.",
    ),
    row(
        RuleId::GetMicromapBuildSizesSizeInfoParameter,
        "The sizes are written into a structure that must exist and carry its type. Pass the address of an \
         initialised VkMicromapBuildSizesInfoEXT.",
    )
    .implicit()
    .structural("The pointer is where the driver puts its answer; a Call names the answer and has no such pointer."),
];
