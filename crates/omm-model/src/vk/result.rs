//! What commands return.

use super::enumerant::open_enum;

open_enum! {
    /// How a command ended; negative is an error:
    /// [`VkResult`](https://docs.vulkan.org/refpages/latest/refpages/source/VkResult.html).
    ///
    /// The constants are the codes that commands in scope return.
    #[doc(alias = "VkResult")]
    pub struct Result {
        /// The command did what it was asked.
        SUCCESS = 0, "VK_SUCCESS";
        /// A query or another result is not there yet.
        NOT_READY = 1, "VK_NOT_READY";
        /// A wait took longer than it was allowed to.
        TIMEOUT = 2, "VK_TIMEOUT";
        /// An event is signalled.
        EVENT_SET = 3, "VK_EVENT_SET";
        /// An event is not signalled.
        EVENT_RESET = 4, "VK_EVENT_RESET";
        /// The array for the results was too short for all of them.
        INCOMPLETE = 5, "VK_INCOMPLETE";
        /// No host memory is left.
        ERROR_OUT_OF_HOST_MEMORY = -1, "VK_ERROR_OUT_OF_HOST_MEMORY";
        /// No device memory is left.
        ERROR_OUT_OF_DEVICE_MEMORY = -2, "VK_ERROR_OUT_OF_DEVICE_MEMORY";
        /// An object could not be initialised.
        ERROR_INITIALIZATION_FAILED = -3, "VK_ERROR_INITIALIZATION_FAILED";
        /// The device is lost, with all that it was doing.
        ERROR_DEVICE_LOST = -4, "VK_ERROR_DEVICE_LOST";
        /// Memory could not be mapped.
        ERROR_MEMORY_MAP_FAILED = -5, "VK_ERROR_MEMORY_MAP_FAILED";
        /// There is no such layer.
        ERROR_LAYER_NOT_PRESENT = -6, "VK_ERROR_LAYER_NOT_PRESENT";
        /// There is no such extension.
        ERROR_EXTENSION_NOT_PRESENT = -7, "VK_ERROR_EXTENSION_NOT_PRESENT";
        /// The device does not have the feature.
        ERROR_FEATURE_NOT_PRESENT = -8, "VK_ERROR_FEATURE_NOT_PRESENT";
        /// The driver does not support the version.
        ERROR_INCOMPATIBLE_DRIVER = -9, "VK_ERROR_INCOMPATIBLE_DRIVER";
        /// There are as many objects of the kind as there can be.
        ERROR_TOO_MANY_OBJECTS = -10, "VK_ERROR_TOO_MANY_OBJECTS";
        /// The device does not support the format.
        ERROR_FORMAT_NOT_SUPPORTED = -11, "VK_ERROR_FORMAT_NOT_SUPPORTED";
        /// A pool has room, but not in one piece.
        ERROR_FRAGMENTED_POOL = -12, "VK_ERROR_FRAGMENTED_POOL";
        /// Something else went wrong.
        ERROR_UNKNOWN = -13, "VK_ERROR_UNKNOWN";
        /// The command broke a valid-usage rule, and something between application and driver refused it.
        ERROR_VALIDATION_FAILED = -1_000_011_001, "VK_ERROR_VALIDATION_FAILED";
        /// A pool has no room left.
        ERROR_OUT_OF_POOL_MEMORY = -1_000_069_000, "VK_ERROR_OUT_OF_POOL_MEMORY";
        /// A handle from outside is not one of the type that was said.
        ERROR_INVALID_EXTERNAL_HANDLE = -1_000_072_003, "VK_ERROR_INVALID_EXTERNAL_HANDLE";
        /// Memory has room for the descriptors, but not in one piece.
        ERROR_FRAGMENTATION = -1_000_161_000, "VK_ERROR_FRAGMENTATION";
        /// The application may not have the priority it asked for.
        ERROR_NOT_PERMITTED = -1_000_174_001, "VK_ERROR_NOT_PERMITTED";
        /// The address asked for when replaying is not free or not usable.
        ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS = -1_000_257_000, "VK_ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS";
        /// The deferred operation is not done, and there is nothing for this thread to do at the moment.
        THREAD_IDLE = 1_000_268_000, "VK_THREAD_IDLE_KHR";
        /// The deferred operation is not done, and there is nothing left for this thread to do.
        THREAD_DONE = 1_000_268_001, "VK_THREAD_DONE_KHR";
        /// The command was deferred: its work is done by joining the operation.
        OPERATION_DEFERRED = 1_000_268_002, "VK_OPERATION_DEFERRED_KHR";
        /// The command could have been deferred, and was done at once.
        OPERATION_NOT_DEFERRED = 1_000_268_003, "VK_OPERATION_NOT_DEFERRED_KHR";
        /// A pipeline would have to be compiled, which the application forbade.
        PIPELINE_COMPILE_REQUIRED = 1_000_297_000, "VK_PIPELINE_COMPILE_REQUIRED";
    }
}

impl Result {
    /// Whether this is an error code, which all negative ones are.
    pub const fn is_error(self) -> bool {
        self.0 < 0
    }
}
