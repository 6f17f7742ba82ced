//! `omm curve`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[allow(dead_code)]
mod common;

use common::{Folder, golden, omm};
use serde_json::json;

fn record(u: f32, v: f32, level: u32, expected: u32) -> Vec<u8> {
    [u.to_le_bytes(), v.to_le_bytes(), level.to_le_bytes(), expected.to_le_bytes()].concat()
}

fn check(folder: &Folder) -> common::Run {
    omm(["curve".as_ref(), "index".as_ref(), "--records".as_ref(), folder.path("r.bin").as_os_str()])
}

#[test]
fn golden_records_have_no_mismatch() {
    let Some(folder) = golden("bird_curve") else { return };
    let run = omm(["curve", "index", "--records", folder.join("uv_level_index.bin").to_str().unwrap()]);
    assert_eq!(run.clean(), "60000 records, 0 mismatches\n");
    let run =
        omm(["curve", "index", "--format", "json", "--records", folder.join("uv_level_index.bin").to_str().unwrap()]);
    assert_eq!(run.json(), json!({ "records": 60000, "mismatches": 0, "first_mismatches": [] }));
}

#[test]
fn mismatches_are_counted_and_shown() {
    let folder = Folder::new();
    // At level 1 the middle part has index 1, part 2 is at vertex 1.
    let records =
        [record(0.3, 0.3, 1, 1), record(0.9, 0.05, 1, 3), record(f32::NAN, -1.0, 1, 0), record(9.0, 0.0, 0, 1)];
    folder.write("r.bin", records.concat());
    let run = check(&folder);
    assert_eq!((run.status, run.stdout.as_str()), (1, "4 records, 2 mismatches\n"));
    assert_eq!(
        run.stderr,
        "record 1 at byte 16: (0.9, 0.05) at level 1 has index 2, the record says 3\n\
         record 3 at byte 48: (9, 0) at level 0 has index 0, the record says 1\n"
    );
    folder.write("r.bin", []);
    assert_eq!(check(&folder).clean(), "0 records, 0 mismatches\n");
}

#[test]
fn bad_files_are_errors_with_record_and_offset() {
    let folder = Folder::new();
    let path = folder.path("r.bin");
    folder.write("r.bin", [record(0.0, 0.0, 1, 0), record(0.0, 0.0, 13, 0)].concat());
    assert_eq!(
        check(&folder).error(),
        format!("{}: record 1, field level at byte 24: subdivision level 13 is above 12", path.display())
    );
    folder.write("r.bin", &record(0.0, 0.0, 1, 0).repeat(3)[..45]);
    assert_eq!(check(&folder).error(), format!("{}: record 2 at byte 32 is cut short: 13 of 16 bytes", path.display()));
    std::fs::remove_file(&path).unwrap();
    assert!(check(&folder).error().starts_with(&format!("{}: cannot read: ", path.display())));
    let run = omm(["curve", "index", "--records", "/dev/zero"]);
    assert_eq!(run.error(), "/dev/zero: cannot read: not a regular file");
}

#[test]
fn one_point() {
    let run = omm(["curve", "index", "--level", "2", "0.25", "0.6"]);
    assert_eq!(run.clean(), "12  (2, 2)/4  (1, 2)/4  (1, 3)/4  upright\n");
    let run = omm(["--format", "json", "curve", "index", "--level", "0", "-2", "4.5"]);
    assert_eq!(
        run.json(),
        json!({
            "u": -2.0, "v": 4.5, "level": 0, "segments": 1, "index": 0,
            "corners": [[0, 0], [1, 0], [0, 1]], "orientation": "upright",
        })
    );
}

#[test]
fn a_table() {
    let text = "\
index  corners (u, v) in the order of the curve, orientation
    0  (0, 0)/2  (1, 0)/2  (0, 1)/2  upright
    1  (0, 1)/2  (1, 1)/2  (1, 0)/2  flipped
    2  (1, 0)/2  (2, 0)/2  (1, 1)/2  upright
    3  (1, 1)/2  (0, 1)/2  (0, 2)/2  upright
";
    assert_eq!(omm(["curve", "table", "--level", "1"]).clean(), text);
    let json = omm(["curve", "table", "--level", "5", "--format", "json"]).json();
    let rows = json["microtriangles"].as_array().unwrap();
    assert_eq!((rows.len(), &json["segments"]), (1024, &json!(32)));
    assert!(rows.iter().enumerate().all(|(index, row)| row["index"] == json!(index)));
}
