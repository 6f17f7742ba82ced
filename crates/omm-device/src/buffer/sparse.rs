//! Binding parts of sparse buffers. What is bound of a buffer has to be one piece, in one piece of memory.

use std::collections::BTreeMap;

use omm_model::call::Output;
use omm_model::vk;

use super::Binding;
use crate::memory::Memory;
use crate::undefined::{At, Reason, Stop};

impl Memory {
    /// `vkQueueBindSparse`: all of it or nothing.
    pub(crate) fn bind_sparse(&mut self, infos: &[vk::SparseBufferMemoryBindInfo]) -> Result<Output, Stop> {
        let mut bindings = BTreeMap::new();
        for (index, info) in infos.iter().enumerate() {
            let at = format_args!("pBindInfo[0].pBufferBinds[{index}]");
            let found = self.buffer(info.buffer).at("buffer").at(at)?;
            let binding = bindings.entry(info.buffer).or_insert(found.binding);
            for (index, bind) in info.binds.iter().enumerate() {
                let new = self.sparse_bind(found.size, bind).at(format_args!("{at}.pBinds[{index}]"))?;
                let old = binding.filter(|old| !old.memory.is_null());
                *binding = bound(old, new).at(format_args!("{at}.pBinds[{index}]"))?;
            }
        }
        for (buffer, binding) in bindings {
            if let Some(found) = self.buffers.get_mut(&buffer) {
                found.binding = binding;
            }
        }
        Ok(Output::None)
    }

    /// One binding, its ranges checked against the buffer and the memory.
    fn sparse_bind(&self, limit: u64, bind: &vk::SparseMemoryBind) -> Result<Binding, Stop> {
        let &vk::SparseMemoryBind { resource_offset, size, memory, memory_offset, flags: _ } = bind;
        if resource_offset.checked_add(size).is_none_or(|end| end > limit) {
            return Err(Reason::OutsideObject { offset: resource_offset, size, limit }).at("resourceOffset");
        }
        if !memory.is_null() {
            let limit = self.allocation_size(memory).at("memory")?;
            if memory_offset.checked_add(size).is_none_or(|end| end > limit) {
                return Err(Reason::OutsideObject { offset: memory_offset, size, limit }).at("memoryOffset");
            }
        }
        Ok(Binding { start: resource_offset, size, memory, memory_offset })
    }
}

/// What is bound of a buffer once `new`, whose memory may be null, has replaced what was bound there.
fn bound(old: Option<Binding>, new: Binding) -> Result<Option<Binding>, Reason> {
    // Both were checked against the buffer's size, so the ends are numbers.
    let end = |binding: &Binding| binding.start + binding.size;
    let Some(old) = old else {
        return Ok(Some(new).filter(|new| !new.memory.is_null() && new.size > 0));
    };
    if new.size == 0 {
        return Ok(Some(old));
    }
    let before = Some(Binding { size: new.start.saturating_sub(old.start).min(old.size), ..old });
    let cut = end(&new).clamp(old.start, end(&old)) - old.start;
    let after = Binding {
        start: old.start + cut,
        size: old.size - cut,
        memory_offset: old.memory_offset + cut,
        memory: old.memory,
    };
    let pieces = [before, Some(new).filter(|new| !new.memory.is_null()), Some(after)];
    let mut joined: Option<Binding> = None;
    for piece in pieces.into_iter().flatten().filter(|piece| piece.size > 0) {
        joined = match joined {
            None => Some(piece),
            Some(first)
                if end(&first) == piece.start
                    && first.memory == piece.memory
                    && first.memory_offset + first.size == piece.memory_offset =>
            {
                Some(Binding { size: first.size + piece.size, ..first })
            }
            Some(_) => return Err(Reason::Unsupported { what: "sparse buffers bound to several pieces of memory" }),
        };
    }
    Ok(joined)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn binding(start: u64, size: u64, memory: u64, memory_offset: u64) -> Binding {
        Binding { start, size, memory: vk::DeviceMemory(memory), memory_offset }
    }

    #[test]
    fn pieces_that_fit_together_become_one() {
        let whole = Some(binding(0, 100, 1, 50));
        assert_eq!(bound(None, binding(0, 100, 1, 50)), Ok(whole));
        assert_eq!(bound(Some(binding(0, 60, 1, 50)), binding(60, 40, 1, 110)), Ok(whole));
        assert_eq!(bound(Some(binding(40, 60, 1, 90)), binding(0, 40, 1, 50)), Ok(Some(binding(0, 100, 1, 50))));
        assert_eq!(bound(whole, binding(20, 10, 1, 70)), Ok(whole));
        assert_eq!(bound(whole, binding(0, 100, 2, 0)), Ok(Some(binding(0, 100, 2, 0))));
        assert_eq!(bound(whole, binding(0, 100, 0, 0)), Ok(None));
        assert_eq!(bound(whole, binding(80, 20, 0, 0)), Ok(Some(binding(0, 80, 1, 50))));
        assert_eq!(bound(whole, binding(0, 30, 0, 0)), Ok(Some(binding(30, 70, 1, 80))));
        assert_eq!(bound(whole, binding(3, 0, 9, 0)), Ok(whole));
        for (start, memory, memory_offset) in [(60, 1, 0), (60, 2, 110), (61, 1, 111), (20, 0, 0)] {
            let result = bound(Some(binding(0, 60, 1, 50)), binding(start, 30, memory, memory_offset));
            assert!(matches!(result, Err(Reason::Unsupported { .. })), "{result:?}");
        }
    }
}
