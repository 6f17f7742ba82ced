//! The bird curve: the order in which a micromap stores its microtriangles.
//!
//! A triangle with vertices 0, 1, 2 and barycentrics *u* (weight of vertex 1) and *v* (weight of vertex 2) is split at the
//! midpoints of its edges. The curve visits the part at vertex 0, the middle part, the part at vertex 1, the part at vertex 2,
//! and does the same within each, so the two most significant bits of an index name the part of the first split and so on down:
//! `index >> 2` is the parent's index at the next coarser level. In the second and the fourth part the curve runs mirrored
//! (they are *flipped*), so that it enters each microtriangle at the corner where it left the one before.
//!
//! [`index`] is the function that the appendix of [`VK_EXT_opacity_micromap`] gives as reference code, for every pair of `f32`
//! to the last bit; where that code is silent (NaN), a coordinate counts as 0. [`MicroTriangle`] is its inverse in integers.
//!
//! [`VK_EXT_opacity_micromap`]: https://docs.vulkan.org/refpages/latest/refpages/source/VK_EXT_opacity_micromap.html

use serde::{Deserialize, Serialize};

use crate::level::SubdivisionLevel;

/// The index of the microtriangle that holds the point with barycentrics (`u`, `v`) at `level`.
///
/// Any `f32` is taken: a coordinate is clamped to `0.0..=1.0`, NaN counts as 0, and a pair with `u + v > 1` is brought back
/// into the triangle as the reference code does. The result is below `level.microtriangles()`.
#[must_use]
pub fn index(u: f32, v: f32, level: SubdivisionLevel) -> u32 {
    let segments = level.segments();
    let fu = clamp_to_unit(u) * segments as f32;
    let fv = clamp_to_unit(v) * segments as f32;
    let (cell_u, cell_v) = (fu as u32, fv as u32);
    // The remainders are those of the unclamped cells, as in the reference code.
    let beyond_diagonal = (fu - cell_u as f32) + (fv - cell_v as f32) >= 1.0;

    let (mut cell_u, cell_v) = (cell_u.min(segments - 1), cell_v.min(segments - 1));
    let sum = cell_u + cell_v;
    if sum >= segments {
        cell_u -= sum - segments + 1;
    }
    // An upright microtriangle has u + v + w = segments - 1 in integers; a flipped one has one less.
    let flipped = beyond_diagonal && sum < segments - 1;
    let cell_w = (!(cell_u + cell_v)).wrapping_sub(u32::from(flipped));
    interleave(cell_u, cell_v, cell_w, segments - 1)
}

/// Clamps to `0.0..=1.0`; NaN becomes 0, where `f32::clamp` would keep it.
fn clamp_to_unit(coordinate: f32) -> f32 {
    if coordinate > 0.0 { coordinate.min(1.0) } else { 0.0 }
}

/// The index of the cell (`u`, `v`, `w`), whose coordinates have as many bits as `mask`.
fn interleave(u: u32, v: u32, w: u32, mask: u32) -> u32 {
    let even = !(u ^ w) & mask;
    let both = (u ^ v) & even;
    // Each bit of `turned` says whether an odd number of fourth parts was entered at or above it.
    let mut turned = both;
    turned ^= turned >> 1;
    turned ^= turned >> 2;
    turned ^= turned >> 4;
    turned ^= turned >> 8;
    let odd = ((turned ^ u) & !even & mask) | both;
    spread(even) | spread(odd) << 1
}

/// Moves bit *n* of the low 16 to bit 2*n*.
const fn spread(bits: u32) -> u32 {
    let bits = (bits | bits << 8) & 0x00ff_00ff;
    let bits = (bits | bits << 4) & 0x0f0f_0f0f;
    let bits = (bits | bits << 2) & 0x3333_3333;
    (bits | bits << 1) & 0x5555_5555
}

/// Which microtriangle a point belongs to that lies on an edge or a vertex of the grid.
///
/// The specification has one lookup for what lies inside of a microtriangle, but leaves it to an implementation how it
/// rounds; what lies within rounding of an edge may read any of those that touch it. A device profile says which.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TieBreak {
    /// That of the appendix's code, [`index`].
    #[default]
    Reference,
    /// The one of lowest index among those whose closed area holds the point, decided without rounding. A point outside
    /// of the triangle is looked up by [`index`].
    LowestIndex,
}

impl TieBreak {
    /// The index of the microtriangle at (`u`, `v`).
    #[must_use]
    pub fn index(self, u: f32, v: f32, level: SubdivisionLevel) -> u32 {
        match self {
            Self::Reference => index(u, v, level),
            Self::LowestIndex => lowest_touching(u, v, level).unwrap_or_else(|| index(u, v, level)),
        }
    }
}

/// The lowest index of the microtriangles that touch a point; `None` if it lies outside of the triangle.
fn lowest_touching(u: f32, v: f32, level: SubdivisionLevel) -> Option<u32> {
    let segments = level.segments();
    // Exact: powers of two, and 53 bits.
    let [fu, fv] = [u, v].map(|coordinate| f64::from(clamp_to_unit(coordinate)) * f64::from(segments));
    let (cell_u, cell_v) = (fu as u32, fv as u32);
    let cells = [(cell_u, cell_v), (cell_u.wrapping_sub(1), cell_v), (cell_u, cell_v.wrapping_sub(1))];
    let cells = cells.into_iter().chain([(cell_u.wrapping_sub(1), cell_v.wrapping_sub(1))]);
    let within = |&(u, v): &(u32, u32)| u < segments && v < segments && u + v < segments;
    let touching = cells.filter(within).flat_map(|(u, v)| {
        let (x, y) = (fu - f64::from(u), fv - f64::from(v));
        // Both differences are exact. x + y is not, but it is on the right side of 1 if its error is looked at too.
        let sum = x + y;
        let error = if x >= y { y - (sum - x) } else { x - (sum - y) };
        let beyond = sum > 1.0 || (sum == 1.0 && error > 0.0);
        let on_diagonal = sum == 1.0 && error == 0.0;
        let in_cell = x <= 1.0 && y <= 1.0;
        let upright = in_cell && !beyond;
        let flipped = in_cell && (beyond || on_diagonal) && u + v + 1 < segments;
        let cell_w = !(u + v);
        let index = |w| interleave(u, v, w, segments - 1);
        [upright.then(|| index(cell_w)), flipped.then(|| index(cell_w.wrapping_sub(1)))].into_iter().flatten()
    });
    touching.min()
}

/// [`index`] for a slice of (`u`, `v`) pairs, into `indices`; pairs and indices beyond the shorter of the two are left alone.
pub fn indices(barycentrics: &[[f32; 2]], level: SubdivisionLevel, indices: &mut [u32]) {
    for (&[u, v], slot) in barycentrics.iter().zip(indices) {
        *slot = index(u, v, level);
    }
}

/// A corner of a microtriangle: its barycentrics *u* and *v* in units of 2<sup>-level</sup>, `0..=2^level` each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Corner {
    /// Weight of vertex 1, times 2<sup>level</sup>.
    pub u: u32,
    /// Weight of vertex 2, times 2<sup>level</sup>.
    pub v: u32,
}

impl Corner {
    /// The corner's barycentrics (*u*, *v*), exactly.
    #[must_use]
    pub fn barycentrics(self, level: SubdivisionLevel) -> [f32; 2] {
        // Numerators of at most 13 bits and a power of two: both steps are exact.
        let unit = 1.0 / level.segments() as f32;
        [self.u as f32 * unit, self.v as f32 * unit]
    }

    const fn midpoint(self, other: Self) -> Self {
        Self { u: (self.u + other.u) / 2, v: (self.v + other.v) / 2 }
    }
}

/// One microtriangle: a level and an index on its curve, which is in range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MicroTriangle {
    level: SubdivisionLevel,
    index: u32,
}

impl MicroTriangle {
    /// The microtriangle that is the whole triangle: level 0, index 0.
    pub const ROOT: Self = Self { level: SubdivisionLevel::ZERO, index: 0 };

    /// The microtriangle `index` of `level`, if the level has so many.
    #[must_use]
    pub const fn new(level: SubdivisionLevel, index: u32) -> Option<Self> {
        if index < level.microtriangles() { Some(Self { level, index }) } else { None }
    }

    /// The microtriangle of `level` that holds the point (`u`, `v`); see [`index`].
    #[must_use]
    pub fn at(u: f32, v: f32, level: SubdivisionLevel) -> Self {
        Self { level, index: index(u, v, level) }
    }

    /// All microtriangles of `level` in the order of the curve.
    pub fn all(level: SubdivisionLevel) -> impl DoubleEndedIterator<Item = Self> + Clone {
        (0..level.microtriangles()).map(move |index| Self { level, index })
    }

    /// The level.
    #[must_use]
    pub const fn level(self) -> SubdivisionLevel {
        self.level
    }

    /// The index on the curve.
    #[must_use]
    pub const fn index(self) -> u32 {
        self.index
    }

    /// The microtriangle of the next coarser level that contains this one.
    #[must_use]
    pub const fn parent(self) -> Option<Self> {
        match self.level.coarser() {
            Some(level) => Some(Self { level, index: self.index >> 2 }),
            None => None,
        }
    }

    /// The four microtriangles of the next finer level that make up this one, in the order of the curve.
    #[must_use]
    pub fn children(self) -> Option<[Self; 4]> {
        let level = self.level.finer()?;
        Some([0, 1, 2, 3].map(|part| Self { level, index: self.index << 2 | part }))
    }

    /// The corners, exactly, in the order in which the curve runs: it enters at the first and leaves at the last.
    ///
    /// The order is not the winding: of the microtriangles of a level some run clockwise and some do not.
    #[must_use]
    pub const fn corners(self) -> [Corner; 3] {
        let segments = self.level.segments();
        let mut corners = [Corner { u: 0, v: 0 }, Corner { u: segments, v: 0 }, Corner { u: 0, v: segments }];
        let mut bit = 2 * self.level.get();
        while bit > 0 {
            bit -= 2;
            corners = part(corners, self.index >> bit & 3);
        }
        corners
    }

    /// Whether the microtriangle is upside down: its corners are the midpoints of an upright one's edges.
    #[must_use]
    pub fn is_flipped(self) -> bool {
        // The corners' sums u + v are s, s+1, s+1 if upright and s+1, s+1, s+2 if flipped.
        let sums = self.corners().map(|corner| corner.u + corner.v);
        let least = sums[0].min(sums[1]).min(sums[2]);
        sums.iter().filter(|&&sum| sum == least).count() == 2
    }

    /// The barycentrics of the centroid, rounded to `f32`; [`index`] maps them back to this microtriangle.
    #[must_use]
    pub fn centroid(self) -> [f32; 2] {
        let [a, b, c] = self.corners();
        let unit = 3.0 * self.level.segments() as f32;
        [(a.u + b.u + c.u) as f32 / unit, (a.v + b.v + c.v) as f32 / unit]
    }
}

/// Part `which` (`0..=3`) of the split of a triangle whose curve runs along `corners`.
///
/// Parts 0 and 2 keep the order of the corners; parts 1 and 3 turn it round.
pub const fn part([a, b, c]: [Corner; 3], which: u32) -> [Corner; 3] {
    let (ab, bc, ca) = (a.midpoint(b), b.midpoint(c), c.midpoint(a));
    match which {
        0 => [a, ab, ca],
        1 => [ca, bc, ab],
        2 => [ab, b, bc],
        _ => [bc, ca, c],
    }
}

/// The corners of every microtriangle of `level` in the order of the curve, into `corners`; slots beyond the level's count are
/// left alone, and the rest of the level is left out if there are fewer.
pub fn corners(level: SubdivisionLevel, corners: &mut [[Corner; 3]]) {
    for (microtriangle, slot) in MicroTriangle::all(level).zip(corners) {
        *slot = microtriangle.corners();
    }
}

#[cfg(test)]
mod tests;
