//! Rows of rules that the specification states without an identifier.

use super::{Group, Kind, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule { kind: Kind::Own, ..Rule::checked(Group::KhrAccelerationStructure, id, explanation) }
}

/// What is the same of all rules of last resort.
const FALLBACK: &str = "Looked at where no other rule has anything to say of the call.";

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
    row(
        RuleId::Buffer01,
        "Buffers are bound once, to memory that reaches as far as they do, before their address is asked for; and what is \
         created in one ends before it does. Otherwise it names bytes that belong to something else, or to nothing.",
    )
    .noted(FALLBACK),
    row(
        RuleId::CommandBuffer01,
        "A command buffer is recorded between begin and end, executed once it has ended, and not executed again if it was \
         begun for one submission or if something that it names is gone. Primary ones are submitted, secondary ones are \
         executed by primary ones.",
    )
    .noted(FALLBACK),
    row(
        RuleId::Contents01,
        "The command takes an object for something that it does not hold: nothing was built into it, its memory was \
         written since, or it holds or was created for another kind of structure. Build it first, in memory of its own.",
    )
    .noted(FALLBACK),
    row(
        RuleId::DeferredOperation01,
        "An operation carries one command at a time; with a second one the first is lost, or both are. Join the operation \
         until it is complete, or use another.",
    )
    .noted(FALLBACK),
    row(
        RuleId::Index01,
        "A triangle names a micromap triangle that is not there, and hits read whatever lies behind the micromap. Count \
         the base triangle in, and mark triangles without a micromap by special indices.",
    )
    .noted("The KHR extension has a rule on this for device builds; this one is for the EXT extension too."),
    row(
        RuleId::Instance01,
        "An instance refers to no structure, and rays that reach it follow an address into nothing. Refer to a living \
         bottom-level structure, by its address or in host builds by its handle, or to none.",
    )
    .noted("Structures of which the address was not asked for are known if they were created at an address."),
    row(
        RuleId::Memory01,
        "The command reads or writes bytes that no living buffer with memory behind it has, or that the side it runs on \
         cannot reach: the device has no host pointers, and the host maps visible memory only. Count offset, stride and \
         number of elements against the buffer.",
    )
    .noted("How much scratch memory a build writes is known if its sizes were asked for; host memory, if the view knows it."),
    row(
        RuleId::Object01,
        "The handle names nothing that lives, and a driver follows it all the same. Keep objects until the last command \
         that names them has executed.",
    )
    .noted(FALLBACK),
    row(
        RuleId::Overlap01,
        "Builds of one command run in no order and all at once, so what one writes no other may touch, and none may write \
         over its own input. Give each destination and each piece of scratch memory a place of its own, or use several \
         commands.",
    )
    .noted(FALLBACK),
    row(
        RuleId::QueryPool01,
        "The pool has no such query, its queries are of another type, they were not reset before they are written, nothing \
         will ever write what is waited for, or the results do not fit where they go.",
    )
    .noted(FALLBACK),
    row(
        RuleId::Serialized01,
        "The bytes are not a structure that a compatible device serialized, or they refer to structures that are not here. \
         Ask for the compatibility first, and replace the addresses in the header by those of structures that live.",
    )
    .noted("Micromap objects of the EXT extension have rules of their own on this."),
    row(
        RuleId::Size01,
        "What is written takes more room than the destination has, and goes on over what lies behind it. Create the \
         destination as large as the device answers that it has to be, and announce as many primitives as there are.",
    )
    .noted(
        "Judged where the sizes of a build with as many primitives were asked for, or the compacted size.",
    ),
    row(
        RuleId::Update01,
        "An update moves vertices and little else: flags, geometries, their types and counts, and unless the build allowed \
         it the micromaps, are those of the build. Otherwise build anew.",
    )
    .noted("Whether the same primitives are active is not judged: that takes the input of the build, which is gone."),
    row(
        RuleId::Value01,
        "A value has no meaning to this command, an array is not as long as the one that it belongs to, or geometry is of a \
         type that the structure is not built from.",
    )
    .noted(FALLBACK),
];
