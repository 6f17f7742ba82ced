//! Two readings of the specification held against each other: what the validator says nothing about, the device can do.

use arbitrary::Unstructured;
use omm_device::{Device, Reason, Undefined};
use omm_layout::object::ObjectHeader;
use omm_model::call::{Call, Output, Timeline};
use omm_model::memory::MemoryView;
use omm_model::profile::DeviceProfile;
use omm_model::vk;
use omm_validate::Validator;

mod program;
mod recorder;
mod replay;
mod spoil;

pub use replay::replay;

use program::{HEAP, programs};
use recorder::{Step, put_host};

/// What came of a sequence of calls.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Outcome {
    /// Calls that the device executed.
    pub calls: usize,
    /// How many of them were submissions and host commands that did work.
    pub executed: usize,
    /// How many reports the validator had.
    pub reports: usize,
    /// Where the device stopped, and on which call, if it did. Where it does not simulate what was asked, it did not.
    pub undefined: Option<(Undefined, Box<Call>)>,
}

impl Outcome {
    /// Whether the validator said nothing from beginning to end.
    #[must_use]
    pub const fn is_silent(&self) -> bool {
        self.reports == 0
    }

    /// Whether the device stopped at something that the validator said nothing about.
    #[must_use]
    pub const fn is_disagreement(&self) -> bool {
        self.is_silent() && self.undefined.is_some()
    }
}

/// Takes a program without a mistake, spoils it as the bytes say, and shows it to validator and device.
///
/// # Panics
/// If the validator said nothing and the device stopped all the same.
pub fn calls(bytes: &[u8]) -> Outcome {
    let outcome = run(bytes);
    if let (true, Some((undefined, call))) = (outcome.is_silent(), &outcome.undefined) {
        panic!("nothing was reported, and the device stopped: {undefined}\n{call:#?}");
    }
    outcome
}

/// The same, but leaves the judgement to the caller.
#[must_use]
pub fn run(bytes: &[u8]) -> Outcome {
    execute(spoiled(bytes).iter())
}

/// The program that the bytes choose, spoiled as they say.
fn spoiled(bytes: &[u8]) -> Vec<Step> {
    let mut choices = Unstructured::new(bytes);
    let program = choices.choose_index(programs().len()).unwrap_or_default();
    let program = &programs()[program];
    let mut steps = program.steps.clone();
    // One mistake more often than several, and sometimes none.
    let spoils = choices.choose(&[0, 1, 1, 1, 2, 2, 3, 6]).copied().unwrap_or_default();
    for _ in 0..spoils {
        // Without bytes left the program stays as it is.
        if steps.is_empty() || spoil::spoil(&mut steps, &mut choices).is_err() {
            break;
        }
    }
    program.prologue.iter().cloned().chain(steps).collect()
}

fn execute<'a>(steps: impl Iterator<Item = &'a Step>) -> Outcome {
    let profile = DeviceProfile::reference();
    let (mut device, mut validator) = (Device::with_heap_size(profile.clone(), HEAP), Validator::new(profile));
    let (mut outcome, mut copied, mut asked) = (Outcome::default(), Vec::new(), Vec::new());
    for step in steps {
        match step {
            Step::Write(address, bytes) => {
                // No program writes where it does not know the address of.
                if asked.contains(address) && device.write(*address, bytes).is_ok() {
                    validator.track_write(vk::DeviceAddressRange { address: *address, size: bytes.len() as u64 });
                }
            }
            Step::Host(address, bytes) => drop(put_host(&mut device, *address, bytes)),
            Step::Call(call) => {
                ask_sizes(call, &mut device, &mut validator);
                tell_sizes(call, &mut copied, &device, &mut validator);
                outcome.reports += validator.check(call, &device).len();
                match device.execute(call) {
                    Ok(output) => {
                        outcome.calls += 1;
                        outcome.executed += usize::from(does_work(call));
                        validator.track(call, &output);
                        if let (Call::GetBufferDeviceAddress { .. }, Output::DeviceAddress(address)) =
                            (&**call, &output)
                        {
                            asked.push(*address);
                        }
                    }
                    // No driver would have given these handles to the program, or the device cannot do it.
                    Err(Undefined { why: Reason::HandleTaken { .. } | Reason::Unsupported { .. }, .. }) => {
                        return outcome;
                    }
                    Err(undefined) if is_of_the_past(&undefined) => return outcome,
                    Err(undefined) => {
                        outcome.undefined = Some((undefined, call.clone()));
                        return outcome;
                    }
                }
            }
        }
    }
    outcome
}

/// Whether the device stopped at what only the input of an earlier build tells, which no validator keeps: which instances and
/// primitives were active, and what the structures refer to that rays reach.
fn is_of_the_past(undefined: &Undefined) -> bool {
    match &undefined.why {
        Reason::Update { what, .. } => ["active primitives", "active instances"].contains(what),
        _ => undefined.at == "topLevel",
    }
}

/// Asks for the sizes of builds before they are called, so that the validator knows what the device needs.
fn ask_sizes(call: &Call, device: &mut Device, validator: &mut Validator) {
    let (infos, counts): (_, Vec<Option<Vec<u32>>>) = match call {
        Call::CmdBuildAccelerationStructures { infos, build_range_infos, .. }
        | Call::BuildAccelerationStructures { infos, build_range_infos, .. } => {
            let counts = |ranges: &Vec<vk::BuildRangeInfo>| ranges.iter().map(|range| range.primitive_count).collect();
            (infos, build_range_infos.iter().map(|ranges| ranges.as_ref().map(counts)).collect())
        }
        Call::CmdBuildAccelerationStructuresIndirect { infos, max_primitive_counts, .. } => {
            (infos, max_primitive_counts.clone())
        }
        Call::CmdBuildMicromaps { infos, .. } | Call::BuildMicromaps { infos, .. } => {
            for info in infos {
                let asked = vk::Device(1);
                let (build_type, build_info) = (build_type(call), info.clone());
                let asks = Call::GetMicromapBuildSizes { device: asked, build_type, build_info };
                if let Ok(output) = device.execute(&asks) {
                    validator.track(&asks, &output);
                }
            }
            return;
        }
        _ => return,
    };
    for (info, max_primitive_counts) in infos.iter().zip(counts) {
        let (asked, build_type, build_info) = (vk::Device(1), build_type(call), info.clone());
        let asks =
            Call::GetAccelerationStructureBuildSizes { device: asked, build_type, build_info, max_primitive_counts };
        if let Ok(output) = device.execute(&asks) {
            validator.track(&asks, &output);
        }
    }
}

/// Tells the sizes of what is copied, as a program that asks for them before each copy would be told.
fn tell_sizes(call: &Call, copied: &mut Vec<Call>, device: &Device, validator: &mut Validator) {
    let is_copy = |call: &Call| call.command().contains("Copy") && !call.command().contains("CopyMemoryTo");
    if is_copy(call) {
        copied.push(call.clone());
    }
    if !(is_copy(call) || does_work(call)) {
        return;
    }
    for copy in copied.iter() {
        match copy {
            Call::CmdCopyAccelerationStructure { info: vk::CopyAccelerationStructureInfo { src, .. }, .. }
            | Call::CopyAccelerationStructure { info: vk::CopyAccelerationStructureInfo { src, .. }, .. }
            | Call::CmdCopyAccelerationStructureToMemory {
                info: vk::CopyAccelerationStructureToMemoryInfo { src, .. },
                ..
            }
            | Call::CopyAccelerationStructureToMemory {
                info: vk::CopyAccelerationStructureToMemoryInfo { src, .. },
                ..
            } => {
                let header = device.acceleration_structure(*src).and_then(|found| header(device, found.address));
                let types = [
                    vk::QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE,
                    vk::QueryType::ACCELERATION_STRUCTURE_SERIALIZATION_SIZE,
                ];
                for (query_type, value) in types.into_iter().zip(header.into_iter().flatten()) {
                    let (acceleration_structures, data_size, stride) = (vec![*src], 8, 8);
                    let asked = Call::WriteAccelerationStructuresProperties {
                        device: vk::Device(1),
                        acceleration_structures,
                        query_type,
                        data_size,
                        stride,
                    };
                    validator.track(&asked, &Output::Properties(vec![value]));
                }
            }
            Call::CmdCopyMicromap { info: vk::CopyMicromapInfo { src, .. }, .. }
            | Call::CopyMicromap { info: vk::CopyMicromapInfo { src, .. }, .. }
            | Call::CmdCopyMicromapToMemory { info: vk::CopyMicromapToMemoryInfo { src, .. }, .. }
            | Call::CopyMicromapToMemory { info: vk::CopyMicromapToMemoryInfo { src, .. }, .. } => {
                let header = device.micromap(*src).and_then(|found| header(device, found.address));
                let types = [vk::QueryType::MICROMAP_COMPACTED_SIZE, vk::QueryType::MICROMAP_SERIALIZATION_SIZE];
                for (query_type, value) in types.into_iter().zip(header.into_iter().flatten()) {
                    let (micromaps, data_size, stride) = (vec![*src], 8, 8);
                    let asked = Call::WriteMicromapsProperties {
                        device: vk::Device(1),
                        micromaps,
                        query_type,
                        data_size,
                        stride,
                    };
                    validator.track(&asked, &Output::Properties(vec![value]));
                }
            }
            _ => {}
        }
    }
}

/// Compacted and serialized size of what lies at an address.
fn header(device: &Device, address: vk::DeviceAddress) -> Option<[u64; 2]> {
    let header = ObjectHeader::read(device.read(address, ObjectHeader::SIZE).ok()?).ok()?;
    Some([header.compacted_size, omm_serialize::serialized_size(&header)])
}

fn build_type(call: &Call) -> vk::AccelerationStructureBuildType {
    match call.timeline() {
        Timeline::Host => vk::AccelerationStructureBuildType::HOST,
        Timeline::Device => vk::AccelerationStructureBuildType::DEVICE,
    }
}

/// Whether a call executes something now.
fn does_work(call: &Call) -> bool {
    match call {
        Call::QueueSubmit { command_buffers, .. } => !command_buffers.is_empty(),
        Call::BuildAccelerationStructures { .. }
        | Call::BuildMicromaps { .. }
        | Call::CopyMicromap { .. }
        | Call::CopyMicromapToMemory { .. }
        | Call::CopyMemoryToMicromap { .. }
        | Call::DeferredOperationJoin { .. } => true,
        _ => false,
    }
}
