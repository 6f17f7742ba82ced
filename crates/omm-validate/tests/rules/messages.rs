//! What people and programs read.

use omm_model::vk;

use crate::scene::*;

#[test]
fn a_stride() {
    let mut scene = Scene::bottom_level();
    scene.attached().index_stride = 3;
    scene.write(INDICES, &[0; 16]);
    insta::assert_snapshot!(scene.check(), @r#"
    Validation Error: [ VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexStride-11573 ]
    Objects: VkCommandBuffer 0x7, VkAccelerationStructureKHR 0x21, VkAccelerationStructureKHR 0x20
    vkCmdBuildAccelerationStructuresKHR(): pInfos[0].pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapKHR>.indexStride: found 3, required a multiple of 2
    The build steps through the index buffer by this stride and would read indices that are not aligned to their size. Use the size of the index type for a tightly packed buffer, or a multiple of it.
    https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureTrianglesOpacityMicromapKHR.html#VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexStride-11573
    "#);
}

#[test]
fn two_findings() {
    let mut scene = Scene::micromap();
    scene.info().flags = vk::BuildAccelerationStructureFlags::LOW_MEMORY;
    scene.usages()[0].subdivision_level = 9;
    insta::assert_snapshot!(scene.check(), @r#"
    Validation Error: [ VUID-VkAccelerationStructureBuildGeometryInfoKHR-flags-11562 ]
    Objects: VkCommandBuffer 0x7, VkAccelerationStructureKHR 0x21
    vkCmdBuildAccelerationStructuresKHR(): pInfos[0].flags: found VK_BUILD_ACCELERATION_STRUCTURE_LOW_MEMORY_BIT_KHR, required flags without VK_BUILD_ACCELERATION_STRUCTURE_LOW_MEMORY_BIT_KHR
    A micromap build knows compaction, the two preferences of speed and lossy storage. The other flags are made for structures that hold geometry: their updates, motion, scratch memory and attached micromaps. Remove them.
    https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureBuildGeometryInfoKHR.html#VUID-VkAccelerationStructureBuildGeometryInfoKHR-flags-11562

    Validation Error: [ VUID-VkAccelerationStructureBuildGeometryInfoKHR-subdivisionLevel-11564 ]
    Objects: VkCommandBuffer 0x7, VkAccelerationStructureKHR 0x21
    vkCmdBuildAccelerationStructuresKHR(): pInfos[0].pGeometries[0].pNext<VkAccelerationStructureGeometryMicromapDataKHR>.pUsageCounts[0].subdivisionLevel: found 9, required at most 3 (maxOpacity4StateSubdivisionLevel)
    The usage counts announce 4-state triangles that are subdivided more finely than the device can store exactly. Bake them at a coarser level, or allow lossy storage where the device's limit for it is higher.
    https://docs.vulkan.org/refpages/latest/refpages/source/VkAccelerationStructureBuildGeometryInfoKHR.html#VUID-VkAccelerationStructureBuildGeometryInfoKHR-subdivisionLevel-11564
    "#);
}

#[test]
fn an_index() {
    let mut scene = Scene::bottom_level();
    scene.attached().base_triangle = 1;
    insta::assert_snapshot!(scene.check(), @r#"
    Validation Error: [ VUID-vkCmdBuildAccelerationStructuresKHR-indexBuffer-11575 ]
    Objects: VkCommandBuffer 0x7, VkAccelerationStructureKHR 0x21, VkAccelerationStructureKHR 0x20
    vkCmdBuildAccelerationStructuresKHR(): pInfos[0].pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapKHR>.indexBuffer[1]: found 2, required at most 1 (the micromap has 3 triangles, baseTriangle is 1)
    An index plus baseTriangle names a triangle that the micromap does not have, so the triangle's opacity is read from foreign memory. Correct the index, lower baseTriangle, or use a special index.
    https://docs.vulkan.org/refpages/latest/refpages/source/vkCmdBuildAccelerationStructuresKHR.html#VUID-vkCmdBuildAccelerationStructuresKHR-indexBuffer-11575
    "#);
    insta::assert_json_snapshot!(scene.check(), @r#"
    [
      {
        "vuid": "VUID-vkCmdBuildAccelerationStructuresKHR-indexBuffer-11575",
        "severity": "error",
        "command": "vkCmdBuildAccelerationStructuresKHR",
        "path": "pInfos[0].pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapKHR>.indexBuffer[1]",
        "found": "2",
        "required": "at most 1 (the micromap has 3 triangles, baseTriangle is 1)",
        "objects": [
          {
            "type": "VkCommandBuffer",
            "handle": "0x7"
          },
          {
            "type": "VkAccelerationStructureKHR",
            "handle": "0x21"
          },
          {
            "type": "VkAccelerationStructureKHR",
            "handle": "0x20"
          }
        ],
        "message": "vkCmdBuildAccelerationStructuresKHR(): pInfos[0].pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapKHR>.indexBuffer[1]: found 2, required at most 1 (the micromap has 3 triangles, baseTriangle is 1). An index plus baseTriangle names a triangle that the micromap does not have, so the triangle's opacity is read from foreign memory. Correct the index, lower baseTriangle, or use a special index."
      }
    ]
    "#);
}

#[test]
fn found_and_required() {
    let text = |scene: fn() -> Scene, change: fn(&mut Scene)| {
        let mut scene = scene();
        change(&mut scene);
        let report = scene.check();
        let text = |it: &omm_validate::Violation| format!("{}, not {}", it.kind.required(), it.kind.found());
        report.iter().map(text).collect::<Vec<_>>().join("; ")
    };
    let all = [
        text(Scene::micromap, |scene| *scene.ranges() = Some(vec![])),
        text(Scene::micromap, |scene| scene.info().geometries = None),
        text(Scene::micromap, |scene| scene.info().src_acceleration_structure = MICROMAP),
        text(Scene::micromap, |scene| scene.micromap_data().usage_count_pointers = Some(vec![])),
        text(Scene::micromap, |scene| scene.micromap_data().triangle_array_stride = 4),
        text(Scene::micromap, |scene| scene.micromap_data().data.0 += 64),
        text(Scene::micromap, |scene| scene.micromap_data().triangle_array_stride = 1 << 62),
        text(Scene::micromap, |scene| scene.geometry().flags = vk::GeometryFlags::from_bits_retain(5)),
        text(Scene::bottom_level, |scene| scene.attached().index_type = vk::IndexType(6)),
        text(Scene::bottom_level, |scene| scene.attached().index_buffer = vk::DeviceAddress(1)),
        text(Scene::bottom_level, |scene| scene.attached().index_stride = 1 << 32),
        text(Scene::bottom_level, |scene| scene.attached().base_triangle = 3),
        text(Scene::bottom_level_without_micromap, |scene| scene.write(INDICES, &[0; 2])),
        text(Scene::bottom_level_without_indices, |scene| scene.attached().index_buffer.0 = 1),
        text(Scene::bottom_level_without_indices, |scene| scene.attached().micromap.0 = 0),
        text(Scene::top_level, |scene| scene.info().ty = vk::AccelerationStructureType::GENERIC),
    ];
    insta::assert_snapshot!(all.join("\n"), @r#"
    NULL, not a pointer
    exactly 1, not 0
    VK_NULL_HANDLE, not 0x20
    only one of them, not pUsageCounts and ppUsageCounts
    at least 8, not 4
    a multiple of 128, not 0x10140
    at most 4096 bytes, where the buffer ends, not 13835058055282163712 bytes from 0x10000
    flags without VK_GEOMETRY_OPAQUE_BIT_KHR | 0x4, not VK_GEOMETRY_OPAQUE_BIT_KHR | 0x4
    VK_INDEX_TYPE_UINT8, VK_INDEX_TYPE_UINT16, VK_INDEX_TYPE_UINT32 or VK_INDEX_TYPE_NONE_KHR, not VkIndexType(6); a value of VkIndexType, not VkIndexType(6)
    an address inside a buffer, not 0x1
    at most 4294967295 (the largest 32-bit number), not 4294967296; at most 3584 bytes, where the buffer ends, not 17179869184 bytes from 0x10200
    no index at all (the micromap has 3 triangles, baseTriangle is 3), not 0
    a special index, 65532 to 65535, not 0
    0, not 0x1
    an object, not VK_NULL_HANDLE
    any other value, not VK_ACCELERATION_STRUCTURE_TYPE_GENERIC_KHR
    "#);
}
