//! Buffers, what they are bound to, and what lies at an address.

use omm_model::call::{Call, DeviceCreateInfo};
use omm_model::vk;
use omm_validate::state::MemorySpan;
use proptest::prelude::*;

use crate::{BUFFER, DEVICE, MEMORY, Program, QUEUE};

const ALIAS: vk::Buffer = vk::Buffer(0x13);

fn sparse(bind: vk::SparseMemoryBind) -> Call {
    let buffer_binds = vec![vk::SparseBufferMemoryBindInfo { buffer: BUFFER, binds: vec![bind] }];
    Call::QueueBindSparse { queue: QUEUE, buffer_binds }
}

fn bind(resource_offset: u64, size: u64, memory: vk::DeviceMemory, memory_offset: u64) -> Call {
    sparse(vk::SparseMemoryBind { resource_offset, size, memory, memory_offset, ..Default::default() })
}

#[test]
fn a_buffer_is_bound_as_long_as_its_memory_lives() {
    let mut program = Program::new();
    assert_eq!(program.state().is_bound(BUFFER, 0, 16), None);
    program.buffer(BUFFER, 0x100, vk::BufferCreateFlags::empty()).allocate(MEMORY, 1);
    assert_eq!(program.state().is_bound(BUFFER, 0, 16), Some(false));
    program.bind(BUFFER, 0x40);
    assert_eq!(program.state().is_bound(BUFFER, 0x80, u64::MAX), Some(true));
    let spans: Vec<_> = program.state().buffer_memory(BUFFER, 0x10, 0x20).collect();
    assert_eq!(spans, [MemorySpan { memory: MEMORY, offset: 0x50, size: 0x20 }]);
    program.calls(Call::FreeMemory { device: DEVICE, memory: MEMORY });
    assert_eq!(program.state().is_bound(BUFFER, 0, 16), Some(false));
}

#[test]
fn a_sparse_buffer_is_bound_where_it_was_bound_last() {
    let mut program = Program::new();
    program.buffer(BUFFER, 0x300, vk::BufferCreateFlags::SPARSE_BINDING).allocate(MEMORY, 1);
    program.calls(bind(0, 0x300, MEMORY, 0x400));
    assert_eq!(program.state().is_bound(BUFFER, 0, 0x300), Some(true));
    // A hole, and something else in its middle.
    program.calls(bind(0x100, 0x100, vk::DeviceMemory::NULL, 0)).calls(bind(0x140, 0x40, MEMORY, 0));
    let bound = |offset, size| program.state().is_bound(BUFFER, offset, size);
    assert_eq!((bound(0, 0x100), bound(0, 0x101)), (Some(true), Some(false)));
    assert_eq!((bound(0x140, 0x40), bound(0x140, 0x41)), (Some(true), Some(false)));
    let mut spans: Vec<_> = program.state().buffer_memory(BUFFER, 0xf0, 0x120).map(|it| (it.offset, it.size)).collect();
    spans.sort_unstable();
    assert_eq!(spans, [(0, 0x40), (0x4f0, 0x10), (0x600, 0x10)]);
}

#[test]
fn buffers_on_one_memory_are_found_by_address_and_by_memory() {
    let mut program = Program::new();
    program.buffer(BUFFER, 0x100, vk::BufferCreateFlags::empty()).buffer(ALIAS, 0x200, vk::BufferCreateFlags::empty());
    program.allocate(MEMORY, 1).bind(BUFFER, 0).bind(ALIAS, 0x80);
    assert!(!program.state().knows_addresses());
    program.address(BUFFER, 0x1000).address(ALIAS, 0x1080);
    let at = |address| {
        program.state().buffers_at(vk::DeviceAddress(address)).map(|it| (it.0, it.2, it.3)).collect::<Vec<_>>()
    };
    assert_eq!(at(0xfff), []);
    assert_eq!(at(0x1000), [(BUFFER, 0, 0x100)]);
    assert_eq!(at(0x10ff), [(BUFFER, 0xff, 1), (ALIAS, 0x7f, 0x181)]);
    assert_eq!(program.state().bytes_from(vk::DeviceAddress(0x10ff)), Some(0x181));
    let range = |address, size| vk::DeviceAddressRange { address: vk::DeviceAddress(address), size };
    let around = |range| program.state().buffers_around(range).map(|(handle, _)| handle).collect::<Vec<_>>();
    assert_eq!(around(range(0x1080, 0x80)), [BUFFER, ALIAS]);
    assert_eq!(around(range(0x1080, 0x81)), [ALIAS]);
    assert_eq!(around(range(0x1080, u64::MAX)), []);
    let on = |span| program.state().buffers_on(span).map(|(handle, _)| handle).collect::<Vec<_>>();
    assert_eq!(on(MemorySpan { memory: MEMORY, offset: 0, size: 0x80 }), [BUFFER]);
    assert_eq!(on(MemorySpan { memory: MEMORY, offset: 0, size: 0x81 }), [BUFFER, ALIAS]);
    let behind: Vec<_> = program.state().memory_behind(range(0x1080, 0x10)).collect();
    assert_eq!(behind, [MemorySpan { memory: MEMORY, offset: 0x80, size: 0x10 }; 2]);
    // Both micromaps lie in the same bytes, through different buffers.
    program.micromap(vk::Micromap(0x20), 0x80);
    let create_info = vk::MicromapCreateInfo { buffer: ALIAS, size: 1, ..Default::default() };
    program.calls(Call::CreateMicromap { device: DEVICE, create_info, micromap: vk::Micromap(0x21) });
    let memory = |handle| program.state().micromap_memory(vk::Micromap(handle)).next().unwrap();
    assert!(memory(0x20).overlaps(&memory(0x21)));
    assert_eq!(program.state().micromap_is_bound(vk::Micromap(0x20)), Some(true));
}

#[test]
fn memory_of_several_devices_has_several_instances_unless_masked() {
    let mut program = Program::new();
    let physical_devices = vec![vk::PhysicalDevice(8), vk::PhysicalDevice(9)];
    let group = vk::DeviceGroupDeviceCreateInfo { physical_devices, ..Default::default() };
    let create_info = DeviceCreateInfo { next: vec![group.into()], ..Default::default() };
    program.calls(Call::CreateDevice { physical_device: vk::PhysicalDevice(8), create_info, device: DEVICE });
    let instances = |program: &Program| program.state().memory(MEMORY).unwrap().instances;
    assert_eq!(instances(program.allocate(MEMORY, 0)), 2);
    assert_eq!(instances(program.allocate(MEMORY, 1)), 1, "the host's heap is shared");
    for (device_mask, expected) in [(0b10, 1), (0b11, 2)] {
        let flags = vk::MemoryAllocateFlags::DEVICE_MASK;
        let masked = vk::MemoryAllocateFlagsInfo { flags, device_mask, ..Default::default() };
        let allocate_info = vk::MemoryAllocateInfo { next: vec![masked.into()], ..Default::default() };
        program.calls(Call::AllocateMemory { device: DEVICE, allocate_info, memory: MEMORY });
        assert_eq!(instances(&program), expected);
    }
    program.allocate(MEMORY, 77);
    assert_eq!(program.state().memory(MEMORY).unwrap().property_flags, None);
}

proptest! {
    /// Sparse bindings against a byte by byte account of them.
    #[test]
    fn sparse_bindings_hold_what_was_bound_to_each_byte(
        binds in prop::collection::vec((0_u64..40, 0_u64..20, 0_u64..3, 0_u64..100), 0..8),
    ) {
        const SIZE: u64 = 64;
        let mut program = Program::new();
        program.buffer(BUFFER, SIZE, vk::BufferCreateFlags::SPARSE_BINDING);
        let mut bytes = vec![None; SIZE as usize];
        for (offset, size, memory, memory_offset) in binds {
            program.calls(bind(offset, size, vk::DeviceMemory(memory), memory_offset));
            for byte in 0..size {
                bytes[(offset + byte) as usize] = (memory != 0).then_some((memory, memory_offset + byte));
            }
        }
        for offset in 0..SIZE {
            let found = program.state().buffer_memory(BUFFER, offset, 1).map(|it| (it.memory.0, it.offset)).next();
            prop_assert_eq!(found, bytes[offset as usize]);
        }
        prop_assert_eq!(program.state().is_bound(BUFFER, 0, SIZE), Some(bytes.iter().all(Option::is_some)));
    }
}
