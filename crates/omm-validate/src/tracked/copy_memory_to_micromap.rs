//! Rules of `vkCmdCopyMemoryToMicromapEXT` and `vkCopyMemoryToMicromapEXT` on objects and addresses.

use omm_model::call::Call;

use super::copy_micromap::{
    bound_memory, complete_operation, device_address, host_visible_memory, single_instance_memory,
};
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;

pub(super) fn check(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    let at = command.pointer("pInfo");
    let (src, dst) = (at.field("src"), at.field("dst"));
    match call {
        Call::CmdCopyMemoryToMicromap { info, .. } => {
            device_address(&src, info.src, state, RuleId::DeserializeAddress07543, report);
            bound_memory(&dst, info.dst, state, RuleId::DeserializeDstMemory07546, report);
        }
        Call::CopyMemoryToMicromap { deferred_operation, info, .. } => {
            complete_operation(command, *deferred_operation, state, RuleId::DeserializeDeferredOperation03678, report);
            host_visible_memory(&dst, info.dst, state, RuleId::HostDeserializeDstMemory07565, report);
            single_instance_memory(&dst, info.dst, state, RuleId::HostDeserializeDstInstances07567, report);
        }
        _ => {}
    }
}
