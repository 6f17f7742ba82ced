//! What an application does.

use omm_model::call::Call;
use omm_model::vk;
use serde::{Deserialize, Serialize};

/// One thing that an application did.
///
/// Data comes to a device through memory that the host has mapped, which is no API call; and host commands read memory that the
/// application has for itself. Both are events of their own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Event {
    /// An API call.
    Call(Box<Call>),
    /// Bytes written through the host's mapping of a buffer's memory.
    Write {
        /// The device address of the first byte.
        address: vk::DeviceAddress,
        /// What was written.
        #[serde(with = "hexadecimal")]
        bytes: Vec<u8>,
    },
    /// Memory of the application's own, full of zeros.
    AllocateHost {
        /// Where it lies.
        address: vk::HostAddress,
        /// Bytes.
        size: u64,
    },
    /// Bytes written into memory of the application's own.
    WriteHost {
        /// The address of the first byte.
        address: vk::HostAddress,
        /// What was written.
        #[serde(with = "hexadecimal")]
        bytes: Vec<u8>,
    },
}

impl From<Call> for Event {
    fn from(call: Call) -> Self {
        Self::Call(Box::new(call))
    }
}

/// Bytes: in text pairs of hexadecimal digits, otherwise a list of bytes.
mod hexadecimal {
    use std::fmt;

    use serde::de::{Error, Visitor};
    use serde::{Deserializer, Serializer};

    pub(super) fn serialize<S: Serializer>(bytes: &[u8], serializer: S) -> Result<S::Ok, S::Error> {
        if !serializer.is_human_readable() {
            return serializer.serialize_bytes(bytes);
        }
        let digit = |value: u8| char::from_digit(value.into(), 16).unwrap_or_default();
        let text: String = bytes.iter().flat_map(|byte| [digit(byte >> 4), digit(byte & 15)]).collect();
        serializer.serialize_str(&text)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<u8>, D::Error> {
        if deserializer.is_human_readable() {
            deserializer.deserialize_str(Bytes)
        } else {
            deserializer.deserialize_byte_buf(Bytes)
        }
    }

    struct Bytes;

    impl Visitor<'_> for Bytes {
        type Value = Vec<u8>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("pairs of hexadecimal digits")
        }

        fn visit_str<E: Error>(self, text: &str) -> Result<Vec<u8>, E> {
            let digits = text.chars().filter(|letter| !letter.is_whitespace()).map(|letter| letter.to_digit(16));
            let digits: Vec<u32> = digits.collect::<Option<_>>().ok_or_else(|| E::custom("no hexadecimal digit"))?;
            match digits.as_chunks() {
                (pairs, []) => Ok(pairs.iter().map(|[high, low]| (high << 4 | low) as u8).collect()),
                _ => Err(E::custom("a hexadecimal digit without another")),
            }
        }

        fn visit_bytes<E: Error>(self, bytes: &[u8]) -> Result<Vec<u8>, E> {
            Ok(bytes.to_vec())
        }
    }
}
