//! `omm bake` on glTF files.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[allow(dead_code)]
mod common;

use common::{Folder, glb, names, png, quad};
use image::{Rgba, RgbaImage};
use serde_json::{Value, json};

/// A folder with `quad.glb`, changed by `change`.
fn with(change: impl FnOnce(&mut Value)) -> Folder {
    let folder = Folder::new();
    let (mut json, binary) = quad();
    change(&mut json);
    folder.write("quad.glb", glb(&json, &binary));
    folder
}

#[track_caller]
fn refused(change: impl FnOnce(&mut Value)) -> String {
    with(change).refused("quad.glb", &[])
}

#[test]
fn every_masked_primitive_has_results() {
    let folder = with(|json| {
        json["materials"].as_array_mut().unwrap().push(json!({}));
        let primitive = json["meshes"][0]["primitives"][0].clone();
        let opaque = json!({ "attributes": {}, "material": 1 });
        json["meshes"] =
            json!([{ "name": "leaf", "primitives": [primitive, opaque, primitive] }, { "primitives": [primitive] }]);
    });
    let results = folder.bake("quad.glb", &["--level", "2", "--format", "json"]).json();
    let found: Vec<_> = results.as_array().unwrap().iter().map(|result| result["name"].as_str().unwrap()).collect();
    assert_eq!(found, ["leaf_prim0", "leaf_prim2", "mesh1_prim0"]);
    assert_eq!(names(&folder.path("out")).len(), 12);
    let indices = folder.read("out/leaf_prim0.index.bin");
    assert_eq!(indices, [0, 0, 0, 0, 1, 0, 0, 0]);
    assert_eq!(folder.read("out/mesh1_prim0.array.bin"), folder.read("out/leaf_prim0.array.bin"));
    // Level 2, 4-state, one after the other.
    assert_eq!(folder.read("out/leaf_prim0.desc.bin"), [0, 0, 0, 0, 2, 0, 2, 0, 4, 0, 0, 0, 2, 0, 2, 0]);
}

#[test]
fn files_beside_the_gltf_are_found() {
    let folder = Folder::new();
    let (mut json, binary) = quad();
    json["buffers"][0]["uri"] = json!("leaf%20data.bin");
    json["images"][0] = json!({ "uri": "leaf.png" });
    folder.write("leaf data.bin", &binary);
    folder.write("leaf.png", png(&RgbaImage::from_pixel(4, 4, Rgba([0, 0, 0, 200]))));
    folder.write("quad.gltf", json.to_string());
    let result = folder.bake("quad.gltf", &["--format", "json", "--picture"]).json();
    assert_eq!((&result[0]["special_indices"]["opaque"], &result[0]["known_fraction"]), (&json!(2), &json!(1.0)));
    assert!(folder.path("out/leaf_prim0.overlay.png").exists());
}

#[test]
fn the_cutoff_is_the_material_s_unless_one_is_given() {
    let states = |cutoff: Value, options: &[&str]| {
        let folder = with(|json| json["materials"][0]["alphaCutoff"] = cutoff);
        let options: Vec<_> = options.iter().chain(&["--format", "json"]).copied().collect();
        folder.bake("quad.glb", &options).json()[0]["special_indices"].clone()
    };
    let opaque = json!({ "transparent": 0, "opaque": 2, "unknown_transparent": 0, "unknown_opaque": 0 });
    let transparent = json!({ "transparent": 2, "opaque": 0, "unknown_transparent": 0, "unknown_opaque": 0 });
    // Alpha equal to the cutoff is opaque in glTF.
    assert_eq!(states(json!(0.0), &[]), opaque);
    assert_eq!(states(json!(1.5), &[]), transparent);
    assert_eq!(states(json!(1.5), &["--cutoff", "0"]), opaque);
}

/// A DDS file of 4 x 4 texels of DXT3, whose alpha is `alphas[mip]` of 15.
fn dds(alphas: &[u8]) -> Vec<u8> {
    let mut header = [0_u32; 32];
    header[0] = u32::from_le_bytes(*b"DDS ");
    // Size and flags, height and width, then the pixel format's size and flags, and its name.
    header[1..5].copy_from_slice(&[124, 0x2_1007, 4, 4]);
    header[7] = alphas.len() as u32;
    header[19..22].copy_from_slice(&[32, 4, u32::from_le_bytes(*b"DXT3")]);
    header[27] = 0x1000;
    let mut bytes: Vec<u8> = header.iter().flat_map(|word| word.to_le_bytes()).collect();
    alphas.iter().for_each(|alpha| bytes.extend([[alpha * 0x11; 8], [0; 8]].concat()));
    bytes
}

#[test]
fn block_compressed_images_and_channels() {
    let folder = with(|json| json["images"][0] = json!({ "uri": "leaf.dds" }));
    let special = |alpha: u8, options: &[&str]| {
        folder.write("leaf.dds", dds(&[alpha]));
        let options: Vec<_> = ["--format", "json"].into_iter().chain(options.iter().copied()).collect();
        folder.bake("quad.glb", &options).json()[0]["special_indices"].clone()
    };
    assert_eq!(special(8, &[])["opaque"], json!(2));
    assert_eq!(special(7, &[])["transparent"], json!(2));
    assert_eq!(special(7, &["--block-decoding", "nvidia"])["transparent"], json!(2));
    // The colours are black.
    assert_eq!(special(15, &["--channel", "red"])["transparent"], json!(2));
    std::fs::remove_dir_all(folder.path("out")).unwrap();
    assert_eq!(
        folder.refused("quad.glb", &["--mips", "1"]),
        "quad.glb: images[0]: there is no mip level 1: the image has 1"
    );
}

#[test]
fn devices_that_decode_otherwise() {
    let folder = with(|json| {
        json["images"][0] = json!({ "uri": "leaf.dds" });
        json["materials"][0]["alphaCutoff"] = json!(0.39);
    });
    let mut file = dds(&[0]);
    file[84..88].copy_from_slice(b"DXT5");
    // Two fifths of the way from 0 to 255, everywhere: 102, or 96 on some devices.
    let codes: u64 = (0..16).map(|texel| 3 << (3 * texel)).sum();
    file[128..136].copy_from_slice(&(codes << 16 | 255 << 8).to_le_bytes());
    folder.write("leaf.dds", &file);
    let special = |device: &str| {
        let options = ["--format", "json", "--promotion", "force-opaque", "--block-decoding", device];
        folder.bake("quad.glb", &options).json()[0]["special_indices"].clone()
    };
    assert_eq!(special("specification")["opaque"], json!(2));
    assert_eq!(special("nvidia")["transparent"], json!(2));
    assert_eq!(special("all")["unknown_opaque"], json!(2));
}

#[test]
fn mips_of_a_dds_file_must_agree() {
    let folder = with(|json| json["images"][0] = json!({ "uri": "leaf.dds" }));
    folder.write("leaf.dds", dds(&[15, 0, 15]));
    let special = |mips: &[&str]| {
        let options = [&["--format", "json", "--promotion", "force-opaque"], mips].concat();
        folder.bake("quad.glb", &options).json()[0]["special_indices"].clone()
    };
    assert_eq!(special(&[])["opaque"], json!(2), "only mip 0 if nothing is said");
    assert_eq!(special(&["--mips", "0"])["opaque"], json!(2));
    assert_eq!(special(&["--mips", "1"])["transparent"], json!(2));
    assert_eq!(special(&["--mips", "0-1"])["unknown_opaque"], json!(2));
    assert_eq!(special(&["--mips", "2-2"])["opaque"], json!(2));
}

#[test]
fn the_gltf_comes_back_with_its_micromaps() {
    let folder = with(|_| ());
    for name in ["again.glb", "again.gltf"] {
        let target = folder.path(name);
        folder.bake("quad.glb", &["--level", "2", "--gltf", target.to_str().unwrap()]).clean();
        let found = omm_bake::gltf::extras::micromaps(&target).unwrap();
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].array, folder.read("out/leaf_prim0.array.bin"));
        let indices: Vec<u8> = found[0].indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        assert_eq!(indices, folder.read("out/leaf_prim0.index.bin"));
        // It bakes as the original does.
        let first = folder.read("out/leaf_prim0.array.bin");
        folder.bake(name, &["--level", "2"]).clean();
        assert_eq!(folder.read("out/leaf_prim0.array.bin"), first);
    }
    std::fs::remove_dir_all(folder.path("out")).unwrap();
    assert_eq!(folder.refused("quad.glb", &["--gltf", "model.obj"]), "model.obj: neither .gltf nor .glb");
}

#[test]
fn textures_that_are_shared_get_an_overview() {
    let folder = with(|json| {
        let mesh = json["meshes"][0].clone();
        json["meshes"].as_array_mut().unwrap().push(mesh);
    });
    folder.bake("quad.glb", &["--picture"]).clean();
    let pictures: Vec<_> = names(&folder.path("out")).into_iter().filter(|name| name.ends_with(".png")).collect();
    assert_eq!(pictures, ["leaf_prim0.overlay.png", "leaf_prim0_2.overlay.png", "texture0.atlas.png"]);
}

#[test]
fn bad_files_are_one_error_and_leave_nothing() {
    assert_eq!(
        refused(|json| json["materials"][0]["alphaMode"] = json!("OPAQUE")),
        "quad.glb: meshes: no primitive has a material with alphaMode MASK, so there is nothing to bake"
    );
    assert_eq!(
        refused(|json| json["meshes"][0]["primitives"][0]["attributes"] = json!({})),
        "quad.glb: meshes[0].primitives[0].attributes: the primitive has no TEXCOORD_0, which its base colour texture reads"
    );
    let folder = Folder::new();
    assert!(folder.refused("absent.glb", &[]).starts_with("absent.glb: cannot read: "));
    let absent = refused(|json| json["images"][0] = json!({ "uri": "absent.png" }));
    assert!(absent.starts_with("quad.glb: images[0].uri: cannot read: absent.png: "), "{absent}");
    assert_eq!(
        refused(|json| json["images"][0] = json!({ "uri": "data:image/webp;base64,UklGRgAAAABXRUJQ" })),
        "quad.glb: images[0]: not a PNG, JPEG, TGA, DDS or KTX2 image: it starts with [52, 49, 46, 46, 00, 00, 00, 00]"
    );
    assert_eq!(
        refused(|json| json["images"][0] = json!({ "uri": "../up.png" })),
        "quad.glb: images[0].uri: uri \"../up.png\": leaves the folder of the glTF file"
    );
    assert_eq!(
        refused(|json| json["accessors"][0]["count"] = json!(1_u64 << 60)),
        "quad.glb: accessors[0]: bytes 0..9223372036854775808 leave the 32 bytes of the buffer view"
    );
    assert_eq!(
        refused(|json| json["accessors"][0]["count"] = json!(2)),
        "quad.glb: meshes[0].primitives[0].indices: index 2 is 2, but there are 2 vertices"
    );
}

#[test]
fn truncated_and_oversized_files_are_one_error() {
    let (json, binary) = quad();
    let whole = glb(&json, &binary);
    let folder = Folder::new();
    for end in [0, 3, 4, 11, 12, 19, 200, whole.len() - 1] {
        folder.write("quad.glb", &whole[..end]);
        let text = folder.refused("quad.glb", &[]);
        assert!(text.starts_with("quad.glb: "), "{end}: {text}");
    }
    folder.write("quad.glb", [whole.as_slice(), b"more"].concat());
    let claimed = whole.len();
    assert_eq!(
        folder.refused("quad.glb", &[]),
        format!("quad.glb: byte 8: {claimed} bytes are claimed, {} are there", claimed + 4)
    );
}

/// A primitive that fails after others were baked takes their results with it.
#[test]
fn all_results_or_none() {
    let folder = with(|_| ());
    std::fs::create_dir_all(folder.path("out/leaf_prim0.stats.json")).unwrap();
    let text = folder.refused("quad.glb", &[]);
    assert!(text.starts_with("out/leaf_prim0.stats.json: cannot write: "), "{text}");
    assert_eq!(names(&folder.path("out")), ["leaf_prim0.stats.json"]);
}
