//! Every rule, broken by one case and kept by another that differs as little as possible.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod build_command;
mod build_info;
mod content;
mod create2_rules;
mod ext_attach;
mod ext_build;
mod ext_build_content;
mod ext_build_messages;
mod ext_build_tracked;
mod ext_build_world;
mod ext_copy;
mod ext_copy_calls;
mod ext_copy_content;
mod ext_copy_objects;
mod ext_copy_world;
mod ext_create;
mod ext_destroy;
mod ext_properties;
mod geometry;
mod khr_build;
mod khr_content;
mod khr_copy;
mod khr_executed;
mod messages;
mod micromap_data;
mod scene;
mod sequences;
mod tracking;
mod triangles_opacity_micromap;

use omm_validate::RuleId;
use omm_validate::catalog::{Kind, RULES, Status};
use scene::Scene;

/// The rule that each case is about, and whether the case breaks it.
fn every_case() -> Vec<(RuleId, bool)> {
    let scenes = [
        build_command::cases(),
        build_info::cases(),
        content::cases(),
        create2_rules::cases(),
        geometry::cases(),
        khr_build::cases(),
        khr_content::cases(),
        khr_copy::cases(),
        khr_executed::cases(),
        micromap_data::cases(),
        triangles_opacity_micromap::cases(),
    ]
    .concat();
    let builds = [
        ext_attach::cases(),
        ext_build::cases(),
        ext_build_content::cases(),
        ext_build_tracked::cases(),
        ext_create::cases(),
    ]
    .concat();
    let copies = [
        ext_copy::cases(),
        ext_copy_content::cases(),
        ext_copy_objects::cases(),
        ext_destroy::cases(),
        ext_properties::cases(),
    ]
    .concat();
    let scenes = scenes.iter().map(|case| (case.rule, case.breaks()));
    let builds = builds.iter().map(|case| (case.rule, case.breaks()));
    let copies = copies.iter().map(|case| (case.rule, case.breaks()));
    scenes.chain(builds).chain(copies).collect()
}

#[test]
fn valid_builds_are_silent() {
    for scene in [
        Scene::micromap(),
        Scene::bottom_level(),
        Scene::bottom_level_without_indices(),
        Scene::bottom_level_without_micromap(),
        Scene::top_level(),
    ] {
        assert_eq!(scene.check().to_string(), "", "{}", scene.name);
        let sizes = scene.into_sizes();
        assert_eq!(sizes.check().to_string(), "", "sizes of {}", sizes.name);
    }
}

/// Whether a rule is one of last resort. They want whole programs, which the scenes of the other rules are not; scenarios show them,
/// and the sequences of calls of `omm-fuzz` hold them against the simulated device.
pub(crate) fn is_general(rule: RuleId) -> bool {
    RULES.iter().any(|row| row.id == rule && row.is_last_resort())
}

/// Rules of valid usage that are checked, and shown, with the implicit ones.
const SHOWN_WITH_IMPLICIT: [RuleId; 2] = [RuleId::DstMicromap07463, RuleId::HostDstMicromap07463];

#[test]
fn every_rule_is_broken_and_kept() {
    let cases = every_case();
    let here = RULES.iter().filter(|rule| rule.status == Status::Checked && rule.kind != Kind::Implicit);
    let here = here.map(|rule| rule.id).filter(|rule| !SHOWN_WITH_IMPLICIT.contains(rule) && !is_general(*rule));
    let missing: Vec<_> = here
        .map(|rule| (rule, cases.contains(&(rule, true)), cases.contains(&(rule, false))))
        .filter(|(_, broken, kept)| !broken || !kept)
        .map(|(rule, broken, kept)| format!("{rule:?}: broken {broken}, kept {kept}"))
        .collect();
    assert!(missing.is_empty(), "{} rules without cases:\n{}", missing.len(), missing.join("\n"));
}
