//! What commands do when they execute: at the submission of their command buffer, or at once on the host.

use std::sync::Arc;

use omm_model::call::{Call, Timeline};
use omm_model::vk;

use super::{
    Age, Attachment, Built, CommandBufferState, Contents, Deserialized, MicromapBuilt, MicromapContents, State,
};

/// Where serialized data lies: whether in host memory, and at which address.
pub(super) type Place = (bool, u64);

fn place(address: vk::DeviceOrHostAddress) -> Place {
    (address.host_address().is_some(), address.raw())
}

/// Serialized data, as far as it is known.
#[derive(Clone, Debug)]
pub(super) enum Serialized {
    Structure(vk::AccelerationStructure, Contents),
    Micromap(vk::Micromap, MicromapContents),
}

impl State {
    /// Visits every command that `call` causes to execute, each with the state that it finds: the commands recorded into
    /// submitted command buffers, secondary ones included, or a host command itself.
    pub(crate) fn each_executed(&self, call: &Call, visit: &mut dyn FnMut(&Self, &Call)) {
        match call {
            Call::QueueSubmit { command_buffers, .. } => {
                let has_work =
                    |it: &vk::CommandBuffer| self.command_buffer(*it).is_some_and(|it| !it.calls().is_empty());
                if command_buffers.iter().any(has_work) {
                    self.clone().replay(command_buffers, &mut |state, call, _| visit(state, call));
                }
            }
            _ if call.timeline() == Timeline::Host => visit(self, call),
            _ => {}
        }
    }

    /// Visits what [`each_executed`](Self::each_executed) does and a deferred command that is joined, with how long each was known.
    pub(crate) fn each_execution(&self, call: &Call, visit: &mut dyn FnMut(&Self, &Call, Age)) {
        match call {
            Call::QueueSubmit { command_buffers, .. } => {
                let mut state = self.clone();
                state.just_serialized.clear();
                state.command_buffers.values_mut().for_each(CommandBufferState::forget_effects);
                state.replay(command_buffers, &mut |state, call, serial| visit(state, call, state.age(serial)));
            }
            Call::DeferredOperationJoin { operation, .. } => {
                if let Some(operation) = self.deferred_operation(*operation)
                    && let Some(pending) = &operation.pending
                {
                    // It does not stand in its own way.
                    let mut state = self.clone();
                    state.operations.clear();
                    visit(&state, pending, self.age(operation.deferred_at));
                }
            }
            _ if call.timeline() == Timeline::Host => visit(self, call, Age::New),
            _ => {}
        }
    }

    /// Whether data was serialized to where an address points, by the submission that is being looked at, so that it is not in
    /// memory yet.
    pub(crate) fn was_just_serialized(&self, address: vk::DeviceOrHostAddress) -> bool {
        self.just_serialized.contains(&place(address))
    }

    /// Whether the submission that is being looked at has written anything that is not in memory yet.
    pub(crate) fn was_just_written(&self) -> bool {
        !self.just_serialized.is_empty()
    }

    /// What is known to lie where an address points: the contents of the acceleration structure that was serialized there.
    #[must_use]
    pub fn serialized_structure(
        &self,
        address: vk::DeviceOrHostAddress,
    ) -> Option<(vk::AccelerationStructure, &Contents)> {
        match self.serialized.get(&place(address))? {
            Serialized::Structure(handle, contents) => Some((*handle, contents)),
            Serialized::Micromap(..) => None,
        }
    }

    /// The micromap object that is known to have been serialized to where an address points.
    #[must_use]
    pub fn serialized_micromap(&self, address: vk::DeviceOrHostAddress) -> Option<vk::Micromap> {
        match self.serialized.get(&place(address))? {
            Serialized::Micromap(handle, _) => Some(*handle),
            Serialized::Structure(..) => None,
        }
    }

    /// Carries out what command buffers hold.
    pub(super) fn replay(&mut self, command_buffers: &[vk::CommandBuffer], visit: &mut dyn FnMut(&Self, &Call, u64)) {
        for command_buffer in command_buffers {
            self.replay_one(*command_buffer, true, visit);
        }
    }

    fn replay_one(&mut self, handle: vk::CommandBuffer, primary: bool, visit: &mut dyn FnMut(&Self, &Call, u64)) {
        let Some(calls) = self.command_buffer(handle).map(CommandBufferState::calls) else { return };
        for (call, serial) in calls.iter() {
            match call {
                // Secondary command buffers execute no others; what claims to is passed over, so that this ends.
                Call::CmdExecuteCommands { command_buffers, .. } => {
                    for secondary in command_buffers.iter().filter(|_| primary) {
                        self.replay_one(*secondary, false, visit);
                    }
                }
                _ => {
                    visit(self, call, *serial);
                    self.execute(call);
                }
            }
        }
    }

    /// Carries out one command.
    pub(super) fn execute(&mut self, call: &Call) {
        match call {
            Call::CmdBuildAccelerationStructures { infos, build_range_infos, .. }
            | Call::BuildAccelerationStructures { infos, build_range_infos, .. } => {
                let ranges = build_range_infos.iter().map(|ranges| ranges.as_deref().unwrap_or_default());
                self.build(infos, ranges);
            }
            Call::CmdBuildAccelerationStructuresIndirect { infos, .. } => self.build(infos, std::iter::empty()),
            Call::CmdCopyAccelerationStructure { info, .. } | Call::CopyAccelerationStructure { info, .. } => {
                let source = self.acceleration_structure(info.src);
                // A source of which nothing is known is taken to hold something.
                let contents = source.map_or_else(|| Some(Contents::default()), |source| source.contents.clone());
                self.fill(info.dst, contents);
                if info.mode == vk::CopyAccelerationStructureMode::CLONE {
                    self.same_sizes(info.src, info.dst);
                }
            }
            Call::CmdCopyAccelerationStructureToMemory { info, .. }
            | Call::CopyAccelerationStructureToMemory { info, .. } => {
                let contents = self.acceleration_structure(info.src).and_then(|source| source.contents.clone());
                self.serialize(info.dst, contents.map(|contents| Serialized::Structure(info.src, contents)));
            }
            Call::CmdCopyMemoryToAccelerationStructure { info, .. }
            | Call::CopyMemoryToAccelerationStructure { info, .. } => {
                let contents = match self.serialized_structure(info.src) {
                    Some((handle, contents)) => Contents {
                        deserialized: Some(Deserialized { origin: Some(handle.0), address: info.src }),
                        ..contents.clone()
                    },
                    None => Contents {
                        deserialized: Some(Deserialized { origin: None, address: info.src }),
                        ..Contents::default()
                    },
                };
                self.fill(info.dst, Some(Contents { updated: false, ..contents }));
            }
            Call::CmdBuildMicromaps { infos, .. } | Call::BuildMicromaps { infos, .. } => {
                for info in infos {
                    let built = Some(Arc::new(MicromapBuilt::new(info)));
                    self.fill_micromap(info.dst_micromap, Some(MicromapContents { built, ..Default::default() }));
                }
            }
            Call::CmdCopyMicromap { info, .. } | Call::CopyMicromap { info, .. } => {
                let source = self.micromap(info.src);
                let contents =
                    source.map_or_else(|| Some(MicromapContents::default()), |source| source.contents.clone());
                self.fill_micromap(info.dst, contents);
                if info.mode == vk::CopyMicromapMode::CLONE {
                    self.same_micromap_sizes(info.src, info.dst);
                }
            }
            Call::CmdCopyMicromapToMemory { info, .. } | Call::CopyMicromapToMemory { info, .. } => {
                let contents = self.micromap(info.src).and_then(|source| source.contents.clone());
                self.serialize(info.dst, contents.map(|contents| Serialized::Micromap(info.src, contents)));
            }
            Call::CmdCopyMemoryToMicromap { info, .. } | Call::CopyMemoryToMicromap { info, .. } => {
                let contents = match self.serialized.get(&place(info.src)) {
                    Some(Serialized::Micromap(handle, contents)) => MicromapContents {
                        deserialized: Some(Deserialized { origin: Some(handle.0), address: info.src }),
                        ..contents.clone()
                    },
                    _ => MicromapContents {
                        deserialized: Some(Deserialized { origin: None, address: info.src }),
                        ..MicromapContents::default()
                    },
                };
                self.fill_micromap(info.dst, Some(contents));
            }
            Call::CmdWriteAccelerationStructuresProperties {
                acceleration_structures, query_pool, first_query, ..
            } => {
                let objects = acceleration_structures.iter().map(|it| (vk::AccelerationStructure::OBJECT_TYPE, it.0));
                self.write_queries(*query_pool, *first_query, objects);
            }
            Call::CmdWriteMicromapsProperties { micromaps, query_pool, first_query, .. } => {
                let objects = micromaps.iter().map(|it| (vk::Micromap::OBJECT_TYPE, it.0));
                self.write_queries(*query_pool, *first_query, objects);
            }
            Call::CmdResetQueryPool { query_pool, first_query, query_count, .. } => {
                self.reset_queries(*query_pool, *first_query, *query_count);
            }
            _ => {}
        }
    }

    /// Builds and updates; those of one command do not see each other.
    fn build<'a>(
        &mut self,
        infos: &[vk::BuildGeometryInfo],
        mut ranges: impl Iterator<Item = &'a [vk::BuildRangeInfo]>,
    ) {
        for info in infos {
            let ranges = ranges.next().unwrap_or_default();
            let attachments = info.geometries_iter().map(Attachment::of).collect();
            let contents = if info.mode == vk::BuildAccelerationStructureMode::UPDATE {
                let source = self.acceleration_structure(info.src_acceleration_structure);
                let contents = source.and_then(|source| source.contents.clone()).unwrap_or_default();
                Contents { attachments, updated: true, ..contents }
            } else {
                Contents { built: Some(Arc::new(Built::new(info, ranges))), attachments, ..Contents::default() }
            };
            self.fill(info.dst_acceleration_structure, Some(contents));
        }
    }

    fn fill(&mut self, handle: vk::AccelerationStructure, contents: Option<Contents>) {
        self.contents_count = self.contents_count.wrapping_add(1);
        let number = self.contents_count;
        if let Some(structure) = self.acceleration_structures.get_mut(&handle) {
            structure.contents = contents.map(|contents| Contents {
                number,
                serialization_size: None,
                compacted_size: None,
                ..contents
            });
            let spans: Vec<_> = self.structure_memory(handle).collect();
            self.overwritten(&spans, Some((vk::AccelerationStructure::OBJECT_TYPE, handle.0)));
        }
    }

    /// A clone is as large as its source in every respect.
    fn same_sizes(&mut self, src: vk::AccelerationStructure, dst: vk::AccelerationStructure) {
        let source = self.acceleration_structure(src).and_then(|source| source.contents.as_ref());
        let Some((serialization_size, compacted_size)) =
            source.map(|contents| (contents.serialization_size, contents.compacted_size))
        else {
            return;
        };
        let destination =
            self.acceleration_structures.get_mut(&dst).and_then(|destination| destination.contents.as_mut());
        if let Some(contents) = destination {
            (contents.serialization_size, contents.compacted_size) = (serialization_size, compacted_size);
        }
    }

    /// So is that of a micromap object.
    fn same_micromap_sizes(&mut self, src: vk::Micromap, dst: vk::Micromap) {
        let source = self.micromap(src).and_then(|source| source.contents.as_ref());
        let Some((serialization_size, compacted_size)) =
            source.map(|contents| (contents.serialization_size, contents.compacted_size))
        else {
            return;
        };
        if let Some(contents) = self.micromaps.get_mut(&dst).and_then(|destination| destination.contents.as_mut()) {
            (contents.serialization_size, contents.compacted_size) = (serialization_size, compacted_size);
        }
    }

    fn fill_micromap(&mut self, handle: vk::Micromap, contents: Option<MicromapContents>) {
        self.contents_count = self.contents_count.wrapping_add(1);
        let number = self.contents_count;
        if let Some(micromap) = self.micromaps.get_mut(&handle) {
            micromap.contents = contents.map(|contents| MicromapContents {
                number,
                serialization_size: None,
                compacted_size: None,
                ..contents
            });
            let spans: Vec<_> = self.micromap_memory(handle).collect();
            self.overwritten(&spans, Some((vk::Micromap::OBJECT_TYPE, handle.0)));
        }
    }

    fn serialize(&mut self, address: vk::DeviceOrHostAddress, data: Option<Serialized>) {
        let size = match &data {
            Some(Serialized::Structure(_, contents)) => contents.serialization_size,
            Some(Serialized::Micromap(_, contents)) => contents.serialization_size,
            None => None,
        };
        if let Some(start) = address.device_address() {
            let size = size.or(self.bytes_from(start)).unwrap_or_default();
            let spans: Vec<_> = self.memory_behind(vk::DeviceAddressRange { address: start, size }).collect();
            self.overwritten(&spans, None);
        }
        self.just_serialized.insert(place(address));
        match data {
            Some(data) => self.serialized.insert(place(address), data),
            None => self.serialized.remove(&place(address)),
        };
    }
}
