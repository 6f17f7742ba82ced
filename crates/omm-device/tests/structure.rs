//! Acceleration structure objects: ranges of memory with a type.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::{bytes, device, micromap};
use omm_device::AccelerationStructure;
use omm_device::app::App;
use omm_model::call::{Call, Output};
use omm_model::vk;

const DEVICE: vk::Device = vk::Device(1);

#[test]
fn a_structure_can_be_made_before_its_buffer_has_memory() {
    let mut device = device();
    let mut call = |call: Call| device.execute(&call);
    let (buffer, memory) = (vk::Buffer(5), vk::DeviceMemory(5));
    let create_info = vk::BufferCreateInfo { size: 1024, ..Default::default() };
    call(Call::CreateBuffer { device: DEVICE, create_info, buffer }).unwrap();
    let acceleration_structure = vk::AccelerationStructure(6);
    let ty = vk::AccelerationStructureType::GENERIC;
    let create_info = vk::AccelerationStructureCreateInfo { buffer, offset: 256, size: 768, ty, ..Default::default() };
    call(Call::CreateAccelerationStructure {
        device: DEVICE,
        create_info: create_info.clone(),
        acceleration_structure,
    })
    .unwrap();
    let info = vk::AccelerationStructureDeviceAddressInfo { acceleration_structure, ..Default::default() };
    let address = Call::GetAccelerationStructureDeviceAddress { device: DEVICE, info };
    assert_eq!(call(address.clone()).unwrap_err().at, "pInfo->accelerationStructure");
    let allocate_info = vk::MemoryAllocateInfo { allocation_size: 1024, ..Default::default() };
    call(Call::AllocateMemory { device: DEVICE, allocate_info, memory }).unwrap();
    call(Call::BindBufferMemory { device: DEVICE, buffer, memory, memory_offset: 0 }).unwrap();
    let found = Output::DeviceAddress(vk::DeviceAddress(0x1_0000_0100));
    assert_eq!(call(address).unwrap(), found);

    // The address of a replay is the address that it would have anyway, or none.
    for (wished, result) in [
        (0x1_0000_0100, Output::None),
        (0x1_0000_0200, Output::Result(vk::Result::ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS)),
    ] {
        let create_info =
            vk::AccelerationStructureCreateInfo { device_address: vk::DeviceAddress(wished), ..create_info.clone() };
        let acceleration_structure = vk::AccelerationStructure(7);
        let create = Call::CreateAccelerationStructure { device: DEVICE, create_info, acceleration_structure };
        assert_eq!(call(create).unwrap(), result);
        call(Call::DestroyAccelerationStructure { device: DEVICE, acceleration_structure }).ok();
    }
    let address = vk::DeviceAddress(0x1_0000_0100);
    let expected = AccelerationStructure { address, size: 768, ty, fully_bound: false };
    assert_eq!(device.acceleration_structure(vk::AccelerationStructure(6)), Some(&expected));
    assert_eq!(device.acceleration_structure(vk::AccelerationStructure(7)), None);
    assert_eq!(device.unused_handle(), 8);
}

#[test]
fn what_is_built_outlives_the_handle() {
    let mut device = device();
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let first = micromap(&mut app);
    let found = bytes(&app, &first);
    app.call(&Call::DestroyAccelerationStructure { device: DEVICE, acceleration_structure: first.handle }).unwrap();
    let acceleration_structure = vk::AccelerationStructure(app.device().unused_handle());
    let address_range = vk::DeviceAddressRange { address: first.address, size: first.size };
    let create_info = vk::AccelerationStructureCreateInfo2 { address_range, ty: first.ty, ..Default::default() };
    app.call(&Call::CreateAccelerationStructure2 { device: DEVICE, create_info, acceleration_structure }).unwrap();
    let again = omm_device::app::Structure { handle: acceleration_structure, ..first };
    let copy = app.copy(&again, vk::CopyAccelerationStructureMode::CLONE).unwrap();
    assert_eq!(bytes(&app, &copy), found);
}
