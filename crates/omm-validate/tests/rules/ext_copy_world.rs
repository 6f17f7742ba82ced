//! A valid program that gives every command on built micromap objects something to do, on both timelines, and cases that change
//! it a little.

use omm_model::call::{Call, Output};
use omm_model::memory::{MemoryError, MemoryView};
use omm_model::profile::DeviceProfile;
use omm_model::vk;
use omm_validate::{Report, RuleId, Validator};

pub(crate) use crate::ext_copy_calls::*;

pub(crate) const DEVICE: vk::Device = vk::Device(1);
pub(crate) const QUEUE: vk::Queue = vk::Queue(2);
pub(crate) const COMMAND_BUFFER: vk::CommandBuffer = vk::CommandBuffer(4);
pub(crate) const BUFFER: vk::Buffer = vk::Buffer(5);
pub(crate) const QUERY_POOL: vk::QueryPool = vk::QueryPool(7);
pub(crate) const OPERATION: vk::DeferredOperation = vk::DeferredOperation(8);
const COMMAND_POOL: vk::CommandPool = vk::CommandPool(3);
pub(crate) const MEMORY: vk::DeviceMemory = vk::DeviceMemory(6);

/// Built on the device, and the source of everything.
pub(crate) const SOURCE: vk::Micromap = vk::Micromap(0x10);
/// Copied into.
pub(crate) const COPY: vk::Micromap = vk::Micromap(0x11);
/// Deserialized into.
pub(crate) const LOADED: vk::Micromap = vk::Micromap(0x12);
/// Created, and otherwise not used.
pub(crate) const EMPTY: vk::Micromap = vk::Micromap(0x13);
/// What [`World::another_micromap`] adds.
pub(crate) const ANOTHER: vk::Micromap = vk::Micromap(0x14);
const ANOTHER_BUFFER: vk::Buffer = vk::Buffer(0x15);
const ANOTHER_MEMORY: vk::DeviceMemory = vk::DeviceMemory(0x16);

/// Device memory: one buffer.
pub(crate) const BASE: u64 = 0x10_0000;
pub(crate) const BUFFER_SIZE: u64 = 0x1_0000;
/// Serialized data in device memory, as a file would hold it.
pub(crate) const BLOB: u64 = BASE + 0x8000;
/// Where the device serializes to.
pub(crate) const SERIALIZED: u64 = BASE + 0x9000;
/// Host memory: triangle array and opacity data, serialized data, and where the host serializes to.
pub(crate) const HOST_BASE: u64 = 0x7000_0000;
pub(crate) const HOST_SIZE: u64 = 0x4000;
pub(crate) const HOST_BLOB: u64 = HOST_BASE + 0x1000;
pub(crate) const HOST_SERIALIZED: u64 = HOST_BASE + 0x2000;

/// The commands of the program that work on the host.
const HOST_COMMANDS: [&str; 4] =
    ["vkWriteMicromapsPropertiesEXT", "vkCopyMicromapEXT", "vkCopyMicromapToMemoryEXT", "vkCopyMemoryToMicromapEXT"];

/// Bytes of a micromap object of the program.
pub(crate) const MICROMAP_SIZE: u64 = 0x1000;
/// What the program is told that serialized micromaps take.
pub(crate) const SERIALIZED_SIZE: u64 = 0x100;

/// The calls of a program with what they returned, the device that it runs on, and memory.
#[derive(Clone)]
pub(crate) struct World {
    pub(crate) profile: DeviceProfile,
    pub(crate) calls: Vec<(Call, Output)>,
    pub(crate) device_memory: Vec<u8>,
    pub(crate) host_memory: Vec<u8>,
}

impl MemoryView for World {
    fn read(&self, address: vk::DeviceAddress, size: u64) -> Result<&[u8], MemoryError> {
        part(&self.device_memory, BASE, address.0, size)
    }

    fn read_host(&self, address: vk::HostAddress, size: u64) -> Result<&[u8], MemoryError> {
        part(&self.host_memory, HOST_BASE, address.0, size)
    }

    fn knows_host_memory(&self) -> bool {
        true
    }
}

fn part(bytes: &[u8], base: u64, address: u64, size: u64) -> Result<&[u8], MemoryError> {
    let rest = address.checked_sub(base).and_then(|start| bytes.get(start as usize..)).unwrap_or_default();
    rest.get(..size as usize).ok_or(MemoryError { address, size, available: rest.len() as u64 })
}

impl World {
    /// The program, on the reference device.
    pub(crate) fn new() -> Self {
        let profile = DeviceProfile::reference();
        let blob = serialized(&profile);
        let (device_memory, host_memory) = (vec![0; BUFFER_SIZE as usize], vec![0; HOST_SIZE as usize]);
        let mut world = Self { profile, calls: Vec::new(), device_memory, host_memory };
        world.put(BLOB, &blob);
        world.put_on_host(HOST_BLOB, &blob);
        // The triangle array: level 0, 4-state.
        world.put(BASE + 6, &[2]);
        world.create_objects();
        world.record();
        world.work_on_host();
        world
    }

    fn create_objects(&mut self) {
        self.calls.extend(create_buffer(BUFFER, MEMORY, memory_of_type(2), BASE));
        for (place, micromap) in (1_u64..).zip([SOURCE, COPY, LOADED, EMPTY]) {
            self.push(create_micromap(micromap, BUFFER, place * MICROMAP_SIZE, MICROMAP_SIZE));
        }
        let create_info = vk::QueryPoolCreateInfo {
            query_type: vk::QueryType::MICROMAP_COMPACTED_SIZE,
            query_count: 2,
            ..Default::default()
        };
        self.push(Call::CreateQueryPool { device: DEVICE, create_info, query_pool: QUERY_POOL });
        self.push(Call::GetDeviceQueue { device: DEVICE, queue_family_index: 0, queue_index: 0, queue: QUEUE });
        let create_info = vk::CommandPoolCreateInfo::default();
        self.push(Call::CreateCommandPool { device: DEVICE, create_info, command_pool: COMMAND_POOL });
        let allocate_info =
            vk::CommandBufferAllocateInfo { command_pool: COMMAND_POOL, command_buffer_count: 1, ..Default::default() };
        let command_buffers = vec![COMMAND_BUFFER];
        self.push(Call::AllocateCommandBuffers { device: DEVICE, allocate_info, command_buffers });
        self.push(Call::CreateDeferredOperation { device: DEVICE, deferred_operation: OPERATION });
    }

    fn record(&mut self) {
        let command_buffer = COMMAND_BUFFER;
        self.push(Call::BeginCommandBuffer { command_buffer, begin_info: vk::CommandBufferBeginInfo::default() });
        self.push(Call::CmdResetQueryPool { command_buffer, query_pool: QUERY_POOL, first_query: 0, query_count: 2 });
        self.push(Call::CmdBuildMicromaps { command_buffer, infos: vec![build(SOURCE)] });
        let info =
            vk::CopyMicromapInfo { src: SOURCE, dst: COPY, mode: vk::CopyMicromapMode::CLONE, ..Default::default() };
        self.push(Call::CmdCopyMicromap { command_buffer, info });
        let dst = vk::DeviceAddress(SERIALIZED).into();
        let mode = vk::CopyMicromapMode::SERIALIZE;
        let info = vk::CopyMicromapToMemoryInfo { src: SOURCE, dst, mode, ..Default::default() };
        self.push(Call::CmdCopyMicromapToMemory { command_buffer, info });
        let src = vk::DeviceAddress(BLOB).into();
        let mode = vk::CopyMicromapMode::DESERIALIZE;
        let info = vk::CopyMemoryToMicromapInfo { src, dst: LOADED, mode, ..Default::default() };
        self.push(Call::CmdCopyMemoryToMicromap { command_buffer, info });
        self.push(Call::CmdWriteMicromapsProperties {
            command_buffer,
            micromaps: vec![SOURCE],
            query_type: vk::QueryType::MICROMAP_COMPACTED_SIZE,
            query_pool: QUERY_POOL,
            first_query: 0,
        });
        self.push(Call::EndCommandBuffer { command_buffer });
        self.push(Call::QueueSubmit { queue: QUEUE, command_buffers: vec![command_buffer] });
    }

    fn work_on_host(&mut self) {
        let (device, deferred_operation) = (DEVICE, vk::DeferredOperation::NULL);
        let query_type = vk::QueryType::MICROMAP_SERIALIZATION_SIZE;
        let micromaps = vec![SOURCE, COPY];
        self.calls.push((
            Call::WriteMicromapsProperties { device, micromaps, query_type, data_size: 16, stride: 8 },
            Output::Properties(vec![SERIALIZED_SIZE; 2]),
        ));
        let info =
            vk::CopyMicromapInfo { src: SOURCE, dst: COPY, mode: vk::CopyMicromapMode::CLONE, ..Default::default() };
        self.push(Call::CopyMicromap { device, deferred_operation, info });
        let dst = vk::HostAddress(HOST_SERIALIZED).into();
        let mode = vk::CopyMicromapMode::SERIALIZE;
        let info = vk::CopyMicromapToMemoryInfo { src: SOURCE, dst, mode, ..Default::default() };
        self.push(Call::CopyMicromapToMemory { device, deferred_operation, info });
        let src = vk::HostAddress(HOST_BLOB).into();
        let mode = vk::CopyMicromapMode::DESERIALIZE;
        let info = vk::CopyMemoryToMicromapInfo { src, dst: LOADED, mode, ..Default::default() };
        self.push(Call::CopyMemoryToMicromap { device, deferred_operation, info });
        let version_data = serialized(&self.profile)[..32].to_vec();
        let version_info = vk::MicromapVersionInfo { version_data, ..Default::default() };
        self.calls.push((
            Call::GetDeviceMicromapCompatibility { device, version_info },
            Output::Compatibility(vk::AccelerationStructureCompatibility::COMPATIBLE),
        ));
        self.push(Call::DestroyMicromap { device, micromap: EMPTY });
    }

    pub(crate) fn push(&mut self, call: Call) {
        self.calls.push((call, Output::None));
    }

    /// Where the first call of that name stands.
    pub(crate) fn position(&self, command: &str) -> usize {
        let position = self.calls.iter().position(|(call, _)| call.command() == command);
        position.unwrap_or_else(|| panic!("no {command}"))
    }

    /// Puts a call before the first of that name.
    pub(crate) fn insert(&mut self, before: &str, call: Call) {
        self.calls.insert(self.position(before), (call, Output::None));
    }

    /// Takes the first call of that name away.
    pub(crate) fn remove(&mut self, command: &str) -> (Call, Output) {
        self.calls.remove(self.position(command))
    }

    /// Keeps the calls of these names, in their order.
    pub(crate) fn only(&mut self, commands: &[&str]) {
        self.calls.retain(|(call, _)| commands.contains(&call.command()));
    }

    /// Takes every host command but that one away.
    pub(crate) fn only_on_host(&mut self, command: &str) {
        for other in HOST_COMMANDS.into_iter().filter(|other| *other != command) {
            self.remove(other);
        }
    }

    /// Takes the submission and all that builds on it away: what was recorded is not judged as if it were executed.
    pub(crate) fn only_record(&mut self) {
        self.only_on_host("");
        self.remove("vkQueueSubmit");
    }

    /// Writes into device memory.
    pub(crate) fn put(&mut self, address: u64, bytes: &[u8]) {
        self.device_memory[(address - BASE) as usize..][..bytes.len()].copy_from_slice(bytes);
    }

    /// Writes into host memory.
    pub(crate) fn put_on_host(&mut self, address: u64, bytes: &[u8]) {
        self.host_memory[(address - HOST_BASE) as usize..][..bytes.len()].copy_from_slice(bytes);
    }

    /// The first part of the call that `part` knows.
    fn find<T>(&mut self, part: impl Fn(&mut Call) -> Option<&mut T>) -> &mut T {
        self.calls.iter_mut().find_map(|(call, _)| part(call)).unwrap()
    }

    pub(crate) fn copy(&mut self) -> &mut vk::CopyMicromapInfo {
        self.find(|call| if let Call::CmdCopyMicromap { info, .. } = call { Some(info) } else { None })
    }

    pub(crate) fn host_copy(&mut self) -> &mut vk::CopyMicromapInfo {
        self.find(|call| if let Call::CopyMicromap { info, .. } = call { Some(info) } else { None })
    }

    pub(crate) fn serialize(&mut self) -> &mut vk::CopyMicromapToMemoryInfo {
        self.find(|call| if let Call::CmdCopyMicromapToMemory { info, .. } = call { Some(info) } else { None })
    }

    pub(crate) fn host_serialize(&mut self) -> &mut vk::CopyMicromapToMemoryInfo {
        self.find(|call| if let Call::CopyMicromapToMemory { info, .. } = call { Some(info) } else { None })
    }

    pub(crate) fn deserialize(&mut self) -> &mut vk::CopyMemoryToMicromapInfo {
        self.find(|call| if let Call::CmdCopyMemoryToMicromap { info, .. } = call { Some(info) } else { None })
    }

    pub(crate) fn host_deserialize(&mut self) -> &mut vk::CopyMemoryToMicromapInfo {
        self.find(|call| if let Call::CopyMemoryToMicromap { info, .. } = call { Some(info) } else { None })
    }

    pub(crate) fn build_info(&mut self) -> &mut vk::MicromapBuildInfo {
        self.find(|call| if let Call::CmdBuildMicromaps { infos, .. } = call { infos.first_mut() } else { None })
    }

    /// The call that resets the queries.
    pub(crate) fn reset(&mut self) -> &mut Call {
        let mut calls = self.calls.iter_mut().map(|(call, _)| call);
        calls.find(|call| matches!(call, Call::CmdResetQueryPool { .. })).unwrap()
    }

    pub(crate) fn query_pool(&mut self) -> &mut vk::QueryPoolCreateInfo {
        self.find(|call| if let Call::CreateQueryPool { create_info, .. } = call { Some(create_info) } else { None })
    }

    pub(crate) fn properties(&mut self) -> Properties<'_> {
        self.calls
            .iter_mut()
            .find_map(|(call, _)| match call {
                Call::CmdWriteMicromapsProperties { micromaps, query_type, first_query, .. } => {
                    Some(Properties { micromaps, query_type, first_query })
                }
                _ => None,
            })
            .unwrap()
    }

    pub(crate) fn host_properties(&mut self) -> HostProperties<'_> {
        self.calls
            .iter_mut()
            .find_map(|(call, _)| match call {
                Call::WriteMicromapsProperties { micromaps, query_type, data_size, stride, .. } => {
                    Some(HostProperties { micromaps, query_type, data_size, stride })
                }
                _ => None,
            })
            .unwrap()
    }

    /// One more micromap, [`ANOTHER`], in a buffer of its own, on memory of that kind if any, which the device builds.
    pub(crate) fn another_micromap(&mut self, allocate_info: Option<vk::MemoryAllocateInfo>) {
        let mut create: Vec<_> =
            create_buffer(ANOTHER_BUFFER, ANOTHER_MEMORY, memory_of_type(2), BASE + 2 * BUFFER_SIZE).into();
        let is_bound = allocate_info.is_some();
        match allocate_info {
            Some(wanted) => {
                let Call::AllocateMemory { allocate_info, .. } = &mut create[1].0 else { panic!("no allocation") };
                *allocate_info = wanted;
            }
            None => create.truncate(1),
        }
        create.push((create_micromap(ANOTHER, ANOTHER_BUFFER, 0, MICROMAP_SIZE), Output::None));
        let at = self.position("vkCreateMicromapEXT");
        self.calls.splice(at..at, create);
        if is_bound {
            let command_buffer = COMMAND_BUFFER;
            self.insert(
                "vkCmdCopyMicromapEXT",
                Call::CmdBuildMicromaps { command_buffer, infos: vec![build(ANOTHER)] },
            );
        }
    }

    /// The call that creates the buffer of [`ANOTHER`].
    pub(crate) fn another_buffer(&mut self) -> &mut Call {
        let mut calls = self.calls.iter_mut().map(|(call, _)| call);
        calls.find(|call| matches!(call, Call::CreateBuffer { buffer: ANOTHER_BUFFER, .. })).unwrap()
    }

    /// Defers a host command on [`OPERATION`].
    pub(crate) fn defer(&mut self, position: usize) {
        let (call, output) = &mut self.calls[position];
        match call {
            Call::CopyMicromap { deferred_operation, .. }
            | Call::CopyMicromapToMemory { deferred_operation, .. }
            | Call::CopyMemoryToMicromap { deferred_operation, .. } => *deferred_operation = OPERATION,
            other => panic!("{} cannot be deferred", other.command()),
        }
        *output = Output::Result(vk::Result::OPERATION_DEFERRED);
    }

    /// The program is told that serialized micromaps take so many bytes.
    pub(crate) fn said_to_take(&mut self, size: u64) {
        let at = self.position("vkWriteMicromapsPropertiesEXT");
        self.calls[at].1 = Output::Properties(vec![size; 2]);
    }

    /// The device is made of two physical ones.
    pub(crate) fn on_two_devices(&mut self) {
        let physical_devices = vec![vk::PhysicalDevice(0x31), vk::PhysicalDevice(0x32)];
        let group = vk::DeviceGroupDeviceCreateInfo { physical_devices, ..Default::default() };
        let create_info = omm_model::call::DeviceCreateInfo {
            next: vec![group.into()],
            queue_create_infos: vec![omm_model::call::DeviceQueueCreateInfo { queue_family_index: 0, queue_count: 1 }],
            enabled_features: None,
        };
        let physical_device = vk::PhysicalDevice(0x31);
        self.calls.insert(0, (Call::CreateDevice { physical_device, create_info, device: DEVICE }, Output::None));
        for (call, _) in &mut self.calls {
            if let Call::AllocateMemory { allocate_info, .. } = call {
                *allocate_info = on_first_device(allocate_info.memory_type_index);
            }
        }
    }

    /// What is found in each call of the program.
    pub(crate) fn reports(&self) -> Vec<Report> {
        let mut validator = Validator::new(self.profile.clone());
        self.calls.iter().map(|(call, output)| validator.check_and_track(call, output, self)).collect()
    }

    /// Every rule broken by the program, with its path.
    pub(crate) fn run(&self) -> Vec<(RuleId, String)> {
        let mut found = Vec::new();
        for violation in self.reports().into_iter().flatten() {
            assert!(!violation.objects.is_empty(), "{violation}");
            found.push((violation.rule, violation.location.to_string()));
        }
        found
    }
}

/// The parameters of `vkCmdWriteMicromapsPropertiesEXT`.
pub(crate) struct Properties<'a> {
    pub(crate) micromaps: &'a mut Vec<vk::Micromap>,
    pub(crate) query_type: &'a mut vk::QueryType,
    pub(crate) first_query: &'a mut u32,
}

/// The parameters of `vkWriteMicromapsPropertiesEXT`.
pub(crate) struct HostProperties<'a> {
    pub(crate) micromaps: &'a mut Vec<vk::Micromap>,
    pub(crate) query_type: &'a mut vk::QueryType,
    pub(crate) data_size: &'a mut u64,
    pub(crate) stride: &'a mut u64,
}

/// A change to the program, and every rule that it breaks, with its path; none if it almost breaks `rule`.
#[derive(Clone)]
pub(crate) struct WorldCase {
    pub(crate) rule: RuleId,
    change: fn(&mut World),
    broken: &'static [(RuleId, &'static str)],
}

impl WorldCase {
    pub(crate) fn breaks(&self) -> bool {
        !self.broken.is_empty()
    }
}

/// A change that breaks `rule` at `path`, and no other.
pub(crate) fn breaks(change: fn(&mut World), broken: &'static [(RuleId, &'static str)]) -> WorldCase {
    WorldCase { rule: broken[0].0, change, broken }
}

/// A change that almost breaks `rule`.
pub(crate) fn keeps(rule: RuleId, change: fn(&mut World)) -> WorldCase {
    WorldCase { rule, change, broken: &[] }
}

pub(crate) fn run_cases(cases: &[WorldCase]) {
    for (index, case) in cases.iter().enumerate() {
        let mut world = World::new();
        (case.change)(&mut world);
        let found = world.run();
        let found: Vec<_> = found.iter().map(|(rule, path)| (*rule, path.as_str())).collect();
        assert_eq!(found, case.broken, "case {index}, of {:?}", case.rule);
    }
}

#[test]
fn the_program_is_valid() {
    assert_eq!(World::new().run(), []);
}
