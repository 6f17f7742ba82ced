//! What a scenario runs in: a simulated device, a validator that looks over its shoulder, and the objects made so far.

mod buffer;
mod recording;
mod structure;

use std::collections::{BTreeMap, BTreeSet};

use omm_device::Device;
use omm_model::call::{Call, Output};
use omm_model::profile::DeviceProfile;
use omm_model::vk;
use omm_serialize::trace::Event;
use omm_validate::{RuleId, Validator};

use crate::error::Mistake;
use crate::given::MicromapTriangles;
use crate::limits;
use crate::node::Node;
use crate::objects::{Object, Objects};
use crate::transcript::{CallRecord, Group, Outcome};

pub(crate) use buffer::{BufferRequest, INPUT};
pub(crate) use structure::{Handle, Preparation, Recipe, Storage, Structure};

/// The device of a scenario, as long as it makes no other.
pub(crate) const DEVICE: vk::Device = vk::Device(1);
/// Its queue.
pub(crate) const QUEUE: vk::Queue = vk::Queue(2);
/// What it is a device of.
pub(crate) const PHYSICAL_DEVICE: vk::PhysicalDevice = vk::PhysicalDevice(3);

/// Everything that a scenario has made.
pub(crate) struct World {
    pub(crate) device: Device,
    validator: Validator,
    pub(crate) objects: Objects,
    pub(crate) structures: BTreeMap<String, Structure>,
    /// Level and format of each triangle of the declared micromaps.
    pub(crate) micromaps: BTreeMap<String, MicromapTriangles>,
    command_pool: Option<vk::CommandPool>,
    /// What is done at the moment.
    pub(crate) group: Group,
    /// The rules that were reported so far.
    pub(crate) reported: BTreeSet<RuleId>,
    /// Whether the device has stopped.
    pub(crate) stopped: bool,
    /// Whether something was asked of the device that it does not simulate, so that it knows less than the validator.
    pub(crate) unsupported: bool,
    /// What was done so far, where somebody wants to know.
    pub(crate) events: Option<Vec<Event>>,
    budget: Budget,
}

/// How much may still be made.
#[derive(Clone, Copy, Debug)]
struct Budget {
    primitives: u64,
    microtriangles: u64,
    bytes: u64,
}

/// What is taken out of the budget.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Cost {
    Primitives,
    Microtriangles,
    Bytes,
}

impl World {
    pub(crate) fn new(profile: DeviceProfile) -> Self {
        let mut objects = Objects::default();
        let known = [("device", "Device", DEVICE.0), ("queue", "Queue", QUEUE.0)];
        for (name, type_name, handle) in known.into_iter().chain([("gpu", "PhysicalDevice", PHYSICAL_DEVICE.0)]) {
            objects.insert(Object { name: name.to_owned(), handles: vec![(type_name, handle)], place: None });
        }
        Self {
            device: Device::with_heap_size(profile.clone(), limits::HEAP),
            validator: Validator::new(profile),
            objects,
            structures: BTreeMap::new(),
            micromaps: BTreeMap::new(),
            command_pool: None,
            group: Group::default(),
            reported: BTreeSet::new(),
            stopped: false,
            unsupported: false,
            events: None,
            budget: Budget {
                primitives: limits::PRIMITIVES,
                microtriangles: limits::MICROTRIANGLES,
                bytes: limits::BYTES,
            },
        }
    }

    pub(crate) fn profile(&self) -> &DeviceProfile {
        self.device.profile()
    }

    /// A handle that nothing has.
    pub(crate) fn handle(&mut self) -> u64 {
        self.objects.new_handle()
    }

    /// Takes `count` out of the budget, or refuses it at `node`.
    pub(crate) fn spend(&mut self, cost: Cost, count: u64, node: &Node) -> Result<(), Mistake> {
        self.afford(cost, count, node)?;
        let left = match cost {
            Cost::Primitives => &mut self.budget.primitives,
            Cost::Microtriangles => &mut self.budget.microtriangles,
            Cost::Bytes => &mut self.budget.bytes,
        };
        *left = left.saturating_sub(count);
        Ok(())
    }

    /// Refuses `count` at `node` if it is more than the budget has left.
    pub(crate) fn afford(&self, cost: Cost, count: u64, node: &Node) -> Result<(), Mistake> {
        let (left, what) = match cost {
            Cost::Primitives => (self.budget.primitives, "triangles, boxes and instances"),
            Cost::Microtriangles => (self.budget.microtriangles, "microtriangles"),
            Cost::Bytes => (self.budget.bytes, "bytes"),
        };
        match count <= left {
            true => Ok(()),
            false => Err(node.mistake(format!("{count} {what} are more than the {left} that a scenario has left"))),
        }
    }

    /// Issues a call: the validator looks at it, the device executes it, the record keeps what they say.
    pub(crate) fn issue(&mut self, call: &Call, is_main: bool) -> Outcome {
        self.note(|| call.clone().into());
        let report = self.validator.check(call, &self.device);
        let outcome = match self.device.execute(call) {
            Ok(output) => {
                self.validator.track(call, &output);
                Outcome::Output(output)
            }
            Err(undefined) => {
                self.unsupported |= undefined.is_unsupported();
                Outcome::Undefined(Box::new(undefined))
            }
        };
        self.reported.extend(report.iter().map(|violation| violation.rule));
        self.group.calls.push(CallRecord::new(call, is_main, &report, &outcome, &self.objects));
        outcome
    }

    /// Issues a call that prepares something, which has to succeed.
    pub(crate) fn prepare(&mut self, call: &Call, node: &Node) -> Result<Output, Mistake> {
        match self.issue(call, false) {
            Outcome::Output(Output::Result(result)) if result.is_error() => {
                Err(node.mistake(format!("this cannot be prepared: {} returned {result:?}", call.command())))
            }
            Outcome::Output(output) => Ok(output),
            // What has a meaning and is only not simulated is there for the validator.
            Outcome::Undefined(undefined) if undefined.is_unsupported() => {
                self.tell(call, &Output::None);
                if let Some(record) = self.group.calls.last_mut() {
                    record.is_undefined = false;
                }
                Ok(Output::None)
            }
            Outcome::Undefined(undefined) => {
                let undefined = self.objects.named(&undefined.to_string());
                Err(node.mistake(format!("this cannot be prepared: {undefined}")))
            }
        }
    }

    /// Lets the validator know of a call that the device cannot take part in.
    pub(crate) fn tell(&mut self, call: &Call, output: &Output) {
        self.validator.track(call, output);
    }

    /// A new command buffer that is being recorded.
    pub(crate) fn begin(&mut self, node: &Node) -> Result<vk::CommandBuffer, Mistake> {
        let command_pool = match self.command_pool {
            Some(pool) => pool,
            None => {
                let command_pool = vk::CommandPool(self.handle());
                let flags = vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER;
                let create_info = vk::CommandPoolCreateInfo { flags, ..Default::default() };
                self.prepare(&Call::CreateCommandPool { device: DEVICE, create_info, command_pool }, node)?;
                self.command_pool = Some(command_pool);
                command_pool
            }
        };
        let command_buffer = vk::CommandBuffer(self.handle());
        let allocate_info =
            vk::CommandBufferAllocateInfo { command_pool, command_buffer_count: 1, ..Default::default() };
        let command_buffers = vec![command_buffer];
        self.prepare(&Call::AllocateCommandBuffers { device: DEVICE, allocate_info, command_buffers }, node)?;
        let flags = vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT;
        let begin_info = vk::CommandBufferBeginInfo { flags, ..Default::default() };
        self.prepare(&Call::BeginCommandBuffer { command_buffer, begin_info }, node)?;
        Ok(command_buffer)
    }

    /// Ends and submits a command buffer. What was recorded may be more than the device can give a meaning to.
    pub(crate) fn submit(&mut self, command_buffer: vk::CommandBuffer) -> Outcome {
        match self.issue(&Call::EndCommandBuffer { command_buffer }, false) {
            Outcome::Output(_) => {
                self.issue(&Call::QueueSubmit { queue: QUEUE, command_buffers: vec![command_buffer] }, false)
            }
            undefined => undefined,
        }
    }

    /// Bytes of device memory.
    pub(crate) fn read(&self, address: u64, size: u64) -> Option<&[u8]> {
        use omm_model::memory::MemoryView as _;
        self.device.read(vk::DeviceAddress(address), size).ok()
    }

    /// Changes bytes of device memory, as an application that has it mapped.
    pub(crate) fn write(&mut self, address: u64, bytes: &[u8], node: &Node) -> Result<(), Mistake> {
        self.spend(Cost::Bytes, bytes.len() as u64, node)?;
        let written = self.write_mapped(vk::DeviceAddress(address), bytes);
        written.map_err(|error| node.mistake(self.objects.named(&error.to_string())))
    }
}
