//! `omm rules` and `omm explain`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[allow(dead_code)]
mod common;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use common::{Folder, omm};
use serde_json::Value;

/// The scenarios of the source tree.
const SPEC_TESTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../spec-tests");

fn rules(arguments: &[&str]) -> Vec<Value> {
    let arguments = ["rules", "--format", "json"].iter().chain(arguments);
    let mut json = omm(arguments).json();
    assert_eq!(json.as_object().unwrap().len(), 1, "{json}");
    serde_json::from_value(json["rules"].take()).unwrap()
}

#[test]
fn every_rule_has_a_verdict_and_every_checked_one_its_scenarios() {
    let keys = ["vuid", "group", "object", "kind", "status", "reason", "scenarios"];
    for rule in rules(&[]) {
        assert_eq!(rule.as_object().unwrap().keys().collect::<Vec<_>>(), keys, "{rule}");
        // Rules of our own carry the name of the room that they belong to.
        assert_eq!(rule["kind"] == "own", rule["vuid"].as_str().unwrap().starts_with("OMM-"), "{rule}");
        assert!(!rule["object"].as_str().unwrap().is_empty(), "{rule}");
        assert_eq!(rule["status"] == "structural", rule["reason"].is_string(), "{rule}");
        let scenarios = rule["scenarios"].as_array().unwrap();
        assert!(rule["status"] == "structural" || scenarios.len() > 1, "{rule}");
        for scenario in scenarios {
            let text = fs::read_to_string(Path::new(SPEC_TESTS).join(scenario.as_str().unwrap())).unwrap();
            assert!(text.contains(rule["vuid"].as_str().unwrap()), "{scenario}");
        }
    }
}

#[test]
fn rules_are_filtered() {
    let all = rules(&[]);
    for key in ["group", "status"] {
        let values: BTreeSet<&str> = all.iter().map(|rule| rule[key].as_str().unwrap()).collect();
        let of_each = values.iter().map(|value| {
            let some = rules(&[&format!("--{key}"), value]);
            assert!(some.iter().all(|rule| rule[key] == *value), "{key} {value}");
            some.len()
        });
        assert_eq!(of_each.sum::<usize>(), all.len(), "{key}");
    }
    let some = rules(&["--group", "khr_opacity_micromap", "--object", "GeometryMicromapData", "--status", "checked"]);
    assert!(some.iter().any(|rule| rule["vuid"].as_str().unwrap().ends_with("count-11643")));
    assert!(some.iter().all(|rule| rule["object"] == "VkAccelerationStructureGeometryMicromapDataKHR"));
    let unknown = omm(["rules", "--group", "khr_opacity_micromaps"]);
    assert_eq!((unknown.status, unknown.stdout.as_str()), (2, ""), "{unknown:?}");
    assert!(unknown.stderr.contains("khr_opacity_micromap"), "{unknown:?}");
}

#[test]
fn the_list_ends_in_a_summary() {
    let text = omm(["rules"]);
    let all = rules(&[]);
    // Our own rules, and two that something in scope depends on.
    let beyond = all.iter().filter(|rule| rule["vuid"].as_str().unwrap().starts_with("OMM-")).count() + 2;
    let in_scope = all.len() - beyond;
    let last = text.clean().lines().last().unwrap();
    assert!(last.starts_with(&format!("{in_scope} rules in scope: ")), "{last}");
    assert!(last.ends_with(&format!(" structural, none without a verdict; and {beyond} beyond it")), "{last}");
    let text = omm(["rules", "--object", "no such object"]);
    assert_eq!(text.clean(), "0 rules in scope: 0 checked, 0 structural, none without a verdict\n");
}

#[test]
fn the_program_needs_no_source_tree() {
    let folder = Folder::new();
    let copy = folder.path("omm-elsewhere");
    fs::copy(env!("CARGO_BIN_EXE_omm"), &copy).unwrap();
    let run = |arguments: &[&str]| Command::new(&copy).args(arguments).current_dir(copy.parent().unwrap()).output();
    for arguments in [&["rules", "--format", "json"][..], &["explain", "11575"]] {
        let (there, here) = (run(arguments).unwrap(), omm(arguments));
        assert_eq!(String::from_utf8(there.stdout).unwrap(), here.clean());
    }
}

#[test]
fn a_rule_is_explained_by_identifier_or_number() {
    let vuid = "VUID-vkCmdBuildAccelerationStructuresKHR-indexBuffer-11575";
    let text = omm(["explain", "11575"]);
    assert!(text.clean().starts_with(vuid), "{text:?}");
    for wanted in [vuid, "indexBuffer-11575", &vuid.to_lowercase()] {
        assert_eq!(omm(["explain", wanted]).clean(), text.clean());
    }
    let json = omm(["explain", vuid, "--format", "json"]).json();
    assert_eq!(json[0]["vuid"], vuid);
    assert!(!json[0]["explanation"].as_str().unwrap().is_empty());
    // Both commands that build on the device have a rule of this number.
    let both = omm(["explain", "10607", "--format", "json"]).json();
    assert_eq!(both.as_array().unwrap().len(), 2);
}

#[test]
fn an_explanation_shows_path_scenario_and_report() {
    let number = "11573";
    let json = &omm(["explain", number, "--format", "json"]).json()[0];
    let (broken, text) = (&json["broken_by"], omm(["explain", number]));
    let report = &broken["reports"][0];
    assert_eq!(report["vuid"], json["vuid"]);
    let place = format!("{}(): {}", report["command"].as_str().unwrap(), report["path"].as_str().unwrap());
    assert_eq!(json["looks_at"][0], place);
    assert!(place.ends_with(".indexStride"), "{place}");
    let file = Path::new(SPEC_TESTS).join(broken["scenario"].as_str().unwrap());
    assert_eq!(broken["text"], fs::read_to_string(file).unwrap());
    let found = format!("{place}: found {}", report["found"].as_str().unwrap());
    for part in ["Looks at:", "Broken by spec-tests/", "breaks: [", &found, "See also: "] {
        assert!(text.clean().contains(part), "{part}: {}", text.stdout);
    }
    // What no call can be written down to break has a reason and nothing to show.
    let structural = &rules(&["--status", "structural"])[0];
    let text = omm(["explain", structural["vuid"].as_str().unwrap()]);
    assert!(text.clean().contains("\nNot checked: ") && !text.stdout.contains("Broken by"), "{}", text.stdout);
}

#[test]
fn an_unknown_rule_is_met_with_its_neighbours() {
    let error = |wanted: &str| omm(["explain", wanted]).error().to_owned();
    assert_eq!(
        error("no rule at all, by any name"),
        "no rule is, or ends in, no rule at all, by any name; `omm rules` lists them"
    );
    let near = error("1157");
    let offered = near.split("did you mean ").nth(1).unwrap().split('?').next().unwrap();
    let offered: Vec<&str> = offered.split(", ").flat_map(|part| part.split(" or ")).collect();
    assert!(offered.len() == 3 && offered.iter().all(|number| number.starts_with("1157")), "{near}");
    let near = error("VUID-vkCmdBuildAccelerationStructureKHR-indexBuffer-11575");
    assert!(near.contains("did you mean VUID-vkCmdBuildAccelerationStructuresKHR-indexBuffer-11575"), "{near}");
    assert!(error("").starts_with("no rule is, or ends in, "));
}
