//! The serialized form of acceleration structures and micromaps: what copying one to memory writes.
//!
//! The chapter on acceleration structures defines a header — driver UUID, compatibility UUID, serialized size, deserialized
//! size, a count and that many handles — and `VK_KHR_opacity_micromap` adds blocks of micromap addresses for bottom-level
//! structures. What follows is the driver's own. This crate reads and writes the header in either byte order, keeps a foreign
//! payload as it is, and converts the simulated device's objects to serialized data and back.
//!
//! | room | does |
//! |---|---|
//! | [`blob`] | cuts serialized data into header and payload, in place |
//! | [`stream`] | the same over data that arrives piece by piece |
//! | [`header`] | the header as a value, and writing it |
//! | [`byte_order`] | the two byte orders and telling them apart |
//! | [`departure`] | drivers that depart from the specification |
//! | [`kind`] | what the data may be, and how sure that is |
//! | [`summary`] | the header for people and scripts |
//! | [`serialize_object`], [`deserialize_object`] | our own payload, specified in `docs/device-layout.md` |
//! | [`replace_references`] | relocation of handles and micromap addresses in place |
//! | [`bundle`] | `.omm` files: baked micromaps to keep on disk |
//! | [`trace`] | what an application did: its calls and uploads, as text and as bytes |
//! | [`compatibility`] | whether a device can take the data |
//!
//! Reading never allocates because of a count: it compares counts with the sizes claimed, and both with the bytes at hand. An
//! error names the field and its offset from the start of the data, and tells truncated from malformed data.
//!
//! No field says what the data is ([`KindGuess`]), and for micromaps the documents name only the two UUIDs: ours have the whole
//! header with a count of 0.
//!
//! # Example
//!
//! ```
//! use omm_layout::object::TlasContents;
//! use omm_model::profile::DeviceProfile;
//! use omm_model::vk;
//! use omm_serialize::{Blob, ByteOrder, ObjectKind};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let device = DeviceProfile::reference();
//! let leaf = vk::Instance { acceleration_structure_reference: 0x1000, ..vk::Instance::default() };
//! let object = TlasContents { flags: 0, instances: vec![leaf] }.encode()?;
//!
//! let mut data = omm_serialize::serialize_object(&object, device.driver_uuid, device.compatibility_uuid)?;
//! assert!(omm_serialize::compatibility(&data, &device));
//! let blob = Blob::read(&data, ByteOrder::Little)?;
//! assert_eq!(blob.handles().collect::<Vec<_>>(), [0x1000]);
//! assert_eq!(blob.kind().kind(), Some(ObjectKind::TopLevel));
//!
//! omm_serialize::replace_references(&mut data, ByteOrder::Little, |handle| handle + 0x50)?;
//! let object = omm_serialize::deserialize_object(&data)?;
//! assert_eq!(omm_layout::object::references(&object)?.collect::<Vec<_>>(), [0x1050]);
//!
//! let error = Blob::read(&data[..60], ByteOrder::Little).unwrap_err();
//! assert_eq!(error.to_string(), "handles at byte 56: 8 bytes are needed, 4 are there");
//! # Ok(())
//! # }
//! ```

pub mod blob;
pub mod bundle;
pub mod byte_order;
mod codec;
mod compatibility;
pub mod departure;
mod describe;
pub mod header;
pub mod kind;
mod object;
pub mod relocate;
pub mod stream;
pub mod summary;
pub mod trace;

pub use blob::{Blob, Head};
pub use byte_order::{ByteOrder, DetectedOrder};
pub use compatibility::compatibility;
pub use departure::Departure;
pub use header::{Block, Claims, Header, References};
pub use kind::{Certainty, KindGuess};
pub use object::{deserialize_object, serialize_object, serialized_size};
pub use omm_layout::error::{ReadError, ReadErrorKind};
pub use omm_layout::object::{Field, ObjectKind};
pub use relocate::replace_references;
pub use stream::{StreamError, StreamReader};
pub use summary::Summary;
