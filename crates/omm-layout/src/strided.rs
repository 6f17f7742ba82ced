//! Items of one size at equal distances, the form of every array that a build reads.

use crate::error::{ReadError, ReadErrorKind};

/// `count` items of `N` bytes, each `stride` bytes behind the one before, all of them within the bytes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Strided<'a, const N: usize> {
    bytes: &'a [u8],
    stride: u64,
    count: u64,
}

impl<'a, const N: usize> Strided<'a, N> {
    /// Proves that the last item ends within `bytes`. Nothing is asked of the stride: items may overlap, or be one and the same.
    pub(crate) fn new(bytes: &'a [u8], stride: u64, count: u64, field: &'static str) -> Result<Self, ReadError> {
        let end = |last: u64| last.checked_mul(stride)?.checked_add(N as u64);
        // Where the end is no u64 it is behind any slice.
        let required = count.checked_sub(1).map_or(0, |last| end(last).unwrap_or(u64::MAX));
        let available = bytes.len() as u64;
        if required > available {
            return Err(ReadError::new(field, 0, ReadErrorKind::Truncated { available, required }));
        }
        Ok(Self { bytes, stride, count })
    }

    pub(crate) const fn len(&self) -> u64 {
        self.count
    }

    /// Bytes from the start to item `index`.
    pub(crate) const fn offset(&self, index: u64) -> u64 {
        index.saturating_mul(self.stride)
    }

    pub(crate) fn get(&self, index: u64) -> Option<&'a [u8; N]> {
        let start = usize::try_from(self.offset(index)).ok().filter(|_| index < self.count)?;
        self.bytes.get(start..)?.first_chunk()
    }

    /// The items as one slice, if nothing lies between them.
    pub(crate) fn packed(&self) -> Option<&'a [[u8; N]]> {
        let count = usize::try_from(self.count).ok().filter(|_| self.stride == N as u64)?;
        self.bytes.as_chunks().0.get(..count)
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &'a [u8; N]> + Clone + use<'a, N> {
        let array = *self;
        (0..array.count).map_while(move |index| array.get(index))
    }
}
