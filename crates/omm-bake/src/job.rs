//! Job files: a bake written down as JSON, with its texture and mesh as raw arrays beside it.
//!
//! ```json
//! {
//!   "name": "leaf",
//!   "texture": { "path": "leaf.tex.bin", "width": 256, "height": 256, "format": "unorm8" },
//!   "uvs": "leaf.uv.bin",
//!   "triangles": "leaf.triangles.bin",
//!   "format": "4-state",
//!   "max_level": 5,
//!   "dynamic_subdivision_scale": null,
//!   "address_mode": "wrap",
//!   "filter": "linear",
//!   "border_alpha": 0.0,
//!   "alpha_cutoff": 0.5,
//!   "unknown_state_promotion": "nearest"
//! }
//! ```
//!
//! | field | meaning |
//! |---|---|
//! | `name` | what the results are called |
//! | `texture` | rows of texels from *v* = 0 upwards without gaps, each a byte (`unorm8`) or a little-endian `f32` (`fp32`) |
//! | `uvs` | a little-endian `f32` pair for each vertex |
//! | `triangles` | a little-endian `u32` triple of vertices for each triangle |
//! | `format` | `2-state` or `4-state` |
//! | `max_level` | the level of all triangles, 0 to 12; with a dynamic scale, the finest level |
//! | `dynamic_subdivision_scale` | texels along the side of a microtriangle; `null` or absent: a uniform level |
//! | `address_mode` | `wrap`, `mirror`, `clamp`, `border` or `mirror_once` |
//! | `filter` | `linear` or `nearest` |
//! | `border_alpha` | alpha outside the texture under `border`; 0 if absent |
//! | `alpha_cutoff` | opaque is alpha above this |
//! | `unknown_state_promotion` | `nearest`, `force_opaque` or `force_transparent` |
//!
//! Paths are relative to the job file's folder. Other fields are refused: one that is misspelt would go unnoticed.

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use omm_model::format::OpacityMicromapFormat;
use omm_model::level::{SubdivisionLevel, SubdivisionLevelError};
use serde::Deserialize;

use crate::files;
use crate::level::LevelChoice;
use crate::options::{BakeInput, BakeOptions};
use crate::promotion::UnknownStatePromotion;
use crate::sampler::{AddressMode, Filter, Sampler};
use crate::texture::{MAX_SIDE, Texture, TextureError};

/// A job, read and checked.
#[derive(Debug)]
pub struct Job {
    /// What the results are called: `name` made safe as the start of a file name.
    pub name: String,
    /// The texture.
    pub texture: Texture,
    /// Texture coordinates of each vertex.
    pub uvs: Vec<[f32; 2]>,
    /// Vertices of each triangle, all below `uvs.len()`.
    pub triangles: Vec<[u32; 3]>,
    /// How it is to be baked.
    pub options: BakeOptions,
    /// The files that were read: the job file, texture, texture coordinates and triangles.
    pub files: Vec<PathBuf>,
}

impl Job {
    /// What is to be baked.
    #[must_use]
    pub fn input(&self) -> BakeInput<'_> {
        BakeInput { texture: &self.texture, uvs: &self.uvs, triangles: &self.triangles }
    }
}

/// What is wrong with a job file, and where.
#[derive(Debug, thiserror::Error)]
#[error("{}: {field}{kind}", file.display(), field = Prefix(field))]
pub struct JobError {
    /// The job file.
    pub file: PathBuf,
    /// The field of the job file, such as `texture.path`; none if the whole file cannot be read.
    pub field: Option<&'static str>,
    /// What is wrong there.
    pub kind: JobErrorKind,
}

struct Prefix<'a>(&'a Option<&'static str>);

impl std::fmt::Display for Prefix<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.map_or(Ok(()), |field| write!(f, "{field}: "))
    }
}

/// What is wrong in a job file.
#[derive(Debug, thiserror::Error)]
pub enum JobErrorKind {
    /// The job file cannot be read.
    #[error("cannot read: {0}")]
    Read(#[source] io::Error),
    /// A file that the job names cannot be read.
    #[error("{}: cannot read: {source}", path.display())]
    ReadPart {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The job file is not the JSON that it should be.
    #[error("{0}")]
    Json(#[source] serde_json::Error),
    /// The name is empty.
    #[error("the name is empty")]
    EmptyName,
    /// The level is above 12.
    #[error(transparent)]
    Level(#[from] SubdivisionLevelError),
    /// A number is not finite, or not above 0 where it must be.
    #[error("{found} is not a finite number{}", if *positive { " above 0" } else { "" })]
    Number {
        /// The number found.
        found: f32,
        /// Whether it must be above 0.
        positive: bool,
    },
    /// A file's size is not the one that the job asks for.
    #[error("{}: the file has {found} bytes, but {required} are needed", path.display())]
    FileSize {
        /// The file.
        path: PathBuf,
        /// Its size in bytes.
        found: u64,
        /// The size needed.
        required: u64,
    },
    /// A file does not end with a whole item.
    #[error("{}: the file has {found} bytes, which is not a multiple of {item}", path.display())]
    PartialItem {
        /// The file.
        path: PathBuf,
        /// Its size in bytes.
        found: u64,
        /// Bytes of an item.
        item: u64,
    },
    /// A triangle names a vertex that does not exist.
    #[error(
        "{}: byte {offset}: vertex {found} of triangle {triangle} is out of range: there are {vertices} vertices",
        path.display()
    )]
    VertexIndex {
        /// The file of triangles.
        path: PathBuf,
        /// Offset of the index in it.
        offset: u64,
        /// Number of the triangle.
        triangle: usize,
        /// The index found.
        found: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// The texture is none.
    #[error(transparent)]
    Texture(#[from] TextureError),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct JobFile {
    name: String,
    texture: TextureFile,
    uvs: PathBuf,
    triangles: PathBuf,
    format: Format,
    max_level: u32,
    #[serde(default)]
    dynamic_subdivision_scale: Option<f32>,
    address_mode: AddressMode,
    filter: Filter,
    #[serde(default)]
    border_alpha: f32,
    alpha_cutoff: f32,
    unknown_state_promotion: UnknownStatePromotion,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TextureFile {
    path: PathBuf,
    width: u32,
    height: u32,
    format: TexelFormat,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum TexelFormat {
    Unorm8,
    Fp32,
}

#[derive(Clone, Copy, Deserialize)]
enum Format {
    #[serde(rename = "2-state")]
    TwoState,
    #[serde(rename = "4-state")]
    FourState,
}

/// Reads the job file at `path` and the files that it names.
///
/// # Errors
/// [`JobError`] names the file and the field that is missing, malformed or contradicts the size of a file.
pub fn read(path: &Path) -> Result<Job, JobError> {
    let fail = |field, kind| JobError { file: path.into(), field, kind };
    let bytes = files::read(path).map_err(|error| fail(None, JobErrorKind::Read(error)))?;
    let job: JobFile = serde_json::from_slice(&bytes).map_err(|error| fail(None, JobErrorKind::Json(error)))?;
    job.resolve(path).map_err(|(field, kind)| fail(Some(field), kind))
}

/// The field that is wrong, and what is wrong with it.
type FieldError = (&'static str, JobErrorKind);

impl JobFile {
    fn resolve(self, file: &Path) -> Result<Job, FieldError> {
        let folder = file.parent().unwrap_or(Path::new(""));
        let name = files::safe_name(&self.name);
        if name.is_empty() {
            return Err(("name", JobErrorKind::EmptyName));
        }
        let options = self.options()?;
        let texture = self.texture.read(folder)?;
        let uvs = pairs(&part(folder, &self.uvs, "uvs", Size::MultipleOf(8))?);
        let triangles = self.read_triangles(folder, uvs.len())?;
        let parts = [&self.texture.path, &self.uvs, &self.triangles].map(|part| folder.join(part));
        let files = std::iter::once(file.to_path_buf()).chain(parts).collect();
        Ok(Job { name, texture, uvs, triangles, options, files })
    }

    fn options(&self) -> Result<BakeOptions, FieldError> {
        let max = SubdivisionLevel::new(self.max_level).map_err(|error| ("max_level", error.into()))?;
        finite("border_alpha", self.border_alpha)?;
        finite("alpha_cutoff", self.alpha_cutoff)?;
        let level = match self.dynamic_subdivision_scale {
            None => LevelChoice::Uniform(max),
            Some(scale) if scale.is_finite() && scale > 0.0 => LevelChoice::Dynamic { scale, max },
            Some(found) => return Err(("dynamic_subdivision_scale", JobErrorKind::Number { found, positive: true })),
        };
        let format = match self.format {
            Format::TwoState => OpacityMicromapFormat::TwoState,
            Format::FourState => OpacityMicromapFormat::FourState,
        };
        Ok(BakeOptions {
            format,
            level,
            sampler: Sampler::new(self.address_mode, self.filter, self.border_alpha),
            alpha_cutoff: self.alpha_cutoff,
            promotion: self.unknown_state_promotion,
            ..BakeOptions::default()
        })
    }

    fn read_triangles(&self, folder: &Path, vertices: usize) -> Result<Vec<[u32; 3]>, FieldError> {
        const FIELD: &str = "triangles";
        let bytes = part(folder, &self.triangles, FIELD, Size::MultipleOf(12))?;
        let triangles: Vec<[u32; 3]> = bytes
            .as_chunks::<4>()
            .0
            .as_chunks::<3>()
            .0
            .iter()
            .map(|triangle| triangle.map(u32::from_le_bytes))
            .collect();
        let beyond = triangles.as_flattened().iter().position(|&index| index as usize >= vertices);
        match beyond {
            None => Ok(triangles),
            Some(position) => {
                let found = triangles.as_flattened().get(position).copied().unwrap_or_default();
                let path = folder.join(&self.triangles);
                let (offset, triangle) = (4 * position as u64, position / 3);
                Err((FIELD, JobErrorKind::VertexIndex { path, offset, triangle, found, vertices }))
            }
        }
    }
}

impl TextureFile {
    fn read(&self, folder: &Path) -> Result<Texture, FieldError> {
        let &Self { ref path, width, height, format } = self;
        // Sizes that make no texture are told before they are held against the file's.
        if width == 0 || height == 0 {
            return Err(("texture", TextureError::Empty { width, height }.into()));
        }
        if width > MAX_SIDE || height > MAX_SIDE {
            return Err(("texture", TextureError::TooLarge { width, height }.into()));
        }
        let texels = u64::from(width) * u64::from(height);
        let texture = match format {
            TexelFormat::Unorm8 => {
                Texture::unorm8(width, height, part(folder, path, "texture.path", Size::Exactly(texels))?)
            }
            TexelFormat::Fp32 => {
                let bytes = part(folder, path, "texture.path", Size::Exactly(4 * texels))?;
                Texture::fp32(width, height, bytes.as_chunks().0.iter().copied().map(f32::from_le_bytes).collect())
            }
        };
        texture.map_err(|error| ("texture.path", error.into()))
    }
}

fn finite(field: &'static str, found: f32) -> Result<(), FieldError> {
    if found.is_finite() { Ok(()) } else { Err((field, JobErrorKind::Number { found, positive: false })) }
}

fn pairs(bytes: &[u8]) -> Vec<[f32; 2]> {
    bytes.as_chunks::<4>().0.as_chunks::<2>().0.iter().map(|pair| pair.map(f32::from_le_bytes)).collect()
}

/// What size a file must have.
#[derive(Clone, Copy)]
enum Size {
    Exactly(u64),
    MultipleOf(u64),
}

/// The bytes of a file that the job names in `field`. Its size is held against `size` before anything is read.
fn part(folder: &Path, path: &Path, field: &'static str, size: Size) -> Result<Vec<u8>, FieldError> {
    let path = folder.join(path);
    let fail = |source| (field, JobErrorKind::ReadPart { path: path.clone(), source });
    let (mut file, found) = files::open(&path).map_err(fail)?;
    match size {
        Size::Exactly(required) if found != required => {
            return Err((field, JobErrorKind::FileSize { path, found, required }));
        }
        Size::MultipleOf(item) if !found.is_multiple_of(item) => {
            return Err((field, JobErrorKind::PartialItem { path, found, item }));
        }
        Size::Exactly(_) | Size::MultipleOf(_) => {}
    }
    let mut bytes = Vec::new();
    file.by_ref().take(found).read_to_end(&mut bytes).map_err(fail)?;
    // The file may have shrunk since.
    if bytes.len() as u64 != found {
        let (required, found) = (found, bytes.len() as u64);
        return Err((field, JobErrorKind::FileSize { path, found, required }));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests;
