//! `omm rules` and `omm explain`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[allow(dead_code)]
mod common;

use common::omm;

#[test]
fn rules_are_listed_and_filtered() {
    let all = omm(["rules", "--format", "json"]).json();
    let rules = all["rules"].as_array().unwrap();
    for rule in rules {
        // Rules of our own carry the name of the room that they belong to.
        assert_eq!(rule["kind"] == "own", rule["vuid"].as_str().unwrap().starts_with("OMM-"), "{rule}");
        assert!(!rule["object"].as_str().unwrap().is_empty(), "{rule}");
        assert_eq!(rule["status"] == "structural", rule["reason"].is_string(), "{rule}");
    }
    let some =
        omm(["rules", "--format", "json", "--group", "khr_opacity_micromap", "--object", "GeometryMicromapData"]);
    let some = some.json();
    let some = some["rules"].as_array().unwrap();
    assert!(some.len() < rules.len());
    assert!(some.iter().any(|rule| rule["vuid"].as_str().unwrap().ends_with("count-11643")));
    assert!(some.iter().all(|rule| rule["group"] == "khr_opacity_micromap"));
    let text = omm(["rules", "--object", "no such object"]);
    assert_eq!(text.clean(), "0 rules: 0 checked, 0 structural\n");
}

#[test]
fn a_rule_is_explained_by_identifier_or_number() {
    let vuid = "VUID-vkCmdBuildAccelerationStructuresKHR-indexBuffer-11575";
    let text = omm(["explain", "11575"]);
    assert!(text.clean().starts_with(vuid), "{text:?}");
    let json = omm(["explain", vuid, "--format", "json"]).json();
    assert_eq!(json[0]["vuid"], vuid);
    assert!(!json[0]["explanation"].as_str().unwrap().is_empty());
    let none = omm(["explain", "99999"]);
    assert_eq!(none.error(), "no rule in scope is, or ends in, 99999; `omm rules` lists them");
}
