//! Traces: what an application did, in order, to keep, to send and to run again.
//!
//! A [`Trace`] is the profile of a device and a list of [`Event`]s: API calls with all that they were given, and what the
//! application wrote into memory, which no call tells. It has two forms, and neither loses anything:
//!
//! - text ([`Trace::to_text`], [`Trace::from_text`]) is RON, for people and for version control;
//! - bytes ([`Trace::write`], [`Trace::read`]) are bincode of a fixed configuration, smaller and checked.
//!
//! `docs/trace-format.md` says what the bytes are. Events have checksums of their own, so that an error names the event; a length
//! is compared with the bytes at hand before it is used, and values inside each other are followed to a [`DEPTH_LIMIT`].
//!
//! ```
//! use omm_model::call::Call;
//! use omm_model::profile::DeviceProfile;
//! use omm_model::vk;
//! use omm_serialize::bundle::Checksums;
//! use omm_serialize::trace::{Event, Trace};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let call = Call::DestroyBuffer { device: vk::Device(1), buffer: vk::Buffer(7) };
//! let write = Event::Write { address: vk::DeviceAddress(0x1_0000_0000), bytes: vec![1, 2, 0xff] };
//! let trace = Trace { profile: DeviceProfile::minimum(), events: vec![write, call.into()] };
//!
//! let text = trace.to_text()?;
//! assert!(text.contains(r#"Write(address: DeviceAddress(4294967296), bytes: "0102ff")"#), "{text}");
//! assert!(text.contains("DestroyBuffer(device: Device(1), buffer: Buffer(7))"), "{text}");
//! assert_eq!(Trace::from_text(&text)?, trace);
//! assert_eq!(Trace::read(&trace.write(), Checksums::Verify)?, trace);
//! # Ok(())
//! # }
//! ```

use omm_model::profile::DeviceProfile;
use serde::{Deserialize, Serialize};

use crate::bundle::Checksums;
use crate::codec::{self, Input};
use crate::{ReadError, ReadErrorKind};

mod decode;
mod event;
mod text;

pub use decode::DEPTH_LIMIT;
pub use event::Event;
pub use text::TraceTextError;

/// The first eight bytes of a trace of any version.
pub const MAGIC: [u8; 8] = *b"ommtrace";
/// The version that is written, and the only one that is read: there is none before it.
pub const VERSION: u32 = 1;

/// What an application did.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trace {
    /// The device that it did it on.
    pub profile: DeviceProfile,
    /// What it did, in order.
    pub events: Vec<Event>,
}

impl Trace {
    /// The trace as bytes.
    ///
    /// Values inside each other beyond the [`DEPTH_LIMIT`] are written, and refused by [`read`](Self::read).
    #[must_use]
    pub fn write(&self) -> Vec<u8> {
        let Self { profile, events } = self;
        let mut out = Vec::new();
        codec::push(&mut out, MAGIC);
        codec::push(&mut out, VERSION);
        push_record(&mut out, 0, profile);
        codec::push(&mut out, events.len() as u64);
        for (event, number) in events.iter().zip(1..) {
            push_record(&mut out, number, event);
        }
        out
    }

    /// Reads a trace that takes all of `bytes`.
    ///
    /// # Errors
    /// The first field that is truncated, of another version, contradicts its checksum, has no meaning or nests too deep.
    pub fn read(bytes: &[u8], checksums: Checksums) -> Result<Self, ReadError> {
        let mut input = Input::new(bytes);
        input.start(MAGIC)?;
        let profile = read_record(&mut input, 0, checksums).map_err(|error| error.within("profile"))?;
        // A count is a claim: the bytes decide how many there are.
        let count = input.u64("events")?;
        let mut events = Vec::new();
        for index in 0..count {
            let event = read_record(&mut input, index.saturating_add(1), checksums);
            events.push(event.map_err(|error| error.within(format_args!("events[{index}]")))?);
        }
        input.finish()?;
        Ok(Self { profile, events })
    }
}

/// The checksum of a record: the profile has number 0, events count from 1 on.
fn checksum(number: u64, contents: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&number.to_le_bytes());
    hasher.update(contents);
    hasher.finalize()
}

fn push_record(out: &mut Vec<u8>, number: u64, value: &impl Serialize) {
    let mut contents = Vec::new();
    codec::push_value(&mut contents, value);
    codec::push(out, checksum(number, &contents));
    codec::push(out, contents.as_slice());
}

/// Bytes of a record before its contents.
const RECORD_HEAD: u64 = 12;

fn read_record<'de, T: Deserialize<'de>>(
    input: &mut Input<'de>,
    number: u64,
    checksums: Checksums,
) -> Result<T, ReadError> {
    let at = input.position();
    let claimed = input.u32("checksum")?;
    let contents = input.bytes("contents")?;
    let required = || checksum(number, contents);
    if checksums == Checksums::Verify && claimed != required() {
        let kind = ReadErrorKind::NotEqual { found: claimed.into(), required: required().into() };
        return Err(ReadError { field: "checksum".into(), offset: at, kind });
    }
    decode::value(contents).map_err(|error| error.moved_by(at + RECORD_HEAD))
}
