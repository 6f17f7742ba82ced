//! Alpha-masked primitives of glTF 2.0 files (`.gltf`, `.glb`).
//!
//! Every primitive whose material has `alphaMode` `MASK` becomes one thing to bake:
//!
//! - **Alpha** is that of the base colour texture (any [`image`] that is read, embedded, as a `data:` URI, or in a
//!   file beside or below the glTF file), times the alpha of `baseColorFactor`. Where `MSFT_texture_dds` names an image, that one is
//!   read; one of `KHR_texture_basisu` is refused, because what a shader reads of it depends on a transcoder. The factor goes into the cutoff, see [`MaskedPrimitive::alpha_cutoff`]. An alpha in `COLOR_0`
//!   other than 1 is refused: it varies over the mesh, so no texture has it.
//! - **Texture coordinates** are those of the set that the texture names, as floats or normalized integers, with
//!   `KHR_texture_transform` applied in `f64` and rounded to `f32`. A shader that transforms in `f32` may differ in the last place.
//! - **Triangles** are those of lists, strips and fans, their vertices in the order that glTF gives them. A micromap is tied to
//!   that order: the acceleration structure must be built from the same.
//! - **Sampler**: along each axis `REPEAT` is [`AddressMode::Wrap`], `MIRRORED_REPEAT` is [`AddressMode::Mirror`], `CLAMP_TO_EDGE` is
//!   [`AddressMode::Clamp`]; the magnification filter is the filter, linear where none is given. Mipmaps are not looked at.
//!
//! Nodes and scenes play no part in baking: a primitive is baked once, however often it is placed. [`read_scene`] reads them, and all
//! that is not masked, for those who want to look.
//!
//! [`embed`] writes what was baked back into a glTF file; [`extras`] reads it there.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use gltf::json;
use json::material::{AlphaMode, Material};
use json::mesh::{Mode, Primitive, Semantic};
use json::texture::{Info, MagFilter, WrappingMode};
use json::validation::Checked;

use crate::files::safe_name;
use crate::image::{self, ImageOptions};
use crate::sampler::{AddressMode, Filter, Sampler};
use crate::texture::Texture;

mod accessor;
mod container;
mod cutoff;
mod embed;
mod error;
pub mod extras;
mod scene;
mod transform;
mod uri;

pub use embed::{GltfKind, embed};
pub use error::{GltfError, GltfErrorKind};
pub use scene::{GltfCamera, GltfPlacement, GltfScene, Mask, Matrix, ScenePrimitive, read_scene};

use accessor::Elements;
use container::Container;
use transform::Transform;

/// The alpha-masked primitives of a glTF file and the textures that they read.
#[derive(Debug)]
pub struct GltfFile {
    /// The alpha channel of each image that is read, once.
    pub textures: Vec<Texture>,
    /// The primitives in the order of meshes and, within a mesh, of primitives. Never empty.
    pub primitives: Vec<MaskedPrimitive>,
    /// The files that were read: the glTF file, then those of its buffers and of the images in use, each once.
    pub files: Vec<PathBuf>,
}

/// One primitive to bake.
#[derive(Debug)]
pub struct MaskedPrimitive {
    /// `meshname_primN`, or `meshM_primN` for a mesh without a name: unique in the file and safe as the start of a file name.
    pub name: String,
    /// The mesh's own name, if it has one. It may be any text.
    pub mesh_name: Option<String>,
    /// Number of the mesh in the file.
    pub mesh: usize,
    /// Number of the primitive in the mesh.
    pub primitive: usize,
    /// Index into [`GltfFile::textures`].
    pub texture: usize,
    /// How the texture is read.
    pub sampler: Sampler,
    /// The texture's alpha above which the surface is opaque.
    ///
    /// That is `alphaCutoff`, 0.5 where none is given, divided by the alpha of `baseColorFactor` and rounded to `f32`; with the
    /// default factor of 1 it is `alphaCutoff` itself. glTF also calls the alpha that *equals* the cutoff opaque. Where that
    /// decides over whole texels - a texel value exists that equals it, such as 1 for a cutoff of 1 - this is the next `f32` below.
    pub alpha_cutoff: f32,
    /// The alpha of `baseColorFactor`, `0.0..=1.0`.
    pub alpha_factor: f32,
    /// Texture coordinates of each vertex, transformed.
    pub uvs: Vec<[f32; 2]>,
    /// Vertices of each triangle, all below `uvs.len()`.
    pub triangles: Vec<[u32; 3]>,
}

impl MaskedPrimitive {
    /// What [`alpha_cutoff`](Self::alpha_cutoff) would be if the material's `alphaCutoff` were `cutoff`.
    #[must_use]
    pub fn cutoff_for(&self, cutoff: f32) -> f32 {
        cutoff::above(cutoff, self.alpha_factor)
    }
}

/// Reads the alpha-masked primitives of the glTF file at `path`, with the buffers and images that it names.
///
/// Of each image the mip levels and the channel of `options` are read. The channel that glTF itself masks by is alpha.
///
/// # Errors
/// [`GltfError`] names the file and the byte or the JSON path at which something is missing, out of range or not known, and says
/// so if there is no primitive to bake.
pub fn read(path: &Path, options: ImageOptions) -> Result<GltfFile, GltfError> {
    let container = Container::read(path)?;
    let mut reader = Reader {
        container: &container,
        options,
        textures: Vec::new(),
        by_image: BTreeMap::new(),
        names: BTreeSet::new(),
    };
    let mut primitives = Vec::new();
    for (mesh_number, mesh) in container.root.meshes.iter().enumerate() {
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let at = format!("meshes[{mesh_number}].primitives[{number}]");
            let Some(material) = reader.masked_material(primitive, &at)? else { continue };
            let mesh_name = mesh.name.as_deref().filter(|name| !name.is_empty());
            let name = mesh_name.map_or_else(|| format!("mesh{mesh_number}"), safe_name);
            let name = reader.unique_name(format!("{name}_prim{number}"));
            let masked = reader.primitive(primitive, material, &at, (name, mesh_number, number))?;
            primitives.push(MaskedPrimitive { mesh_name: mesh_name.map(str::to_owned), ..masked });
        }
    }
    if primitives.is_empty() {
        return Err(container.error("meshes", GltfErrorKind::NothingToBake));
    }
    let images = reader.by_image.keys().filter_map(|&index| container.root.images.get(index)?.uri.as_deref());
    let files = container.files(images);
    Ok(GltfFile { textures: reader.textures, primitives, files })
}

/// A material and the place where it stands.
type Located<'a> = (&'a Material, String);

struct Reader<'a> {
    container: &'a Container,
    options: ImageOptions,
    textures: Vec<Texture>,
    /// Where in `textures` the alpha of an image is.
    by_image: BTreeMap<usize, usize>,
    /// Names given so far, in lower case: some file systems know no other.
    names: BTreeSet<String>,
}

impl<'a> Reader<'a> {
    fn unique_name(&mut self, name: String) -> String {
        let mut unique = name.clone();
        let mut number = 2;
        while !self.names.insert(unique.to_lowercase()) {
            unique = format!("{name}_{number}");
            number += 1;
        }
        unique
    }

    /// The primitive's material, if its alpha is to be cut off.
    fn masked_material(&self, primitive: &Primitive, at: &str) -> Result<Option<Located<'a>>, GltfError> {
        let Some(index) = primitive.material else { return Ok(None) };
        let material = self.container.item(&self.container.root.materials, index.value(), &format!("{at}.material"))?;
        let at = format!("materials[{}]", index.value());
        match material.alpha_mode {
            Checked::Valid(AlphaMode::Mask) => Ok(Some((material, at))),
            Checked::Valid(AlphaMode::Opaque | AlphaMode::Blend) => Ok(None),
            Checked::Invalid => Err(self.container.error(format!("{at}.alphaMode"), GltfErrorKind::Value)),
        }
    }

    fn primitive(
        &mut self,
        primitive: &Primitive,
        (material, material_at): Located<'a>,
        at: &str,
        (name, mesh, number): (String, usize, usize),
    ) -> Result<MaskedPrimitive, GltfError> {
        let surface = &material.pbr_metallic_roughness;
        let surface_at = format!("{material_at}.pbrMetallicRoughness");
        let texture_at = format!("{surface_at}.baseColorTexture");
        let Some(info) = &surface.base_color_texture else {
            return Err(self.container.error(material_at, GltfErrorKind::NoTexture));
        };
        let (texture, sampler) = self.texture(info, &texture_at)?;
        let factor = surface.base_color_factor.0[3];
        if !(0.0..=1.0).contains(&factor) {
            let kind = GltfErrorKind::Range { found: factor, least: 0.0, most: 1.0 };
            return Err(self.container.error(format!("{surface_at}.baseColorFactor[3]"), kind));
        }
        let cutoff = material.alpha_cutoff.map_or(0.5, |cutoff| cutoff.0);
        if !cutoff.is_finite() {
            return Err(self
                .container
                .error(format!("{material_at}.alphaCutoff"), GltfErrorKind::NotFinite { found: cutoff }));
        }
        self.check_vertex_alpha(primitive, at)?;
        let uvs = self.texture_coordinates(primitive, info, at, &texture_at)?;
        let triangles = self.triangles(primitive, uvs.len(), at)?;
        let alpha_cutoff = cutoff::above(cutoff, factor);
        Ok(MaskedPrimitive {
            name,
            mesh_name: None,
            mesh,
            primitive: number,
            texture,
            sampler,
            alpha_cutoff,
            alpha_factor: factor,
            uvs,
            triangles,
        })
    }

    /// The index of the texture's alpha, and how it is read.
    fn texture(&mut self, info: &Info, at: &str) -> Result<(usize, Sampler), GltfError> {
        let (image_index, sampler) = self.texture_source(info, at)?;
        if let Some(&known) = self.by_image.get(&image_index) {
            return Ok((known, sampler));
        }
        let bytes = self.image_bytes(image_index)?;
        let fail = |error: image::ImageError| self.container.error(format!("images[{image_index}]"), error.into());
        self.textures.push(image::read(&bytes, self.options).map_err(fail)?);
        let index = self.textures.len() - 1;
        self.by_image.insert(image_index, index);
        Ok((index, sampler))
    }

    /// The number of a texture's image, and how it is read.
    fn texture_source(&self, info: &Info, at: &str) -> Result<(usize, Sampler), GltfError> {
        let container = self.container;
        let texture = container.item(&container.root.textures, info.index.value(), &format!("{at}.index"))?;
        let at = format!("textures[{}]", info.index.value());
        let sampler = match texture.sampler {
            Some(index) => self.sampler(index.value(), &format!("{at}.sampler"))?,
            None => Sampler::default(),
        };
        let image_index = self.image_of(texture, &at)?;
        container.item(&container.root.images, image_index, &format!("{at}.source"))?;
        Ok((image_index, sampler))
    }

    /// The bytes of an image file.
    fn image_bytes(&self, image_index: usize) -> Result<Cow<'a, [u8]>, GltfError> {
        let container = self.container;
        let at = format!("images[{image_index}]");
        let image = container.item(&container.root.images, image_index, &at)?;
        match (&image.uri, image.buffer_view) {
            (Some(uri), _) => Ok(uri::read(&container.file, &format!("{at}.uri"), uri)?.into()),
            (None, Some(view)) => Ok(container.view(view.value(), &format!("{at}.bufferView"))?.0.into()),
            (None, None) => Err(container.error(at, GltfErrorKind::NoImage)),
        }
    }

    /// The number of the image that a program which knows the texture's extensions would read.
    fn image_of(&self, texture: &json::texture::Texture, at: &str) -> Result<usize, GltfError> {
        // The JSON reader's mark for a source that is absent, as in a texture that only an extension gives an image.
        let source = Some(texture.source.value()).filter(|&source| source != u32::MAX as usize);
        let others = texture.extensions.as_ref().map(|extensions| &extensions.others);
        let extended = |name: &str| {
            let Some(extension) = others.and_then(|others| others.get(name)) else { return Ok(None) };
            let index =
                extension.get("source").and_then(json::Value::as_u64).and_then(|index| usize::try_from(index).ok());
            let at = || format!("{at}.extensions.{name}.source");
            index.map(Some).ok_or_else(|| self.container.error(at(), GltfErrorKind::Value))
        };
        match (extended("KHR_texture_basisu")?, extended("MSFT_texture_dds")?, source) {
            (Some(_), _, Some(_)) => Err(self.container.error(at, GltfErrorKind::Basis)),
            (Some(index), ..) | (None, Some(index), _) | (None, None, Some(index)) => Ok(index),
            (None, None, None) => Err(self.container.error(at, GltfErrorKind::NoImage)),
        }
    }

    fn sampler(&self, index: usize, at: &str) -> Result<Sampler, GltfError> {
        let sampler = self.container.item(&self.container.root.samplers, index, at)?;
        let fail = |field: &str, kind| self.container.error(format!("samplers[{index}]{field}"), kind);
        let mode = |field, mode: &Checked<WrappingMode>| match mode {
            Checked::Valid(WrappingMode::Repeat) => Ok(AddressMode::Wrap),
            Checked::Valid(WrappingMode::MirroredRepeat) => Ok(AddressMode::Mirror),
            Checked::Valid(WrappingMode::ClampToEdge) => Ok(AddressMode::Clamp),
            Checked::Invalid => Err(fail(field, GltfErrorKind::Value)),
        };
        let (address_mode_u, address_mode_v) = (mode(".wrapS", &sampler.wrap_s)?, mode(".wrapT", &sampler.wrap_t)?);
        let filter = match sampler.mag_filter {
            Some(Checked::Valid(MagFilter::Nearest)) => Filter::Nearest,
            Some(Checked::Valid(MagFilter::Linear)) | None => Filter::Linear,
            Some(Checked::Invalid) => return Err(fail(".magFilter", GltfErrorKind::Value)),
        };
        Ok(Sampler { address_mode_u, address_mode_v, filter, border_alpha: 0.0 })
    }

    fn check_vertex_alpha(&self, primitive: &Primitive, at: &str) -> Result<(), GltfError> {
        let Some(accessor) = primitive.attributes.get(&Checked::Valid(Semantic::Colors(0))) else { return Ok(()) };
        let at = format!("{at}.attributes.COLOR_0");
        let colours = Elements::read(self.container, accessor.value(), &at)?;
        match colours.first_alpha() {
            Ok(None) => Ok(()),
            Ok(Some((vertex, found))) => Err(self.container.error(at, GltfErrorKind::VertexAlpha { vertex, found })),
            Err(kind) => Err(self.container.error(at, kind)),
        }
    }

    fn texture_coordinates(
        &self,
        primitive: &Primitive,
        info: &Info,
        at: &str,
        texture_at: &str,
    ) -> Result<Vec<[f32; 2]>, GltfError> {
        let transform = info.extensions.as_ref().and_then(|extensions| extensions.texture_transform.as_ref());
        let set = transform.and_then(|transform| transform.tex_coord).unwrap_or(info.tex_coord);
        let Some(accessor) = primitive.attributes.get(&Checked::Valid(Semantic::TexCoords(set))) else {
            return Err(self.container.error(format!("{at}.attributes"), GltfErrorKind::NoTextureCoordinates { set }));
        };
        let at = format!("{at}.attributes.TEXCOORD_{set}");
        let pairs = Elements::read(self.container, accessor.value(), &at)?.pairs();
        let mut uvs = pairs.map_err(|kind| self.container.error(at, kind))?;
        if let Some(transform) = transform {
            let Some(transform) = Transform::new(transform) else {
                let at = format!("{texture_at}.extensions.KHR_texture_transform");
                return Err(self.container.error(at, GltfErrorKind::Value));
            };
            for uv in &mut uvs {
                *uv = transform.apply(*uv);
            }
        }
        Ok(uvs)
    }

    fn triangles(&self, primitive: &Primitive, vertices: usize, at: &str) -> Result<Vec<[u32; 3]>, GltfError> {
        let mode_at = format!("{at}.mode");
        let Checked::Valid(mode) = primitive.mode else {
            return Err(self.container.error(mode_at, GltfErrorKind::Value));
        };
        let (indices, at) = match primitive.indices {
            Some(accessor) => {
                let at = format!("{at}.indices");
                let indices = Elements::read(self.container, accessor.value(), &at)?.indices();
                (indices.map_err(|kind| self.container.error(&at, kind))?, at)
            }
            // So many vertices have data, hence their numbers fit.
            None => ((0..vertices as u32).collect(), at.to_owned()),
        };
        let beyond = indices.iter().enumerate().find(|&(_, &index)| index as usize >= vertices);
        if let Some((position, &found)) = beyond {
            return Err(self.container.error(at, GltfErrorKind::VertexIndex { position, found, vertices }));
        }
        let count = indices.len();
        let enough = match mode {
            Mode::Triangles => count > 0 && count.is_multiple_of(3),
            Mode::TriangleStrip | Mode::TriangleFan => count >= 3,
            Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => {
                return Err(self.container.error(mode_at, GltfErrorKind::Mode { mode: format!("{mode:?}") }));
            }
        };
        if !enough {
            return Err(self.container.error(at, GltfErrorKind::VertexCount { count }));
        }
        Ok(assemble(mode, &indices))
    }
}

/// The triangles of a list, strip or fan, with the order of vertices that glTF gives them.
fn assemble(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
    match (mode, indices) {
        (Mode::TriangleStrip, [first, second, rest @ ..]) => {
            let mut edge = [*first, *second];
            let mut triangles = Vec::with_capacity(rest.len());
            for (number, &next) in rest.iter().enumerate() {
                let [a, b] = edge;
                triangles.push(if number.is_multiple_of(2) { [a, b, next] } else { [a, next, b] });
                edge = [b, next];
            }
            triangles
        }
        (Mode::TriangleFan, [hub, first, rest @ ..]) => {
            let befores = std::iter::once(first).chain(rest);
            befores.zip(rest).map(|(&before, &next)| [before, next, *hub]).collect()
        }
        _ => indices.as_chunks().0.to_vec(),
    }
}

#[cfg(test)]
mod tests;
