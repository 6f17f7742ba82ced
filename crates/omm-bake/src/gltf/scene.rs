//! Everything that a glTF file shows: placed meshes, opaque ones too, with their colours, and cameras.
//!
//! - **Meshes** are those that a node of the scene places; `scene` says which scene, the first one otherwise, and without scenes
//!   every node that is nobody's child is placed. Points and lines, which no ray hits, are left out.
//! - **Transforms** are multiplied in `f64`, from the root down.
//! - **Colours** are those of the base colour texture and factor. What `alphaMode` `BLEND` covers is shown as if it were opaque.
//! - Skins, morph targets, animations and lights play no part.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use ::image::RgbImage;
use gltf::json;
use json::mesh::{Mode, Primitive, Semantic};
use json::validation::Checked;

use super::accessor::Elements;
use super::container::Container;
use super::error::{GltfError, GltfErrorKind};
use super::{MaskedPrimitive, Reader, image};
use crate::sampler::Sampler;
use crate::texture::Texture;

mod nodes;

pub use nodes::{GltfCamera, GltfPlacement, Matrix};

/// What a glTF file shows.
#[derive(Debug)]
pub struct GltfScene {
    /// The alpha channels that masked primitives read.
    pub textures: Vec<Texture>,
    /// The images whose colours are shown.
    pub images: Vec<RgbImage>,
    /// The meshes of the file; those that no node places are empty.
    pub meshes: Vec<Vec<ScenePrimitive>>,
    /// Where meshes are placed.
    pub placements: Vec<GltfPlacement>,
    /// Where cameras are placed.
    pub cameras: Vec<GltfCamera>,
}

/// A primitive of triangles.
#[derive(Debug)]
pub struct ScenePrimitive {
    /// Vertices, finite.
    pub positions: Vec<[f32; 3]>,
    /// Texture coordinates of the vertices, transformed; empty if the primitive has no texture.
    pub uvs: Vec<[f32; 2]>,
    /// Three vertices each, all below `positions.len()`, and below `uvs.len()` if that is not empty.
    pub triangles: Vec<[u32; 3]>,
    /// What the colour is multiplied with, linear.
    pub base_color_factor: [f32; 4],
    /// Index into [`GltfScene::images`], and how the image is read.
    pub base_color: Option<(usize, Sampler)>,
    /// What is cut out.
    pub mask: Option<Mask>,
}

/// An alpha test; see [`MaskedPrimitive`] for its fields.
#[derive(Clone, Copy, Debug)]
pub struct Mask {
    /// Index into [`GltfScene::textures`].
    pub texture: usize,
    /// How the texture is read.
    pub sampler: Sampler,
    /// The texture's alpha above which the surface is opaque.
    pub alpha_cutoff: f32,
}

/// Reads what the glTF file at `path` shows, with the buffers and images that it names.
///
/// # Errors
/// [`GltfError`] names the file and the byte or the JSON path at which something is missing, out of range or not known. A file that
/// places no triangles is none.
pub fn read_scene(path: &Path) -> Result<GltfScene, GltfError> {
    let container = Container::read(path)?;
    let mut reader = SceneReader {
        masks: Reader {
            container: &container,
            textures: Vec::new(),
            by_image: BTreeMap::new(),
            names: BTreeSet::new(),
        },
        images: Vec::new(),
        by_image: BTreeMap::new(),
    };
    let (placements, cameras) = nodes::walk(&container)?;
    let placed: BTreeSet<usize> = placements.iter().map(|placement| placement.mesh).collect();
    let mut meshes = Vec::new();
    for (number, mesh) in container.root.meshes.iter().enumerate() {
        let mut primitives = Vec::new();
        for (position, primitive) in mesh.primitives.iter().enumerate().filter(|_| placed.contains(&number)) {
            let at = format!("meshes[{number}].primitives[{position}]");
            primitives.extend(reader.primitive(primitive, &at, [number, position])?);
        }
        meshes.push(primitives);
    }
    if meshes.iter().all(Vec::is_empty) {
        return Err(container.error("nodes", GltfErrorKind::NothingToShow));
    }
    Ok(GltfScene { textures: reader.masks.textures, images: reader.images, meshes, placements, cameras })
}

struct SceneReader<'a> {
    masks: Reader<'a>,
    images: Vec<RgbImage>,
    /// Where in `images` an image of the file is.
    by_image: BTreeMap<usize, usize>,
}

impl SceneReader<'_> {
    /// A primitive; `None` if it is one of points or lines.
    fn primitive(
        &mut self,
        primitive: &Primitive,
        at: &str,
        [mesh, number]: [usize; 2],
    ) -> Result<Option<ScenePrimitive>, GltfError> {
        let container = self.masks.container;
        if matches!(primitive.mode, Checked::Valid(Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip)) {
            return Ok(None);
        }
        let positions = self.positions(primitive, at)?;
        let Some(material) = primitive.material else {
            let triangles = self.masks.triangles(primitive, positions.len(), at)?;
            let factor = [1.0; 4];
            let (uvs, base_color, mask) = (Vec::new(), None, None);
            return Ok(Some(ScenePrimitive { positions, uvs, triangles, base_color_factor: factor, base_color, mask }));
        };
        let material_at = format!("materials[{}]", material.value());
        let material = container.item(&container.root.materials, material.value(), &format!("{at}.material"))?;
        let surface = &material.pbr_metallic_roughness;
        let texture_at = format!("{material_at}.pbrMetallicRoughness.baseColorTexture");
        let base_color = match &surface.base_color_texture {
            Some(info) => Some(self.colour(info, &texture_at)?),
            None => None,
        };
        let (uvs, triangles, mask) = match self.masks.masked_material(primitive, at)? {
            Some(located) => {
                let name = (String::new(), mesh, number);
                let MaskedPrimitive { texture, sampler, alpha_cutoff, uvs, triangles, .. } =
                    self.masks.primitive(primitive, located, at, name)?;
                (uvs, triangles, Some(Mask { texture, sampler, alpha_cutoff }))
            }
            None => {
                let uvs = match &surface.base_color_texture {
                    Some(info) => self.masks.texture_coordinates(primitive, info, at, &texture_at)?,
                    None => Vec::new(),
                };
                let vertices = if uvs.is_empty() { positions.len() } else { uvs.len() };
                (uvs, self.masks.triangles(primitive, vertices, at)?, None)
            }
        };
        let beyond = triangles.as_flattened().iter().enumerate();
        let beyond = beyond.map(|(position, &found)| (position, found)).find(|&(_, at)| at as usize >= positions.len());
        if let Some((position, found)) = beyond {
            let kind = GltfErrorKind::VertexIndex { position, found, vertices: positions.len() };
            return Err(container.error(format!("{at}.attributes.POSITION"), kind));
        }
        let base_color_factor = surface.base_color_factor.0;
        Ok(Some(ScenePrimitive { positions, uvs, triangles, base_color_factor, base_color, mask }))
    }

    fn positions(&self, primitive: &Primitive, at: &str) -> Result<Vec<[f32; 3]>, GltfError> {
        let container = self.masks.container;
        let Some(accessor) = primitive.attributes.get(&Checked::Valid(Semantic::Positions)) else {
            return Err(container.error(format!("{at}.attributes"), GltfErrorKind::NoPositions));
        };
        let at = format!("{at}.attributes.POSITION");
        let positions = Elements::read(container, accessor.value(), &at)?.triples();
        let positions = positions.map_err(|kind| container.error(&at, kind))?;
        match positions.as_flattened().iter().find(|x| !x.is_finite()) {
            Some(&found) => Err(container.error(at, GltfErrorKind::NotFinite { found })),
            None => Ok(positions),
        }
    }

    /// The index of the image's colours, and how they are read.
    fn colour(&mut self, info: &json::texture::Info, at: &str) -> Result<(usize, Sampler), GltfError> {
        let (image_index, sampler) = self.masks.texture_source(info, at)?;
        if let Some(&known) = self.by_image.get(&image_index) {
            return Ok((known, sampler));
        }
        let container = self.masks.container;
        let bytes = self.masks.image_bytes(image_index)?;
        let colours = image::colours(&bytes).map_err(|kind| container.error(format!("images[{image_index}]"), kind))?;
        self.images.push(colours);
        self.by_image.insert(image_index, self.images.len() - 1);
        Ok((self.images.len() - 1, sampler))
    }
}

#[cfg(test)]
mod tests;
