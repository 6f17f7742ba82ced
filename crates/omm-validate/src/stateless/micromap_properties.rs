//! Rules of `vkCmdWriteMicromapsPropertiesEXT` and `vkWriteMicromapsPropertiesEXT` on their parameters.

use omm_model::call::Call;
use omm_model::profile::Features;
use omm_model::vk;
use vk::QueryType;

use super::copy_micromap::host_commands;
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::ViolationKind;

/// The sizes that a micromap has.
const SIZES: [QueryType; 2] = [QueryType::MICROMAP_COMPACTED_SIZE, QueryType::MICROMAP_SERIALIZATION_SIZE];
/// Bytes of a size.
const SIZE_OF_RESULT: u64 = 8;

/// Where a host command puts its results.
#[derive(Clone, Copy)]
struct Results {
    query_type: QueryType,
    count: usize,
    data_size: u64,
    stride: u64,
}

pub(super) fn check(call: &Call, command: &At<'_>, features: &Features, report: &mut Report) {
    match call {
        // Numbers that are no type at all break this rule too: the command has no rule on valid enumerants.
        Call::CmdWriteMicromapsProperties { query_type, .. } => {
            query_type_07503(command, *query_type, RuleId::QueryType07503, report);
        }
        Call::WriteMicromapsProperties { micromaps, query_type, data_size, stride, .. } => {
            host_commands(command, features, RuleId::HostPropertiesFeature07578, report);
            if query_type.name().is_some() {
                query_type_07503(command, *query_type, RuleId::HostQueryType07503, report);
            }
            let results =
                Results { query_type: *query_type, count: micromaps.len(), data_size: *data_size, stride: *stride };
            stride_10071(command, results, report);
            data_10072(command, results, report);
            data_size_07576(command, results, report);
        }
        _ => {}
    }
}

/// A micromap has two sizes to ask for.
///
/// VUID-vkCmdWriteMicromapsPropertiesEXT-queryType-07503,
/// VUID-vkWriteMicromapsPropertiesEXT-queryType-07503
fn query_type_07503(command: &At<'_>, found: QueryType, rule: RuleId, report: &mut Report) {
    if !SIZES.contains(&found) {
        let allowed = &["VK_QUERY_TYPE_MICROMAP_COMPACTED_SIZE_EXT", "VK_QUERY_TYPE_MICROMAP_SERIALIZATION_SIZE_EXT"];
        let kind = ViolationKind::UnexpectedValue { found: found.into(), allowed };
        report.push(rule, &command.field("queryType"), kind);
    }
}

/// Results are aligned to each other.
///
/// VUID-vkWriteMicromapsPropertiesEXT-queryType-10071
fn stride_10071(command: &At<'_>, results: Results, report: &mut Report) {
    let Results { query_type, stride, .. } = results;
    if SIZES.contains(&query_type) && !stride.is_multiple_of(SIZE_OF_RESULT) {
        let kind = ViolationKind::NotMultiple { found: stride, of: SIZE_OF_RESULT };
        report.push(RuleId::Stride10071, &command.field("stride"), kind);
    }
}

/// There is room for one result. No room at all breaks another rule.
///
/// VUID-vkWriteMicromapsPropertiesEXT-queryType-10072
fn data_10072(command: &At<'_>, results: Results, report: &mut Report) {
    let Results { query_type, data_size, .. } = results;
    if SIZES.contains(&query_type) && (1..SIZE_OF_RESULT).contains(&data_size) {
        let kind = ViolationKind::BelowLimit { found: data_size, limit: SIZE_OF_RESULT };
        report.push(RuleId::Data10072, &command.field("dataSize"), kind);
    }
}

/// There is room for every result.
///
/// VUID-vkWriteMicromapsPropertiesEXT-dataSize-07576
fn data_size_07576(command: &At<'_>, results: Results, report: &mut Report) {
    let Results { count, data_size, stride, .. } = results;
    // More than 2^64 bytes are more than there can be.
    let limit = stride.saturating_mul(count as u64);
    let overflows = stride.checked_mul(count as u64).is_none();
    if data_size < limit || overflows {
        let kind = ViolationKind::BelowLimit { found: data_size, limit };
        report.push(RuleId::DataSize07576, &command.field("dataSize"), kind);
    }
}
