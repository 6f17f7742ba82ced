//! Rows of `VkAccelerationStructureTrianglesOpacityMicromapKHR`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::KhrOpacityMicromap, id, explanation)
}

const NOT_FOR_SIZES: &str = "Not asked of a query of build sizes, which ignores addresses.";

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::IndexType11570,
        "The build does not know how wide an index of this type is. Choose 8, 16 or 32 bits, or VK_INDEX_TYPE_NONE_KHR where \
         triangle i of the geometry uses triangle i of the micromap.",
    ),
    row(
        RuleId::IndexBuffer11571,
        "Without an index type no index is read, so an index buffer points to a misunderstanding: either the type was forgotten \
         or the address is left over. Set the one or clear the other.",
    )
    .noted(NOT_FOR_SIZES),
    row(
        RuleId::IndexBuffer11572,
        "The build reads an index for every triangle from an address that belongs to no buffer; on hardware this is a page fault \
         or somebody else's memory. Pass what vkGetBufferDeviceAddress returned for a buffer that still exists, plus an offset \
         inside it.",
    )
    .noted(
        "Not asked of a query of build sizes, which ignores addresses. Apart from 0, an address is judged once the address of \
         any buffer was asked for: a validator that is not shown these calls knows no buffer.",
    ),
    row(
        RuleId::IndexStride11573,
        "The build steps through the index buffer by this stride and would read indices that are not aligned to their size. Use \
         the size of the index type for a tightly packed buffer, or a multiple of it.",
    ),
    row(
        RuleId::IndexStride11574,
        "The stride does not fit into the 32 bits that hardware has for it, and would be cut off. Store the indices closer \
         together.",
    ),
    row(
        RuleId::TriangleIndex11576,
        "Without an index buffer triangle i of the geometry uses triangle i + baseTriangle of the micromap, and the micromap ends \
         before the geometry does: the last triangles read foreign memory. Build a micromap with a triangle for each, lower \
         baseTriangle, or pass indices.",
    )
    .noted(
        "The rule's text lets an index equal to the number of triangles pass; since triangles count from 0 there is none of that \
         index, and we require less. Judged when a build is recorded, if the build of the micromap is known by then.",
    ),
    row(
        RuleId::Micromap11579,
        "Without an index buffer every triangle takes its opacity from the micromap, and there is none. Attach a micromap, or \
         pass an index buffer that holds special indices only, or drop the structure from the chain.",
    ),
    row(
        RuleId::AccelerationStructureTrianglesOpacityMicromapKhrSType,
        "The KHR and EXT structures differ in size and order of members, and sType alone tells them apart; with the \
         wrong one the driver takes an address for a handle or builds without opacity. Set the KHR structure's own \
         type.",
    )
    .implicit(),
    row(
        RuleId::AccelerationStructureTrianglesOpacityMicromapKhrIndexTypeParameter,
        "The value names no index type at all, so the driver cannot know how wide an index is. Use one of the \
         enumerants. The list that the structure's own rule on indexType allows is the whole enumeration, so whoever \
         breaks one breaks both; we report both.",
    )
    .implicit(),
    row(
        RuleId::AccelerationStructureTrianglesOpacityMicromapKhrMicromapParameter,
        "The handle names no acceleration structure, so the build takes the micromap from freed or foreign memory; \
         mostly the micromap was destroyed too early, or a VkMicromapEXT was cast. Keep the micromap alive as long \
         as structures refer to it.",
    )
    .implicit(),
];
