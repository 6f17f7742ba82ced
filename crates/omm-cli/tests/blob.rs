//! `omm blob relocate`, `omm diff` and `omm inspect --dump`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[allow(dead_code)]
mod common;

use std::fs;

use common::{Folder, golden, names, omm};
use omm_layout::object::{MicromapContents, MicromapTriangleData, TlasContents};
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::profile::DeviceProfile;
use omm_model::vk;
use serde_json::json;

fn serialize(object: &[u8]) -> Vec<u8> {
    let device = DeviceProfile::reference();
    omm_serialize::serialize_object(object, device.driver_uuid, device.compatibility_uuid).unwrap()
}

fn tlas(references: &[u64]) -> Vec<u8> {
    let instance = |&acceleration_structure_reference: &u64| vk::Instance {
        acceleration_structure_reference,
        ..vk::Instance::default()
    };
    serialize(&TlasContents { flags: 0, instances: references.iter().map(instance).collect() }.encode().unwrap())
}

fn micromap(data: &[u8; 4]) -> Vec<u8> {
    let triangle = MicromapTriangleData {
        subdivision_level: SubdivisionLevel::new(2).unwrap(),
        format: OpacityMicromapFormat::FourState,
        data,
    };
    serialize(&MicromapContents { flags: 2, triangles: vec![triangle; 2] }.encode().unwrap())
}

fn text(path: &std::path::Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn references_are_listed_and_replaced() {
    let folder = Folder::new();
    let (input, map, out) = (folder.path("in.blob"), folder.path("map.json"), folder.path("out.blob"));
    folder.write("in.blob", tlas(&[0x1000, 0x2000, 0x1000]));
    let listed = omm(["blob", "relocate", text(&input), "--list"]);
    assert_eq!(listed.clean(), "0x0000000000001000\n0x0000000000002000\n0x0000000000001000\n");
    folder.write("map.json", r#"{"0x1000": "0x5000", "0x9": "0x8"}"#);
    let arguments = ["blob", "relocate", text(&input), "--map", text(&map), "-o", text(&out)];
    let run = omm(arguments);
    let lines = "2 of 3 references replaced, 0 are null\nkept, not in the map: 0x0000000000002000\n\
                 in the map, but nothing refers to it: 0x0000000000000009\n";
    assert_eq!(run.clean(), lines);
    assert_eq!(folder.read("out.blob"), tlas(&[0x5000, 0x2000, 0x5000]));
    let diff = omm(["diff", text(&input), text(&out)]);
    assert_eq!((diff.status, diff.stderr.as_str()), (1, ""));
    let line = "handles[0]: 0x0000000000001000 in the first, 0x0000000000005000 in the second\n";
    assert!(diff.stdout.starts_with(line) && diff.stdout.ends_with("2 differences\n"), "{diff:?}");
    for bad in [r#"{"1000": "0x1"}"#, r#"{"0x1": 5}"#, r#"{"0x+1": "0x2"}"#, r#"{"0x1": "0x2", "0x01": "0x3"}"#, "[]"] {
        folder.write("map.json", bad);
        fs::remove_file(&out).ok();
        assert!(omm(arguments).error().contains("map.json: "), "{bad}");
        assert!(!out.exists());
    }
}

#[test]
fn differences_are_said_in_words() {
    let folder = Folder::new();
    let (a, b) = (folder.path("a.blob"), folder.path("b.blob"));
    folder.write("a.blob", micromap(&[1, 2, 3, 4]));
    folder.write("b.blob", micromap(&[1, 2, 3, 4]));
    assert_eq!(omm(["diff", text(&a), text(&b)]).clean(), "no difference\n");
    folder.write("b.blob", micromap(&[1, 2, 3, 5]));
    let run = omm(["diff", text(&a), text(&b)]);
    assert_eq!(run.status, 1);
    assert!(run.stdout.starts_with("payload.data of triangles[0]: "), "{run:?}");
    assert!(run.stdout.ends_with("2 differences\n"), "{run:?}");
    // One has more: the rest is compared all the same.
    folder.write("a.blob", tlas(&[1, 2]));
    folder.write("b.blob", tlas(&[1, 2, 3]));
    let run = omm(["diff", text(&a), text(&b)]);
    let lines: Vec<_> = run.stdout.lines().filter(|line| line.contains("handle")).collect();
    let expected = [
        "handle_count: 2 in the first, 3 in the second",
        "handles[2]: absent from the first, 0x0000000000000003 in the second",
    ];
    assert_eq!(lines, expected, "{run:?}");
    assert!(!run.stdout.contains("payload.magic") && run.stdout.contains("payload.size: "), "{run:?}");
    folder.write("a.blob", micromap(&[1, 2, 3, 4]));
    folder.write("b.blob", tlas(&[1]));
    let run = omm(["diff", "--format", "json", text(&a), text(&b)]);
    assert_eq!(run.status, 1);
    let found: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    assert!(found.as_array().unwrap().iter().any(|row| row["what"] == "handles[0]" && row["a"].is_null()), "{found}");
}

#[test]
fn our_payload_is_counted_and_dumped_to_the_last_byte() {
    let folder = Folder::new();
    let path = folder.path("a.blob");
    folder.write("a.blob", micromap(&[0, 0, 0, 0b11_10_01_00]));
    let found = omm(["inspect", "--format", "json", text(&path)]).json();
    assert_eq!(found["contents"]["usage"], json!([{ "level": 2, "format": 2, "count": 2 }]));
    let states = json!({ "opaque": 2, "transparent": 26, "unknown_opaque": 2, "unknown_transparent": 2 });
    assert_eq!(found["contents"]["states"], states);
    assert_eq!(found["departure"], json!(null));
    let dump = omm(["inspect", "--dump", text(&path)]);
    let lines: Vec<_> = dump.clean().lines().collect();
    assert!(lines[0].contains("| driver_uuid: "), "{dump:?}");
    assert!(dump.stdout.contains("| payload.data of triangles[0]: TTTTTTTTTTTTTOuU\n"), "{dump:?}");
    assert!(lines.last().unwrap().ends_with("was named: true"), "{dump:?}");
    let shown: usize = lines[..lines.len() - 1]
        .iter()
        .map(|line| line.split_once(": ").unwrap().1.split('|').next().unwrap().split_whitespace().count())
        .sum();
    assert_eq!(shown, folder.read("a.blob").len());
}

#[test]
fn departures_of_real_drivers_are_explained() {
    let Some(folder) = golden("blobs") else { return };
    let mut blobs = 0;
    for driver in names(&folder) {
        for name in names(&folder.join(&driver)).iter().filter(|name| name.ends_with(".blob")) {
            let path = folder.join(&driver).join(name);
            let dump = omm(["inspect", "--dump", text(&path)]);
            assert!(dump.clean().trim_end().ends_with("was named: true"), "{name}");
            let run = omm(["inspect", text(&path)]);
            let text = ["departure ", "driver version      25.0.7-2+deb13u1\n"].map(|text| run.clean().contains(text));
            assert_eq!(text, [driver.starts_with("lavapipe"); 2], "{name}");
            blobs += 1;
        }
    }
    assert_eq!(blobs, 12);
}
