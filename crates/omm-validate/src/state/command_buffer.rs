//! What command buffers hold: the effects that their commands will have.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use omm_model::call::{Call, RenderingInfo};
use omm_model::vk;

use super::{Built, State};
use crate::context::command_at;
use crate::location::Object;
use crate::own::named::each_object;

/// Where a command buffer is in its life.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum RecordingState {
    /// Nothing is recorded.
    #[default]
    Initial,
    /// Between begin and end.
    Recording,
    /// Ended; can be submitted.
    Executable,
    /// Submitted, and allowed to be only once; or something that it names is gone.
    Invalid,
}

impl std::fmt::Display for RecordingState {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Initial => "initial",
            Self::Recording => "recording",
            Self::Executable => "executable",
            Self::Invalid => "invalid",
        })
    }
}

/// A command pool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct CommandPoolState {
    /// The family of the queues that its command buffers are submitted to.
    pub queue_family_index: u32,
}

/// A command buffer.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct CommandBufferState {
    /// The pool that it comes from, if its allocation was seen.
    pub command_pool: Option<vk::CommandPool>,
    /// Primary or secondary.
    pub level: vk::CommandBufferLevel,
    /// Where it is in its life.
    pub recording: RecordingState,
    /// How it is used, as told when recording began.
    pub usage: vk::CommandBufferUsageFlags,
    /// Whether the next command stands inside a render pass instance.
    pub in_render_pass: bool,
    /// Whether the last render pass instance was suspended and none has resumed it.
    pub is_suspended: bool,
    /// The commands, in order, that do something when they execute.
    pub(super) calls: Arc<Vec<(Call, u64)>>,
    /// The objects that they name.
    names: Arc<BTreeSet<Object>>,
    effects: Arc<Vec<Effect>>,
    /// The last effect on each acceleration structure.
    last: Arc<BTreeMap<vk::AccelerationStructure, usize>>,
}

/// What a command will do to an acceleration structure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Effect {
    /// Build it.
    Build { dst: vk::AccelerationStructure, built: Built },
    /// Fill it with what another holds.
    Copy {
        src: vk::AccelerationStructure,
        dst: vk::AccelerationStructure,
        /// The effect of this command buffer that filled the other, if there is one.
        filled_by: Option<usize>,
    },
    /// Fill it with serialized data.
    Deserialize { dst: vk::AccelerationStructure },
}

impl Effect {
    const fn dst(&self) -> vk::AccelerationStructure {
        match self {
            Self::Build { dst, .. } | Self::Copy { dst, .. } | Self::Deserialize { dst } => *dst,
        }
    }
}

/// What a command buffer says about the contents of an acceleration structure.
pub(super) enum Recorded<'a> {
    /// It builds them.
    Built(&'a Built),
    /// It fills them with what is not known.
    Unknown,
    /// They are what this structure held when the command buffer was submitted.
    Elsewhere(vk::AccelerationStructure),
}

impl CommandBufferState {
    /// A new one.
    pub(super) fn allocated(command_pool: vk::CommandPool, level: vk::CommandBufferLevel) -> Self {
        Self { command_pool: Some(command_pool), level, ..Self::default() }
    }

    /// One that is being recorded, of which nothing else was seen.
    pub(super) fn midway() -> Self {
        Self { recording: RecordingState::Recording, ..Self::default() }
    }

    /// Forgets what is recorded.
    pub(super) fn reset(&mut self) {
        self.effects = Arc::default();
        self.last = Arc::default();
        self.calls = Arc::default();
        self.names = Arc::default();
        self.recording = RecordingState::Initial;
        (self.in_render_pass, self.is_suspended) = (false, false);
    }

    /// Forgets what is recorded and starts anew.
    pub(super) fn begin(&mut self, usage: vk::CommandBufferUsageFlags) {
        self.reset();
        self.usage = usage;
        self.recording = RecordingState::Recording;
        self.in_render_pass = self.level == vk::CommandBufferLevel::SECONDARY
            && usage.contains(vk::CommandBufferUsageFlags::RENDER_PASS_CONTINUE);
    }

    pub(super) fn begin_rendering(&mut self, info: &RenderingInfo) {
        self.in_render_pass = true;
        self.is_suspended = info.flags.contains(vk::RenderingFlags::SUSPENDING);
    }

    pub(super) fn end_rendering(&mut self) {
        self.in_render_pass = false;
    }

    /// Keeps a call and the time at which it was recorded.
    pub(super) fn record_call(&mut self, call: &Call, serial: u64) {
        let own = call.recorded_into().map(|it| (vk::CommandBuffer::OBJECT_TYPE, it.0));
        let names = Arc::make_mut(&mut self.names);
        each_object(call, &command_at(call), &mut |_, object, _| {
            if Some(object) != own {
                names.insert(object);
            }
        });
        Arc::make_mut(&mut self.calls).push((call.clone(), serial));
    }

    /// Whether a command recorded so far names an object.
    pub(super) fn names(&self, object: Object) -> bool {
        self.names.contains(&object)
    }

    /// Forgets what the commands will have done, where they are carried out one by one.
    pub(super) fn forget_effects(&mut self) {
        self.effects = Arc::default();
        self.last = Arc::default();
    }

    /// The commands, in order, that do something when they execute.
    pub(super) fn calls(&self) -> Arc<Vec<(Call, u64)>> {
        Arc::clone(&self.calls)
    }

    /// Whether a command recorded so far serializes a micromap object to that address, where its data is once it has executed.
    pub(crate) fn serializes_micromap_to(&self, address: vk::DeviceOrHostAddress) -> bool {
        let serializes =
            |call: &Call| matches!(call, Call::CmdCopyMicromapToMemory { info, .. } if info.dst == address);
        self.calls.iter().any(|(call, _)| serializes(call))
    }

    pub(super) fn record_build(&mut self, dst: vk::AccelerationStructure, built: Built) {
        self.record(Effect::Build { dst, built });
    }

    pub(super) fn record_update(&mut self, src: vk::AccelerationStructure, dst: vk::AccelerationStructure) {
        if src != dst {
            self.record_copy(src, dst);
        }
    }

    pub(super) fn record_copy(&mut self, src: vk::AccelerationStructure, dst: vk::AccelerationStructure) {
        self.record(Effect::Copy { src, dst, filled_by: self.last.get(&src).copied() });
    }

    pub(super) fn record_deserialize(&mut self, dst: vk::AccelerationStructure) {
        self.record(Effect::Deserialize { dst });
    }

    fn record(&mut self, effect: Effect) {
        Arc::make_mut(&mut self.last).insert(effect.dst(), self.effects.len());
        Arc::make_mut(&mut self.effects).push(effect);
    }

    /// What the commands so far make of `handle`.
    pub(super) fn contents(&self, mut handle: vk::AccelerationStructure) -> Recorded<'_> {
        let mut effect = self.last.get(&handle).copied();
        // A copy refers to an earlier effect, so this ends.
        while let Some(found) = effect.and_then(|index| self.effects.get(index)) {
            match found {
                Effect::Build { built, .. } => return Recorded::Built(built),
                Effect::Deserialize { .. } => return Recorded::Unknown,
                Effect::Copy { src, filled_by, .. } => (handle, effect) = (*src, *filled_by),
            }
        }
        Recorded::Elsewhere(handle)
    }
}

impl State {
    /// The family of the queues that a command buffer is submitted to, if its pool is known.
    #[must_use]
    pub fn queue_family(&self, command_buffer: vk::CommandBuffer) -> Option<u32> {
        let pool = self.command_buffer(command_buffer)?.command_pool?;
        Some(self.command_pool(pool)?.queue_family_index)
    }

    /// What the queues can do that a command buffer is submitted to, if its pool and the family are known.
    #[must_use]
    pub fn queue_flags(&self, command_buffer: vk::CommandBuffer) -> Option<vk::QueueFlags> {
        Some(self.profile.queue_family(self.queue_family(command_buffer)?)?.queue_flags)
    }
}
