use super::*;

/// A heap of a mebibyte with one allocation of 256 bytes, handle 1.
fn memory() -> Memory {
    let mut memory = Memory::new(1 << 20);
    let info = vk::MemoryAllocateInfo { allocation_size: 256, ..Default::default() };
    assert_eq!(memory.allocate(&info, vk::DeviceMemory(1)), Ok(Output::None));
    memory
}

fn buffer(memory: &mut Memory, handle: u64, size: u64, offset: u64) -> u64 {
    let buffer = vk::Buffer(handle);
    let info = vk::BufferCreateInfo { size, ..Default::default() };
    assert_eq!(memory.create_buffer(&info, buffer), Ok(Output::None));
    assert_eq!(memory.bind_buffer(buffer, vk::DeviceMemory(1), offset), Ok(Output::None));
    match memory.buffer_address(buffer) {
        Ok(Output::DeviceAddress(address)) => address.0,
        other => panic!("{other:?}"),
    }
}

#[test]
fn addresses_are_apart_and_overruns_are_noticed() {
    let mut memory = memory();
    let (first, second) = (buffer(&mut memory, 1, 100, 0), buffer(&mut memory, 2, 100, 100));
    assert_eq!((first, second), (0x1_0000_0000, 0x1_0002_0000));
    memory.write(first + 98, &[1, 2]).unwrap();
    assert_eq!(memory.read(first + 97, 3), Ok(&[0, 1, 2][..]));
    assert_eq!(memory.write(first + 99, &[1, 2]), Err(MemoryError { address: first + 99, size: 2, available: 1 }));
    assert_eq!(memory.read(first + 101, 0), Err(MemoryError { address: first + 101, size: 0, available: 0 }));
    assert_eq!(memory.read(first + 100, 0), Ok(&[][..]));
    assert_eq!(memory.read(second, u64::MAX), Err(MemoryError { address: second, size: u64::MAX, available: 100 }));
    assert!(memory.read(0, 1).is_err());
    assert!(memory.read(u64::MAX, u64::MAX).is_err());
}

#[test]
fn buffers_may_share_memory() {
    let mut memory = memory();
    let (first, second) = (buffer(&mut memory, 1, 200, 0), buffer(&mut memory, 2, 156, 100));
    memory.write(second, &[7]).unwrap();
    assert_eq!(memory.read(first + 100, 1), Ok(&[7][..]));
    let place = |address, size| memory.place(address, size).unwrap();
    assert!(place(first + 90, 11).overlaps(&place(second, 1)));
    assert!(!place(first + 90, 10).overlaps(&place(second, 1)));
    assert!(!place(first + 100, 0).overlaps(&place(second, 1)));
}

#[test]
fn what_was_written_can_be_taken_back() {
    let mut memory = memory();
    let address = buffer(&mut memory, 1, 8, 0);
    memory.write(address, &[1; 8]).unwrap();
    memory.begin();
    memory.write(address, &[2; 4]).unwrap();
    memory.write(address + 2, &[3; 4]).unwrap();
    memory.roll_back();
    assert_eq!(memory.read(address, 8), Ok(&[1; 8][..]));
    memory.begin();
    memory.write(address, &[2; 4]).unwrap();
    memory.commit();
    memory.roll_back();
    assert_eq!(memory.read(address, 5), Ok(&[2, 2, 2, 2, 1][..]));
}

#[test]
fn nothing_is_larger_than_the_heap() {
    let mut memory = memory();
    let out = Ok(Output::Result(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY));
    for allocation_size in [(1 << 20) - 255, 1 << 60, u64::MAX] {
        let info = vk::MemoryAllocateInfo { allocation_size, ..Default::default() };
        assert_eq!(memory.allocate(&info, vk::DeviceMemory(2)), out);
    }
    for size in [(1 << 20) + 1, u64::MAX] {
        let info = vk::BufferCreateInfo { size, ..Default::default() };
        assert_eq!(memory.create_buffer(&info, vk::Buffer(2)), out);
    }
    let rest = vk::MemoryAllocateInfo { allocation_size: (1 << 20) - 256, ..Default::default() };
    assert_eq!(memory.allocate(&rest, vk::DeviceMemory(2)), Ok(Output::None));
    assert_eq!(memory.free(vk::DeviceMemory(2)), Ok(Output::None));
    assert_eq!(memory.allocate(&rest, vk::DeviceMemory(2)), Ok(Output::None));
}

#[test]
fn freed_memory_and_destroyed_buffers_are_gone() {
    let mut memory = memory();
    let (first, second) = (buffer(&mut memory, 1, 8, 0), buffer(&mut memory, 2, 8, 0));
    assert_eq!(memory.destroy_buffer(vk::Buffer(1)), Ok(Output::None));
    assert!(memory.read(first, 1).is_err());
    assert!(memory.read(second, 1).is_ok());
    assert_eq!(memory.free(vk::DeviceMemory(1)), Ok(Output::None));
    let gone = Err(MemoryError { address: second, size: 1, available: 0 });
    assert_eq!(memory.read(second, 1), gone);
    let info = vk::MemoryAllocateInfo { allocation_size: 256, ..Default::default() };
    assert_eq!(memory.allocate(&info, vk::DeviceMemory(1)), Ok(Output::None));
    assert_eq!(memory.read(second, 1), gone);
    assert_eq!(memory.free(vk::DeviceMemory::NULL), Ok(Output::None));
    assert_eq!(memory.destroy_buffer(vk::Buffer::NULL), Ok(Output::None));
}
