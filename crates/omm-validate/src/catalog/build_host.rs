//! Rows of `vkBuildAccelerationStructuresKHR`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::KhrAccelerationStructure, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::ExtIndexBuffer10892,
        "No index is read without an index type, so the pointer is left over or the type was forgotten, and then \
         every triangle takes the wrong micromap triangle. Clear the pointer, or name the type of the indices.",
    ),
    row(
        RuleId::ExtIndexBuffer11821,
        "The host build dereferences the pointer for each triangle, and a null one crashes the process. Point it to \
         the indices in host memory, or set VK_INDEX_TYPE_NONE_KHR where triangles use the micromap in order.",
    ),
    row(
        RuleId::HostMicromap11705,
        "KHR micromaps are built and read by the device only, and a host build cannot look into one. Build the \
         structure with vkCmdBuildAccelerationStructuresKHR, or leave the micromap null and use special indices.",
    ),
];
