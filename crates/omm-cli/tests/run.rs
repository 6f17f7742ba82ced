//! `omm run`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[allow(dead_code)]
mod common;

use common::{Folder, omm};

const README: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../spec-tests/readme.ron");

#[test]
fn the_explaining_scenario_passes() {
    let text = omm(["run", README]);
    assert!(text.clean().trim_end().ends_with("passed"), "{text:?}");
    let json = omm(["run", "--format", "json", README, README]).json();
    assert_eq!(json.as_array().unwrap().len(), 2);
}

#[test]
fn an_expectation_that_fails_is_a_violation() {
    let folder = Folder::new();
    let scenario = r#"(title: "Nothing is broken", given: { "leaf": micromap(["TOUu"]) }, when: [sizes("leaf")], then: [undefined("never")])"#;
    folder.write("s.ron", scenario);
    let run = omm(["run".as_ref(), folder.path("s.ron").as_os_str()]);
    assert_eq!((run.status, run.stderr.as_str()), (1, ""), "{run:?}");
}

#[test]
fn mistakes_are_shown_in_the_source() {
    let folder = Folder::new();
    folder.write("s.ron", "(title: \"x\",\n given: { \"leaf\": micromapp([\"TOUu\"]) })");
    let run = omm(["run".as_ref(), folder.path("s.ron").as_os_str()]);
    assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{run:?}");
    assert!(run.stderr.contains("micromapp"), "{run:?}");
}
