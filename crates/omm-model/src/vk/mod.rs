//! The raw vocabulary of the API: every enumerant, flag and structure of the extensions in scope, under Vulkan's names.
//!
//! The extensions are `VK_KHR_opacity_micromap`, `VK_EXT_opacity_micromap`, `VK_KHR_acceleration_structure`, the
//! acceleration-structure part of `VK_KHR_device_address_commands`, `VK_KHR_deferred_host_operations` and
//! `VK_NV_ray_tracing_motion_blur`, with what of the core API calls on them need.
//!
//! Values that an application may get wrong can be represented: an enumerant is an open newtype around its integer, flags keep
//! bits that have no name, a handle is a number, a structure's `s_type` may lie. Nothing here checks anything.
//!
//! # Names
//!
//! A type keeps its Vulkan name less `Vk` and the author's tag, and less `AccelerationStructure` or `PhysicalDevice` in front
//! where the short name is clear; a search for the Vulkan name finds it. Fields stand in the order of the API, in snake case
//! without `p`; `type` is `ty`, `sType` is `s_type`, `pNext` is [`next`](Chain). An array carries its own length, so the count
//! beside it is gone. Where the API takes an array or an array of pointers, each is an `Option`, because each can be null.
//!
//! # Example
//!
//! ```
//! use omm_model::vk::{BuildGeometryInfo, Geometry, GeometryMicromapData, GeometryType, MicromapUsage, OpacityMicromapFormat};
//!
//! let micromap = GeometryMicromapData {
//!     usage_counts: Some(vec![MicromapUsage { count: 1, subdivision_level: 2, format: OpacityMicromapFormat::FOUR_STATE }]),
//!     triangle_array_stride: 8,
//!     ..Default::default()
//! };
//! let geometry = Geometry { next: vec![micromap.into()], geometry_type: GeometryType::MICROMAP, ..Default::default() };
//! let build = BuildGeometryInfo { geometries: Some(vec![geometry]), ..Default::default() };
//!
//! let data = build.geometries_iter().next().and_then(Geometry::micromap_data);
//! assert_eq!(data.map(|data| data.usages().count()), Some(1));
//! ```

mod acceleration_structure;
mod address;
mod buffer;
mod build;
mod chain;
mod command_buffer;
mod copy;
mod device;
mod enumerant;
mod format;
mod geometry;
mod handle;
mod index_type;
mod instance;
mod memory;
mod micromap;
mod micromap_ext;
mod motion;
mod object_type;
mod pipeline;
mod query;
mod queue;
mod result;
mod sparse;
mod structure_type;
mod synchronization;

#[cfg(test)]
mod tests;

pub use acceleration_structure::*;
pub use address::*;
pub use buffer::*;
pub use build::*;
pub use chain::{Chain, ChainStructure};
pub use command_buffer::*;
pub use copy::*;
pub use device::*;
pub use format::*;
pub use geometry::*;
pub use handle::*;
pub use index_type::*;
pub use instance::*;
pub use memory::*;
pub use micromap::*;
pub use micromap_ext::*;
pub use motion::*;
pub use object_type::*;
pub use pipeline::*;
pub use query::*;
pub use queue::*;
pub use result::*;
pub use sparse::*;
pub use structure_type::*;
pub use synchronization::*;
