//! Replacing what serialized data refers to, as the application must before it deserializes.

use crate::blob::{Blob, Count, block_at};
use crate::header::{BLOCK_SIZE, BLOCK_TYPE_OPACITY_MICROMAP, FIXED_SIZE};
use crate::{ByteOrder, ReadError};

/// Puts `replace(address)` in the place of every handle, and of every address in blocks of micromaps, null ones included, and says
/// how many there are. Blocks of other types and the payload stay as they are. It takes no memory.
///
/// # Errors
/// As [`Blob::read`]; then nothing was changed.
pub fn replace_references(
    bytes: &mut [u8],
    order: ByteOrder,
    mut replace: impl FnMut(u64) -> u64,
) -> Result<usize, ReadError> {
    let blob = Blob::read(bytes, order)?;
    let mut at = FIXED_SIZE as usize;
    match blob.prefix().count {
        Count::Handles(_) => {
            let count = blob.handles().len();
            Ok(replace_run(bytes, at, count, order, &mut replace))
        }
        Count::Blocks(blocks) => {
            let mut replaced = 0;
            for _ in 0..blocks {
                // That every block is whole was proved.
                let Some((block_type, count)) = block_at(bytes, order, at) else { break };
                at += BLOCK_SIZE as usize;
                if block_type == BLOCK_TYPE_OPACITY_MICROMAP {
                    replaced += replace_run(bytes, at, count, order, &mut replace);
                }
                at += 8 * count;
            }
            Ok(replaced)
        }
    }
}

/// Replaces `count` addresses from `at` on and says how many that were.
fn replace_run(
    bytes: &mut [u8],
    at: usize,
    count: usize,
    order: ByteOrder,
    replace: &mut impl FnMut(u64) -> u64,
) -> usize {
    let run = bytes.get_mut(at..).and_then(|rest| rest.get_mut(..8 * count)).unwrap_or_default();
    let addresses = run.as_chunks_mut::<8>().0;
    // The order is the same for all: one loop for each lets the compiler take several addresses at once.
    match order {
        ByteOrder::Little => {
            addresses.iter_mut().for_each(|address| *address = replace(u64::from_le_bytes(*address)).to_le_bytes());
        }
        ByteOrder::Big => {
            addresses.iter_mut().for_each(|address| *address = replace(u64::from_be_bytes(*address)).to_be_bytes());
        }
    }
    addresses.len()
}
