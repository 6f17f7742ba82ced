//! Rules of the build commands on the micromaps of a structure that is updated.

use omm_model::vk;
use vk::BuildAccelerationStructureFlags as BuildFlags;

use crate::context::{BuildContext, GeometryContext, OpacityMicromapContext, Purpose};
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::{Attachment, Built, Contents, State};
use crate::violation::{Origin, ViolationKind};

const MICROMAP: &str = "VkAccelerationStructureTrianglesOpacityMicromapKHR";

/// The rules of one command.
struct Rules {
    micromap_11625: RuleId,
    null_micromap_11626: RuleId,
    new_micromap_11627: RuleId,
    origin_11628: RuleId,
    same_micromap_11629: RuleId,
}

const DEVICE: Rules = Rules {
    micromap_11625: RuleId::UpdateMicromap11625,
    null_micromap_11626: RuleId::UpdateNullMicromap11626,
    new_micromap_11627: RuleId::UpdateNewMicromap11627,
    origin_11628: RuleId::UpdateOrigin11628,
    same_micromap_11629: RuleId::UpdateSameMicromap11629,
};

const INDIRECT: Rules = Rules {
    micromap_11625: RuleId::IndirectUpdateMicromap11625,
    null_micromap_11626: RuleId::IndirectUpdateNullMicromap11626,
    new_micromap_11627: RuleId::IndirectUpdateNewMicromap11627,
    origin_11628: RuleId::IndirectUpdateOrigin11628,
    same_micromap_11629: RuleId::IndirectUpdateSameMicromap11629,
};

/// The rules of the command, if this is an update that has such.
const fn rules(build: &BuildContext<'_>) -> Option<&'static Rules> {
    match build.purpose {
        _ if build.info.mode.0 != vk::BuildAccelerationStructureMode::UPDATE.0 => None,
        Purpose::Build { .. } => Some(&DEVICE),
        Purpose::Indirect { .. } => Some(&INDIRECT),
        Purpose::Host | Purpose::Sizes => None,
    }
}

/// What is known when an update is recorded.
pub(super) fn check(build: &BuildContext<'_>, state: &State, report: &mut Report) {
    let (Some(rules), Some(command_buffer)) = (rules(build), build.command_buffer()) else { return };
    let Some(original) = state.built(command_buffer, build.info.src_acceleration_structure) else { return };
    build.each_geometry(|geometry| {
        let Some(attachment) = attached_originally(original, geometry.index) else { return };
        geometry.with_triangles(|at, triangles| {
            let now = triangles.opacity_micromap().map(|attached| attached.micromap);
            match attachment {
                Attachment::Khr(micromap) if micromap.is_null() => {
                    null_micromap_11626(at, now, rules.null_micromap_11626, report);
                }
                Attachment::Khr(_) => micromap_11625(at, now, rules.micromap_11625, report),
                Attachment::None | Attachment::Ext(_) => {
                    new_micromap_11627(at, now, rules.new_micromap_11627, report);
                }
            }
        });
    });
}

/// What is known when an update executes.
pub(super) fn check_executed(geometry: &GeometryContext<'_>, state: &State, report: &mut Report) {
    let build = geometry.build;
    let source = state.acceleration_structure(build.info.src_acceleration_structure);
    let (Some(rules), Some(contents)) = (rules(build), source.and_then(|source| source.contents.as_ref())) else {
        return;
    };
    let Some(built) = contents.built.as_deref() else { return };
    let Some(Attachment::Khr(original)) = attached_originally(built, geometry.index) else { return };
    geometry.each_opacity_micromap(|attached| {
        if !original.is_null() && !attached.attached.micromap.is_null() {
            let update = Update { contents, flags: built.flags, original, attached };
            update.origin_11628(rules.origin_11628, state, report);
            update.same_micromap_11629(rules.same_micromap_11629, report);
        }
    });
}

/// What the original build attached to a geometry of triangles.
fn attached_originally(original: &Built, index: usize) -> Option<Attachment> {
    let geometry = original.geometries.get(index)?;
    (geometry.ty == vk::GeometryType::TRIANGLES).then_some(geometry.attachment)
}

/// A geometry that had a micromap has one.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11625
fn micromap_11625(at: &At<'_>, now: Option<vk::AccelerationStructure>, rule: RuleId, report: &mut Report) {
    match now {
        None => {
            let kind = ViolationKind::StructureMissing { structure: MICROMAP };
            report.push(rule, &at.field("pNext"), kind);
        }
        Some(micromap) if micromap.is_null() => {
            report.push(rule, &at.chained(MICROMAP).field("micromap"), ViolationKind::HandleNull);
        }
        Some(_) => {}
    }
}

/// A geometry that had special indices alone has these.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11626
fn null_micromap_11626(at: &At<'_>, now: Option<vk::AccelerationStructure>, rule: RuleId, report: &mut Report) {
    match now {
        None => {
            let kind = ViolationKind::StructureMissing { structure: MICROMAP };
            report.push(rule, &at.field("pNext"), kind);
        }
        Some(micromap) if !micromap.is_null() => {
            let at = at.chained(MICROMAP).about(micromap);
            report.push(rule, &at.field("micromap"), ViolationKind::HandleNotNull { found: micromap.0 });
        }
        Some(_) => {}
    }
}

/// A geometry that had no micromap has none.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11627
fn new_micromap_11627(at: &At<'_>, now: Option<vk::AccelerationStructure>, rule: RuleId, report: &mut Report) {
    if now.is_some() {
        report.push(rule, &at.chained(MICROMAP), ViolationKind::StructureForbidden { structure: MICROMAP });
    }
}

/// An update of a geometry that has a micromap and had one.
struct Update<'a> {
    /// What the source holds.
    contents: &'a Contents,
    /// The flags of the original build.
    flags: BuildFlags,
    /// The micromap of the original build.
    original: vk::AccelerationStructure,
    attached: &'a OpacityMicromapContext<'a>,
}

impl Update<'_> {
    /// A deserialized structure keeps the micromap that was deserialized with it.
    ///
    /// VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11628
    fn origin_11628(&self, rule: RuleId, state: &State, report: &mut Report) {
        if self.contents.deserialized.is_none() || self.flags.contains(BuildFlags::ALLOW_OPACITY_MICROMAP_UPDATE) {
            return;
        }
        let found = self.attached.attached.micromap;
        let contents = state.acceleration_structure(found).and_then(|micromap| micromap.contents.as_ref());
        let origin = match contents.map(|contents| contents.deserialized) {
            Some(None) => Origin::Built,
            Some(Some(deserialized)) if deserialized.origin.is_some_and(|origin| origin != self.original.0) => {
                Origin::Other
            }
            _ => return,
        };
        report.push(rule, &self.attached.at.field("micromap"), ViolationKind::WrongOrigin { found: found.0, origin });
    }

    /// A structure keeps its micromap unless it was built to have others.
    ///
    /// VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11629
    fn same_micromap_11629(&self, rule: RuleId, report: &mut Report) {
        let updates = BuildFlags::ALLOW_OPACITY_MICROMAP_UPDATE.union(BuildFlags::ALLOW_OPACITY_MICROMAP_DATA_UPDATE);
        let found = self.attached.attached.micromap;
        let may_differ = self.flags.intersects(updates) || self.contents.deserialized.is_some();
        if !may_differ && found != self.original {
            let kind = ViolationKind::OtherHandle { found: found.0, required: self.original.0 };
            report.push(rule, &self.attached.at.field("micromap"), kind);
        }
    }
}
