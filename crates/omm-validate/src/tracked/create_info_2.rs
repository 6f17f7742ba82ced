//! Rules of `VkAccelerationStructureCreateInfo2KHR` on the buffers and the memory behind its range.

use omm_model::call::Call;
use omm_model::vk;
use vk::{
    AccelerationStructureCreateFlags as CreateFlags, AddressCommandFlags as AddressFlags, BufferCreateFlags,
    BufferUsageFlags,
};

use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::{BufferState, State};
use crate::violation::ViolationKind;

pub(super) fn check(call: &Call, command: &At<'_>, state: &State, report: &mut Report) {
    let Call::CreateAccelerationStructure2 { device, create_info, .. } = call else { return };
    let create = Create { at: command.pointer("pCreateInfo"), info: create_info, device: *device, state };
    create.protected_13098(report);
    create.protected_13099(report);
    create.storage_usage_13122(report);
    create.storage_usage_13123(report);
    create.transform_feedback_usage_13124(report);
    create.transform_feedback_usage_13125(report);
    create.address_range_11602(report);
    create.address_range_11603(report);
    create.address_range_11604(report);
    create.capture_replay_11606(report);
    create.capture_replay_11607(report);
    create.feature_11673(report);
}

/// One creation.
struct Create<'a> {
    at: At<'a>,
    info: &'a vk::AccelerationStructureCreateInfo2,
    device: vk::Device,
    state: &'a State,
}

/// The address flags that speak of one kind of usage.
struct Usage {
    usage: BufferUsageFlags,
    known: AddressFlags,
    unknown: AddressFlags,
}

const STORAGE: Usage = Usage {
    usage: BufferUsageFlags::STORAGE_BUFFER,
    known: AddressFlags::STORAGE_BUFFER_USAGE,
    unknown: AddressFlags::UNKNOWN_STORAGE_BUFFER_USAGE,
};

const TRANSFORM_FEEDBACK: Usage = Usage {
    usage: BufferUsageFlags::TRANSFORM_FEEDBACK_BUFFER,
    known: AddressFlags::TRANSFORM_FEEDBACK_BUFFER_USAGE,
    unknown: AddressFlags::UNKNOWN_TRANSFORM_FEEDBACK_BUFFER_USAGE,
};

impl Create<'_> {
    /// The buffers that the whole range lies in.
    fn around(&self) -> impl Iterator<Item = &BufferState> {
        self.state.buffers_around(self.info.address_range).map(|(_, buffer)| buffer)
    }

    /// The buffers that the range begins in.
    fn buffers_at(&self) -> impl Iterator<Item = &BufferState> {
        self.state.buffers_at(self.info.address_range.address).map(|(_, buffer, _, _)| buffer)
    }

    /// Those of them that the structure can lie in.
    fn storage(&self) -> impl Iterator<Item = &BufferState> {
        self.around().filter(|buffer| buffer.usage.contains(BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE))
    }

    /// Whether a buffer that shares memory with the range has that usage, or lacks it.
    fn shares_memory(&self, usage: BufferUsageFlags, has: bool) -> bool {
        let mut spans = self.state.memory_behind(self.info.address_range);
        spans.any(|span| self.state.buffers_on(span).any(|(_, buffer)| buffer.usage.contains(usage) == has))
    }

    /// Reports an address flag that is not there.
    fn need(&self, required: AddressFlags, rule: RuleId, report: &mut Report) {
        let (found, required) = (self.info.address_flags.into(), required.into());
        report.push(rule, &self.at.field("addressFlags"), ViolationKind::MissingOneOfFlags { found, required });
    }

    /// Reports an address flag that is there.
    fn forbid(&self, forbidden: AddressFlags, rule: RuleId, report: &mut Report) {
        let (found, forbidden) = (self.info.address_flags.into(), forbidden.into());
        report.push(rule, &self.at.field("addressFlags"), ViolationKind::ForbiddenFlags { found, forbidden });
    }

    /// A range in a protected buffer is known to be protected.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-13098
    fn protected_13098(&self, report: &mut Report) {
        let is_safe = self.state.profile().limits.protected_no_fault;
        let is_protected = |buffer: &BufferState| buffer.flags.contains(BufferCreateFlags::PROTECTED);
        if !is_safe && !self.info.address_flags.contains(AddressFlags::PROTECTED) && self.around().any(is_protected) {
            self.need(AddressFlags::PROTECTED, RuleId::Protected13098, report);
        }
    }

    /// A range in ordinary buffers is not taken for a protected one.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-13099
    fn protected_13099(&self, report: &mut Report) {
        let is_safe = self.state.profile().limits.protected_no_fault;
        let is_protected = |buffer: &BufferState| buffer.flags.contains(BufferCreateFlags::PROTECTED);
        let is_known = self.around().next().is_some() && !self.around().any(is_protected);
        if !is_safe && self.info.address_flags.contains(AddressFlags::PROTECTED) && is_known {
            self.forbid(AddressFlags::PROTECTED, RuleId::Protected13099, report);
        }
    }

    /// Usage of the memory is announced.
    fn usage_announced(&self, usage: &Usage, rule: RuleId, report: &mut Report) {
        let either = usage.known.union(usage.unknown);
        if !self.info.address_flags.intersects(either) && self.shares_memory(usage.usage, true) {
            self.need(either, rule, report);
        }
    }

    /// Usage that is announced is that of every buffer on the memory.
    fn usage_of_all(&self, usage: &Usage, rule: RuleId, report: &mut Report) {
        if self.info.address_flags.contains(usage.known) && self.shares_memory(usage.usage, false) {
            self.forbid(usage.known, rule, report);
        }
    }

    /// Storage usage is announced.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-13122
    fn storage_usage_13122(&self, report: &mut Report) {
        self.usage_announced(&STORAGE, RuleId::StorageUsage13122, report);
    }

    /// Announced storage usage is there.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-13123
    fn storage_usage_13123(&self, report: &mut Report) {
        self.usage_of_all(&STORAGE, RuleId::StorageUsage13123, report);
    }

    /// Transform feedback usage is announced.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-13124
    fn transform_feedback_usage_13124(&self, report: &mut Report) {
        self.usage_announced(&TRANSFORM_FEEDBACK, RuleId::TransformFeedbackUsage13124, report);
    }

    /// Announced transform feedback usage is there.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-13125
    fn transform_feedback_usage_13125(&self, report: &mut Report) {
        self.usage_of_all(&TRANSFORM_FEEDBACK, RuleId::TransformFeedbackUsage13125, report);
    }

    /// The range begins in a buffer. The stateless part of the rule looks for address 0.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-11602
    fn address_range_11602(&self, report: &mut Report) {
        let address = self.info.address_range.address;
        if !address.is_null() && self.state.knows_addresses() && self.buffers_at().next().is_none() {
            let kind = ViolationKind::InvalidAddress { found: address.0 };
            let range = self.at.field("addressRange");
            report.push(RuleId::AddressRange11602, &range.field("address"), kind);
        }
    }

    /// The range lies in a buffer for acceleration structures.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-11603
    fn address_range_11603(&self, report: &mut Report) {
        let vk::DeviceAddressRange { address, size } = self.info.address_range;
        let Some(available) = self.state.bytes_from(address).filter(|_| self.storage().next().is_none()) else {
            return;
        };
        let required = BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE;
        let kind = match self.around().next() {
            Some(buffer) => ViolationKind::MissingFlags { found: buffer.usage.into(), required: required.into() },
            // The buffer that has the usage ends too early, whatever lies in others.
            None => {
                let has_usage = |buffer: &BufferState| buffer.usage.contains(required);
                let buffers = self.state.buffers_at(address).filter(|(_, buffer, _, _)| has_usage(buffer));
                let available = buffers.map(|(_, _, _, available)| available).max().unwrap_or(available);
                ViolationKind::BeyondBuffer { start: address.0, size: size.into(), available }
            }
        };
        report.push(RuleId::AddressRange11603, &self.at.field("addressRange"), kind);
    }

    /// The buffer is not one that can be bound in part.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-addressRange-11604
    fn address_range_11604(&self, report: &mut Report) {
        let forbidden = BufferCreateFlags::SPARSE_RESIDENCY;
        let is_sparse = |buffer: &BufferState| buffer.flags.contains(forbidden);
        if let Some(buffer) = self.storage().next().filter(|_| self.storage().all(is_sparse)) {
            let kind = ViolationKind::ForbiddenFlags { found: buffer.flags.into(), forbidden: forbidden.into() };
            report.push(RuleId::AddressRange11604, &self.at.field("addressRange"), kind);
        }
    }

    /// In a buffer whose address is captured the object's address is captured.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-11606
    fn capture_replay_11606(&self, report: &mut Report) {
        let required = CreateFlags::DEVICE_ADDRESS_CAPTURE_REPLAY;
        let is_captured = |it: &BufferState| it.flags.contains(BufferCreateFlags::DEVICE_ADDRESS_CAPTURE_REPLAY);
        let all_captured = self.buffers_at().next().is_some() && self.buffers_at().all(is_captured);
        if all_captured && !self.info.create_flags.contains(required) {
            let found = self.info.create_flags.into();
            let kind = ViolationKind::MissingFlags { found, required: required.into() };
            report.push(RuleId::CaptureReplay11606, &self.at.field("createFlags"), kind);
        }
    }

    /// The object's address is captured in a buffer whose address is captured.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-11607
    fn capture_replay_11607(&self, report: &mut Report) {
        let forbidden = CreateFlags::DEVICE_ADDRESS_CAPTURE_REPLAY;
        let is_captured = |it: &BufferState| it.flags.contains(BufferCreateFlags::DEVICE_ADDRESS_CAPTURE_REPLAY);
        let none_captured = self.buffers_at().next().is_some() && !self.buffers_at().any(is_captured);
        if none_captured && self.info.create_flags.contains(forbidden) {
            let found = self.info.create_flags.into();
            let kind = ViolationKind::ForbiddenFlags { found, forbidden: forbidden.into() };
            report.push(RuleId::CaptureReplay11607, &self.at.field("createFlags"), kind);
        }
    }

    /// Addresses are captured on several physical devices where that is possible.
    ///
    /// VUID-VkAccelerationStructureCreateInfo2KHR-createFlags-11673
    fn feature_11673(&self, report: &mut Report) {
        let is_captured = self.info.create_flags.contains(CreateFlags::DEVICE_ADDRESS_CAPTURE_REPLAY);
        let found = self.state.physical_devices(self.device) as u64;
        if is_captured && found > 1 && !self.state.features(self.device).buffer_device_address_multi_device {
            let kind = ViolationKind::SeveralPhysicalDevices { found, feature: "bufferDeviceAddressMultiDevice" };
            report.push(RuleId::Feature11673, &self.at.field("createFlags"), kind);
        }
    }
}
