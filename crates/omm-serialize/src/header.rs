//! The header as a value, and writing it.

use omm_model::profile::Uuid;
use serde::{Deserialize, Serialize};

use crate::ByteOrder;
use crate::blob::COUNT_AT;

/// `VK_ACCELERATION_STRUCTURE_SERIALIZED_BLOCK_TYPE_OPACITY_MICROMAP_KHR`: the block's addresses are those of micromaps.
pub const BLOCK_TYPE_OPACITY_MICROMAP: u32 = 0;

/// Bytes of the fields that every header has: two UUIDs, two sizes and a count.
pub const FIXED_SIZE: u64 = 56;
/// Bytes of a block without its addresses.
pub const BLOCK_SIZE: u64 = 16;
/// The high half of the count when the low half counts blocks and not handles.
pub(crate) const BLOCK_MARK: u32 = u32::MAX;

/// Everything that stands before the payload.
///
/// The sizes are fields of their own, so that a header can be wrong; [`Header::for_payload`] makes one that is right.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Header {
    /// `VkPhysicalDeviceIDProperties::driverUUID` of the writer.
    pub driver_uuid: Uuid,
    /// What the driver compares to say whether it can read the data.
    pub compatibility_uuid: Uuid,
    /// Bytes of header and payload.
    pub serialized_size: u64,
    /// The size with which an acceleration structure that takes the data must be created.
    pub deserialized_size: u64,
    /// What the data refers to.
    pub references: References,
}

/// The part of the header that the application relocates.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum References {
    /// A plain count with handles, which are device addresses of bottom-level acceleration structures: none in micromaps and in
    /// bottom-level structures without micromaps.
    Handles(Vec<u64>),
    /// A count of blocks, its high half all ones.
    Blocks(Vec<Block>),
}

/// A run of device addresses of one meaning.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Block {
    /// A `VkAccelerationStructureSerializedBlockTypeKHR`, any value: 0 is [`BLOCK_TYPE_OPACITY_MICROMAP`].
    pub block_type: u32,
    /// The 32 bits that align what follows.
    pub reserved: u32,
    /// Device addresses.
    pub addresses: Vec<u64>,
}

/// Counts that [`Header::write_claiming`] writes whatever is there.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Claims {
    /// The 64-bit count of handles or, its high half all ones, of blocks.
    pub count: Option<u64>,
    /// For each block in order, its count of addresses. Blocks without an entry tell the truth.
    pub addresses: Vec<Option<u64>>,
}

impl References {
    /// Bytes that the handles or blocks take behind the count.
    #[must_use]
    pub fn size(&self) -> u64 {
        match self {
            Self::Handles(handles) => 8 * handles.len() as u64,
            Self::Blocks(blocks) => blocks.iter().map(|block| BLOCK_SIZE + 8 * block.addresses.len() as u64).sum(),
        }
    }

    /// The 64-bit field before the handles or blocks.
    ///
    /// More blocks than 2<sup>32</sup> - 1 do not occur, as they would take 64 GiB.
    const fn count_field(&self) -> u64 {
        match self {
            Self::Handles(handles) => handles.len() as u64,
            Self::Blocks(blocks) => (BLOCK_MARK as u64) << 32 | (blocks.len() as u64 & 0xffff_ffff),
        }
    }
}

impl Header {
    /// The header for a payload of so many bytes.
    #[must_use]
    pub fn for_payload(
        driver_uuid: Uuid,
        compatibility_uuid: Uuid,
        deserialized_size: u64,
        references: References,
        payload_size: u64,
    ) -> Self {
        let serialized_size = (FIXED_SIZE + references.size()).saturating_add(payload_size);
        Self { driver_uuid, compatibility_uuid, serialized_size, deserialized_size, references }
    }

    /// Bytes of the header: where the payload begins.
    #[must_use]
    pub fn size(&self) -> u64 {
        FIXED_SIZE + self.references.size()
    }

    /// The header's bytes followed by `payload`. Nothing is checked: a header with wrong sizes is written as it is.
    #[must_use]
    pub fn write(&self, order: ByteOrder, payload: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(self.size() as usize + payload.len());
        self.write_into(order, &mut bytes);
        bytes.extend_from_slice(payload);
        bytes
    }

    /// As [`write`](Self::write), with the counts that `claims` names in the place of the right ones: wrong data on purpose.
    #[must_use]
    pub fn write_claiming(&self, claims: &Claims, order: ByteOrder, payload: &[u8]) -> Vec<u8> {
        let Claims { count, addresses } = claims;
        let mut bytes = self.write(order, payload);
        let mut put = |at: usize, claim: Option<u64>| {
            let place = bytes.get_mut(at..).and_then(<[u8]>::first_chunk_mut::<8>);
            if let (Some(place), Some(claim)) = (place, claim) {
                *place = order.u64_bytes(claim);
            }
        };
        put(COUNT_AT as usize, *count);
        if let References::Blocks(blocks) = &self.references {
            let mut at = FIXED_SIZE;
            for (block, claim) in blocks.iter().zip(addresses) {
                put(at as usize + 8, *claim);
                at += BLOCK_SIZE + 8 * block.addresses.len() as u64;
            }
        }
        bytes
    }

    /// Appends the header's bytes.
    pub(crate) fn write_into(&self, order: ByteOrder, bytes: &mut Vec<u8>) {
        let Self { driver_uuid, compatibility_uuid, serialized_size, deserialized_size, references } = self;
        bytes.extend_from_slice(&driver_uuid.0);
        bytes.extend_from_slice(&compatibility_uuid.0);
        let mut push = |value: u64| bytes.extend_from_slice(&order.u64_bytes(value));
        push(*serialized_size);
        push(*deserialized_size);
        push(references.count_field());
        match references {
            References::Handles(handles) => handles.iter().copied().for_each(push),
            References::Blocks(blocks) => {
                blocks.iter().for_each(|block| block.write_into(order, bytes));
            }
        }
    }
}

impl Block {
    fn write_into(&self, order: ByteOrder, bytes: &mut Vec<u8>) {
        let Self { block_type, reserved, addresses } = self;
        bytes.extend_from_slice(&order.u32_bytes(*block_type));
        bytes.extend_from_slice(&order.u32_bytes(*reserved));
        bytes.extend_from_slice(&order.u64_bytes(addresses.len() as u64));
        addresses.iter().for_each(|address| bytes.extend_from_slice(&order.u64_bytes(*address)));
    }
}
