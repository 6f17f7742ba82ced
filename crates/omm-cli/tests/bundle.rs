//! `omm bundle`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[allow(dead_code)]
mod common;

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
