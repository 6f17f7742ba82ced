use omm_model::call::Call;
use omm_model::vk;

use super::*;
use crate::objects::{Object, Range};

fn objects() -> Objects {
    let mut objects = Objects::default();
    objects.insert(Object {
        name: "leaf".to_owned(),
        handles: vec![("AccelerationStructure", 0x4001)],
        place: Some(Range { address: 0x1_0000, size: 0x100, host: false }),
    });
    objects.insert(Object {
        name: "blob".to_owned(),
        handles: vec![],
        place: Some(Range { address: 0x9_0000, size: 0x100, host: true }),
    });
    objects
}

fn call() -> Call {
    let usage = vk::MicromapUsage { count: 2, subdivision_level: 1, format: vk::OpacityMicromapFormat::FOUR_STATE };
    let data = vk::GeometryMicromapData {
        usage_counts: Some(vec![usage]),
        triangle_array: vk::DeviceAddress(0x2_0000),
        triangle_array_stride: 8,
        ..Default::default()
    };
    let attached = vk::TrianglesOpacityMicromap {
        index_type: vk::IndexType::UINT16,
        index_buffer: vk::DeviceAddress(0x3_0000),
        index_stride: 4,
        ..Default::default()
    };
    let triangles = vk::GeometryTrianglesData { next: vec![attached.into()], ..Default::default() };
    let geometries = vec![
        vk::Geometry { next: vec![data.into()], geometry_type: vk::GeometryType::MICROMAP, ..Default::default() },
        vk::Geometry { geometry: vk::GeometryData::Triangles(triangles), ..Default::default() },
    ];
    Call::CmdBuildAccelerationStructures {
        command_buffer: vk::CommandBuffer(7),
        infos: vec![vk::BuildGeometryInfo { geometries: Some(geometries), ..Default::default() }],
        build_range_infos: vec![Some(vec![vk::BuildRangeInfo::default()]), None],
    }
}

/// The call's values after some changes, each as a line, or the mistake.
fn change(text: &str) -> String {
    let node = crate::node::read(text).unwrap();
    let before = crate::path::places(&Tree::of(&call()).unwrap());
    let changes = Changes::read(&node).unwrap();
    match changes.apply::<Call>(Tree::of(&call()).unwrap(), &objects()) {
        Ok(Changed { value, writes, notes }) => {
            let places = crate::path::places(&Tree::of(&value).unwrap());
            let counts = (places.len() as i64) - (before.len() as i64);
            let notes: Vec<_> = notes.iter().map(|(path, value)| format!("{path} = {value}")).collect();
            let writes: Vec<_> =
                writes.iter().map(|write| format!("\n{:#x}: {:x?}", write.address, write.bytes)).collect();
            format!("{} ({counts:+}){}", notes.join("\n"), writes.concat())
        }
        Err(Mistake { span, message, help }) => {
            let place = &text[span.start..span.end];
            format!("{place}: {message}{}", help.map(|help| format!("; {help}")).unwrap_or_default())
        }
    }
}

#[test]
fn values_are_set() {
    let all = [
        r#"{"…indexStride": 3}"#,
        r#"{"…triangles…indexType": VK_INDEX_TYPE_NONE_KHR}"#,
        r#"{"pInfos[0].type": "OPACITY_MICROMAP"}"#,
        r#"{"pInfos[0].flags": [ALLOW_UPDATE, VK_BUILD_ACCELERATION_STRUCTURE_LOW_MEMORY_BIT_KHR, 0x80000000]}"#,
        r#"{"pInfos[0].flags": "ALLOW_UPDATE | ALLOW_COMPACTION"}"#,
        r#"{"pInfos[0].dstAccelerationStructure": "leaf"}"#,
        r#"{"pInfos[0].dstAccelerationStructure": null}"#,
        r#"{"pInfos[0].dstAccelerationStructure": 0xdead}"#,
        r#"{"pInfos[0].scratchData": "leaf + 1"}"#,
        r#"{"pInfos[0].scratchData": "blob"}"#,
        r#"{"pInfos[0].scratchData": host(64)}"#,
        r#"{"…indexBuffer": "leaf+2"}"#,
        r#"{"…pUsageCounts[0].format": 7}"#,
        r#"{"…pUsageCounts": [(count: 3), (count: 1, subdivisionLevel: 4, format: VK_OPACITY_MICROMAP_FORMAT_2_STATE_KHR)]}"#,
        r#"{"…ppUsageCounts": same("…pUsageCounts"), "…pUsageCounts": null}"#,
        r#"{"pInfos[0].pGeometries[1].geometry": none}"#,
        r#"{"pInfos[0].pGeometries[1].geometry": aabbs(stride: 24)}"#,
        r#"{"ppBuildRangeInfos[1]": [VkAccelerationStructureBuildRangeInfoKHR(primitiveCount: 1)]}"#,
        r#"{"ppBuildRangeInfos[0][0].primitiveCount": 4294967295}"#,
    ];
    insta::assert_snapshot!(all.map(change).join("\n"));
}

#[test]
fn parts_come_and_go() {
    let all = [
        r#"{"pInfos": push(same("pInfos[0]"))}"#,
        r#"{"pInfos[0].pGeometries": push((geometryType: INSTANCES))}"#,
        r#"{"pInfos[0].pGeometries[0].pNext": push(VkAccelerationStructureGeometryMicromapDataKHR())}"#,
        r#"{"pInfos[0].pNext": push(unknown(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO))}"#,
        r#"{"…ppUsageCounts": push(VkMicromapUsageKHR(count: 1))}"#,
        r#"{"pInfos[0].pGeometries[0]": remove}"#,
        r#"{"pInfos[0].pGeometries": remove}"#,
        r#"{"…pNext<VkAccelerationStructureGeometryMicromapDataKHR>": remove}"#,
        r#"{"ppBuildRangeInfos": remove}"#,
    ];
    insta::assert_snapshot!(all.map(change).join("\n"));
}

#[test]
fn memory_is_written() {
    let all = [
        r#"{"…triangleArray[2].format": 0xffff}"#,
        r#"{"pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.triangleArray[1].subdivisionLevel": 13}"#,
        r#"{"…indexBuffer[3]": T}"#,
        r#"{"…indexBuffer[0]": -4, "…indexStride": 2, "…indexBuffer[1]": 5}"#,
    ];
    insta::assert_snapshot!(all.map(change).join("\n"));
}

#[test]
fn mistakes_say_what_else_there_is() {
    let all = [
        r#"{"…indexSride": 3}"#,
        r#"{"pInfos[1].type": 3}"#,
        r#"{"pInfos[0].geometryCount": 3}"#,
        r#"{"…sType": 3}"#,
        r#"{"…indexStride": -1}"#,
        r#"{"…indexStride": "leaf"}"#,
        r#"{"…triangles…indexType": UINT}"#,
        r#"{"pInfos[0].dstAccelerationStructure": "laef"}"#,
        r#"{"…indexBuffer": "blob"}"#,
        r#"{"…indexBuffer[0]": 70000}"#,
        r#"{"…triangleArray[0]": 1}"#,
        r#"{"…triangleArray[x].format": 1}"#,
        r#"{"…triangleArray[99999999999999999999].format": 1}"#,
        r#"{"…triangleArray[9223372036854775807].format": 1}"#,
        r#"{"pInfos[0].pNext": push(VkNothing())}"#,
        r#"{"pInfos[0].pNext": push(VkMicromapUsageKHR())}"#,
        r#"{"pInfos[0].pNext": push(VkAccelerationStructureGeometryMicromapDataKHR(strid: 1))}"#,
        r#"{"…ppUsageCounts": ["leaf"]}"#,
        r#"{"…indexStride": remove}"#,
        r#"{"…indexStride": push(1)}"#,
        r#"{"…pUsageCounts[0]": same("…nothing")}"#,
        r#"{"…pUsageCounts[0].count": 4294967296}"#,
    ];
    insta::assert_snapshot!(all.map(change).join("\n"));
}
