//! Rows of `vkCmdBuildAccelerationStructuresKHR`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::KhrAccelerationStructure, id, explanation)
}

const FIRST_ENTRY: &str = "The first entry that breaks the rule is reported. Memory is read when the build is checked.";

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::BuildRangeInfos11544,
        "A micromap's extent comes from its usage counts, not from build ranges, and a range here suggests a geometry that was \
         meant to be something else. Put NULL in the place of this build.",
    ),
    row(
        RuleId::Mode11545,
        "Micromaps cannot be updated. Build the micromap again, and update the structures that refer to it.",
    ),
    row(
        RuleId::SrcAccelerationStructure11546,
        "Only an update has a source, and micromaps cannot be updated. Pass VK_NULL_HANDLE.",
    ),
    row(
        RuleId::DstAccelerationStructure11547,
        "The object was created for another type, and a driver may have prepared it for that type alone. Create it with \
         VK_ACCELERATION_STRUCTURE_TYPE_OPACITY_MICROMAP_KHR, or with the generic type.",
    )
    .noted("Judged if the object's creation was tracked."),
    row(
        RuleId::Alignment11552,
        "The build loads the opacity data and the triangle array in blocks of 128 bytes. Move the array to an aligned offset in \
         its buffer.",
    ),
    row(
        RuleId::TriangleArrayRange11554,
        "The usage counts announce more triangles than the buffer has room for from the address on, so that the build reads past \
         its end. Correct the counts, the stride or the address; the padding behind the last entry counts too.",
    )
    .noted("Judged if the address lies in a buffer whose address was asked for, in the largest one where buffers overlap."),
    row(
        RuleId::TriangleFormat11555,
        "An entry of the triangle array has a format that no device knows, so how many bits a state takes is undefined; often \
         the sign of a wrong stride or of memory that was not written yet. Store 1 for 2-state or 2 for 4-state.",
    )
    .noted(FIRST_ENTRY),
    row(
        RuleId::TwoStateLevel11556,
        "An entry of the triangle array is a 2-state triangle subdivided more finely than the device can look up, whatever the \
         usage counts say. Bake it at a coarser level.",
    )
    .noted(FIRST_ENTRY),
    row(
        RuleId::Index11575,
        "An index plus baseTriangle names a triangle that the micromap does not have, so the triangle's opacity is read from \
         foreign memory. Correct the index, lower baseTriangle, or use a special index.",
    )
    .noted(
        "The rule's text lets an index equal to the number of triangles pass and looks at indices above 0 only; since triangles \
         count from 0 we require less, of every index that is not special. The first index that breaks the rule is reported. \
         Memory is read when the build is checked; judged if the build of the micromap is known by then.",
    ),
    row(
        RuleId::SpecialIndex11578,
        "Without a micromap an index can only say that the whole triangle has one state. Use -1 to -4 cast to the index type, or \
         attach the micromap.",
    )
    .noted("The first index that breaks the rule is reported. Memory is read when the build is checked."),
    row(
        RuleId::BuildRangeInfos11543,
        "The build takes the number of primitives of each geometry from here, and a null or short array makes the \
         driver read past it on the host. Pass one range for each geometry. The rule holds the build's type against \
         a geometry type, which can never be equal; we exempt micromap builds, and builds with a geometry of the \
         dense AMDX type.",
    ),
    row(
        RuleId::DstAccelerationStructure11548,
        "Builds of one command run in any order and at once, so the micromap is written while another build reads \
         it. Build micromaps in a command before, with a barrier between. The rule speaks of other elements only; an \
         element that refers to its own destination overwrites what it reads just the same, and we report it too.",
    ),
    row(
        RuleId::DstAccelerationStructure11549,
        "Two objects share bytes, and the build writes its result over the micromap that another build of the \
         command is reading. Give them memory of their own, or split the command and keep to the order. We compare \
         whole objects, as nobody but the driver knows which part is touched, and also look at an element's own \
         micromaps, which the words leave out.",
    ),
    row(
        RuleId::MicromapData11550,
        "Data and triangle array are read by the device from these addresses, and outside every buffer that is a \
         page fault. Pass what vkGetBufferDeviceAddress returned for a live buffer, plus an offset inside it. \
         Buffers are looked up once the address of any was asked for.",
    ),
    row(
        RuleId::MicromapData11551,
        "A driver places buffers and flushes caches by their declared usage, and a build may read stale or \
         unreachable bytes from one that was not announced as its input. Add \
         VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR when creating the buffer; the EXT \
         extension's micromap usage is another bit. Where several buffers share the address one with the usage \
         suffices.",
    ),
    row(
        RuleId::DataRange11553,
        "The triangle's opacity lies partly behind the end of the buffer, so the build reads foreign memory. Correct \
         dataOffset or the level, or make the buffer larger; offsets count in bytes from data, not from the buffer's \
         start. The range lost its plus sign in the rule's text; we take it as offset to offset plus size, end \
         excluded. The first such entry is reported, as memory is when the build is recorded.",
    ),
    row(
        RuleId::IndexRange11577,
        "The build fetches one index for each triangle and runs past the end of the buffer, so the last triangles \
         get somebody else's bytes as opacity. Make the buffer larger, or correct stride, address or primitive \
         count. Padding behind the last index counts, as the rule multiplies stride by count; its text lost the plus \
         sign between address and product.",
    ),
    row(
        RuleId::InstanceFlags10607,
        "An instance switches off the micromaps of a structure that was not built to be traced without them; drivers \
         may ignore the flag or lose the geometry's own opacity. Set the allow-disable flag when the bottom-level \
         structure is built. The rule names the address of the instance array where it must mean the structure that \
         each instance refers to, and repeats a rule of the instance; we read it so, and report both.",
    ),
    row(
        RuleId::Micromap11701,
        "The memory of the micromap holds nothing yet when the build reads it, so opacity becomes garbage or the \
         device faults. Submit the micromap's build before, or record it earlier with a barrier; builds of one \
         command do not wait for each other. What is not certain when the command is recorded is judged when it is \
         submitted.",
    ),
    row(
        RuleId::MicromapType11624,
        "Micromaps share their handle type with other structures, so a mixed-up handle compiles; the build then \
         reads tree nodes as opacity states. Pass the structure that was built with the micromap type, also where \
         the object was created as generic.",
    ),
    row(
        RuleId::UpdateMicromap11625,
        "The update only refits what is there, and the triangles still expect opacity from a micromap that it no \
         longer names; the device reads a stale reference. Chain a micromap to this geometry as the original build \
         did, or rebuild the structure without.",
    ),
    row(
        RuleId::UpdateNullMicromap11626,
        "The first build stored one state for each triangle and no room for a micromap; an update that brings one \
         writes where nothing was reserved, and one without the structure leaves the states undefined. Keep the \
         structure with a null micromap, or rebuild.",
    ),
    row(
        RuleId::UpdateNewMicromap11627,
        "A structure built without micromaps has no place to refer to one, and refitting does not make one. Rebuild \
         the structure with the micromap; an update may only keep what the build began with.",
    ),
    row(
        RuleId::UpdateOrigin11628,
        "The structure was not built to have micromaps exchanged, so after deserialization the update has to name \
         the same opacity again, brought over from the saved data; any other may differ in levels and formats. \
         Deserialize the micromap that was saved with it, or build with the micromap-update flag. The rule names the \
         device's deserialization only; we treat the host's alike, and stay silent about data whose origin we cannot \
         follow.",
    ),
    row(
        RuleId::UpdateSameMicromap11629,
        "The structure may have copied or rearranged what it knows of its micromap, and refitting it against another \
         one leaves the two out of step. Pass the same handle as the build did, or build with \
         VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_OPACITY_MICROMAP_UPDATE_BIT_KHR. The words can be read as lacking \
         either flag or lacking both; since no build may have both we take them as lacking both.",
    ),
    row(
        RuleId::ExtMicromap11632,
        "The build reads the micromap object while its memory holds nothing, so opacity is garbage. Build it with \
         vkCmdBuildMicromapsEXT before, with a barrier between, or on the host. The rule's words make no exception \
         for a null micromap; the chapter allows one where all indices are special, and so do we.",
    ),
    row(
        RuleId::ExtIndexBuffer10904,
        "With VK_INDEX_TYPE_NONE_KHR no index is fetched, so the address says that something else was meant. Set it \
         to 0, or name the type of the indices that lie there.",
    ),
    row(
        RuleId::ExtIndexBuffer10905,
        "The index of every triangle is fetched from here, and an address outside every buffer is a page fault or \
         somebody else's data. Pass the address of a live buffer; a host pointer serves host builds only. Buffers \
         are looked up once the address of any was asked for.",
    ),
];
