//! What is made of all results together: overviews of textures, a glTF file with the micromaps in it, a report.

use std::collections::BTreeMap;
use std::io::Write;
use std::ops::Deref;
use std::path::Path;

use omm_bake::gltf::extras::PrimitiveOutput;
use omm_bake::gltf::{self, GltfKind};
use omm_bake::picture::{self, Layer};
use omm_bake::{BakeOutput, Coverage};

use super::statistics::Statistics;
use super::{Item, report};
use crate::error::CliError;
use crate::output::OutputSet;

/// One thing that was baked.
pub(super) struct Baked<'a> {
    pub(super) item: Item<'a>,
    pub(super) output: BakeOutput,
    /// The index buffer's bytes, of the type that was asked for.
    pub(super) indices: Vec<u8>,
    pub(super) coverage: Coverage,
    pub(super) statistics: Statistics,
}

impl<'a> Deref for Baked<'a> {
    type Target = Item<'a>;
    fn deref(&self) -> &Item<'a> {
        &self.item
    }
}

/// What was baked, by the number of the texture that it reads.
pub(super) fn by_texture<'a, 'b>(baked: &'b [Baked<'a>]) -> BTreeMap<usize, Vec<&'b Baked<'a>>> {
    let mut textures = BTreeMap::<_, Vec<_>>::new();
    baked.iter().for_each(|one| textures.entry(one.texture).or_default().push(one));
    textures
}

/// Adds an overview of each texture that more than one primitive reads.
pub(super) fn write_atlases(baked: &[Baked<'_>], files: &mut OutputSet) -> Result<(), CliError> {
    for (texture, users) in by_texture(baked) {
        let [first, _, ..] = users.as_slice() else { continue };
        let layers: Vec<_> = users.iter().map(|one| Layer { input: one.input, output: &one.output }).collect();
        let picture = picture::atlas(first.input.texture, first.options.sampler, &layers);
        files.add_png(&format!("texture{texture}.atlas.png"), &picture)?;
    }
    Ok(())
}

/// The report of what was baked from `source`, ready to appear as the file `path`.
pub(super) fn stage_report(source: &Path, baked: &[Baked<'_>], path: &Path) -> Result<OutputSet, CliError> {
    let page = report::page(source, baked).map_err(CliError::Report)?;
    stage(path, page.as_bytes())
}

/// The glTF file `source` with the micromaps in it, ready to appear as the file `path`, whose name says which kind it is.
pub(super) fn stage_gltf(source: &Path, baked: &[Baked<'_>], path: &Path) -> Result<OutputSet, CliError> {
    let kind = gltf_kind(path).ok_or_else(|| CliError::UnknownOutput { path: path.into() })?;
    let micromaps: Vec<_> = baked
        .iter()
        .filter_map(|one| {
            let (mesh, primitive) = one.place?;
            Some(PrimitiveOutput { mesh, primitive, output: &one.output })
        })
        .collect();
    stage(path, &gltf::embed(source, &micromaps, kind)?)
}

/// The kind of glTF file that a name stands for.
pub(super) fn gltf_kind(path: &Path) -> Option<GltfKind> {
    match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
        "glb" => Some(GltfKind::Binary),
        "gltf" => Some(GltfKind::Json),
        _ => None,
    }
}

fn stage(path: &Path, bytes: &[u8]) -> Result<OutputSet, CliError> {
    let mut files = OutputSet::of_file(path)?;
    files.add_file(path, |out| out.write_all(bytes))?;
    Ok(files)
}
