//! How findings of this sort read.

use omm_model::call::Call;
use omm_model::memory::NoMemory;
use omm_model::vk;
use serde_json::json;

use crate::calls::base;
use crate::case::changed;
use crate::world::{COMMAND_BUFFER, GONE, NEVER, OTHER_MICROMAP, TRANSFER_COMMAND_BUFFER, World};

#[test]
fn messages_say_what_was_found_and_what_was_required() {
    let mut world = World::new();
    let mut lines = Vec::new();
    for (name, pointer, value) in [
        ("CopyMicromap", "/info/s_type", json!(0)),
        ("CopyMicromap", "/info/next", json!([{ "Unknown": 77 }])),
        ("CopyMicromap", "/info/src", json!(0)),
        ("CopyMicromap", "/info/dst", json!(GONE)),
        ("CopyMicromap", "/info/dst", json!(OTHER_MICROMAP.0)),
        ("CopyMicromap", "/deferred_operation", json!(NEVER)),
        ("KHR", "/infos/0/geometries/0/next", json!([{ "Unknown": 77 }])),
        ("CmdCopyMicromapToMemory", "/info/mode", json!(9)),
        ("CmdBuildMicromaps", "/infos/0/flags", json!("0x81")),
        ("CmdBuildMicromaps", "/infos", json!([])),
        ("CmdCopyMicromap", "/command_buffer", json!(TRANSFER_COMMAND_BUFFER.0)),
    ] {
        let report = world.0.check(&changed(&base(name), pointer, &value), &NoMemory);
        lines.extend(report.iter().map(omm_validate::Violation::summary));
    }
    world.render(vk::RenderingFlags::SUSPENDING);
    lines.extend(world.0.check(&base("CmdCopyMicromap"), &NoMemory).iter().map(omm_validate::Violation::summary));
    world.track(&Call::CmdEndRendering { command_buffer: COMMAND_BUFFER });
    world.track(&Call::EndCommandBuffer { command_buffer: COMMAND_BUFFER });
    lines.extend(world.0.check(&base("CmdCopyMicromap"), &NoMemory).iter().map(omm_validate::Violation::summary));
    insta::assert_snapshot!(lines.join("\n"), @r"
    vkCopyMicromapEXT(): pInfo->sType: found VkStructureType(0), required VK_STRUCTURE_TYPE_COPY_MICROMAP_INFO_EXT
    vkCopyMicromapEXT(): pInfo->pNext: found VkStructureType(77), required NULL
    vkCopyMicromapEXT(): pInfo->src: found VK_NULL_HANDLE, required a living VkMicromapEXT
    vkCopyMicromapEXT(): pInfo->dst: found 0x66, which was destroyed, required a living VkMicromapEXT
    vkCopyMicromapEXT(): pInfo->dst: found an object of VkDevice 0x2, required one of VkDevice 0x1
    vkCopyMicromapEXT(): deferredOperation: found 0xdead, which was never created, required a living VkDeferredOperationKHR or VK_NULL_HANDLE
    vkCmdBuildAccelerationStructuresKHR(): pInfos[0].pGeometries[0].pNext<VkStructureType(77)>: found VkStructureType(77), required VkAccelerationStructureGeometryMicromapDataKHR, VkAccelerationStructureDenseGeometryFormatTrianglesDataAMDX, VkAccelerationStructureGeometryLinearSweptSpheresDataNV or VkAccelerationStructureGeometrySpheresDataNV
    vkCmdCopyMicromapToMemoryEXT(): pInfo->mode: found VkCopyMicromapModeEXT(9), required a value of VkCopyMicromapModeEXT
    vkCmdBuildMicromapsEXT(): pInfos[0].flags: found VK_BUILD_MICROMAP_PREFER_FAST_TRACE_BIT_EXT | 0x80, required flags without 0x80
    vkCmdBuildMicromapsEXT(): infoCount: found 0, required at least 1
    vkCmdCopyMicromapEXT(): commandBuffer: found VK_QUEUE_TRANSFER_BIT, required flags with VK_QUEUE_COMPUTE_BIT
    vkCmdCopyMicromapEXT(): commandBuffer: found a render pass instance, required none
    vkCmdCopyMicromapEXT(): commandBuffer: found a command buffer in the executable state, required one that is being recorded
    vkCmdCopyMicromapEXT(): commandBuffer: found a suspended render pass instance, required none
    ");
}
