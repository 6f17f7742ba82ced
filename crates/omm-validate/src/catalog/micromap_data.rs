//! Rows of `VkAccelerationStructureGeometryMicromapDataKHR`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::KhrOpacityMicromap, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::UsageCounts11642,
        "The usage counts can be passed as an array or as an array of pointers. With both, the driver has no way to tell which \
         one describes the micromap, and may size memory from one and build from the other. Set one of the two pointers to NULL.",
    ),
    row(
        RuleId::TotalCount11643,
        "The usage counts add up to more triangles than the device can hold in one micromap; sizes derived from them may wrap \
         around. Split the micromap into several and let each geometry refer to its own.",
    ),
    row(
        RuleId::TwoStateLevel11645,
        "The usage counts announce 2-state triangles that are subdivided more finely than the device can look up. Bake them at \
         a coarser level, or split the mesh triangle.",
    ),
    row(
        RuleId::TriangleArrayStride11646,
        "An entry of the triangle array takes 8 bytes. With a smaller stride neighbouring entries overlap, and the build reads \
         one triangle's format as the next one's offset. Use 8 for a tightly packed array.",
    ),
    row(
        RuleId::TriangleArrayStride11647,
        "Entries of the triangle array begin with a 32-bit number, and hardware reads them aligned to 4 bytes. Pad the entries \
         to a multiple of 4.",
    ),
    row(
        RuleId::AccelerationStructureGeometryMicromapDataSType,
        "A driver walks the chain by sType and does not recognise this structure, so the micromap has no data, or it \
         reads the bytes as another structure. Set sType to \
         VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_MICROMAP_DATA_KHR.",
    )
    .implicit(),
    row(
        RuleId::AccelerationStructureGeometryMicromapDataUsageCountsParameter,
        "The driver reads as many usage counts as announced; a dangling pointer or too large a count makes it read \
         foreign host memory and size the micromap from it. Let the count be the length of the array that \
         pUsageCounts points to. A wrong format inside an entry is the business of that structure's own rule.",
    )
    .implicit()
    .structural(
        "A Call holds the usage counts as an optional list, so a count that disagrees with the array or a pointer to \
         foreign memory does not exist.",
    ),
    row(
        RuleId::AccelerationStructureGeometryMicromapDataUsageCountPointersParameter,
        "With ppUsageCounts the driver follows one pointer for each usage, and a null or stale one crashes it on the \
         host. Fill every element, and let the count be the number of pointers.",
    )
    .implicit()
    .structural(
        "A Call holds the usages behind ppUsageCounts by value, so a null or dangling pointer in the array, or a \
         wrong length, does not exist.",
    ),
    row(
        RuleId::MicromapUsageFormatParameter,
        "The device needs the format to know how many bits a microtriangle takes, and computes sizes from a \
         meaningless one; often the usage was left at zero. Store 1 for 2-state or 2 for 4-state.",
    )
    .implicit(),
];
