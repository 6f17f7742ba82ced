//! The ledger against the list of identifiers and, where it is at hand, against the specification's own list.

use std::collections::BTreeSet;
use std::path::PathBuf;

use super::*;

#[test]
fn every_rule_has_one_row() {
    for id in RuleId::ALL {
        assert_eq!(RULES.iter().filter(|rule| rule.id == *id).count(), 1, "rows of {id}");
        assert_eq!(RuleId::from_vuid(id.vuid()), Some(*id));
        let is_explicit = id.rule().unwrap().kind == Kind::Explicit;
        assert!(
            !is_explicit || format!("{id:?}").ends_with(id.vuid().rsplit('-').next().unwrap()),
            "{id:?} does not end as {id} does"
        );
    }
    assert_eq!(RULES.len(), RuleId::ALL.len());
}

#[test]
fn every_row_explains() {
    for rule in RULES {
        assert!(rule.explanation.len() > 40, "{}: {:?}", rule.vuid(), rule.explanation);
        let reason = rule.status.reason().unwrap_or_default();
        for text in [rule.explanation, rule.note, reason].into_iter().filter(|text| !text.is_empty()) {
            assert!(text.ends_with('.') && !text.contains("  "), "{}: {text:?}", rule.vuid());
        }
    }
}

/// The specification's own list of rules, where it is at hand.
fn listed_rules() -> Option<Vec<serde_json::Value>> {
    let path = std::env::var_os("OMM_REGISTRY_VUIDS").map_or_else(
        || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/registry/vuids.json"),
        PathBuf::from,
    );
    let text = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) => {
            eprintln!("skipped: list of rules absent ({error})");
            return None;
        }
    };
    let list: serde_json::Value = serde_json::from_str(&text).unwrap();
    Some(list["rules"].as_array().unwrap().clone())
}

#[test]
fn every_rule_in_scope_has_a_row_and_no_other_counts() {
    let Some(listed) = listed_rules() else { return };
    let whole = [
        Group::KhrOpacityMicromap,
        Group::ExtOpacityMicromap,
        Group::CreateAccelerationStructure2,
        Group::DeferredHostOperations,
    ];
    let is_in_scope = |rule: &&serde_json::Value| {
        whole.iter().any(|group| rule["group"] == group.name())
            || rule["group"] == Group::KhrAccelerationStructure.name()
                && rule["text"].as_str().unwrap().to_lowercase().contains("micromap")
    };
    let listed: BTreeSet<&str> = listed.iter().filter(is_in_scope).map(|rule| rule["vuid"].as_str().unwrap()).collect();
    let ours: BTreeSet<&str> = RULES.iter().filter(|rule| rule.is_in_scope()).map(Rule::vuid).collect();
    assert_eq!(listed, ours);
}

#[test]
fn every_row_stands_in_the_specification() {
    let Some(listed) = listed_rules() else { return };
    for rule in RULES.iter().filter(|rule| rule.kind != Kind::Own) {
        let entry = listed.iter().find(|entry| entry["vuid"] == rule.vuid());
        let entry = entry.unwrap_or_else(|| panic!("{} is not in the specification", rule.vuid()));
        assert_eq!(entry["group"], rule.group.name(), "{}", rule.vuid());
        assert_eq!(entry["object"], rule.object(), "{}", rule.vuid());
        assert_eq!(entry["kind"], rule.kind.name(), "{}", rule.vuid());
        assert_ne!(entry["text"], rule.explanation, "{}: our own words, please", rule.vuid());
    }
}

#[test]
fn most_rules_can_be_checked() {
    let structural = RULES.iter().filter(|rule| rule.status != Status::Checked).count();
    println!("{} rules, {structural} of them structural", RULES.len());
    assert!(structural * 10 <= RULES.len() * 3);
}
