//! What is to be seen: meshes with what covers them, where they stand, and who looks.

use image::RgbImage;
use omm_bake::{Sampler, Texture};

use crate::camera::Camera;

/// A scene. Indices that lead nowhere show nothing: a mesh that is not there is not placed, a texture that is not there is white.
#[derive(Clone, Debug)]
pub struct RenderScene {
    /// The alpha that [`Cutout::alpha`] counts.
    pub alphas: Vec<Texture>,
    /// The colours that [`Paint::Image`] counts.
    pub colours: Vec<RgbImage>,
    /// The meshes that [`Placement::mesh`] counts. Each becomes a bottom-level structure, each of its parts a geometry.
    pub meshes: Vec<Mesh>,
    /// Where the meshes stand.
    pub placements: Vec<Placement>,
    /// Who looks.
    pub camera: Camera,
    /// Towards the sun; not zero.
    pub sun: [f32; 3],
}

/// Parts that are placed together.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// The parts.
    pub parts: Vec<Part>,
}

/// Triangles of one material.
#[derive(Clone, Debug)]
pub struct Part {
    /// Vertices.
    pub positions: Vec<[f32; 3]>,
    /// Texture coordinates of the vertices; may be empty if neither paint nor cutout needs any.
    pub uvs: Vec<[f32; 2]>,
    /// Three vertices each.
    pub triangles: Vec<[u32; 3]>,
    /// Its colour.
    pub paint: Paint,
    /// Where it is to be seen through; `None` if it is opaque.
    pub cutout: Option<Cutout>,
}

/// An alpha test.
#[derive(Clone, Copy, Debug)]
pub struct Cutout {
    /// Index into [`RenderScene::alphas`].
    pub alpha: usize,
    /// How the alpha is read.
    pub sampler: Sampler,
    /// Opaque is alpha above this.
    pub alpha_cutoff: f32,
}

/// A colour rule. Colours are sRGB, 0 to 255.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Paint {
    /// One colour.
    Plain([f32; 3]),
    /// The nearest texel of an image.
    Image {
        /// Index into [`RenderScene::colours`].
        colour: usize,
        /// How coordinates outside of the image are read.
        sampler: Sampler,
        /// What each channel is multiplied with.
        factor: [f32; 3],
    },
    /// Greens that grow lighter with the second texture coordinate's distance from 1 and differ from plant to plant.
    Frond {
        /// How many triangles after each other are one plant; all are if 0.
        plant: u32,
    },
    /// Brown in rings around the vertical axis of the world.
    Earth,
}

/// Where a mesh stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Index into [`RenderScene::meshes`].
    pub mesh: usize,
    /// From the mesh's space to the world's: three rows, the translation last.
    pub transform: [[f32; 4]; 3],
}

impl Mesh {
    /// Triangles of all parts.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.parts.iter().map(|part| part.triangles.len()).sum()
    }
}

impl Placement {
    /// The transform that changes nothing.
    pub const IDENTITY: [[f32; 4]; 3] = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

    /// A point of the mesh in the world.
    #[must_use]
    pub fn apply(&self, point: [f32; 3]) -> [f64; 3] {
        let [x, y, z] = point.map(f64::from);
        self.transform.map(|row| {
            let [a, b, c, d] = row.map(f64::from);
            a * x + b * y + c * z + d
        })
    }
}

impl RenderScene {
    /// The placements of meshes that have triangles, in order: those become instances.
    pub fn placed(&self) -> impl Iterator<Item = &Placement> {
        self.placements.iter().filter(|at| self.meshes.get(at.mesh).is_some_and(|mesh| mesh.triangles() > 0))
    }
}
