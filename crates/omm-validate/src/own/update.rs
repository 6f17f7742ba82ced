//! An update leaves alone what an update must leave alone.

use omm_model::vk;
use vk::BuildAccelerationStructureFlags as BuildFlags;

use super::finding::OwnFinding;
use super::memory::Executed;
use crate::content::range;
use crate::context::{BuildContext, GeometryContext};
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::{Attachment, Built};
use crate::violation::ViolationKind;

/// OMM-update-01
pub(super) fn check(build: &BuildContext<'_>, executed: &Executed<'_>, report: &mut Report) {
    let info = build.info;
    if info.mode != vk::BuildAccelerationStructureMode::UPDATE {
        return;
    }
    let source = executed.state.acceleration_structure(info.src_acceleration_structure);
    let Some(contents) = source.and_then(|source| source.contents.as_ref()) else { return };
    let Some(built) = contents.built.as_deref() else { return };
    if !built.flags.contains(BuildFlags::ALLOW_UPDATE) {
        let kind = ViolationKind::MissingFlags { found: built.flags.into(), required: BuildFlags::ALLOW_UPDATE.into() };
        report.push(RuleId::Update01, &build.at.field("srcAccelerationStructure"), kind);
    }
    differs(&build.at.field("type"), "a structure of type", info.ty.0 as u64, built.ty.0 as u64, report);
    let (found, required) = (info.flags.bits().into(), built.flags.bits().into());
    differs(&build.at.field("flags"), "flags", found, required, report);
    let (found, required) = (info.geometries_iter().count() as u64, built.geometries.len() as u64);
    differs(&build.at.field("geometryCount"), "a number of geometries", found, required, report);
    if report.is_empty() {
        build.each_geometry(|geometry| {
            let was = contents.attachments.get(geometry.index).copied().unwrap_or_default();
            same_geometry(geometry, built, was, executed, report);
        });
    }
}

fn same_geometry(
    geometry: &GeometryContext<'_>,
    built: &Built,
    was: Attachment,
    executed: &Executed<'_>,
    report: &mut Report,
) {
    let Some(original) = built.geometries.get(geometry.index) else { return };
    let (ty, flags) = (geometry.geometry.geometry_type, geometry.geometry.flags);
    differs(&geometry.at.field("geometryType"), "geometry of type", ty.0 as u64, original.ty.0 as u64, report);
    let (found, required) = (flags.bits().into(), original.flags.bits().into());
    differs(&geometry.at.field("flags"), "flags", found, required, report);
    if let (Some(found), Some(required)) =
        (range(geometry, executed.memory), built.primitive_counts.get(geometry.index))
    {
        differs(&geometry.at, "a number of primitives", found.primitive_count.into(), (*required).into(), report);
    }
    same_attachment(geometry, built.flags, was, report);
}

/// Whether there is a micromap, and which, is free only as far as the flags of the build say.
fn same_attachment(geometry: &GeometryContext<'_>, flags: BuildFlags, was: Attachment, report: &mut Report) {
    let is = Attachment::of(geometry.geometry);
    let kind = |attachment: Attachment| match attachment {
        Attachment::None => 0_u64,
        Attachment::Khr(handle) => 1 + u64::from(!handle.is_null()),
        Attachment::Ext(handle) => 1 + u64::from(!handle.is_null()),
    };
    let is_ext = matches!(is, Attachment::Ext(_));
    let full = flags.contains(BuildFlags::ALLOW_OPACITY_MICROMAP_UPDATE);
    let at = geometry.at.field("geometry");
    let at = at.field("triangles");
    // The KHR extension has rules of its own on this.
    if !(full && is_ext && kind(was).min(kind(is)) > 0) {
        differs(&at, "a micromap: none (0), a null one (1) or another (2):", kind(is), kind(was), report);
    }
    let either = BuildFlags::ALLOW_OPACITY_MICROMAP_UPDATE.union(BuildFlags::ALLOW_OPACITY_MICROMAP_DATA_UPDATE);
    if let (Attachment::Ext(found), Attachment::Ext(required)) = (is, was)
        && !flags.intersects(either)
        && found != required
    {
        report.push(RuleId::Update01, &at, ViolationKind::OtherHandle { found: found.0, required: required.0 });
    }
}

fn differs(at: &At<'_>, what: &'static str, found: u64, required: u64, report: &mut Report) {
    if found != required {
        report.push(RuleId::Update01, at, ViolationKind::Own(OwnFinding::Differs { what, found, required }));
    }
}
