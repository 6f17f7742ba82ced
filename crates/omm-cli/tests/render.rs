//! `omm render`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[allow(dead_code)]
mod common;

use common::{Folder, glb, names, omm, quad};
use serde_json::{Value, json};

/// A folder with `scene.glb`: the masked quad in front of a camera, changed by `change`.
fn with(change: impl FnOnce(&mut Value)) -> Folder {
    let folder = Folder::new();
    let (mut json, mut binary) = quad();
    binary.resize(binary.len().next_multiple_of(4), 0);
    let offset = binary.len();
    let positions = [-1.0, -1.0, 0.0, 1.0, -1.0, 0.0, -1.0, 1.0, 0.0, 1.0, 1.0, 0.0_f32];
    binary.extend(positions.iter().flat_map(|x| x.to_le_bytes()));
    json["buffers"][0]["byteLength"] = json!(binary.len());
    let view = json["bufferViews"].as_array().unwrap().len();
    let accessor = json["accessors"].as_array().unwrap().len();
    let push = |json: &mut Value, array: &str, item: Value| json[array].as_array_mut().unwrap().push(item);
    push(&mut json, "bufferViews", json!({ "buffer": 0, "byteOffset": offset, "byteLength": 48 }));
    push(&mut json, "accessors", json!({ "bufferView": view, "componentType": 5126, "type": "VEC3", "count": 4 }));
    json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(accessor);
    json["cameras"] = json!([{ "type": "perspective", "name": "front", "perspective": { "yfov": 1.0, "znear": 0.1 } }]);
    json["nodes"] = json!([{ "mesh": 0 }, { "camera": 0, "translation": [0, 0, 3] }]);
    json["scenes"] = json!([{ "nodes": [0, 1] }]);
    change(&mut json);
    folder.write("scene.glb", glb(&json, &binary));
    folder
}

fn render(folder: &Folder, arguments: &[&str]) -> common::Run {
    let (scene, out) = (folder.path("scene.glb"), folder.path("out.png"));
    let fixed = [scene.as_os_str(), "--size".as_ref(), "40x30".as_ref(), "--out".as_ref(), out.as_os_str()];
    let all = ["render".as_ref()].into_iter().chain(fixed).chain(arguments.iter().map(AsRef::as_ref));
    omm(all)
}

fn size(folder: &Folder) -> [u32; 2] {
    let picture = image::open(folder.path("out.png")).unwrap();
    [picture.width(), picture.height()]
}

#[test]
fn statistics_count_what_micromaps_save() {
    let folder = with(|_| {});
    let stats = folder.path("stats.json");
    let printed = render(&folder, &["--stats", stats.to_str().unwrap(), "--format", "json"]).json();
    let written: Value = serde_json::from_slice(&folder.read("stats.json")).unwrap();
    assert_eq!(printed, written);
    assert_eq!((size(&folder), &printed["triangles"]), ([40, 30], &json!(2)));
    let number = |key: &str| printed[key].as_u64().unwrap();
    assert!(number("rays") > 1200 && number("any_hit_without") > 0, "{printed}");
    assert!(number("any_hit_with") < number("any_hit_without"), "{printed}");
    assert_eq!(printed["images_identical"], json!(true));
    assert!(printed["seconds"].as_f64().unwrap() > 0.0 && printed["rays_per_second"].as_f64().unwrap() > 0.0);
}

#[test]
fn modes_and_comparisons_make_sheets() {
    let folder = with(|_| {});
    assert!(render(&folder, &["--compare"]).clean().contains("pictures identical: yes"));
    assert_eq!(size(&folder), [120, 60]);
    render(&folder, &["--mode", "any-hit,source,shaded"]).clean();
    assert_eq!(size(&folder), [40, 90]);
    render(&folder, &["--compare", "--mode", "source"]).clean();
    assert_eq!(size(&folder), [120, 30]);
    assert_eq!(names(&folder.path("")), ["out.png", "scene.glb"]);
}

#[test]
fn the_picture_does_not_depend_on_threads_but_on_the_seed() {
    let folder = with(|_| {});
    let taken = |arguments: &[&str]| {
        render(&folder, arguments).clean();
        folder.read("out.png")
    };
    let one = taken(&["--samples", "4", "--threads", "1"]);
    assert_eq!(one, taken(&["--samples", "4", "--threads", "3"]));
    assert_ne!(one, taken(&["--samples", "4", "--seed", "1"]));
}

#[test]
fn the_camera_can_be_chosen() {
    let folder = with(|_| {});
    let taken = |arguments: &[&str]| {
        render(&folder, arguments).clean();
        folder.read("out.png")
    };
    let first = taken(&[]);
    assert_eq!(first, taken(&["--camera", "front"]));
    assert_eq!(first, taken(&["--camera", "0"]));
    assert_ne!(first, taken(&["--eye", "-1,1,2", "--target", "0,0,0", "--fov", "60"]));
    let lost = render(&folder, &["--camera", "back"]);
    assert_eq!(lost.error(), "there is no camera \"back\"; there are: front");
    let bad = render(&folder, &["--eye", "0,0,0", "--target", "0,0,0"]);
    assert_eq!(bad.error(), "the camera looks at the point where it is");
    assert_eq!(render(&folder, &["--sun", "0,0,0"]).status, 2);
}

#[test]
fn the_garden_needs_no_file() {
    let folder = Folder::new();
    let out = folder.path("garden.png");
    let run = omm(["render", "--compare", "--size", "64x36", "--level", "4", "--out", out.to_str().unwrap()]);
    assert!(run.clean().contains("pictures identical: yes"));
    assert_eq!(names(&folder.path("")), ["garden.png"]);
}

#[test]
fn bad_input_leaves_nothing() {
    let folder = with(|json| json["nodes"] = json!([{ "mesh": 0, "children": [0] }]));
    assert!(render(&folder, &[]).error().contains("nodes[0]: the node is its own ancestor"));
    assert_eq!(names(&folder.path("")), ["scene.glb"]);
    for size in ["0x1", "1", "20000x1", "16384x16384", "ax3"] {
        assert_eq!(render(&folder, &["--size", size]).status, 2, "{size}");
    }
}
