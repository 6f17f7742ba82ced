//! A small application: the calls that it takes to upload data, build structures and get sizes back, each shown to an observer.
//!
//! An [`App`] issues ordinary [`Call`]s to a [`Device`] and knows nothing that an application could not know. Its [`Observer`]
//! sees every call with the device's memory before it is executed, and the output after, so that the same calls can be
//! validated, written down or counted.
//!
//! # Example
//!
//! A micromap of one triangle, built, compacted and serialized:
//!
//! ```
//! use omm_device::app::{App, MicromapInput};
//! use omm_device::Device;
//! use omm_model::format::OpacityMicromapFormat;
//! use omm_model::level::SubdivisionLevel;
//! use omm_model::profile::DeviceProfile;
//! use omm_model::triangle::MicromapTriangle;
//! use omm_model::vk;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut device = Device::new(DeviceProfile::reference());
//! let mut observer = ();
//! let mut app = App::new(&mut device, &mut observer);
//!
//! let format = OpacityMicromapFormat::TwoState;
//! let triangle = MicromapTriangle { data_offset: 0, subdivision_level: SubdivisionLevel::new(2)?, format };
//! let micromap = app.build_micromap(&MicromapInput {
//!     data: &[0b1010_0101, 0b1111_0000],
//!     triangles: &[triangle],
//!     flags: vk::BuildAccelerationStructureFlags::ALLOW_COMPACTION,
//! })?;
//! let compacted = app.copy(&micromap, vk::CopyAccelerationStructureMode::COMPACT)?;
//! assert!(compacted.size <= micromap.size);
//!
//! let blob = app.serialize(&compacted)?;
//! let again = app.deserialize(&blob, vk::AccelerationStructureType::OPACITY_MICROMAP)?;
//! assert_eq!(app.serialize(&again)?, blob);
//! # Ok(())
//! # }
//! ```

use omm_layout::error::{ReadError, WriteError};
use omm_model::call::{Call, Output};
use omm_model::memory::{MemoryError, MemoryView};
use omm_model::vk;

use crate::device::Device;
use crate::undefined::Undefined;

mod copy;
mod ext;
mod input;
mod structure;

pub use ext::{MicromapBindingExt, MicromapExt};
pub use input::{MicromapBinding, MicromapInput, TriangleInput};
pub use structure::Structure;

/// Somebody who looks at the calls of an [`App`]. `()` looks away.
pub trait Observer {
    /// A call is about to be executed; `memory` is the device's as it is now.
    fn before(&mut self, call: &Call, memory: &dyn MemoryView);

    /// The call was executed. A call that stops the device is seen by [`before`](Self::before) only.
    fn after(&mut self, call: &Call, output: &Output);
}

impl Observer for () {
    fn before(&mut self, _call: &Call, _memory: &dyn MemoryView) {}
    fn after(&mut self, _call: &Call, _output: &Output) {}
}

/// Why an [`App`] could not go on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AppError {
    /// The device stopped: the call leaves its behaviour undefined.
    #[error(transparent)]
    Undefined(#[from] Undefined),
    /// A command answered with an error code, such as "out of device memory".
    #[error("{command} returned {result:?}")]
    Result {
        /// The command.
        command: &'static str,
        /// What it returned.
        result: vk::Result,
    },
    /// A command answered something else than it should.
    #[error("{command} returned {found:?}")]
    Output {
        /// The command.
        command: &'static str,
        /// What it returned.
        found: Output,
    },
    /// The application reached beyond its own buffers.
    #[error(transparent)]
    Memory(#[from] MemoryError),
    /// Serialized data of another driver or of an incompatible version.
    #[error("the serialized data is not compatible with the device")]
    Incompatible,
    /// Serialized data that cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// Input that has no place in the bytes that the device reads.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// More elements than the API can count.
    #[error("{found} {what} are more than 32 bits count")]
    Count {
        /// What was counted.
        what: &'static str,
        /// How many there are.
        found: usize,
    },
}

/// A buffer with memory of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Buffer {
    /// The buffer.
    pub buffer: vk::Buffer,
    /// Its memory.
    pub memory: vk::DeviceMemory,
    /// The address of its first byte.
    pub address: vk::DeviceAddress,
    /// Bytes.
    pub size: u64,
}

/// An application on a device.
pub struct App<'a> {
    device: &'a mut Device,
    observer: &'a mut dyn Observer,
}

impl std::fmt::Debug for App<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("App").field("device", &self.device).finish_non_exhaustive()
    }
}

/// The handle of the device and of its queue, which the simulated device does not look at.
const DEVICE: vk::Device = vk::Device(1);
const QUEUE: vk::Queue = vk::Queue(1);

impl<'a> App<'a> {
    /// An application on `device`, which may already have objects.
    pub fn new(device: &'a mut Device, observer: &'a mut dyn Observer) -> Self {
        Self { device, observer }
    }

    /// The device.
    #[must_use]
    pub fn device(&self) -> &Device {
        self.device
    }

    /// The handle for the next object.
    fn handle(&self) -> u64 {
        self.device.unused_handle()
    }

    /// Issues a call.
    ///
    /// # Errors
    /// The device stopped, or the command returned an error.
    pub fn call(&mut self, call: &Call) -> Result<Output, AppError> {
        self.observer.before(call, self.device);
        let output = self.device.execute(call)?;
        self.observer.after(call, &output);
        match output {
            Output::Result(result) if result.is_error() => Err(AppError::Result { command: call.command(), result }),
            output => Ok(output),
        }
    }

    /// Issues a call that answers with an address.
    fn address(&mut self, call: &Call) -> Result<vk::DeviceAddress, AppError> {
        match self.call(call)? {
            Output::DeviceAddress(address) => Ok(address),
            found => Err(AppError::Output { command: call.command(), found }),
        }
    }

    /// A buffer of at least one byte, bound to new memory. `SHADER_DEVICE_ADDRESS` is added to its usage.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn buffer(&mut self, size: u64, usage: vk::BufferUsageFlags) -> Result<Buffer, AppError> {
        self.buffer_of_type(size, usage, 0)
    }

    /// Such a buffer in memory that the host can map, as host commands need it.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn host_buffer(&mut self, size: u64, usage: vk::BufferUsageFlags) -> Result<Buffer, AppError> {
        let memory_type = self.device.profile().find_memory_type(vk::MemoryPropertyFlags::HOST_VISIBLE);
        self.buffer_of_type(size, usage, memory_type.unwrap_or_default())
    }

    fn buffer_of_type(
        &mut self,
        size: u64,
        usage: vk::BufferUsageFlags,
        memory_type_index: u32,
    ) -> Result<Buffer, AppError> {
        let size = size.max(1);
        let buffer = vk::Buffer(self.handle());
        let usage = usage | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let create_info = vk::BufferCreateInfo { size, usage, ..Default::default() };
        self.call(&Call::CreateBuffer { device: DEVICE, create_info, buffer })?;
        let memory = vk::DeviceMemory(self.handle());
        let flags = vk::MemoryAllocateFlags::DEVICE_ADDRESS;
        let flags = vk::MemoryAllocateFlagsInfo { flags, ..Default::default() };
        let allocate_info = vk::MemoryAllocateInfo {
            next: vec![flags.into()],
            allocation_size: size,
            memory_type_index,
            ..Default::default()
        };
        self.call(&Call::AllocateMemory { device: DEVICE, allocate_info, memory })?;
        self.call(&Call::BindBufferMemory { device: DEVICE, buffer, memory, memory_offset: 0 })?;
        let info = vk::BufferDeviceAddressInfo { buffer, ..Default::default() };
        let address = self.address(&Call::GetBufferDeviceAddress { device: DEVICE, info })?;
        Ok(Buffer { buffer, memory, address, size })
    }

    /// A buffer that holds `bytes`.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn upload(&mut self, bytes: &[u8], usage: vk::BufferUsageFlags) -> Result<Buffer, AppError> {
        let buffer = self.buffer(bytes.len() as u64, usage)?;
        self.device.write(buffer.address, bytes)?;
        Ok(buffer)
    }

    /// A buffer with input of builds.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn upload_input(&mut self, bytes: &[u8]) -> Result<Buffer, AppError> {
        self.upload(bytes, vk::BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY)
    }

    /// Host memory that holds `bytes`, for host commands.
    ///
    /// # Errors
    /// The device has no room for it.
    pub fn upload_host(&mut self, bytes: &[u8]) -> Result<vk::HostAddress, AppError> {
        let size = (bytes.len() as u64).max(1);
        let no_room = MemoryError { address: 0, size, available: 0 };
        let address = self.device.allocate_host(size).ok_or(no_room)?;
        self.device.write_host(address, bytes)?;
        Ok(address)
    }

    /// Writes bytes into a buffer, from `address` on.
    ///
    /// # Errors
    /// They do not all lie in one buffer.
    pub fn write(&mut self, address: vk::DeviceAddress, bytes: &[u8]) -> Result<(), AppError> {
        Ok(self.device.write(address, bytes)?)
    }

    /// The bytes that a buffer holds.
    ///
    /// # Errors
    /// The buffer was destroyed.
    pub fn download(&self, buffer: &Buffer) -> Result<Vec<u8>, AppError> {
        Ok(self.device.read(buffer.address, buffer.size)?.to_vec())
    }

    /// Destroys a buffer and frees its memory.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn destroy(&mut self, buffer: Buffer) -> Result<(), AppError> {
        self.call(&Call::DestroyBuffer { device: DEVICE, buffer: buffer.buffer })?;
        self.call(&Call::FreeMemory { device: DEVICE, memory: buffer.memory })?;
        Ok(())
    }

    /// Records the commands that `commands` makes for a command buffer of its own, and submits them.
    ///
    /// # Errors
    /// As [`App::call`].
    pub fn submit(&mut self, commands: impl FnOnce(vk::CommandBuffer) -> Vec<Call>) -> Result<(), AppError> {
        let command_pool = vk::CommandPool(self.handle());
        let create_info =
            vk::CommandPoolCreateInfo { flags: vk::CommandPoolCreateFlags::TRANSIENT, ..Default::default() };
        self.call(&Call::CreateCommandPool { device: DEVICE, create_info, command_pool })?;
        let submitted = self.submit_from(command_pool, commands);
        // Whatever became of the commands, the pool is not needed any more.
        self.call(&Call::DestroyCommandPool { device: DEVICE, command_pool })?;
        submitted
    }

    fn submit_from(
        &mut self,
        command_pool: vk::CommandPool,
        commands: impl FnOnce(vk::CommandBuffer) -> Vec<Call>,
    ) -> Result<(), AppError> {
        let command_buffer = vk::CommandBuffer(self.handle());
        let allocate_info =
            vk::CommandBufferAllocateInfo { command_pool, command_buffer_count: 1, ..Default::default() };
        let command_buffers = vec![command_buffer];
        self.call(&Call::AllocateCommandBuffers { device: DEVICE, allocate_info, command_buffers })?;
        let flags = vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT;
        let begin_info = vk::CommandBufferBeginInfo { flags, ..Default::default() };
        self.call(&Call::BeginCommandBuffer { command_buffer, begin_info })?;
        for command in commands(command_buffer) {
            self.call(&command)?;
        }
        self.call(&Call::EndCommandBuffer { command_buffer })?;
        self.call(&Call::QueueSubmit { queue: QUEUE, command_buffers: vec![command_buffer] })?;
        Ok(())
    }
}
