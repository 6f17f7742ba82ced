//! The conservative test of a ray against boxes; see the [module](super) for what it guarantees.

use glam::Vec4;

use super::{Bvh, Planes};

/// A ray in the unit of a tree, made ready for its boxes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxRay {
    axes: [Axis; 3],
    /// What `t` is multiplied with.
    t_scale: f64,
    t_min: Vec4,
}

/// A ray along one axis, the same for four boxes.
#[derive(Clone, Copy, Debug)]
struct Axis {
    /// What is subtracted from the ends at which the ray enters boxes, and from those at which it leaves them: the
    /// origin as far ahead as it may be, and as far back.
    origin: [Vec4; 2],
    inverse: Vec4,
    /// Which ends it enters at: 0 for the lower ones, 1 for the upper ones.
    enters: usize,
}

/// Components of the direction below this part of the longest count as zero.
const PARALLEL: f32 = 1.0 / (1_u32 << 20) as f32;
/// Half the width of the band that a ray is where it counts as parallel, in parts of the scene's size.
const PARALLEL_MARGIN: f32 = 1.0 / (1_u32 << 16) as f32;
/// Half the width of the origin, in parts of its largest coordinate, and room for three roundings.
const ORIGIN_MARGIN: f32 = 4.0 / (1_u32 << 24) as f32;
/// Stands for the inverse of zero. Times the band it exceeds every `t` by far.
const PARALLEL_INVERSE: f32 = (1_u128 << 96) as f32;
/// The smallest number above zero.
const SMALLEST: f64 = f32::from_bits(1) as f64;
/// Room for a dozen roundings.
const SLACK: f32 = 1.0 + 1.0 / (1_u32 << 20) as f32;

impl BoxRay {
    /// The ray through `origin` along `direction`, which is not zero, from `t_min` on; for the boxes of `bvh`.
    #[inline]
    pub(crate) fn new(bvh: &Bvh, origin: [f64; 3], direction: [f64; 3], t_min: f32) -> Self {
        let direction = direction.map(|x| x * bvh.scale);
        let longest = direction.into_iter().fold(0.0, |longest: f64, x| longest.max(x.abs()));
        let t_scale = power_below(longest);
        // Exact: the inverse of a power of two.
        let t_unit = 1.0 / t_scale;
        let [x, y, z] = origin.map(|x| (x * bvh.scale) as f32);
        let origin = Vec4::new(x, y, z, 0.0);
        let [x, y, z] = direction.map(|x| (x * t_unit) as f32);
        let slope = Vec4::new(x, y, z, 1.0);

        let distance = origin.abs().max_element();
        let parallel = slope.abs().cmplt(Vec4::splat(PARALLEL));
        let inverse = Vec4::select(parallel, Vec4::splat(PARALLEL_INVERSE), slope.recip());
        // Coordinates of boxes are below 2.
        let band = distance.max(2.0) * PARALLEL_MARGIN;
        let margin = Vec4::select(parallel, Vec4::splat(band), Vec4::splat(distance * ORIGIN_MARGIN));
        // Only absurd transforms lead beyond the numbers; then every box is met.
        let known = origin.is_finite();
        let above = if known { origin + margin } else { Vec4::INFINITY };
        let below = if known { origin - margin } else { Vec4::NEG_INFINITY };
        let axis = |axis: usize| {
            let (ahead, behind) = (Vec4::splat(above[axis]), Vec4::splat(below[axis]));
            if inverse[axis] < 0.0 {
                Axis { origin: [behind, ahead], inverse: Vec4::splat(inverse[axis]), enters: 1 }
            } else {
                Axis { origin: [ahead, behind], inverse: Vec4::splat(inverse[axis]), enters: 0 }
            }
        };
        let axes = [axis(0), axis(1), axis(2)];
        Self { axes, t_scale, t_min: Vec4::splat((f64::from(t_min) * t_scale) as f32) }
    }

    /// At least the largest `t` in the ray's own unit that can stand for one of at most `t`.
    #[inline]
    pub(super) fn bound(&self, t: f32) -> f32 {
        // A `t` that was rounded down to `t` is less by a part that the slack covers, or by a part of the smallest number.
        // What is too small for the ray's own unit is less than boxes are grown by.
        ((f64::from(t) + SMALLEST) * self.t_scale) as f32 * SLACK
    }

    /// Whether the ray can meet one box, given four times, at most at `t`.
    pub(crate) fn meets(&self, planes: &Planes, t: f32) -> bool {
        self.enter(planes, self.bound(t)).0 != 0
    }

    /// Which of four boxes the ray can meet at most at `bound`, as bits, and where it enters them, in its own unit.
    #[inline(always)]
    pub(super) fn enter(&self, planes: &Planes, bound: f32) -> (u32, Vec4) {
        let (mut near, mut far) = (self.t_min, Vec4::splat(bound));
        for (planes, axis) in planes.iter().zip(&self.axes) {
            // No `t` is NaN: planes are finite, the inverse is neither zero nor infinite, and an infinite origin gives
            // infinities.
            near = near.max((planes[axis.enters & 1] - axis.origin[0]) * axis.inverse);
            far = far.min((planes[axis.enters & 1 ^ 1] - axis.origin[1]) * axis.inverse);
        }
        // A negative far end stays negative, and `t_min` is not negative.
        (near.cmple(far * SLACK).bitmask(), near)
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
