use serde_json::{Value, json};

use super::super::tests::{glb, quad};
use super::*;

/// The quad, placed twice, beside an opaque copy without texture, and a camera.
fn file() -> (Value, Vec<u8>) {
    let (mut json, mut binary) = quad();
    let positions: Vec<u8> =
        [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0_f32].iter().flat_map(|x| x.to_le_bytes()).collect();
    binary.resize(binary.len().next_multiple_of(4), 0);
    let offset = binary.len();
    binary.extend(&positions);
    json["buffers"][0]["byteLength"] = json!(binary.len());
    let push = |json: &mut Value, array: &str, item: Value| json[array].as_array_mut().unwrap().push(item);
    push(&mut json, "bufferViews", json!({ "buffer": 0, "byteOffset": offset, "byteLength": 48 }));
    push(
        &mut json,
        "accessors",
        json!({ "bufferView": 3, "componentType": 5126, "type": "VEC3", "count": 4,
        "min": [0, 0, 0], "max": [1, 1, 0] }),
    );
    push(&mut json, "materials", json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.25, 1, 1] } }));
    json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(2);
    let opaque = json!({ "attributes": { "POSITION": 2 }, "indices": 1, "material": 1 });
    let lines = json!({ "attributes": { "POSITION": 2 }, "mode": 1 });
    push(&mut json, "meshes", json!({ "primitives": [opaque, lines] }));
    push(&mut json, "meshes", json!({ "primitives": [{ "attributes": {} }] }));
    json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1 } },
        { "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 1, "znear": 0, "zfar": 1 } }]);
    json["nodes"] = json!([
        { "children": [1, 2], "translation": [1, 2, 3] },
        { "mesh": 0, "scale": [2, 2, 2] },
        { "mesh": 1, "children": [3, 4] },
        { "name": "eye", "camera": 0 },
        { "camera": 1, "mesh": 0 },
    ]);
    json["scenes"] = json!([{ "nodes": [0] }]);
    (json, binary)
}

fn read_file(change: impl FnOnce(&mut Value)) -> Result<GltfScene, String> {
    let (mut json, binary) = file();
    change(&mut json);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.glb");
    std::fs::write(&path, glb(&json, &binary)).unwrap();
    read_scene(&path).map_err(|error| error.to_string().rsplit_once("scene.glb: ").unwrap().1.to_owned())
}

#[test]
fn meshes_are_placed_by_the_tree() {
    let scene = read_file(|_| {}).unwrap();
    let parts: Vec<_> = scene.meshes.iter().map(Vec::len).collect();
    // Lines are left out, and what nobody places is not read.
    assert_eq!(parts, [1, 1, 0]);
    let places: Vec<_> = scene.placements.iter().map(|at| (at.mesh, at.transform[1])).collect();
    assert_eq!(places, [(0, [0.0, 2.0, 0.0, 2.0]), (1, [0.0, 1.0, 0.0, 2.0]), (0, [0.0, 1.0, 0.0, 2.0])]);
    let [camera] = scene.cameras.as_slice() else { panic!("{:?}", scene.cameras) };
    assert_eq!((camera.number, camera.name.as_deref(), camera.transform[2]), (0, Some("eye"), [0.0, 0.0, 1.0, 3.0]));
    assert_eq!((scene.textures.len(), scene.images.len()), (1, 1));
    let (masked, opaque) = (&scene.meshes[0][0], &scene.meshes[1][0]);
    assert_eq!(masked.mask.unwrap().alpha_cutoff, 0.5);
    assert!(masked.base_color.is_some() && masked.uvs.len() == 4 && masked.positions.len() == 4);
    assert!(opaque.mask.is_none() && opaque.base_color.is_none() && opaque.uvs.is_empty());
    assert_eq!((opaque.base_color_factor, opaque.triangles.len()), ([0.5, 0.25, 1.0, 1.0], 2));
}

#[test]
fn without_scenes_the_roots_are_placed() {
    let scene = read_file(|json| {
        json.as_object_mut().unwrap().remove("scenes");
    });
    assert_eq!(scene.unwrap().placements.len(), 3);
}

#[test]
fn bad_trees_are_refused() {
    let refused = |change: fn(&mut Value)| read_file(change).unwrap_err();
    let twice = "the node is its own ancestor, or has several parents";
    assert_eq!(refused(|json| json["nodes"][3]["children"] = json!([0])), format!("nodes[0]: {twice}"));
    assert_eq!(refused(|json| json["nodes"][3]["children"] = json!([1])), format!("nodes[1]: {twice}"));
    assert_eq!(
        refused(|json| json["nodes"][3]["children"] = json!([9])),
        "nodes: index 9 is out of range: there are 5"
    );
    assert_eq!(refused(|json| json["scene"] = json!(4)), "scene: index 4 is out of range: there are 1");
    assert_eq!(
        refused(|json| json["nodes"][1]["mesh"] = json!(7)),
        "nodes[1].mesh: index 7 is out of range: there are 3"
    );
    let huge = refused(|json| {
        json["nodes"][0]["scale"] = json!([1e30, 1, 1]);
        json["nodes"][1]["scale"] = json!([1e30, 1, 1]);
    });
    assert_eq!(huge, "nodes[1]: the transform of the node is not finite");
}

#[test]
fn bad_meshes_and_cameras_are_refused() {
    let refused = |change: fn(&mut Value)| read_file(change).unwrap_err();
    let nothing = "nodes: the scene places no triangles, so there is nothing to show";
    assert_eq!(refused(|json| json["scenes"] = json!([{ "nodes": [3] }])), nothing);
    let at = refused(|json| json["meshes"][1]["primitives"][0]["attributes"] = json!({}));
    assert_eq!(at, "meshes[1].primitives[0].attributes: the primitive has no POSITION");
    let few = refused(|json| json["accessors"][2]["count"] = json!(3));
    assert!(few.contains("index 5 is 3, but there are 3 vertices"), "{few}");
    let wide = refused(|json| json["cameras"][0]["perspective"]["yfov"] = json!(4));
    assert!(wide.starts_with("cameras[0].perspective.yfov: 4 is outside"), "{wide}");
    assert!(refused(|json| json["cameras"][0] = json!({ "type": "perspective" })).starts_with("cameras[0].type"));
}
