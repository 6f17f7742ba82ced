//! What a header says, for people and scripts.

use std::fmt::{self, Display};

use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};

use crate::Blob;
use crate::blob::BlockView;

/// The header of serialized data, to be written as JSON. Addresses are written one by one: however many there are, it takes no memory.
///
/// | field | holds |
/// |---|---|
/// | `driver_uuid`, `compatibility_uuid` | lowercase hexadecimal digits |
/// | `byte_order` | `little` or `big`: how the numbers were read |
/// | `serialized_size` | bytes of header and payload |
/// | `deserialized_size` | bytes of the acceleration structure that takes the data |
/// | `handle_count`, `handles` | the handles, hexadecimal with `0x` and 16 digits; none if there are blocks |
/// | `blocks` | for each its `type`, `reserved` and `addresses` |
/// | `header_size` | bytes of the header: where the payload begins |
/// | `kind` | what the data is, as far as it shows: a [`KindGuess`](crate::KindGuess) |
#[derive(Clone, Copy, Debug)]
pub struct Summary<'a>(Blob<'a>);

/// A device address as people write it: `0x` and 16 digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Address(pub u64);

impl Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#018x}", self.0)
    }
}

impl Serialize for Address {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// A sequence that is written item by item.
struct Sequence<I>(I);

impl<I: Iterator<Item: Serialize> + Clone> Serialize for Sequence<I> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.clone())
    }
}

struct Block<'a>(BlockView<'a>);

impl Serialize for Block<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(block) = self;
        let mut fields = serializer.serialize_struct("Block", 3)?;
        fields.serialize_field("type", &block.block_type)?;
        fields.serialize_field("reserved", &block.reserved)?;
        fields.serialize_field("addresses", &Sequence(block.addresses().map(Address)))?;
        fields.end()
    }
}

impl Serialize for Summary<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(blob) = self;
        let prefix = blob.prefix();
        let mut fields = serializer.serialize_struct("Summary", 10)?;
        fields.serialize_field("driver_uuid", &prefix.driver_uuid.to_string())?;
        fields.serialize_field("compatibility_uuid", &prefix.compatibility_uuid.to_string())?;
        fields.serialize_field("byte_order", &blob.order())?;
        fields.serialize_field("serialized_size", &prefix.serialized_size)?;
        fields.serialize_field("deserialized_size", &prefix.deserialized_size)?;
        fields.serialize_field("handle_count", &blob.handles().len())?;
        fields.serialize_field("handles", &Sequence(blob.handles().map(Address)))?;
        fields.serialize_field("blocks", &Sequence(blob.blocks().map(Block)))?;
        fields.serialize_field("header_size", &blob.header_size())?;
        fields.serialize_field("kind", &blob.kind())?;
        fields.end()
    }
}

impl<'a> Blob<'a> {
    /// What the header says.
    #[must_use]
    pub const fn summary(&self) -> Summary<'a> {
        Summary(*self)
    }
}
