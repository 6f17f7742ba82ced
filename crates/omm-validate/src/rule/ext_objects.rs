//! The rules of the structures of `VK_EXT_opacity_micromap`.

macro_rules! ext_objects_ids {
    ($next:ident $($rest:ident)*; $($table:tt)*) => {
        $next! { $($rest)*; $($table)*
            AttachedUsageCounts07335 = "VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-pUsageCounts-07335";
            AttachedIndexType10719 = "VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-indexType-10719";
            AttachedIndexStride10722 = "VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-indexType-10722";
            AttachedIndexStride10723 = "VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-indexType-10723";
            AttachedUsageFormat11679 = "VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-format-11679";
            AttachedTwoStateLevel11680 = "VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-subdivisionLevel-11680";
            AttachedFourStateLevel11681 = "VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-subdivisionLevel-11681";
            AttachedDisplacementFormat11682 = "VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-format-11682";
            AttachedDisplacementLevel11683 = "VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-subdivisionLevel-11683";
            AccelerationStructureTrianglesOpacityMicromapExtSType = "VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-sType-sType";
            AccelerationStructureTrianglesOpacityMicromapExtIndexTypeParameter = "VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-indexType-parameter";
            AccelerationStructureTrianglesOpacityMicromapExtUsageCountsParameter = "VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-pUsageCounts-parameter";
            AccelerationStructureTrianglesOpacityMicromapExtUsageCountPointersParameter = "VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-ppUsageCounts-parameter";
            AccelerationStructureTrianglesOpacityMicromapExtMicromapParameter = "VUID-VkAccelerationStructureTrianglesOpacityMicromapEXT-micromap-parameter";

            SerializedData07547 = "VUID-VkCopyMemoryToMicromapInfoEXT-src-07547";
            DeserializeMode07548 = "VUID-VkCopyMemoryToMicromapInfoEXT-mode-07548";
            SerializedFormat07549 = "VUID-VkCopyMemoryToMicromapInfoEXT-src-07549";
            DeserializedSize07550 = "VUID-VkCopyMemoryToMicromapInfoEXT-dst-07550";
            CopyMemoryToMicromapInfoSType = "VUID-VkCopyMemoryToMicromapInfoEXT-sType-sType";
            CopyMemoryToMicromapInfoNext = "VUID-VkCopyMemoryToMicromapInfoEXT-pNext-pNext";
            CopyMemoryToMicromapInfoDstParameter = "VUID-VkCopyMemoryToMicromapInfoEXT-dst-parameter";
            CopyMemoryToMicromapInfoModeParameter = "VUID-VkCopyMemoryToMicromapInfoEXT-mode-parameter";

            CopyMode07531 = "VUID-VkCopyMicromapInfoEXT-mode-07531";
            CompactionFlag07533 = "VUID-VkCopyMicromapInfoEXT-mode-07533";
            CopyMicromapInfoSType = "VUID-VkCopyMicromapInfoEXT-sType-sType";
            CopyMicromapInfoNext = "VUID-VkCopyMicromapInfoEXT-pNext-pNext";
            CopyMicromapInfoSrcParameter = "VUID-VkCopyMicromapInfoEXT-src-parameter";
            CopyMicromapInfoDstParameter = "VUID-VkCopyMicromapInfoEXT-dst-parameter";
            CopyMicromapInfoCommonParent = "VUID-VkCopyMicromapInfoEXT-commonparent";

            SerializeSource07540 = "VUID-VkCopyMicromapToMemoryInfoEXT-src-07540";
            SerializeRoom07541 = "VUID-VkCopyMicromapToMemoryInfoEXT-dst-07541";
            SerializeMode07542 = "VUID-VkCopyMicromapToMemoryInfoEXT-mode-07542";
            CopyMicromapToMemoryInfoSType = "VUID-VkCopyMicromapToMemoryInfoEXT-sType-sType";
            CopyMicromapToMemoryInfoNext = "VUID-VkCopyMicromapToMemoryInfoEXT-pNext-pNext";
            CopyMicromapToMemoryInfoSrcParameter = "VUID-VkCopyMicromapToMemoryInfoEXT-src-parameter";
            CopyMicromapToMemoryInfoModeParameter = "VUID-VkCopyMicromapToMemoryInfoEXT-mode-parameter";

            UsageCounts07516 = "VUID-VkMicromapBuildInfoEXT-pUsageCounts-07516";
            UsageFormat11652 = "VUID-VkMicromapBuildInfoEXT-format-11652";
            DisplacementUsageFormat11653 = "VUID-VkMicromapBuildInfoEXT-format-11653";
            UsageTwoStateLevel11654 = "VUID-VkMicromapBuildInfoEXT-subdivisionLevel-11654";
            UsageFourStateLevel11655 = "VUID-VkMicromapBuildInfoEXT-subdivisionLevel-11655";
            DisplacementUsageLevel11656 = "VUID-VkMicromapBuildInfoEXT-subdivisionLevel-11656";
            TriangleFormat11657 = "VUID-VkMicromapBuildInfoEXT-format-11657";
            DisplacementTriangleFormat11658 = "VUID-VkMicromapBuildInfoEXT-format-11658";
            TriangleTwoStateLevel11659 = "VUID-VkMicromapBuildInfoEXT-subdivisionLevel-11659";
            TriangleFourStateLevel11660 = "VUID-VkMicromapBuildInfoEXT-subdivisionLevel-11660";
            DisplacementTriangleLevel11661 = "VUID-VkMicromapBuildInfoEXT-subdivisionLevel-11661";
            MicromapBuildInfoSType = "VUID-VkMicromapBuildInfoEXT-sType-sType";
            MicromapBuildInfoNext = "VUID-VkMicromapBuildInfoEXT-pNext-pNext";
            MicromapBuildInfoTypeParameter = "VUID-VkMicromapBuildInfoEXT-type-parameter";
            MicromapBuildInfoFlagsParameter = "VUID-VkMicromapBuildInfoEXT-flags-parameter";
            MicromapBuildInfoUsageCountsParameter = "VUID-VkMicromapBuildInfoEXT-pUsageCounts-parameter";
            MicromapBuildInfoUsageCountPointersParameter = "VUID-VkMicromapBuildInfoEXT-ppUsageCounts-parameter";

            MicromapBuildSizesInfoSType = "VUID-VkMicromapBuildSizesInfoEXT-sType-sType";
            MicromapBuildSizesInfoNext = "VUID-VkMicromapBuildSizesInfoEXT-pNext-pNext";

            ReplayAddress07433 = "VUID-VkMicromapCreateInfoEXT-deviceAddress-07433";
            CaptureReplay11616 = "VUID-VkMicromapCreateInfoEXT-micromapCaptureReplay-11616";
            MultiDeviceReplay11617 = "VUID-VkMicromapCreateInfoEXT-bufferDeviceAddressMultiDevice-11617";
            BufferUsage07435 = "VUID-VkMicromapCreateInfoEXT-buffer-07435";
            SparseBuffer07436 = "VUID-VkMicromapCreateInfoEXT-buffer-07436";
            Range07437 = "VUID-VkMicromapCreateInfoEXT-offset-07437";
            Offset07438 = "VUID-VkMicromapCreateInfoEXT-offset-07438";
            MicromapCreateInfoSType = "VUID-VkMicromapCreateInfoEXT-sType-sType";
            MicromapCreateInfoNext = "VUID-VkMicromapCreateInfoEXT-pNext-pNext";
            MicromapCreateInfoCreateFlagsParameter = "VUID-VkMicromapCreateInfoEXT-createFlags-parameter";
            MicromapCreateInfoBufferParameter = "VUID-VkMicromapCreateInfoEXT-buffer-parameter";
            MicromapCreateInfoTypeParameter = "VUID-VkMicromapCreateInfoEXT-type-parameter";
            MicromapCreateInfoDeviceAddressParameter = "VUID-VkMicromapCreateInfoEXT-deviceAddress-parameter";

            MicromapVersionInfoSType = "VUID-VkMicromapVersionInfoEXT-sType-sType";
            MicromapVersionInfoNext = "VUID-VkMicromapVersionInfoEXT-pNext-pNext";
            MicromapVersionInfoVersionDataParameter = "VUID-VkMicromapVersionInfoEXT-pVersionData-parameter";

            PhysicalDeviceOpacityMicromapFeaturesExtSType = "VUID-VkPhysicalDeviceOpacityMicromapFeaturesEXT-sType-sType";

            PhysicalDeviceOpacityMicromapPropertiesExtSType = "VUID-VkPhysicalDeviceOpacityMicromapPropertiesEXT-sType-sType";
        }
    };
}
