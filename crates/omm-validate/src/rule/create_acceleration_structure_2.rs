//! The rules of the second way to create acceleration structures.

macro_rules! create_acceleration_structure_2_ids {
    ($next:ident $($rest:ident)*; $($table:tt)*) => {
        $next! { $($rest)*; $($table)*
            FullyBound13097 = "VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-13097";
            Protected13098 = "VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-13098";
            Protected13099 = "VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-13099";
            StorageUsage13100 = "VUID-VkAccelerationStructureCreateInfo2KHR-addressFlags-13100";
            StorageUsage13122 = "VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-13122";
            StorageUsage13123 = "VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-13123";
            TransformFeedbackUsage13101 = "VUID-VkAccelerationStructureCreateInfo2KHR-addressFlags-13101";
            TransformFeedbackUsage13124 = "VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-13124";
            TransformFeedbackUsage13125 = "VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-13125";
            AddressRange11602 = "VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-11602";
            AddressRange11603 = "VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-11603";
            AddressRange11604 = "VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-11604";
            AddressRange11605 = "VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-11605";
            CaptureReplay11606 = "VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-11606";
            CaptureReplay11607 = "VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-11607";
            AddressRange11608 = "VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-11608";
            Feature11609 = "VUID-VkAccelerationStructureCreateInfo2KHR-micromap-11609";
            CreateFlags11610 = "VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-11610";
            CreateFlags11611 = "VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-11611";
            Feature03613 = "VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-03613";
            Feature11673 = "VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-11673";
            MotionInfo04954 = "VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-04954";
            MotionTriangles04955 = "VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-04955";
            Feature08108 = "VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-08108";
            OpaqueCapture08109 = "VUID-VkAccelerationStructureCreateInfo2KHR-pNext-08109";
            AccelerationStructureCreateInfo2SType = "VUID-VkAccelerationStructureCreateInfo2KHR-sType-sType";
            AccelerationStructureCreateInfo2PNext = "VUID-VkAccelerationStructureCreateInfo2KHR-pNext-pNext";
            AccelerationStructureCreateInfo2Unique = "VUID-VkAccelerationStructureCreateInfo2KHR-sType-unique";
            AccelerationStructureCreateInfo2CreateFlagsParameter = "VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-parameter";
            AccelerationStructureCreateInfo2AddressFlagsParameter = "VUID-VkAccelerationStructureCreateInfo2KHR-addressFlags-parameter";
            AccelerationStructureCreateInfo2TypeParameter = "VUID-VkAccelerationStructureCreateInfo2KHR-type-parameter";

            Feature03611 = "VUID-vkCreateAccelerationStructure2KHR-accelerationStructure-03611";
            Feature13086 = "VUID-vkCreateAccelerationStructure2KHR-deviceAddressCommands-13086";
            CreateAccelerationStructure2DeviceParameter = "VUID-vkCreateAccelerationStructure2KHR-device-parameter";
            CreateAccelerationStructure2CreateInfoParameter = "VUID-vkCreateAccelerationStructure2KHR-pCreateInfo-parameter";
            CreateAccelerationStructure2AllocatorParameter = "VUID-vkCreateAccelerationStructure2KHR-pAllocator-parameter";
            CreateAccelerationStructure2AccelerationStructureParameter = "VUID-vkCreateAccelerationStructure2KHR-pAccelerationStructure-parameter";
            CreateAccelerationStructure2DeviceQueuecount = "VUID-vkCreateAccelerationStructure2KHR-device-queuecount";
        }
    };
}
