//! The two byte orders, and telling which one data is in.
//!
//! Serialized data is in the order of the host that wrote it, and no field names that order. The size fields give it away: the
//! first of them is the length of the data.

use byteorder::{BigEndian, ByteOrder as _, LittleEndian};
use serde::{Deserialize, Serialize};

use crate::{ReadError, ReadErrorKind};

/// The order of the bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ByteOrder {
    /// Least significant byte first.
    Little,
    /// Most significant byte first.
    Big,
}

/// What [`detect`] found out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DetectedOrder {
    /// In this order, and not in the other, the serialized size is the length of the data.
    Certain(ByteOrder),
    /// In neither order the serialized size is the length of the data, which may be truncated; in this order the larger of the
    /// two sizes is smaller than in the other.
    Likely(ByteOrder),
    /// Both orders give the same.
    Ambiguous,
}

impl DetectedOrder {
    /// The order found; little-endian if that is ambiguous.
    #[must_use]
    pub const fn order(self) -> ByteOrder {
        match self {
            Self::Certain(order) | Self::Likely(order) => order,
            Self::Ambiguous => ByteOrder::Little,
        }
    }
}

impl ByteOrder {
    /// The other order.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Little => Self::Big,
            Self::Big => Self::Little,
        }
    }

    pub(crate) fn u32(self, bytes: &[u8; 4]) -> u32 {
        match self {
            Self::Little => LittleEndian::read_u32(bytes),
            Self::Big => BigEndian::read_u32(bytes),
        }
    }

    pub(crate) fn u64(self, bytes: &[u8; 8]) -> u64 {
        match self {
            Self::Little => LittleEndian::read_u64(bytes),
            Self::Big => BigEndian::read_u64(bytes),
        }
    }

    pub(crate) const fn u32_bytes(self, value: u32) -> [u8; 4] {
        match self {
            Self::Little => value.to_le_bytes(),
            Self::Big => value.to_be_bytes(),
        }
    }

    pub(crate) const fn u64_bytes(self, value: u64) -> [u8; 8] {
        match self {
            Self::Little => value.to_le_bytes(),
            Self::Big => value.to_be_bytes(),
        }
    }
}

impl std::fmt::Display for ByteOrder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Little => "little-endian",
            Self::Big => "big-endian",
        })
    }
}

/// Tells the byte order of serialized data from its two size fields.
///
/// # Errors
/// The data ends before the end of the size fields.
pub fn detect(bytes: &[u8]) -> Result<DetectedOrder, ReadError> {
    detect_with_length(bytes, bytes.len() as u64)
}

/// Tells the byte order of serialized data of `length` bytes from its first 48 bytes or more.
///
/// # Errors
/// `bytes` ends before the end of the size fields.
pub fn detect_with_length(bytes: &[u8], length: u64) -> Result<DetectedOrder, ReadError> {
    let size = |field: &'static str, offset: usize| {
        let field_bytes = bytes.get(offset..).and_then(<[u8]>::first_chunk::<8>);
        field_bytes.ok_or_else(|| {
            let available = bytes.len().saturating_sub(offset) as u64;
            let kind = ReadErrorKind::Truncated { available, required: 8 };
            ReadError { field: field.into(), offset: offset as u64, kind }
        })
    };
    let (serialized, deserialized) = (size("serialized_size", 32)?, size("deserialized_size", 40)?);
    let fits = |order: ByteOrder| order.u64(serialized) == length;
    let larger = |order: ByteOrder| order.u64(serialized).max(order.u64(deserialized));
    let (little, big) = (ByteOrder::Little, ByteOrder::Big);
    Ok(match (fits(little), fits(big)) {
        (true, false) => DetectedOrder::Certain(little),
        (false, true) => DetectedOrder::Certain(big),
        (true, true) => DetectedOrder::Ambiguous,
        (false, false) => match larger(little).cmp(&larger(big)) {
            std::cmp::Ordering::Less => DetectedOrder::Likely(little),
            std::cmp::Ordering::Greater => DetectedOrder::Likely(big),
            std::cmp::Ordering::Equal => DetectedOrder::Ambiguous,
        },
    })
}
