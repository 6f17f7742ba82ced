use std::path::PathBuf;

use omm_model::level::SubdivisionLevel;
use serde_json::json;

use super::super::tests::{glb, quad};
use super::super::{GltfFile, GltfKind, embed, read};
use super::*;
use crate::image::ImageOptions;
use crate::{BakeInput, BakeOptions, LevelChoice, bake};

fn baked(file: &GltfFile) -> BakeOutput {
    let primitive = &file.primitives[0];
    let texture = &file.textures[primitive.texture];
    let input = BakeInput { texture, uvs: &primitive.uvs, triangles: &primitive.triangles };
    let level = LevelChoice::Uniform(SubdivisionLevel::new(3).unwrap());
    bake(&input, &BakeOptions { level, ..BakeOptions::default() }, &|_| {}).unwrap()
}

/// A folder with files of the given names.
fn folder(files: &[(&str, &[u8])]) -> (tempfile::TempDir, impl Fn(&str) -> PathBuf + use<>) {
    let folder = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, bytes)| std::fs::write(folder.path().join(name), bytes).unwrap());
    let path = folder.path().to_path_buf();
    (folder, move |name: &str| path.join(name))
}

#[test]
fn what_is_embedded_is_read_back() {
    let (mut json, binary) = quad();
    json["meshes"][0]["primitives"][0]["extras"] = json!({ "mine": [1, 2] });
    json["meshes"][0]["extensions"] = json!({ "VENDOR_unknown": { "kept": true } });
    let (_folder, path) = folder(&[("quad.glb", &glb(&json, &binary))]);
    let file = read(&path("quad.glb"), ImageOptions::default()).unwrap();
    let output = baked(&file);
    assert!(!output.triangles.is_empty());
    let micromaps_of = |output| [PrimitiveOutput { mesh: 0, primitive: 0, output }];
    for (kind, name) in [(GltfKind::Binary, "out.glb"), (GltfKind::Json, "out.gltf")] {
        let bytes = embed(&path("quad.glb"), &micromaps_of(&output), kind).unwrap();
        // Alone in another folder: the file is complete in itself.
        let (_other, elsewhere) = folder(&[(name, &bytes)]);
        let [found] = micromaps(&elsewhere(name)).unwrap().try_into().unwrap();
        assert_eq!(found.array, output.array);
        assert_eq!((&found.triangles, &found.indices), (&output.triangles, &output.indices));
        assert_eq!(
            (&found.usage_counts, &found.index_usage_counts),
            (&output.usage_counts, &output.index_usage_counts)
        );
        let again = read(&elsewhere(name), ImageOptions::default()).unwrap();
        assert_eq!(again.primitives[0].uvs, file.primitives[0].uvs);
        assert_eq!(baked(&again), output);
        let container = Container::read(&elsewhere(name)).unwrap();
        let root: Value = serde_json::from_slice(&container.json).unwrap();
        assert_eq!(root.pointer("/meshes/0/primitives/0/extras/mine"), Some(&json!([1, 2])));
        assert_eq!(root.pointer("/meshes/0/extensions"), Some(&json["meshes"][0]["extensions"]));
    }
}

#[test]
fn files_beside_the_gltf_are_taken_in() {
    let (mut json, binary) = quad();
    let (mesh_data, png) = binary.split_at(44);
    json["buffers"] = json!([{ "uri": "a.bin", "byteLength": 32 }, { "uri": "b.bin", "byteLength": 12 }]);
    json["bufferViews"] = json!([{ "buffer": 0, "byteLength": 32 }, { "buffer": 1, "byteLength": 12 }]);
    json["images"] = json!([{ "uri": "leaf.png" }]);
    let text = json.to_string();
    let files: [(&str, &[u8]); 4] =
        [("in.gltf", text.as_bytes()), ("a.bin", &mesh_data[..32]), ("b.bin", &mesh_data[32..]), ("leaf.png", png)];
    let (_folder, path) = folder(&files);
    let file = read(&path("in.gltf"), ImageOptions::default()).unwrap();
    let output = baked(&file);
    for (kind, name) in [(GltfKind::Binary, "out.glb"), (GltfKind::Json, "out.gltf")] {
        let bytes =
            embed(&path("in.gltf"), &[PrimitiveOutput { mesh: 0, primitive: 0, output: &output }], kind).unwrap();
        let (_other, elsewhere) = folder(&[(name, &bytes)]);
        assert_eq!(micromaps(&elsewhere(name)).unwrap()[0].array, output.array);
        assert_eq!(baked(&read(&elsewhere(name), ImageOptions::default()).unwrap()), output);
    }
    assert_eq!(micromaps(&path("in.gltf")).unwrap(), []);
}

/// A mesh whose triangles all have special indices has no data, and no buffer views for it.
#[test]
fn special_indices_alone_need_no_data() {
    let (mut json, binary) = quad();
    json["materials"][0]["alphaCutoff"] = json!(0.0);
    let (_folder, path) = folder(&[("quad.glb", &glb(&json, &binary))]);
    let file = read(&path("quad.glb"), ImageOptions::default()).unwrap();
    let primitive = &file.primitives[0];
    let texture = &file.textures[primitive.texture];
    let input = BakeInput { texture, uvs: &primitive.uvs, triangles: &primitive.triangles };
    let options = BakeOptions { alpha_cutoff: primitive.alpha_cutoff, ..BakeOptions::default() };
    let output = bake(&input, &options, &|_| {}).unwrap();
    let bytes = embed(&path("quad.glb"), &[PrimitiveOutput { mesh: 0, primitive: 0, output: &output }], GltfKind::Json)
        .unwrap();
    let (_other, elsewhere) = folder(&[("out.gltf", &bytes)]);
    let found = micromaps(&elsewhere("out.gltf")).unwrap();
    assert_eq!((found[0].indices.as_slice(), found[0].array.len()), ([-2, -2].as_slice(), 0));
}

#[test]
fn blocks_that_contradict_their_data_are_refused() {
    let (mut json, mut binary) = quad();
    let start = binary.len();
    // A triangle of level 0 in 4-state format at byte 0, of 1 byte of data, which one of two triangles uses.
    binary.extend([0, 0, 0, 0, 0, 0, 2, 0]);
    binary.extend([[0_u8; 4], [0xff; 4]].concat());
    json["buffers"][0]["byteLength"] = json!(binary.len());
    let views = json["bufferViews"].as_array_mut().unwrap();
    views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": 8 }));
    views.push(json!({ "buffer": 0, "byteOffset": start + 8, "byteLength": 8 }));
    let usage = json!([{ "count": 1, "subdivisionLevel": 0, "format": 2 }]);
    json["meshes"][0]["primitives"][0]["extras"] = json!({ "opacityMicromap": {
        "version": 1, "data": 3, "triangles": 3, "indices": 4, "usageCounts": usage, "indexUsageCounts": usage,
    } });
    let found = |change: &dyn Fn(&mut Value, &mut Vec<u8>)| {
        let (mut json, mut binary) = (json.clone(), binary.clone());
        change(&mut json["meshes"][0]["primitives"][0]["extras"]["opacityMicromap"], &mut binary);
        let (_folder, path) = folder(&[("f.glb", &glb(&json, &binary))]);
        micromaps(&path("f.glb")).map_err(|error| format!("{}: {}", error.at, error.kind))
    };
    let good = found(&|_, _| ()).unwrap();
    assert_eq!((good[0].indices.as_slice(), good[0].triangles.len()), ([0, -1].as_slice(), 1));
    let refused = |change: &dyn Fn(&mut Value, &mut Vec<u8>), expected: &str| {
        let text = found(change).unwrap_err();
        assert!(text.starts_with("meshes[0].primitives[0].extras.opacityMicromap"), "{text}");
        assert!(text.contains(expected), "{text}");
    };
    refused(&|block, _| block["version"] = json!(2), "version: version 2 of the block; only version 1 is known");
    refused(&|block, _| block["colour"] = json!(2), "unknown field `colour`");
    refused(&|block, _| *block = json!([]), "invalid length 0");
    refused(&|block, _| block["indices"] = json!(99), "indices: index 99 is out of range: there are 5");
    refused(&|block, _| block["usageCounts"] = json!([]), "usageCounts: the counts are not those");
    refused(&|block, _| block["indexUsageCounts"][0]["count"] = json!(2), "indexUsageCounts: the counts are not those");
    refused(&|_, binary| binary[start] = 9, "triangles: micromap triangle 0: its data ends at byte 10 of 8");
    refused(&|_, binary| binary[start + 4] = 13, "triangles: micromap triangle 0: ");
    refused(&|_, binary| binary[start + 8] = 1, "indices: index 0 is 1, but there are 1 micromap triangles");
    refused(&|_, binary| binary[start + 12] = 0xf0, "indices: index 1 is -16, but there are 1 micromap triangles");
    refused(&|block, _| block["triangles"] = json!(1), "12 bytes are not a multiple of 8");
}

#[test]
fn there_must_be_a_primitive_and_room_in_its_extras() {
    let (mut json, binary) = quad();
    json["meshes"][0]["primitives"][0]["extras"] = json!("mine");
    let (_folder, path) = folder(&[("quad.glb", &glb(&json, &binary))]);
    let output = BakeOutput::default();
    let refused = |mesh| {
        let micromaps = [PrimitiveOutput { mesh, primitive: 0, output: &output }];
        let error = embed(&path("quad.glb"), &micromaps, GltfKind::Binary).unwrap_err();
        format!("{}: {}", error.at, error.kind)
    };
    let text = refused(0);
    assert_eq!(text, "meshes[0].primitives[0].extras: the extras are no JSON object, so nothing can be added to them");
    assert!(refused(7).starts_with("meshes[7].primitives[0].extras: not a value"));
}
