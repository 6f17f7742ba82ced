//! Rows of `vkGetAccelerationStructureBuildSizesKHR`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::KhrAccelerationStructure, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::MaxPrimitiveCounts11612,
        "Sizes follow from the number of primitives; without it the driver dereferences a null pointer, or reads \
         behind a short array and answers with a size that is too small. Pass the largest count of each geometry.",
    ),
    row(
        RuleId::MaxPrimitiveCounts11613,
        "A micromap has no primitives; its size follows from the usage counts, and a driver that read counts here \
         would size it wrongly. Pass NULL and put the number of triangles into the usages.",
    ),
    row(
        RuleId::BuildType11614,
        "KHR micromaps are built by the device only, so sizes for a host build belong to a build that cannot happen. \
         Ask with VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR.",
    ),
];
