//! Sequences of calls that begin as a valid program and are then spoiled: nothing panics, whatever stops leaves no trace, and
//! the same calls give the same bytes.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use std::collections::BTreeMap;
use std::sync::OnceLock;

use common::{device, micromap};
use omm_device::app::{App, MicromapBinding, MicromapBindingExt, Observer, Structure, TriangleInput};
use omm_device::{Device, Undefined};
use omm_layout::index::IndexType;
use omm_model::call::{Call, Output};
use omm_model::memory::MemoryView;
use omm_model::profile::DeviceProfile;
use omm_model::special_index::{OpacityMicromapSpecialIndex, TriangleMap};
use omm_model::vk;
use proptest::prelude::*;
use serde_json::Value;

/// What a program does: calls, and writes through its mapping of the memory.
#[derive(Clone, Debug)]
enum Step {
    Call(Box<Call>),
    Write(vk::DeviceAddress, Vec<u8>),
}

/// Writes down what an application does, uploads included.
#[derive(Default)]
struct Recorder {
    steps: Vec<Step>,
    /// Sizes of buffers that the application may write.
    sizes: BTreeMap<vk::Buffer, u64>,
    inputs: BTreeMap<vk::Buffer, (vk::DeviceAddress, u64)>,
}

impl Observer for Recorder {
    fn before(&mut self, call: &Call, memory: &dyn MemoryView) {
        match call {
            Call::CreateBuffer { create_info, buffer, .. } => {
                let storage = vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE
                    | vk::BufferUsageFlags::MICROMAP_STORAGE
                    | vk::BufferUsageFlags::TRANSFER_DST;
                if !create_info.usage.intersects(storage) {
                    self.sizes.insert(*buffer, create_info.size);
                }
            }
            Call::DestroyBuffer { buffer, .. } => {
                self.inputs.remove(buffer);
            }
            Call::QueueSubmit { .. } => {
                for &(address, size) in self.inputs.values() {
                    self.steps.push(Step::Write(address, memory.read(address, size).unwrap().to_vec()));
                }
            }
            _ => {}
        }
        self.steps.push(Step::Call(Box::new(call.clone())));
    }

    fn after(&mut self, call: &Call, output: &Output) {
        if let (Call::GetBufferDeviceAddress { info, .. }, Output::DeviceAddress(address)) = (call, output)
            && let Some(&size) = self.sizes.get(&info.buffer)
        {
            self.inputs.insert(info.buffer, (*address, size));
        }
    }
}

/// A program that does a little of everything.
fn program() -> &'static [Step] {
    static PROGRAM: OnceLock<Vec<Step>> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let mut device = device();
        let pieces = host_pieces(&mut device);
        let mut recorder = Recorder::default();
        let mut app = App::new(&mut device, &mut recorder);
        let micromap = micromap(&mut app);
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [f32::NAN; 3]];
        let special = TriangleMap::SpecialIndex(OpacityMicromapSpecialIndex::FullyUnknownOpaque);
        let maps = [TriangleMap::Triangle(1), special, TriangleMap::Triangle(0)];
        let binding = MicromapBinding { micromap: Some(&micromap), maps: &maps, index_type: IndexType::Uint8 };
        let (indices, flags) = (&[0, 1, 2, 2, 1, 0, 0, 1, 3], vk::GeometryFlags::OPAQUE);
        let mapped = TriangleInput { positions: &positions, indices, flags, micromap: Some(binding) };
        let plain = TriangleInput { micromap: None, ..mapped };
        let flags = vk::BuildAccelerationStructureFlags::ALLOW_UPDATE;
        let bottom = app.build_triangles(&[mapped, plain], flags).unwrap();
        let reference =
            |acceleration_structure_reference| vk::Instance { acceleration_structure_reference, ..Default::default() };
        let top = app.build_instances(&[reference(bottom.address.0), reference(0)], flags).unwrap();
        for structure in [micromap, bottom, top] {
            let compacted = app.copy(&structure, vk::CopyAccelerationStructureMode::COMPACT).unwrap();
            let blob = app.serialize(&compacted).unwrap();
            app.deserialize(&blob, structure.ty).unwrap();
            app.destroy_structure(compacted).unwrap();
        }
        extended(&mut app, pieces, &top);
        recorder.steps
    })
}

/// What the host commands of the program read: opacity, one triangle of level 1, and scratch memory.
fn host_pieces(device: &mut Device) -> [vk::HostAddress; 3] {
    let triangle = vk::MicromapTriangle { data_offset: 1, subdivision_level: 1, format: 2 };
    let pieces = [vec![0, 0xe4, 0], omm_layout::triangle::encode(&triangle).to_vec(), vec![0; 512]];
    pieces.map(|bytes| {
        let address = device.allocate_host(bytes.len() as u64).unwrap();
        device.write_host(address, &bytes).unwrap();
        address
    })
}

/// Micromap objects, host commands, deferred operations, secondary command buffers, rays.
fn extended(app: &mut App<'_>, [data, array, scratch]: [vk::HostAddress; 3], top: &Structure) {
    let usage = vk::MicromapUsageExt { count: 1, subdivision_level: 1, format: 2 };
    let mut info = vk::MicromapBuildInfo {
        usage_counts: Some(vec![usage]),
        data: data.into(),
        scratch_data: scratch.into(),
        triangle_array: array.into(),
        triangle_array_stride: 8,
        ..Default::default()
    };
    let sizes = app.micromap_build_sizes(vk::AccelerationStructureBuildType::HOST, &info).unwrap();
    let [first, second] = [1, 2].map(|_| app.create_micromap_ext(sizes.micromap_size).unwrap());
    info.dst_micromap = first.handle;
    let deferred_operation = vk::DeferredOperation(app.device().unused_handle());
    let (device, operation) = (vk::Device(1), deferred_operation);
    let copy = vk::CopyMicromapInfo {
        src: first.handle,
        dst: second.handle,
        mode: vk::CopyMicromapMode::COMPACT,
        ..Default::default()
    };
    let mode = vk::CopyMicromapMode::SERIALIZE;
    let serialize =
        vk::CopyMicromapToMemoryInfo { src: second.handle, dst: scratch.into(), mode, ..Default::default() };
    let mode = vk::CopyMicromapMode::DESERIALIZE;
    let deserialize =
        vk::CopyMemoryToMicromapInfo { src: scratch.into(), dst: first.handle, mode, ..Default::default() };
    for call in [
        Call::CreateDeferredOperation { device, deferred_operation },
        Call::BuildMicromaps { device, deferred_operation, infos: vec![info] },
        Call::GetDeferredOperationMaxConcurrency { device, operation },
        Call::GetDeferredOperationResult { device, operation },
        Call::DeferredOperationJoin { device, operation },
        Call::CopyMicromap { device, deferred_operation, info: copy.clone() },
        Call::DeferredOperationJoin { device, operation },
        Call::CopyMicromapToMemory { device, deferred_operation, info: serialize },
        Call::DeferredOperationJoin { device, operation },
        Call::CopyMemoryToMicromap { device, deferred_operation: vk::DeferredOperation::NULL, info: deserialize },
        Call::DestroyDeferredOperation { device, operation },
    ] {
        app.call(&call).unwrap();
    }
    let special = [TriangleMap::Triangle(0), TriangleMap::SpecialIndex(OpacityMicromapSpecialIndex::FullyOpaque)];
    let binding =
        MicromapBindingExt { micromap: Some(&first), maps: &special, index_type: IndexType::Uint32, usages: &[] };
    let input =
        TriangleInput { positions: &[[0.5; 3]], indices: &[0; 6], flags: vk::GeometryFlags::empty(), micromap: None };
    app.build_triangles_ext(&[(input, Some(binding))], Default::default()).unwrap();

    let command_pool = vk::CommandPool(app.device().unused_handle());
    let pipeline = vk::Pipeline(command_pool.0 + 2);
    let [secondary, primary] = [1, 3].map(|after| vk::CommandBuffer(command_pool.0 + after));
    let allocate = |level, buffer| {
        let allocate_info =
            vk::CommandBufferAllocateInfo { command_pool, level, command_buffer_count: 1, ..Default::default() };
        Call::AllocateCommandBuffers { device, allocate_info, command_buffers: vec![buffer] }
    };
    let begin = |command_buffer| Call::BeginCommandBuffer { command_buffer, begin_info: Default::default() };
    let clone = vk::CopyMicromapInfo { mode: vk::CopyMicromapMode::CLONE, ..copy };
    for call in [
        Call::CreateCommandPool { device, create_info: Default::default(), command_pool },
        allocate(vk::CommandBufferLevel::SECONDARY, secondary),
        Call::CreateRayTracingPipelines { device, create_infos: vec![Default::default()], pipelines: vec![pipeline] },
        allocate(vk::CommandBufferLevel::PRIMARY, primary),
        begin(secondary),
        Call::CmdCopyMicromap { command_buffer: secondary, info: clone },
        Call::CmdTraceRays { command_buffer: secondary, pipeline, top_level: top.address },
        Call::EndCommandBuffer { command_buffer: secondary },
        begin(primary),
        Call::CmdExecuteCommands { command_buffer: primary, command_buffers: vec![secondary] },
        Call::EndCommandBuffer { command_buffer: primary },
        Call::QueueSubmit { queue: vk::Queue(1), command_buffers: vec![primary] },
        Call::ResetCommandBuffer { command_buffer: primary, flags: Default::default() },
        Call::FreeCommandBuffers { device, command_pool, command_buffers: vec![secondary] },
    ] {
        app.call(&call).unwrap();
    }
}

/// Executes a program; gives what every call returned, and the memory at the end.
fn run(steps: &[Step]) -> (Vec<Result<Output, Undefined>>, Vec<u8>) {
    let mut device = Device::with_heap_size(DeviceProfile::reference(), 1 << 20);
    host_pieces(&mut device);
    let mut results = Vec::new();
    for step in steps {
        match step {
            Step::Write(address, bytes) => drop(device.write(*address, bytes)),
            Step::Call(call) => {
                let result = device.execute(call);
                if result.is_err() {
                    let before = contents(&device);
                    assert_eq!(device.execute(call), result);
                    assert_eq!(contents(&device), before);
                }
                results.push(result);
            }
        }
    }
    (results, contents(&device))
}

/// What can be read at the addresses that buffers can have.
fn contents(device: &Device) -> Vec<u8> {
    let mut contents = Vec::new();
    for address in (0x1_0000_0000_u64..0x1_0100_0000).step_by(0x1_0000) {
        let size = device.read(vk::DeviceAddress(address), u64::MAX).unwrap_err().available;
        contents.extend_from_slice(device.read(vk::DeviceAddress(address), size).unwrap_or_default());
    }
    contents
}

/// One way to spoil a program.
#[derive(Clone, Debug)]
enum Spoil {
    Remove,
    Repeat,
    Swap(usize),
    /// Replaces one of the numbers in a call, or a byte of a write.
    Number(usize, u64),
    /// Replaces one of the numbers in a call with another of them.
    Copy(usize, usize),
}

fn spoil() -> impl Strategy<Value = Spoil> {
    let number = prop_oneof![
        0..20_u64,
        any::<u64>(),
        Just(u64::MAX),
        Just(u32::MAX.into()),
        Just(0x1_0000_0000),
        Just(1_000_623_000),
        Just(1 << 20),
    ];
    prop_oneof![
        1 => Just(Spoil::Remove),
        1 => Just(Spoil::Repeat),
        1 => any::<usize>().prop_map(Spoil::Swap),
        4 => (any::<usize>(), number).prop_map(|(at, number)| Spoil::Number(at, number)),
        2 => (any::<usize>(), any::<usize>()).prop_map(|(to, from)| Spoil::Copy(to, from)),
    ]
}

/// All numbers of a value.
fn numbers<'a>(value: &'a mut Value, found: &mut Vec<&'a mut Value>) {
    match value {
        Value::Number(_) => found.push(value),
        Value::Array(values) => values.iter_mut().for_each(|value| numbers(value, found)),
        Value::Object(values) => values.values_mut().for_each(|value| numbers(value, found)),
        _ => {}
    }
}

/// The same call with one number replaced, if that number fits there.
fn replaced(call: &Call, at: usize, number: impl FnOnce(&[&mut Value]) -> Value) -> Option<Call> {
    let mut value = serde_json::to_value(call).unwrap();
    let mut found = Vec::new();
    numbers(&mut value, &mut found);
    let number = number(&found);
    let count = found.len();
    **found.get_mut(at % count.max(1))? = number;
    serde_json::from_value(value).ok()
}

fn apply(steps: &mut Vec<Step>, at: usize, spoil: &Spoil) {
    if steps.is_empty() {
        return;
    }
    let at = at % steps.len();
    match (spoil, &mut steps[at]) {
        (Spoil::Remove, _) => drop(steps.remove(at)),
        (Spoil::Repeat, step) => {
            let step = step.clone();
            steps.insert(at, step);
        }
        (Spoil::Swap(other), _) => {
            let other = other % steps.len();
            steps.swap(at, other);
        }
        (Spoil::Number(at, number), Step::Write(_, bytes)) => {
            let at = at % bytes.len();
            bytes[at] = *number as u8;
        }
        (Spoil::Copy(to, from), Step::Write(_, bytes)) => {
            let (to, from) = (to % bytes.len(), from % bytes.len());
            bytes[to] = bytes[from];
        }
        (Spoil::Number(at, number), Step::Call(call)) => {
            **call = replaced(call, *at, |_| (*number).into()).unwrap_or_else(|| (**call).clone());
        }
        (Spoil::Copy(to, from), Step::Call(call)) => {
            let copy = |found: &[&mut Value]| {
                found.get(from % found.len().max(1)).map_or(Value::Null, |found| (*found).clone())
            };
            **call = replaced(call, *to, copy).unwrap_or_else(|| (**call).clone());
        }
    }
}

#[test]
fn the_program_itself_is_defined() {
    let (results, memory) = run(program());
    assert!(results.iter().all(Result::is_ok), "{results:?}");
    assert!(memory.windows(8).any(|bytes| bytes == b"ommobj02"));
}

proptest! {
    #[test]
    fn spoiled_programs_stop_cleanly(spoils in prop::collection::vec((any::<usize>(), spoil()), 1..8)) {
        let mut steps = program().to_vec();
        for (at, spoil) in &spoils {
            apply(&mut steps, *at, spoil);
        }
        prop_assert_eq!(run(&steps), run(&steps));
    }
}
