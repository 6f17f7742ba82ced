//! The normative model of Vulkan opacity micromaps.
//!
//! An opacity micromap splits a triangle into 4<sup>N</sup> *microtriangles* along a space-filling "bird curve" and stores one
//! or two bits for each, so that ray traversal can decide without calling a shader. This crate holds what
//! [`VK_KHR_opacity_micromap`] and its relatives define, free of I/O, devices and allocation in its hot paths:
//!
//! | room | holds |
//! |---|---|
//! | [`vk`] | the raw vocabulary of the API: enumerants, flags and structures that may carry any value an application writes |
//! | [`call`] | one variant per API command: what scenarios write, the validator checks and the device executes |
//! | [`level`], [`curve`] | subdivision levels and the bird curve: barycentrics to index and back |
//! | [`format`](mod@format), [`opacity`], [`special_index`] | decoding an element and the whole decision for a triangle candidate |
//! | [`triangle`], [`usage`] | the checked form of `VkMicromapTriangleKHR` and of usage counts |
//! | [`profile`] | limits, features, identities, queues and memory types of a device |
//! | [`memory`] | the one interface through which anybody reads memory at an address |
//! | `ash` | with the feature of that name: structures of the [ash](https://docs.rs/ash) crate, converted |
//!
//! Types under [`vk`] are *raw*: an unknown enumerant or a dangling handle is representable there. Types elsewhere are *checked*:
//! they are reached by `TryFrom` and cannot be wrong, so what takes them cannot be handed nonsense.
//!
//! # Example
//!
//! Which element does a hit read, and what becomes of the candidate?
//!
//! ```
//! use omm_model::curve;
//! use omm_model::format::OpacityMicromapFormat;
//! use omm_model::level::SubdivisionLevel;
//! use omm_model::opacity::{CandidateOpacity, OpacityResult, OpacityState};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let level = SubdivisionLevel::new(2)?;
//! let index = curve::index(0.1, 0.85, level);
//! assert_eq!(index, 15);
//!
//! // Sixteen elements of two bits, least significant bits first: 0b10 in element 15 is "unknown transparent".
//! let data = [0, 0, 0, 0b1000_0000];
//! let state = OpacityMicromapFormat::FourState.state(&data, index.into()).ok_or("beyond the data")?;
//! assert_eq!(state, OpacityState::UnknownTransparent);
//!
//! let mut candidate = CandidateOpacity { micromap: Some(state), ..CandidateOpacity::default() };
//! assert_eq!(candidate.resolve(), OpacityResult::NonOpaque);
//! candidate.ray.force_two_state = true;
//! assert_eq!(candidate.resolve(), OpacityResult::Ignored);
//! # Ok(())
//! # }
//! ```
//!
//! [`VK_KHR_opacity_micromap`]: https://docs.vulkan.org/refpages/latest/refpages/source/VK_KHR_opacity_micromap.html

#[cfg(feature = "ash")]
pub mod ash;
pub mod call;
pub mod curve;
pub mod format;
pub mod level;
pub mod memory;
pub mod opacity;
pub mod profile;
pub mod special_index;
pub mod triangle;
pub mod usage;
pub mod vk;
