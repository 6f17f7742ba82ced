//! Rows of `VkAccelerationStructureBuildGeometryInfoKHR`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::KhrAccelerationStructure, id, explanation)
}

const FIRST_ENTRY: &str = "The first entry that breaks the rule is reported. Memory is read when the build is checked.";

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::Type03654,
        "An object may be created without saying what it will hold, but a build has to know. Name the type that is built.",
    ),
    row(
        RuleId::Flags03796,
        "The two preferences contradict each other, and drivers differ in which one they follow. Keep the one that matters more.",
    ),
    row(
        RuleId::Flags11558,
        "One flag lets updates attach other micromaps, the other promises that only the opacity values of the same micromaps \
         change; a structure cannot be laid out for both. Keep the one that fits the updates to come.",
    )
    .noted(
        "The rule's text has no condition on the type of the structure, although only bottom-level structures can have \
         micromaps; we apply it to every type.",
    ),
    row(
        RuleId::GeometryCount11560,
        "A micromap is built from one geometry that carries its data; a driver reads the first and may ignore or misread others. \
         Give each micromap its own entry of pInfos.",
    ),
    row(
        RuleId::GeometryType11561,
        "The build takes a micromap's data from the chain of a geometry of type VK_GEOMETRY_TYPE_MICROMAP_KHR; in a geometry of \
         another type it looks for vertices, boxes or instances. Set the geometry's type, or the type of the build.",
    ),
    row(
        RuleId::Flags11562,
        "A micromap build knows compaction, the two preferences of speed and lossy storage. The other flags are made for \
         structures that hold geometry: their updates, motion, scratch memory and attached micromaps. Remove them.",
    ),
    row(
        RuleId::Type11563,
        "Only the opacity states of a micromap may be stored lossily; other structures have nothing that could be. Remove the \
         flag, or build a micromap.",
    ),
    row(
        RuleId::FourStateLevel11564,
        "The usage counts announce 4-state triangles that are subdivided more finely than the device can store exactly. Bake \
         them at a coarser level, or allow lossy storage where the device's limit for it is higher.",
    ),
    row(
        RuleId::LossyLevel11565,
        "The usage counts announce triangles that are subdivided more finely than the device can store even with losses. Bake \
         them at a coarser level.",
    )
    .noted("The limit's name speaks of the 4-state format, the rule's text of every format; we apply it to every format."),
    row(
        RuleId::FourStateLevel11566,
        "An entry of the triangle array is a 4-state triangle subdivided more finely than the device can store exactly, whatever \
         the usage counts say. Bake it at a coarser level, or allow lossy storage where the device's limit for it is higher.",
    )
    .noted(FIRST_ENTRY),
    row(
        RuleId::LossyLevel11567,
        "An entry of the triangle array is subdivided more finely than the device can store even with losses, whatever the usage \
         counts say. Bake it at a coarser level.",
    )
    .noted(FIRST_ENTRY),
    row(
        RuleId::Flags11709,
        "Updates of opacity data alone exist in the EXT extension only; a device created without its feature may \
         ignore the flag and lay the structure out so that the later update corrupts it. Enable the EXT feature, or \
         drop the flag and rebuild. The rule is stated for every type of structure, and so we apply it, though only \
         a bottom-level one has micromaps.",
    ),
    row(
        RuleId::Flags11710,
        "The flag asks for room to exchange micromaps on a device that was created without micromaps, where its bit \
         has no meaning. Enable the KHR or the EXT feature at device creation, or drop the flag. It holds for every \
         type of structure, as the rule states no type.",
    ),
    row(
        RuleId::Flags11711,
        "There are no micromaps that an instance could switch off on this device, and a driver may take the bit for \
         something else. Enable a micromap feature or drop the flag. We ask it of every type of structure, since the \
         rule names none.",
    ),
    row(
        RuleId::Feature11559,
        "The device was created without KHR micromaps, so its driver does not know this type and may build anything \
         or fail. Chain VkPhysicalDeviceOpacityMicromapFeaturesKHR with micromap set when creating the device; the \
         EXT extension's feature does not count here.",
    ),
    row(
        RuleId::GeometryType11707,
        "Rays meet triangles, boxes and instances; a micromap inside a bottom- or top-level structure is nothing \
         they could meet, and the driver reads the unused union as geometry. Build the micromap as a structure of \
         its own and attach it to triangles by handle.",
    ),
    row(
        RuleId::LossyFormat11712,
        "Lossy storage replaces states by unknown ones, which 2-state triangles cannot express, so no driver can \
         keep such a triangle's promise. Bake the triangles as 4-state, or build without the lossy flag.",
    ),
    row(
        RuleId::LossyFormat11713,
        "The counts were in order but an entry of the triangle array is 2-state, and the unknown states of lossy \
         storage do not fit into one bit. Bake the triangle as 4-state, or drop the lossy flag. The first such entry \
         is reported, as memory is when the build is recorded.",
    ),
];
