//! Rows of `VkAccelerationStructureGeometryKHR`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::KhrAccelerationStructure, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::MicromapData11568,
        "A micromap's data hangs in the chain of its geometry, since the union has no member for it. Without the structure there \
         is nothing to build, with two a driver may take either. Chain exactly one \
         VkAccelerationStructureGeometryMicromapDataKHR.",
    ),
    row(
        RuleId::Flags11569,
        "Opaque and no-duplicate-any-hit describe surfaces that rays meet; a micromap is not met by rays. Set the flags on the \
         triangle geometry that the micromap is attached to.",
    ),
    row(
        RuleId::AccelerationStructureGeometryPNext,
        "The driver ignores a structure that does not belong here, or a layer between crashes on it; usually a \
         triangles' micromap structure was chained to the geometry instead of to its triangles. Move it to the chain \
         of geometry.triangles, or drop it.",
    )
    .implicit(),
    row(
        RuleId::AccelerationStructureGeometryTrianglesDataPNext,
        "Only motion vertices and micromaps extend triangle data; anything else is passed over by the driver, so \
         what it should have said is lost. The input of a micromap build, for one, belongs to a geometry of its own. \
         A displacement micromap may stand here, and we look no further into it.",
    )
    .implicit(),
];
