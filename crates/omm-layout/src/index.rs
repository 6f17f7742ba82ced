//! Geometry index buffers: u16 or u32 indices, tightly packed, or none.

use omm_model::vk;

use crate::error::ReadError;
use crate::strided::Strided;

/// How an index is stored: the checked form of [`vk::IndexType`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum IndexType {
    /// There is no buffer; index *i* is *i*.
    None,
    /// In one byte.
    Uint8,
    /// In two bytes.
    Uint16,
    /// In four bytes.
    Uint32,
}

impl IndexType {
    /// Bytes of an index; 0 if there is no buffer.
    #[must_use]
    pub const fn size(self) -> u32 {
        match self {
            Self::None => 0,
            Self::Uint8 => 1,
            Self::Uint16 => 2,
            Self::Uint32 => 4,
        }
    }

    /// The largest value of the type; `u32::MAX` if there is no buffer.
    #[must_use]
    pub const fn max(self) -> u32 {
        match self {
            Self::Uint8 => u8::MAX as u32,
            Self::Uint16 => u16::MAX as u32,
            Self::Uint32 | Self::None => u32::MAX,
        }
    }
}

impl TryFrom<vk::IndexType> for IndexType {
    type Error = vk::IndexType;
    /// The raw value itself is the error when it has no meaning.
    fn try_from(raw: vk::IndexType) -> Result<Self, Self::Error> {
        match raw {
            vk::IndexType::NONE => Ok(Self::None),
            vk::IndexType::UINT8 => Ok(Self::Uint8),
            vk::IndexType::UINT16 => Ok(Self::Uint16),
            vk::IndexType::UINT32 => Ok(Self::Uint32),
            other => Err(other),
        }
    }
}

impl From<IndexType> for vk::IndexType {
    fn from(index_type: IndexType) -> Self {
        match index_type {
            IndexType::None => Self::NONE,
            IndexType::Uint8 => Self::UINT8,
            IndexType::Uint16 => Self::UINT16,
            IndexType::Uint32 => Self::UINT32,
        }
    }
}

/// Indices of any type at any stride, widened to 32 bits.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Indices<'a> {
    None(u64),
    Uint8(Strided<'a, 1>),
    Uint16(Strided<'a, 2>),
    Uint32(Strided<'a, 4>),
}

impl<'a> Indices<'a> {
    pub(crate) fn new(bytes: &'a [u8], index_type: IndexType, stride: u64, count: u64) -> Result<Self, ReadError> {
        Ok(match index_type {
            IndexType::None => Self::None(count),
            IndexType::Uint8 => Self::Uint8(Strided::new(bytes, stride, count, "indices")?),
            IndexType::Uint16 => Self::Uint16(Strided::new(bytes, stride, count, "indices")?),
            IndexType::Uint32 => Self::Uint32(Strided::new(bytes, stride, count, "indices")?),
        })
    }

    pub(crate) const fn len(&self) -> u64 {
        match self {
            Self::None(count) => *count,
            Self::Uint8(indices) => indices.len(),
            Self::Uint16(indices) => indices.len(),
            Self::Uint32(indices) => indices.len(),
        }
    }

    /// Bytes from the start of the buffer to index `at`.
    pub(crate) const fn offset(&self, at: u64) -> u64 {
        match self {
            Self::None(_) => 0,
            Self::Uint8(indices) => indices.offset(at),
            Self::Uint16(indices) => indices.offset(at),
            Self::Uint32(indices) => indices.offset(at),
        }
    }

    pub(crate) fn get(&self, at: u64) -> Option<u32> {
        match self {
            Self::None(count) => u32::try_from(at).ok().filter(|_| at < *count),
            Self::Uint8(indices) => indices.get(at).map(|[byte]| u32::from(*byte)),
            Self::Uint16(indices) => indices.get(at).map(|bytes| u16::from_le_bytes(*bytes).into()),
            Self::Uint32(indices) => indices.get(at).map(|bytes| u32::from_le_bytes(*bytes)),
        }
    }
}

/// A geometry's vertex indices read in place.
#[derive(Clone, Copy, Debug)]
pub struct IndexBuffer<'a> {
    indices: Indices<'a>,
}

impl<'a> IndexBuffer<'a> {
    /// `count` indices, tightly packed at the start of `bytes`; of the bytes nothing is read if `index_type` is none.
    ///
    /// # Errors
    /// The last index ends behind `bytes`.
    pub fn new(bytes: &'a [u8], index_type: IndexType, count: u64) -> Result<Self, ReadError> {
        Ok(Self { indices: Indices::new(bytes, index_type, index_type.size().into(), count)? })
    }

    /// Number of indices.
    #[must_use]
    pub const fn len(&self) -> u64 {
        self.indices.len()
    }

    /// Whether there are no indices.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Index `at`, if there are so many.
    #[must_use]
    pub fn get(&self, at: u64) -> Option<u32> {
        self.indices.get(at)
    }

    /// The indices in order.
    pub fn iter(&self) -> impl Iterator<Item = u32> + Clone + use<'a> {
        let indices = self.indices;
        (0..indices.len()).map_while(move |at| indices.get(at))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn indices_are_little_endian(values: Vec<u32>) {
            let wide: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            let count = values.len() as u64;
            let buffer = IndexBuffer::new(&wide, IndexType::Uint32, count).unwrap();
            prop_assert_eq!(buffer.iter().collect::<Vec<_>>(), values.clone());
            let narrow: Vec<u8> = values.iter().flat_map(|value| (*value as u16).to_le_bytes()).collect();
            let buffer = IndexBuffer::new(&narrow, IndexType::Uint16, count).unwrap();
            prop_assert!(buffer.iter().eq(values.iter().map(|value| value & 0xffff)));
            prop_assert_eq!(buffer.get(count), None);
            prop_assert!(IndexBuffer::new(&narrow, IndexType::Uint16, count + 1).is_err());
        }
    }

    #[test]
    fn without_a_buffer_indices_count_up() {
        let buffer = IndexBuffer::new(&[], IndexType::None, 4).unwrap();
        assert_eq!(buffer.iter().collect::<Vec<_>>(), [0, 1, 2, 3]);
        assert!(IndexBuffer::new(&[], IndexType::None, 0).unwrap().is_empty());
    }

    #[test]
    fn raw_and_checked_agree() {
        for index_type in [IndexType::None, IndexType::Uint8, IndexType::Uint16, IndexType::Uint32] {
            let raw = vk::IndexType::from(index_type);
            assert_eq!(IndexType::try_from(raw), Ok(index_type));
            assert_eq!(raw.size(), Some(index_type.size()));
        }
        assert_eq!(IndexType::try_from(vk::IndexType(-1)), Err(vk::IndexType(-1)));
    }
}
