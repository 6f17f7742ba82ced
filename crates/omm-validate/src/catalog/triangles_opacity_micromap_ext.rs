//! Rows of `VkAccelerationStructureTrianglesOpacityMicromapEXT`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::ExtOpacityMicromap, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::AttachedUsageCounts07335,
        "The counts of the attached micromap can be given as an array or as an array of pointers. With both, a \
         driver may size the bottom-level structure from one and fill it from the other. Set one of the two pointers \
         to NULL.",
    ),
    row(
        RuleId::AttachedIndexType10719,
        "The EXT extension reads micromap indices of 16 or 32 bits; 8-bit indices came only with the KHR extension, \
         and a driver of the older one reads two of them as one. Widen the indices, or use the KHR structure. Values \
         that are no index type at all are reported under the rule on valid enumerants.",
    ),
    row(
        RuleId::AttachedIndexStride10722,
        "The build walks through the index buffer by this stride, and hardware loads an index from an address \
         aligned to its size. Use the size of the index type for a packed buffer, or a multiple of it. A stride of 0 \
         is a multiple too: every triangle then uses the same index.",
    ),
    row(
        RuleId::AttachedIndexStride10723,
        "Hardware and command streams have 32 bits for the stride; the upper half of a larger one is lost and the \
         build reads indices from the wrong places. Store the indices closer together. The rule writes the limit as \
         232-1, which is 2 to the power of 32, less 1, with the raised digits lost.",
    ),
    row(
        RuleId::AttachedUsageFormat11679,
        "The counts say how many triangles of which format the geometry will use, and a driver sizes the bottom- \
         level structure by them; for a format that nobody knows it has no size. Write 1 for 2-state or 2 for \
         4-state. Looked at if the micromap is known to the validator, since the format is meant for its type.",
    ),
    row(
        RuleId::AttachedTwoStateLevel11680,
        "The geometry announces 2-state triangles divided more finely than the device can look up during traversal, \
         so the space kept for them is computed from a level that does not exist. Announce the level that the \
         micromap was really built with, or bake coarser. The text says \"build\" where its neighbour says \
         \"construct\"; we take the type that the micromap object was created with in both.",
    ),
    row(
        RuleId::AttachedFourStateLevel11681,
        "The geometry announces 4-state triangles divided more finely than the device can look up during traversal, \
         so the space kept for them is computed from a level that does not exist. Announce the level that the \
         micromap was really built with, or bake coarser. The text says \"build\" where its neighbour says \
         \"construct\"; we take the type that the micromap object was created with in both.",
    ),
    row(
        RuleId::AttachedDisplacementFormat11682,
        "A displacement micromap counts its triangles by the three block formats of the NV extension; another number \
         tells the driver nothing about their size. Use one of the three. The device of this project does not \
         simulate displacement and says so; the rule is checked on the raw numbers. That a displacement micromap \
         hangs in the opacity structure at all is forbidden by no rule, odd as it is.",
    ),
    row(
        RuleId::AttachedDisplacementLevel11683,
        "The counts announce displacement triangles finer than the device displaces. Lower the level. Displacement \
         itself is not simulated here; only the number is compared with the limit of the profile. As with the \
         format, nothing forbids to attach such a micromap as opacity.",
    ),
    row(
        RuleId::AccelerationStructureTrianglesOpacityMicromapExtSType,
        "A driver walks the chain by these numbers and passes over one it does not know: the geometry is built as if \
         no micromap were attached, without any error. Copying the structure of the KHR extension and its number is \
         the usual cause; use the EXT number.",
    )
    .implicit(),
    row(
        RuleId::AccelerationStructureTrianglesOpacityMicromapExtIndexTypeParameter,
        "A number that is no index type tells the driver nothing about how wide an index is; most look it up in a \
         table without a bounds check. Use 16 or 32 bits, or none. Types that exist but are not allowed here are \
         reported under 10719.",
    )
    .implicit(),
    row(
        RuleId::AccelerationStructureTrianglesOpacityMicromapExtUsageCountsParameter,
        "The driver reads as many counts as announced; from an array that is shorter, or a pointer that has gone \
         stale, it reads garbage and sizes the bottom-level structure by it. Keep the array alive during the call \
         and its length in step with usageCountsCount.",
    )
    .implicit()
    .structural(
        "A Call holds the elements themselves in a Vec; a pointer that is neither NULL nor valid, or an array \
         shorter than its count, cannot be written down.",
    ),
    row(
        RuleId::AccelerationStructureTrianglesOpacityMicromapExtUsageCountPointersParameter,
        "Each of the announced pointers is followed, and a null or stale one among them crashes the driver in the \
         middle of a geometry. Fill all usageCountsCount elements with pointers to living counts.",
    )
    .implicit()
    .structural(
        "A Call holds the elements themselves in a Vec; a pointer that is neither NULL nor valid, or an array \
         shorter than its count, cannot be written down.",
    ),
    row(
        RuleId::AccelerationStructureTrianglesOpacityMicromapExtMicromapParameter,
        "The build of the bottom-level structure copies from the micromap or keeps a reference to it, and a \
         destroyed one is freed memory. Keep the micromap until the build has ended, and longer unless the sizes \
         said that it may be discarded. A null handle is allowed where every index is special.",
    )
    .implicit(),
];
