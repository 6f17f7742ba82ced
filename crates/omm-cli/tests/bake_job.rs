//! `omm bake` on job files.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[allow(dead_code)]
mod common;

use std::fs;
use std::path::Path;

use common::{Folder, golden, names, omm};
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;
use omm_model::special_index::OpacityMicromapSpecialIndex;
use serde_json::{Value, json};

/// The files of data that a bake wrote, or that the peer did.
struct Baked {
    array: Vec<u8>,
    /// Offset, level and format.
    descs: Vec<(usize, SubdivisionLevel, OpacityMicromapFormat)>,
    indices: Vec<i32>,
}

impl Baked {
    fn read(folder: &Path, name: &str) -> Option<Self> {
        let part = |part: &str| fs::read(folder.join(format!("{name}.{part}.bin"))).ok();
        let u16_at = |bytes: &[u8], at: usize| u32::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]));
        let desc = |bytes: &[u8]| {
            let offset = u32::from_le_bytes(*bytes.first_chunk().unwrap()) as usize;
            let level = SubdivisionLevel::new(u16_at(bytes, 4)).unwrap();
            (offset, level, OpacityMicromapFormat::from_value(u16_at(bytes, 6)).unwrap())
        };
        let (array, descs, indices) = (part("array")?, part("desc")?, part("index")?);
        assert!(descs.len().is_multiple_of(8) && indices.len().is_multiple_of(4));
        Some(Self {
            array,
            descs: descs.chunks(8).map(desc).collect(),
            indices: indices.chunks(4).map(|bytes| i32::from_le_bytes(*bytes.first_chunk().unwrap())).collect(),
        })
    }

    /// The states of a triangle of the mesh, at `level` if one state says all.
    fn states(&self, triangle: usize, level: SubdivisionLevel) -> Vec<OpacityState> {
        let index = self.indices[triangle];
        if let Some(special) = OpacityMicromapSpecialIndex::from_value(index) {
            return vec![special.state(); level.microtriangles() as usize];
        }
        let (offset, level, format) = self.descs[usize::try_from(index).unwrap()];
        let data = &self.array[offset..offset + format.data_size(level) as usize];
        (0..level.microtriangles()).map(|index| format.state(data, index.into()).unwrap()).collect()
    }
}

#[test]
fn golden_jobs_are_baked_as_the_peer_did_or_better() {
    let Some(golden) = golden("bake") else { return };
    let folder = Folder::new();
    let jobs: Vec<_> = names(&golden).into_iter().filter(|name| name.ends_with(".job.json")).collect();
    assert_eq!(jobs.len(), 21);
    let (mut all, mut others) = (0, 0);
    for file in &jobs {
        let path = golden.join(file);
        let run = omm(["bake".as_ref(), path.as_os_str(), "--out".as_ref(), folder.path("out").as_os_str()]);
        run.clean();
        let job: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
        let name = job["name"].as_str().unwrap();
        let ours = Baked::read(&folder.path("out"), name).unwrap();
        let statistics: Value = serde_json::from_slice(&folder.read(&format!("out/{name}.stats.json"))).unwrap();
        assert_eq!(statistics["triangles"], json!(ours.indices.len()));
        assert_eq!(statistics["bytes"]["array"], json!(ours.array.len()));
        let counted: u64 = ["transparent", "opaque", "unknown_transparent", "unknown_opaque"]
            .iter()
            .map(|state| statistics["states"][state].as_u64().unwrap())
            .sum();
        let micro: u64 = ours.descs.iter().map(|(_, level, _)| u64::from(level.microtriangles())).sum();
        assert_eq!(counted, micro, "{name}");
        // The peer crashed on one.
        let Some(peer) = Baked::read(&golden, name) else { continue };
        assert_eq!(ours.indices.len(), peer.indices.len());
        if !job["dynamic_subdivision_scale"].is_null() {
            // Dynamic levels are each baker's own choice.
            continue;
        }
        let level = SubdivisionLevel::new(u32::try_from(job["max_level"].as_u64().unwrap()).unwrap()).unwrap();
        for triangle in 0..ours.indices.len() {
            let (ours, theirs) = (ours.states(triangle, level), peer.states(triangle, level));
            assert_eq!(ours.len(), theirs.len());
            all += ours.len();
            others += ours.iter().zip(&theirs).filter(|(ours, theirs)| ours != theirs).count();
        }
    }
    println!("{others} of {all} microtriangles differ from the peer's");
    assert!(others * 100 < all, "{others} of {all}");
}

/// A folder with a job of a texture of 4 x 4 texels, the left half opaque, and a quad.
fn small() -> (Folder, Value) {
    let folder = Folder::new();
    folder.write("t.bin", [255, 255, 0, 0].repeat(4));
    let uvs = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0_f32];
    folder.write("uv.bin", uvs.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>());
    folder.write("tri.bin", [0, 1, 2, 2, 1, 3_u32].iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>());
    let job = json!({
        "name": "half",
        "texture": { "path": "t.bin", "width": 4, "height": 4, "format": "unorm8" },
        "uvs": "uv.bin",
        "triangles": "tri.bin",
        "format": "4-state",
        "max_level": 2,
        "dynamic_subdivision_scale": null,
        "address_mode": "clamp",
        "filter": "nearest",
        "border_alpha": 0.0,
        "alpha_cutoff": 0.5,
        "unknown_state_promotion": "nearest",
    });
    folder.write("half.job.json", job.to_string());
    (folder, job)
}

#[test]
fn results_and_their_names() {
    let (folder, _) = small();
    let run = folder.bake("half.job.json", &["--picture"]);
    assert!(run.clean().contains("\nhalf "), "{run:?}");
    let results =
        ["array.bin", "desc.bin", "index.bin", "overlay.png", "stats.json"].map(|part| format!("half.{part}"));
    assert_eq!(names(&folder.path("out")), results);
    let letters: String = Baked::read(&folder.path("out"), "half")
        .unwrap()
        .states(0, SubdivisionLevel::ZERO)
        .iter()
        .map(|s| s.letter())
        .collect();
    // The line u = 1/2 passes between microtriangles, so closed ones that touch it have both.
    assert!(letters.contains('O') && letters.contains('T'), "{letters}");
    let picture = image::load_from_memory(&folder.read("out/half.overlay.png")).unwrap();
    assert_eq!((picture.width(), picture.height()), (512, 512));
}

#[test]
fn the_same_bytes_on_any_number_of_threads_and_over_old_results() {
    let (folder, _) = small();
    folder.bake("half.job.json", &["--threads", "1", "--level", "7"]).clean();
    let first = folder.read("out/half.array.bin");
    folder.write("out/half.array.bin", b"old");
    folder.bake("half.job.json", &["--threads", "3", "--level", "7"]).clean();
    assert_eq!(folder.read("out/half.array.bin"), first);
}

#[test]
fn options_override_the_job() {
    let (folder, _) = small();
    let options = |options: &[&str]| {
        let options: Vec<_> = options.iter().chain(&["--format", "json"]).copied().collect();
        folder.bake("half.job.json", &options).json()[0].clone()
    };
    let two = options(&["--state", "2", "--level", "3"]);
    assert_eq!(two["histogram"], json!([{ "level": 3, "format": 1, "count": 2 }]));
    assert_eq!(two["known_fraction"], json!(1.0));
    let opaque = options(&["--cutoff", "-1"]);
    assert_eq!((&opaque["special_indices"]["opaque"], &opaque["bytes"]["array"]), (&json!(2), &json!(0)));
    let data = options(&["--cutoff", "-1", "--no-special-indices"]);
    assert_eq!((&data["special_indices"]["opaque"], &data["micromap_triangles"]), (&json!(0), &json!(1)));
    assert_eq!(options(&["--dynamic", "1", "--level", "12"])["histogram"][0]["level"], json!(1));
    assert_eq!(options(&["--promotion", "force-opaque"])["states"]["unknown_transparent"], json!(0));
    assert_eq!(options(&["--promotion", "force_transparent"])["states"]["unknown_opaque"], json!(0));
}

#[test]
fn names_cannot_leave_the_folder() {
    let (folder, mut job) = small();
    job["name"] = json!("../../up/../x");
    folder.write("half.job.json", job.to_string());
    folder.bake("half.job.json", &[]).clean();
    assert_eq!(names(&folder.path("out")).len(), 4);
    assert!(names(&folder.path("out")).iter().all(|name| name.starts_with("_._.._up_.._x.")));
}

#[test]
fn bad_jobs_are_one_error_and_leave_nothing() {
    let (folder, job) = small();
    assert_eq!(
        folder.refused("half.job.json", &["--gltf", "out.glb"]),
        "half.job.json: --gltf adds to a glTF file, which a job is not"
    );
    let with = |pointer: &str, value: Value| {
        let mut job = job.clone();
        *job.pointer_mut(pointer).unwrap() = value;
        folder.write("bad.job.json", job.to_string());
        folder.refused("bad.job.json", &[])
    };
    assert_eq!(with("/max_level", json!(13)), "bad.job.json: max_level: subdivision level 13 is above 12");
    assert_eq!(with("/texture/width", json!(0)), "bad.job.json: texture: a texture of 0 x 4 texels is empty");
    assert_eq!(
        with("/texture/height", json!(5)),
        "bad.job.json: texture.path: t.bin: the file has 16 bytes, but 20 are needed"
    );
    assert_eq!(with("/alpha_cutoff", json!(1e60)), "bad.job.json: alpha_cutoff: inf is not a finite number");
    assert!(with("/uvs", json!("absent.bin")).starts_with("bad.job.json: uvs: absent.bin: cannot read: "));
    assert!(with("/format", json!("x")).contains("unknown variant `x`"));
    folder.write("tri.bin", [0, 1, 4_u32].iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>());
    assert_eq!(
        folder.refused("half.job.json", &[]),
        "half.job.json: triangles: tri.bin: byte 8: vertex 4 of triangle 0 is out of range: there are 4 vertices"
    );
    folder.write("tri.bin", [0; 11]);
    assert_eq!(
        folder.refused("half.job.json", &[]),
        "half.job.json: triangles: tri.bin: the file has 11 bytes, which is not a multiple of 12"
    );
    folder.write("bad.txt", "{}");
    assert_eq!(folder.refused("bad.txt", &[]), "bad.txt: neither glTF (.gltf, .glb) nor a job file (.json)");
    assert!(folder.refused("absent.job.json", &[]).starts_with("absent.job.json: cannot read: "));
}

#[test]
fn outputs_that_cannot_be_written_are_one_error() {
    let (folder, _) = small();
    folder.write("out", "a file in the way");
    assert!(folder.refused("half.job.json", &[]).starts_with("out: cannot write: "));
    fs::remove_file(folder.path("out")).unwrap();
    fs::create_dir_all(folder.path("out/half.index.bin")).unwrap();
    assert!(folder.refused("half.job.json", &[]).starts_with("out/half.index.bin: cannot write: "));
    assert_eq!(names(&folder.path("out")), ["half.index.bin"]);
}
