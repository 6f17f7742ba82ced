//! What the tests of the binary share: running it, the golden data, small inputs.

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use image::{ImageFormat, Rgba, RgbaImage};
use serde_json::{Value, json};

/// What a run of `omm` said.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) status: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

/// Runs `omm` with `arguments`.
pub(crate) fn omm<A: AsRef<std::ffi::OsStr>>(arguments: impl IntoIterator<Item = A>) -> Run {
    let Output { status, stdout, stderr } =
        Command::new(env!("CARGO_BIN_EXE_omm")).args(arguments).output().expect("the binary runs");
    Run {
        status: status.code().expect("no signal"),
        stdout: String::from_utf8(stdout).expect("UTF-8"),
        stderr: String::from_utf8(stderr).expect("UTF-8"),
    }
}

impl Run {
    /// The run could not be done: status 2, nothing on the standard output, one line that starts with `error: `.
    #[track_caller]
    pub(crate) fn error(&self) -> &str {
        assert_eq!((self.status, self.stdout.as_str()), (2, ""), "{self:?}");
        assert_eq!(self.stderr.lines().count(), 1, "{self:?}");
        self.stderr.trim_end().strip_prefix("error: ").expect("starts with error:")
    }

    /// The run found nothing to complain about and said nothing on the standard error.
    #[track_caller]
    pub(crate) fn clean(&self) -> &str {
        assert_eq!((self.status, self.stderr.as_str()), (0, ""), "{self:?}");
        &self.stdout
    }

    #[track_caller]
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(self.clean()).expect("one JSON document")
    }
}

/// The folder of golden data; where there is none, says so.
pub(crate) fn golden(part: &str) -> Option<PathBuf> {
    let default = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/golden");
    let folder = std::env::var_os("OMM_GOLDEN").map_or(default, PathBuf::from).join(part);
    if !folder.is_dir() {
        println!("skipped: golden data absent ({})", folder.display());
        return None;
    }
    Some(folder)
}

/// The names in a folder, sorted; none if it is absent.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// A folder with an input in it, beside which `out` may come to be.
pub(crate) struct Folder(tempfile::TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.path(name), bytes).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    /// Bakes `input` into `out`.
    pub(crate) fn bake(&self, input: &str, options: &[&str]) -> Run {
        let (input, out) = (self.path(input), self.path("out"));
        let mut arguments = vec!["bake".as_ref(), input.as_os_str(), "--out".as_ref(), out.as_os_str()];
        arguments.extend(options.iter().map(std::ffi::OsStr::new));
        omm(arguments)
    }

    /// The error of a bake that leaves nothing behind, without the folder's path.
    #[track_caller]
    pub(crate) fn refused(&self, input: &str, options: &[&str]) -> String {
        let before = names(self.0.path());
        let run = self.bake(input, options);
        let text = run.error().replace(&format!("{}/", self.0.path().display()), "");
        assert_eq!(names(self.0.path()), before, "{text}");
        text
    }
}

/// A PNG of `image`.
pub(crate) fn png(image: &RgbaImage) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// A glTF file of a quad whose texture is opaque on its left half, as JSON and the contents of its buffer.
pub(crate) fn quad() -> (Value, Vec<u8>) {
    let uvs = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0_f32]];
    let mut binary: Vec<u8> = uvs.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    binary.extend([0, 1, 2, 2, 1, 3_u16].iter().flat_map(|x| x.to_le_bytes()));
    let png = png(&RgbaImage::from_fn(8, 8, |x, _| Rgba([0, 0, 0, if x < 4 { 255 } else { 0 }])));
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
        "samplers": [{ "wrapS": 33071, "wrapT": 33071, "magFilter": 9728 }],
        "textures": [{ "source": 0, "sampler": 0 }],
        "materials": [{ "alphaMode": "MASK", "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
        "meshes": [{ "name": "leaf", "primitives": [
            { "attributes": { "TEXCOORD_0": 0 }, "indices": 1, "material": 0 },
        ] }],
    });
    binary.extend(png);
    (json, binary)
}

/// The `.glb` of a JSON document and a buffer.
pub(crate) fn glb(json: &Value, binary: &[u8]) -> Vec<u8> {
    let mut json = json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut binary = binary.to_vec();
    binary.resize(binary.len().next_multiple_of(4), 0);
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend(u32::try_from(28 + json.len() + binary.len()).unwrap().to_le_bytes());
    for (kind, data) in [(b"JSON", json), (b"BIN\0", binary)] {
        bytes.extend(u32::try_from(data.len()).unwrap().to_le_bytes());
        bytes.extend(kind);
        bytes.extend(data);
    }
    bytes
}
