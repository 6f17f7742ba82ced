//! Rules on usage counts of the EXT extension, wherever a structure has them.

use omm_model::format::OpacityMicromapFormat;
use omm_model::profile::Limits;

use crate::context::micromap_ext::UsagesExt;
use crate::report::Report;
use crate::rule::RuleId;
use crate::value::Constant;
use crate::violation::ViolationKind;

/// Usages of opacity have a format that exists.
pub(crate) fn opacity_formats(usages: UsagesExt<'_>, rule: RuleId, report: &mut Report) {
    formats(usages, opacity_format, rule, report);
}

/// Usages of displacement have a format that exists.
pub(crate) fn displacement_formats(usages: UsagesExt<'_>, rule: RuleId, report: &mut Report) {
    formats(usages, displacement_format, rule, report);
}

/// Usages of one format of opacity stay within its limit.
pub(crate) fn opacity_levels(
    usages: UsagesExt<'_>,
    format: OpacityMicromapFormat,
    limits: &Limits,
    rule: RuleId,
    report: &mut Report,
) {
    let is_of_format = |found| found == u32::from(format.value());
    levels(usages, is_of_format, opacity_limit(format, limits), rule, report);
}

/// Usages of displacement stay within the limit, whatever their format.
pub(crate) fn displacement_levels(usages: UsagesExt<'_>, limits: &Limits, rule: RuleId, report: &mut Report) {
    levels(usages, |_| true, displacement_limit(limits), rule, report);
}

/// Usage counts come through one of the two pointers.
pub(super) fn both_pointers(usages: UsagesExt<'_>, rule: RuleId, report: &mut Report) {
    if usages.direct.is_some() && usages.pointers.is_some() {
        let kind = ViolationKind::BothPointers { members: ["pUsageCounts", "ppUsageCounts"] };
        report.push(rule, &usages.at.field("pUsageCounts"), kind);
    }
}

/// Reports each usage that `wrong` finds something wrong with in its format.
fn formats(usages: UsagesExt<'_>, wrong: fn(u32) -> Option<ViolationKind>, rule: RuleId, report: &mut Report) {
    usages.each(|at, usage| {
        if let Some(kind) = wrong(usage.format) {
            report.push(rule, &at.field("format"), kind);
        }
    });
}

/// Reports each usage above the limit of that name, among those of certain formats.
fn levels(
    usages: UsagesExt<'_>,
    is_limited: impl Fn(u32) -> bool,
    (limit, from): (u32, &'static str),
    rule: RuleId,
    report: &mut Report,
) {
    usages.each(|at, usage| {
        if is_limited(usage.format) && usage.subdivision_level > limit {
            let kind = ViolationKind::AboveLimit { found: usage.subdivision_level.into(), limit: limit.into(), from };
            report.push(rule, &at.field("subdivisionLevel"), kind);
        }
    });
}

/// What is wrong with a format of opacity, if anything is.
pub(crate) fn opacity_format(found: u32) -> Option<ViolationKind> {
    let allowed = &["VK_OPACITY_MICROMAP_FORMAT_2_STATE_EXT", "VK_OPACITY_MICROMAP_FORMAT_4_STATE_EXT"];
    let found = Constant { type_name: "VkOpacityMicromapFormatEXT", name: None, value: found.into() };
    let is_known = (1..=2).contains(&found.value);
    (!is_known).then_some(ViolationKind::UnexpectedValue { found, allowed })
}

/// What is wrong with a format of displacement, if anything is.
pub(crate) fn displacement_format(found: u32) -> Option<ViolationKind> {
    let allowed = &[
        "VK_DISPLACEMENT_MICROMAP_FORMAT_64_TRIANGLES_64_BYTES_NV",
        "VK_DISPLACEMENT_MICROMAP_FORMAT_256_TRIANGLES_128_BYTES_NV",
        "VK_DISPLACEMENT_MICROMAP_FORMAT_1024_TRIANGLES_128_BYTES_NV",
    ];
    let found = Constant { type_name: "VkDisplacementMicromapFormatNV", name: None, value: found.into() };
    let is_known = (1..=3).contains(&found.value);
    (!is_known).then_some(ViolationKind::UnexpectedValue { found, allowed })
}

/// The highest level of triangles of a format, and the limit's name.
pub(crate) const fn opacity_limit(format: OpacityMicromapFormat, limits: &Limits) -> (u32, &'static str) {
    match format {
        OpacityMicromapFormat::TwoState => {
            (limits.max_opacity2_state_subdivision_level, "maxOpacity2StateSubdivisionLevel")
        }
        OpacityMicromapFormat::FourState => {
            (limits.max_opacity4_state_subdivision_level, "maxOpacity4StateSubdivisionLevel")
        }
    }
}

/// The highest level of displacement, and the limit's name.
pub(crate) const fn displacement_limit(limits: &Limits) -> (u32, &'static str) {
    (limits.max_displacement_micromap_subdivision_level, "maxDisplacementMicromapSubdivisionLevel")
}
