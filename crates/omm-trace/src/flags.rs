//! Ray flags, and what they and an instance's flags say about opacity and facing.

use omm_model::opacity::{InstanceOpacity, RayOpacity};
use omm_model::vk::GeometryInstanceFlags;

bitflags::bitflags! {
    /// The `Ray Flags` operand, under the names and with the values of SPIR-V (`SPV_KHR_ray_tracing`,
    /// `SPV_EXT_opacity_micromap`). Unknown bits are kept and mean nothing.
    ///
    /// The specification forbids some combinations: more than one of the four opacity flags that force or cull,
    /// both face culling flags, both skip flags, and [`SKIP_TRIANGLES`](Self::SKIP_TRIANGLES) with face culling.
    /// Traversal does not check that: it applies every flag that is set, in the order of the chapter.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct RayFlags: u32 {
        /// Every candidate is opaque, whatever geometry, micromap and instance say, unless the micromap ignores it.
        const OPAQUE = 0x1;
        /// Every candidate is non-opaque, likewise.
        const NO_OPAQUE = 0x2;
        /// The first hit that is confirmed ends the search.
        const TERMINATE_ON_FIRST_HIT = 0x4;
        /// No closest-hit shader runs. Traversal itself is not changed by it: whoever calls it has the hit and runs
        /// the shader or does not.
        const SKIP_CLOSEST_HIT_SHADER = 0x8;
        /// Candidates on the back of a triangle are dropped.
        const CULL_BACK_FACING_TRIANGLES = 0x10;
        /// Candidates on the front of a triangle are dropped.
        const CULL_FRONT_FACING_TRIANGLES = 0x20;
        /// Opaque candidates are dropped.
        const CULL_OPAQUE = 0x40;
        /// Non-opaque candidates are dropped.
        const CULL_NO_OPAQUE = 0x80;
        /// Triangles are passed over.
        const SKIP_TRIANGLES = 0x100;
        /// AABBs are passed over.
        const SKIP_AABBS = 0x200;
        /// The unknown states of micromaps are read as the known state they lean to.
        const FORCE_OPACITY_MICROMAP_2_STATE = 0x400;
        const _ = !0;
    }
}

impl RayFlags {
    /// The part that bears on opacity.
    #[must_use]
    pub const fn opacity(self) -> RayOpacity {
        RayOpacity {
            opaque: self.contains(Self::OPAQUE),
            no_opaque: self.contains(Self::NO_OPAQUE),
            cull_opaque: self.contains(Self::CULL_OPAQUE),
            cull_no_opaque: self.contains(Self::CULL_NO_OPAQUE),
            force_two_state: self.contains(Self::FORCE_OPACITY_MICROMAP_2_STATE),
        }
    }
}

/// The part of an instance's flags that bears on opacity.
pub(crate) const fn instance_opacity(flags: GeometryInstanceFlags) -> InstanceOpacity {
    InstanceOpacity {
        force_opaque: flags.contains(GeometryInstanceFlags::FORCE_OPAQUE),
        force_no_opaque: flags.contains(GeometryInstanceFlags::FORCE_NO_OPAQUE),
        force_two_state: flags.contains(GeometryInstanceFlags::FORCE_OPACITY_MICROMAP_2_STATE),
        disable_micromaps: flags.contains(GeometryInstanceFlags::DISABLE_OPACITY_MICROMAPS),
    }
}

/// Which sides of its triangles an instance shows to a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Facing {
    flip: bool,
    cull_front: bool,
    cull_back: bool,
}

impl Facing {
    pub(crate) const fn new(ray: RayFlags, instance: GeometryInstanceFlags) -> Self {
        let cull = !instance.contains(GeometryInstanceFlags::TRIANGLE_FACING_CULL_DISABLE);
        Self {
            flip: instance.contains(GeometryInstanceFlags::TRIANGLE_FLIP_FACING),
            cull_front: cull && ray.contains(RayFlags::CULL_FRONT_FACING_TRIANGLES),
            cull_back: cull && ray.contains(RayFlags::CULL_BACK_FACING_TRIANGLES),
        }
    }

    /// Whether a triangle that shows its front by its winding shows its front after all.
    pub(crate) const fn is_front(self, front_by_winding: bool) -> bool {
        front_by_winding != self.flip
    }

    /// Whether that side is culled.
    pub(crate) const fn culls(self, front: bool) -> bool {
        if front { self.cull_front } else { self.cull_back }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_those_of_spir_v() {
        let values = [0x1, 0x2, 0x4, 0x8, 0x10, 0x20, 0x40, 0x80, 0x100, 0x200, 0x400];
        let named: Vec<_> = RayFlags::all().iter_names().map(|(_, flag)| flag.bits()).collect();
        assert_eq!(named, values);
        assert_eq!(RayFlags::from_bits_retain(0x8000_0000).bits(), 0x8000_0000);
    }

    #[test]
    fn each_flag_reaches_its_field() {
        let fields = |o: RayOpacity| [o.opaque, o.no_opaque, o.cull_opaque, o.cull_no_opaque, o.force_two_state];
        let flags = [0x1, 0x2, 0x40, 0x80, 0x400];
        for (at, bits) in flags.into_iter().enumerate() {
            let expected = std::array::from_fn(|i| i == at);
            assert_eq!(fields(RayFlags::from_bits_retain(bits).opacity()), expected);
        }
        assert_eq!(fields(RayFlags::from_bits_retain(!0x4c3).opacity()), [false; 5]);

        let fields = |o: InstanceOpacity| [o.force_opaque, o.force_no_opaque, o.force_two_state, o.disable_micromaps];
        for at in 0..4 {
            let expected = std::array::from_fn(|i| i == at);
            assert_eq!(fields(instance_opacity(GeometryInstanceFlags::from_bits_retain(4 << at))), expected);
        }
    }

    #[test]
    fn facing_table() {
        const BACK: RayFlags = RayFlags::CULL_BACK_FACING_TRIANGLES;
        const FRONT: RayFlags = RayFlags::CULL_FRONT_FACING_TRIANGLES;
        let none = GeometryInstanceFlags::empty();
        let flip = GeometryInstanceFlags::TRIANGLE_FLIP_FACING;
        let disable = GeometryInstanceFlags::TRIANGLE_FACING_CULL_DISABLE;
        // Ray flags, instance flags, culled if the winding says front, culled if it says back.
        let table = [
            (RayFlags::empty(), none, false, false),
            (BACK, none, false, true),
            (FRONT, none, true, false),
            (BACK | FRONT, none, true, true),
            (BACK, flip, true, false),
            (FRONT, flip, false, true),
            (BACK, disable, false, false),
            (FRONT, disable, false, false),
            (BACK, flip | disable, false, false),
        ];
        for (ray, instance, front, back) in table {
            let facing = Facing::new(ray, instance);
            let culled = |by_winding| facing.culls(facing.is_front(by_winding));
            assert_eq!((culled(true), culled(false)), (front, back), "{ray:?} {instance:?}");
        }
    }
}
