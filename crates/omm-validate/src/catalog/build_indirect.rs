//! Rows of `vkCmdBuildAccelerationStructuresIndirectKHR`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::KhrAccelerationStructure, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::IndirectInstanceFlags10607,
        "The instances switch micromaps off in a structure that was not built for it, so that traversal may have \
         nothing to fall back to. Build the bottom-level structure with the allow-disable flag. This repeats a rule \
         of the instance itself, and we report both; since the counts lie in device memory we look only if they can \
         be read when the build is recorded.",
    ),
    row(
        RuleId::IndirectMicromap11701,
        "The indirect build reads the micromap when the queue reaches it, and there is only uninitialised memory. \
         Record or submit the micromap's build first, with a barrier between. We decide when the command buffer is \
         submitted.",
    ),
    row(
        RuleId::IndirectMicromapType11624,
        "What the handle names holds boxes, triangles or instances, and the indirect build would take its nodes for \
         opacity. Attach the structure that the micromap was built into.",
    ),
    row(
        RuleId::IndirectUpdateMicromap11625,
        "An update keeps the shape of the structure, and with it the room for micromap references; without a \
         micromap the references of the first build stay behind or are overwritten. Give the updated geometry a \
         micromap again. Reusing the geometry description of the first build, with new addresses, avoids this.",
    ),
    row(
        RuleId::IndirectUpdateNullMicromap11626,
        "The geometry was laid out for whole-triangle states only; an indirect update can neither add a reference to \
         a micromap nor forget the states. Repeat the structure with a null micromap.",
    ),
    row(
        RuleId::IndirectUpdateNewMicromap11627,
        "Opacity cannot be brought in by an update, indirect or not, as the nodes have no place for it. Leave the \
         structure out, or rebuild with it.",
    ),
    row(
        RuleId::IndirectUpdateOrigin11628,
        "The structure came back from serialized data and keeps to the micromaps it was first built with; an \
         indirect update may not bring in others. Deserialize the micromap from the data saved beside the structure \
         and attach that one. Only origins that we could follow are judged.",
    ),
    row(
        RuleId::IndirectUpdateSameMicromap11629,
        "Without an update flag the triangles keep the layout of the micromap they were built with, and an indirect \
         update with another one mixes the two. Pass the original handle, or build with the micromap-update flag. We \
         read the rule as speaking of builds with neither of the two flags.",
    ),
    row(
        RuleId::IndirectExtMicromap11632,
        "The queue reaches the indirect build before anything was written into the micromap object. Submit its build \
         or copy first. A null micromap, which the chapter allows where all indices are special, is not asked for.",
    ),
    row(
        RuleId::IndirectExtIndexBuffer10904,
        "An address that is never read hints at a forgotten index type, and then triangles take opacity in the wrong \
         order. Clear it, or set the type of the indices.",
    ),
    row(
        RuleId::IndirectExtIndexBuffer10905,
        "The device fetches indices from an address that belongs to no buffer and faults in the middle of an \
         indirect build. Pass what vkGetBufferDeviceAddress returned for a live buffer.",
    ),
    row(
        RuleId::IndirectType11557,
        "The extent of a micromap comes from its usage counts on the host, and there is nothing that an indirect \
         build could read from device memory instead; drivers have no such path. Build it with \
         vkCmdBuildAccelerationStructuresKHR.",
    ),
];
