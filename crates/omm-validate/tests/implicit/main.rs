//! The rules that follow from the registry: each broken by one value of a valid call, and kept by another.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod calls;
mod case;
mod command;
mod member;
mod messages;
mod mutated;
mod structure;
mod world;

use calls::{BASES, base};
use omm_validate::RuleId;
use omm_validate::catalog::{Kind, RULES, Status};
use world::World;

/// Rules that an author wrote down although they are of this sort.
const EXPLICIT: [RuleId; 2] = [RuleId::DstMicromap07463, RuleId::HostDstMicromap07463];

fn every_case() -> Vec<case::Case> {
    [command::cases(), member::cases(), structure::cases()].into_iter().flatten().collect()
}

#[test]
fn valid_calls_are_silent() {
    for name in BASES {
        assert_eq!(case::findings(&World::new(), &base(name)), [], "{name}");
    }
}

#[test]
fn each_case_breaks_what_it_says() {
    let failures: Vec<_> = every_case().iter().flat_map(case::Case::failures).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn every_implicit_rule_has_a_case() {
    let cases = every_case();
    let missing: Vec<_> = RULES
        .iter()
        .filter(|rule| rule.kind == Kind::Implicit || EXPLICIT.contains(&rule.id))
        .filter(|rule| rule.status == Status::Checked)
        .filter(|rule| cases.iter().all(|case| case.rule() != rule.id))
        .map(|rule| rule.id)
        .collect();
    assert_eq!(missing, [], "implicit rules without a case");
}

#[test]
fn what_was_not_seen_is_not_judged() {
    for name in BASES {
        let world = World(omm_validate::Validator::new(omm_model::profile::DeviceProfile::reference()));
        assert_eq!(case::findings(&world, &base(name)), [], "{name}");
    }
}
