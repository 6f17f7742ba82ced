//! What a header says, for people and scripts.

use serde::Serialize;

use crate::{Blob, ByteOrder, KindGuess};

/// The header of serialized data, ready to be printed or written as JSON.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Summary {
    /// Lowercase hexadecimal digits.
    pub driver_uuid: String,
    /// Lowercase hexadecimal digits.
    pub compatibility_uuid: String,
    /// The order in which the numbers of the header were read.
    pub byte_order: ByteOrder,
    /// Bytes of header and payload.
    pub serialized_size: u64,
    /// Bytes of the acceleration structure that takes the data.
    pub deserialized_size: u64,
    /// Number of handles; 0 if there are blocks.
    pub handle_count: u64,
    /// The handles, hexadecimal with `0x` and 16 digits.
    pub handles: Vec<String>,
    /// The blocks.
    pub blocks: Vec<BlockSummary>,
    /// Bytes of the header: where the payload begins.
    pub header_size: u64,
    /// What the data is, as far as it shows.
    pub kind: KindGuess,
}

/// One block of the header.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BlockSummary {
    /// The type's number.
    #[serde(rename = "type")]
    pub block_type: u32,
    /// The reserved number.
    pub reserved: u32,
    /// The addresses, hexadecimal with `0x` and 16 digits.
    pub addresses: Vec<String>,
}

impl Blob<'_> {
    /// What the header says.
    #[must_use]
    pub fn summary(&self) -> Summary {
        let address = |address: u64| format!("{address:#018x}");
        let prefix = self.prefix();
        let block = |block: crate::blob::BlockView<'_>| BlockSummary {
            block_type: block.block_type,
            reserved: block.reserved,
            addresses: block.addresses().map(address).collect(),
        };
        Summary {
            driver_uuid: prefix.driver_uuid.to_string(),
            compatibility_uuid: prefix.compatibility_uuid.to_string(),
            byte_order: self.order(),
            serialized_size: prefix.serialized_size,
            deserialized_size: prefix.deserialized_size,
            handle_count: self.handles().len() as u64,
            handles: self.handles().map(address).collect(),
            blocks: self.blocks().map(block).collect(),
            header_size: self.header_size(),
            kind: self.kind(),
        }
    }
}
