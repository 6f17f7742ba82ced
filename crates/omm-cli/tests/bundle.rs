//! `omm bundle`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[allow(dead_code)]
mod common;

use std::fs;

use common::{Folder, glb, omm, quad};

#[test]
fn a_bake_goes_into_a_bundle_and_comes_out_again() {
    let folder = Folder::new();
    let (json, binary) = quad();
    folder.write("quad.glb", glb(&json, &binary));
    folder.bake("quad.glb", &["--level", "3", "--no-special-indices"]).clean();
    let path = |name: &str| folder.path(name).to_str().unwrap().to_owned();
    let pack = |from: &str, to: &str, more: &[&str]| {
        let (from, to) = (path(from), path(to));
        let mut arguments = vec!["bundle", "pack", &from, "-o", &to];
        arguments.extend(more);
        omm(arguments)
    };
    let source = path("quad.glb");
    assert!(pack("out", "a.omm", &["--source", &source]).clean().starts_with("1 micromaps, "));
    let list = omm(["bundle", "list", "--format", "json", &path("a.omm")]).json();
    assert_eq!((&list[0]["name"], &list[0]["triangles"]), (&"leaf_prim0".into(), &2.into()));
    assert_eq!(list[0]["sources"][0]["name"], "quad.glb");
    assert!(omm(["bundle", "list", &path("a.omm")]).clean().starts_with("leaf_prim0\n  2 triangles"));
    let folder_path = folder.path("");
    let verify = ["bundle", "verify", &path("a.omm"), "--sources", folder_path.to_str().unwrap()];
    assert_eq!(omm(verify).clean(), "everything fits\n");
    // Out and in again: the same bytes.
    omm(["bundle", "unpack", &path("a.omm"), "--out", &path("again")]).clean();
    assert_eq!(folder.read("again/leaf_prim0.array.bin"), folder.read("out/leaf_prim0.array.bin"));
    assert_eq!(folder.read("again/leaf_prim0.index.bin"), folder.read("out/leaf_prim0.index.bin"));
    pack("again", "b.omm", &[]).clean();
    assert_eq!(folder.read("a.omm"), folder.read("b.omm"));
    assert_eq!(omm(["bundle", "diff", &path("a.omm"), &path("b.omm")]).clean(), "no difference\n");
    // Another bake of the same.
    let mut array = folder.read("out/leaf_prim0.array.bin");
    array[0] ^= 1;
    folder.write("again/leaf_prim0.array.bin", array);
    pack("again", "b.omm", &[]).clean();
    let run = omm(["bundle", "diff", &path("a.omm"), &path("b.omm")]);
    assert_eq!((run.status, run.stderr.as_str()), (1, ""));
    assert!(run.stdout.starts_with("leaf_prim0: 1 of "), "{run:?}");
    // A source that has changed, and a byte.
    folder.write("quad.glb", b"other");
    let run = omm(verify);
    assert_eq!((run.status, run.stdout.as_str()), (1, "leaf_prim0: source \"quad.glb\" has changed\n"));
    let mut bytes = folder.read("a.omm");
    bytes[100] ^= 1;
    folder.write("a.omm", bytes);
    assert_eq!(omm(["bundle", "verify", &path("a.omm")]).status, 1);
    assert!(omm(["bundle", "list", &path("a.omm")]).error().contains("checksum at byte "));
    // Indices that name nothing are not packed.
    folder.write("again/leaf_prim0.index.bin", 99_i32.to_le_bytes());
    assert!(pack("again", "c.omm", &[]).error().contains("found 99, required at most "));
    assert!(!folder.path("c.omm").exists());
}

#[test]
fn a_bake_writes_the_bundle_that_its_folder_packs_to() {
    let folder = Folder::new();
    let (mut json, binary) = quad();
    fs::create_dir(folder.path("data")).unwrap();
    folder.write("data/quad.bin", &binary);
    json["buffers"][0]["uri"] = "data/quad.bin".into();
    folder.write("quad.gltf", json.to_string());
    folder.write("quad.glb", glb(&quad().0, &binary));
    let path = |name: &str| folder.path(name).to_str().unwrap().to_owned();

    folder.bake("quad.glb", &["--level", "3"]).clean();
    omm(["bundle", "pack", &path("out"), "-o", &path("packed.omm"), "--source", &path("quad.glb")]).clean();
    let baked = omm(["bake", &path("quad.glb"), "-o", &path("baked.omm"), "--level", "3"]);
    assert!(baked.clean().ends_with(&format!("written to {}\n", path("baked.omm"))), "{baked:?}");
    assert_eq!(folder.read("baked.omm"), folder.read("packed.omm"));

    // Every file that was read is a source.
    omm(["bake", &path("quad.gltf"), "-o", &path("parts.omm")]).clean();
    let list = omm(["bundle", "list", "--format", "json", &path("parts.omm")]).json();
    let names: Vec<_> = list[0]["sources"].as_array().unwrap().iter().map(|source| &source["name"]).collect();
    assert_eq!(names, ["quad.gltf", "data/quad.bin"]);
    let verify = ["bundle", "verify", &path("parts.omm"), "--sources", &path("")];
    assert_eq!(omm(verify).clean(), "everything fits\n");
    folder.write("data/quad.bin", b"other");
    assert_eq!(omm(verify).stdout, "leaf_prim0: source \"data/quad.bin\" has changed\n");

    // What cannot be baked leaves no bundle, and neither does a bundle that cannot be written.
    let before = names_in(&folder);
    omm(["bake", &path("quad.gltf"), "-o", &path("bad.omm")]).error();
    omm(["bake", &path("quad.glb"), "-o", &path("data")]).error();
    assert_eq!(names_in(&folder), before);
    for more in [&["--out", "x"][..], &["--picture"]] {
        let run = omm([&["bake", &path("quad.glb"), "-o", &path("bad.omm")], more].concat());
        assert!(run.status == 2 && run.stderr.contains("cannot be used with"), "{run:?}");
    }
}

fn names_in(folder: &Folder) -> Vec<String> {
    common::names(&folder.path(""))
}

#[test]
fn names_do_not_lead_out_of_the_folder() {
    use omm_serialize::bundle::{BundleData, MicromapData};
    let folder = Folder::new();
    for name in ["../escape", "", "..", "a/b", "c:d", "a\\b"] {
        let micromap = MicromapData { name: name.to_owned(), ..MicromapData::default() };
        folder.write("a.omm", BundleData { micromaps: vec![micromap] }.write());
        let (file, out) = (folder.path("a.omm"), folder.path("out"));
        let run = omm(["bundle", "unpack", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
        assert!(run.error().ends_with("can be no file name"), "{run:?}");
        assert!(!out.exists());
    }
}
