//! Rows of rules that the specification states without an identifier.

use super::{Group, Kind, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule { kind: Kind::Own, ..Rule::checked(Group::KhrAccelerationStructure, id, explanation) }
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::HostBuild01,
        "Micromaps of the KHR extension are built by device commands alone: their input has device addresses only, and a \
         driver has no code that builds them on the host. Record vkCmdBuildAccelerationStructuresKHR instead.",
    )
    .noted("The chapter says so of the build type that sizes are asked for, and of nothing else."),
    row(
        RuleId::CopySize01,
        "A clone takes as much room as its source, and the copy writes over what lies behind the destination. Create the \
         destination as large as the source.",
    )
    .noted("Judged of clones where both objects are known; how much a compaction takes is known to the device alone."),
    row(
        RuleId::CopyOverlap02,
        "Source and destination share memory, so that the copy reads what it has written already and leaves neither of \
         them whole. Give the destination memory of its own.",
    )
    .noted("Judged where the addresses of both objects are known."),
    row(
        RuleId::CopyType03,
        "A copy holds what its source holds, and the destination was made for something else. Create both with the same \
         type, or the destination with the generic one.",
    )
    .noted("Judged where both objects are known, by the types that they were created with."),
    row(
        RuleId::PartlyNan01,
        "NaN as the x of a triangle's first vertex takes the triangle out; NaN anywhere else in an active triangle gives \
         it bounds that compare with nothing, and drivers differ in what rays then meet. Write NaN to every x, or \
         numbers everywhere.",
    )
    .noted(
        "The section on inactive primitives asks this of every vertex. Three-component 32-bit positions are looked at, \
         without their transform; the first vertex that breaks the rule is reported. Memory is read when the build is \
         checked.",
    ),
];
