//! `omm trace`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[allow(dead_code)]
mod common;

use common::{Folder, Run, omm};

const BROKEN: &str = r#"(
    title: "Indices of 16 bits cannot lie three bytes apart",
    breaks: ["VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexStride-11573"],
    given: { "leaf": micromap(["O"]), "card": blas(triangles: 1, micromap: "leaf", indices: u16([0])) },
    when: build("card", {"…indexStride": 3}),
)"#;

/// Runs `omm` with words; those in capitals are files of the folder.
fn run(folder: &Folder, words: &str) -> Run {
    let file = |word: &str| word.starts_with(char::is_uppercase).then(|| folder.path(word).into_os_string());
    omm(words.split(' ').map(|word| file(word).unwrap_or_else(|| word.into())))
}

fn recorded() -> Folder {
    let folder = Folder::new();
    folder.write("S.ron", BROKEN);
    run(&folder, "run S.ron --trace T.ommtrace").clean();
    folder
}

#[test]
fn a_recorded_trace_runs_as_its_scenario_did() {
    let folder = recorded();
    let text = run(&folder, "trace run T.ommtrace");
    assert_eq!((text.status, text.stderr.as_str()), (1, ""), "{text:?}");
    assert!(text.stdout.contains("! VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexStride-11573\n"));
    let json = run(&folder, "trace run --format json T.ommtrace");
    let json: serde_json::Value = serde_json::from_str(&json.stdout).unwrap();
    assert_eq!(json["reported"][0], "VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexStride-11573");
    folder.write("Clean.ron", r#"(title: "x", given: { "leaf": micromap(["O"]) }, when: build("leaf"))"#);
    run(&folder, "run Clean.ron --trace C.ron").clean();
    run(&folder, "trace run C.ron").clean();
}

#[test]
fn both_forms_convert_into_each_other() {
    let folder = recorded();
    let said = run(&folder, "trace convert T.ommtrace -o U.ron");
    assert!(said.clean().contains(" events, "), "{said:?}");
    assert!(folder.read("U.ron").starts_with(b"Trace(\n"));
    let json = run(&folder, "trace convert --format json U.ron -o V.ommtrace").json();
    assert_eq!(folder.read("V.ommtrace"), folder.read("T.ommtrace"));
    assert_eq!(json["bytes"], folder.read("T.ommtrace").len());
}

#[test]
fn a_small_trace_reports_the_same() {
    let folder = recorded();
    let said = run(&folder, "trace minimize T.ommtrace -o M.ron --keep 11573");
    assert_eq!(said.status, 0, "{said:?}");
    assert!(said.stderr.lines().all(|line| line.contains(" events, ")), "{said:?}");
    assert!(folder.read("M.ron").len() < 8000);
    let small = run(&folder, "trace run --format json M.ron");
    let small: serde_json::Value = serde_json::from_str(&small.stdout).unwrap();
    let rules = serde_json::json!(["VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexStride-11573"]);
    assert_eq!(small["reported"], rules);
    run(&folder, "trace minimize T.ommtrace -o N.ron");
    assert_eq!(folder.read("N.ron"), folder.read("M.ron"), "the first report is kept, and the result is the same");
}

#[test]
fn what_cannot_be_done_is_said_and_leaves_nothing() {
    let folder = recorded();
    let refused = |words: &str, expected: &str| {
        let run = run(&folder, words);
        assert!(run.error().contains(expected), "{run:?}");
    };
    refused("trace convert T.ommtrace -o X.json", "written as .ron (text) or .ommtrace (bytes)");
    refused("trace minimize T.ommtrace -o X.json", "written as .ron (text) or .ommtrace (bytes)");
    refused("trace minimize T.ommtrace -o X.ron --keep 11575", "the trace does not break VUID-");
    refused("trace minimize T.ommtrace -o X.ron --keep undefined", "the device does not stop");
    refused("trace minimize T.ommtrace -o X.ron --keep 1", "no rule is, or ends in, 1; did you mean");
    refused("run S.ron S.ron --trace X.ron", "a trace is of one scenario, these are 2");
    refused("trace run S.ron", "line ");
    let mut bytes = folder.read("T.ommtrace");
    bytes[40] ^= 1;
    folder.write("B.ommtrace", &bytes);
    refused("trace run B.ommtrace", "profile.checksum at byte 12: found ");
    assert!(!folder.path("X.ron").exists() && !folder.path("X.json").exists());
}
