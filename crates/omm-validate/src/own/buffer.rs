//! Buffers are bound once, to memory that is large enough, and what lies in them fits.

use omm_model::call::Call;
use omm_model::vk;

use super::finding::OwnFinding;
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::violation::ViolationKind;

/// OMM-buffer-01
pub(super) fn check(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    match call {
        Call::BindBufferMemory { buffer, memory, memory_offset, .. } => {
            let Some(found) = state.buffer(*buffer) else { return };
            if let Some(memory) = found.memory.map(|(memory, _)| memory).or(found.bindings.first().map(|it| it.memory))
            {
                let kind = ViolationKind::Own(OwnFinding::AlreadyBound { memory: memory.0 });
                report.push(RuleId::Buffer01, &command.field("buffer"), kind);
            }
            let limit = state.memory_size(*memory);
            within(&command.field("memoryOffset"), (*memory_offset, found.size), limit, report);
        }
        Call::QueueBindSparse { buffer_binds, .. } => {
            for (index, info) in buffer_binds.iter().enumerate() {
                let at = command.element("pBufferBinds", index);
                for (index, bind) in info.binds.iter().enumerate() {
                    let at = at.element("pBinds", index);
                    let limit = state.buffer(info.buffer).map(|buffer| buffer.size);
                    within(&at.field("resourceOffset"), (bind.resource_offset, bind.size), limit, report);
                    if !bind.memory.is_null() {
                        let limit = state.memory_size(bind.memory);
                        within(&at.field("memoryOffset"), (bind.memory_offset, bind.size), limit, report);
                    }
                }
            }
        }
        Call::GetBufferDeviceAddress { info, .. } => {
            let Some(found) = state.buffer(info.buffer) else { return };
            let is_sparse = found.flags.contains(vk::BufferCreateFlags::SPARSE_BINDING);
            if !is_sparse && state.sees_bindings() && !state.was_bound(info.buffer) {
                let kind = ViolationKind::NotBound { buffer: info.buffer.0 };
                report.push(RuleId::Buffer01, &command.pointer("pInfo").field("buffer"), kind);
            }
        }
        Call::CreateAccelerationStructure { create_info, .. } => {
            let limit = state.buffer(create_info.buffer).map(|buffer| buffer.size);
            let at = command.pointer("pCreateInfo");
            within(&at.field("offset"), (create_info.offset, create_info.size), limit, report);
        }
        _ => {}
    }
}

/// Reports bytes from an offset on that reach beyond a limit, if it is known.
fn within(at: &At<'_>, (start, size): (u64, u64), limit: Option<u64>, report: &mut Report) {
    if let Some(limit) = limit.filter(|limit| start.checked_add(size).is_none_or(|end| end > *limit)) {
        let available = limit.saturating_sub(start);
        report.push(RuleId::Buffer01, at, ViolationKind::BeyondBuffer { start, size: size.into(), available });
    }
}
