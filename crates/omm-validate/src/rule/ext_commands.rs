//! The rules of the commands of `VK_EXT_opacity_micromap`.

macro_rules! ext_commands_ids {
    ($next:ident $($rest:ident)*; $($table:tt)*) => {
        $next! { $($rest)*; $($table)*
            HostDstMicromapSize07461 = "VUID-vkBuildMicromapsEXT-pInfos-07461";
            HostMode07462 = "VUID-vkBuildMicromapsEXT-mode-07462";
            HostDstMicromap07463 = "VUID-vkBuildMicromapsEXT-dstMicromap-07463";
            HostType07464 = "VUID-vkBuildMicromapsEXT-pInfos-07464";
            HostDstMicromapMemory07552 = "VUID-vkBuildMicromapsEXT-pInfos-07552";
            HostData07553 = "VUID-vkBuildMicromapsEXT-pInfos-07553";
            HostTriangleArray07554 = "VUID-vkBuildMicromapsEXT-pInfos-07554";
            HostBuildFeature07555 = "VUID-vkBuildMicromapsEXT-micromapHostCommands-07555";
            HostScratch07556 = "VUID-vkBuildMicromapsEXT-pInfos-07556";
            HostDstMicromapInstances07557 = "VUID-vkBuildMicromapsEXT-pInfos-07557";
            HostDstMicromapOverlap11667 = "VUID-vkBuildMicromapsEXT-dstMicromap-11667";
            HostDstMicromapScratchOverlap11668 = "VUID-vkBuildMicromapsEXT-dstMicromap-11668";
            HostScratchOverlap11669 = "VUID-vkBuildMicromapsEXT-scratchData-11669";
            BuildMicromapsDeviceParameter = "VUID-vkBuildMicromapsEXT-device-parameter";
            BuildMicromapsDeferredOperationParameter = "VUID-vkBuildMicromapsEXT-deferredOperation-parameter";
            BuildMicromapsInfosParameter = "VUID-vkBuildMicromapsEXT-pInfos-parameter";
            BuildMicromapsInfoCount = "VUID-vkBuildMicromapsEXT-infoCount-arraylength";
            BuildMicromapsDeferredOperationParent = "VUID-vkBuildMicromapsEXT-deferredOperation-parent";

            DstMicromapSize07461 = "VUID-vkCmdBuildMicromapsEXT-pInfos-07461";
            Mode07462 = "VUID-vkCmdBuildMicromapsEXT-mode-07462";
            DstMicromap07463 = "VUID-vkCmdBuildMicromapsEXT-dstMicromap-07463";
            Type07464 = "VUID-vkCmdBuildMicromapsEXT-pInfos-07464";
            BuildFeature11648 = "VUID-vkCmdBuildMicromapsEXT-micromap-11648";
            DstMicromapMemory07508 = "VUID-vkCmdBuildMicromapsEXT-pInfos-07508";
            ScratchRange07509 = "VUID-vkCmdBuildMicromapsEXT-pInfos-07509";
            InputUsage07510 = "VUID-vkCmdBuildMicromapsEXT-data-07510";
            ScratchUsage07511 = "VUID-vkCmdBuildMicromapsEXT-pInfos-07511";
            ScratchAddress07512 = "VUID-vkCmdBuildMicromapsEXT-pInfos-07512";
            DataAddress10896 = "VUID-vkCmdBuildMicromapsEXT-pInfos-10896";
            TriangleArrayAddress10897 = "VUID-vkCmdBuildMicromapsEXT-pInfos-10897";
            ScratchAlignment07514 = "VUID-vkCmdBuildMicromapsEXT-pInfos-07514";
            InputAlignment07515 = "VUID-vkCmdBuildMicromapsEXT-pInfos-07515";
            DstMicromapOverlap11649 = "VUID-vkCmdBuildMicromapsEXT-dstMicromap-11649";
            DstMicromapScratchOverlap11650 = "VUID-vkCmdBuildMicromapsEXT-dstMicromap-11650";
            ScratchOverlap11651 = "VUID-vkCmdBuildMicromapsEXT-scratchData-11651";
            CmdBuildMicromapsCommandBufferParameter = "VUID-vkCmdBuildMicromapsEXT-commandBuffer-parameter";
            CmdBuildMicromapsInfosParameter = "VUID-vkCmdBuildMicromapsEXT-pInfos-parameter";
            CmdBuildMicromapsRecording = "VUID-vkCmdBuildMicromapsEXT-commandBuffer-recording";
            CmdBuildMicromapsQueue = "VUID-vkCmdBuildMicromapsEXT-commandBuffer-cmdpool";
            CmdBuildMicromapsRenderPass = "VUID-vkCmdBuildMicromapsEXT-renderpass";
            CmdBuildMicromapsSuspended = "VUID-vkCmdBuildMicromapsEXT-suspended";
            CmdBuildMicromapsVideoCoding = "VUID-vkCmdBuildMicromapsEXT-videocoding";
            CmdBuildMicromapsInfoCount = "VUID-vkCmdBuildMicromapsEXT-infoCount-arraylength";

            DeserializeAddress07543 = "VUID-vkCmdCopyMemoryToMicromapEXT-pInfo-07543";
            DeserializeAlignment07544 = "VUID-vkCmdCopyMemoryToMicromapEXT-pInfo-07544";
            DeserializeDstMemory07546 = "VUID-vkCmdCopyMemoryToMicromapEXT-buffer-07546";
            CmdCopyMemoryToMicromapCommandBufferParameter = "VUID-vkCmdCopyMemoryToMicromapEXT-commandBuffer-parameter";
            CmdCopyMemoryToMicromapInfoParameter = "VUID-vkCmdCopyMemoryToMicromapEXT-pInfo-parameter";
            CmdCopyMemoryToMicromapRecording = "VUID-vkCmdCopyMemoryToMicromapEXT-commandBuffer-recording";
            CmdCopyMemoryToMicromapQueue = "VUID-vkCmdCopyMemoryToMicromapEXT-commandBuffer-cmdpool";
            CmdCopyMemoryToMicromapRenderPass = "VUID-vkCmdCopyMemoryToMicromapEXT-renderpass";
            CmdCopyMemoryToMicromapSuspended = "VUID-vkCmdCopyMemoryToMicromapEXT-suspended";
            CmdCopyMemoryToMicromapVideoCoding = "VUID-vkCmdCopyMemoryToMicromapEXT-videocoding";

            CopySrcMemory07529 = "VUID-vkCmdCopyMicromapEXT-buffer-07529";
            CopyDstMemory07530 = "VUID-vkCmdCopyMicromapEXT-buffer-07530";
            CopySource07532 = "VUID-vkCmdCopyMicromapEXT-src-07532";
            CmdCopyMicromapCommandBufferParameter = "VUID-vkCmdCopyMicromapEXT-commandBuffer-parameter";
            CmdCopyMicromapInfoParameter = "VUID-vkCmdCopyMicromapEXT-pInfo-parameter";
            CmdCopyMicromapRecording = "VUID-vkCmdCopyMicromapEXT-commandBuffer-recording";
            CmdCopyMicromapQueue = "VUID-vkCmdCopyMicromapEXT-commandBuffer-cmdpool";
            CmdCopyMicromapRenderPass = "VUID-vkCmdCopyMicromapEXT-renderpass";
            CmdCopyMicromapSuspended = "VUID-vkCmdCopyMicromapEXT-suspended";
            CmdCopyMicromapVideoCoding = "VUID-vkCmdCopyMicromapEXT-videocoding";

            SerializeAddress07536 = "VUID-vkCmdCopyMicromapToMemoryEXT-pInfo-07536";
            SerializeAlignment07537 = "VUID-vkCmdCopyMicromapToMemoryEXT-pInfo-07537";
            SerializeSrcMemory07539 = "VUID-vkCmdCopyMicromapToMemoryEXT-buffer-07539";
            CmdCopyMicromapToMemoryCommandBufferParameter = "VUID-vkCmdCopyMicromapToMemoryEXT-commandBuffer-parameter";
            CmdCopyMicromapToMemoryInfoParameter = "VUID-vkCmdCopyMicromapToMemoryEXT-pInfo-parameter";
            CmdCopyMicromapToMemoryRecording = "VUID-vkCmdCopyMicromapToMemoryEXT-commandBuffer-recording";
            CmdCopyMicromapToMemoryQueue = "VUID-vkCmdCopyMicromapToMemoryEXT-commandBuffer-cmdpool";
            CmdCopyMicromapToMemoryRenderPass = "VUID-vkCmdCopyMicromapToMemoryEXT-renderpass";
            CmdCopyMicromapToMemorySuspended = "VUID-vkCmdCopyMicromapToMemoryEXT-suspended";
            CmdCopyMicromapToMemoryVideoCoding = "VUID-vkCmdCopyMicromapToMemoryEXT-videocoding";

            QueryPoolType07525 = "VUID-vkCmdWriteMicromapsPropertiesEXT-queryPool-07525";
            QueriesUnavailable12417 = "VUID-vkCmdWriteMicromapsPropertiesEXT-None-12417";
            PropertiesMemory07527 = "VUID-vkCmdWriteMicromapsPropertiesEXT-buffer-07527";
            QueryRange07528 = "VUID-vkCmdWriteMicromapsPropertiesEXT-query-07528";
            PropertiesSource11662 = "VUID-vkCmdWriteMicromapsPropertiesEXT-pMicromaps-11662";
            CompactedSizeFlag07502 = "VUID-vkCmdWriteMicromapsPropertiesEXT-pMicromaps-07502";
            QueryType07503 = "VUID-vkCmdWriteMicromapsPropertiesEXT-queryType-07503";
            CmdWriteMicromapsPropertiesCommandBufferParameter = "VUID-vkCmdWriteMicromapsPropertiesEXT-commandBuffer-parameter";
            CmdWriteMicromapsPropertiesMicromapsParameter = "VUID-vkCmdWriteMicromapsPropertiesEXT-pMicromaps-parameter";
            CmdWriteMicromapsPropertiesQueryPoolParameter = "VUID-vkCmdWriteMicromapsPropertiesEXT-queryPool-parameter";
            CmdWriteMicromapsPropertiesRecording = "VUID-vkCmdWriteMicromapsPropertiesEXT-commandBuffer-recording";
            CmdWriteMicromapsPropertiesQueue = "VUID-vkCmdWriteMicromapsPropertiesEXT-commandBuffer-cmdpool";
            CmdWriteMicromapsPropertiesRenderPass = "VUID-vkCmdWriteMicromapsPropertiesEXT-renderpass";
            CmdWriteMicromapsPropertiesSuspended = "VUID-vkCmdWriteMicromapsPropertiesEXT-suspended";
            CmdWriteMicromapsPropertiesVideoCoding = "VUID-vkCmdWriteMicromapsPropertiesEXT-videocoding";
            CmdWriteMicromapsPropertiesMicromapCount = "VUID-vkCmdWriteMicromapsPropertiesEXT-micromapCount-arraylength";
            CmdWriteMicromapsPropertiesCommonParent = "VUID-vkCmdWriteMicromapsPropertiesEXT-commonparent";

            DeserializeDeferredOperation03678 = "VUID-vkCopyMemoryToMicromapEXT-deferredOperation-03678";
            HostDeserializePointer07563 = "VUID-vkCopyMemoryToMicromapEXT-pInfo-07563";
            HostDeserializeAlignment07564 = "VUID-vkCopyMemoryToMicromapEXT-pInfo-07564";
            HostDeserializeDstMemory07565 = "VUID-vkCopyMemoryToMicromapEXT-buffer-07565";
            HostDeserializeFeature07566 = "VUID-vkCopyMemoryToMicromapEXT-micromapHostCommands-07566";
            HostDeserializeDstInstances07567 = "VUID-vkCopyMemoryToMicromapEXT-buffer-07567";
            CopyMemoryToMicromapDeviceParameter = "VUID-vkCopyMemoryToMicromapEXT-device-parameter";
            CopyMemoryToMicromapDeferredOperationParameter = "VUID-vkCopyMemoryToMicromapEXT-deferredOperation-parameter";
            CopyMemoryToMicromapInfoParameter = "VUID-vkCopyMemoryToMicromapEXT-pInfo-parameter";
            CopyMemoryToMicromapDeferredOperationParent = "VUID-vkCopyMemoryToMicromapEXT-deferredOperation-parent";

            CopyDeferredOperation03678 = "VUID-vkCopyMicromapEXT-deferredOperation-03678";
            HostCopySrcMemory07558 = "VUID-vkCopyMicromapEXT-buffer-07558";
            HostCopyDstMemory07559 = "VUID-vkCopyMicromapEXT-buffer-07559";
            HostCopyFeature07560 = "VUID-vkCopyMicromapEXT-micromapHostCommands-07560";
            HostCopySrcInstances07561 = "VUID-vkCopyMicromapEXT-buffer-07561";
            HostCopyDstInstances07562 = "VUID-vkCopyMicromapEXT-buffer-07562";
            HostCopySource11670 = "VUID-vkCopyMicromapEXT-src-11670";
            CopyMicromapDeviceParameter = "VUID-vkCopyMicromapEXT-device-parameter";
            CopyMicromapDeferredOperationParameter = "VUID-vkCopyMicromapEXT-deferredOperation-parameter";
            CopyMicromapInfoParameter = "VUID-vkCopyMicromapEXT-pInfo-parameter";
            CopyMicromapDeferredOperationParent = "VUID-vkCopyMicromapEXT-deferredOperation-parent";

            SerializeDeferredOperation03678 = "VUID-vkCopyMicromapToMemoryEXT-deferredOperation-03678";
            HostSerializeSrcMemory07568 = "VUID-vkCopyMicromapToMemoryEXT-buffer-07568";
            HostSerializePointer07569 = "VUID-vkCopyMicromapToMemoryEXT-pInfo-07569";
            HostSerializeAlignment07570 = "VUID-vkCopyMicromapToMemoryEXT-pInfo-07570";
            HostSerializeFeature07571 = "VUID-vkCopyMicromapToMemoryEXT-micromapHostCommands-07571";
            HostSerializeSrcInstances07572 = "VUID-vkCopyMicromapToMemoryEXT-buffer-07572";
            CopyMicromapToMemoryDeviceParameter = "VUID-vkCopyMicromapToMemoryEXT-device-parameter";
            CopyMicromapToMemoryDeferredOperationParameter = "VUID-vkCopyMicromapToMemoryEXT-deferredOperation-parameter";
            CopyMicromapToMemoryInfoParameter = "VUID-vkCopyMicromapToMemoryEXT-pInfo-parameter";
            CopyMicromapToMemoryDeferredOperationParent = "VUID-vkCopyMicromapToMemoryEXT-deferredOperation-parent";

            CreateFeature11615 = "VUID-vkCreateMicromapEXT-micromap-11615";
            CreateMicromapDeviceParameter = "VUID-vkCreateMicromapEXT-device-parameter";
            CreateMicromapCreateInfoParameter = "VUID-vkCreateMicromapEXT-pCreateInfo-parameter";
            CreateMicromapAllocatorParameter = "VUID-vkCreateMicromapEXT-pAllocator-parameter";
            CreateMicromapMicromapParameter = "VUID-vkCreateMicromapEXT-pMicromap-parameter";
            CreateMicromapQueueCount = "VUID-vkCreateMicromapEXT-device-queuecount";

            DestroyFeature11619 = "VUID-vkDestroyMicromapEXT-micromap-11619";
            Pending07441 = "VUID-vkDestroyMicromapEXT-micromap-07441";
            AllocatorMissing07442 = "VUID-vkDestroyMicromapEXT-micromap-07442";
            AllocatorUnexpected07443 = "VUID-vkDestroyMicromapEXT-micromap-07443";
            DestroyMicromapDeviceParameter = "VUID-vkDestroyMicromapEXT-device-parameter";
            DestroyMicromapMicromapParameter = "VUID-vkDestroyMicromapEXT-micromap-parameter";
            DestroyMicromapAllocatorParameter = "VUID-vkDestroyMicromapEXT-pAllocator-parameter";
            DestroyMicromapMicromapParent = "VUID-vkDestroyMicromapEXT-micromap-parent";

            CompatibilityFeature11666 = "VUID-vkGetDeviceMicromapCompatibilityEXT-micromap-11666";
            GetDeviceMicromapCompatibilityDeviceParameter = "VUID-vkGetDeviceMicromapCompatibilityEXT-device-parameter";
            GetDeviceMicromapCompatibilityVersionInfoParameter = "VUID-vkGetDeviceMicromapCompatibilityEXT-pVersionInfo-parameter";
            GetDeviceMicromapCompatibilityCompatibilityParameter = "VUID-vkGetDeviceMicromapCompatibilityEXT-pCompatibility-parameter";

            BuildSizesFeature11618 = "VUID-vkGetMicromapBuildSizesEXT-micromap-11618";
            MultiDeviceSizes07440 = "VUID-vkGetMicromapBuildSizesEXT-device-07440";
            GetMicromapBuildSizesDeviceParameter = "VUID-vkGetMicromapBuildSizesEXT-device-parameter";
            GetMicromapBuildSizesBuildTypeParameter = "VUID-vkGetMicromapBuildSizesEXT-buildType-parameter";
            GetMicromapBuildSizesBuildInfoParameter = "VUID-vkGetMicromapBuildSizesEXT-pBuildInfo-parameter";
            GetMicromapBuildSizesSizeInfoParameter = "VUID-vkGetMicromapBuildSizesEXT-pSizeInfo-parameter";

            HostCompactedSizeFlag07502 = "VUID-vkWriteMicromapsPropertiesEXT-pMicromaps-07502";
            HostQueryType07503 = "VUID-vkWriteMicromapsPropertiesEXT-queryType-07503";
            Stride10071 = "VUID-vkWriteMicromapsPropertiesEXT-queryType-10071";
            Data10072 = "VUID-vkWriteMicromapsPropertiesEXT-queryType-10072";
            DataSize07576 = "VUID-vkWriteMicromapsPropertiesEXT-dataSize-07576";
            HostPropertiesMemory07577 = "VUID-vkWriteMicromapsPropertiesEXT-buffer-07577";
            HostPropertiesFeature07578 = "VUID-vkWriteMicromapsPropertiesEXT-micromapHostCommands-07578";
            HostPropertiesInstances07579 = "VUID-vkWriteMicromapsPropertiesEXT-buffer-07579";
            HostPropertiesSource11671 = "VUID-vkWriteMicromapsPropertiesEXT-pMicromaps-11671";
            WriteMicromapsPropertiesDeviceParameter = "VUID-vkWriteMicromapsPropertiesEXT-device-parameter";
            WriteMicromapsPropertiesMicromapsParameter = "VUID-vkWriteMicromapsPropertiesEXT-pMicromaps-parameter";
            WriteMicromapsPropertiesQueryTypeParameter = "VUID-vkWriteMicromapsPropertiesEXT-queryType-parameter";
            WriteMicromapsPropertiesDataParameter = "VUID-vkWriteMicromapsPropertiesEXT-pData-parameter";
            WriteMicromapsPropertiesMicromapCount = "VUID-vkWriteMicromapsPropertiesEXT-micromapCount-arraylength";
            WriteMicromapsPropertiesDataSize = "VUID-vkWriteMicromapsPropertiesEXT-dataSize-arraylength";
            WriteMicromapsPropertiesMicromapsParent = "VUID-vkWriteMicromapsPropertiesEXT-pMicromaps-parent";
        }
    };
}
