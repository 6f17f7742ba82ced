//! Writing micromaps back into a glTF file.

use std::path::Path;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use serde_json::{Map, Value};

use super::container::Container;
use super::error::{GltfError, GltfErrorKind};
use super::extras::{Block, KEY, PrimitiveOutput, VERSION, usages};
use super::uri;

/// The two kinds of glTF file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GltfKind {
    /// Binary, `.glb`.
    Binary,
    /// JSON, `.gltf`, with its buffers as `data:` URIs.
    Json,
}

/// Buffer views of micromaps start at a multiple of this many bytes of their buffer.
const ALIGNMENT: usize = 16;

/// The glTF file at `path` with `micromaps` in `extras` blocks of its primitives, complete in itself: buffers and images that lie
/// beside the file are taken in. Everything else stays as it is, also what is not known here.
///
/// # Errors
/// [`GltfError`] if the file cannot be read, has no such primitive, or has `extras` there that are no object; if a file that it names
/// cannot be read; and if the result would be larger than a `.glb` can be.
pub fn embed(path: &Path, micromaps: &[PrimitiveOutput<'_>], kind: GltfKind) -> Result<Vec<u8>, GltfError> {
    let container = Container::read(path)?;
    let root: Value =
        serde_json::from_slice(&container.json).map_err(|error| container.error("JSON", GltfErrorKind::Json(error)))?;
    let mut embedder = Embedder { container: &container, root, data: container.buffer(0).to_vec() };
    embedder.images()?;
    for micromap in micromaps {
        embedder.micromap(micromap)?;
    }
    embedder.finish(kind)
}

struct Embedder<'a> {
    container: &'a Container,
    root: Value,
    /// The contents of buffer 0, to which everything is appended.
    data: Vec<u8>,
}

impl Embedder<'_> {
    /// Takes in the images that are files.
    fn images(&mut self) -> Result<(), GltfError> {
        for (number, image) in self.container.root.images.iter().enumerate() {
            let Some(uri) = image.uri.as_deref().filter(|uri| !uri::is_data(uri)) else { continue };
            let at = format!("images[{number}]");
            let bytes = uri::read(&self.container.file, &format!("{at}.uri"), uri)?;
            let view = self.append(&bytes)?;
            let entry = self.root.get_mut("images").and_then(|images| images.get_mut(number)?.as_object_mut());
            let entry = entry.ok_or_else(|| self.container.error(at, GltfErrorKind::Value))?;
            entry.remove("uri");
            entry.insert("bufferView".into(), view.into());
            entry.entry("mimeType").or_insert_with(|| media_type(&bytes).into());
        }
        Ok(())
    }

    fn micromap(&mut self, micromap: &PrimitiveOutput<'_>) -> Result<(), GltfError> {
        let &PrimitiveOutput { mesh, primitive, output } = micromap;
        let triangles: Vec<u8> =
            output.triangles.iter().flat_map(|&triangle| omm_layout::triangle::encode(&triangle.into())).collect();
        let indices: Vec<u8> = output.indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let block = Block {
            version: VERSION,
            data: self.append_some(&output.array)?,
            triangles: self.append_some(&triangles)?,
            indices: self.append(&indices)?,
            usage_counts: usages(&output.usage_counts),
            index_usage_counts: usages(&output.index_usage_counts),
        };
        let at = format!("meshes[{mesh}].primitives[{primitive}].extras");
        let fail = |kind| self.container.error(&at, kind);
        let block = serde_json::to_value(&block).map_err(|error| fail(GltfErrorKind::Json(error)))?;
        let primitive = self.root.pointer_mut(&format!("/meshes/{mesh}/primitives/{primitive}"));
        let primitive = primitive.and_then(Value::as_object_mut).ok_or_else(|| fail(GltfErrorKind::Value))?;
        let extras = primitive.entry("extras").or_insert_with(|| Value::Object(Map::new()));
        let extras = extras.as_object_mut().ok_or_else(|| fail(GltfErrorKind::ExtrasKind))?;
        extras.insert(KEY.into(), block);
        Ok(())
    }

    /// Appends `bytes` to the buffer, and a buffer view of them; its number.
    fn append(&mut self, bytes: &[u8]) -> Result<usize, GltfError> {
        self.data.resize(self.data.len().next_multiple_of(ALIGNMENT), 0);
        let mut view = Map::new();
        view.insert("buffer".into(), 0.into());
        view.insert("byteOffset".into(), self.data.len().into());
        view.insert("byteLength".into(), bytes.len().into());
        self.data.extend_from_slice(bytes);
        let views = self.list("bufferViews")?;
        views.push(Value::Object(view));
        Ok(views.len() - 1)
    }

    /// As [`append`](Self::append), but no buffer view may be empty.
    fn append_some(&mut self, bytes: &[u8]) -> Result<Option<usize>, GltfError> {
        if bytes.is_empty() { Ok(None) } else { self.append(bytes).map(Some) }
    }

    /// An array of the root, made if it is absent.
    fn list(&mut self, name: &str) -> Result<&mut Vec<Value>, GltfError> {
        let root = self.root.as_object_mut();
        let list = root.and_then(|root| root.entry(name).or_insert_with(|| Value::Array(Vec::new())).as_array_mut());
        list.ok_or_else(|| self.container.error(name, GltfErrorKind::Value))
    }

    fn finish(mut self, kind: GltfKind) -> Result<Vec<u8>, GltfError> {
        let data = std::mem::take(&mut self.data);
        let later: Vec<String> =
            (1..self.container.root.buffers.len()).map(|n| data_uri(self.container.buffer(n))).collect();
        let buffers = self.list("buffers")?;
        if buffers.is_empty() {
            buffers.push(Value::Object(Map::new()));
        }
        for (number, buffer) in buffers.iter_mut().enumerate() {
            let Some(buffer) = buffer.as_object_mut() else { continue };
            if number == 0 {
                buffer.remove("uri");
                buffer.insert("byteLength".into(), data.len().into());
                if kind == GltfKind::Json {
                    buffer.insert("uri".into(), data_uri(&data).into());
                }
            } else if let Some(uri) = later.get(number - 1) {
                buffer.insert("uri".into(), uri.as_str().into());
            }
        }
        let text = serde_json::to_vec(&self.root);
        let text = text.map_err(|error| self.container.error("JSON", GltfErrorKind::Json(error)))?;
        match kind {
            GltfKind::Json => Ok(text),
            GltfKind::Binary => binary(text, data).map_err(|kind| self.container.error("", kind)),
        }
    }
}

/// A `.glb` of a JSON and a binary chunk.
fn binary(mut text: Vec<u8>, mut data: Vec<u8>) -> Result<Vec<u8>, GltfErrorKind> {
    text.resize(text.len().next_multiple_of(4), b' ');
    data.resize(data.len().next_multiple_of(4), 0);
    let total = 28 + text.len() + data.len();
    let length = |bytes: usize| u32::try_from(bytes).map_err(|_| GltfErrorKind::TooLarge { bytes: total });
    let mut file = Vec::with_capacity(total);
    file.extend_from_slice(b"glTF\x02\0\0\0");
    file.extend_from_slice(&length(total)?.to_le_bytes());
    for (kind, chunk) in [(b"JSON", text), (b"BIN\0", data)] {
        file.extend_from_slice(&length(chunk.len())?.to_le_bytes());
        file.extend_from_slice(kind);
        file.extend_from_slice(&chunk);
    }
    Ok(file)
}

fn data_uri(bytes: &[u8]) -> String {
    format!("data:application/octet-stream;base64,{}", BASE64_STANDARD.encode(bytes))
}

/// The media type of an image, by its first bytes.
fn media_type(bytes: &[u8]) -> &'static str {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => "image/png",
        [0xff, 0xd8, 0xff, ..] => "image/jpeg",
        [b'D', b'D', b'S', b' ', ..] => "image/vnd-ms.dds",
        [0xab, b'K', b'T', b'X', b' ', b'2', b'0', ..] => "image/ktx2",
        _ => "application/octet-stream",
    }
}
