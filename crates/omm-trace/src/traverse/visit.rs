//! What a search knows while it is inside an instance.

use crate::bvh::BoxRay;
use crate::ray::Ray;
use crate::scene::{Blas, Instance, Scene};
use crate::transform::WorldToObject;
use crate::triangle::{PacketRay, TriangleRay};

/// The ray in the space of an instance.
#[derive(Clone, Debug)]
pub(super) struct Visit<'s> {
    /// Where the instance is in the scene.
    at: u32,
    pub(super) instance: &'s Instance,
    pub(super) blas: &'s Blas,
    pub(super) origin: [f64; 3],
    pub(super) direction: [f64; 3],
    packet_ray: PacketRay,
    /// Once it is needed.
    triangle_ray: Option<TriangleRay>,
}

/// Slots of a leaf that are still to be tried.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pending {
    first: usize,
    /// The lowest bit is the first slot.
    bits: u32,
}

impl<'s> Visit<'s> {
    /// The visit of an instance; `None` if there is no way into it at the time of the ray.
    #[inline]
    pub(super) fn new(scene: &'s Scene, at: u32, ray: &Ray) -> Option<Self> {
        let instance = scene.instances.get(at as usize)?;
        let blas = scene.blases.get(instance.blas as usize)?;
        let at_time;
        let to_object = match &instance.to_object {
            Some(known) => known,
            None => {
                at_time = WorldToObject::new(&scene.placements.get(at as usize)?.at(ray.time()))?;
                &at_time
            }
        };
        let (origin, direction) = (to_object.point(ray.origin()), to_object.direction(ray.direction()));
        Some(Self {
            at,
            instance,
            blas,
            origin,
            direction,
            packet_ray: PacketRay::new(origin, direction, blas.largest),
            triangle_ray: None,
        })
    }

    /// Whether it is the visit of that instance.
    pub(super) const fn is_of(&self, at: u32) -> bool {
        self.at == at
    }

    /// The ray among the boxes of the instance.
    pub(super) fn box_ray(&self, ray: &Ray) -> BoxRay {
        BoxRay::new(&self.blas.triangle_bvh, self.origin, self.direction, ray.t_min())
    }

    /// The ray among the triangles of the instance.
    #[inline]
    pub(super) fn triangle_ray(&mut self) -> &TriangleRay {
        self.triangle_ray.get_or_insert_with(|| TriangleRay::new(self.origin, self.direction))
    }

    /// The triangles of a leaf that the ray may meet.
    #[inline]
    pub(super) fn triangles(&self, leaf: usize) -> Pending {
        let slots = self.blas.triangle_bvh.slots(leaf);
        // What moves has no packets.
        let met = self.blas.packets.get(leaf).map_or(!0, |packet| self.packet_ray.may_meet(packet));
        Pending { first: slots.start, bits: met & ((1 << slots.len()) - 1) }
    }
}

impl Pending {
    /// Takes the next slot out.
    #[inline]
    pub(super) fn take(&mut self) -> Option<usize> {
        let next = self.bits.trailing_zeros();
        if next == u32::BITS {
            return None;
        }
        self.bits &= self.bits - 1;
        Some(self.first + next as usize)
    }
}
