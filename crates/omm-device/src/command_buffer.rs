//! Command buffers: lists of recorded calls and the life cycle they go through.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use omm_model::call::{Call, Output};
use omm_model::vk;

use crate::undefined::{At, Reason, Stop};

/// Where a command buffer is in its life cycle. Nothing is ever pending: a submission has been executed when it returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CommandBufferState {
    /// Allocated, with nothing recorded.
    Initial,
    /// Between begin and end.
    Recording,
    /// Ended; can be submitted.
    Executable,
    /// Submitted once where only one submission was announced, or something that it names was destroyed.
    Invalid,
}

impl fmt::Display for CommandBufferState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Initial => "initial",
            Self::Recording => "recording",
            Self::Executable => "executable",
            Self::Invalid => "invalid",
        })
    }
}

#[derive(Debug)]
struct CommandBuffer {
    pool: vk::CommandPool,
    level: vk::CommandBufferLevel,
    state: CommandBufferState,
    flags: vk::CommandBufferUsageFlags,
    commands: Vec<Call>,
}

impl CommandBuffer {
    const fn is_one_time(&self) -> bool {
        self.flags.contains(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT)
    }

    /// The secondary command buffers that are executed, one after the other.
    fn secondary(&self) -> impl Iterator<Item = vk::CommandBuffer> {
        let executed = self.commands.iter().filter_map(|call| match call {
            Call::CmdExecuteCommands { command_buffers, .. } => Some(command_buffers),
            _ => None,
        });
        executed.flatten().copied()
    }
}

/// All command pools and command buffers of a device.
#[derive(Debug, Default)]
pub(crate) struct CommandBuffers {
    pools: BTreeMap<vk::CommandPool, vk::CommandPoolCreateInfo>,
    buffers: BTreeMap<vk::CommandBuffer, CommandBuffer>,
}

impl CommandBuffers {
    /// `vkCreateCommandPool`.
    pub(crate) fn create_pool(
        &mut self,
        info: &vk::CommandPoolCreateInfo,
        pool: vk::CommandPool,
    ) -> Result<Output, Stop> {
        if pool.is_null() || self.pools.contains_key(&pool) {
            return Err(Reason::HandleTaken { object: "command pool", handle: pool.0 }).at("pCommandPool");
        }
        self.pools.insert(pool, info.clone());
        Ok(Output::None)
    }

    /// `vkDestroyCommandPool`.
    pub(crate) fn destroy_pool(&mut self, pool: vk::CommandPool) -> Result<Output, Stop> {
        if !pool.is_null() {
            if self.pools.remove(&pool).is_none() {
                return Err(Reason::UnknownHandle { object: "command pool", handle: pool.0 }).at("commandPool");
            }
            let of_pool = |(&handle, buffer): (_, &CommandBuffer)| (buffer.pool == pool).then_some(handle);
            let freed: Vec<_> = self.buffers.iter().filter_map(of_pool).collect();
            freed.into_iter().for_each(|buffer| self.remove(buffer));
        }
        Ok(Output::None)
    }

    /// `vkAllocateCommandBuffers`.
    pub(crate) fn allocate(
        &mut self,
        info: &vk::CommandBufferAllocateInfo,
        buffers: &[vk::CommandBuffer],
    ) -> Result<Output, Stop> {
        let pool = info.command_pool;
        if !self.pools.contains_key(&pool) {
            return Err(Reason::UnknownHandle { object: "command pool", handle: pool.0 })
                .at("pAllocateInfo->commandPool");
        }
        let (found, required) = (buffers.len() as u64, info.command_buffer_count.into());
        if found != required {
            return Err(Reason::CountMismatch { found, required }).at("pCommandBuffers");
        }
        let mut new = BTreeSet::new();
        for (index, buffer) in buffers.iter().enumerate() {
            if buffer.is_null() || !new.insert(buffer) || self.buffers.contains_key(buffer) {
                let why = Reason::HandleTaken { object: "command buffer", handle: buffer.0 };
                return Err(why).at(format_args!("pCommandBuffers[{index}]"));
            }
        }
        for &buffer in buffers {
            let state = CommandBufferState::Initial;
            let flags = vk::CommandBufferUsageFlags::empty();
            let new = CommandBuffer { pool, level: info.level, state, flags, commands: Vec::new() };
            self.buffers.insert(buffer, new);
        }
        Ok(Output::None)
    }

    /// `vkFreeCommandBuffers`: all or none.
    pub(crate) fn free(&mut self, pool: vk::CommandPool, buffers: &[vk::CommandBuffer]) -> Result<Output, Stop> {
        if !self.pools.contains_key(&pool) {
            return Err(Reason::UnknownHandle { object: "command pool", handle: pool.0 }).at("commandPool");
        }
        let mut freed = BTreeSet::new();
        for (index, &buffer) in buffers.iter().enumerate().filter(|(_, buffer)| !buffer.is_null()) {
            let of_pool = self.buffers.get(&buffer).is_some_and(|found| found.pool == pool);
            if !of_pool || !freed.insert(buffer) {
                let why = Reason::UnknownHandle { object: "command buffer of the pool", handle: buffer.0 };
                return Err(why).at(format_args!("pCommandBuffers[{index}]"));
            }
        }
        freed.into_iter().for_each(|buffer| self.remove(buffer));
        Ok(Output::None)
    }

    fn remove(&mut self, buffer: vk::CommandBuffer) {
        self.buffers.remove(&buffer);
        self.invalidate(|call| executes(call, buffer));
    }

    /// `vkResetCommandBuffer`.
    pub(crate) fn reset(&mut self, buffer: vk::CommandBuffer) -> Result<Output, Stop> {
        let found = self.get(buffer).at("commandBuffer")?;
        found.state = CommandBufferState::Initial;
        found.commands.clear();
        self.invalidate(|call| executes(call, buffer));
        Ok(Output::None)
    }

    fn get(&mut self, buffer: vk::CommandBuffer) -> Result<&mut CommandBuffer, Reason> {
        self.buffers.get_mut(&buffer).ok_or(Reason::UnknownHandle { object: "command buffer", handle: buffer.0 })
    }

    /// The command buffer, if it is in that state.
    fn in_state(
        &mut self,
        buffer: vk::CommandBuffer,
        required: CommandBufferState,
    ) -> Result<&mut CommandBuffer, Reason> {
        let found = self.get(buffer)?;
        if found.state == required {
            Ok(found)
        } else {
            Err(Reason::CommandBufferState { command_buffer: buffer.0, found: found.state, required })
        }
    }

    /// `vkBeginCommandBuffer`, which also resets a command buffer that is not being recorded.
    pub(crate) fn begin(
        &mut self,
        buffer: vk::CommandBuffer,
        info: &vk::CommandBufferBeginInfo,
    ) -> Result<Output, Stop> {
        let found = self.get(buffer).at("commandBuffer")?;
        if found.state == CommandBufferState::Recording {
            let (found, required) = (found.state, CommandBufferState::Initial);
            return Err(Reason::CommandBufferState { command_buffer: buffer.0, found, required }).at("commandBuffer");
        }
        found.state = CommandBufferState::Recording;
        found.flags = info.flags;
        found.commands.clear();
        self.invalidate(|call| executes(call, buffer));
        Ok(Output::None)
    }

    /// `vkEndCommandBuffer`.
    pub(crate) fn end(&mut self, buffer: vk::CommandBuffer) -> Result<Output, Stop> {
        self.in_state(buffer, CommandBufferState::Recording).at("commandBuffer")?.state =
            CommandBufferState::Executable;
        Ok(Output::None)
    }

    /// Any command that is recorded.
    pub(crate) fn record(&mut self, buffer: vk::CommandBuffer, call: &Call) -> Result<Output, Stop> {
        let found = self.in_state(buffer, CommandBufferState::Recording).at("commandBuffer")?;
        found.commands.push(call.clone());
        Ok(Output::None)
    }

    /// Requires a primary command buffer, and secondary ones that can be executed in it.
    pub(crate) fn check_execution(
        &self,
        primary: vk::CommandBuffer,
        secondary: &[vk::CommandBuffer],
    ) -> Result<(), Stop> {
        let level = self.buffers.get(&primary).map_or(vk::CommandBufferLevel::PRIMARY, |found| found.level);
        if level != vk::CommandBufferLevel::PRIMARY {
            let (command_buffer, required) = (primary.0, vk::CommandBufferLevel::PRIMARY);
            return Err(Reason::CommandBufferLevel { command_buffer, found: level, required }).at("commandBuffer");
        }
        secondary.iter().enumerate().try_for_each(|(index, &buffer)| {
            let required = vk::CommandBufferLevel::SECONDARY;
            self.check_executable(buffer, required).at(format_args!("pCommandBuffers[{index}]"))
        })
    }

    fn check_executable(&self, buffer: vk::CommandBuffer, required: vk::CommandBufferLevel) -> Result<(), Reason> {
        let unknown = Reason::UnknownHandle { object: "command buffer", handle: buffer.0 };
        let &CommandBuffer { level: found, state, .. } = self.buffers.get(&buffer).ok_or(unknown)?;
        if found != required {
            return Err(Reason::CommandBufferLevel { command_buffer: buffer.0, found, required });
        }
        let required = CommandBufferState::Executable;
        if state != required {
            return Err(Reason::CommandBufferState { command_buffer: buffer.0, found: state, required });
        }
        Ok(())
    }

    /// Requires every command buffer to be executable when its turn comes.
    pub(crate) fn check_submission(&self, buffers: &[vk::CommandBuffer]) -> Result<(), Stop> {
        let mut seen = BTreeSet::new();
        buffers.iter().enumerate().try_for_each(|(index, &buffer)| {
            let primary = vk::CommandBufferLevel::PRIMARY;
            let result = self.check_executable(buffer, primary).and_then(|()| self.check_once(buffer, &mut seen));
            result.at(format_args!("pCommandBuffers[{index}]"))
        })
    }

    /// Requires a command buffer that is announced to be submitted once, and those that it executes, not to have been seen.
    fn check_once(&self, buffer: vk::CommandBuffer, seen: &mut BTreeSet<vk::CommandBuffer>) -> Result<(), Reason> {
        let Some(found) = self.buffers.get(&buffer) else {
            return Ok(());
        };
        if found.is_one_time() && !seen.insert(buffer) {
            let (found, required) = (CommandBufferState::Invalid, CommandBufferState::Executable);
            return Err(Reason::CommandBufferState { command_buffer: buffer.0, found, required });
        }
        // Only primary ones execute others, so this ends.
        found.secondary().try_for_each(|secondary| self.check_once(secondary, seen))
    }

    /// The commands of a command buffer that is to be executed; [`CommandBuffers::put_back`] brings them back.
    pub(crate) fn take(&mut self, buffer: vk::CommandBuffer) -> Vec<Call> {
        self.buffers.get_mut(&buffer).map(|found| std::mem::take(&mut found.commands)).unwrap_or_default()
    }

    /// Brings the commands back unchanged.
    pub(crate) fn put_back(&mut self, buffer: vk::CommandBuffer, commands: Vec<Call>) {
        if let Some(found) = self.buffers.get_mut(&buffer) {
            found.commands = commands;
        }
    }

    /// Makes a command buffer invalid if it was announced to be submitted once, and likewise those that it executed.
    pub(crate) fn executed(&mut self, buffer: vk::CommandBuffer) {
        let Some(found) = self.buffers.get_mut(&buffer) else {
            return;
        };
        let secondary: Vec<_> = found.secondary().collect();
        if found.is_one_time() {
            found.state = CommandBufferState::Invalid;
            self.invalidate(|call| executes(call, buffer));
        }
        secondary.into_iter().for_each(|buffer| self.executed(buffer));
    }

    /// Makes the command buffers invalid that recorded a command for which `names` holds, because what it names is destroyed, and
    /// those that execute them.
    pub(crate) fn invalidate(&mut self, names: impl Fn(&Call) -> bool) {
        let named = |(&handle, buffer): (_, &CommandBuffer)| buffer.commands.iter().any(&names).then_some(handle);
        let mut invalid: Vec<_> = self.buffers.iter().filter_map(named).collect();
        while let Some(buffer) = invalid.pop() {
            if let Some(found) = self.buffers.get_mut(&buffer) {
                found.state = CommandBufferState::Invalid;
                found.commands.clear();
            }
            let named = |(&handle, found): (_, &CommandBuffer)| {
                found.commands.iter().any(|call| executes(call, buffer)).then_some(handle)
            };
            invalid.extend(self.buffers.iter().filter_map(named));
        }
    }
}

/// Whether a command executes a secondary command buffer.
fn executes(call: &Call, buffer: vk::CommandBuffer) -> bool {
    matches!(call, Call::CmdExecuteCommands { command_buffers, .. } if command_buffers.contains(&buffer))
}
