//! Sixteen microtriangles decided together; the proof is with [`tile`](super::tile).
//!
//! While they are being decided they have the numbers of [`leaves`](super::leaves).

use super::Patch;
use super::cell::{Cell, greater, lesser};
use super::grid::{Cells, FRACTION, Spot, WIDEN};
use super::leaves::{NUMBERS, PLACES, all_corners, any_corner};
use super::tile::{MARGIN, Points, SIDE, Tile, UNIT};
use crate::classify::Classification;
use crate::packed::spread;
use crate::surface::Surface;

/// The anchors of the sixteen among the corners of the node.
const ANCHORS: [usize; 16] = [0, 1, 2, 3, 5, 6, 7, 9, 10, 12, 0, 1, 2, 5, 6, 9];

/// The boxes of the sixteen, along an axis and by half: fixed-point coordinates from the anchor of their node, widened by 2^-13.
#[derive(Clone, Debug, Default)]
pub(super) struct Boxes {
    least: [[[i32; 16]; 2]; 2],
    most: [[[i32; 16]; 2]; 2],
}

impl Boxes {
    /// Takes the steps of a grid and the corners of the sixteen.
    pub(super) fn set(&mut self, steps: [[i64; 2]; 2], corners: &Points) {
        for (axis, corners) in [&corners.x, &corners.y].into_iter().enumerate() {
            // A node of a patch is no larger than 64 texels.
            let [a, b, widen] = [steps[0][axis], steps[1][axis], WIDEN].map(|step| step as i32);
            let lower = [0.min(a).min(b) - widen, 0.max(a).max(b) + widen];
            // The other half is the first turned round.
            let extents = [lower, [a + b - lower[1], a + b - lower[0]]];
            let ([least, upper_least], [most, upper_most]) = (&mut self.least[axis], &mut self.most[axis]);
            for k in 0..16 {
                let extent = extents[usize::from(k >= 10)];
                let anchor = corners[0][ANCHORS[k]];
                (least[k], most[k]) = (anchor + extent[0], anchor + extent[1]);
                (upper_least[k], upper_most[k]) = (4 * (a + b) - most[k], 4 * (a + b) - least[k]);
            }
        }
    }
}

/// Boxes in a tile along an axis: in texels from its first, their first and last cells, and by a bit for each, which touch a cell.
#[derive(Clone, Debug, Default)]
struct PlacedAxis {
    least: [f32; 16],
    most: [f32; 16],
    first: [i32; 16],
    last: [i32; 16],
    touching: [u16; SIDE + 1],
}

/// Boxes in a tile.
#[derive(Clone, Debug, Default)]
pub(super) struct PlacedBoxes([PlacedAxis; 2]);

impl PlacedBoxes {
    /// Takes those of the node `spot`, of which `tile` has the texels.
    #[inline(always)]
    fn set(&mut self, boxes: &Boxes, spot: Spot, tile: &Tile) {
        let half = spot.half();
        for (axis, (placed, anchor)) in self.0.iter_mut().zip(spot.coordinates()).enumerate() {
            let start = anchor - tile.base[axis];
            let (least, most) = (&boxes.least[axis][half], &boxes.most[axis][half]);
            for k in 0..16 {
                let (least, most) = (start + least[k], start + most[k]);
                (placed.first[k], placed.last[k]) = (least >> FRACTION, most >> FRACTION);
                (placed.least[k], placed.most[k]) = (least as f32 * UNIT, most as f32 * UNIT);
            }
            // A bit is turned where a box starts and after it ends.
            placed.touching = [0; SIDE + 1];
            for k in 0..16 {
                placed.touching[placed.first[k] as usize % SIDE] ^= 1 << k;
                placed.touching[placed.last[k] as usize % SIDE + 1] ^= 1 << k;
            }
            let mut bits = 0;
            for touching in &mut placed.touching {
                bits ^= *touching;
                *touching = bits;
            }
        }
    }

    /// A bit for each that touches a column, or a row, counted from the first of the tile.
    #[inline(always)]
    fn touching(&self, axis: usize, cell: u32) -> u16 {
        self.0[axis].touching[cell as usize % SIDE]
    }

    /// Whether all of a cell that box `k` overlaps is `above` or not.
    #[inline(always)]
    fn is_one_sided(&self, k: usize, cell: &Cell<f32>, above: bool) -> bool {
        let k = k % 16;
        let [x, y] = &self.0;
        let within =
            |axis: &PlacedAxis, start: f32| [greater(axis.least[k] - start, 0.0), lesser(axis.most[k] - start, 1.0)];
        let towards = if above { 1.0 } else { -1.0 };
        cell.least_within(within(x, cell.x), within(y, cell.y), towards) > MARGIN
    }
}

/// What is certain of sixteen microtriangles: a bit for each.
#[derive(Clone, Copy, Debug, Default)]
struct Sixteen {
    opaque: u16,
    transparent: u16,
    mixed: u16,
}

impl Sixteen {
    /// By the sides of their corners: where these are the same, it is what the microtriangle is if it has a single side.
    #[inline(always)]
    fn by_corners([above, below]: [u16; 2]) -> Self {
        Self {
            opaque: all_corners(above),
            transparent: all_corners(below),
            mixed: any_corner(above) & any_corner(below),
        }
    }

    fn set(&mut self, k: usize, classification: Option<Classification>) {
        let bit = 1 << k;
        self.opaque &= !bit;
        self.transparent &= !bit;
        match classification {
            Some(Classification::Opaque) => self.opaque |= bit,
            Some(Classification::Transparent) => self.transparent |= bit,
            Some(Classification::Mixed) => self.mixed |= bit,
            Some(Classification::Undecided) | None => {}
        }
    }

    /// Two bits for each in the order of the curve.
    fn in_order(self, spot: Spot) -> u32 {
        let open = !(self.opaque | self.transparent | self.mixed);
        let codes = spread(self.opaque | open) | spread(self.mixed | open) << 1;
        let places = &PLACES[usize::from(spot.order) % 12];
        (0..).zip(places).fold(0, |word, (k, &place)| word | (codes >> (2 * place) & 3) << (2 * k))
    }
}

/// The places of the bits that are 1.
pub(crate) struct Bits(pub(crate) u32);

impl Iterator for Bits {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        if self.0 == 0 {
            return None;
        }
        let place = self.0.trailing_zeros();
        self.0 &= self.0 - 1;
        Some(place as usize)
    }
}

/// What cells show of the sixteen, a bit for each: which have two sides, of which rounding decides, and of which edges were looked at.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    mixed: u16,
    unsure: u16,
    edges: u16,
}

impl Seen {
    /// Adds the least value on the edges of number `k` in a cell.
    fn add(&mut self, k: usize, least: f32) {
        self.edges |= 1 << k;
        self.mixed |= u16::from(least < -2.0 * MARGIN) << k;
        self.unsure |= u16::from((-2.0 * MARGIN..=MARGIN).contains(&least)) << k;
    }
}

impl Patch {
    /// What is certain of the microtriangles two levels below `spot`, two bits for each in the order of the curve: 0 transparent,
    /// 1 opaque, 2 mixed, 3 not known. `None` if they see too many texels. The tile stays there.
    pub(crate) fn sixteen(&mut self, surface: &Surface<'_>, spot: Spot) -> Option<u32> {
        let cells = self.grid.cells(spot, 2);
        if !self.linear || !self.tile.load(surface, &self.window, cells) {
            return None;
        }
        let mut found = Sixteen::by_corners(self.tile.sides(spot, &self.corners));
        let same = found.opaque | found.transparent;
        let mut unsure = !(same | found.mixed);
        let seen = self.by_cells(spot, cells, found.opaque, same);
        found.mixed |= seen.mixed;
        unsure |= seen.unsure;
        for k in Bits((seen.edges & !(seen.mixed | seen.unsure)).into()) {
            match self.contains_other(self.leaf_at(spot, k), found.opaque >> k & 1 == 1) {
                Some(true) => found.mixed |= 1 << k,
                Some(false) => {}
                None => unsure |= 1 << k,
            }
        }
        found.opaque &= !(found.mixed | unsure);
        found.transparent &= !(found.mixed | unsure);
        for k in Bits(unsure.into()) {
            let leaf = self.leaf_at(spot, k);
            found.set(k, self.leaf(surface, leaf));
        }
        Some(found.in_order(spot))
    }

    /// What the cells show of those of `same`, whose corners are all `above` or all not.
    ///
    /// Cells with texels of one side are not looked at: if a microtriangle has points in one of the wrong side, the surface changes sides
    /// between there and a corner, within the microtriangle and in a cell that has texels of both.
    #[inline(always)]
    fn by_cells(&mut self, spot: Spot, cells: Cells, above: u16, same: u16) -> Seen {
        let Cells { left, right, top, bottom } = cells;
        self.placed.set(&self.boxes, spot, &self.tile);
        let boxes = &self.placed;
        let mut seen = Seen::default();
        let mut open = same;
        for row in top..=bottom {
            let in_row = boxes.touching(1, row - top);
            let mut columns = self.window.mixed_cells(left, right, row);
            while columns != 0 {
                let column = columns.trailing_zeros();
                columns &= columns - 1;
                let touching = open & in_row & boxes.touching(0, column - left);
                if touching == 0 {
                    continue;
                }
                let cell = self.tile.cell(column, row);
                for k in Bits(touching.into()) {
                    let above = above >> k & 1 == 1;
                    if !boxes.is_one_sided(k, &cell, above) {
                        seen.add(k, self.edges.at(self.leaf_at(spot, k), self.tile.base).least(&cell, above));
                        open &= !(seen.mixed | seen.unsure);
                    }
                }
            }
        }
        seen
    }

    /// One of the sixteen below `spot` by its number.
    #[inline]
    fn leaf_at(&self, spot: Spot, number: usize) -> Spot {
        self.one_of_sixteen(spot, NUMBERS[usize::from(spot.order) % 12][number % 16].into())
    }

    /// One of the sixteen below `spot`, in the order of the curve.
    #[inline]
    pub(crate) fn one_of_sixteen(&self, spot: Spot, which: usize) -> Spot {
        self.grid.leaf(spot, spot.leaves()[which % 16])
    }
}

#[cfg(test)]
mod tests {
    use omm_model::curve::MicroTriangle;
    use omm_model::level::SubdivisionLevel;

    use super::*;
    use crate::classify::Node;
    use crate::planes::Planes;
    use crate::sampler::{AddressMode, Filter, Sampler};
    use crate::texel_triangle::TexelTriangle;
    use crate::texture::Texture;

    /// What is certain is what the scan finds, for bytes and floats, cutoffs between texels and at them, within the texture and over its
    /// edge; and mostly it is certain.
    #[test]
    fn answers_are_those_of_the_scan() {
        let values: Vec<u8> = (0..1600_u32).map(|k| (k / 40 * 23 % 251 + k % 40 * 31 % 199) as u8).collect();
        let floats = values.iter().map(|&value| f32::from(value) / 255.0).collect();
        let level = SubdivisionLevel::new(4).unwrap();
        let (mut certain, mut all, mut counts) = (0, 0, [0; 4]);
        for texture in [Texture::unorm8(40, 40, values).unwrap(), Texture::fp32(40, 40, floats).unwrap()] {
            for cutoff in [0.4, 0.7, 102.0 / 255.0] {
                let surface =
                    Surface::new(&texture, Sampler::new(AddressMode::Mirror, Filter::Linear, 0.0), cutoff).unwrap();
                let planes = Planes::new(&surface);
                for uvs in [
                    [[0.1, 0.1], [0.93, 0.3], [0.2, 0.9]],
                    [[0.1, 0.1], [0.2, 0.9], [0.93, 0.3]],
                    [[0.7, 0.8], [1.6, 1.1], [0.6, 1.7]],
                    [[0.1, 0.1], [0.3, 0.1], [0.1, 0.3]],
                ] {
                    let triangle = TexelTriangle::new(uvs, &texture).unwrap();
                    let mut patch = Patch::new();
                    let weights = MicroTriangle::ROOT
                        .corners()
                        .map(|corner| omm_model::curve::Corner { u: 16 * corner.u, v: 16 * corner.v });
                    let mut spots =
                        vec![patch.load(&surface, &planes, &triangle, Node { weights, level }, 16).unwrap()];
                    for size in [3, 2] {
                        spots =
                            spots.iter().flat_map(|&s| [0, 1, 2, 3].map(|which| patch.part(s, size, which))).collect();
                    }
                    for spot in spots {
                        let found = patch.sixteen(&surface, spot).unwrap();
                        for which in 0..16 {
                            let leaf = patch.one_of_sixteen(spot, which);
                            let code = found >> (2 * which) & 3;
                            let expected =
                                match (Node { weights: patch.weights(leaf), level }).scan(&surface, &triangle) {
                                    Classification::Transparent => 0,
                                    Classification::Opaque => 1,
                                    Classification::Mixed | Classification::Undecided => 2,
                                };
                            all += 1;
                            certain += usize::from(code != 3);
                            counts[code as usize] += 1;
                            assert!(code == 3 || code == expected, "{code} {expected} {leaf:?} {uvs:?} {cutoff}");
                        }
                    }
                }
            }
        }
        assert!(certain > all * 9 / 10, "{certain} of {all}");
        assert!(counts.into_iter().take(3).all(|count| count > all / 50), "{counts:?}");
    }
}
