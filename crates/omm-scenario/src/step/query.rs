//! Queries of sizes.

use omm_model::call::Call;
use omm_model::vk;

use super::Plan;
use crate::change::enumerant;
use crate::constant;
use crate::error::Mistake;
use crate::node::{Arguments, Node};
use crate::world::{DEVICE, Handle, World};

impl World {
    /// `query("leaf", compacted_size)`: the command, a pool for it, and the question for the results.
    pub(super) fn query(&mut self, node: &Node, command_buffer: vk::CommandBuffer) -> Result<Plan, Mistake> {
        let arguments = Arguments::of(node, &["object", "type", "set"])?;
        let names = arguments.need("object")?.one_or_more();
        let (mut structures, mut micromaps) = (Vec::new(), Vec::new());
        for name in names {
            match self.structure(name.text()?, name)?.handle {
                Handle::AccelerationStructure(handle) => structures.push(handle),
                Handle::Micromap(handle) => micromaps.push(handle),
            }
        }
        let query_type = query_type(arguments.need("type")?, !micromaps.is_empty())?;
        let query_count = u32::try_from(names.len()).map_err(|_| node.mistake("these are too many"))?;
        let query_pool = vk::QueryPool(self.handle());
        let create_info = vk::QueryPoolCreateInfo { query_type, query_count, ..Default::default() };
        self.prepare(&Call::CreateQueryPool { device: DEVICE, create_info, query_pool }, node)?;
        let first_query = 0;
        let call = match (structures.is_empty(), micromaps.is_empty()) {
            (_, true) => Call::CmdWriteAccelerationStructuresProperties {
                command_buffer,
                acceleration_structures: structures,
                query_type,
                query_pool,
                first_query,
            },
            (true, false) => {
                Call::CmdWriteMicromapsProperties { command_buffer, micromaps, query_type, query_pool, first_query }
            }
            _ => return Err(node.mistake("no command asks micromap objects and acceleration structures")),
        };
        let results = Call::GetQueryPoolResults {
            device: DEVICE,
            query_pool,
            first_query,
            query_count,
            data_size: 8 * u64::from(query_count),
            stride: 8,
            flags: vk::QueryResultFlags::RESULT_64 | vk::QueryResultFlags::WAIT,
        };
        let reset = Call::CmdResetQueryPool { command_buffer, query_pool, first_query, query_count };
        Ok(Plan { before: vec![reset], call, after: vec![results], creates: None })
    }
}

/// `size`, `compacted_size`, `serialization_size`, `serialization_pointers`, or a name of the API.
fn query_type(node: &Node, is_ext: bool) -> Result<vk::QueryType, Mistake> {
    let words = [
        ("size", vk::QueryType::ACCELERATION_STRUCTURE_SIZE),
        ("compacted_size", vk::QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE),
        ("serialization_size", vk::QueryType::ACCELERATION_STRUCTURE_SERIALIZATION_SIZE),
        ("serialization_pointers", vk::QueryType::ACCELERATION_STRUCTURE_SERIALIZATION_BOTTOM_LEVEL_POINTERS),
    ];
    if let Some((_, found)) = words.iter().find(|(word, _)| node.name() == Some(word)) {
        return Ok(match *found {
            vk::QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE if is_ext => vk::QueryType::MICROMAP_COMPACTED_SIZE,
            vk::QueryType::ACCELERATION_STRUCTURE_SERIALIZATION_SIZE if is_ext => {
                vk::QueryType::MICROMAP_SERIALIZATION_SIZE
            }
            found => found,
        });
    }
    let mistake = || {
        let mistake = node.mistake(format!("{} is no type of query", node.describe()));
        mistake.nearest(node.name().unwrap_or_default(), words.iter().map(|(word, _)| *word))
    };
    let constants = constant::of_type("QueryType").ok_or_else(mistake)?;
    let found = enumerant(node, constants).map_err(|_| mistake())?;
    i32::try_from(found).map(vk::QueryType).map_err(|_| mistake())
}
