//! A simulated Vulkan device that executes calls on acceleration structures and owns the bytes.
//!
//! A [`Device`] takes [`Call`](omm_model::call::Call)s, one API command each, and answers with an
//! [`Output`](omm_model::call::Output). It has memory with device addresses, buffers, command buffers, queries, acceleration
//! structures and the micromap objects of `VK_EXT_opacity_micromap`; micromaps, bottom-level and top-level structures are built,
//! updated, cloned, compacted, serialized and deserialized. What it builds lies in its memory in the packed form of
//! [`omm_layout::object`], the same for both extensions, and everything else works on those bytes: a handle stands for an address,
//! a size and a type, and for nothing more.
//!
//! # Undefined
//!
//! The device does not check valid usage; that is a validator's business. It does what it is told as long as that means
//! something. Where the specification leaves behaviour undefined and no meaning can be given — a handle that names nothing, an
//! address in no buffer, an index beyond the micromap, a race between two builds of one command — it stops with [`Undefined`],
//! which says where and why, and is as it was before the call.
//!
//! Commands with a meaning that is not simulated stop with [`Reason::Unsupported`]: displacement micromaps, buffers with
//! sparse residency or with several bound pieces, and structures of tens of gibibytes.
//!
//! # Host commands
//!
//! They read and write host memory that the device lends ([`Device::allocate_host`], [`Device::write_host`], and
//! [`read_host`](omm_model::memory::MemoryView::read_host)), on objects in memory that the host can map. Given a deferred
//! operation they leave their work to the threads that join it: by [`Call::DeferredOperationJoin`](omm_model::call::Call), or, from
//! several threads at once, by [`Device::join`]. Each element of `pInfos` is a unit of work.
//!
//! # Micromaps
//!
//! A build that may lose states stores what is beyond the four-state limit at that limit. A coarse microtriangle keeps the state
//! that all its parts have, and is otherwise unknown opaque or unknown transparent, whichever half of the parts it is more like;
//! nothing but the elements of the triangle decides it. What is within the limit stays as it is. No micromap is discardable:
//! bottom-level structures refer to micromaps of either extension and copy nothing of them.
//!
//! An update keeps for each geometry whether it has a micromap. Without a flag for updates of micromaps the micromap has to hold
//! what it held; with either flag it may be another; with the flag for full updates an EXT micromap may also become null or cease
//! to be. Indices may change in all cases.
//!
//! Commands that trace rays reach every structure and micromap that a ray could reach, and find nothing.
//!
//! # The same bytes every time
//!
//! Addresses follow from the order in which buffers are created, structures from their input, sizes from counts. The same calls
//! and uploads on the same profile give the same bytes on every machine. Memory is zero until it is written, each buffer begins
//! at a multiple of 64 KiB, and between any two lie at least 64 KiB that nobody can access.
//!
//! | room | holds |
//! |---|---|
//! | [`Device`] | the objects, and [`execute`](Device::execute); it is a [`MemoryView`](omm_model::memory::MemoryView) |
//! | [`AccelerationStructure`], [`Micromap`] | what handles stand for |
//! | [`Undefined`], [`Reason`] | why it stopped |
//! | [`app`] | an application's side: uploads, builds, copies and queries in a call each, for demos and tests |
//!
//! # Example
//!
//! ```
//! use omm_device::{Device, Reason};
//! use omm_model::call::{Call, Output};
//! use omm_model::profile::DeviceProfile;
//! use omm_model::vk;
//!
//! let mut device = Device::new(DeviceProfile::reference());
//! let handle = vk::Device(1);
//! let buffer = vk::Buffer(device.unused_handle());
//! let create_info = vk::BufferCreateInfo { size: 256, ..Default::default() };
//! let create = Call::CreateBuffer { device: handle, create_info, buffer };
//! assert_eq!(device.execute(&create), Ok(Output::None));
//!
//! // Without memory behind it a buffer has no address to give away.
//! let info = vk::BufferDeviceAddressInfo { buffer, ..Default::default() };
//! let undefined = device.execute(&Call::GetBufferDeviceAddress { device: handle, info }).unwrap_err();
//! assert_eq!(undefined.why, Reason::NotBound { buffer: 1 });
//! assert_eq!(
//!     undefined.to_string(),
//!     "vkGetBufferDeviceAddress: pInfo->buffer: buffer 0x1 is not bound to memory"
//! );
//! ```

mod acceleration_structure;
pub mod app;
mod buffer;
mod build;
mod command_buffer;
mod copy;
mod deferred;
mod device;
mod holder;
mod memory;
mod micromap;
mod names;
mod query;
mod trace;
mod undefined;
mod work;

pub use acceleration_structure::AccelerationStructure;
pub use command_buffer::CommandBufferState;
pub use device::{DEFAULT_HEAP_SIZE, Device};
pub use micromap::Micromap;
pub use query::MAX_QUERIES;
pub use trace::StructureMemory;
pub use undefined::{Reason, Submitted, Undefined};
