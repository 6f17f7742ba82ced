//! What becomes of objects and command buffers when something else changes.

use omm_model::call::Call;
use omm_model::vk;

use super::{CommandBufferState, MemorySpan, RecordingState, State, Storage};
use crate::location::Object;

/// How what is executed relates to what was checked before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Age {
    /// It is called now.
    New,
    /// It was recorded or deferred, and nothing it could depend on has changed since.
    Unchanged,
    /// It was recorded or deferred, and something has changed since.
    Changed,
}

/// Whether a call can change what a command finds that was recorded before it.
pub(super) const fn changes(call: &Call) -> bool {
    !(call.recorded_into().is_some()
        || matches!(
            call,
            Call::BeginCommandBuffer { .. }
                | Call::EndCommandBuffer { .. }
                | Call::ResetCommandBuffer { .. }
                | Call::CreateBuffer { .. }
                | Call::AllocateMemory { .. }
                | Call::CreateCommandPool { .. }
                | Call::AllocateCommandBuffers { .. }
                | Call::CreateQueryPool { .. }
                | Call::CreateAccelerationStructure { .. }
                | Call::CreateAccelerationStructure2 { .. }
                | Call::CreateMicromap { .. }
                | Call::CreateDeferredOperation { .. }
                | Call::GetBufferDeviceAddress { .. }
                | Call::GetAccelerationStructureDeviceAddress { .. }
                | Call::GetAccelerationStructureBuildSizes { .. }
                | Call::GetMicromapBuildSizes { .. }
                | Call::GetQueryPoolResults { .. }
                | Call::GetDeferredOperationMaxConcurrency { .. }
                | Call::GetDeferredOperationResult { .. }
                | Call::WriteAccelerationStructuresProperties { .. }
                | Call::WriteMicromapsProperties { .. }
        ))
}

impl State {
    /// Whether any buffer was bound, so that binding is among the calls that are seen.
    pub(crate) const fn sees_bindings(&self) -> bool {
        self.sees_bindings
    }

    /// How a command that was recorded or deferred at that time relates to the present.
    pub(super) const fn age(&self, serial: u64) -> Age {
        if self.changed_at > serial { Age::Changed } else { Age::Unchanged }
    }

    /// Makes the command buffers invalid that recorded a command that names an object, and those that execute them.
    pub(super) fn invalidate(&mut self, object: Object) {
        let mut gone = vec![object];
        while let Some(object) = gone.pop() {
            for (handle, state) in &mut self.command_buffers {
                if state.names(object) {
                    state.reset();
                    state.recording = RecordingState::Invalid;
                    gone.push((vk::CommandBuffer::OBJECT_TYPE, handle.0));
                }
            }
        }
    }

    /// A command buffer was executed: if it was begun for one submission, it and those that execute it are invalid.
    pub(super) fn executed(&mut self, handle: vk::CommandBuffer) {
        let Some(state) = self.command_buffers.get_mut(&handle) else { return };
        let secondary: Vec<_> = state.secondary().collect();
        if state.usage.contains(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT) {
            state.recording = RecordingState::Invalid;
            self.invalidate((vk::CommandBuffer::OBJECT_TYPE, handle.0));
        }
        // Those that secondary ones claim to execute are passed over, so that this ends.
        for handle in secondary {
            let state = self.command_buffers.get(&handle);
            if state.is_some_and(|state| state.usage.contains(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT)) {
                self.command_buffers.entry(handle).and_modify(|state| state.recording = RecordingState::Invalid);
                self.invalidate((vk::CommandBuffer::OBJECT_TYPE, handle.0));
            }
        }
    }

    /// A device and all that was created on it are gone.
    pub(super) fn destroy_device(&mut self, device: vk::Device) {
        self.devices.remove(&device);
        self.destroyed((vk::Device::OBJECT_TYPE, device.0));
        // Memory stays as it is: what lies there has gone with its objects.
        let is_child =
            |(object, parent): (&Object, _)| parent == Some(device) && object.0 != vk::ObjectType::DEVICE_MEMORY;
        let children = self.objects.iter().map(|(object, state)| (object, state.device())).filter(|it| is_child(*it));
        let children: Vec<Object> = children.map(|(object, _)| *object).collect();
        children.into_iter().for_each(|object| self.destroyed(object));
    }

    /// The program or a device wrote addresses: what was built there is gone.
    pub(crate) fn written(&mut self, range: vk::DeviceAddressRange) {
        self.serial = self.serial.wrapping_add(1);
        self.changed_at = self.serial;
        let spans: Vec<_> = self.memory_behind(range).collect();
        self.overwritten(&spans, None);
    }

    /// Memory was written, by a command that fills `except`: what other objects held there is gone.
    pub(super) fn overwritten(&mut self, spans: &[MemorySpan], except: Option<Object>) {
        let touches =
            |storage| self.storage_memory(storage).iter().any(|it| spans.iter().any(|span| it.overlaps(span)));
        let structures = self.acceleration_structures.iter().filter(|(handle, state)| {
            let object = (vk::AccelerationStructure::OBJECT_TYPE, handle.0);
            state.contents.is_some() && except != Some(object) && touches(state.storage)
        });
        let structures: Vec<_> = structures.map(|(handle, _)| *handle).collect();
        let micromaps = self.micromaps.iter().filter(|(handle, state)| {
            let &super::MicromapState { buffer, offset, size, .. } = *state;
            let object = (vk::Micromap::OBJECT_TYPE, handle.0);
            state.contents.is_some() && except != Some(object) && touches(Storage::Buffer { buffer, offset, size })
        });
        let micromaps: Vec<_> = micromaps.map(|(handle, _)| *handle).collect();
        for handle in structures {
            self.acceleration_structures.entry(handle).and_modify(|state| state.contents = None);
        }
        for handle in micromaps {
            self.micromaps.entry(handle).and_modify(|state| state.contents = None);
        }
    }

    /// The memory behind a range of a buffer or of addresses, as far as it is known.
    pub(crate) fn storage_memory(&self, storage: Storage) -> Vec<MemorySpan> {
        match storage {
            Storage::Buffer { buffer, offset, size } => self.buffer_memory(buffer, offset, size).collect(),
            Storage::AddressRange(range) => self.memory_behind(range).collect(),
        }
    }
}

impl CommandBufferState {
    /// The secondary command buffers that it executes.
    pub(crate) fn secondary(&self) -> impl Iterator<Item = vk::CommandBuffer> {
        let executed = self.calls.iter().filter_map(|(call, _)| match call {
            Call::CmdExecuteCommands { command_buffers, .. } => Some(command_buffers),
            _ => None,
        });
        executed.flatten().copied()
    }
}
