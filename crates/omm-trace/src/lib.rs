//! Ray traversal over what the simulated device built.
//!
//! [`Scene::load`] reads a top-level acceleration structure and all that it refers to out of memory, in the packed
//! form of [`omm_layout::object`]. Rays are followed through it as the chapter *Ray Traversal* describes:
//! [`Scene::trace`] calls [`Shaders`] where a pipeline would, and a [`RayQuery`] stops where a ray query would. Both
//! add up in [`Counters`] what happened.
//!
//! | room | holds |
//! |---|---|
//! | [`ray`], [`flags`] | the operands of a trace instruction, hit groups |
//! | [`scene`], [`error`] | loading, and why it fails |
//! | [`shader`], [`hit`] | any-hit and intersection shaders, and what they see |
//! | [`query`] | ray queries and their states |
//! | [`space`] | how an instance lies in the scene: matrices, and the ray in its space |
//! | [`counters`] | what traversal did, in numbers |
//!
//! # What shaders read
//!
//! | built-in | here |
//! |---|---|
//! | `InstanceId`, `InstanceCustomIndexKHR`, `RayGeometryIndexKHR`, `PrimitiveId`, `HitKindKHR`, barycentrics | [`Candidate`], [`Hit`] |
//! | `RayTmaxKHR` | [`Candidate::t`]; [`AabbCandidate::t_max`] in an intersection shader; [`Ray::t_max`] in a miss shader |
//! | `RayTminKHR`, `WorldRayOriginKHR`, `WorldRayDirectionKHR`, `CurrentRayTimeNV` | [`Ray`] |
//! | `IncomingRayFlagsKHR`, `CullMaskKHR` | [`TraceOptions`] |
//! | `ObjectRayOriginKHR`, `ObjectRayDirectionKHR`, `ObjectToWorldKHR`, `WorldToObjectKHR` | [`Scene::object_space`] |
//! | `HitTriangleVertexPositionsKHR` | [`Scene::triangle_vertices`] |
//! | which shader runs | [`TraceOptions::hit_group`], [`TraceOptions::last_shader`] |
//!
//! Closest-hit and miss shaders are the caller's, and so is recursion: a shader that traces calls [`Scene::trace`] again.
//!
//! # What is guaranteed
//!
//! - **Watertight within an instance.** A ray becomes a ray of the instance once, in `f64`, and all its triangles
//!   see that same ray. A vertex is projected by a function of its position and the ray alone, and which side of an
//!   edge the ray passes is decided exactly for the projected points. So where triangles share an edge or surround
//!   a vertex, a ray through it hits exactly one of those that lie on different sides: none is lost and none is
//!   counted twice. A ray along the open border of a mesh hits or misses, but always the same way. Between
//!   instances nothing is promised.
//! - **The hierarchy loses nothing.** The candidates are those that trying every primitive would give, whatever the
//!   transforms, directions and times: boxes are tested with more room than all rounding needs.
//! - **The closest hit is one.** It does not depend on the hierarchy; at equal `t` the lowest instance, geometry
//!   and primitive wins. `t` and barycentrics are computed in `f64` and rounded to `f32` once, and ranges compare
//!   the rounded `t`: open at both ends for triangles, closed for AABBs.
//! - **Facing** is judged in the instance's space by the winding: a mirroring transform does not change it. By
//!   default the front is where vertices run counterclockwise in a right-handed system (clockwise in a left-handed
//!   one).
//! - **Motion.** At the time of the ray every element of two matrices, or every component of two SRT transforms, is
//!   interpolated linearly in `f64`; the transform of the latter is translation · rotation · scale, after the
//!   quaternion was normalised. Vertices are interpolated in `f64` and rounded to `f32`, so what moves is as
//!   watertight as what does not.
//! - Degenerate triangles, triangles seen edge-on, inactive primitives and instances, and instances whose transform
//!   has no inverse (at the time of the ray, if they move) are never hit.
//! - A pipeline and a ray query whose callers answer alike see the same candidates in the same order and find the same
//!   hit.
//!
//! # Example
//!
//! A triangle whose micromap is opaque at one corner only.
//!
//! ```
//! use omm_layout::object::*;
//! use omm_model::format::OpacityMicromapFormat;
//! use omm_model::level::SubdivisionLevel;
//! use omm_model::memory::MemoryRange;
//! use omm_model::special_index::TriangleMap;
//! use omm_model::vk::{DeviceAddress, GeometryFlags, Instance, TransformMatrix};
//! use omm_trace::{Counters, NoShaders, Ray, Scene, TraceOptions};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // What a device would have built: micromap, bottom and top level, at addresses of our choice.
//! let (level, format) = (SubdivisionLevel::new(1)?, OpacityMicromapFormat::TwoState);
//! let corner = MicromapTriangleData { subdivision_level: level, format, data: &[0b0001] };
//! let micromap = MicromapContents { flags: 0, triangles: vec![corner] }.encode()?;
//! let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
//! let triangles = vec![Some(MappedTriangle { vertices, map: TriangleMap::Triangle(0) })];
//! let primitives = BlasPrimitives::MicromapTriangles { micromap: 0x1000, triangles };
//! let geometry = BlasGeometry { flags: GeometryFlags::empty(), primitives };
//! let blas = BlasContents { flags: 0, geometries: vec![geometry] }.encode()?;
//! let instance = Instance {
//!     transform: TransformMatrix::IDENTITY,
//!     mask: 0xff,
//!     acceleration_structure_reference: 0x2000,
//!     ..Instance::default()
//! };
//! let tlas = TlasContents { flags: 0, instances: vec![instance] }.encode()?;
//! let mut bytes = vec![0; 0x3000];
//! for (at, object) in [(0, micromap), (0x1000, blas), (0x2000, tlas)] {
//!     bytes[at..at + object.len()].copy_from_slice(&object);
//! }
//! let memory = MemoryRange { address: DeviceAddress(0x1000), bytes: &bytes };
//!
//! let scene = Scene::load(&memory, DeviceAddress(0x3000))?;
//! let mut counters = Counters::default();
//! let mut hit = |x, y| -> Result<_, Box<dyn std::error::Error>> {
//!     let ray = Ray::unbounded([x, y, 1.0], [0.0, 0.0, -1.0])?;
//!     Ok(scene.trace(&ray, &TraceOptions::default(), &mut NoShaders, &mut counters))
//! };
//! assert!(hit(0.2, 0.2)?.is_some_and(|hit| hit.opaque && hit.barycentrics == [0.2, 0.2]));
//! assert_eq!(hit(0.6, 0.2)?, None);
//! assert_eq!((counters.candidates, counters.opaque, counters.ignored), (2, 1, 1));
//! # Ok(())
//! # }
//! ```

pub mod counters;
pub mod error;
pub mod flags;
pub mod hit;
pub mod query;
pub mod ray;
pub mod scene;
pub mod shader;
pub mod space;

mod bvh;
mod opacity;
mod pipeline;
mod placement;
mod transform;
mod traverse;
mod triangle;

pub use counters::Counters;
pub use error::{LoadError, LoadErrorKind, ObjectPath};
pub use flags::RayFlags;
pub use hit::{Candidate, Hit, HitKind};
pub use query::{QueryError, RayQuery};
pub use ray::{LastShader, Ray, RayError, TraceOptions};
pub use scene::Scene;
pub use shader::{AabbCandidate, AnyHit, NoShaders, ReportedHit, Shaders};
pub use space::ObjectSpace;
