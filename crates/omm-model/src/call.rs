//! One vocabulary for everything that calls the API.
//!
//! A scenario writes calls down, the validator checks them, the device executes them, a trace stores them. A [`Call`] carries the
//! parameters of one API command under their names (snake case, without `p` and `pp`) and in their order. Whatever an application
//! may get wrong is representable.
//!
//! A command that creates objects names the handles of what it creates: to a validator that watches a real program they are what
//! the driver returned; the simulated device gives the new object exactly that handle. What a command returns beside handles is
//! its [`Output`].
//!
//! Commands that matter here for little of what they do are written down in reduced form, and say so: those that create devices,
//! pipelines and shaders, begin a render pass or trace rays. The structures of this module hold what is kept of theirs.

mod common;
mod names;
mod output;
mod reduced;

#[cfg(test)]
mod samples;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

use crate::vk;

pub use common::Timeline;
pub use output::Output;
pub use reduced::{
    DeviceCreateInfo, DeviceQueueCreateInfo, PhysicalDeviceFeatures2, PhysicalDeviceProperties2,
    RayTracingPipelineCreateInfo, RenderingInfo, ShaderCreateInfo,
};

/// One API command with its parameters.
///
/// # Host commands
///
/// A command with a `deferred_operation` does its work on the host. It returns success or an error at once if the operation is
/// null. Otherwise its output is [`Output::Result`] with `OPERATION_DEFERRED` if the work is to be done by joining the operation,
/// with `OPERATION_NOT_DEFERRED` if it is done already, or with an error if it could not be begun.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Call {
    /// Asks for features. Output: [`Output::Structures`].
    #[doc(alias = "vkGetPhysicalDeviceFeatures2")]
    GetPhysicalDeviceFeatures2 {
        /// The physical device.
        physical_device: vk::PhysicalDevice,
        /// The structures to fill.
        features: PhysicalDeviceFeatures2,
    },
    /// Asks for limits. Output: [`Output::Structures`].
    #[doc(alias = "vkGetPhysicalDeviceProperties2")]
    GetPhysicalDeviceProperties2 {
        /// The physical device.
        physical_device: vk::PhysicalDevice,
        /// The structures to fill.
        properties: PhysicalDeviceProperties2,
    },
    /// Creates a device.
    ///
    /// Calls may name a device whose creation was not among them, as where an engine starts to feed its calls midway. Such a device
    /// has the features of the [profile](crate::profile::DeviceProfile), one physical device and any queues.
    #[doc(alias = "vkCreateDevice")]
    CreateDevice {
        /// The physical device.
        physical_device: vk::PhysicalDevice,
        /// Queues, features, physical devices.
        create_info: DeviceCreateInfo,
        /// The new device.
        device: vk::Device,
    },
    /// Destroys a device.
    #[doc(alias = "vkDestroyDevice")]
    DestroyDevice {
        /// The device, or null.
        device: vk::Device,
    },
    /// Asks for a queue.
    #[doc(alias = "vkGetDeviceQueue")]
    GetDeviceQueue {
        /// The device.
        device: vk::Device,
        /// Its family, an index into those of the profile.
        queue_family_index: u32,
        /// Which queue of the family.
        queue_index: u32,
        /// The queue.
        queue: vk::Queue,
    },
    /// Creates a buffer, not yet bound to memory.
    #[doc(alias = "vkCreateBuffer")]
    CreateBuffer {
        /// The device.
        device: vk::Device,
        /// Size and usage.
        create_info: vk::BufferCreateInfo,
        /// The new buffer.
        buffer: vk::Buffer,
    },
    /// Destroys a buffer.
    #[doc(alias = "vkDestroyBuffer")]
    DestroyBuffer {
        /// The device.
        device: vk::Device,
        /// The buffer, or null.
        buffer: vk::Buffer,
    },
    /// Allocates memory.
    #[doc(alias = "vkAllocateMemory")]
    AllocateMemory {
        /// The device.
        device: vk::Device,
        /// How much, and of which type.
        allocate_info: vk::MemoryAllocateInfo,
        /// The new memory.
        memory: vk::DeviceMemory,
    },
    /// Frees memory.
    #[doc(alias = "vkFreeMemory")]
    FreeMemory {
        /// The device.
        device: vk::Device,
        /// The memory, or null.
        memory: vk::DeviceMemory,
    },
    /// Binds a buffer to memory.
    #[doc(alias = "vkBindBufferMemory")]
    BindBufferMemory {
        /// The device.
        device: vk::Device,
        /// The buffer.
        buffer: vk::Buffer,
        /// The memory.
        memory: vk::DeviceMemory,
        /// Offset of the buffer's first byte in the memory.
        memory_offset: u64,
    },
    /// Binds ranges of sparse buffers to memory.
    ///
    /// The batches of `VkBindSparseInfo` are written as one; images, semaphores and fences are outside this vocabulary.
    #[doc(alias = "vkQueueBindSparse")]
    QueueBindSparse {
        /// The queue.
        queue: vk::Queue,
        /// Buffers and their ranges.
        buffer_binds: Vec<vk::SparseBufferMemoryBindInfo>,
    },
    /// Asks for the address of a buffer. Output: [`Output::DeviceAddress`].
    #[doc(alias = "vkGetBufferDeviceAddress")]
    GetBufferDeviceAddress {
        /// The device.
        device: vk::Device,
        /// Which buffer.
        info: vk::BufferDeviceAddressInfo,
    },
    /// Creates a pool of command buffers.
    #[doc(alias = "vkCreateCommandPool")]
    CreateCommandPool {
        /// The device.
        device: vk::Device,
        /// Queue family.
        create_info: vk::CommandPoolCreateInfo,
        /// The new pool.
        command_pool: vk::CommandPool,
    },
    /// Destroys a pool and its command buffers.
    #[doc(alias = "vkDestroyCommandPool")]
    DestroyCommandPool {
        /// The device.
        device: vk::Device,
        /// The pool, or null.
        command_pool: vk::CommandPool,
    },
    /// Allocates command buffers.
    #[doc(alias = "vkAllocateCommandBuffers")]
    AllocateCommandBuffers {
        /// The device.
        device: vk::Device,
        /// From which pool, of which level, how many.
        allocate_info: vk::CommandBufferAllocateInfo,
        /// The new command buffers.
        command_buffers: Vec<vk::CommandBuffer>,
    },
    /// Gives command buffers back to their pool.
    #[doc(alias = "vkFreeCommandBuffers")]
    FreeCommandBuffers {
        /// The device.
        device: vk::Device,
        /// The pool.
        command_pool: vk::CommandPool,
        /// The command buffers; null ones are passed over.
        command_buffers: Vec<vk::CommandBuffer>,
    },
    /// Starts recording.
    #[doc(alias = "vkBeginCommandBuffer")]
    BeginCommandBuffer {
        /// The command buffer, which forgets what was recorded before.
        command_buffer: vk::CommandBuffer,
        /// How it will be used.
        begin_info: vk::CommandBufferBeginInfo,
    },
    /// Ends recording.
    #[doc(alias = "vkEndCommandBuffer")]
    EndCommandBuffer {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
    },
    /// Forgets what was recorded.
    #[doc(alias = "vkResetCommandBuffer")]
    ResetCommandBuffer {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
        /// How.
        flags: vk::CommandBufferResetFlags,
    },
    /// Submits command buffers, which execute one after the other.
    ///
    /// The batches of `VkSubmitInfo` are written as one; semaphores and fences are outside this vocabulary.
    #[doc(alias = "vkQueueSubmit")]
    QueueSubmit {
        /// The queue.
        queue: vk::Queue,
        /// The command buffers in order.
        command_buffers: Vec<vk::CommandBuffer>,
    },
    /// Records that secondary command buffers are executed.
    #[doc(alias = "vkCmdExecuteCommands")]
    CmdExecuteCommands {
        /// The primary command buffer.
        command_buffer: vk::CommandBuffer,
        /// The secondary command buffers in order.
        command_buffers: Vec<vk::CommandBuffer>,
    },
    /// Records the start of a render pass instance.
    #[doc(alias = "vkCmdBeginRendering")]
    CmdBeginRendering {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
        /// How it begins and will end.
        rendering_info: RenderingInfo,
    },
    /// Records the end of a render pass instance.
    #[doc(alias = "vkCmdEndRendering")]
    CmdEndRendering {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
    },
    /// Creates a pool of queries.
    #[doc(alias = "vkCreateQueryPool")]
    CreateQueryPool {
        /// The device.
        device: vk::Device,
        /// Type and number of queries.
        create_info: vk::QueryPoolCreateInfo,
        /// The new pool.
        query_pool: vk::QueryPool,
    },
    /// Destroys a pool of queries.
    #[doc(alias = "vkDestroyQueryPool")]
    DestroyQueryPool {
        /// The device.
        device: vk::Device,
        /// The pool, or null.
        query_pool: vk::QueryPool,
    },
    /// Makes queries unavailable, on the host.
    #[doc(alias = "vkResetQueryPool")]
    ResetQueryPool {
        /// The device.
        device: vk::Device,
        /// The pool.
        query_pool: vk::QueryPool,
        /// First query.
        first_query: u32,
        /// Number of queries.
        query_count: u32,
    },
    /// Records that queries become unavailable.
    #[doc(alias = "vkCmdResetQueryPool")]
    CmdResetQueryPool {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
        /// The pool.
        query_pool: vk::QueryPool,
        /// First query.
        first_query: u32,
        /// Number of queries.
        query_count: u32,
    },
    /// Reads queries. Output: [`Output::QueryResults`], or [`Output::Result`] with `NOT_READY`.
    #[doc(alias = "vkGetQueryPoolResults")]
    GetQueryPoolResults {
        /// The device.
        device: vk::Device,
        /// The pool.
        query_pool: vk::QueryPool,
        /// First query.
        first_query: u32,
        /// Number of queries.
        query_count: u32,
        /// Bytes of the array that takes the results.
        data_size: u64,
        /// Bytes from one result to the next.
        stride: u64,
        /// Width of a result and what to do with unavailable ones.
        flags: vk::QueryResultFlags,
    },
    /// Creates an acceleration structure on a range of a buffer. Cannot create micromaps.
    #[doc(alias = "vkCreateAccelerationStructureKHR")]
    CreateAccelerationStructure {
        /// The device.
        device: vk::Device,
        /// Where, how large, of which type.
        create_info: vk::AccelerationStructureCreateInfo,
        /// The new acceleration structure.
        acceleration_structure: vk::AccelerationStructure,
    },
    /// Creates an acceleration structure, or a micromap, on a range of addresses.
    #[doc(alias = "vkCreateAccelerationStructure2KHR")]
    CreateAccelerationStructure2 {
        /// The device.
        device: vk::Device,
        /// Where and of which type.
        create_info: vk::AccelerationStructureCreateInfo2,
        /// The new acceleration structure.
        acceleration_structure: vk::AccelerationStructure,
    },
    /// Destroys an acceleration structure; its memory keeps its bytes.
    #[doc(alias = "vkDestroyAccelerationStructureKHR")]
    DestroyAccelerationStructure {
        /// The device.
        device: vk::Device,
        /// The acceleration structure, or null.
        acceleration_structure: vk::AccelerationStructure,
    },
    /// Asks for the address by which instances and micromap blocks refer to an acceleration structure.
    /// Output: [`Output::DeviceAddress`].
    #[doc(alias = "vkGetAccelerationStructureDeviceAddressKHR")]
    GetAccelerationStructureDeviceAddress {
        /// The device.
        device: vk::Device,
        /// Which acceleration structure.
        info: vk::AccelerationStructureDeviceAddressInfo,
    },
    /// Asks how much memory a build will need. Output: [`Output::BuildSizes`].
    #[doc(alias = "vkGetAccelerationStructureBuildSizesKHR")]
    GetAccelerationStructureBuildSizes {
        /// The device.
        device: vk::Device,
        /// Host or device.
        build_type: vk::AccelerationStructureBuildType,
        /// The build; addresses, handles and mode are ignored.
        build_info: vk::BuildGeometryInfo,
        /// The most primitives of each geometry; `None` is a null pointer, as micromaps need it.
        max_primitive_counts: Option<Vec<u32>>,
    },
    /// Asks whether serialized data can be deserialized here. Output: [`Output::Compatibility`].
    #[doc(alias = "vkGetDeviceAccelerationStructureCompatibilityKHR")]
    GetDeviceAccelerationStructureCompatibility {
        /// The device.
        device: vk::Device,
        /// The first 32 bytes of the serialized data.
        version_info: vk::AccelerationStructureVersionInfo,
    },
    /// Records builds and updates of acceleration structures.
    #[doc(alias = "vkCmdBuildAccelerationStructuresKHR")]
    CmdBuildAccelerationStructures {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
        /// One build each.
        infos: Vec<vk::BuildGeometryInfo>,
        /// For each build the ranges of its geometries; `None` is a null pointer, as micromaps need it.
        build_range_infos: Vec<Option<Vec<vk::BuildRangeInfo>>>,
    },
    /// Records builds and updates of acceleration structures whose ranges lie in device memory.
    #[doc(alias = "vkCmdBuildAccelerationStructuresIndirectKHR")]
    CmdBuildAccelerationStructuresIndirect {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
        /// One build each.
        infos: Vec<vk::BuildGeometryInfo>,
        /// For each build where its [`vk::BuildRangeInfo`] entries begin.
        indirect_device_addresses: Vec<vk::DeviceAddress>,
        /// For each build the bytes from one entry to the next.
        indirect_strides: Vec<u32>,
        /// For each build the most primitives of each geometry; `None` is a null pointer.
        max_primitive_counts: Vec<Option<Vec<u32>>>,
    },
    /// Records a clone or compaction.
    #[doc(alias = "vkCmdCopyAccelerationStructureKHR")]
    CmdCopyAccelerationStructure {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
        /// From, to and mode.
        info: vk::CopyAccelerationStructureInfo,
    },
    /// Records a serialization.
    #[doc(alias = "vkCmdCopyAccelerationStructureToMemoryKHR")]
    CmdCopyAccelerationStructureToMemory {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
        /// From, to and mode.
        info: vk::CopyAccelerationStructureToMemoryInfo,
    },
    /// Records a deserialization.
    #[doc(alias = "vkCmdCopyMemoryToAccelerationStructureKHR")]
    CmdCopyMemoryToAccelerationStructure {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
        /// From, to and mode.
        info: vk::CopyMemoryToAccelerationStructureInfo,
    },
    /// Records queries of sizes.
    #[doc(alias = "vkCmdWriteAccelerationStructuresPropertiesKHR")]
    CmdWriteAccelerationStructuresProperties {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
        /// Whose sizes.
        acceleration_structures: Vec<vk::AccelerationStructure>,
        /// Which size.
        query_type: vk::QueryType,
        /// The pool that takes the results.
        query_pool: vk::QueryPool,
        /// The query that takes the first.
        first_query: u32,
    },
    /// Builds and updates acceleration structures on the host. Output: as of every [host command](Call#host-commands).
    #[doc(alias = "vkBuildAccelerationStructuresKHR")]
    BuildAccelerationStructures {
        /// The device.
        device: vk::Device,
        /// The operation that the command may be deferred on, or null.
        deferred_operation: vk::DeferredOperation,
        /// One build each.
        infos: Vec<vk::BuildGeometryInfo>,
        /// For each build the ranges of its geometries; `None` is a null pointer.
        build_range_infos: Vec<Option<Vec<vk::BuildRangeInfo>>>,
    },
    /// Clones or compacts on the host. Output: as of every [host command](Call#host-commands).
    #[doc(alias = "vkCopyAccelerationStructureKHR")]
    CopyAccelerationStructure {
        /// The device.
        device: vk::Device,
        /// The operation that the command may be deferred on, or null.
        deferred_operation: vk::DeferredOperation,
        /// From, to and mode.
        info: vk::CopyAccelerationStructureInfo,
    },
    /// Serializes on the host. Output: as of every [host command](Call#host-commands).
    #[doc(alias = "vkCopyAccelerationStructureToMemoryKHR")]
    CopyAccelerationStructureToMemory {
        /// The device.
        device: vk::Device,
        /// The operation that the command may be deferred on, or null.
        deferred_operation: vk::DeferredOperation,
        /// From, to and mode.
        info: vk::CopyAccelerationStructureToMemoryInfo,
    },
    /// Deserializes on the host. Output: as of every [host command](Call#host-commands).
    #[doc(alias = "vkCopyMemoryToAccelerationStructureKHR")]
    CopyMemoryToAccelerationStructure {
        /// The device.
        device: vk::Device,
        /// The operation that the command may be deferred on, or null.
        deferred_operation: vk::DeferredOperation,
        /// From, to and mode.
        info: vk::CopyMemoryToAccelerationStructureInfo,
    },
    /// Asks for sizes on the host. Output: [`Output::Properties`].
    #[doc(alias = "vkWriteAccelerationStructuresPropertiesKHR")]
    WriteAccelerationStructuresProperties {
        /// The device.
        device: vk::Device,
        /// Whose sizes.
        acceleration_structures: Vec<vk::AccelerationStructure>,
        /// Which size.
        query_type: vk::QueryType,
        /// Bytes of the array that takes the results.
        data_size: u64,
        /// Bytes from one result to the next.
        stride: u64,
    },
    /// Creates a micromap object on a range of a buffer.
    #[doc(alias = "vkCreateMicromapEXT")]
    CreateMicromap {
        /// The device.
        device: vk::Device,
        /// Where, how large, of which type.
        create_info: vk::MicromapCreateInfo,
        /// The new micromap.
        micromap: vk::Micromap,
    },
    /// Destroys a micromap object; its memory keeps its bytes.
    #[doc(alias = "vkDestroyMicromapEXT")]
    DestroyMicromap {
        /// The device.
        device: vk::Device,
        /// The micromap, or null.
        micromap: vk::Micromap,
    },
    /// Asks how much memory a build will need. Output: [`Output::MicromapBuildSizes`].
    #[doc(alias = "vkGetMicromapBuildSizesEXT")]
    GetMicromapBuildSizes {
        /// The device.
        device: vk::Device,
        /// Host or device.
        build_type: vk::AccelerationStructureBuildType,
        /// The build; addresses, handles and mode are ignored.
        build_info: vk::MicromapBuildInfo,
    },
    /// Asks whether a serialized micromap can be deserialized here. Output: [`Output::Compatibility`].
    #[doc(alias = "vkGetDeviceMicromapCompatibilityEXT")]
    GetDeviceMicromapCompatibility {
        /// The device.
        device: vk::Device,
        /// The first 32 bytes of the serialized micromap.
        version_info: vk::MicromapVersionInfo,
    },
    /// Records builds of micromap objects.
    #[doc(alias = "vkCmdBuildMicromapsEXT")]
    CmdBuildMicromaps {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
        /// One build each.
        infos: Vec<vk::MicromapBuildInfo>,
    },
    /// Records a clone or compaction of a micromap object.
    #[doc(alias = "vkCmdCopyMicromapEXT")]
    CmdCopyMicromap {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
        /// From, to and mode.
        info: vk::CopyMicromapInfo,
    },
    /// Records a serialization of a micromap object.
    #[doc(alias = "vkCmdCopyMicromapToMemoryEXT")]
    CmdCopyMicromapToMemory {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
        /// From, to and mode.
        info: vk::CopyMicromapToMemoryInfo,
    },
    /// Records a deserialization of a micromap object.
    #[doc(alias = "vkCmdCopyMemoryToMicromapEXT")]
    CmdCopyMemoryToMicromap {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
        /// From, to and mode.
        info: vk::CopyMemoryToMicromapInfo,
    },
    /// Records queries of sizes of micromap objects.
    #[doc(alias = "vkCmdWriteMicromapsPropertiesEXT")]
    CmdWriteMicromapsProperties {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
        /// Whose sizes.
        micromaps: Vec<vk::Micromap>,
        /// Which size.
        query_type: vk::QueryType,
        /// The pool that takes the results.
        query_pool: vk::QueryPool,
        /// The query that takes the first.
        first_query: u32,
    },
    /// Builds micromap objects on the host. Output: as of every [host command](Call#host-commands).
    #[doc(alias = "vkBuildMicromapsEXT")]
    BuildMicromaps {
        /// The device.
        device: vk::Device,
        /// The operation that the command may be deferred on, or null.
        deferred_operation: vk::DeferredOperation,
        /// One build each.
        infos: Vec<vk::MicromapBuildInfo>,
    },
    /// Clones or compacts a micromap object on the host. Output: as of every [host command](Call#host-commands).
    #[doc(alias = "vkCopyMicromapEXT")]
    CopyMicromap {
        /// The device.
        device: vk::Device,
        /// The operation that the command may be deferred on, or null.
        deferred_operation: vk::DeferredOperation,
        /// From, to and mode.
        info: vk::CopyMicromapInfo,
    },
    /// Serializes a micromap object on the host. Output: as of every [host command](Call#host-commands).
    #[doc(alias = "vkCopyMicromapToMemoryEXT")]
    CopyMicromapToMemory {
        /// The device.
        device: vk::Device,
        /// The operation that the command may be deferred on, or null.
        deferred_operation: vk::DeferredOperation,
        /// From, to and mode.
        info: vk::CopyMicromapToMemoryInfo,
    },
    /// Deserializes a micromap object on the host. Output: as of every [host command](Call#host-commands).
    #[doc(alias = "vkCopyMemoryToMicromapEXT")]
    CopyMemoryToMicromap {
        /// The device.
        device: vk::Device,
        /// The operation that the command may be deferred on, or null.
        deferred_operation: vk::DeferredOperation,
        /// From, to and mode.
        info: vk::CopyMemoryToMicromapInfo,
    },
    /// Asks for sizes of micromap objects on the host. Output: [`Output::Properties`].
    #[doc(alias = "vkWriteMicromapsPropertiesEXT")]
    WriteMicromapsProperties {
        /// The device.
        device: vk::Device,
        /// Whose sizes.
        micromaps: Vec<vk::Micromap>,
        /// Which size.
        query_type: vk::QueryType,
        /// Bytes of the array that takes the results.
        data_size: u64,
        /// Bytes from one result to the next.
        stride: u64,
    },
    /// Creates an operation that host commands can be deferred on, one at a time.
    #[doc(alias = "vkCreateDeferredOperationKHR")]
    CreateDeferredOperation {
        /// The device.
        device: vk::Device,
        /// The new operation.
        deferred_operation: vk::DeferredOperation,
    },
    /// Destroys an operation, on which no command may be pending.
    #[doc(alias = "vkDestroyDeferredOperationKHR")]
    DestroyDeferredOperation {
        /// The device.
        device: vk::Device,
        /// The operation, or null.
        operation: vk::DeferredOperation,
    },
    /// Asks how many threads can join usefully. Output: [`Output::MaxConcurrency`].
    #[doc(alias = "vkGetDeferredOperationMaxConcurrencyKHR")]
    GetDeferredOperationMaxConcurrency {
        /// The device.
        device: vk::Device,
        /// The operation.
        operation: vk::DeferredOperation,
    },
    /// Asks for the result of the deferred command.
    ///
    /// Output: [`Output::Result`] with `NOT_READY` while it is pending, then what the command would have returned at once.
    #[doc(alias = "vkGetDeferredOperationResultKHR")]
    GetDeferredOperationResult {
        /// The device.
        device: vk::Device,
        /// The operation.
        operation: vk::DeferredOperation,
    },
    /// Lends the calling thread to the deferred command.
    ///
    /// Output: [`Output::None`] if the command is complete, [`Output::Result`] with `THREAD_DONE` if nothing is left to do for this
    /// thread, with `THREAD_IDLE` if there is nothing to do at the moment.
    #[doc(alias = "vkDeferredOperationJoinKHR")]
    DeferredOperationJoin {
        /// The device.
        device: vk::Device,
        /// The operation.
        operation: vk::DeferredOperation,
    },
    /// Creates pipelines that trace rays.
    ///
    /// Pipeline cache and deferral are outside this vocabulary.
    #[doc(alias = "vkCreateRayTracingPipelinesKHR")]
    CreateRayTracingPipelines {
        /// The device.
        device: vk::Device,
        /// One pipeline each.
        create_infos: Vec<RayTracingPipelineCreateInfo>,
        /// The new pipelines.
        pipelines: Vec<vk::Pipeline>,
    },
    /// Destroys a pipeline.
    #[doc(alias = "vkDestroyPipeline")]
    DestroyPipeline {
        /// The device.
        device: vk::Device,
        /// The pipeline, or null.
        pipeline: vk::Pipeline,
    },
    /// Creates shader objects, whose ray queries trace rays.
    #[doc(alias = "vkCreateShadersEXT")]
    CreateShaders {
        /// The device.
        device: vk::Device,
        /// One shader each.
        create_infos: Vec<ShaderCreateInfo>,
        /// The new shaders.
        shaders: Vec<vk::Shader>,
    },
    /// Destroys a shader object.
    #[doc(alias = "vkDestroyShaderEXT")]
    DestroyShader {
        /// The device.
        device: vk::Device,
        /// The shader, or null.
        shader: vk::Shader,
    },
    /// Records that a pipeline traces rays.
    ///
    /// In reduced form: which pipeline meets which structure, without shader binding tables and the number of rays. The pipeline
    /// stands for the one that is bound, the address for what its shaders trace against.
    #[doc(alias = "vkCmdTraceRaysKHR")]
    CmdTraceRays {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
        /// The pipeline.
        pipeline: vk::Pipeline,
        /// Address of the top-level acceleration structure.
        top_level: vk::DeviceAddress,
    },
    /// Records that a compute shader traces rays by query.
    ///
    /// In reduced form, as [`CmdTraceRays`](Call::CmdTraceRays).
    #[doc(alias = "vkCmdDispatch")]
    CmdDispatch {
        /// The command buffer.
        command_buffer: vk::CommandBuffer,
        /// The shader object.
        shader: vk::Shader,
        /// Address of the top-level acceleration structure.
        top_level: vk::DeviceAddress,
    },
}
