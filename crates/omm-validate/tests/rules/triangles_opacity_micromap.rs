//! `VkAccelerationStructureTrianglesOpacityMicromapKHR`: members and tracked objects.

use omm_model::call::Call;
use omm_model::vk;
use omm_validate::RuleId::*;

use crate::scene::*;

/// The path of a member; a macro because a case holds its paths as constants.
macro_rules! member {
    ($name:literal) => {
        concat!(
            "pInfos[0].pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapKHR>.",
            $name
        )
    };
}

pub(crate) fn cases() -> Vec<Case> {
    vec![
        fails(
            Scene::bottom_level,
            |scene| scene.attached().index_type = vk::IndexType(6),
            &[
                (IndexType11570, member!("indexType")),
                (AccelerationStructureTrianglesOpacityMicromapKhrIndexTypeParameter, member!("indexType")),
            ],
        ),
        passes(IndexType11570, Scene::bottom_level, |scene| {
            scene.attached().index_type = vk::IndexType::UINT8;
            scene.write(INDICES, &[0, 9, 2, 9, 252, 9, 1, 9]);
        }),
        fails(
            Scene::bottom_level_without_indices,
            |scene| scene.attached().index_buffer = vk::DeviceAddress(INDICES),
            &[(IndexBuffer11571, member!("indexBuffer"))],
        ),
        passes(IndexBuffer11571, Scene::bottom_level_without_indices, |_| {}),
        passes(
            IndexBuffer11571,
            || Scene::bottom_level_without_indices().into_sizes(),
            |scene| {
                scene.attached().index_buffer = vk::DeviceAddress(INDICES);
            },
        ),
        fails(
            Scene::bottom_level,
            |scene| scene.attached().index_buffer = vk::DeviceAddress::NULL,
            &[(IndexBuffer11572, member!("indexBuffer"))],
        ),
        // The first address behind the buffer.
        fails(
            Scene::bottom_level,
            |scene| scene.attached().index_buffer = vk::DeviceAddress(BASE + BUFFER_SIZE),
            &[(IndexBuffer11572, member!("indexBuffer"))],
        ),
        fails(
            Scene::bottom_level,
            |scene| {
                scene.with_limits(|_| {});
                let create_info = vk::BufferCreateInfo { size: 16, ..Default::default() };
                let other = vk::Buffer(0x55);
                scene.track(&Call::CreateBuffer { device: DEVICE, create_info, buffer: other });
                let info = vk::BufferDeviceAddressInfo { buffer: other, ..Default::default() };
                let address = omm_model::call::Output::DeviceAddress(vk::DeviceAddress(0x100));
                scene.validator.track(&Call::GetBufferDeviceAddress { device: DEVICE, info }, &address);
                scene.track(&Call::DestroyBuffer { device: DEVICE, buffer: BUFFER });
            },
            &[(IndexBuffer11572, member!("indexBuffer"))],
        ),
        passes(IndexBuffer11572, Scene::bottom_level, |scene| {
            scene.attached().index_buffer = vk::DeviceAddress(BASE + BUFFER_SIZE - 2);
            scene.range().primitive_count = 1;
        }),
        passes(
            IndexBuffer11572,
            || Scene::bottom_level().into_sizes(),
            |scene| {
                scene.attached().index_buffer = vk::DeviceAddress::NULL;
            },
        ),
        // Without any known address nothing can be said.
        passes(IndexBuffer11572, Scene::bottom_level, |scene| {
            scene.validator = omm_validate::Validator::new(scene.validator.profile().clone());
        }),
        fails(
            Scene::bottom_level,
            |scene| {
                scene.attached().index_stride = 3;
                scene.write(INDICES, &[0; 16]);
            },
            &[(IndexStride11573, member!("indexStride"))],
        ),
        passes(IndexStride11573, Scene::bottom_level, |scene| {
            scene.attached().index_stride = 6;
            scene.write(INDICES, &[0; 32]);
        }),
        fails(
            Scene::bottom_level,
            |scene| scene.attached().index_stride = 1 << 32,
            &[(IndexStride11574, member!("indexStride")), (IndexRange11577, member!("indexBuffer"))],
        ),
        fails(
            Scene::bottom_level,
            |scene| scene.attached().index_stride = (1 << 32) - 2,
            &[(IndexRange11577, member!("indexBuffer"))],
        ),
        passes(
            IndexStride11574,
            || Scene::bottom_level().into_sizes(),
            |scene| scene.attached().index_stride = (1 << 32) - 2,
        ),
        passes(IndexStride11574, Scene::bottom_level_without_indices, |scene| {
            scene.attached().index_stride = 1 << 32;
        }),
        fails(
            Scene::bottom_level_without_indices,
            |scene| scene.range().primitive_count = MICROMAP_TRIANGLES + 1,
            &[(TriangleIndex11576, member!("baseTriangle"))],
        ),
        fails(
            Scene::bottom_level_without_indices,
            |scene| scene.attached().base_triangle = u32::MAX,
            &[(TriangleIndex11576, member!("baseTriangle"))],
        ),
        passes(TriangleIndex11576, Scene::bottom_level_without_indices, |scene| {
            scene.attached().base_triangle = 1;
            scene.range().primitive_count = MICROMAP_TRIANGLES - 1;
        }),
        // No triangle, no index.
        passes(TriangleIndex11576, Scene::bottom_level_without_indices, |scene| {
            scene.attached().base_triangle = u32::MAX;
            scene.range().primitive_count = 0;
        }),
        fails(
            Scene::bottom_level_without_indices,
            |scene| scene.attached().micromap = vk::AccelerationStructure::NULL,
            &[(Micromap11579, member!("micromap"))],
        ),
        passes(Micromap11579, Scene::bottom_level_without_micromap, |_| {}),
        // The union of a geometry of another type is not looked at.
        passes(IndexType11570, Scene::bottom_level, |scene| {
            scene.attached().index_type = vk::IndexType(6);
            scene.geometry().geometry_type = vk::GeometryType::AABBS;
        }),
    ]
}

#[test]
fn cases_hold() {
    run(&cases());
}
