//! The scenarios of `spec-tests/`: each is run and its transcript compared with the snapshot beside it.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use omm_scenario::{Library, Scenario, files, run};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../spec-tests")
}

fn library() -> Library {
    Library::read(&folder()).unwrap_or_else(|error| panic!("{error}"))
}

/// Whether a scenario is asked for: `OMM_SPEC=ext_build` runs those alone whose path has that in it.
fn wanted(path: &Path) -> bool {
    std::env::var("OMM_SPEC").map_or(true, |part| path.to_str().unwrap().contains(&part))
}

/// Compares one scenario's transcript with its snapshot, and judges it.
fn check(path: &Path, scenario: &Scenario) -> Result<(), String> {
    let transcript = run(scenario).map_err(|error| error.to_string())?;
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(folder().join(path.parent().unwrap()));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    let name = path.file_stem().unwrap().to_str().unwrap();
    let compare = || settings.bind(|| insta::assert_snapshot!(name, transcript));
    catch_unwind(AssertUnwindSafe(compare)).map_err(|_| "the transcript is not the snapshot".to_owned())?;
    let failures: Vec<String> = transcript.failures().collect();
    if transcript.passed() { Ok(()) } else { Err(format!("{}\n{transcript}", failures.join("\n"))) }
}

#[test]
fn scenarios_pass_and_are_as_recorded() {
    let library = library();
    assert!(!library.is_empty(), "there are no scenarios in {}", folder().display());
    let failed = |(path, scenario): (&Path, &Scenario)| {
        let error = check(path, scenario).err()?;
        Some(format!("{}: {error}", path.display()))
    };
    let failed: Vec<String> = library.iter().filter(|(path, _)| wanted(path)).filter_map(failed).collect();
    assert!(failed.is_empty(), "{} of {} fail\n{}", failed.len(), library.len(), failed.join("\n\n"));
}

#[test]
fn every_snapshot_belongs_to_a_scenario() {
    let scenarios: BTreeSet<PathBuf> = library().iter().map(|(path, _)| path.with_extension("")).collect();
    for snapshot in files(&folder(), "snap").unwrap() {
        assert!(scenarios.contains(&snapshot.with_extension("")), "{} has no scenario", snapshot.display());
    }
    let waiting = files(&folder(), "new").unwrap();
    assert!(waiting.is_empty(), "these wait to be accepted or removed: {waiting:?}");
}

#[test]
fn names_say_what_rule_is_broken_or_kept() {
    for (path, scenario) in library().iter() {
        // What lies in no section explains the form.
        if path.components().count() < 2 {
            continue;
        }
        let name = path.file_stem().unwrap().to_str().unwrap();
        let parts: Vec<&str> = name.rsplitn(3, '-').collect();
        let Some((outcome @ ("pass" | "fail"), number)) = parts.first().copied().zip(parts.get(1).copied()) else {
            assert!(scenario.breaks().is_empty(), "{name} breaks a rule and should end in its number and -fail");
            continue;
        };
        let rules = if outcome == "fail" { scenario.breaks() } else { scenario.keeps() };
        let ends = |rule: &omm_validate::RuleId| rule.vuid().ends_with(&format!("-{number}"));
        assert!(rules.iter().any(ends), "{name} is not about a rule {number}");
        assert_eq!(outcome == "fail", !scenario.breaks().is_empty(), "{name}");
    }
}

#[test]
fn every_rule_is_broken_by_one_scenario_and_kept_by_another() {
    let missing = library().missing();
    assert!(missing.is_empty(), "without a scenario that breaks only it and one that keeps it: {missing:#?}");
}

#[test]
fn the_library_holds_every_scenario() {
    let (built_in, read) = (Library::built_in().unwrap(), library());
    assert_eq!(built_in.len(), read.len());
    for ((path, carried), (file, scenario)) in built_in.iter().zip(read.iter()) {
        assert_eq!((path, carried.name()), (file, scenario.name()));
        assert!(carried.text() == scenario.text(), "{} is another text", path.display());
    }
}

/// Why the simulated device does not stop where a rule is broken: the last word of a line of `rules-without-effect.txt`.
const REASONS: [&str; 8] = [
    // It needs no promise of the program that a driver may need: alignment, usage, features, queues, render passes.
    "promise",
    // It is one device, whatever device, physical device or group a call names.
    "one-device",
    // It looks at what a structure is and not at what it or its chain says beside that.
    "structure",
    // It does not look at the value, or not at all of it.
    "unread",
    // It has an answer all the same, which is not one of a driver.
    "answered",
    // It says that it does not simulate this, which is no judgement.
    "unsupported",
    // What is broken is only recorded or asked for; a stop would come of another mistake.
    "asked",
    // What is built is complete; only what is made of it later is wrong.
    "later",
];

/// Two readings: a rule with an effect that can be seen has a scenario in which the device stops. The others are listed, with why.
#[test]
fn the_device_stops_where_a_rule_is_broken_that_has_an_effect() {
    let listed = std::fs::read_to_string(folder().join("rules-without-effect.txt")).unwrap();
    let lines = listed.lines().filter(|line| !line.starts_with('#') && !line.is_empty());
    let listed: BTreeSet<&str> = lines
        .map(|line| line.split_once(' ').expect(line))
        .map(|(vuid, reason)| {
            assert!(REASONS.contains(&reason), "{vuid}: {reason} is no reason");
            vuid
        })
        .collect();
    let (library, mut stopping) = (library(), BTreeSet::new());
    let mut breaking = BTreeSet::new();
    for (_, scenario) in library.iter().filter(|(_, scenario)| !scenario.breaks().is_empty()) {
        breaking.extend(scenario.breaks().iter().map(|rule| rule.vuid()));
        if run(scenario).unwrap().stops() {
            stopping.extend(scenario.breaks().iter().map(|rule| rule.vuid()));
        }
    }
    let silent: BTreeSet<&str> = breaking.difference(&stopping).copied().collect();
    println!("{} rules stop the device, {} do not", stopping.len(), silent.len());
    let unlisted: Vec<_> = silent.difference(&listed).collect();
    let settled: Vec<_> = listed.difference(&silent).collect();
    assert!(unlisted.is_empty(), "the device goes on where these are broken, and no reason is listed: {unlisted:#?}");
    assert!(settled.is_empty(), "the device stops where these are broken, or no scenario breaks them: {settled:#?}");
}

#[test]
fn transcripts_are_the_same_each_time_and_for_programs() {
    for (path, scenario) in library().iter() {
        let transcript = run(scenario).unwrap();
        assert_eq!(transcript.to_string(), run(scenario).unwrap().to_string(), "{}", path.display());
        let json = serde_json::to_value(&transcript).unwrap();
        assert_eq!(json["passed"], transcript.passed());
        assert_eq!(
            json["when"].as_array().map(Vec::len).unwrap_or_default() > 0,
            transcript.to_string().contains("\nwhen\n")
        );
    }
}
