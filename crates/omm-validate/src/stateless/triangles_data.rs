//! Rules of the build commands on `VkAccelerationStructureTrianglesOpacityMicromapEXT` in the chain of triangles, on its members.

use omm_model::vk;

use crate::context::Purpose;
use crate::context::micromap_ext::OpacityMicromapExtContext;
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::violation::ViolationKind;

/// The rules of one command on the index buffer: without an index type it has to be null, with one it has to be there.
pub(crate) fn index_buffer_rules(purpose: Purpose) -> Option<[RuleId; 2]> {
    match purpose {
        Purpose::Build { .. } => Some([RuleId::ExtIndexBuffer10904, RuleId::ExtIndexBuffer10905]),
        Purpose::Indirect { .. } => Some([RuleId::IndirectExtIndexBuffer10904, RuleId::IndirectExtIndexBuffer10905]),
        Purpose::Host => Some([RuleId::ExtIndexBuffer10892, RuleId::ExtIndexBuffer11821]),
        Purpose::Sizes => None,
    }
}

/// Visits the index buffer's path.
pub(crate) fn index_buffer_at(attached: &OpacityMicromapExtContext<'_>, visit: impl FnOnce(&At<'_>)) {
    let at = attached.at.field("indexBuffer");
    let on_host = attached.geometry.build.purpose == Purpose::Host;
    visit(&at.field(if on_host { "hostAddress" } else { "deviceAddress" }));
}

pub(super) fn check(attached: &OpacityMicromapExtContext<'_>, report: &mut Report) {
    if let Some([without_type, with_type]) = index_buffer_rules(attached.geometry.build.purpose) {
        index_buffer_10904(attached, without_type, report);
        index_buffer_10905(attached, with_type, report);
    }
}

/// Without an index type there is no index buffer.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-pInfos-10904, for host builds 10892
fn index_buffer_10904(attached: &OpacityMicromapExtContext<'_>, rule: RuleId, report: &mut Report) {
    let vk::TrianglesOpacityMicromapExt { index_type, index_buffer, .. } = attached.attached;
    if *index_type == vk::IndexType::NONE && !index_buffer.is_null() {
        let kind = ViolationKind::AddressNotNull { found: index_buffer.raw() };
        index_buffer_at(attached, |at| report.push(rule, at, kind));
    }
}

/// With an index type there is an index buffer, where the command can read it. The tracked part of the rule looks the buffer up.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-pInfos-10905, for host builds 11821
fn index_buffer_10905(attached: &OpacityMicromapExtContext<'_>, rule: RuleId, report: &mut Report) {
    let vk::TrianglesOpacityMicromapExt { index_type, index_buffer, .. } = attached.attached;
    let on_host = attached.geometry.build.purpose == Purpose::Host;
    let unreachable = !on_host && index_buffer.host_address().is_some();
    if *index_type != vk::IndexType::NONE && (index_buffer.is_null() || unreachable) {
        let found = index_buffer.raw();
        let kind =
            if on_host { ViolationKind::InvalidHostAddress { found } } else { ViolationKind::InvalidAddress { found } };
        index_buffer_at(attached, |at| report.push(rule, at, kind));
    }
}
