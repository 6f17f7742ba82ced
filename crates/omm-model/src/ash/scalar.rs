//! Enumerants, flags and handles: the same numbers.

use ::ash::vk::{self as ash, Handle};

use super::vk;

macro_rules! enumerants {
    ($($theirs:ident => $ours:ident;)*) => {$(
        impl From<ash::$theirs> for vk::$ours {
            fn from(value: ash::$theirs) -> Self {
                Self(value.as_raw())
            }
        }
    )*};
}

enumerants! {
    StructureType => StructureType;
    Result => Result;
    MicromapTypeEXT => MicromapType;
    BuildMicromapModeEXT => BuildMicromapMode;
    CopyMicromapModeEXT => CopyMicromapMode;
    OpacityMicromapFormatEXT => OpacityMicromapFormat;
    OpacityMicromapSpecialIndexEXT => OpacityMicromapSpecialIndex;
    AccelerationStructureTypeKHR => AccelerationStructureType;
    AccelerationStructureBuildTypeKHR => AccelerationStructureBuildType;
    AccelerationStructureCompatibilityKHR => AccelerationStructureCompatibility;
    BuildAccelerationStructureModeKHR => BuildAccelerationStructureMode;
    GeometryTypeKHR => GeometryType;
    IndexType => IndexType;
    Format => Format;
    QueryType => QueryType;
    SharingMode => SharingMode;
}

macro_rules! flags {
    ($($theirs:ident => $ours:ident;)*) => {$(
        impl From<ash::$theirs> for vk::$ours {
            fn from(flags: ash::$theirs) -> Self {
                Self::from_bits_retain(flags.as_raw())
            }
        }
    )*};
}

flags! {
    MicromapCreateFlagsEXT => MicromapCreateFlags;
    BuildMicromapFlagsEXT => BuildMicromapFlags;
    AccelerationStructureCreateFlagsKHR => AccelerationStructureCreateFlags;
    BuildAccelerationStructureFlagsKHR => BuildAccelerationStructureFlags;
    GeometryFlagsKHR => GeometryFlags;
    BufferCreateFlags => BufferCreateFlags;
    BufferUsageFlags => BufferUsageFlags;
    MemoryAllocateFlags => MemoryAllocateFlags;
    MemoryPropertyFlags => MemoryPropertyFlags;
}

macro_rules! handles {
    ($($theirs:ident => $ours:ident;)*) => {$(
        impl From<ash::$theirs> for vk::$ours {
            fn from(handle: ash::$theirs) -> Self {
                Self(handle.as_raw())
            }
        }
    )*};
}

handles! {
    PhysicalDevice => PhysicalDevice;
    Device => Device;
    Queue => Queue;
    Buffer => Buffer;
    DeviceMemory => DeviceMemory;
    CommandPool => CommandPool;
    CommandBuffer => CommandBuffer;
    QueryPool => QueryPool;
    AccelerationStructureKHR => AccelerationStructure;
    MicromapEXT => Micromap;
    DeferredOperationKHR => DeferredOperation;
}
