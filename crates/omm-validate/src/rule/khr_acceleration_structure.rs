//! The rules of `VK_KHR_acceleration_structure`, of those that concern micromaps.

macro_rules! khr_acceleration_structure_ids {
    ($next:ident $($rest:ident)*; $($table:tt)*) => {
        $next! { $($rest)*; $($table)*
            Type03654 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-type-03654";
            Flags03796 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-flags-03796";
            Flags11558 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-flags-11558";
            GeometryCount11560 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-geometryCount-11560";
            GeometryType11561 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-geometryType-11561";
            Flags11562 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-flags-11562";
            Type11563 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-type-11563";
            FourStateLevel11564 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-subdivisionLevel-11564";
            LossyLevel11565 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-subdivisionLevel-11565";
            FourStateLevel11566 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-subdivisionLevel-11566";
            LossyLevel11567 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-subdivisionLevel-11567";
            Flags11709 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-flags-11709";
            Flags11710 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-flags-11710";
            Flags11711 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-flags-11711";
            Feature11559 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-micromap-11559";
            GeometryType11707 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-geometryType-11707";
            LossyFormat11712 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-format-11712";
            LossyFormat11713 = "VUID-VkAccelerationStructureBuildGeometryInfoKHR-format-11713";

            MicromapData11568 = "VUID-VkAccelerationStructureGeometryKHR-micromap-11568";
            Flags11569 = "VUID-VkAccelerationStructureGeometryKHR-flags-11569";
            AccelerationStructureGeometryPNext = "VUID-VkAccelerationStructureGeometryKHR-pNext-pNext";

            BuildRangeInfos11544 = "VUID-vkCmdBuildAccelerationStructuresKHR-ppBuildRangeInfos-11544";
            Mode11545 = "VUID-vkCmdBuildAccelerationStructuresKHR-mode-11545";
            SrcAccelerationStructure11546 = "VUID-vkCmdBuildAccelerationStructuresKHR-srcAccelerationStructure-11546";
            DstAccelerationStructure11547 = "VUID-vkCmdBuildAccelerationStructuresKHR-dstAccelerationStructure-11547";
            Alignment11552 = "VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11552";
            TriangleArrayRange11554 = "VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11554";
            TriangleFormat11555 = "VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11555";
            TwoStateLevel11556 = "VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11556";
            Index11575 = "VUID-vkCmdBuildAccelerationStructuresKHR-indexBuffer-11575";
            SpecialIndex11578 = "VUID-vkCmdBuildAccelerationStructuresKHR-indexBuffer-11578";
            BuildRangeInfos11543 = "VUID-vkCmdBuildAccelerationStructuresKHR-ppBuildRangeInfos-11543";
            DstAccelerationStructure11548 = "VUID-vkCmdBuildAccelerationStructuresKHR-dstAccelerationStructure-11548";
            DstAccelerationStructure11549 = "VUID-vkCmdBuildAccelerationStructuresKHR-dstAccelerationStructure-11549";
            MicromapData11550 = "VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11550";
            MicromapData11551 = "VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11551";
            DataRange11553 = "VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11553";
            IndexRange11577 = "VUID-vkCmdBuildAccelerationStructuresKHR-indexBuffer-11577";
            InstanceFlags10607 = "VUID-vkCmdBuildAccelerationStructuresKHR-pInfos-10607";
            Micromap11701 = "VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11701";
            MicromapType11624 = "VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11624";
            UpdateMicromap11625 = "VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11625";
            UpdateNullMicromap11626 = "VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11626";
            UpdateNewMicromap11627 = "VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11627";
            UpdateOrigin11628 = "VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11628";
            UpdateSameMicromap11629 = "VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11629";
            ExtMicromap11632 = "VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11632";
            ExtIndexBuffer10904 = "VUID-vkCmdBuildAccelerationStructuresKHR-pInfos-10904";
            ExtIndexBuffer10905 = "VUID-vkCmdBuildAccelerationStructuresKHR-pInfos-10905";

            Type11600 = "VUID-VkAccelerationStructureCreateInfoKHR-type-11600";

            AccelerationStructureGeometryTrianglesDataPNext = "VUID-VkAccelerationStructureGeometryTrianglesDataKHR-pNext-pNext";

            InstanceFlags11580 = "VUID-VkAccelerationStructureInstanceKHR-micromap-11580";
            InstanceFlags11581 = "VUID-VkAccelerationStructureInstanceKHR-flags-11581";

            SrcMicromaps11582 = "VUID-VkCopyAccelerationStructureToMemoryInfoKHR-src-11582";

            BlockFeature11584 = "VUID-VkCopyMemoryToAccelerationStructureInfoKHR-dst-11584";
            BlockAddress11585 = "VUID-VkCopyMemoryToAccelerationStructureInfoKHR-dst-11585";

            ExtIndexBuffer10892 = "VUID-vkBuildAccelerationStructuresKHR-pInfos-10892";
            ExtIndexBuffer11821 = "VUID-vkBuildAccelerationStructuresKHR-pInfos-11821";
            HostMicromap11705 = "VUID-vkBuildAccelerationStructuresKHR-pInfos-11705";

            IndirectInstanceFlags10607 = "VUID-vkCmdBuildAccelerationStructuresIndirectKHR-pInfos-10607";
            IndirectMicromap11701 = "VUID-vkCmdBuildAccelerationStructuresIndirectKHR-micromap-11701";
            IndirectMicromapType11624 = "VUID-vkCmdBuildAccelerationStructuresIndirectKHR-micromap-11624";
            IndirectUpdateMicromap11625 = "VUID-vkCmdBuildAccelerationStructuresIndirectKHR-micromap-11625";
            IndirectUpdateNullMicromap11626 = "VUID-vkCmdBuildAccelerationStructuresIndirectKHR-micromap-11626";
            IndirectUpdateNewMicromap11627 = "VUID-vkCmdBuildAccelerationStructuresIndirectKHR-micromap-11627";
            IndirectUpdateOrigin11628 = "VUID-vkCmdBuildAccelerationStructuresIndirectKHR-micromap-11628";
            IndirectUpdateSameMicromap11629 = "VUID-vkCmdBuildAccelerationStructuresIndirectKHR-micromap-11629";
            IndirectExtMicromap11632 = "VUID-vkCmdBuildAccelerationStructuresIndirectKHR-micromap-11632";
            IndirectExtIndexBuffer10904 = "VUID-vkCmdBuildAccelerationStructuresIndirectKHR-pInfos-10904";
            IndirectExtIndexBuffer10905 = "VUID-vkCmdBuildAccelerationStructuresIndirectKHR-pInfos-10905";
            IndirectType11557 = "VUID-vkCmdBuildAccelerationStructuresIndirectKHR-type-11557";

            SrcMicromaps11634 = "VUID-vkCmdCopyAccelerationStructureKHR-src-11634";

            DstAddress11699 = "VUID-vkCmdCopyAccelerationStructureToMemoryKHR-pInfo-11699";

            SrcAddress11700 = "VUID-vkCmdCopyAccelerationStructureToMemoryKHR-pInfo-11700";

            SrcMicromaps11587 = "VUID-vkCopyAccelerationStructureKHR-src-11587";

            MaxPrimitiveCounts11612 = "VUID-vkGetAccelerationStructureBuildSizesKHR-pMaxPrimitiveCounts-11612";
            MaxPrimitiveCounts11613 = "VUID-vkGetAccelerationStructureBuildSizesKHR-pMaxPrimitiveCounts-11613";
            BuildType11614 = "VUID-vkGetAccelerationStructureBuildSizesKHR-buildType-11614";
        }
    };
}
