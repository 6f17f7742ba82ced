//! Replacing what serialized data refers to, as the application must before it deserializes.

use crate::blob::{Blob, Count};
use crate::header::{BLOCK_SIZE, BLOCK_TYPE_OPACITY_MICROMAP, FIXED_SIZE};
use crate::{ByteOrder, ReadError};

/// Puts `replace(address)` in the place of every handle, and of every address in blocks of micromaps, and says how many there
/// are. Blocks of other types and the payload stay as they are.
///
/// # Errors
/// As [`Blob::read`]; then nothing was changed.
pub fn replace_references(
    bytes: &mut [u8],
    order: ByteOrder,
    mut replace: impl FnMut(u64) -> u64,
) -> Result<usize, ReadError> {
    let blob = Blob::read(bytes, order)?;
    let mut runs = Vec::new();
    let mut at = FIXED_SIZE as usize;
    match blob.prefix().count {
        Count::Handles(_) => runs.push((at, blob.handles().len())),
        Count::Blocks(_) => {
            for block in blob.blocks() {
                let count = block.addresses().len();
                at += BLOCK_SIZE as usize;
                if block.block_type == BLOCK_TYPE_OPACITY_MICROMAP {
                    runs.push((at, count));
                }
                at += 8 * count;
            }
        }
    }
    let mut replaced = 0;
    for (at, count) in runs {
        let addresses = bytes.get_mut(at..).unwrap_or_default().as_chunks_mut::<8>().0;
        for address in addresses.iter_mut().take(count) {
            *address = order.u64_bytes(replace(order.u64(address)));
            replaced += 1;
        }
    }
    Ok(replaced)
}
