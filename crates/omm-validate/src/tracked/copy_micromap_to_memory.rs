//! Rules of `vkCmdCopyMicromapToMemoryEXT`, `vkCopyMicromapToMemoryEXT` and `VkCopyMicromapToMemoryInfoEXT` on objects and
//! addresses.

use omm_model::call::Call;

use super::copy_micromap::{
    bound_memory, complete_operation, constructed, device_address, host_visible_memory, single_instance_memory,
};
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;

pub(super) fn check(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    let at = command.pointer("pInfo");
    let (src, dst) = (at.field("src"), at.field("dst"));
    match call {
        Call::CmdCopyMicromapToMemory { info, .. } => {
            device_address(&dst, info.dst, state, RuleId::SerializeAddress07536, report);
            bound_memory(&src, info.src, state, RuleId::SerializeSrcMemory07539, report);
        }
        Call::CopyMicromapToMemory { deferred_operation, info, .. } => {
            complete_operation(command, *deferred_operation, state, RuleId::SerializeDeferredOperation03678, report);
            host_visible_memory(&src, info.src, state, RuleId::HostSerializeSrcMemory07568, report);
            single_instance_memory(&src, info.src, state, RuleId::HostSerializeSrcInstances07572, report);
        }
        _ => {}
    }
}

/// Checks what the command finds when it executes.
pub(super) fn check_executed(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    if let Call::CmdCopyMicromapToMemory { info, .. } | Call::CopyMicromapToMemory { info, .. } = call {
        let at = command.pointer("pInfo");
        constructed(&at.field("src"), info.src, state, RuleId::SerializeSource07540, report);
    }
}
