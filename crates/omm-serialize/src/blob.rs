//! Reading serialized data in place.

use omm_model::profile::{UUID_SIZE, Uuid};

use crate::byte_order::{self, ByteOrder, DetectedOrder};
use crate::header::{BLOCK_MARK, BLOCK_SIZE, BLOCK_TYPE_OPACITY_MICROMAP, Block, FIXED_SIZE, Header, References};
use crate::{ReadError, ReadErrorKind};

/// Offset of the count of handles or blocks.
pub(crate) const COUNT_AT: u64 = 48;

/// The fields that every header has, read from the first 56 bytes: enough to learn how long the data is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Prefix {
    /// The driver that wrote the data.
    pub driver_uuid: Uuid,
    /// What the driver compares to say whether it can read the data.
    pub compatibility_uuid: Uuid,
    /// Bytes of header and payload, at least 56.
    pub serialized_size: u64,
    /// The size with which an acceleration structure that takes the data must be created.
    pub deserialized_size: u64,
    /// How many handles or blocks follow.
    pub count: Count,
}

/// The meaning of the 64-bit count in the header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Count {
    /// So many handles follow.
    Handles(u64),
    /// The high half is all ones: so many blocks follow.
    Blocks(u32),
}

impl Prefix {
    /// Reads the fixed fields at the start of `bytes`.
    ///
    /// # Errors
    /// Fewer than 56 bytes, or a serialized size below that.
    pub fn read(bytes: &[u8], order: ByteOrder) -> Result<Self, ReadError> {
        let mut input = Input { bytes, order, position: 0 };
        let prefix = Self {
            driver_uuid: Uuid(*input.array::<UUID_SIZE>("driver_uuid")?),
            compatibility_uuid: Uuid(*input.array::<UUID_SIZE>("compatibility_uuid")?),
            serialized_size: input.u64("serialized_size")?,
            deserialized_size: input.u64("deserialized_size")?,
            count: match input.u64("handle_count")? {
                count if (count >> 32) as u32 == BLOCK_MARK => Count::Blocks(count as u32),
                count => Count::Handles(count),
            },
        };
        let found = prefix.serialized_size;
        if found < FIXED_SIZE {
            return Err(error("serialized_size", 32, ReadErrorKind::Below { found, least: FIXED_SIZE }));
        }
        Ok(prefix)
    }
}

/// The header of serialized data, read in place: every handle and block that it counts is there.
#[derive(Clone, Copy, Debug)]
pub struct Head<'a> {
    order: ByteOrder,
    prefix: Prefix,
    /// Handles, or blocks one after the other.
    references: &'a [u8],
}

/// Serialized data, cut into header and payload.
///
/// What the header claims was compared with the bytes: handles and blocks are all there, and header and payload fill the data
/// from the first byte to the last. Nothing is known about the payload.
#[derive(Clone, Copy, Debug)]
pub struct Blob<'a> {
    head: Head<'a>,
    payload: &'a [u8],
}

/// A block of a [`Blob`].
#[derive(Clone, Copy, Debug)]
pub struct BlockView<'a> {
    order: ByteOrder,
    /// Any value; 0 is [`BLOCK_TYPE_OPACITY_MICROMAP`].
    pub block_type: u32,
    /// The 32 bits that align what follows.
    pub reserved: u32,
    addresses: &'a [[u8; 8]],
}

impl<'a> BlockView<'a> {
    /// The device addresses.
    pub fn addresses(&self) -> impl ExactSizeIterator<Item = u64> + Clone + use<'a> {
        let order = self.order;
        self.addresses.iter().map(move |address| order.u64(address))
    }
}

impl<'a> Blob<'a> {
    /// Cuts `bytes`, which must be the serialized data and nothing more.
    ///
    /// # Errors
    /// The first field that is truncated, or whose claim contradicts the serialized size or the length of `bytes`.
    pub fn read(bytes: &'a [u8], order: ByteOrder) -> Result<Self, ReadError> {
        let mut position = 0;
        let mut step = Step::Prefix;
        let prefix = loop {
            match step.next(bytes, order, &mut position)? {
                Step::Payload(prefix) => break prefix,
                next => step = next,
            }
        };
        check_length(&prefix, position as u64, bytes.len() as u64)?;
        let (references, payload) = bytes.split_at_checked(position).unwrap_or_default();
        let references = references.get(FIXED_SIZE as usize..).unwrap_or_default();
        Ok(Self { head: Head { order, prefix, references }, payload })
    }

    /// Cuts `bytes` in the byte order that its size fields speak for, and says how sure that is.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn read_detected(bytes: &'a [u8]) -> Result<(Self, DetectedOrder), ReadError> {
        let detected = byte_order::detect(bytes)?;
        Ok((Self::read(bytes, detected.order())?, detected))
    }

    /// The header.
    #[must_use]
    pub const fn head(&self) -> Head<'a> {
        self.head
    }

    /// The byte order in which the header was read.
    #[must_use]
    pub const fn order(&self) -> ByteOrder {
        self.head.order
    }

    /// The fields that every header has.
    #[must_use]
    pub const fn prefix(&self) -> &Prefix {
        &self.head.prefix
    }

    /// The handles; none if there are blocks.
    pub fn handles(&self) -> impl ExactSizeIterator<Item = u64> + Clone + use<'a> {
        self.head.handles()
    }

    /// The blocks, of any type; none if there are handles.
    pub fn blocks(&self) -> impl Iterator<Item = BlockView<'a>> + Clone + use<'a> {
        self.head.blocks()
    }

    /// The addresses of micromaps in all blocks of that type.
    pub fn micromaps(&self) -> impl Iterator<Item = u64> + Clone + use<'a> {
        self.head.micromaps()
    }

    /// Bytes of the header: where the payload begins.
    #[must_use]
    pub const fn header_size(&self) -> u64 {
        self.head.size()
    }

    /// The header as a value, which [`Header::write`] turns into the bytes read.
    #[must_use]
    pub fn header(&self) -> Header {
        self.head.to_header()
    }

    /// What follows the header.
    #[must_use]
    pub const fn payload(&self) -> &'a [u8] {
        self.payload
    }
}

impl<'a> Head<'a> {
    pub(crate) const fn new(order: ByteOrder, prefix: Prefix, references: &'a [u8]) -> Self {
        Self { order, prefix, references }
    }

    /// The byte order in which the header was read.
    #[must_use]
    pub const fn order(&self) -> ByteOrder {
        self.order
    }

    /// The fields that every header has.
    #[must_use]
    pub const fn prefix(&self) -> &Prefix {
        &self.prefix
    }

    /// The handles; none if there are blocks.
    pub fn handles(&self) -> impl ExactSizeIterator<Item = u64> + Clone + use<'a> {
        let order = self.order;
        let handles = match self.prefix.count {
            Count::Handles(_) => self.references.as_chunks::<8>().0,
            Count::Blocks(_) => &[],
        };
        handles.iter().map(move |handle| order.u64(handle))
    }

    /// The blocks, of any type; none if there are handles.
    pub fn blocks(&self) -> impl Iterator<Item = BlockView<'a>> + Clone + use<'a> {
        let blocks = matches!(self.prefix.count, Count::Blocks(_));
        let mut input = Input { bytes: if blocks { self.references } else { &[] }, order: self.order, position: 0 };
        // That every block is whole was proved, so the sequence ends with the bytes.
        std::iter::from_fn(move || input.block(u64::MAX).ok())
    }

    /// The addresses of micromaps in all blocks of that type.
    pub fn micromaps(&self) -> impl Iterator<Item = u64> + Clone + use<'a> {
        let micromap = |block: &BlockView<'_>| block.block_type == BLOCK_TYPE_OPACITY_MICROMAP;
        self.blocks().filter(micromap).flat_map(|block| block.addresses())
    }

    /// Bytes of the header: where the payload begins.
    #[must_use]
    pub const fn size(&self) -> u64 {
        FIXED_SIZE + self.references.len() as u64
    }

    /// The header as a value, which [`Header::write`] turns into the bytes read.
    #[must_use]
    pub fn to_header(&self) -> Header {
        let Prefix { driver_uuid, compatibility_uuid, serialized_size, deserialized_size, count } = self.prefix;
        let references = match count {
            Count::Handles(_) => References::Handles(self.handles().collect()),
            Count::Blocks(count) => {
                // So many blocks were found, of 16 bytes at least.
                let mut blocks = Vec::with_capacity(count as usize);
                blocks.extend(self.blocks().map(|block| Block {
                    block_type: block.block_type,
                    reserved: block.reserved,
                    addresses: block.addresses().collect(),
                }));
                References::Blocks(blocks)
            }
        };
        Header { driver_uuid, compatibility_uuid, serialized_size, deserialized_size, references }
    }
}

/// What of a header is read next.
///
/// The whole-slice reader and the one over a stream take the same steps, so that they cannot disagree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// The fixed fields.
    Prefix,
    /// All handles.
    Handles(Prefix),
    /// The block of that index.
    Block(Prefix, u32),
    /// Nothing: the payload follows.
    Payload(Prefix),
}

impl Step {
    /// Takes this step at `position`, which it moves if the bytes are there and right, and says what comes next.
    pub(crate) fn next(self, bytes: &[u8], order: ByteOrder, position: &mut usize) -> Result<Self, ReadError> {
        let mut input = Input { bytes, order, position: *position };
        let next = match self {
            Self::Prefix => {
                let prefix = Prefix::read(bytes, order)?;
                input.position = FIXED_SIZE as usize;
                let size = prefix.serialized_size;
                match prefix.count {
                    Count::Handles(count) => {
                        claim(count, 8, FIXED_SIZE, size).map_err(|kind| error("handle_count", COUNT_AT, kind))?;
                        Self::Handles(prefix)
                    }
                    Count::Blocks(count) => {
                        claim(count.into(), BLOCK_SIZE, FIXED_SIZE, size)
                            .map_err(|kind| error("block_count", COUNT_AT, kind))?;
                        if count == 0 { Self::Payload(prefix) } else { Self::Block(prefix, 0) }
                    }
                }
            }
            Self::Handles(prefix) => {
                if let Count::Handles(count) = prefix.count {
                    input.items::<8>(count, "handles")?;
                }
                Self::Payload(prefix)
            }
            Self::Block(prefix, index) => {
                let block = input.block(prefix.serialized_size);
                block.map_err(|error| error.within(format_args!("blocks[{index}]")))?;
                match prefix.count {
                    Count::Blocks(count) if index + 1 < count => Self::Block(prefix, index + 1),
                    _ => Self::Payload(prefix),
                }
            }
            Self::Payload(_) => self,
        };
        *position = input.position;
        Ok(next)
    }
}

/// Requires data of `length` bytes, whose header was found to be of `start` bytes, to be as long as it claims.
pub(crate) fn check_length(prefix: &Prefix, start: u64, length: u64) -> Result<(), ReadError> {
    let size = prefix.serialized_size;
    // A serialized size that the header fits into was proved with its counts.
    let (required, available) = (size.saturating_sub(start), length.saturating_sub(start));
    match available.cmp(&required) {
        std::cmp::Ordering::Less => Err(error("payload", start, ReadErrorKind::Truncated { available, required })),
        std::cmp::Ordering::Equal => Ok(()),
        std::cmp::Ordering::Greater => {
            Err(error("serialized_size", 32, ReadErrorKind::NotEqual { found: size, required: length }))
        }
    }
}

/// Requires `count` items of `item` bytes from `start` on to end within `size`.
fn claim(count: u64, item: u64, start: u64, size: u64) -> Result<(), ReadErrorKind> {
    let limit = size.saturating_sub(start) / item;
    if count <= limit { Ok(()) } else { Err(ReadErrorKind::Above { found: count, limit }) }
}

/// Type and number of addresses of the block that begins at `at`, if it is whole.
pub(crate) fn block_at(bytes: &[u8], order: ByteOrder, at: usize) -> Option<(u32, usize)> {
    let block = Input { bytes, order, position: at }.block(u64::MAX).ok()?;
    Some((block.block_type, block.addresses.len()))
}

fn error(field: &'static str, offset: u64, kind: ReadErrorKind) -> ReadError {
    ReadError { field: field.into(), offset, kind }
}

/// A position in the header that only moves forwards.
#[derive(Clone, Copy, Debug)]
struct Input<'a> {
    bytes: &'a [u8],
    order: ByteOrder,
    position: usize,
}

impl<'a> Input<'a> {
    fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.position..).unwrap_or_default()
    }

    /// The next `count` items of `N` bytes.
    fn items<const N: usize>(&mut self, count: u64, field: &'static str) -> Result<&'a [[u8; N]], ReadError> {
        let rest = self.rest();
        let required = count.saturating_mul(N as u64);
        let items = usize::try_from(required).ok().and_then(|size| rest.get(..size)).ok_or_else(|| {
            let kind = ReadErrorKind::Truncated { available: rest.len() as u64, required };
            error(field, self.position as u64, kind)
        })?;
        self.position += items.len();
        Ok(items.as_chunks().0)
    }

    fn array<const N: usize>(&mut self, field: &'static str) -> Result<&'a [u8; N], ReadError> {
        let at = self.position as u64;
        let missing = ReadErrorKind::Truncated { available: 0, required: N as u64 };
        self.items(1, field)?.first().ok_or_else(|| error(field, at, missing))
    }

    fn u32(&mut self, field: &'static str) -> Result<u32, ReadError> {
        self.array(field).map(|bytes| self.order.u32(bytes))
    }

    fn u64(&mut self, field: &'static str) -> Result<u64, ReadError> {
        self.array(field).map(|bytes| self.order.u64(bytes))
    }

    /// The next block, whose addresses must end within the first `size` bytes.
    fn block(&mut self, size: u64) -> Result<BlockView<'a>, ReadError> {
        let block_type = self.u32("type")?;
        let reserved = self.u32("reserved")?;
        let at = self.position as u64;
        let count = self.u64("count")?;
        claim(count, 8, self.position as u64, size).map_err(|kind| error("count", at, kind))?;
        Ok(BlockView { order: self.order, block_type, reserved, addresses: self.items(count, "addresses")? })
    }
}
