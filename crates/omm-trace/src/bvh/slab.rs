//! The conservative test of a ray against boxes; see the [module](super) for what it guarantees.

use super::{Bvh, Planes};

/// A ray in the unit of a tree, made ready for its boxes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxRay {
    /// For each axis the origin from above and from below: subtracted from lower and upper ends of boxes.
    origin: [[f32; 2]; 3],
    inverse: [f32; 3],
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
        let distance = largest(origin);
        // Coordinates of boxes are below 2.
        let size = distance.max(2.0);

        let mut ray =
            Self { origin: [[0.0; 2]; 3], inverse: [0.0; 3], t_scale, t_min: round_down(f64::from(t_min) * t_scale) };
        let axes = ray.origin.iter_mut().zip(&mut ray.inverse);
        for ((slot, inverse), (x, slope)) in axes.zip(origin.into_iter().zip(direction)) {
            let slope = slope / t_scale;
            let parallel = slope.abs() < PARALLEL;
            let margin = if parallel { size * PARALLEL_MARGIN } else { distance * ORIGIN_MARGIN };
            *inverse = if parallel { PARALLEL_INVERSE } else { (1.0 / slope) as f32 };
            // Only absurd transforms lead beyond the numbers; then every box is met.
            let known = x.is_finite() && margin.is_finite();
            *slot =
                if known { [round_up(x + margin), round_down(x - margin)] } else { [f32::INFINITY, f32::NEG_INFINITY] };
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
        let (mut near, mut far) = ([self.t_min; 2], [bound; 2]);
        for ((&[a, b, c, d], &[above, below]), &inverse) in planes.iter().zip(&self.origin).zip(&self.inverse) {
            let low = [(a - above) * inverse, (b - above) * inverse];
            let high = [(c - below) * inverse, (d - below) * inverse];
            let (enter, leave) = if inverse < 0.0 { (high, low) } else { (low, high) };
            near = larger(near, enter);
            far = smaller(far, leave);
        }
        // No `t` is NaN: planes are finite, the inverse is neither zero nor infinite, and an infinite origin gives
        // infinities. A negative far end stays negative, and `t_min` is not negative.
        [0, 1].map(|side| (near[side] <= far[side] * SLACK).then_some(near[side]))
    }
}

// `f32::min` and `f32::max` spend instructions on NaN.
#[inline(always)]
fn smaller(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [0, 1].map(|side| if a[side] < b[side] { a[side] } else { b[side] })
}

#[inline(always)]
fn larger(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [0, 1].map(|side| if a[side] > b[side] { a[side] } else { b[side] })
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
