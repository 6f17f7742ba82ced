//! The outermost layer: `.glb` chunks, JSON, and the buffers that the JSON names.

use std::path::{Path, PathBuf};

use gltf::json::{self, Root};

use super::error::{GltfError, GltfErrorKind};
use super::uri;
use crate::files;

/// Extensions that a file may require: those honoured here and those that change only how things look otherwise.
const KNOWN_EXTENSIONS: [&str; 5] = [
    "KHR_texture_transform",
    "KHR_mesh_quantization",
    "KHR_materials_unlit",
    "KHR_materials_specular",
    "KHR_lights_punctual",
];

/// A glTF file with all its buffers.
pub(super) struct Container {
    pub(super) file: PathBuf,
    pub(super) root: Root,
    buffers: Vec<Vec<u8>>,
    /// Bytes of the file and of all buffers.
    pub(super) total_bytes: u64,
}

impl Container {
    pub(super) fn read(file: &Path) -> Result<Self, GltfError> {
        let fail = |at: &str, kind| GltfError::new(file, at, kind);
        let bytes = files::read(file).map_err(|error| fail("", GltfErrorKind::Read(error)))?;
        let (json, binary) = split(&bytes).map_err(|(offset, kind)| fail(&format!("byte {offset}"), kind))?;
        let root: Root =
            json::deserialize::from_slice(json).map_err(|error| fail("JSON", GltfErrorKind::Json(error)))?;
        for (position, name) in root.extensions_required.iter().enumerate() {
            if !KNOWN_EXTENSIONS.contains(&name.as_str()) {
                let name = name.clone();
                return Err(fail(&format!("extensionsRequired[{position}]"), GltfErrorKind::Extension { name }));
            }
        }
        let mut container = Self { file: file.into(), root, buffers: Vec::new(), total_bytes: bytes.len() as u64 };
        container.read_buffers(binary)?;
        Ok(container)
    }

    fn read_buffers(&mut self, binary: Option<&[u8]>) -> Result<(), GltfError> {
        for (position, buffer) in self.root.buffers.iter().enumerate() {
            let at = format!("buffers[{position}]");
            let mut data = match (&buffer.uri, binary) {
                (Some(uri), _) => uri::read(&self.file, &format!("{at}.uri"), uri)?,
                (None, Some(binary)) if position == 0 => binary.to_vec(),
                (None, _) => return Err(self.error(at, GltfErrorKind::NoData)),
            };
            let (claimed, found) = (buffer.byte_length.0, data.len() as u64);
            if claimed > found {
                return Err(self.error(format!("{at}.byteLength"), GltfErrorKind::Length { claimed, found }));
            }
            // A binary chunk is padded, and a file may go on: what is beyond the claimed length does not belong to the buffer.
            data.truncate(usize::try_from(claimed).unwrap_or(usize::MAX));
            self.total_bytes = self.total_bytes.saturating_add(claimed);
            self.buffers.push(data);
        }
        Ok(())
    }

    /// This file, and those that the URIs of its buffers and these URIs of images name, each once.
    pub(super) fn files<'a>(&'a self, images: impl Iterator<Item = &'a str>) -> Vec<PathBuf> {
        let buffers = self.root.buffers.iter().filter_map(|buffer| buffer.uri.as_deref());
        let mut files = vec![self.file.clone()];
        for file in buffers.chain(images).filter_map(|uri| uri::file(&self.file, uri)) {
            if !files.contains(&file) {
                files.push(file);
            }
        }
        files
    }

    /// The error `kind` at `at` in this file.
    pub(super) fn error(&self, at: impl Into<String>, kind: GltfErrorKind) -> GltfError {
        GltfError::new(&self.file, at, kind)
    }

    /// Item `index` of one of the root's arrays; `at` is the place that names it.
    pub(super) fn item<'a, T>(&self, items: &'a [T], index: usize, at: &str) -> Result<&'a T, GltfError> {
        items.get(index).ok_or_else(|| self.error(at, GltfErrorKind::Index { index, count: items.len() }))
    }

    /// The bytes and the stride of a buffer view; `at` is the place that names it.
    pub(super) fn view(&self, index: usize, at: &str) -> Result<(&[u8], Option<usize>), GltfError> {
        let view = self.item(&self.root.buffer_views, index, at)?;
        let at = format!("bufferViews[{index}]");
        let buffer = self.item(&self.buffers, view.buffer.value(), &format!("{at}.buffer"))?;
        let start = view.byte_offset.unwrap_or_default().0;
        let bytes = slice(buffer, start, view.byte_length.0, "buffer").map_err(|kind| self.error(at, kind))?;
        Ok((bytes, view.byte_stride.map(|stride| stride.0)))
    }
}

/// `length` bytes of `bytes` from `start`, if there are so many.
pub(super) fn slice<'a>(bytes: &'a [u8], start: u64, length: u64, of: &'static str) -> Result<&'a [u8], GltfErrorKind> {
    let end = start.saturating_add(length);
    let range = usize::try_from(start).ok().zip(usize::try_from(end).ok());
    let found = range.and_then(|(start, end)| bytes.get(start..end));
    found.ok_or(GltfErrorKind::OutOfRange { start, end, available: bytes.len() as u64, of })
}

/// A container's JSON and binary chunk. A file that does not start like a `.glb` is all JSON.
type Chunks<'a> = (&'a [u8], Option<&'a [u8]>);

fn split(bytes: &[u8]) -> Result<Chunks<'_>, (usize, GltfErrorKind)> {
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes, None));
    }
    let found = bytes.len() as u64;
    let word = |offset: usize| {
        let word = bytes.get(offset..).and_then(|rest| rest.first_chunk::<4>());
        word.copied().ok_or((offset, GltfErrorKind::Length { claimed: offset as u64 + 4, found }))
    };
    let version = u32::from_le_bytes(word(4)?);
    if version != 2 {
        return Err((4, GltfErrorKind::Version { found: version }));
    }
    let claimed = u64::from(u32::from_le_bytes(word(8)?));
    if claimed != found {
        return Err((8, GltfErrorKind::Length { claimed, found }));
    }
    // A chunk's type and data, and where the next one starts.
    let chunk = |offset: usize| {
        let length = u32::from_le_bytes(word(offset)?) as usize;
        let kind = word(offset + 4)?;
        let data = bytes.get(offset + 8..).unwrap_or_default();
        let rest = data.len() as u64;
        let data = data.get(..length).ok_or((offset, GltfErrorKind::Length { claimed: length as u64, found: rest }))?;
        Ok((kind, data, offset + 8 + length))
    };
    let (kind, json, mut offset) = chunk(12)?;
    if kind != *b"JSON" {
        return Err((16, GltfErrorKind::FirstChunk { found: kind }));
    }
    // Chunks of unknown types are to be skipped.
    while offset < bytes.len() {
        let (kind, data, next) = chunk(offset)?;
        if kind == *b"BIN\0" {
            return Ok((json, Some(data)));
        }
        offset = next;
    }
    Ok((json, None))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn glb(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
        let body: Vec<u8> = chunks
            .iter()
            .flat_map(|(kind, data)| {
                [&u32::try_from(data.len()).unwrap().to_le_bytes(), kind.as_slice(), data].concat()
            })
            .collect();
        let length = u32::try_from(12 + body.len()).unwrap();
        [b"glTF".as_slice(), &2_u32.to_le_bytes(), &length.to_le_bytes(), &body].concat()
    }

    fn text(bytes: &[u8]) -> String {
        let (offset, kind) = split(bytes).unwrap_err();
        format!("{offset}: {kind}")
    }

    #[test]
    fn chunks_are_found_and_unknown_ones_skipped() {
        assert_eq!(split(b"{}").unwrap(), (b"{}".as_slice(), None));
        assert_eq!(split(&glb(&[(b"JSON", b"{}  ")])).unwrap(), (b"{}  ".as_slice(), None));
        let three = glb(&[(b"JSON", b"{}  "), (b"ODD!", b"????"), (b"BIN\0", &[1, 2, 3, 4])]);
        assert_eq!(split(&three).unwrap(), (b"{}  ".as_slice(), Some([1, 2, 3, 4].as_slice())));
    }

    #[test]
    fn every_truncation_is_named() {
        let whole = glb(&[(b"JSON", b"{}  "), (b"BIN\0", &[1, 2, 3, 4])]);
        for end in 4..whole.len() {
            assert!(text(&whole[..end]).contains(" are there"), "{end}");
        }
        // The header may agree with a truncated file; then a chunk does not.
        for end in 12..whole.len() {
            let mut cut = whole[..end].to_vec();
            cut[8..12].copy_from_slice(&u32::try_from(end).unwrap().to_le_bytes());
            assert!(end == 24 || text(&cut).contains(" are there"), "{end}");
        }
        assert_eq!(text(&whole[..30]), "8: 36 bytes are claimed, 30 are there");
    }

    #[test]
    fn other_containers_are_refused() {
        let mut version = glb(&[(b"JSON", b"{}  ")]);
        version[4] = 1;
        assert_eq!(text(&version), "4: version 1 of the binary container; only version 2 is known");
        let first = glb(&[(b"BIN\0", &[0; 4])]);
        assert_eq!(text(&first), "16: the first chunk has type [42, 49, 4e, 00], which is not \"JSON\"");
    }
}
