//! The rules of `VK_KHR_deferred_host_operations`.

macro_rules! deferred_host_operations_ids {
    ($next:ident $($rest:ident)*; $($table:tt)*) => {
        $next! { $($rest)*; $($table)*
            CreateDeferredOperationDeviceParameter = "VUID-vkCreateDeferredOperationKHR-device-parameter";
            CreateDeferredOperationAllocatorParameter = "VUID-vkCreateDeferredOperationKHR-pAllocator-parameter";
            CreateDeferredOperationDeferredOperationParameter = "VUID-vkCreateDeferredOperationKHR-pDeferredOperation-parameter";
            CreateDeferredOperationDeviceQueuecount = "VUID-vkCreateDeferredOperationKHR-device-queuecount";

            DeferredOperationJoinDeviceParameter = "VUID-vkDeferredOperationJoinKHR-device-parameter";
            DeferredOperationJoinOperationParameter = "VUID-vkDeferredOperationJoinKHR-operation-parameter";
            DeferredOperationJoinOperationParent = "VUID-vkDeferredOperationJoinKHR-operation-parent";

            DestroyDeferredOperationAllocator03434 = "VUID-vkDestroyDeferredOperationKHR-operation-03434";
            DestroyDeferredOperationAllocator03435 = "VUID-vkDestroyDeferredOperationKHR-operation-03435";
            Operation03436 = "VUID-vkDestroyDeferredOperationKHR-operation-03436";
            DestroyDeferredOperationDeviceParameter = "VUID-vkDestroyDeferredOperationKHR-device-parameter";
            DestroyDeferredOperationOperationParameter = "VUID-vkDestroyDeferredOperationKHR-operation-parameter";
            DestroyDeferredOperationAllocatorParameter = "VUID-vkDestroyDeferredOperationKHR-pAllocator-parameter";
            DestroyDeferredOperationOperationParent = "VUID-vkDestroyDeferredOperationKHR-operation-parent";

            GetDeferredOperationMaxConcurrencyDeviceParameter = "VUID-vkGetDeferredOperationMaxConcurrencyKHR-device-parameter";
            GetDeferredOperationMaxConcurrencyOperationParameter = "VUID-vkGetDeferredOperationMaxConcurrencyKHR-operation-parameter";
            GetDeferredOperationMaxConcurrencyOperationParent = "VUID-vkGetDeferredOperationMaxConcurrencyKHR-operation-parent";

            GetDeferredOperationResultDeviceParameter = "VUID-vkGetDeferredOperationResultKHR-device-parameter";
            GetDeferredOperationResultOperationParameter = "VUID-vkGetDeferredOperationResultKHR-operation-parameter";
            GetDeferredOperationResultOperationParent = "VUID-vkGetDeferredOperationResultKHR-operation-parent";
        }
    };
}
