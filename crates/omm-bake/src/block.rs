//! The data of one micromap triangle, from the hierarchy of its microtriangles.

use omm_model::curve::{MicroTriangle, part};
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;
use rayon::prelude::*;

use crate::classify::{Classification, Node};
use crate::packed;
use crate::patch::{Bits, Patch, Spot};
use crate::planes::Planes;
use crate::promotion::{UnknownStatePromotion, mostly_opaque};
use crate::statistics::StateCounts;
use crate::surface::Surface;
use crate::texel_triangle::TexelTriangle;

/// The levels of a subtree that is baked in one piece: 4^6 microtriangles, 1 KiB of 4-state data.
const PIECE_LEVELS: u32 = 6;

/// The data of one micromap triangle and what is in it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Block {
    pub(crate) data: Vec<u8>,
    pub(crate) tally: Tally,
}

/// What is in a block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Tally {
    pub(crate) states: StateCounts,
    pub(crate) undecided: u64,
}

/// What all blocks of a bake have in common.
#[derive(Debug)]
pub(crate) struct BlockBaker<'a> {
    pub(crate) surface: &'a Surface<'a>,
    pub(crate) planes: &'a Planes,
    pub(crate) format: OpacityMicromapFormat,
    pub(crate) promotion: UnknownStatePromotion,
}

impl BlockBaker<'_> {
    /// The block of `triangle` at `level`; `patch` is room to work in. Pieces of it are baked in parallel, and `finished` is told of each how many microtriangles
    /// it had.
    pub(crate) fn bake(
        &self,
        triangle: &TexelTriangle,
        level: SubdivisionLevel,
        patch: &mut Patch,
        finished: &(dyn Fn(u64) + Sync),
    ) -> Block {
        let piece_levels = level.get().min(PIECE_LEVELS);
        // At most 12 less something.
        let root_level = SubdivisionLevel::new(level.get() - piece_levels).unwrap_or_default();
        let bytes = self.format.data_size(level) as usize;
        let mut data = vec![0; bytes];
        let piece_bytes = bytes / root_level.microtriangles() as usize;
        let bake_piece = |patch: &mut Patch, (index, bytes): (usize, &mut [u8])| {
            let mut piece = Piece { baker: self, triangle, level, bytes, tally: Tally::default() };
            // A piece for each microtriangle of the root level.
            if let Some(root) = MicroTriangle::new(root_level, index as u32) {
                piece.bake(root, patch);
            }
            finished(1 << (2 * piece_levels));
            piece.tally
        };
        if root_level == SubdivisionLevel::ZERO {
            let tally = bake_piece(patch, (0, &mut data));
            return Block { data, tally };
        }
        let pieces = data.par_chunks_mut(piece_bytes.max(1)).enumerate();
        let tally = pieces.map_init(Patch::new, bake_piece).reduce(Tally::default, Tally::plus);
        Block { data, tally }
    }

    /// A block of one state.
    pub(crate) fn uniform(&self, state: OpacityState, level: SubdivisionLevel) -> Block {
        let state = self.stored(state);
        let mut block = Block { data: vec![0; self.format.data_size(level) as usize], tally: Tally::default() };
        fill(&mut block.data, self.format, 0, level.microtriangles(), state);
        block.tally.states.add(state, level.microtriangles().into());
        block
    }

    /// The state as the format can hold it.
    fn stored(&self, state: OpacityState) -> OpacityState {
        match self.format {
            OpacityMicromapFormat::TwoState => state.to_two_state(),
            OpacityMicromapFormat::FourState => state,
        }
    }
}

impl Tally {
    fn plus(mut self, other: Self) -> Self {
        self.states.add_all(other.states, 1);
        self.undecided += other.undecided;
        self
    }
}

/// Part of a block: the descendants of one microtriangle.
struct Piece<'a> {
    baker: &'a BlockBaker<'a>,
    triangle: &'a TexelTriangle,
    /// The level of the block.
    level: SubdivisionLevel,
    bytes: &'a mut [u8],
    tally: Tally,
}

impl Piece<'_> {
    fn bake(&mut self, root: MicroTriangle, patch: &mut Patch) {
        // In units of the finest level all corners below are integers.
        let finer = self.level.get() - root.level().get();
        let weights = root.corners().map(|mut corner| {
            corner.u <<= finer;
            corner.v <<= finer;
            corner
        });
        self.visit(Node { weights, level: self.level }, 0, finer, patch);
    }

    /// Decides the microtriangles below `node`, which is `finer` levels above them and whose first is `first`.
    fn visit(&mut self, node: Node, first: u32, finer: u32, patch: &mut Patch) {
        let BlockBaker { surface, planes, .. } = *self.baker;
        if let Some(classification) = node.uniform(surface, planes, self.triangle) {
            return self.set(classification, node, first, finer);
        }
        if let Some(spot) = patch.load(surface, planes, self.triangle, node, 1 << finer) {
            return self.visit_patch(patch, spot, first, finer);
        }
        if finer == 0 {
            return self.set(node.scan(surface, self.triangle), node, first, finer);
        }
        for which in 0..4 {
            let child = Node { weights: part(node.weights, which), ..node };
            self.visit(child, first + (which << (2 * (finer - 1))), finer - 1, patch);
        }
    }

    /// The same within a patch, for a node that is known not to be on one side, or not known to be.
    fn visit_patch(&mut self, patch: &mut Patch, spot: Spot, first: u32, finer: u32) {
        if finer == 0 {
            return self.leaf(patch, spot, first);
        }
        if finer == 2 && self.sixteen(patch, spot, first) {
            return;
        }
        let finer = finer - 1;
        for which in 0..4 {
            let (spot, first) = (patch.part(spot, finer, which), first + (which << (2 * finer)));
            match patch.quick(spot, finer) {
                Some(Classification::Opaque) => self.put(OpacityState::Opaque, first, finer),
                Some(_) => self.put(OpacityState::Transparent, first, finer),
                None => self.visit_patch(patch, spot, first, finer),
            }
        }
    }

    /// Decides the microtriangles two levels below `spot` together; `false` if they are too large for that.
    fn sixteen(&mut self, patch: &mut Patch, spot: Spot, first: u32) -> bool {
        let BlockBaker { surface, promotion, .. } = *self.baker;
        let Some(mut states) = patch.sixteen(surface, spot) else { return false };
        for place in Bits(states & 0xaaaa_aaaa) {
            let (which, shift) = (place / 2, place - 1);
            let leaf = patch.one_of_sixteen(spot, which);
            let node = || Node { weights: patch.weights(leaf), level: self.level };
            let is_mixed = states >> shift & 1 == 0;
            let classification = if is_mixed { Classification::Mixed } else { node().scan(surface, self.triangle) };
            let mostly_opaque = || patch.mostly_opaque_in_tile(leaf).unwrap_or_else(|| self.mostly_opaque(node()));
            let state = promotion.state(classification, mostly_opaque);
            states = states & !(3 << shift) | u32::from(state.value()) << shift;
            self.tally.undecided += u64::from(classification == Classification::Undecided);
        }
        self.put_sixteen(states, first);
        true
    }

    /// Sets sixteen microtriangles from `first` on to `states`, two bits each.
    fn put_sixteen(&mut self, states: u32, first: u32) {
        let format = self.baker.format;
        let word = match format {
            OpacityMicromapFormat::TwoState => packed::gather(states).into(),
            OpacityMicromapFormat::FourState => states,
        };
        let (at, length) = ((first * format.bits()) as usize / 8, 2 * format.bits() as usize);
        let Some(bytes) = self.bytes.get_mut(at..at + length) else { return };
        bytes.iter_mut().zip(word.to_le_bytes()).for_each(|(to, from)| *to = from);
        self.tally.states.add_all(packed::count_word(word.into(), format, 16), 1);
    }

    /// Decides one microtriangle of a patch.
    fn leaf(&mut self, patch: &mut Patch, spot: Spot, first: u32) {
        let BlockBaker { surface, promotion, .. } = *self.baker;
        let node = |patch: &Patch| Node { weights: patch.weights(spot), level: self.level };
        let classification = patch.leaf(surface, spot).unwrap_or_else(|| node(patch).scan(surface, self.triangle));
        let mostly_opaque = || patch.mostly_opaque(surface, spot).unwrap_or_else(|| self.mostly_opaque(node(patch)));
        let state = promotion.state(classification, mostly_opaque);
        self.decide(classification, state, first, 0);
    }

    /// Sets all microtriangles below `node` to the state for `classification`.
    fn set(&mut self, classification: Classification, node: Node, first: u32, finer: u32) {
        let state = self.baker.promotion.state(classification, || self.mostly_opaque(node));
        self.decide(classification, state, first, finer);
    }

    fn mostly_opaque(&self, node: Node) -> bool {
        let surface = self.baker.surface;
        let corners = self.triangle.corners(node.weights, node.level, surface.shift());
        mostly_opaque(&corners, |x, y| surface.is_above_near(x, y))
    }

    fn decide(&mut self, classification: Classification, state: OpacityState, first: u32, finer: u32) {
        self.put(state, first, finer);
        self.tally.undecided += u64::from(classification == Classification::Undecided);
    }

    fn put(&mut self, state: OpacityState, first: u32, finer: u32) {
        let count = 1 << (2 * finer);
        let state = self.baker.stored(state);
        fill(self.bytes, self.baker.format, first, count, state);
        self.tally.states.add(state, count.into());
    }
}

/// Sets `count` elements from `first` on to `state`; they have been 0. `count` is a power of 4 of which `first` is a multiple.
fn fill(bytes: &mut [u8], format: OpacityMicromapFormat, first: u32, count: u32, state: OpacityState) {
    let bits = format.bits();
    let (start, length) = (first * bits, count * bits);
    // The element's value in every place of a byte.
    let spread = state.value() * if bits == 1 { 0xff } else { 0x55 };
    let at = start as usize / 8;
    if length >= 8 {
        if let Some(bytes) = bytes.get_mut(at..at + length as usize / 8) {
            bytes.fill(spread);
        }
    } else if let Some(byte) = bytes.get_mut(at) {
        *byte |= (spread & ((1 << length) - 1)) << (start % 8);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fill_sets_what_the_format_reads() {
        for format in OpacityMicromapFormat::ALL {
            for state in OpacityState::ALL.into_iter().take(1 << format.bits()) {
                for finer in 0..=3 {
                    let count = 1_u32 << (2 * finer);
                    for first in (0..64).step_by(count as usize) {
                        let mut bytes = [0; 16];
                        fill(&mut bytes, format, first, count, state);
                        for index in 0..64 {
                            let inside = (first..first + count).contains(&index);
                            let expected = if inside { state } else { OpacityState::Transparent };
                            assert_eq!(format.state(&bytes, index.into()), Some(expected));
                        }
                    }
                }
            }
        }
    }
}
