//! The conservative baker: alpha textures and texture coordinates to opacity micromaps.
//!
//! For each triangle of a mesh the baker decides, microtriangle by microtriangle, whether an alpha test would pass on all of it, on
//! none of it, or on a part: *opaque*, *transparent* or *unknown*. It is **sound and complete**. A state is known exactly if real
//! arithmetic on the `f32` texture coordinates says so: [`classify()`] computes in `f64` where an error bound leaves no doubt, and
//! in integers elsewhere, ties included.
//!
//! | room | holds |
//! |---|---|
//! | [`texture`], [`sampler`], [`surface`] | what the shader sees: texels, filter and address mode, and both with a cutoff |
//! | [`texel_triangle`] | a triangle's texture coordinates in texels, rounded and exact |
//! | [`classify`](mod@classify) | the decision for one microtriangle, and the proof of its error bounds |
//! | [`level`], [`promotion`] | how finely a triangle is split; which unknown state a mixed microtriangle gets |
//! | `job`, `gltf`, `image`, `picture` | with the feature `files`: what is baked, from files; pictures of what was baked |
//! | [`input`], [`mip`] | texture coordinates and triangles as buffers hold them; which mips are read |
//! | [`bake`](mod@bake), [`options`], [`statistics`], [`error`] | everything for a mesh: array, triangles, index buffer, histograms, counts |
//! | [`order`], [`coverage`](mod@coverage) | in which order blocks lie; what needs no shader, triangle by triangle |
//! | [`dry_run`](mod@dry_run), [`downsample`](mod@downsample) | what a bake would make; lower levels from what was baked |
//!
//! # Example
//!
//! A texture whose right half is opaque, on one triangle that covers its lower left half:
//!
//! ```
//! use omm_bake::{BakeInput, BakeOptions, LevelChoice, Texture, bake};
//! use omm_model::level::SubdivisionLevel;
//! use omm_model::opacity::OpacityState;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let texture = Texture::unorm8(4, 1, vec![0, 0, 255, 255])?;
//! let input = BakeInput {
//!     texture: &texture,
//!     uvs: &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
//!     triangles: &[[0, 1, 2]],
//! };
//! let level = SubdivisionLevel::new(2)?;
//! let mut options = BakeOptions { level: LevelChoice::Uniform(level), ..BakeOptions::default() };
//! options.sampler.address_mode_u = omm_bake::AddressMode::Clamp;
//!
//! let output = bake(&input, &options, &|_progress| {})?;
//! assert_eq!(output.indices, [0]);
//! let states: String = (0..level.microtriangles().into())
//!     .filter_map(|index| options.format.state(&output.array, index))
//!     .map(OpacityState::letter)
//!     .collect();
//! // Alpha is exactly 0.5 in the middle, which is not above the cutoff: what touches it from the right is mixed.
//! assert_eq!(states, "TTTTTTTTUUOUTTTT");
//! # Ok(())
//! # }
//! ```

pub mod bake;
mod block;
mod budget;
pub mod classify;
mod collect;
pub mod coverage;
pub mod downsample;
pub mod dry_run;
pub mod error;
mod exact;
#[cfg(feature = "files")]
mod files;
#[cfg(feature = "files")]
pub mod gltf;
#[cfg(feature = "files")]
pub mod image;
pub mod input;
#[cfg(feature = "files")]
pub mod job;
mod layers;
pub mod level;
mod lowering;
mod merge;
pub mod mip;
mod near;
pub mod options;
pub mod order;
mod packed;
mod patch;
#[cfg(feature = "files")]
pub mod picture;
mod planes;
pub mod promotion;
pub mod sampler;
mod schedule;
pub mod statistics;
pub mod surface;
pub mod texel_triangle;
pub mod texture;
mod window;

pub use bake::{BakeOutput, Progress, ProgressAnswer, WorkEstimate, bake, estimate};
pub use classify::{Classification, classify};
pub use coverage::{Coverage, coverage};
pub use downsample::downsample;
pub use dry_run::{DryRun, dry_run};
pub use error::BakeError;
pub use input::{IndexFormat, UvFormat};
pub use level::LevelChoice;
pub use mip::MipChoice;
pub use options::{BakeInput, BakeOptions, CutoffStates, TriangleOverride};
pub use order::BlockOrder;
pub use promotion::UnknownStatePromotion;
pub use sampler::{AddressMode, Filter, Sampler};
pub use statistics::{BakeStatistics, StateCounts};
pub use surface::{Surface, SurfaceError};
pub use texel_triangle::{TexelTriangle, TexelTriangleError};
pub use texture::{Texture, TextureError};
