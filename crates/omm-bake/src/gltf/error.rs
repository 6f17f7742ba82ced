//! What can be wrong with a glTF file.

use std::io;
use std::path::{Path, PathBuf};

use gltf::json;

use crate::texture::TextureError;

/// What is wrong with a glTF file, and where.
#[derive(Debug, thiserror::Error)]
#[error("{}: {at}{}{kind}", file.display(), if at.is_empty() { "" } else { ": " })]
pub struct GltfError {
    /// The glTF file, or a file beside it that it names.
    pub file: PathBuf,
    /// The place in the file: `byte 12`, or a path such as `meshes[0].primitives[1].attributes.TEXCOORD_0`. Empty if the
    /// whole file cannot be read.
    pub at: String,
    /// What is wrong there.
    pub kind: GltfErrorKind,
}

impl GltfError {
    pub(super) fn new(file: &Path, at: impl Into<String>, kind: GltfErrorKind) -> Self {
        Self { file: file.into(), at: at.into(), kind }
    }
}

/// What is wrong in a glTF file.
#[derive(Debug, thiserror::Error)]
pub enum GltfErrorKind {
    /// A file cannot be read.
    #[error("cannot read: {0}")]
    Read(#[source] io::Error),
    /// The binary container has a version other than 2.
    #[error("version {found} of the binary container; only version 2 is known")]
    Version {
        /// The version found.
        found: u32,
    },
    /// The binary container or a chunk of it ends early, or later than it says.
    #[error("{claimed} bytes are claimed, {found} are there")]
    Length {
        /// Bytes that the header claims.
        claimed: u64,
        /// Bytes up to the end of the file, or of the container.
        found: u64,
    },
    /// The first chunk of the binary container is not JSON.
    #[error("the first chunk has type {found:02x?}, which is not \"JSON\"")]
    FirstChunk {
        /// The type found.
        found: [u8; 4],
    },
    /// The JSON is not that of a glTF file.
    #[error("{0}")]
    Json(#[source] json::Error),
    /// The file needs an extension that changes what is read and that is not known here.
    #[error("extension {name:?} is required, but not known")]
    Extension {
        /// The extension's name.
        name: String,
    },
    /// No primitive has a material whose `alphaMode` is `MASK`.
    #[error("no primitive has a material with alphaMode MASK, so there is nothing to bake")]
    NothingToBake,
    /// The scene places no triangles.
    #[error("the scene places no triangles, so there is nothing to show")]
    NothingToShow,
    /// A node is in the tree of nodes twice.
    #[error("the node is its own ancestor, or has several parents")]
    NodeTwice,
    /// A node's transform leaves the numbers.
    #[error("the transform of the node is not finite")]
    Transform,
    /// The vertices have no positions.
    #[error("the primitive has no POSITION")]
    NoPositions,
    /// An index points past the end of an array of the file.
    #[error("index {index} is out of range: there are {count}")]
    Index {
        /// The index found.
        index: usize,
        /// Number of items.
        count: usize,
    },
    /// A value is none that glTF allows there.
    #[error("not a value that glTF allows here")]
    Value,
    /// A number is NaN or infinite.
    #[error("{found} is not a finite number")]
    NotFinite {
        /// The number found.
        found: f32,
    },
    /// A number lies outside the range that glTF gives it.
    #[error("{found} is outside {least}..={most}")]
    Range {
        /// The number found.
        found: f32,
        /// Least number allowed.
        least: f32,
        /// Greatest number allowed.
        most: f32,
    },
    /// A `uri` is not one that is followed.
    #[error("uri {uri:?}: {why}")]
    Uri {
        /// The URI, shortened.
        uri: String,
        /// Why it is not followed.
        why: &'static str,
    },
    /// A buffer has no data: it has no `uri` and the file no binary chunk for it.
    #[error("the buffer has no uri and there is no binary chunk for it")]
    NoData,
    /// A range of bytes leaves the buffer or buffer view that it lies in.
    #[error("bytes {start}..{end} leave the {available} bytes of the {of}")]
    OutOfRange {
        /// First byte.
        start: u64,
        /// One past the last byte.
        end: u64,
        /// Bytes available.
        available: u64,
        /// What holds the bytes: `buffer` or `buffer view`.
        of: &'static str,
    },
    /// An accessor holds elements of a kind that cannot stand there.
    #[error("elements of {found} cannot stand here: {required} are needed")]
    AccessorType {
        /// Type and component type found.
        found: String,
        /// What is needed.
        required: &'static str,
    },
    /// A sparse accessor without a buffer view claims more elements than the whole input has bytes.
    #[error("{count} elements are claimed without a buffer view")]
    Unbacked {
        /// Elements claimed.
        count: u64,
    },
    /// A vertex index points past the vertices.
    #[error("index {position} is {found}, but there are {vertices} vertices")]
    VertexIndex {
        /// Position of the index.
        position: usize,
        /// The index found.
        found: u32,
        /// Vertices of the primitive.
        vertices: usize,
    },
    /// The primitive has no triangles.
    #[error("mode {mode} does not make triangles")]
    Mode {
        /// The mode's name.
        mode: String,
    },
    /// The number of vertices does not make triangles.
    #[error("{count} vertices do not make triangles")]
    VertexCount {
        /// Number of vertices or indices.
        count: usize,
    },
    /// The set of texture coordinates that the texture asks for is absent.
    #[error("the primitive has no TEXCOORD_{set}, which its base colour texture reads")]
    NoTextureCoordinates {
        /// Number of the set.
        set: u32,
    },
    /// The vertices carry an alpha of their own.
    #[error("vertex {vertex} has alpha {found} in COLOR_0: alpha that varies over the mesh cannot be baked exactly")]
    VertexAlpha {
        /// The first vertex whose alpha is not 1.
        vertex: usize,
        /// Its alpha.
        found: f32,
    },
    /// A masked material has no base colour texture, so there is no alpha to bake.
    #[error("alphaMode is MASK, but there is no baseColorTexture to bake")]
    NoTexture,
    /// A texture names no image that is known.
    #[error("the texture names no PNG or JPEG image")]
    NoImage,
    /// The image is neither PNG nor JPEG.
    #[error("neither a PNG nor a JPEG image: it starts with {start:02x?}")]
    ImageFormat {
        /// Its first bytes.
        start: Vec<u8>,
    },
    /// The image claims more pixels than its data can hold.
    #[error("{width} x {height} pixels are claimed, more than {bytes} bytes can hold")]
    ImageSize {
        /// Width claimed.
        width: u32,
        /// Height claimed.
        height: u32,
        /// Bytes of the image file.
        bytes: usize,
    },
    /// The image cannot be decoded.
    #[error("{0}")]
    Image(#[source] image::ImageError),
    /// The image does not make a texture.
    #[error(transparent)]
    Texture(#[from] TextureError),
}
