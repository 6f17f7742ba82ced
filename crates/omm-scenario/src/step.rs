//! What a scenario does: words that stand for one command each, and what goes around it.
//!
//! A recorded command gets a command buffer of its own, which is begun before it and ended and submitted after it. `only(…)` leaves
//! that out; `record([…])` puts several commands into one command buffer. `host(…)` turns a recorded command into its form for the
//! host, deferred if an operation is named; `indirect(…)` turns a build into its indirect form.

mod copy;
mod host;
mod outline;
mod query;

use omm_model::call::Call;
use omm_model::vk;

pub(crate) use outline::{count, made_by};
use outline::{set, title};

use crate::error::Mistake;
use crate::node::{Arguments, Node};
use crate::transcript::Outcome;
use crate::world::{DEVICE, Handle, QUEUE, Recipe, World};

/// The words that a step can begin with.
pub(crate) const VERBS: &[&str] = &[
    "build",
    "update",
    "sizes",
    "create",
    "destroy",
    "clone",
    "compact",
    "serialize",
    "deserialize",
    "query",
    "compatibility",
    "address",
    "write",
    "record",
    "host",
    "indirect",
    "join",
    "only",
    "begin",
    "end",
    "submit",
];

/// The arguments of most words: an object and changes to the call.
const OBJECT: &[&str] = &["object", "set"];

/// One command of a step.
pub(crate) struct Plan {
    /// Recorded before it into the same command buffer.
    before: Vec<Call>,
    call: Call,
    /// Issued once it has executed.
    after: Vec<Call>,
    /// The name and the handle of the object that it creates.
    creates: Option<(String, u64)>,
}

impl From<Call> for Plan {
    fn from(call: Call) -> Self {
        Self { before: Vec::new(), call, after: Vec::new(), creates: None }
    }
}

impl World {
    /// Takes one step.
    pub(crate) fn step(&mut self, node: &Node) -> Result<(), Mistake> {
        self.group.name = title(node);
        match node.head() {
            Some("write") => self.write_step(node),
            Some("record") => self.record(node),
            Some("only") => {
                let step = Arguments::of(node, &["step"])?.need("step")?;
                let plan = self.plan(step, vk::CommandBuffer::NULL)?;
                self.main(plan);
                Ok(())
            }
            _ => self.wrapped(node),
        }
    }

    /// A step with what goes around it.
    fn wrapped(&mut self, node: &Node) -> Result<(), Mistake> {
        // Only a recorded command needs a command buffer, which is known once there is a plan.
        let recorded = self.records(node);
        let command_buffer = if recorded { self.begin(node)? } else { vk::CommandBuffer::NULL };
        let Plan { before, call, after, creates } = self.plan(node, command_buffer)?;
        for call in &before {
            self.prepare(call, node)?;
        }
        if self.main(Plan { before: Vec::new(), call, after: Vec::new(), creates }) {
            return Ok(());
        }
        if recorded && matches!(self.submit(command_buffer), Outcome::Undefined(_)) {
            self.stopped = true;
            return Ok(());
        }
        for call in &after {
            if let Outcome::Undefined(_) = self.issue(call, true) {
                self.stopped = true;
                break;
            }
        }
        Ok(())
    }

    /// Issues the command itself; tells whether the device stopped.
    fn main(&mut self, plan: Plan) -> bool {
        match self.issue(&plan.call, true) {
            Outcome::Undefined(_) => self.stopped = true,
            Outcome::Output(output) => {
                if let Some((name, handle)) = plan.creates {
                    self.name_created(&name, &plan.call, handle, &output);
                }
            }
        }
        self.stopped
    }

    /// Whether a step is a recorded command.
    fn records(&self, node: &Node) -> bool {
        match node.head() {
            Some("build" | "update" | "clone" | "compact" | "serialize" | "deserialize" | "query") => true,
            Some("indirect") => true,
            Some(head) => head.starts_with("vkCmd"),
            None => false,
        }
    }

    /// `record([step, …])`: several commands in one command buffer.
    fn record(&mut self, node: &Node) -> Result<(), Mistake> {
        let steps = Arguments::of(node, &["steps"])?.need("steps")?.list()?;
        let command_buffer = self.begin(node)?;
        let mut after = Vec::new();
        for step in steps {
            if !self.records(step) {
                return Err(step.mistake("only commands that are recorded can stand here"));
            }
            let plan = self.plan(step, command_buffer)?;
            for call in &plan.before {
                self.prepare(call, step)?;
            }
            after.extend(plan.after.iter().cloned());
            if self.main(plan) {
                return Ok(());
            }
        }
        if let Outcome::Undefined(_) = self.submit(command_buffer) {
            self.stopped = true;
            return Ok(());
        }
        for call in &after {
            if let Outcome::Undefined(_) = self.issue(call, true) {
                self.stopped = true;
                break;
            }
        }
        Ok(())
    }

    /// What a step does, with its changes made.
    fn plan(&mut self, node: &Node, command_buffer: vk::CommandBuffer) -> Result<Plan, Mistake> {
        match node.head() {
            Some("host") => {
                let arguments = Arguments::of(node, &["step", "operation"])?;
                let step = arguments.need("step")?;
                let operation = arguments.get("operation").map(|name| self.typed(name)).transpose()?;
                let Plan { call, .. } = self.unchanged(step, vk::CommandBuffer::NULL)?;
                let call = self.on_host(call, operation.unwrap_or_default(), step)?;
                Ok(self.changed(call, set(step), step)?.into())
            }
            Some("indirect") => {
                let step = Arguments::of(node, &["step"])?.need("step")?;
                let Plan { call, .. } = self.unchanged(step, command_buffer)?;
                let call = self.indirect(call, step)?;
                Ok(self.changed(call, set(step), step)?.into())
            }
            Some(head) if head.starts_with("vk") => {
                let (call, handle) = self.raw_call(node, command_buffer)?;
                let name = Arguments::of(node, &["set", "name"])?.get("name").map(Node::text).transpose()?;
                Ok(Plan { creates: name.map(|name| (name.to_owned(), handle)), ..call.into() })
            }
            _ => {
                let mut plan = self.unchanged(node, command_buffer)?;
                plan.call = self.changed(plan.call, set(node), node)?;
                Ok(plan)
            }
        }
    }

    /// What a step does before its changes are made.
    fn unchanged(&mut self, node: &Node, command_buffer: vk::CommandBuffer) -> Result<Plan, Mistake> {
        let head = node.head().unwrap_or_default();
        Ok(match head {
            "build" => {
                let arguments = Arguments::of(node, OBJECT)?;
                let names = arguments.need("object")?.one_or_more();
                let names = names.iter().map(Node::text).collect::<Result<Vec<_>, _>>()?;
                self.build_call(&names, command_buffer, arguments.need("object")?)?.into()
            }
            "update" => {
                let name = self.object(node)?;
                let mut call = self.build_call(&[name.text()?], command_buffer, name)?;
                if let Call::CmdBuildAccelerationStructures { infos, .. } = &mut call {
                    for info in infos {
                        info.mode = vk::BuildAccelerationStructureMode::UPDATE;
                        info.src_acceleration_structure = info.dst_acceleration_structure;
                    }
                }
                call.into()
            }
            "sizes" => {
                let name = self.object(node)?;
                let recipe = self.structure(name.text()?, name)?.recipe.as_ref();
                let message = "nothing says what it is built from";
                recipe.map(Recipe::sizes).ok_or_else(|| name.mistake(message))?.into()
            }
            "create" => {
                let name = self.object(node)?;
                self.structure(name.text()?, name)?.create_call().into()
            }
            "address" => {
                let name = self.object(node)?;
                let handle = self.objects.handle("AccelerationStructure", name.text()?);
                let handle = handle.map_err(|unknown| crate::change::unknown(name, unknown))?;
                let acceleration_structure = vk::AccelerationStructure(handle);
                let info = vk::AccelerationStructureDeviceAddressInfo { acceleration_structure, ..Default::default() };
                Call::GetAccelerationStructureDeviceAddress { device: DEVICE, info }.into()
            }
            "destroy" => self.destroy(self.object(node)?)?.into(),
            "clone" | "compact" => self.copy(head, node, command_buffer)?.into(),
            "serialize" => self.serialize(node, command_buffer)?.into(),
            "deserialize" => self.deserialize(node, command_buffer)?.into(),
            "compatibility" => self.compatibility(node)?.into(),
            "query" => self.query(node, command_buffer)?,
            "begin" | "end" => {
                let name = self.object(node)?;
                let command_buffer = self.command_buffer_of(name)?;
                match head {
                    "begin" => {
                        let begin_info = vk::CommandBufferBeginInfo::default();
                        Call::BeginCommandBuffer { command_buffer, begin_info }.into()
                    }
                    _ => Call::EndCommandBuffer { command_buffer }.into(),
                }
            }
            "join" => {
                let operation = self.typed(self.object(node)?)?;
                Call::DeferredOperationJoin { device: DEVICE, operation }.into()
            }
            "submit" => {
                let arguments = Arguments::of(node, OBJECT)?;
                let names = arguments.need("object")?.one_or_more();
                let command_buffers =
                    names.iter().map(|name| self.command_buffer_of(name)).collect::<Result<_, _>>()?;
                Call::QueueSubmit { queue: QUEUE, command_buffers }.into()
            }
            _ => {
                let mistake = node.mistake(format!("{} is no step", node.describe()));
                return Err(mistake.nearest(head, VERBS.iter().copied()));
            }
        })
    }

    /// The object that a word is about.
    fn object<'n>(&self, node: &'n Node) -> Result<&'n Node, Mistake> {
        Arguments::of(node, OBJECT)?.need("object")
    }

    fn command_buffer_of(&self, name: &Node) -> Result<vk::CommandBuffer, Mistake> {
        let handle = self.objects.handle("CommandBuffer", name.text()?);
        handle.map(vk::CommandBuffer).map_err(|unknown| crate::change::unknown(name, unknown))
    }

    /// The command that destroys an object.
    fn destroy(&self, name: &Node) -> Result<Call, Mistake> {
        let device = DEVICE;
        if let Some(structure) = self.structures.get(name.text()?) {
            return Ok(match structure.handle {
                Handle::AccelerationStructure(acceleration_structure) => {
                    Call::DestroyAccelerationStructure { device, acceleration_structure }
                }
                Handle::Micromap(micromap) => Call::DestroyMicromap { device, micromap },
            });
        }
        let object = self.objects.get(name.text()?).map_err(|unknown| crate::change::unknown(name, unknown))?;
        let (type_name, handle) = object.handles.first().copied().unwrap_or_default();
        Ok(match type_name {
            "Buffer" => Call::DestroyBuffer { device, buffer: vk::Buffer(handle) },
            "QueryPool" => Call::DestroyQueryPool { device, query_pool: vk::QueryPool(handle) },
            "CommandBuffer" => {
                let command_pool = vk::CommandPool(object.handle("CommandPool").unwrap_or_default());
                Call::FreeCommandBuffers { device, command_pool, command_buffers: vec![vk::CommandBuffer(handle)] }
            }
            "DeviceMemory" => Call::FreeMemory { device, memory: vk::DeviceMemory(handle) },
            "DeferredOperation" => Call::DestroyDeferredOperation { device, operation: vk::DeferredOperation(handle) },
            "Pipeline" => Call::DestroyPipeline { device, pipeline: vk::Pipeline(handle) },
            "Shader" => Call::DestroyShader { device, shader: vk::Shader(handle) },
            "Device" => Call::DestroyDevice { device: vk::Device(handle) },
            _ => return Err(name.mistake("nothing destroys this")),
        })
    }

    /// `write("leaf.data + 1", bytes)`
    fn write_step(&mut self, node: &Node) -> Result<(), Mistake> {
        let arguments = Arguments::of(node, &["to", "bytes"])?;
        let to = arguments.need("to")?;
        let address = self.objects.address(to.text()?).map_err(|unknown| crate::change::unknown(to, unknown))?;
        let bytes = crate::given::bytes(arguments.need("bytes")?, &self.objects)?;
        if address.host {
            return Err(to.mistake("this lies in host memory"));
        }
        self.group.description = format!("{} bytes", bytes.len());
        self.write(address.value, &bytes, to)
    }
}
