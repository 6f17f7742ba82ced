//! Model values as exact bytes, and back.
//!
//! | room | bytes |
//! |---|---|
//! | [`packed`] | elements of 1 or 2 bits, least significant first |
//! | [`triangle`], [`usage`] | micromap triangle arrays with a stride; usage counts |
//! | [`index_buffer`] | micromap indices in 8, 16 or 32 bits, special indices, base triangle |
//! | [`index`], [`vertex`], [`aabb`] | geometry: vertex indices, vertices of each format, boxes |
//! | [`instance`], [`motion_instance`], [`transform`], [`build_range`] | the structures that builds read from memory |
//! | [`object`] | the packed form in which the simulated device keeps what it built |
//!
//! Bytes come from outside, so every read is bounded by the bytes at hand: a view proves what it needs when it is made, and an
//! [`error::ReadError`] names the field, its offset, the value found and what was required. Everything is little-endian. What is
//! written reads back the same, and the other way round.
//!
//! # Example
//!
//! ```
//! use omm_layout::object::{MicromapContents, MicromapObject, MicromapTriangleData};
//! use omm_layout::packed;
//! use omm_model::format::OpacityMicromapFormat::FourState;
//! use omm_model::level::SubdivisionLevel;
//! use omm_model::opacity::OpacityState;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let level = SubdivisionLevel::new(1)?;
//! let data = packed::pack(FourState, &packed::states("TOUu")?)?;
//! assert_eq!(data, [0b10_11_01_00]);
//!
//! let triangle = MicromapTriangleData { subdivision_level: level, format: FourState, data: &data };
//! let built = MicromapContents { flags: 0, triangles: vec![triangle] }.encode()?;
//! let micromap = MicromapObject::read(&built)?;
//! assert_eq!(micromap.state(0, 2), Some(OpacityState::UnknownOpaque));
//!
//! let error = MicromapObject::read(&built[..70]).unwrap_err();
//! assert_eq!(error.to_string(), "object at byte 0: 88 bytes are needed, 70 are there");
//! assert!(error.is_truncated());
//! # Ok(())
//! # }
//! ```

pub mod aabb;
pub mod build_range;
mod bytes;
pub mod error;
pub mod index;
pub mod index_buffer;
pub mod instance;
pub mod motion_instance;
pub mod object;
pub mod packed;
mod strided;
pub mod transform;
pub mod triangle;
pub mod usage;
pub mod vertex;
