//! Rows of `VkAccelerationStructureCreateInfoKHR`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::KhrAccelerationStructure, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[row(
    RuleId::Type11600,
    "A micromap lives in a range of addresses, which the older creation command has no parameters for, so a \
         driver has no path that makes one from a buffer. Create it with vkCreateAccelerationStructure2KHR.",
)];
