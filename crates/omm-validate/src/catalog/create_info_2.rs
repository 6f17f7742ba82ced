//! Rows of `VkAccelerationStructureCreateInfo2KHR`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::CreateAccelerationStructure2, id, explanation)
}

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::FullyBound13097,
        "The flag lets the driver drop its guard against unbound pages, and an access to one then faults instead of \
         reading zeros. Bind the whole range before the object is used, or create it without the flag. The rule \
         belongs to creation but speaks of the time of access, so that is when we judge.",
    ),
    row(
        RuleId::Protected13098,
        "On this device touching protected memory without announcing it faults. Add \
         VK_ADDRESS_COMMAND_PROTECTED_BIT_KHR, or take the range from an unprotected buffer. The rule's sentence is \
         incomplete; we take it to speak of the buffer that the range lies in.",
    ),
    row(
        RuleId::Protected13099,
        "The driver is told to use protected accesses on memory that is not protected, which faults on a device \
         without protectedNoFault. Drop the flag, or create the buffer as a protected one. As in its counterpart, \
         the buffer meant is the one that the range lies in.",
    ),
    row(
        RuleId::StorageUsage13100,
        "One flag says that the memory is used as storage buffer, the other that nobody knows; a driver may rely on \
         either. Keep the one that is true; the unknown flag always works and may cost speed.",
    ),
    row(
        RuleId::StorageUsage13122,
        "Shaders may write the same memory through a storage buffer, and a driver that was not told skips the cache \
         work between the two, so that stale nodes are traced. Add VK_ADDRESS_COMMAND_STORAGE_BUFFER_USAGE_BIT_KHR, \
         or the unknown flag. Buffers count that merely share the memory, also at another address.",
    ),
    row(
        RuleId::StorageUsage13123,
        "The flag promises that every buffer on this memory can be a storage buffer, and one cannot; a driver may \
         choose a way of access that this buffer's memory does not allow. Drop the flag, or use the unknown flag \
         where buffers with and without the usage share memory.",
    ),
    row(
        RuleId::TransformFeedbackUsage13101,
        "The flags say at once that transform feedback writes here and that it is not known. Keep the true one; when \
         in doubt that is the unknown flag.",
    ),
    row(
        RuleId::TransformFeedbackUsage13124,
        "Transform feedback may write the memory behind the object, past caches that the driver then does not flush. \
         Announce it with VK_ADDRESS_COMMAND_TRANSFORM_FEEDBACK_BUFFER_USAGE_BIT_KHR or the unknown flag, or keep \
         acceleration structures out of such buffers.",
    ),
    row(
        RuleId::TransformFeedbackUsage13125,
        "The flag speaks for every buffer that shares the memory, and one of them is not made for transform \
         feedback. Drop it; the unknown flag is there for mixed or uncertain memory.",
    ),
    row(
        RuleId::AddressRange11602,
        "The object would live in memory that belongs to no buffer, and the first build into it faults. Pass the \
         address that vkGetBufferDeviceAddress returned for a live buffer, plus an offset inside it. Buffers are \
         looked up once the address of any was asked for.",
    ),
    row(
        RuleId::AddressRange11603,
        "Either the buffer was not created to hold acceleration structures, and lies in memory that traversal cannot \
         read, or the object reaches past its end and overwrites what follows. Create the buffer with \
         VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR and large enough. The EXT extension's micromap \
         storage usage does not serve here.",
    ),
    row(
        RuleId::AddressRange11604,
        "A sparsely resident buffer may have holes, and a traversal that runs into one reads anything or faults. Use \
         a buffer without VK_BUFFER_CREATE_SPARSE_RESIDENCY_BIT; sparse binding alone is allowed as long as the \
         range is bound.",
    ),
    row(
        RuleId::AddressRange11605,
        "Hardware drops the low eight bits when it stores references to acceleration structures, so another place \
         than the object's would be traced. Round the offset in the buffer up to a multiple of 256; a buffer's own \
         address may need rounding, too.",
    ),
    row(
        RuleId::CaptureReplay11606,
        "The buffer can be replayed at its address but the object in it cannot, so that a captured trace finds \
         references that lead nowhere. Set VK_ACCELERATION_STRUCTURE_CREATE_DEVICE_ADDRESS_CAPTURE_REPLAY_BIT_KHR \
         along with the buffer's flag.",
    ),
    row(
        RuleId::CaptureReplay11607,
        "An object cannot be replayed at an address that its buffer may not get again. Create the buffer with \
         VK_BUFFER_CREATE_DEVICE_ADDRESS_CAPTURE_REPLAY_BIT, or drop the flag here.",
    ),
    row(
        RuleId::AddressRange11608,
        "An object of no bytes has no room for anything, and a driver may place the next one over it. Pass the size \
         that vkGetAccelerationStructureBuildSizesKHR reported.",
    ),
    row(
        RuleId::Feature11609,
        "The device was created without KHR micromaps and its driver cannot make such an object. Enable the feature \
         at device creation; the EXT extension's feature makes micromap objects of its own, not these.",
    ),
    row(
        RuleId::CreateFlags11610,
        "Micromaps are never bound as descriptors, so there is no descriptor data to capture, and a driver may write \
         some for an object it does not expect. Drop the flag; addresses of micromaps are replayed with the device- \
         address flag.",
    ),
    row(
        RuleId::CreateFlags11611,
        "A micromap lies on a triangle wherever that moves, and has no motion of its own; the flag would reserve or \
         select a layout that micromaps do not have. Set it on the structures whose vertices or instances move.",
    ),
    row(
        RuleId::Feature03613,
        "Replaying addresses needs the driver to keep a part of the address space aside, which it does only when \
         asked for at device creation. Enable accelerationStructureCaptureReplay, or drop the flag. It is a feature \
         for capture tools; applications do without.",
    ),
    row(
        RuleId::Feature11673,
        "Across several physical devices an address is the same only with the multi-device feature, so a captured \
         address would be right on one of them at most. Enable bufferDeviceAddressMultiDevice, use one physical \
         device, or drop the flag.",
    ),
    row(
        RuleId::MotionInfo04954,
        "A moving top-level structure stores more for each instance, and without the chained number of instances the \
         driver cannot reserve it. Chain VkAccelerationStructureMotionInfoNV with the most instances that will be \
         built. The rule on this structure's chain does not list it; we take that for an oversight and accept it \
         here.",
    ),
    row(
        RuleId::MotionTriangles04955,
        "The geometry brings vertices for two points in time and the object was made for one, so the second set has \
         no room and is lost or written past the end. Create the destination with \
         VK_ACCELERATION_STRUCTURE_CREATE_MOTION_BIT_NV. Creation knows no geometry, so we look when the object is \
         built.",
    ),
    row(
        RuleId::Feature08108,
        "Capturing descriptor data has to be prepared when the device is created, and otherwise the flag is a bit \
         the driver does not understand. Enable descriptorBufferCaptureReplay, or drop the flag.",
    ),
    row(
        RuleId::OpaqueCapture08109,
        "Captured descriptor data is offered for an object that was not announced as a replayed one, so it is \
         ignored and the replayed descriptors point elsewhere. Set the capture-replay flag for descriptor buffers, \
         or leave the structure out.",
    ),
    row(
        RuleId::AccelerationStructureCreateInfo2SType,
        "Layers and drivers tell by sType what they are looking at; with that of the older creation structure an \
         address range may be read as buffer and offset. Set the new structure's type.",
    )
    .implicit(),
    row(
        RuleId::AccelerationStructureCreateInfo2PNext,
        "The driver passes over what does not belong into this chain, and whatever it should have said is lost. \
         Remove it, or chain it where it belongs. VkAccelerationStructureMotionInfoNV is not on the list, but \
         another rule of the same structure requires it for moving top-level structures, so we let it pass.",
    )
    .implicit(),
    row(
        RuleId::AccelerationStructureCreateInfo2Unique,
        "With two structures of one type a driver takes the first or the last, and the other is lost without a word. \
         Keep one of them.",
    )
    .implicit(),
    row(
        RuleId::AccelerationStructureCreateInfo2CreateFlagsParameter,
        "Bits without a meaning today may get one in a later driver and change what is created; usually they are \
         flags of another type. Clear them.",
    )
    .implicit(),
    row(
        RuleId::AccelerationStructureCreateInfo2AddressFlagsParameter,
        "The driver derives from these flags how it may touch the memory, and an unknown bit makes that \
         unpredictable. Use VkAddressCommandFlagBitsKHR only; buffer usage flags do not belong here.",
    )
    .implicit(),
    row(
        RuleId::AccelerationStructureCreateInfo2TypeParameter,
        "The driver does not know what the object is to hold and picks a layout by chance. Use one of the types; a \
         micromap type of the EXT extension has other numbers.",
    )
    .implicit(),
];
