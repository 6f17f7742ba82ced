//! Rules of `vkCmdCopyMemoryToMicromapEXT`, `vkCopyMemoryToMicromapEXT` and `VkCopyMemoryToMicromapInfoEXT` on serialized data.

use omm_layout::object::{ObjectHeader, ObjectKind};
use omm_model::call::Call;
use omm_model::memory::{MemoryError, MemoryView};
use omm_model::profile::{DeviceProfile, UUID_SIZE, Uuid};
use omm_model::vk;
use omm_serialize::blob::Prefix;
use omm_serialize::header::FIXED_SIZE;
use omm_serialize::{Blob, ByteOrder, ReadError};

use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::violation::ViolationKind;

/// Bytes of the two identities that serialized data begins with.
const VERSION_SIZE: u64 = 2 * UUID_SIZE as u64;

pub(super) fn check(call: &Call, command: &At<'_>, state: &State, memory: &dyn MemoryView, report: &mut Report) {
    let info = match call {
        // A device command cannot read host memory: another rule's business.
        Call::CmdCopyMemoryToMicromap { info, .. } if info.src.host_address().is_some() => return,
        Call::CmdCopyMemoryToMicromap { command_buffer, info } => {
            // What the command buffer itself writes there is not there yet.
            let recorded = state.command_buffer(*command_buffer);
            if recorded.is_some_and(|recorded| recorded.serializes_micromap_to(info.src)) {
                return;
            }
            info
        }
        Call::CopyMemoryToMicromap { info, .. } => {
            host_deserialize_pointer_07563(command, info, memory, report);
            if info.src.host_address().is_none() {
                return;
            }
            info
        }
        _ => return,
    };
    let at = command.pointer("pInfo");
    let data = SerializedData { address: info.src, profile: state.profile(), memory };
    serialized_data_07547(&at, &data, report);
    serialized_format_07549(&at, &data, report);
    deserialized_size_07550(&at, info.dst, &data, state, report);
}

/// The host reads from its own memory.
///
/// VUID-vkCopyMemoryToMicromapEXT-pInfo-07563
fn host_deserialize_pointer_07563(
    command: &At<'_>,
    info: &vk::CopyMemoryToMicromapInfo,
    memory: &dyn MemoryView,
    report: &mut Report,
) {
    host_memory(command, ("src", info.src), memory, RuleId::HostDeserializePointer07563, report);
}

/// An address has to be one of host memory; whether it is can be told if the view knows host memory.
pub(super) fn host_memory(
    command: &At<'_>,
    (name, address): (&'static str, vk::DeviceOrHostAddress),
    memory: &dyn MemoryView,
    rule: RuleId,
    report: &mut Report,
) {
    let is_wrong = match address.host_address() {
        Some(host) => host.is_null() || memory.knows_host_memory() && memory.read_host(host, 1).is_err(),
        None => true,
    };
    if is_wrong {
        let kind = ViolationKind::InvalidHostAddress { found: address.raw() };
        report.push(rule, &command.pointer("pInfo").field(name), kind);
    }
}

/// Memory that should hold a serialized micromap.
struct SerializedData<'a> {
    address: vk::DeviceOrHostAddress,
    profile: &'a DeviceProfile,
    memory: &'a dyn MemoryView,
}

impl<'a> SerializedData<'a> {
    /// The first bytes.
    fn read(&self, size: u64) -> Result<&'a [u8], MemoryError> {
        self.memory.read_either(self.address, size)
    }

    /// Whether the device and the writer are simulated ones of the same kind, whose payload we can read.
    fn is_ours(&self) -> bool {
        let version = self.read(VERSION_SIZE);
        self.profile.driver_uuid == DeviceProfile::reference().driver_uuid
            && version.is_ok_and(|version| omm_serialize::compatibility(version, self.profile))
    }

    /// The size of a micromap that takes the data, as its header says; known of sound data that is ours.
    fn deserialized_size(&self) -> Option<u64> {
        if !self.is_ours() || self.flaw().is_some() {
            return None;
        }
        let prefix = Prefix::read(self.read(FIXED_SIZE).ok()?, ByteOrder::Little).ok()?;
        Some(prefix.deserialized_size)
    }

    /// The first byte that is missing or makes no sense, and whether it is missing.
    fn flaw(&self) -> Option<(u64, bool)> {
        let ended = |error: MemoryError| Some((error.available, true));
        match self.read(VERSION_SIZE) {
            // Nothing readable at all says nothing about the data.
            Err(error) if error.available == 0 => return None,
            Err(error) => return ended(error),
            Ok(_) if !self.is_ours() => return None,
            Ok(_) => {}
        }
        let malformed = |error: ReadError| Some((error.offset, error.is_truncated()));
        let prefix = match self.read(FIXED_SIZE).map(|bytes| Prefix::read(bytes, ByteOrder::Little)) {
            Err(error) => return ended(error),
            Ok(Err(error)) => return malformed(error),
            Ok(Ok(prefix)) => prefix,
        };
        let bytes = match self.read(prefix.serialized_size) {
            Err(error) => return ended(error),
            Ok(bytes) => bytes,
        };
        let object = match omm_serialize::deserialize_object(bytes) {
            Err(error) => return malformed(error),
            Ok(object) => object,
        };
        let is_micromap = ObjectHeader::read(&object).is_ok_and(|header| header.kind == ObjectKind::Micromap);
        // The kind stands behind the eight bytes that every payload begins with.
        let kind_at = || Blob::read(bytes, ByteOrder::Little).map_or(0, |blob| blob.header_size() + 8);
        (!is_micromap).then(|| (kind_at(), false))
    }
}

/// What is read was written by a serialization of a micromap.
///
/// VUID-VkCopyMemoryToMicromapInfoEXT-src-07547
fn serialized_data_07547(at: &At<'_>, data: &SerializedData<'_>, report: &mut Report) {
    if let Some((offset, truncated)) = data.flaw() {
        let kind = ViolationKind::NotSerialized { offset, truncated, writer: "vkCmdCopyMicromapToMemoryEXT" };
        report.push(RuleId::SerializedData07547, &at.field("src"), kind);
    }
}

/// What is read was written for such a device.
///
/// VUID-VkCopyMemoryToMicromapInfoEXT-src-07549
fn serialized_format_07549(at: &At<'_>, data: &SerializedData<'_>, report: &mut Report) {
    let Ok(version) = data.read(VERSION_SIZE) else { return };
    if let ([driver, compatibility], _) = version.as_chunks::<UUID_SIZE>()
        && !omm_serialize::compatibility(version, data.profile)
    {
        let found = [Uuid(*driver), Uuid(*compatibility)];
        let required = [data.profile.driver_uuid, data.profile.compatibility_uuid];
        report.push(RuleId::SerializedFormat07549, &at.field("src"), ViolationKind::Incompatible { found, required });
    }
}

/// There is room for the micromap.
///
/// VUID-VkCopyMemoryToMicromapInfoEXT-dst-07550
fn deserialized_size_07550(
    at: &At<'_>,
    dst: vk::Micromap,
    data: &SerializedData<'_>,
    state: &State,
    report: &mut Report,
) {
    let Some(object) = state.micromap(dst) else { return };
    // The header of other drivers does not say: there the micromap that was serialized tells.
    let seen = || state.serialized_micromap(data.address).and_then(|source| state.micromap(source));
    let Some(limit) = data.deserialized_size().or_else(|| seen().map(|source| source.size)) else { return };
    if object.size < limit {
        let kind = ViolationKind::BelowLimit { found: object.size, limit };
        report.push(RuleId::DeserializedSize07550, &at.field("dst").about_micromap(dst), kind);
    }
}
