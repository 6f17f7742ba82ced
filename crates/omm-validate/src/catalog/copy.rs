//! Rows of `VkCopyAccelerationStructureToMemoryInfoKHR`, `VkCopyMemoryToAccelerationStructureInfoKHR`,
//! `vkCmdCopyAccelerationStructureKHR`, `vkCmdCopyAccelerationStructureToMemoryKHR`,
//! `vkCmdCopyMemoryToAccelerationStructureKHR` and `vkCopyAccelerationStructureKHR`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::KhrAccelerationStructure, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::SrcMicromaps11582,
        "A deserialized structure finds its micromaps by address only; if other data lies there, what gets \
         serialized now refers to opacity that never belonged to it. Deserialize every micromap from the data saved \
         with the structure before serializing again, or replace it by an update. Where data was moved in a way we \
         cannot follow we say nothing about its origin.",
    ),
    row(
        RuleId::BlockFeature11584,
        "The serialized structure refers to KHR micromaps, which this device was created without, so its triangles \
         would point to objects that cannot exist. Enable the KHR feature, or deserialize a structure that was built \
         without micromaps. The EXT feature does not help here.",
    ),
    row(
        RuleId::BlockAddress11585,
        "The addresses in the data are those of the session that wrote it; unpatched they point anywhere now, and \
         tracing reads opacity from foreign memory. Create and fill the micromaps first, write their addresses into \
         the blocks, then deserialize. The rule wants constructed micromaps while the proposal is content with \
         created ones; we follow the rule, and take any micromap for a compatible one since the word is not defined.",
    ),
    row(
        RuleId::SrcMicromaps11634,
        "Copying and compacting may follow the references to micromaps, and after deserialization those are right \
         only once the micromaps were deserialized, too. Restore each micromap from the data saved with the \
         structure before copying, or replace it by an update. Where we cannot follow how data was moved we say \
         nothing about its origin.",
    ),
    row(
        RuleId::DstAddress11699,
        "The device writes serialized data in aligned blocks and may tear or misplace it at another address. Move \
         the destination to a multiple of 256: another rule asks that of every serialization, so this one is never \
         broken without it. We report it nevertheless, because it is the one that speaks of micromaps.",
    ),
    row(
        RuleId::SrcAddress11700,
        "The device reads serialized data in aligned blocks, and at another address it reads the wrong ones. Move \
         the data to a multiple of 256, which another rule asks of every deserialization. The rule stands under the \
         serializing command, where src is a handle and has no address; we check it at deserialization, for which it \
         was plainly written.",
    ),
    row(
        RuleId::SrcMicromaps11587,
        "The host copies a structure whose micromaps are not the ones it was saved with, so the copy carries \
         references to the wrong opacity, or to memory not written yet. Deserialize the micromaps first, from the \
         data saved with the structure. Data whose origin we cannot follow is not judged.",
    ),
];
