//! Copies: of a structure into another one, into memory, and back.

use omm_layout::object::Object as Built;
use omm_model::call::Call;
use omm_model::vk;
use omm_serialize::ByteOrder;
use omm_serialize::blob::Prefix;

use crate::change::unknown;
use crate::error::Mistake;
use crate::node::{Arguments, Node};
use crate::objects::Address;
use crate::world::{BufferRequest, DEVICE, Handle, INPUT, Preparation, World};

const FROM_TO: &[&str] = &["from", "to", "set"];

/// Bytes of what something unreadable is copied into.
const UNKNOWN_SIZE: u64 = 4096;

impl World {
    /// `clone("leaf", "twin")` and `compact("leaf", "small")`. What is not declared is made as large as it has to be.
    pub(super) fn copy(&mut self, word: &str, node: &Node, command_buffer: vk::CommandBuffer) -> Result<Call, Mistake> {
        let arguments = Arguments::of(node, FROM_TO)?;
        let (from, to) = (arguments.need("from")?, arguments.need("to")?);
        let source = self.structure(from.text()?, from)?.clone();
        if !self.objects.contains(to.text()?) {
            let size = match (self.built(from.text()?, from)?, word) {
                (Some(object), "compact") => object.header().compacted_size,
                (Some(object), _) => object.header().size,
                (None, _) => source.range.size,
            };
            let is_ext = matches!(source.handle, Handle::Micromap(_));
            self.make_empty(to.text()?, source.ty, is_ext, size, Preparation::Created, to)?;
        }
        match (source.handle, self.structure(to.text()?, to)?.handle) {
            (Handle::AccelerationStructure(src), Handle::AccelerationStructure(dst)) => {
                let mode = match word {
                    "compact" => vk::CopyAccelerationStructureMode::COMPACT,
                    _ => vk::CopyAccelerationStructureMode::CLONE,
                };
                let info = vk::CopyAccelerationStructureInfo { src, dst, mode, ..Default::default() };
                Ok(Call::CmdCopyAccelerationStructure { command_buffer, info })
            }
            (Handle::Micromap(src), Handle::Micromap(dst)) => {
                let mode = if word == "compact" { vk::CopyMicromapMode::COMPACT } else { vk::CopyMicromapMode::CLONE };
                let info = vk::CopyMicromapInfo { src, dst, mode, ..Default::default() };
                Ok(Call::CmdCopyMicromap { command_buffer, info })
            }
            _ => Err(to.mistake("no command copies between micromap objects and acceleration structures")),
        }
    }

    /// `serialize("leaf", "blob")`
    pub(super) fn serialize(&mut self, node: &Node, command_buffer: vk::CommandBuffer) -> Result<Call, Mistake> {
        let arguments = Arguments::of(node, FROM_TO)?;
        let (from, to) = (arguments.need("from")?, arguments.need("to")?);
        let source = self.structure(from.text()?, from)?.clone();
        if !self.objects.contains(to.text()?) {
            let built = self.built(from.text()?, from)?;
            let size = built.map_or(UNKNOWN_SIZE, |object| omm_serialize::serialized_size(object.header()));
            self.make_buffer(&BufferRequest::new(to.text()?, size, INPUT), to)?;
        }
        let dst = self.place(to)?;
        Ok(match source.handle {
            Handle::AccelerationStructure(src) => {
                let mode = vk::CopyAccelerationStructureMode::SERIALIZE;
                let info = vk::CopyAccelerationStructureToMemoryInfo { src, dst, mode, ..Default::default() };
                Call::CmdCopyAccelerationStructureToMemory { command_buffer, info }
            }
            Handle::Micromap(src) => {
                let mode = vk::CopyMicromapMode::SERIALIZE;
                let info = vk::CopyMicromapToMemoryInfo { src, dst, mode, ..Default::default() };
                Call::CmdCopyMicromapToMemory { command_buffer, info }
            }
        })
    }

    /// `deserialize("blob", "again")`: into a structure of the type that the data holds, unless one is declared.
    pub(super) fn deserialize(&mut self, node: &Node, command_buffer: vk::CommandBuffer) -> Result<Call, Mistake> {
        let arguments = Arguments::of(node, &["from", "to", "ext", "set"])?;
        let (from, to) = (arguments.need("from")?, arguments.need("to")?);
        let is_ext = match arguments.get("ext") {
            Some(node) if node.name().is_some() => node.boolean()?,
            _ => false,
        };
        let src = self.place(from)?;
        if !self.objects.contains(to.text()?) {
            let (ty, size) = self.serialized(src).unwrap_or((vk::AccelerationStructureType::GENERIC, UNKNOWN_SIZE));
            self.make_empty(to.text()?, ty, is_ext, size, Preparation::Created, to)?;
        }
        Ok(match self.structure(to.text()?, to)?.handle {
            Handle::AccelerationStructure(dst) => {
                let mode = vk::CopyAccelerationStructureMode::DESERIALIZE;
                let info = vk::CopyMemoryToAccelerationStructureInfo { src, dst, mode, ..Default::default() };
                Call::CmdCopyMemoryToAccelerationStructure { command_buffer, info }
            }
            Handle::Micromap(dst) => {
                let mode = vk::CopyMicromapMode::DESERIALIZE;
                let info = vk::CopyMemoryToMicromapInfo { src, dst, mode, ..Default::default() };
                Call::CmdCopyMemoryToMicromap { command_buffer, info }
            }
        })
    }

    /// `compatibility("blob")`
    pub(super) fn compatibility(&mut self, node: &Node) -> Result<Call, Mistake> {
        let arguments = Arguments::of(node, &["object", "set"])?;
        let name = arguments.need("object")?;
        let address = self.objects.address(name.text()?).map_err(|error| unknown(name, error))?;
        let bytes = self.read(address.value, 2 * vk::UUID_SIZE as u64).unwrap_or_default().to_vec();
        let version_info = vk::AccelerationStructureVersionInfo { version_data: bytes, ..Default::default() };
        Ok(Call::GetDeviceAccelerationStructureCompatibility { device: DEVICE, version_info })
    }

    /// Where a buffer lies.
    fn place(&self, name: &Node) -> Result<vk::DeviceOrHostAddress, Mistake> {
        let Address { value, host } = self.objects.address(name.text()?).map_err(|error| unknown(name, error))?;
        Ok(if host { vk::HostAddress(value).into() } else { vk::DeviceAddress(value).into() })
    }

    /// What serialized data makes: the type, and how many bytes it takes.
    fn serialized(&self, address: vk::DeviceOrHostAddress) -> Option<(vk::AccelerationStructureType, u64)> {
        let address = address.device_address()?.0;
        let fixed = self.read(address, 56)?;
        let prefix = Prefix::read(fixed, ByteOrder::Little).ok()?;
        let blob = self.read(address, prefix.serialized_size)?;
        let bytes = omm_serialize::deserialize_object(blob).ok()?;
        let ty = match Built::read(&bytes).ok()? {
            Built::Micromap(_) => vk::AccelerationStructureType::OPACITY_MICROMAP,
            Built::BottomLevel(_) => vk::AccelerationStructureType::BOTTOM_LEVEL,
            Built::TopLevel(_) => vk::AccelerationStructureType::TOP_LEVEL,
        };
        Some((ty, prefix.deserialized_size))
    }
}
