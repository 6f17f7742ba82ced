//! What a search knows while it is inside an instance.

use omm_model::opacity::InstanceOpacity;

use crate::bvh::BoxRay;
use crate::flags::{self, Facing};
use crate::ray::{Ray, TraceOptions};
use crate::scene::{Blas, Instance, Scene};
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
    pub(super) opacity: InstanceOpacity,
    pub(super) facing: Facing,
    pub(super) triangle_ray: TriangleRay,
    packet_ray: PacketRay,
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
    pub(super) fn new(scene: &'s Scene, at: u32, ray: &Ray, options: &TraceOptions) -> Option<Self> {
        let instance = scene.instances.get(at as usize)?;
        let blas = scene.blases.get(instance.blas as usize)?;
        let to_object = scene.to_object(at, instance, ray.time())?;
        let (origin, direction) = (to_object.point(ray.origin()), to_object.direction(ray.direction()));
        let triangle_ray = TriangleRay::new(origin, direction);
        Some(Self {
            at,
            instance,
            blas,
            origin,
            direction,
            opacity: flags::instance_opacity(instance.flags),
            facing: Facing::new(options.flags, instance.flags),
            triangle_ray,
            packet_ray: PacketRay::new(&triangle_ray, blas.largest),
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
