//! The conservative test of a ray against boxes; see the [module](super) for what it guarantees.

use glam::{Vec4, Vec4Swizzles};

use super::{Bvh, Planes};

/// A ray in the unit of a tree, made ready for its boxes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxRay {
    /// For each axis what is subtracted from planes: the origin from above twice, for lower ends, and from below twice.
    origin: [Vec4; 3],
    inverse: [Vec4; 3],
    /// What `t` is multiplied with.
    t_scale: f64,
    t_min: f32,
}

/// Components of the direction below this part of the longest count as zero.
const PARALLEL: f64 = 1.0 / (1_u32 << 20) as f64;
/// Half the width of the band that a ray is where it counts as parallel, in parts of the scene's size.
const PARALLEL_MARGIN: f64 = 1.0 / (1_u32 << 16) as f64;
/// Half the width of the origin, in parts of its largest coordinate.
const ORIGIN_MARGIN: f64 = 1.0 / (1_u32 << 24) as f64;
/// Stands for the inverse of zero. Times the band it exceeds every `t` by far.
const PARALLEL_INVERSE: f32 = (1_u128 << 96) as f32;
/// Room for three roundings at each end of an interval, and then some.
const SLACK: f32 = 1.0 + 1.0 / (1_u32 << 20) as f32;

impl BoxRay {
    /// The ray through `origin` along `direction`, which is not zero, from `t_min` on; for the boxes of `bvh`.
    pub(crate) fn new(bvh: &Bvh, origin: [f64; 3], direction: [f64; 3], t_min: f32) -> Self {
        let largest = |point: [f64; 3]| point.into_iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        let origin = origin.map(|x| x * bvh.scale);
        let direction = direction.map(|x| x * bvh.scale);
        let t_scale = power_below(largest(direction));
        let t_unit = 1.0 / t_scale;
        let distance = largest(origin);
        // Coordinates of boxes are below 2.
        let size = distance.max(2.0);

        let mut ray = Self {
            origin: [Vec4::ZERO; 3],
            inverse: [Vec4::ZERO; 3],
            t_scale,
            t_min: round_down(f64::from(t_min) * t_scale),
        };
        let axes = ray.origin.iter_mut().zip(&mut ray.inverse);
        for ((slot, inverse), (x, slope)) in axes.zip(origin.into_iter().zip(direction)) {
            // Exact: the inverse of a power of two.
            let slope = slope * t_unit;
            let parallel = slope.abs() < PARALLEL;
            let margin = if parallel { size * PARALLEL_MARGIN } else { distance * ORIGIN_MARGIN };
            *inverse = Vec4::splat(if parallel { PARALLEL_INVERSE } else { (1.0 / slope) as f32 });
            // Only absurd transforms lead beyond the numbers; then every box is met.
            let known = x.is_finite() && margin.is_finite();
            let [above, below] =
                if known { [round_up(x + margin), round_down(x - margin)] } else { [f32::INFINITY, f32::NEG_INFINITY] };
            *slot = Vec4::new(above, above, below, below);
        }
        ray
    }

    /// The largest `t` in the ray's own unit that can stand for one of at most `t`.
    pub(super) fn bound(&self, t: f32) -> f32 {
        // One step more, so that a `t` that was rounded down to `t` is within it.
        round_up(f64::from(t.next_up()) * self.t_scale)
    }

    /// Whether the ray can meet one box at most at `t`.
    pub(crate) fn meets(&self, planes: &Planes, t: f32) -> bool {
        self.enter(planes, self.bound(t))[0].is_some()
    }

    /// Where the ray enters each of two boxes, in its own unit, if it can meet them at most at `bound`.
    #[inline(always)]
    pub(super) fn enter(&self, planes: &Planes, bound: f32) -> [Option<f32>; 2] {
        let (mut near, mut far) = (Vec4::splat(self.t_min), Vec4::splat(bound));
        for ((planes, origin), inverse) in planes.iter().zip(&self.origin).zip(&self.inverse) {
            // Of both boxes where the ray crosses the lower ends, then where it crosses the upper ones. No `t` is NaN: planes are
            // finite, the inverse is neither zero nor infinite, and an infinite origin gives infinities.
            let crossed = (*planes - *origin) * *inverse;
            let opposite = crossed.zwxy();
            near = near.max(crossed.min(opposite));
            far = far.min(crossed.max(opposite));
        }
        // A negative far end stays negative, and `t_min` is not negative.
        let met = near.cmple(far * SLACK).bitmask();
        [0, 1].map(|side| (met >> side & 1 == 1).then_some(near[side]))
    }
}

/// The largest power of two that is at most `x`, within the exponents of normal numbers and their inverses.
pub(super) fn power_below(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & (0x7ff << 52)).clamp(2.0_f64.powi(-1022), 2.0_f64.powi(1022))
}

/// The largest `f32` at most `x`.
pub(super) fn round_down(x: f64) -> f32 {
    let rounded = x as f32;
    if f64::from(rounded) > x { rounded.next_down() } else { rounded }
}

/// The smallest `f32` at least `x`.
pub(super) fn round_up(x: f64) -> f32 {
    let rounded = x as f32;
    if f64::from(rounded) < x { rounded.next_up() } else { rounded }
}
