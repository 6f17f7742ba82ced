use std::fs;

use serde_json::{Value, json};

use super::*;

/// A folder with a job of a 2 x 2 texture and one triangle.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        folder.write("t.bin", &[0, 255, 128, 64]);
        folder.write("uv.bin", &floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]));
        folder.write("tri.bin", &[0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0]);
        folder
    }

    fn write(&self, name: &str, bytes: &[u8]) {
        fs::write(self.0.path().join(name), bytes).unwrap();
    }

    fn read(&self, job: &str) -> Result<Job, JobError> {
        self.write("x.job.json", job.as_bytes());
        read(&self.0.path().join("x.job.json"))
    }

    /// The error's text without the folder.
    fn refused(&self, job: &str) -> String {
        let text = self.read(job).unwrap_err().to_string();
        text.replace(&format!("{}/", self.0.path().display()), "")
    }
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn job() -> Value {
    json!({
        "name": "leaf",
        "texture": { "path": "t.bin", "width": 2, "height": 2, "format": "unorm8" },
        "uvs": "uv.bin",
        "triangles": "tri.bin",
        "format": "2-state",
        "max_level": 5,
        "dynamic_subdivision_scale": null,
        "address_mode": "mirror_once",
        "filter": "nearest",
        "border_alpha": 0.25,
        "alpha_cutoff": 0.75,
        "unknown_state_promotion": "force_opaque",
    })
}

fn with(pointer: &str, value: Value) -> String {
    let mut job = job();
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    job.pointer_mut(parent).unwrap()[key] = value;
    job.to_string()
}

#[test]
fn every_field_is_read() {
    let folder = Folder::new();
    let Job { name, texture, uvs, triangles, options, files } = folder.read(&job().to_string()).unwrap();
    assert_eq!((name.as_str(), texture.width(), texture.alpha(0, 1)), ("leaf", 2, Some(128.0 / 255.0)));
    assert_eq!((uvs, triangles), (vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], vec![[0, 1, 2]]));
    let expected = BakeOptions {
        format: OpacityMicromapFormat::TwoState,
        level: LevelChoice::Uniform(SubdivisionLevel::new(5).unwrap()),
        sampler: Sampler::new(AddressMode::MirrorOnce, Filter::Nearest, 0.25),
        alpha_cutoff: 0.75,
        promotion: UnknownStatePromotion::ForceOpaque,
        ..BakeOptions::default()
    };
    assert_eq!(options, expected);
    assert_eq!(files, ["x.job.json", "t.bin", "uv.bin", "tri.bin"].map(|name| folder.0.path().join(name)));
}

#[test]
fn a_scale_makes_levels_dynamic() {
    let folder = Folder::new();
    let options = folder.read(&with("/dynamic_subdivision_scale", json!(4))).unwrap().options;
    assert_eq!(options.level, LevelChoice::Dynamic { scale: 4.0, max: SubdivisionLevel::new(5).unwrap() });
    let mut absent = job();
    absent.as_object_mut().unwrap().remove("dynamic_subdivision_scale");
    let options = folder.read(&absent.to_string()).unwrap().options;
    assert_eq!(options.level, LevelChoice::Uniform(SubdivisionLevel::new(5).unwrap()));
}

#[test]
fn float_textures() {
    let folder = Folder::new();
    folder.write("t.bin", &floats(&[0.0, 1.5, -2.0, 0.25]));
    let job = with("/texture/format", json!("fp32"));
    assert_eq!(folder.read(&job).unwrap().texture.alpha(0, 1), Some(-2.0));
    folder.write("t.bin", &floats(&[0.0, 1.5, f32::NAN, 0.25]));
    assert_eq!(folder.refused(&job), "x.job.json: texture.path: texel (0, 1) is NaN, which is not a finite number");
}

#[test]
fn what_is_wrong_is_named_with_its_field() {
    let folder = Folder::new();
    folder.write("odd.bin", &[0; 13]);
    folder.write("far.bin", &[0, 0, 0, 0, 1, 0, 0, 0, 3, 0, 0, 0]);
    let cases = [
        (with("/name", json!("")), "name: the name is empty"),
        (with("/max_level", json!(13)), "max_level: subdivision level 13 is above 12"),
        (with("/alpha_cutoff", json!(1e300)), "alpha_cutoff: inf is not a finite number"),
        (with("/border_alpha", json!(-1e300)), "border_alpha: -inf is not a finite number"),
        (with("/dynamic_subdivision_scale", json!(0)), "dynamic_subdivision_scale: 0 is not a finite number above 0"),
        (
            with("/dynamic_subdivision_scale", json!(1e300)),
            "dynamic_subdivision_scale: inf is not a finite number above 0",
        ),
        (with("/texture/width", json!(0)), "texture: a texture of 0 x 2 texels is empty"),
        (
            with("/texture/width", json!(u32::MAX)),
            "texture: a texture of 4294967295 x 2 texels is too large: no side may exceed 65536",
        ),
        (with("/texture/width", json!(3)), "texture.path: t.bin: the file has 4 bytes, but 6 are needed"),
        (with("/texture/height", json!(1)), "texture.path: t.bin: the file has 4 bytes, but 2 are needed"),
        (with("/texture/format", json!("fp32")), "texture.path: t.bin: the file has 4 bytes, but 16 are needed"),
        (with("/uvs", json!("odd.bin")), "uvs: odd.bin: the file has 13 bytes, which is not a multiple of 8"),
        (
            with("/triangles", json!("odd.bin")),
            "triangles: odd.bin: the file has 13 bytes, which is not a multiple of 12",
        ),
        (
            with("/triangles", json!("far.bin")),
            "triangles: far.bin: byte 8: vertex 3 of triangle 0 is out of range: there are 3 vertices",
        ),
    ];
    for (job, expected) in cases {
        assert_eq!(folder.refused(&job), format!("x.job.json: {expected}"));
    }
    let absent = folder.refused(&with("/uvs", json!("absent.bin")));
    assert!(absent.starts_with("x.job.json: uvs: absent.bin: cannot read: "), "{absent}");
    let device = folder.refused(&with("/triangles", json!("/dev/null")));
    assert_eq!(device, "x.job.json: triangles: /dev/null: cannot read: not a regular file");
}

#[test]
fn other_json_is_refused_with_line_and_column() {
    let folder = Folder::new();
    let cases = [
        (with("/cutoff", json!(0.5)), "unknown field `cutoff`"),
        (with("/texture/pitch", json!(0.5)), "unknown field `pitch`"),
        (with("/format", json!("3-state")), "unknown variant `3-state`"),
        (with("/max_level", json!(-1)), "invalid value: integer `-1`"),
        (with("/filter", json!(null)), "filter"),
        (job().to_string().replace("0.75", "1e999"), "number out of range"),
        (job().to_string().trim_end_matches('}').to_owned(), "EOF while parsing"),
        ("[]".to_owned(), "invalid length 0"),
        (String::new(), "EOF while parsing"),
    ];
    for (job, expected) in cases {
        let text = folder.refused(&job);
        assert!(text.starts_with("x.job.json: ") && text.contains(" at line 1 column "), "{text}");
        assert!(expected == "filter" || text.contains(expected), "{text}");
    }
    let absent = read(Path::new("absent.job.json")).unwrap_err().to_string();
    assert!(absent.starts_with("absent.job.json: cannot read: "), "{absent}");
}
