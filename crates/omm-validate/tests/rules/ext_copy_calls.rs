//! What the program of [`World`](crate::ext_copy_world::World) is made of: calls and serialized data.

use omm_layout::object::{MicromapContents, MicromapTriangleData};
use omm_model::call::{Call, Output};
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::profile::DeviceProfile;
use omm_model::vk;

use crate::ext_copy_world::{BASE, BUFFER_SIZE, DEVICE};

/// The micromap of one triangle that the program builds, serialized on the device of `profile`.
pub(crate) fn serialized(profile: &DeviceProfile) -> Vec<u8> {
    let triangle = MicromapTriangleData {
        subdivision_level: SubdivisionLevel::new(0).unwrap(),
        format: OpacityMicromapFormat::FourState,
        data: &[1],
    };
    let object = MicromapContents { flags: 4, triangles: vec![triangle] }.encode().unwrap();
    omm_serialize::serialize_object(&object, profile.driver_uuid, profile.compatibility_uuid).unwrap()
}

/// Memory of a type of the reference device, with an instance on each physical device where the heap allows.
pub(crate) fn memory_of_type(memory_type_index: u32) -> vk::MemoryAllocateInfo {
    let flags = vk::MemoryAllocateFlagsInfo { flags: vk::MemoryAllocateFlags::DEVICE_ADDRESS, ..Default::default() };
    vk::MemoryAllocateInfo {
        next: vec![flags.into()],
        allocation_size: BUFFER_SIZE,
        memory_type_index,
        ..Default::default()
    }
}

/// The same on the first physical device only.
pub(crate) fn on_first_device(memory_type_index: u32) -> vk::MemoryAllocateInfo {
    let flags = vk::MemoryAllocateFlags::DEVICE_ADDRESS | vk::MemoryAllocateFlags::DEVICE_MASK;
    let flags = vk::MemoryAllocateFlagsInfo { flags, device_mask: 1, ..Default::default() };
    vk::MemoryAllocateInfo { next: vec![flags.into()], ..memory_of_type(memory_type_index) }
}

/// Creates a buffer, allocates its memory, binds it and asks for its address.
pub(crate) fn create_buffer(
    buffer: vk::Buffer,
    memory: vk::DeviceMemory,
    allocate_info: vk::MemoryAllocateInfo,
    address: u64,
) -> [(Call, Output); 4] {
    let usage = vk::BufferUsageFlags::MICROMAP_STORAGE
        | vk::BufferUsageFlags::MICROMAP_BUILD_INPUT_READ_ONLY
        | vk::BufferUsageFlags::STORAGE_BUFFER
        | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
    let create_info = vk::BufferCreateInfo { size: BUFFER_SIZE, usage, ..Default::default() };
    let info = vk::BufferDeviceAddressInfo { buffer, ..Default::default() };
    [
        (Call::CreateBuffer { device: DEVICE, create_info, buffer }, Output::None),
        (Call::AllocateMemory { device: DEVICE, allocate_info, memory }, Output::None),
        (Call::BindBufferMemory { device: DEVICE, buffer, memory, memory_offset: 0 }, Output::None),
        (Call::GetBufferDeviceAddress { device: DEVICE, info }, Output::DeviceAddress(vk::DeviceAddress(address))),
    ]
}

pub(crate) fn create_micromap(micromap: vk::Micromap, buffer: vk::Buffer, offset: u64, size: u64) -> Call {
    let create_info =
        vk::MicromapCreateInfo { buffer, offset, size, ty: vk::MicromapType::OPACITY_MICROMAP, ..Default::default() };
    Call::CreateMicromap { device: DEVICE, create_info, micromap }
}

/// A build of a micromap of one triangle that can be compacted.
pub(crate) fn build(dst_micromap: vk::Micromap) -> vk::MicromapBuildInfo {
    vk::MicromapBuildInfo {
        flags: vk::BuildMicromapFlags::ALLOW_COMPACTION,
        dst_micromap,
        usage_counts: Some(vec![vk::MicromapUsageExt { count: 1, subdivision_level: 0, format: 2 }]),
        data: vk::DeviceAddress(BASE + 0x100).into(),
        scratch_data: vk::DeviceAddress(BASE + 0x200).into(),
        triangle_array: vk::DeviceAddress(BASE).into(),
        triangle_array_stride: 8,
        ..Default::default()
    }
}
