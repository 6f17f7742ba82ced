//! A scene: a top-level structure and all that it refers to, read once and made ready for rays.

use omm_model::curve::TieBreak;
use omm_model::memory::MemoryView;
use omm_model::vk::{DeviceAddress, GeometryInstanceFlags};

use crate::bvh::{Bounds, Bvh, Node, Planes};
use crate::error::LoadError;
use crate::opacity::{Micromap, TriangleOpacity};
use crate::placement::Placement;
use crate::transform::WorldToObject;
use crate::triangle::Packet;

mod load;
mod reference;

/// All that rays can hit: the instances of a top-level structure, their bottom-level structures, and the micromaps
/// of these.
///
/// It is a copy: later changes of memory do not reach it. It can be traced from several threads at once.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    pub(crate) instances: Vec<Instance>,
    pub(crate) blases: Vec<Blas>,
    pub(crate) micromaps: Vec<Micromap>,
    /// Parts of all instances: those with a box in the order of the leaves of `bvh`, then the others.
    pub(crate) references: Vec<Reference>,
    /// Over `references[..boxed]`.
    pub(crate) bvh: Bvh,
    pub(crate) boxed: usize,
    /// Where each instance lies, in the order of `instances`.
    pub(crate) placements: Vec<Placement>,
    /// For each instance of the top-level structure its position in `instances`; `u32::MAX` if no ray can reach it.
    pub(crate) slots: Vec<u32>,
    pub(crate) tie_break: TieBreak,
    bounds: Option<Bounds>,
}

/// An active instance that rays can reach.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instance {
    /// At all times; `None` if the instance moves.
    pub(crate) to_object: Option<WorldToObject>,
    pub(crate) blas: u32,
    pub(crate) instance_id: u32,
    pub(crate) custom_index: u32,
    pub(crate) sbt_record_offset: u32,
    pub(crate) mask: u8,
    pub(crate) flags: GeometryInstanceFlags,
}

/// A part of an instance: a node of one of the trees of its bottom-level structure, and all below it.
///
/// Each instance has its own few nodes in the hierarchy of the scene, so that rays pass over most of what overlaps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reference {
    pub(crate) instance: u32,
    pub(crate) primitives: Primitives,
    pub(crate) node: Node,
}

/// What lies below a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Primitives {
    Triangles,
    Aabbs,
}

/// A bottom-level structure.
#[derive(Clone, Debug, Default)]
pub(crate) struct Blas {
    pub(crate) geometries: Vec<Geometry>,
    /// In the order of the slots of `triangle_bvh`.
    pub(crate) triangles: Vec<Triangle>,
    /// The vertices at time 1 of each of them; empty if none of them moves.
    pub(crate) ends: Vec<[[f32; 3]; 3]>,
    /// The vertices of the triangles in each leaf; empty if any moves.
    pub(crate) packets: Vec<Packet>,
    /// No coordinate of a triangle is larger.
    pub(crate) largest: f64,
    pub(crate) triangle_bvh: Bvh,
    /// In the order of the slots of `aabb_bvh`.
    pub(crate) aabbs: Vec<Aabb>,
    /// In the unit of `triangle_bvh`.
    pub(crate) aabb_bvh: Bvh,
    bounds: Option<Bounds>,
}

/// What the primitives of a geometry have in common.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Geometry {
    pub(crate) opaque: bool,
    /// The micromap's position in the scene; `None` if there is none or it is null.
    pub(crate) micromap: Option<u32>,
}

/// An active triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    /// At time 0, if they move.
    pub(crate) vertices: [[f32; 3]; 3],
    pub(crate) geometry: u32,
    pub(crate) primitive: u32,
    pub(crate) opacity: TriangleOpacity,
}

/// An active box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aabb {
    pub(crate) min: [f32; 3],
    pub(crate) max: [f32; 3],
    pub(crate) planes: Planes,
    pub(crate) geometry: u32,
    pub(crate) primitive: u32,
}

impl Scene {
    /// Reads the top-level structure at `tlas` and whatever it refers to, and builds hierarchies over it.
    ///
    /// Each bottom-level structure and each micromap is read once, however often it is referred to. What no ray can
    /// hit is left out: instances without a bottom-level structure, with an empty one, or with a transform that has
    /// no inverse (a matrix that is not finite, or whose determinant `f64` cannot tell from zero; one that moves is only
    /// left out at the times when it has none); inactive primitives; triangles with a vertex that is not finite, at time
    /// 0 or 1; boxes with a NaN or with a lower end above the upper one.
    ///
    /// # Errors
    /// The first object that cannot be read, is not of the kind wanted, lies in the bytes of another, or
    /// contradicts another; with the way to it. What is allocated is a small multiple of the bytes read, and some 20
    /// megabytes at most for a hierarchy that tells overlapping instances apart.
    pub fn load(view: &dyn MemoryView, tlas: DeviceAddress) -> Result<Self, LoadError> {
        load::load(view, tlas)
    }

    /// The same scene on a device that breaks ties between microtriangles in another way than
    /// [`TieBreak::Reference`]; see [`DeviceProfile::micromap_tie_break`](omm_model::profile::DeviceProfile).
    #[must_use]
    pub fn with_tie_break(self, tie_break: TieBreak) -> Self {
        Self { tie_break, ..self }
    }

    /// Instances that rays can reach.
    #[must_use]
    pub fn instance_count(&self) -> usize {
        self.instances.len()
    }

    /// Triangles that rays can reach, those of every instance counted.
    #[must_use]
    pub fn triangle_count(&self) -> u64 {
        let blases = self.instances.iter().filter_map(|instance| self.blases.get(instance.blas as usize));
        blases.map(|blas| blas.triangles.len() as u64).sum()
    }

    /// Lowest and highest coordinates of all that rays can reach, a little grown; `None` if there is nothing, or if
    /// an instance's transform is too ill-conditioned to say or changes too much with time.
    #[must_use]
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        self.bounds.map(|bounds| [bounds.low, bounds.high])
    }
}
