//! Micromaps in a glTF file: buffer views that an `extras` block of each primitive names, as `docs/gltf-extras.md` describes.

use std::path::Path;

use omm_layout::triangle::TriangleArray;
use omm_model::special_index::OpacityMicromapSpecialIndex;
use omm_model::triangle::MicromapTriangle;
use omm_model::usage::{self, MicromapUsage};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::container::Container;
use super::error::{GltfError, GltfErrorKind};
use crate::bake::BakeOutput;

/// The name of the block in a primitive's `extras`.
pub const KEY: &str = "opacityMicromap";

/// The version of the block that is written, and the only one that is read.
pub const VERSION: u32 = 1;

/// The block, as it stands in the file. Buffer views that would be empty are left out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub(super) struct Block {
    pub(super) version: u32,
    /// Buffer view of the micromap's data.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) data: Option<usize>,
    /// Buffer view of the micromap triangles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) triangles: Option<usize>,
    /// Buffer view of the index buffer.
    pub(super) indices: usize,
    pub(super) usage_counts: Vec<Usage>,
    pub(super) index_usage_counts: Vec<Usage>,
}

/// A usage count, under the names of the specification.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub(super) struct Usage {
    count: u32,
    subdivision_level: u32,
    format: u16,
}

impl From<&MicromapUsage> for Usage {
    fn from(&MicromapUsage { count, subdivision_level, format }: &MicromapUsage) -> Self {
        Self { count, subdivision_level: subdivision_level.get(), format: format.value() }
    }
}

pub(super) fn usages(counts: &[MicromapUsage]) -> Vec<Usage> {
    counts.iter().map(Usage::from).collect()
}

/// The micromap of one primitive.
#[derive(Clone, Copy, Debug)]
pub struct PrimitiveOutput<'a> {
    /// Number of the mesh in the file.
    pub mesh: usize,
    /// Number of the primitive in the mesh.
    pub primitive: usize,
    /// What was baked for it.
    pub output: &'a BakeOutput,
}

/// The micromap of one primitive, as it was found in a file. All of it has been checked: ranges lie in `array`, and indices name
/// triangles or are special.
#[derive(Clone, Debug, PartialEq)]
pub struct PrimitiveMicromap {
    /// Number of the mesh in the file.
    pub mesh: usize,
    /// Number of the primitive in the mesh.
    pub primitive: usize,
    /// The micromap's data.
    pub array: Vec<u8>,
    /// Where each block lies and how it is to be read.
    pub triangles: Vec<MicromapTriangle>,
    /// For each triangle of the primitive an index into `triangles`, or a special index.
    pub indices: Vec<i32>,
    /// How many of `triangles` have each level and format.
    pub usage_counts: Vec<MicromapUsage>,
    /// How many of `indices` refer to a triangle of each level and format.
    pub index_usage_counts: Vec<MicromapUsage>,
}

/// The micromaps that the glTF file at `path` holds, in the order of meshes and primitives; none if it has none.
///
/// # Errors
/// [`GltfError`] names the file and the place at which a block is malformed, of another version, or contradicts its data.
pub fn micromaps(path: &Path) -> Result<Vec<PrimitiveMicromap>, GltfError> {
    let container = Container::read(path)?;
    let mut found = Vec::new();
    for (mesh_number, mesh) in container.root.meshes.iter().enumerate() {
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let at = format!("meshes[{mesh_number}].primitives[{number}].extras.{KEY}");
            let json = |error| container.error(&at, GltfErrorKind::Json(error));
            let extras: Option<Value> = match &primitive.extras {
                Some(raw) => serde_json::from_str(raw.get()).map_err(json)?,
                None => None,
            };
            let Some(block) = extras.and_then(|mut extras| extras.get_mut(KEY).map(Value::take)) else { continue };
            let block = serde_json::from_value(block).map_err(json)?;
            let micromap = decode(&container, &block, (mesh_number, number), &at);
            found.push(micromap.map_err(|(at, kind)| container.error(at, kind))?);
        }
    }
    Ok(found)
}

/// What is wrong, and where.
type Located = (String, GltfErrorKind);

fn decode(
    container: &Container,
    block: &Block,
    (mesh, primitive): (usize, usize),
    at: &str,
) -> Result<PrimitiveMicromap, Located> {
    let &Block { version, data, triangles, indices, ref usage_counts, ref index_usage_counts } = block;
    if version != VERSION {
        return Err((format!("{at}.version"), GltfErrorKind::ExtrasVersion { found: version }));
    }
    let view = |field: &str, view: Option<usize>| match view {
        Some(view) => {
            container.view(view, &format!("{at}.{field}")).map(|(bytes, _)| bytes).map_err(|e| (e.at, e.kind))
        }
        None => Ok(&[][..]),
    };
    let array = view("data", data)?.to_vec();
    let triangles = decode_triangles(view("triangles", triangles)?, array.len() as u64)
        .map_err(|kind| (format!("{at}.triangles"), kind))?;
    let indices = decode_indices(view("indices", Some(indices))?, triangles.len())
        .map_err(|kind| (format!("{at}.indices"), kind))?;
    let counts = usage::histogram(triangles.iter().copied());
    let referred = indices.iter().filter_map(|&index| triangles.get(usize::try_from(index).ok()?)).copied();
    let index_counts = usage::histogram(referred);
    for (field, found, counted) in
        [("usageCounts", usage_counts, &counts), ("indexUsageCounts", index_usage_counts, &index_counts)]
    {
        if *found != usages(counted) {
            return Err((format!("{at}.{field}"), GltfErrorKind::ExtrasCounts));
        }
    }
    let (usage_counts, index_usage_counts) = (counts, index_counts);
    Ok(PrimitiveMicromap { mesh, primitive, array, triangles, indices, usage_counts, index_usage_counts })
}

fn decode_triangles(bytes: &[u8], array_bytes: u64) -> Result<Vec<MicromapTriangle>, GltfErrorKind> {
    const SIZE: usize = omm_layout::triangle::SIZE;
    let count = bytes.len() / SIZE;
    if !bytes.len().is_multiple_of(SIZE) {
        return Err(GltfErrorKind::ExtrasLength { found: bytes.len(), unit: SIZE });
    }
    let unreadable = |number: usize, reason: String| GltfErrorKind::ExtrasTriangle { number, reason };
    let array =
        TriangleArray::new(bytes, SIZE as u64, count as u64).map_err(|error| unreadable(0, error.to_string()))?;
    let checked = array.checked().enumerate().map(|(number, triangle)| {
        let triangle = triangle.map_err(|error| unreadable(number, error.to_string()))?;
        let end = triangle.data_range().end;
        let outside = || unreadable(number, format!("its data ends at byte {end} of {array_bytes}"));
        if end <= array_bytes { Ok(triangle) } else { Err(outside()) }
    });
    checked.collect()
}

fn decode_indices(bytes: &[u8], triangles: usize) -> Result<Vec<i32>, GltfErrorKind> {
    let (words, []) = bytes.as_chunks() else {
        return Err(GltfErrorKind::ExtrasLength { found: bytes.len(), unit: size_of::<i32>() });
    };
    let indices: Vec<i32> = words.iter().map(|&word| i32::from_le_bytes(word)).collect();
    let known = |&index: &i32| match usize::try_from(index) {
        Ok(index) => index < triangles,
        Err(_) => OpacityMicromapSpecialIndex::from_value(index).is_some(),
    };
    match indices.iter().position(|index| !known(index)) {
        None => Ok(indices),
        Some(position) => Err(GltfErrorKind::ExtrasIndex { position, found: indices[position], triangles }),
    }
}

#[cfg(test)]
mod tests;
