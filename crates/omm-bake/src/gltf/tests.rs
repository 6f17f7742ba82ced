use std::io::Cursor;
use std::path::PathBuf;

use ::image::{ImageFormat, Rgba, RgbaImage};
use proptest::prelude::*;
use serde_json::{Value, json};

use super::*;

/// A quad of two triangles with a 4 x 4 texture whose alpha is 16 times the texel's number.
pub(super) fn quad() -> (Value, Vec<u8>) {
    let uvs = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0_f32]];
    let mut binary: Vec<u8> = uvs.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    binary.extend([0, 1, 2, 2, 1, 3_u16].iter().flat_map(|x| x.to_le_bytes()));
    let image = RgbaImage::from_fn(4, 4, |x, y| Rgba([0, 0, 0, (64 * y + 16 * x) as u8]));
    let mut png = Cursor::new(Vec::new());
    image.write_to(&mut png, ImageFormat::Png).unwrap();
    let png = png.into_inner();
    let json = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": 44 + png.len() }],
        "bufferViews": [
            { "buffer": 0, "byteLength": 32 },
            { "buffer": 0, "byteOffset": 32, "byteLength": 12 },
            { "buffer": 0, "byteOffset": 44, "byteLength": png.len() },
        ],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "type": "VEC2", "count": 4 },
            { "bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 6 },
        ],
        "images": [{ "bufferView": 2, "mimeType": "image/png" }],
        "samplers": [{}],
        "textures": [{ "source": 0, "sampler": 0 }],
        "materials": [{ "alphaMode": "MASK", "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
        "meshes": [{ "name": "leaf/1", "primitives": [
            { "attributes": { "TEXCOORD_0": 0 }, "indices": 1, "material": 0 },
        ] }],
    });
    binary.extend(png);
    (json, binary)
}

pub(super) fn glb(json: &Value, binary: &[u8]) -> Vec<u8> {
    let json = json.to_string().into_bytes();
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    let length = u32::try_from(28 + json.len() + binary.len()).unwrap();
    bytes.extend(length.to_le_bytes());
    for (kind, data) in [(b"JSON", json.as_slice()), (b"BIN\0", binary)] {
        bytes.extend(u32::try_from(data.len()).unwrap().to_le_bytes());
        bytes.extend(kind);
        bytes.extend(data);
    }
    bytes
}

fn read_bytes(bytes: &[u8]) -> Result<GltfFile, GltfError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("quad.glb");
    std::fs::write(&path, bytes).unwrap();
    read(&path).map_err(|mut error| {
        error.file = PathBuf::from(error.file.file_name().unwrap());
        error
    })
}

/// The quad with one value of its JSON replaced, or added.
fn with(pointer: &str, value: Value) -> Result<GltfFile, GltfError> {
    let (mut json, binary) = quad();
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    match json.pointer_mut(parent).unwrap() {
        Value::Array(items) => items[key.parse::<usize>().unwrap()] = value,
        object => object[key] = value,
    }
    read_bytes(&glb(&json, &binary))
}

fn refused(pointer: &str, value: Value) -> String {
    with(pointer, value).unwrap_err().to_string()
}

const PRIMITIVE: &str = "/meshes/0/primitives/0";
const SURFACE: &str = "/materials/0/pbrMetallicRoughness";

#[test]
fn a_quad_is_read() {
    let (json, binary) = quad();
    let file = read_bytes(&glb(&json, &binary)).unwrap();
    let [primitive] = file.primitives.as_slice() else { panic!("{file:?}") };
    assert_eq!((primitive.name.as_str(), primitive.mesh, primitive.primitive), ("leaf_1_prim0", 0, 0));
    assert_eq!(primitive.uvs, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]);
    assert_eq!(primitive.triangles, [[0, 1, 2], [2, 1, 3]]);
    assert_eq!(primitive.alpha_cutoff, 0.5);
    assert_eq!(primitive.sampler, Sampler::default());
    assert_eq!(file.textures[primitive.texture].alpha(1, 3), Some(208.0 / 255.0));
}

#[test]
fn materials_and_samplers_are_honoured() {
    let one = |pointer: &str, value| with(pointer, value).unwrap().primitives.remove(0);
    assert_eq!(one("/materials/0/alphaCutoff", json!(0.25)).alpha_cutoff, 0.25);
    assert_eq!(one(&format!("{SURFACE}/baseColorFactor"), json!([1, 1, 1, 0.7])).alpha_cutoff, 0.5 / 0.7);
    assert_eq!(one("/samplers/0/magFilter", json!(9728)).sampler.filter, Filter::Nearest);
    for (gl, mode) in [(10497, AddressMode::Wrap), (33648, AddressMode::Mirror), (33071, AddressMode::Clamp)] {
        let sampler = one("/samplers/0", json!({ "wrapS": gl, "wrapT": gl })).sampler;
        assert_eq!(sampler, Sampler::new(mode, Filter::Linear, 0.0));
    }
    let mixed = one("/samplers/0/wrapT", json!(33071)).sampler;
    assert_eq!((mixed.address_mode_u, mixed.address_mode_v), (AddressMode::Wrap, AddressMode::Clamp));
    let transform = json!({ "KHR_texture_transform": { "offset": [0.5, 0], "scale": [2, 4] } });
    let moved = one(&format!("{SURFACE}/baseColorTexture/extensions"), transform);
    assert_eq!(moved.uvs, [[0.5, 0.0], [2.5, 0.0], [0.5, 4.0], [2.5, 4.0]]);
}

#[test]
fn the_transform_may_choose_another_set() {
    let transform = json!({ "index": 0, "extensions": { "KHR_texture_transform": { "texCoord": 3 } } });
    let text = refused(&format!("{SURFACE}/baseColorTexture"), transform);
    assert!(text.ends_with("the primitive has no TEXCOORD_3, which its base colour texture reads"), "{text}");
}

#[test]
fn strips_and_fans_become_triangles() {
    assert_eq!(assemble(Mode::TriangleStrip, &[5, 6, 7, 8, 9]), [[5, 6, 7], [6, 8, 7], [7, 8, 9]]);
    assert_eq!(assemble(Mode::TriangleFan, &[5, 6, 7, 8]), [[6, 7, 5], [7, 8, 5]]);
    let strip = with(PRIMITIVE, json!({ "attributes": { "TEXCOORD_0": 0 }, "material": 0, "mode": 5 })).unwrap();
    assert_eq!(strip.primitives[0].triangles, [[0, 1, 2], [1, 3, 2]]);
}

#[test]
fn sparse_accessors_replace_elements() {
    // Vertex 1 becomes (0, 0), which are the first eight bytes of the view.
    let sparse = |index_type| {
        json!({ "bufferView": 0, "componentType": 5126, "type": "VEC2", "count": 4, "sparse": {
            "count": 1,
            "indices": { "bufferView": 1, "byteOffset": 2, "componentType": index_type },
            "values": { "bufferView": 0 },
        } })
    };
    let file = with("/accessors/0", sparse(5123)).unwrap();
    assert_eq!(file.primitives[0].uvs, [[0.0, 0.0], [0.0, 0.0], [0.0, 1.0], [1.0, 1.0]]);
    let text = refused("/accessors/0", sparse(5125));
    assert_eq!(text, "quad.glb: accessors[0].sparse.indices[0]: index 131073 is out of range: there are 4");
    let zeros = json!({ "componentType": 5126, "type": "VEC2", "count": 1_000_000_000_000_u64, "sparse": sparse(5123)["sparse"] });
    let text = refused("/accessors/0", zeros);
    assert_eq!(text, "quad.glb: accessors[0].count: 1000000000000 elements are claimed without a buffer view");
}

#[test]
fn equal_names_become_unique() {
    let primitive = json!({ "attributes": { "TEXCOORD_0": 0 }, "indices": 1, "material": 0 });
    let mesh = |name: Value| json!({ "name": name, "primitives": [primitive, primitive] });
    let meshes = json!([mesh(json!("leaf")), mesh(json!("Leaf")), mesh(json!("")), mesh(json!("../x"))]);
    let names: Vec<_> =
        with("/meshes", meshes).unwrap().primitives.into_iter().map(|primitive| primitive.name).collect();
    assert_eq!(
        names,
        [
            "leaf_prim0",
            "leaf_prim1",
            "Leaf_prim0_2",
            "Leaf_prim1_2",
            "mesh2_prim0",
            "mesh2_prim1",
            "_._x_prim0",
            "_._x_prim1"
        ]
    );
}

#[test]
fn vertex_colours_may_not_have_an_alpha() {
    let coloured = json!({ "attributes": { "TEXCOORD_0": 0, "COLOR_0": 2 }, "indices": 1, "material": 0 });
    let (mut json, binary) = quad();
    json["meshes"][0]["primitives"][0] = coloured;
    let accessors = json["accessors"].as_array_mut().unwrap();
    accessors.push(json!({ "bufferView": 0, "componentType": 5126, "type": "VEC4", "count": 2 }));
    let text = read_bytes(&glb(&json, &binary)).unwrap_err().to_string();
    assert!(text.contains("attributes.COLOR_0: vertex 0 has alpha 0 in COLOR_0"), "{text}");
    json["accessors"][2] =
        json!({ "bufferView": 0, "byteOffset": 16, "componentType": 5126, "type": "VEC4", "count": 1 });
    assert!(read_bytes(&glb(&json, &binary)).is_ok());
}

#[test]
fn what_is_wrong_is_named_with_its_path() {
    let cases = [
        ("/materials/0/alphaMode", json!("BLEND"), "meshes: no primitive has a material with alphaMode MASK"),
        ("/materials/0/alphaMode", json!("CUT"), "materials[0].alphaMode: not a value that glTF allows here"),
        ("/materials/0/alphaCutoff", json!(1e39), "materials[0].alphaCutoff: inf is not a finite number"),
        (
            "/materials/0/pbrMetallicRoughness",
            json!({}),
            "materials[0]: alphaMode is MASK, but there is no baseColorTexture",
        ),
        (
            "/materials/0/pbrMetallicRoughness/baseColorFactor",
            json!([1, 1, 1, 2]),
            "materials[0].pbrMetallicRoughness.baseColorFactor[3]: 2 is outside 0..=1",
        ),
        ("/samplers/0/wrapS", json!(1), "samplers[0].wrapS: not a value"),
        ("/samplers/0/magFilter", json!(1), "samplers[0].magFilter: not a value"),
        ("/textures/0", json!({}), "textures[0]: the texture names no PNG or JPEG image"),
        ("/textures/0/source", json!(7), "textures[0].source: index 7 is out of range: there are 1"),
        ("/images/0", json!({}), "images[0]: the texture names no PNG or JPEG image"),
        ("/images/0", json!({ "uri": "absent.png" }), "images[0].uri: cannot read: "),
        ("/images/0", json!({ "uri": "../up.png" }), "leaves the folder of the glTF file"),
        ("/images/0", json!({ "uri": "data:;base64,AAAA" }), "images[0]: neither a PNG nor a JPEG image"),
        ("/images/0/bufferView", json!(0), "images[0]: neither a PNG nor a JPEG image"),
        ("/bufferViews/2/byteLength", json!(60), "images[0]: "),
        ("/bufferViews/0/byteLength", json!(16), "accessors[0]: bytes 0..32 leave the 16 bytes of the buffer view"),
        (
            "/bufferViews/0/byteOffset",
            json!(u64::MAX),
            "bufferViews[0]: bytes 18446744073709551615..18446744073709551615",
        ),
        ("/bufferViews/0/byteStride", json!(4), "bufferViews[0].byteStride: not a value"),
        ("/buffers/0/byteLength", json!(1_000_000), "buffers[0].byteLength: 1000000 bytes are claimed, "),
        ("/accessors/0/count", json!(5), "accessors[0]: bytes 0..40 leave the 32 bytes of the buffer view"),
        ("/accessors/0/count", json!(u64::MAX), "leave the 32 bytes of the buffer view"),
        ("/accessors/0/count", json!(3), "indices: index 5 is 3, but there are 3 vertices"),
        ("/accessors/0/type", json!("VEC3"), "leave the 32 bytes of the buffer view"),
        ("/accessors/0/componentType", json!(5125), "TEXCOORD_0: elements of Vec2 U32 cannot stand here"),
        ("/accessors/0/componentType", json!(1), "accessors[0].componentType: not a value"),
        ("/accessors/1/componentType", json!(5122), "indices: elements of Scalar I16 cannot stand here"),
        ("/accessors/1/count", json!(4), "indices: 4 vertices do not make triangles"),
        ("/accessors/1/count", json!(0), "indices: 0 vertices do not make triangles"),
        ("/meshes/0/primitives/0/mode", json!(1), "meshes[0].primitives[0].mode: mode Lines does not make triangles"),
        ("/meshes/0/primitives/0/indices", json!(9), "meshes[0].primitives[0].indices: index 9 is out of range"),
        ("/meshes/0/primitives/0/material", json!(9), "meshes[0].primitives[0].material: index 9 is out of range"),
        (
            "/meshes/0/primitives/0/attributes",
            json!({}),
            "meshes[0].primitives[0].attributes: the primitive has no TEXCOORD_0",
        ),
        ("/extensionsRequired", json!(["KHR_draco_mesh_compression"]), "extensionsRequired[0]: extension"),
        ("/accessors/0/type", json!(3), "JSON: invalid type"),
        ("/asset", json!(null), "JSON: "),
    ];
    for (pointer, value, expected) in cases {
        let text = refused(pointer, value.clone());
        assert!(text.starts_with("quad.glb: ") && text.contains(expected), "{pointer} = {value}: {text}");
        assert!(!text.contains('\n'), "{text}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    /// Whatever bytes are changed, the answer is a value or an error.
    #[test]
    fn changed_bytes_never_panic(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4)) {
        let (json, binary) = quad();
        let mut bytes = glb(&json, &binary);
        for (place, value) in changes {
            let place = place.index(bytes.len());
            bytes[place] = value;
        }
        if let Ok(file) = read_bytes(&bytes) {
            for primitive in file.primitives {
                let vertices = primitive.uvs.len();
                prop_assert!(primitive.triangles.iter().flatten().all(|&vertex| (vertex as usize) < vertices));
            }
        }
    }

    /// Numbers in the JSON, where a claim is made, changed to others of any size.
    #[test]
    fn changed_numbers_never_panic(which in any::<prop::sample::Index>(), value in prop_oneof![
        0_u64..100, any::<u64>(), Just(u64::from(u32::MAX)), Just(u64::MAX)
    ]) {
        let (json, binary) = quad();
        let text = json.to_string();
        let numbers: Vec<_> = text.match_indices(|c: char| c.is_ascii_digit()).map(|(at, _)| at).collect();
        let at = numbers[which.index(numbers.len())];
        let changed = format!("{}{value}{}", &text[..at], &text[at + 1..]);
        if let Ok(json) = serde_json::from_str::<Value>(&changed) {
            let _ = read_bytes(&glb(&json, &binary));
        }
    }
}
