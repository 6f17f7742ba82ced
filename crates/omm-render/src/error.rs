//! Why there is no picture.

use omm_bake::gltf::GltfError;
use omm_bake::{BakeError, SurfaceError, TextureError};
use omm_device::app::AppError;
use omm_trace::{LoadError, RayError};

use crate::camera::CameraError;

/// Why a scene cannot be made, baked, built or traced.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// A glTF file or a file that it names is bad.
    #[error(transparent)]
    Gltf(#[from] GltfError),
    /// The file has no such camera.
    #[error("there is no camera {wanted:?}; there are: {}", if known.is_empty() { "none" } else { known })]
    NoCamera {
        /// The name or number that was asked for.
        wanted: String,
        /// Those that a node places.
        known: String,
    },
    /// A texture has no size or a texel that is no number.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// The camera can see nothing.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The baker refuses a part.
    #[error("mesh {mesh}, part {part}: {source}")]
    Bake {
        /// The mesh.
        mesh: usize,
        /// The part of the mesh.
        part: usize,
        /// What the baker says.
        source: BakeError,
    },
    /// A cutout has a cutoff or a border that nothing can be compared with.
    #[error("mesh {mesh}, part {part}: {source}")]
    Surface {
        /// The mesh.
        mesh: usize,
        /// The part of the mesh.
        part: usize,
        /// What is wrong.
        source: SurfaceError,
    },
    /// More meshes than a custom index can count, which has 24 bits.
    #[error("{found} meshes are more than an instance's custom index can tell apart")]
    Meshes {
        /// How many there are.
        found: usize,
    },
    /// The simulated device could not build.
    #[error(transparent)]
    Build(#[from] AppError),
    /// What was built cannot be traced.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// The camera or the sun gives no ray.
    #[error(transparent)]
    Ray(#[from] RayError),
}
