//! What a bake counted.

use omm_model::opacity::OpacityState;
use serde::{Deserialize, Serialize};

/// How many microtriangles, or triangles, have each state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct StateCounts {
    /// [`OpacityState::Transparent`].
    pub transparent: u64,
    /// [`OpacityState::Opaque`].
    pub opaque: u64,
    /// [`OpacityState::UnknownTransparent`].
    pub unknown_transparent: u64,
    /// [`OpacityState::UnknownOpaque`].
    pub unknown_opaque: u64,
}

impl StateCounts {
    /// Counts `count` more of `state`.
    pub fn add(&mut self, state: OpacityState, count: u64) {
        *match state {
            OpacityState::Transparent => &mut self.transparent,
            OpacityState::Opaque => &mut self.opaque,
            OpacityState::UnknownTransparent => &mut self.unknown_transparent,
            OpacityState::UnknownOpaque => &mut self.unknown_opaque,
        } += count;
    }

    /// Counts everything in `other` `times` times.
    pub fn add_all(&mut self, other: Self, times: u64) {
        let Self { transparent, opaque, unknown_transparent, unknown_opaque } = other;
        self.transparent += transparent * times;
        self.opaque += opaque * times;
        self.unknown_transparent += unknown_transparent * times;
        self.unknown_opaque += unknown_opaque * times;
    }

    /// How many have `state`.
    #[must_use]
    pub const fn of(&self, state: OpacityState) -> u64 {
        match state {
            OpacityState::Transparent => self.transparent,
            OpacityState::Opaque => self.opaque,
            OpacityState::UnknownTransparent => self.unknown_transparent,
            OpacityState::UnknownOpaque => self.unknown_opaque,
        }
    }

    /// All of them.
    #[must_use]
    pub const fn total(&self) -> u64 {
        self.known() + self.unknown_transparent + self.unknown_opaque
    }

    /// Those that need no shader.
    #[must_use]
    pub const fn known(&self) -> u64 {
        self.transparent + self.opaque
    }

    /// The part that needs no shader, 0..=1; 0 if there is nothing.
    #[must_use]
    pub fn known_fraction(&self) -> f64 {
        if self.total() == 0 { 0.0 } else { self.known() as f64 / self.total() as f64 }
    }

    /// The only state that there is, if there is one.
    #[must_use]
    pub fn only_state(&self) -> Option<OpacityState> {
        let mut states = OpacityState::ALL.into_iter().filter(|&state| self.of(state) > 0);
        states.next().filter(|_| states.next().is_none())
    }
}

/// What a bake counted.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BakeStatistics {
    /// Triangles of the mesh.
    pub triangles: u64,
    /// Triangles that were baked: those whose texture coordinates and level no earlier triangle had, without those that cannot be
    /// baked.
    pub baked_triangles: u64,
    /// Micromap triangles in the array: distinct blocks, without those that a special index replaces.
    pub micromap_triangles: u64,
    /// Microtriangles in the array by state.
    pub array_states: StateCounts,
    /// Microtriangles of all triangles of the mesh by state. A triangle with a special index counts as all the microtriangles that
    /// its level has; one that cannot be baked has level 0 if levels are dynamic.
    pub triangle_states: StateCounts,
    /// Triangles of the mesh with a special index, by its state.
    pub special_indices: StateCounts,
    /// The part of `triangle_states` that needs no shader, 0..=1.
    pub known_fraction: f64,
    /// Triangles of the mesh with a texture coordinate that is NaN or infinite.
    pub not_finite: u64,
    /// Triangles of the mesh with a texture coordinate beyond
    /// [`MAX_COORDINATE`](crate::texel_triangle::MAX_COORDINATE) texels.
    pub out_of_range: u64,
    /// Microtriangles, of all triangles of the mesh and once for each mip, that are unknown because deciding would have taken more than
    /// the budget of [`classify`](mod@crate::classify).
    pub undecided: u64,
    /// Triangles of the mesh of which less than [`rejection_threshold`](crate::BakeOptions::rejection_threshold) was known.
    pub rejected: u64,
    /// Triangles of the mesh whose level was lowered, or that were given up, to meet
    /// [`max_array_bytes`](crate::BakeOptions::max_array_bytes).
    pub lowered: u64,
    /// Micromap triangles that became one with another that was almost the same.
    pub near_merged: u64,
    /// Bytes of the array.
    pub array_bytes: u64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counting() {
        let mut counts = StateCounts::default();
        assert_eq!((counts.known_fraction(), counts.only_state()), (0.0, None));
        counts.add(OpacityState::UnknownOpaque, 3);
        assert_eq!(counts.only_state(), Some(OpacityState::UnknownOpaque));
        let mut twice = StateCounts { transparent: 1, opaque: 1, ..StateCounts::default() };
        twice.add_all(counts, 2);
        assert_eq!((twice.total(), twice.known(), twice.only_state()), (8, 2, None));
        assert_eq!(twice.known_fraction(), 0.25);
        assert_eq!(OpacityState::ALL.map(|state| twice.of(state)), [1, 1, 0, 6]);
    }
}
