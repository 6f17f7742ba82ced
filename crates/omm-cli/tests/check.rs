//! `omm check`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[allow(dead_code)]
mod common;

use common::{Folder, Run, golden, omm};
use serde_json::Value;

/// Two triangles: 16 elements of 2 bits at offset 0, 4 elements of 1 bit at offset 4.
const DESC: [[u32; 2]; 2] = [[0, 2 | 2 << 16], [4, 1 | 1 << 16]];

fn words(words: impl IntoIterator<Item = u32>) -> Vec<u8> {
    words.into_iter().flat_map(u32::to_le_bytes).collect()
}

fn check(array: &[u8], desc: &[[u32; 2]], index: &[i32], more: &[&str]) -> Run {
    let folder = Folder::new();
    folder.write("a.bin", array);
    folder.write("d.bin", words(desc.as_flattened().iter().copied()));
    folder.write("i.bin", words(index.iter().map(|&index| index as u32)));
    let [array, desc, index] = ["a.bin", "d.bin", "i.bin"].map(|name| folder.path(name));
    let mut arguments = vec!["check", "array", "--format", "json", "--array", array.to_str().unwrap()];
    arguments.extend(["--desc", desc.to_str().unwrap(), "--index", index.to_str().unwrap()]);
    arguments.extend(more);
    omm(arguments)
}

/// The rules that were reported, by number, and whether the device stopped.
fn found(run: &Run) -> (Vec<String>, bool) {
    assert_eq!((run.status, run.stderr.as_str()), (1, ""), "{run:?}");
    let json: Value = serde_json::from_str(&run.stdout).unwrap();
    let number = |violation: &Value| violation["vuid"].as_str().unwrap().rsplit('-').next().unwrap().to_owned();
    (json["violations"].as_array().unwrap().iter().map(number).collect(), !json["device"].is_null())
}

#[test]
fn sound_data_is_clean() {
    let json = check(&[0; 5], &DESC, &[0, 1, -1, -4], &[]).json();
    assert_eq!((&json["micromap_triangles"], &json["geometry_triangles"]), (&2.into(), &4.into()));
    assert_eq!(json["violations"], Value::Array(Vec::new()));
    check(&[0; 5], &DESC, &[0, -1], &["--base-triangle", "1", "--profile", "minimum"]).clean();
}

#[test]
fn each_mistake_is_named() {
    // The index is one too many.
    assert_eq!(found(&check(&[0; 5], &DESC, &[0, 2], &[])), (vec!["11575".to_owned()], true));
    // The same by the base.
    assert_eq!(found(&check(&[0; 5], &DESC, &[1], &["--base-triangle", "1"])), (vec!["11575".to_owned()], true));
    // Level 5 is beyond the minimum profile, in the array and in the usage counts made from it.
    let finer = [[0, 5 | 2 << 16]];
    let (rules, _) = found(&check(&[0; 256], &finer, &[0], &["--profile", "minimum"]));
    assert!(rules.iter().any(|rule| rule == "11566") && rules.iter().any(|rule| rule == "11564"), "{rules:?}");
    // A format that is none.
    let (rules, stopped) = found(&check(&[0; 5], &[[0, 2 | 7 << 16]], &[0], &[]));
    assert_eq!((rules, stopped), (vec!["11555".to_owned(), "parameter".to_owned()], true));
}

#[test]
fn what_cannot_be_read_is_one_error() {
    let folder = Folder::new();
    folder.write("a.bin", [0; 4]);
    folder.write("d.bin", [0; 9]);
    let [array, desc] = ["a.bin", "d.bin"].map(|name| folder.path(name));
    let run = omm(["check", "array", "--array", array.to_str().unwrap(), "--desc", desc.to_str().unwrap()]);
    assert!(run.error().ends_with("d.bin: 9 bytes are not a multiple of 8, the size of an element"), "{run:?}");
    let run = omm(["check", "array", "--array", "a", "--desc", "d", "--profile", array.to_str().unwrap()]);
    assert!(run.error().contains("a.bin: not a device profile: "), "{run:?}");
}

/// What another baker wrote breaks no rule.
#[test]
fn golden_arrays_are_clean() {
    let Some(folder) = golden("bake") else { return };
    let mut checked = 0;
    for name in common::names(&folder) {
        let Some(name) = name.strip_suffix(".array.bin") else { continue };
        let path = |part: &str| folder.join(format!("{name}.{part}.bin")).display().to_string();
        omm(["check", "array", "--array", &path("array"), "--desc", &path("desc"), "--index", &path("index")]).clean();
        checked += 1;
    }
    assert_eq!(checked, 20);
}
