//! Structures that hold values alone.

use ::ash::vk as ash;

use crate::vk;

/// A member's value: the same, or made by a function where it is a bare number in C.
macro_rules! value {
    ($value:ident) => {
        $value.into()
    };
    ($value:ident $make:path) => {
        $make($value)
    };
}

/// Structures whose members have the same names. They are taken apart without `..`, so that a new member stops the build.
macro_rules! structures {
    ($($theirs:ident => $ours:ident { $($member:ident $(: $make:path)?),* };)*) => {$(
        impl From<&ash::$theirs<'_>> for vk::$ours {
            fn from(structure: &ash::$theirs<'_>) -> Self {
                let &ash::$theirs { s_type, p_next: _, $($member,)* _marker } = structure;
                Self { s_type: s_type.into(), next: vk::Chain::new(), $($member: value!($member $($make)?),)* }
            }
        }
    )*};
}

structures! {
    MicromapCreateInfoEXT => MicromapCreateInfo {
        create_flags, buffer, offset, size, ty, device_address: vk::DeviceAddress
    };
    MicromapBuildSizesInfoEXT => MicromapBuildSizesInfo {
        micromap_size, build_scratch_size, discardable: vk::Bool32
    };
    CopyMicromapInfoEXT => CopyMicromapInfo { src, dst, mode };
    AccelerationStructureCreateInfoKHR => AccelerationStructureCreateInfo {
        create_flags, buffer, offset, size, ty, device_address: vk::DeviceAddress
    };
    PhysicalDeviceOpacityMicromapFeaturesEXT => OpacityMicromapFeaturesExt {
        micromap: vk::Bool32, micromap_capture_replay: vk::Bool32, micromap_host_commands: vk::Bool32
    };
    PhysicalDeviceOpacityMicromapPropertiesEXT => OpacityMicromapPropertiesExt {
        max_opacity2_state_subdivision_level, max_opacity4_state_subdivision_level
    };
}
