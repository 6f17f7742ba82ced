//! `omm inspect`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[allow(dead_code)]
mod common;

use std::fs;

use common::{Folder, Run, glb, golden, omm, quad};
use serde_json::{Value, json};

fn inspect(folder: &Folder) -> Run {
    omm(["inspect".as_ref(), "--format".as_ref(), "json".as_ref(), folder.path("b.blob").as_os_str()])
}

/// A header with `count` in its last field, and what follows it.
fn blob(serialized_size: u64, count: u64, rest: &[u8]) -> Vec<u8> {
    let mut bytes = vec![0xaa; 16];
    bytes.extend([0xbb; 16]);
    for field in [serialized_size, 4096, count] {
        bytes.extend(field.to_le_bytes());
    }
    bytes.extend(rest);
    bytes
}

#[test]
fn golden_blobs_decode_to_what_their_cases_say() {
    let Some(folder) = golden("blobs") else { return };
    let mut blobs = 0;
    for driver in common::names(&folder) {
        let folder = folder.join(driver);
        let cases: Value = serde_json::from_slice(&fs::read(folder.join("cases.json")).unwrap()).unwrap();
        for case in cases["cases"].as_array().unwrap() {
            let Some(name) = case["blob"].as_str() else { continue };
            let found = omm(["inspect", "--format", "json", folder.join(name).to_str().unwrap()]).json();
            let header = &case["header"];
            assert_eq!(found["driver_uuid"], header["driver_uuid"]);
            assert_eq!(found["compatibility_uuid"], header["compat_uuid"]);
            for field in ["serialized_size", "deserialized_size", "handle_count"] {
                assert_eq!(found[field], header[field], "{name} {field}");
            }
            let handles = header["handles"].as_array().unwrap().iter().map(|handle| handle["device_address"].clone());
            assert_eq!(found["handles"], Value::Array(handles.collect()), "{name}");
            assert_eq!(found["blocks"], json!([]));
            let kind = &found["kind"];
            if kind["certainty"] == "certain" {
                assert_eq!(kind["name"], case["kind"], "{name}");
            } else {
                assert!(kind["candidates"].as_array().unwrap().contains(&case["kind"]), "{name}: {kind}");
            }
            blobs += 1;
        }
    }
    assert_eq!(blobs, 12);
}

#[test]
fn handles_and_blocks_are_listed() {
    let folder = Folder::new();
    folder.write("b.blob", blob(80, 2, &[7; 24]));
    let found = inspect(&folder).json();
    assert_eq!(found["handles"], json!(["0x0707070707070707", "0x0707070707070707"]));
    assert_eq!((&found["kind"]["name"], &found["kind"]["certainty"]), (&json!("tlas"), &json!("certain")));
    // One block of type 0 with one address.
    let block = [[0; 8], 1_u64.to_le_bytes(), 0x1234_u64.to_le_bytes()].concat();
    folder.write("b.blob", blob(80, 0xffff_ffff_0000_0001, &block));
    let found = inspect(&folder).json();
    assert_eq!(found["blocks"], json!([{ "type": 0, "reserved": 0, "addresses": ["0x0000000000001234"] }]));
    assert_eq!((&found["handle_count"], &found["kind"]["name"]), (&json!(0), &json!("blas")));
    let text = omm(["inspect".as_ref(), folder.path("b.blob").as_os_str()]);
    assert!(text.clean().contains("driver UUID         aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\n"), "{text:?}");
    assert!(text.clean().contains("0x0000000000001234\n"), "{text:?}");
}

#[test]
fn unknown_blocks_and_big_endian_data_are_named() {
    let folder = Folder::new();
    let mut bytes = vec![0xaa; 32];
    for field in [88, 4096, 0xffff_ffff_0000_0002_u64] {
        bytes.extend(field.to_be_bytes());
    }
    for (block_type, count) in [(7_u32, 0_u64), (0, 0)] {
        bytes.extend(block_type.to_be_bytes());
        bytes.extend([0; 4]);
        bytes.extend(count.to_be_bytes());
    }
    folder.write("b.blob", bytes);
    let run = omm(["inspect".as_ref(), folder.path("b.blob").as_os_str()]);
    for line in ["byte order          big-endian", "type 7 (unknown, kept as it is)", "type 0 (opacity micromaps)"] {
        assert!(run.clean().contains(line), "{line}: {run:?}");
    }
}

#[test]
fn bundles_are_summed_up_and_dumped() {
    let folder = Folder::new();
    let (json, binary) = quad();
    folder.write("quad.glb", glb(&json, &binary));
    let (glb, file) = (folder.path("quad.glb"), folder.path("quad.omm"));
    let (glb, file) = (glb.to_str().unwrap(), file.to_str().unwrap());
    omm(["bake", glb, "-o", file, "--level", "3", "--no-special-indices"]).clean();
    let run = omm(["inspect", file]);
    assert!(run.clean().contains("bytes: a bundle of version 1, 1 micromaps\nleaf_prim0\n"), "{run:?}");
    let found = omm(["inspect", "--format", "json", file]).json();
    assert_eq!((&found["kind"], &found["version"]), (&json!("bundle"), &json!(1)));
    let micromap = &found["micromaps"][0];
    assert_eq!(micromap["histogram"], json!([{ "level": 3, "format": 2, "count": 2 }]));
    assert_eq!(micromap["index_histogram"], micromap["histogram"]);
    assert_eq!(micromap["settings"]["special_indices"], json!(false));
    assert_eq!(micromap["statistics"]["triangles"], json!(2));
    let dump = omm(["inspect", "--dump", file]);
    assert!(dump.clean().contains("| micromaps[0].triangles[1]: data at 16, level 3, 4-state\n"), "{dump:?}");
    let size = folder.read("quad.omm").len();
    assert!(dump.stdout.ends_with(&format!("{size:08x}: end; every byte of {size} was named: true\n")), "{dump:?}");
    assert_eq!(omm(["diff", file, file]).clean(), "no difference\n");
}

/// Files that are much larger than memory should be used for, without holes filled.
#[test]
fn large_files_that_lie_are_refused_at_their_start() {
    let folder = Folder::new();
    let path = folder.path("b.blob");
    let refused = |start: &[u8], verb: &[&str]| {
        fs::write(&path, start).unwrap();
        let file = fs::OpenOptions::new().write(true).open(&path).unwrap();
        // More than any machine's memory.
        file.set_len(1 << 40).unwrap();
        let arguments = verb.iter().map(std::ffi::OsStr::new).chain([path.as_os_str()]);
        omm(arguments).error().to_owned()
    };
    let found = refused(&[], &["inspect"]);
    assert!(found.contains("serialized_size at byte 32: found 0, required at least 56"), "{found}");
    let found = refused(&blob(1 << 40, 1 << 38, &[]), &["inspect"]);
    assert!(found.contains("handle_count at byte 48: found 274877906944, required at most 137438953465"), "{found}");
    let found = refused(&blob(1 << 40, 1 << 38, &[]), &["blob", "relocate", "--list"]);
    assert!(found.contains("handle_count at byte 48: "), "{found}");
    let found = refused(b"ommbundl\x02\0\0\0", &["inspect"]);
    assert!(found.contains("version at byte 8: found 2, "), "{found}");
    let found = refused(b"ommbundl\x01\0\0\0\x01\0\0\0\0\0\0\0", &["bundle", "list"]);
    assert!(found.contains("sections at byte 12: found 1, required a multiple of 9"), "{found}");
    assert!(refused(b"glTF", &["bundle", "list"]).contains("magic at byte 0: "));
}

#[test]
fn bad_blobs_are_errors_with_offset() {
    let folder = Folder::new();
    let whole = blob(80, 2, &[7; 24]);
    for end in 0..whole.len() {
        folder.write("b.blob", &whole[..end]);
        let run = inspect(&folder);
        let text = run.error();
        assert!(text.contains(" at byte ") && text.ends_with(&format!("(the file has {end} bytes)")), "{text}");
    }
    let longer = [whole.as_slice(), &[0]].concat();
    folder.write("b.blob", longer);
    let run = inspect(&folder);
    assert!(
        run.error().ends_with("b.blob: serialized_size at byte 32: found 80, required 81 (the file has 81 bytes)"),
        "{run:?}"
    );
    // Claims of any size.
    for count in [4, 1 << 40, u64::MAX >> 1, 0xffff_ffff_ffff_ffff, 0xffff_ffff_7fff_ffff] {
        folder.write("b.blob", blob(80, count, &[7; 24]));
        assert!(inspect(&folder).error().contains(" at byte 48: "), "{count}");
    }
    assert!(omm(["inspect", "/dev/zero"]).error().ends_with("not a regular file"));
    assert!(omm(["inspect", "."]).error().ends_with("not a regular file"));
}
