//! Pictures of scenes, traced with and without opacity micromaps.
//!
//! A [`RenderScene`] is meshes, materials, places and a camera; [`garden::garden`] makes one from nothing. [`Baked`] is what the baker
//! makes of its cutouts, [`Built`] what a simulated device builds of both, and a [`Tracer`] takes [`Picture`]s of that: one ray from
//! the camera and one towards the sun for each sample. With micromaps or without, the picture is the same; the number of any-hit calls
//! is not.
//!
//! | room | holds |
//! |---|---|
//! | [`scene`], [`camera`] | what is to be seen |
//! | [`garden`], [`gltf`] | a scene that needs no file, scenes from files |
//! | [`build`] | baking, and building on a device |
//! | [`trace`] | rays and shaders |
//! | [`paper`] | pictures to look at |
//!
//! # Example
//!
//! ```
//! use omm_bake::BakeOptions;
//! use omm_device::Device;
//! use omm_device::app::App;
//! use omm_model::profile::DeviceProfile;
//! use omm_render::{Baked, Built, PictureOptions, Tracer, garden};
//! use omm_trace::Scene;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = garden::garden()?;
//! let baked = Baked::new(&scene, &BakeOptions::default(), &|_, _| {})?;
//! let mut device = Device::new(DeviceProfile::reference());
//! let built = Built::new(&mut App::new(&mut device, &mut ()), &scene, &baked)?;
//!
//! let options = PictureOptions { size: [32, 18], samples: 1, seed: 0 };
//! let mut pictures = Vec::new();
//! for structure in [built.without, built.with] {
//!     let rays = Scene::load(&device, structure.address)?;
//!     pictures.push(Tracer::new(&rays, &scene)?.picture(&options, &|_, _| {})?);
//! }
//! assert_eq!(pictures[0].colours, pictures[1].colours);
//! assert!(pictures[1].counters.any_hit_calls * 2 < pictures[0].counters.any_hit_calls);
//! # Ok(())
//! # }
//! ```

pub mod build;
pub mod camera;
pub mod error;
pub mod garden;
pub mod gltf;
pub mod paper;
pub mod scene;
pub mod trace;

mod heat;
mod random;
mod vector;

pub use build::{Baked, Built};
pub use camera::{Camera, CameraError};
pub use error::RenderError;
pub use paper::Mode;
pub use scene::{Cutout, Mesh, Paint, Part, Placement, RenderScene};
pub use trace::{OpacitySource, Picture, PictureOptions, Tracer};
