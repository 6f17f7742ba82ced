//! Rows of `vkCopyMemoryToMicromapEXT`, `vkCopyMicromapEXT` and `vkCopyMicromapToMemoryEXT`.

use super::{Group, Rule};
use crate::rule::RuleId;

const fn row(id: RuleId, explanation: &'static str) -> Rule {
    Rule::checked(Group::ExtOpacityMicromap, id, explanation)
}

const HOST_MEMORY: &str =
    "Null and device addresses are seen always, others where the view of memory knows host memory.";

pub(super) const ROWS: &[Rule] = &[
    row(
        RuleId::DeserializeDeferredOperation03678,
        "A deferred operation holds the work of one command; given to a second one while threads still join the \
         first, its queue of work is overwritten under them. Join until it is complete before it is passed to \
         vkCopyMemoryToMicromapEXT, or create another operation.",
    ),
    row(
        RuleId::HostDeserializePointer07563,
        "The CPU reads the serialized bytes through this pointer; a device address put into the union looks like one \
         and crashes. Pass a pointer to the data, valid until the copy, deferred or not, has ended.",
    )
    .noted(HOST_MEMORY),
    row(
        RuleId::HostDeserializeAlignment07564,
        "Drivers read serialized data with 16-byte vector loads, which fault on an odd address. Allocate with that \
         alignment; a pointer into the middle of a file read into a byte array seldom has it.",
    ),
    row(
        RuleId::HostDeserializeDstMemory07565,
        "Host commands run on the CPU, which unpacks the data through a mapping of the micromap's memory; device- \
         local memory without host access has none. Bind the buffer to a host-visible memory type, or record the \
         device command instead.",
    ),
    row(
        RuleId::HostDeserializeFeature07566,
        "Deserializing on the CPU is optional, and few drivers offer it; without the feature the function may be a \
         stub that crashes. Enable micromapHostCommands where the device supports it, or record the command of the \
         device timeline.",
    ),
    row(
        RuleId::HostDeserializeDstInstances07567,
        "Memory with several instances has one copy on each GPU of a device group, and the CPU cannot say which one \
         it is to fill. Allocate from a heap without instances, or with a device mask of one bit.",
    ),
    row(
        RuleId::CopyMemoryToMicromapDeviceParameter,
        "Deserialization asks the device which data it can read, and there is no such device. Calls dispatch through \
         the handle, so a wrong one usually crashes in the loader. Pass what vkCreateDevice returned. If it is \
         unknown, nothing else of the call is checked, as features and limits are unknown too.",
    )
    .implicit(),
    row(
        RuleId::CopyMemoryToMicromapDeferredOperationParameter,
        "The deserialization would wait in an object that was destroyed or never made. Create the operation with \
         vkCreateDeferredOperationKHR and destroy it after it is complete, or pass VK_NULL_HANDLE to do the work in \
         the call.",
    )
    .implicit(),
    row(
        RuleId::CopyMemoryToMicromapInfoParameter,
        "The host command reads its parameters through this pointer, at the latest when it is joined if deferred. \
         Keep the structure alive until then.",
    )
    .implicit()
    .structural(
        "A Call holds the structure itself and not a pointer to it, so the pointer is always there; what stands in \
         the structure is checked under its own rules.",
    ),
    row(
        RuleId::CopyMemoryToMicromapDeferredOperationParent,
        "The operation belongs to another device, whose threads know nothing of this micromap. Create one operation \
         on each device that defers commands.",
    )
    .implicit(),
    row(
        RuleId::CopyDeferredOperation03678,
        "A deferred operation holds the work of one command; given to a second one while threads still join the \
         first, its queue of work is overwritten under them. Join until it is complete before it is passed to \
         vkCopyMicromapEXT, or create another operation.",
    ),
    row(
        RuleId::HostCopySrcMemory07558,
        "Host commands run on the CPU, which reads the source through a mapping of the micromap's memory; device- \
         local memory without host access has none. Bind the buffer to a host-visible memory type, or record the \
         device command instead.",
    ),
    row(
        RuleId::HostCopyDstMemory07559,
        "Host commands run on the CPU, which writes the copy through a mapping of the micromap's memory; device- \
         local memory without host access has none. Bind the buffer to a host-visible memory type, or record the \
         device command instead.",
    ),
    row(
        RuleId::HostCopyFeature07560,
        "Copying micromaps on the CPU is optional, and few drivers offer it; without the feature the function may be \
         a stub that crashes. Enable micromapHostCommands where the device supports it, or record the command of the \
         device timeline.",
    ),
    row(
        RuleId::HostCopySrcInstances07561,
        "Memory with several instances has one copy on each GPU of a device group, and the CPU cannot say which one \
         it is to read. Allocate from a heap without instances, or with a device mask of one bit.",
    ),
    row(
        RuleId::HostCopyDstInstances07562,
        "Memory with several instances has one copy on each GPU of a device group, and the CPU cannot say which one \
         it is to write the copy into. Allocate from a heap without instances, or with a device mask of one bit.",
    ),
    row(
        RuleId::HostCopySource11670,
        "The CPU copies what the source holds, and before a build that is nothing with a size. Build the source \
         first; a deferred build counts only once it is joined to its end, and a device build once its submission \
         has completed.",
    ),
    row(
        RuleId::CopyMicromapDeviceParameter,
        "A host copy is carried out by the device that owns both micromaps, and this handle names none. Calls \
         dispatch through the handle, so a wrong one usually crashes in the loader. Pass what vkCreateDevice \
         returned. If it is unknown, nothing else of the call is checked, as features and limits are unknown too.",
    )
    .implicit(),
    row(
        RuleId::CopyMicromapDeferredOperationParameter,
        "The copy would be deferred to an object that was destroyed or never made. Create the operation with \
         vkCreateDeferredOperationKHR and destroy it after it is complete, or pass VK_NULL_HANDLE to do the work in \
         the call.",
    )
    .implicit(),
    row(
        RuleId::CopyMicromapInfoParameter,
        "A host copy may be carried out by joining threads later, which read the parameters then. Keep the structure \
         alive until the operation is complete.",
    )
    .implicit()
    .structural(
        "A Call holds the structure itself and not a pointer to it, so the pointer is always there; what stands in \
         the structure is checked under its own rules.",
    ),
    row(
        RuleId::CopyMicromapDeferredOperationParent,
        "An operation of another device keeps its bookkeeping there, and the copy would be joined with foreign \
         state. Create one operation on each device that defers commands.",
    )
    .implicit(),
    row(
        RuleId::SerializeDeferredOperation03678,
        "A deferred operation holds the work of one command; given to a second one while threads still join the \
         first, its queue of work is overwritten under them. Join until it is complete before it is passed to \
         vkCopyMicromapToMemoryEXT, or create another operation.",
    ),
    row(
        RuleId::HostSerializeSrcMemory07568,
        "Host commands run on the CPU, which reads the micromap through a mapping of the micromap's memory; device- \
         local memory without host access has none. Bind the buffer to a host-visible memory type, or record the \
         device command instead.",
    ),
    row(
        RuleId::HostSerializePointer07569,
        "The CPU writes the serialized bytes through this pointer; null, freed memory or a device address crashes \
         the application or, worse, does not. Pass host memory of the serialization size.",
    )
    .noted(HOST_MEMORY),
    row(
        RuleId::HostSerializeAlignment07570,
        "The host writes the serialized form with 16-byte vector stores, which fault on an odd address. Allocate the \
         destination with an alignment of 16.",
    ),
    row(
        RuleId::HostSerializeFeature07571,
        "Serializing on the CPU is optional, and few drivers offer it; without the feature the function may be a \
         stub that crashes. Enable micromapHostCommands where the device supports it, or record the command of the \
         device timeline.",
    ),
    row(
        RuleId::HostSerializeSrcInstances07572,
        "Memory with several instances has one copy on each GPU of a device group, and the CPU cannot say which one \
         it is to serialize. Allocate from a heap without instances, or with a device mask of one bit.",
    ),
    row(
        RuleId::CopyMicromapToMemoryDeviceParameter,
        "The identifiers in front of serialized data come from the device, and this handle names none. Calls \
         dispatch through the handle, so a wrong one usually crashes in the loader. Pass what vkCreateDevice \
         returned. If it is unknown, nothing else of the call is checked, as features and limits are unknown too.",
    )
    .implicit(),
    row(
        RuleId::CopyMicromapToMemoryDeferredOperationParameter,
        "The serialization would be handed to an object that was destroyed or never made. Create the operation with \
         vkCreateDeferredOperationKHR and destroy it after it is complete, or pass VK_NULL_HANDLE to do the work in \
         the call.",
    )
    .implicit(),
    row(
        RuleId::CopyMicromapToMemoryInfoParameter,
        "The host serialization reads its parameters through this pointer, for a deferred one in another thread. \
         Keep the structure alive until it is complete.",
    )
    .implicit()
    .structural(
        "A Call holds the structure itself and not a pointer to it, so the pointer is always there; what stands in \
         the structure is checked under its own rules.",
    ),
    row(
        RuleId::CopyMicromapToMemoryDeferredOperationParent,
        "An operation of another device would be joined by a driver that cannot reach the micromap. Create one \
         operation on each device that defers commands.",
    )
    .implicit(),
];
