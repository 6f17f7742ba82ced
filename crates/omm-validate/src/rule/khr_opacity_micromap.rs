//! The rules of `VK_KHR_opacity_micromap`.

macro_rules! khr_opacity_micromap_ids {
    ($next:ident $($rest:ident)*; $($table:tt)*) => {
        $next! { $($rest)*; $($table)*
            UsageCounts11642 = "VUID-VkAccelerationStructureGeometryMicromapDataKHR-pUsageCounts-11642";
            TotalCount11643 = "VUID-VkAccelerationStructureGeometryMicromapDataKHR-count-11643";
            TwoStateLevel11645 = "VUID-VkAccelerationStructureGeometryMicromapDataKHR-subdivisionLevel-11645";
            TriangleArrayStride11646 = "VUID-VkAccelerationStructureGeometryMicromapDataKHR-triangleArrayStride-11646";
            TriangleArrayStride11647 = "VUID-VkAccelerationStructureGeometryMicromapDataKHR-triangleArrayStride-11647";
            AccelerationStructureGeometryMicromapDataSType = "VUID-VkAccelerationStructureGeometryMicromapDataKHR-sType-sType";
            AccelerationStructureGeometryMicromapDataUsageCountsParameter = "VUID-VkAccelerationStructureGeometryMicromapDataKHR-pUsageCounts-parameter";
            AccelerationStructureGeometryMicromapDataUsageCountPointersParameter = "VUID-VkAccelerationStructureGeometryMicromapDataKHR-ppUsageCounts-parameter";

            IndexType11570 = "VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexType-11570";
            IndexBuffer11571 = "VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexBuffer-11571";
            IndexBuffer11572 = "VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexBuffer-11572";
            IndexStride11573 = "VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexStride-11573";
            IndexStride11574 = "VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexStride-11574";
            TriangleIndex11576 = "VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-geometry-11576";
            Micromap11579 = "VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-micromap-11579";
            AccelerationStructureTrianglesOpacityMicromapKhrSType = "VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-sType-sType";
            AccelerationStructureTrianglesOpacityMicromapKhrIndexTypeParameter = "VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexType-parameter";
            AccelerationStructureTrianglesOpacityMicromapKhrMicromapParameter = "VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-micromap-parameter";

            MicromapUsageFormatParameter = "VUID-VkMicromapUsageKHR-format-parameter";

            PhysicalDeviceOpacityMicromapFeaturesKhrSType = "VUID-VkPhysicalDeviceOpacityMicromapFeaturesKHR-sType-sType";

            PhysicalDeviceOpacityMicromapPropertiesKhrSType = "VUID-VkPhysicalDeviceOpacityMicromapPropertiesKHR-sType-sType";
        }
    };
}
