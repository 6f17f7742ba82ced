//! Host memory: what the application allocates for itself and gives to host commands.

use std::collections::BTreeMap;

use omm_model::memory::MemoryError;

use super::{Origin, Place, zeros};
use crate::buffer::ADDRESS_ALIGNMENT;

/// The address of the first piece. It is far from every device address, so that the two are told apart at sight.
const FIRST_ADDRESS: u64 = 0x7f00_0000_0000;

/// The pieces of host memory by address. They lie as far apart as buffers do.
#[derive(Debug, Default)]
pub(crate) struct HostMemory {
    pieces: BTreeMap<u64, Vec<u8>>,
    /// Where the next piece goes, counted from [`FIRST_ADDRESS`].
    next: u64,
}

impl HostMemory {
    /// A new piece of `size` zeros, or `None` where all pieces together would have more than `limit` bytes.
    pub(crate) fn allocate(&mut self, size: u64, limit: u64) -> Option<u64> {
        let used: u64 = self.pieces.values().map(|piece| piece.len() as u64).sum();
        let address = FIRST_ADDRESS.checked_add(self.next)?;
        let end = self.next.checked_add(size)?.checked_add(ADDRESS_ALIGNMENT)?;
        let next = end.checked_next_multiple_of(ADDRESS_ALIGNMENT)?;
        let bytes = Some(size).filter(|&size| size <= limit.saturating_sub(used)).and_then(zeros)?;
        self.pieces.insert(address, bytes);
        self.next = next;
        Some(address)
    }

    /// Frees the piece that begins at that address, if there is one.
    pub(crate) fn free(&mut self, address: u64) -> bool {
        self.pieces.remove(&address).is_some()
    }

    pub(super) fn place(&self, address: u64, size: u64) -> Result<Place, MemoryError> {
        let unknown = MemoryError { address, size, available: 0 };
        let (&base, piece) = self.pieces.range(..=address).next_back().ok_or(unknown)?;
        let start = usize::try_from(address - base).map_err(|_| unknown)?;
        let available = piece.len().checked_sub(start).ok_or(unknown)?;
        let outside = MemoryError { available: available as u64, ..unknown };
        let length = usize::try_from(size).ok().filter(|&length| length <= available).ok_or(outside)?;
        Ok(Place { origin: Origin::Host(base), bytes: start..start + length })
    }

    pub(super) fn bytes(&self, base: u64) -> Option<&[u8]> {
        self.pieces.get(&base).map(Vec::as_slice)
    }

    pub(super) fn bytes_mut(&mut self, base: u64) -> Option<&mut [u8]> {
        self.pieces.get_mut(&base).map(Vec::as_mut_slice)
    }
}
