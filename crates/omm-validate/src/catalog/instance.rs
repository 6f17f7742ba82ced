//! Rows of `VkAccelerationStructureInstanceKHR`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::KhrAccelerationStructure, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::InstanceFlags11580,
        "The two flags steer how micromaps are read, and on a device without micromaps their bits mean nothing or \
         something else. Enable the KHR or EXT feature, or clear the bits in the instance buffer. The first such \
         instance is reported, as memory is when the build is recorded.",
    ),
    row(
        RuleId::InstanceFlags11581,
        "A structure built without the flag need not keep what it takes to trace without its micromaps, so the \
         instance may keep them, lose geometry, or hang the traversal. Build the bottom-level structure with \
         VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_DISABLE_OPACITY_MICROMAPS_BIT_KHR, or clear the flag in the instance. \
         The device builds say the same once more in a rule of their own; there we report both.",
    ),
];
