//! Parts of instances, each with a box of its own in the scene.
//!
//! Where instances overlap, as plants do, a ray would enter many of them for nothing if each were one box. So the
//! trees of a bottom-level structure are cut into parts, and the scene's tree is built over the parts of all instances.
//! The box of a part is what [`Placement::bounds`] says of the primitives in it: the box that an instance of these
//! alone would have, so that what it guarantees does not change.

use super::{Blas, Primitives, Reference, Scene};
use crate::bvh::{Bounds, Bvh, Part, unit};
use crate::error::LoadErrorKind;
use crate::placement::Placement;

/// Parts of a tree, at most.
const MOST: usize = 64;
/// Parts of a tree that are allowed however many instances there are.
const FEWEST: usize = 4;
/// References beyond which there are fewer parts.
const MANY: usize = 1 << 16;
/// A box that is turned grows. Parts of no more triangles than this get one around their vertices instead.
const FEW_TRIANGLES: usize = 8;

/// A part of a bottom-level structure.
struct Placed {
    primitives: Primitives,
    part: Part,
    /// Together they hold all that is in the part.
    boxes: Vec<Bounds>,
}

impl Scene {
    /// Refers to all instances and builds the tree over the references.
    pub(super) fn refer(&mut self) -> Result<(), LoadErrorKind> {
        let count = (MANY / self.instances.len().max(1)).clamp(FEWEST, MOST);
        let parts: Vec<_> = self.blases.iter().map(|blas| blas.parts(count)).collect();
        let (mut boxes, mut boxed, mut unboxed) = (Vec::new(), Vec::new(), Vec::new());
        for (instance, (reachable, placement)) in (0..).zip(self.instances.iter().zip(&self.placements)) {
            let Some(parts) = parts.get(reachable.blas as usize) else { continue };
            let reference = |part: &Placed| Reference { instance, primitives: part.primitives, node: part.part.node };
            match parts.iter().map(|part| part.bounds(placement)).collect::<Option<Vec<_>>>() {
                Some(bounds) if placement.is_well_conditioned() => {
                    boxes.extend(bounds);
                    boxed.extend(parts.iter().map(reference));
                }
                _ => unboxed.extend(parts.iter().map(reference)),
            }
        }
        let found = boxes.len() as u64;
        self.bvh = Bvh::build(&boxes, 1, unit(&boxes)).ok_or(LoadErrorKind::TooMany { found })?;
        self.references = self.bvh.in_order(&boxed);
        self.boxed = self.references.len();
        self.references.append(&mut unboxed);
        Ok(())
    }
}

impl Placed {
    /// A box around all places that the part can be in.
    fn bounds(&self, placement: &Placement) -> Option<Bounds> {
        let placed = self.boxes.iter().map(|of| placement.bounds(of));
        placed.reduce(|a, b| Some(a?.union(b?))).flatten()
    }
}

impl Blas {
    /// All parts, at most `count` of each tree.
    fn parts(&self, count: usize) -> Vec<Placed> {
        let triangles = self.triangle_bvh.cut(count).into_iter().map(|part| {
            let corners: Vec<_> = part.slots.clone().flat_map(|slot| self.corners(slot)).collect();
            let boxes = if part.slots.len() <= FEW_TRIANGLES {
                corners.into_iter().filter_map(|corner| Bounds::around([corner])).collect()
            } else {
                Vec::from_iter(Bounds::around(corners))
            };
            Placed { primitives: Primitives::Triangles, part, boxes }
        });
        let aabbs = self.aabb_bvh.cut(count).into_iter().map(|part| {
            let ends =
                self.aabbs.get(part.slots.clone()).unwrap_or_default().iter().flat_map(|aabb| [aabb.min, aabb.max]);
            let boxes = Vec::from_iter(Bounds::around(ends.map(|end| end.map(f64::from))));
            Placed { primitives: Primitives::Aabbs, part, boxes }
        });
        triangles.chain(aabbs).collect()
    }

    /// The vertices of a triangle, at both times if it moves. What moves stays between them, placed or not: a box around
    /// the places of each is one around all.
    fn corners(&self, slot: usize) -> impl Iterator<Item = [f64; 3]> {
        let start = self.triangles.get(slot).map(|triangle| &triangle.vertices);
        start.into_iter().chain(self.ends.get(slot)).flatten().map(|corner| corner.map(f64::from))
    }
}
