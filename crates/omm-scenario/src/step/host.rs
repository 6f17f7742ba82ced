//! The host's and the indirect forms of recorded commands.

use omm_layout::{build_range, instance};
use omm_model::call::Call;
use omm_model::vk;

use crate::error::Mistake;
use crate::node::Node;
use crate::objects::{Object, Range};
use crate::tree::Tree;
use crate::world::{BufferRequest, Cost, DEVICE, INPUT, World};

impl World {
    /// The host's form of a recorded command: what it reads and writes by address is copied to host memory.
    pub(super) fn on_host(
        &mut self,
        call: Call,
        deferred_operation: vk::DeferredOperation,
        node: &Node,
    ) -> Result<Call, Mistake> {
        let device = DEVICE;
        let sizes = |count: usize| (8 * count as u64, 8);
        let call = match call {
            Call::CmdBuildAccelerationStructures { infos, build_range_infos, .. } => {
                Call::BuildAccelerationStructures { device, deferred_operation, infos, build_range_infos }
            }
            Call::CmdCopyAccelerationStructure { info, .. } => {
                Call::CopyAccelerationStructure { device, deferred_operation, info }
            }
            Call::CmdCopyAccelerationStructureToMemory { info, .. } => {
                Call::CopyAccelerationStructureToMemory { device, deferred_operation, info }
            }
            Call::CmdCopyMemoryToAccelerationStructure { info, .. } => {
                Call::CopyMemoryToAccelerationStructure { device, deferred_operation, info }
            }
            Call::CmdWriteAccelerationStructuresProperties { acceleration_structures, query_type, .. } => {
                let (data_size, stride) = sizes(acceleration_structures.len());
                Call::WriteAccelerationStructuresProperties {
                    device,
                    acceleration_structures,
                    query_type,
                    data_size,
                    stride,
                }
            }
            Call::CmdBuildMicromaps { infos, .. } => Call::BuildMicromaps { device, deferred_operation, infos },
            Call::CmdCopyMicromap { info, .. } => Call::CopyMicromap { device, deferred_operation, info },
            Call::CmdCopyMicromapToMemory { info, .. } => {
                Call::CopyMicromapToMemory { device, deferred_operation, info }
            }
            Call::CmdCopyMemoryToMicromap { info, .. } => {
                Call::CopyMemoryToMicromap { device, deferred_operation, info }
            }
            Call::CmdWriteMicromapsProperties { micromaps, query_type, .. } => {
                let (data_size, stride) = sizes(micromaps.len());
                Call::WriteMicromapsProperties { device, micromaps, query_type, data_size, stride }
            }
            other => return Err(node.mistake(format!("{} has no form for the host", other.command()))),
        };
        let mut tree = Tree::of(&call).map_err(|error| node.mistake(error.to_string()))?;
        self.move_addresses(&mut tree, node)?;
        tree.to().map_err(|error| node.mistake(error.to_string()))
    }

    /// Replaces device addresses by those of copies in host memory, wherever a host command takes either.
    fn move_addresses(&mut self, tree: &mut Tree, node: &Node) -> Result<(), Mistake> {
        match tree {
            Tree::Variant("DeviceOrHostAddress", variant, Some(inner)) if *variant == "DeviceAddress" => {
                let address = inner.integer().and_then(|number| u64::try_from(number).ok()).unwrap_or(0);
                if let Some(host) = self.host_copy(address, node)? {
                    *variant = "HostAddress";
                    **inner = Tree::Newtype("HostAddress", Box::new(Tree::Integer(host.into())));
                }
                Ok(())
            }
            Tree::Some(inner) | Tree::Newtype(_, inner) | Tree::Variant(_, _, Some(inner)) => {
                self.move_addresses(inner, node)
            }
            Tree::List(items) => items.iter_mut().try_for_each(|item| self.move_addresses(item, node)),
            Tree::Struct(_, fields) => fields.iter_mut().try_for_each(|(_, field)| self.move_addresses(field, node)),
            _ => Ok(()),
        }
    }

    /// The address in host memory that stands for one in a buffer of the device; the buffer is copied when it is first met.
    fn host_copy(&mut self, address: u64, node: &Node) -> Result<Option<u64>, Mistake> {
        let Some((name, place)) = self.objects.holding(address) else { return Ok(None) };
        let copy = format!("{name}.host");
        if !self.objects.contains(&copy) {
            let mut bytes = self.read(place.address, place.size).unwrap_or_default().to_vec();
            // In host memory instances refer to structures by handle.
            if name.ends_with(".instances") {
                for instance in bytes.chunks_exact_mut(instance::SIZE) {
                    let Some(reference) = instance.last_chunk_mut() else { continue };
                    let name = self.objects.name_of_address(u64::from_le_bytes(*reference), false).unwrap_or_default();
                    *reference = self.objects.handle("AccelerationStructure", &name).unwrap_or(0).to_le_bytes();
                }
            }
            self.host_memory_of(&copy, &bytes, node)?;
        }
        let base = self.objects.address(&copy).map_err(|unknown| crate::change::unknown(node, unknown))?;
        Ok(base.value.checked_add(address - place.address))
    }

    /// Host memory that holds some bytes.
    pub(crate) fn host_memory_of(&mut self, name: &str, bytes: &[u8], node: &Node) -> Result<(), Mistake> {
        let size = bytes.len() as u64;
        self.spend(Cost::Bytes, size, node)?;
        let address = self.new_host_memory(bytes).ok_or_else(|| node.mistake("there is not so much host memory"))?;
        let place = Some(Range { address: address.0, size, host: true });
        self.objects.insert(Object { name: name.to_owned(), handles: Vec::new(), place });
        Ok(())
    }

    /// The indirect form of a build: its ranges lie in a buffer.
    pub(super) fn indirect(&mut self, call: Call, node: &Node) -> Result<Call, Mistake> {
        let Call::CmdBuildAccelerationStructures { command_buffer, infos, build_range_infos } = call else {
            return Err(node.mistake(format!("{} has no indirect form", call.command())));
        };
        let (mut indirect_device_addresses, mut max_primitive_counts) = (Vec::new(), Vec::new());
        for (info, ranges) in infos.iter().zip(&build_range_infos) {
            let ranges = ranges.clone().unwrap_or_default();
            let handle = info.dst_acceleration_structure.0;
            let of = self.objects.name_of_handle("AccelerationStructure", handle).unwrap_or_default();
            let name = format!("{of}.ranges");
            if !self.objects.contains(&name) {
                let bytes: Vec<u8> = ranges.iter().flat_map(build_range::encode).collect();
                let usage = INPUT | vk::BufferUsageFlags::INDIRECT_BUFFER;
                let size = bytes.len() as u64;
                let request = BufferRequest::new(&name, size, usage);
                let range = self.make_buffer(&request, node)?;
                self.write(range.address, &bytes, node)?;
            }
            let address = self.objects.address(&name).map_err(|unknown| crate::change::unknown(node, unknown))?;
            indirect_device_addresses.push(vk::DeviceAddress(address.value));
            max_primitive_counts.push(Some(ranges.iter().map(|range| range.primitive_count).collect()));
        }
        let indirect_strides = vec![build_range::SIZE as u32; infos.len()];
        Ok(Call::CmdBuildAccelerationStructuresIndirect {
            command_buffer,
            infos,
            indirect_device_addresses,
            indirect_strides,
            max_primitive_counts,
        })
    }
}
