//! A few texels of a surface as bits: what a small part of a mesh triangle sees, in a frame of its own.

use crate::planes::Planes;
use crate::sampler::Axis;
use crate::surface::Surface;

/// Columns and rows of a window.
pub(crate) const SIDE: u32 = u64::BITS;

/// A square of up to 64 x 64 texels, address modes resolved, as bits: whether each is above the cutoff.
#[derive(Clone, Debug)]
pub(crate) struct Window {
    /// The texel coordinates of its first column and row.
    base: [i64; 2],
    /// Whether it lies in the texture, where texel coordinates are texels.
    inside: bool,
    height: u32,
    /// For runs of 1, 2 and 4 rows from each row on: columns in which one is above, and in which one is not.
    above: [[u64; SIDE as usize]; 3],
    below: [[u64; SIDE as usize]; 3],
}

impl Window {
    pub(crate) fn new() -> Self {
        let empty = [[0; SIDE as usize]; 3];
        Self { base: [0; 2], inside: false, height: 0, above: empty, below: empty }
    }

    /// Moves the window to the texels from `base` on, `width` columns and `height` rows, `1..=SIDE` each.
    pub(crate) fn load(&mut self, surface: &Surface<'_>, planes: &Planes, base: [i64; 2], width: u32, height: u32) {
        let within =
            |axis: &Axis, start: i64, length: u32| start >= 0 && start + i64::from(length) <= axis.size().into();
        let (columns, rows) = (surface.columns(), surface.rows());
        self.base = base;
        self.height = height.min(SIDE);
        self.inside = within(columns, base[0], width) && within(rows, base[1], height);
        let lines = self.above[0].iter_mut().zip(&mut self.below[0]).take(self.height as usize);
        if self.inside {
            for (row, (above, below)) in (base[1] as u32..).zip(lines) {
                *above = planes.bits(row, base[0] as u32);
                *below = !*above;
            }
        } else {
            let border = surface.border() > surface.threshold();
            let mut texels = [None; SIDE as usize];
            for (k, texel) in (base[0]..).zip(&mut texels).take(width as usize) {
                *texel = columns.texel(k);
            }
            for (y, (above, below)) in (base[1]..).zip(lines) {
                let row = rows.texel(y);
                let bit = |column: &Option<u32>| match (column, row) {
                    (Some(column), Some(row)) => planes.bit(row, *column),
                    _ => border,
                };
                *above =
                    texels.iter().take(width as usize).rev().fold(0, |bits, texel| bits << 1 | u64::from(bit(texel)));
                *below = !*above;
            }
        }
        for planes in [&mut self.above, &mut self.below] {
            let [one, two, four] = planes;
            join(one, two, 1);
            join(two, four, 2);
        }
    }

    /// Whether some texel in columns `left..=right` and rows `top..=bottom` of the window is above, and whether some is not.
    #[inline]
    pub(crate) fn sides(&self, left: u32, right: u32, top: u32, bottom: u32) -> (bool, bool) {
        let mask = u64::MAX << (left % SIDE) & u64::MAX >> (SIDE - 1 - right.min(SIDE - 1));
        let height = bottom + 1 - top;
        let (run, step) = match height {
            1 => (0, 1),
            2 | 3 => (1, 2),
            _ => (2, 4),
        };
        let (above, below) = (&self.above[run], &self.below[run]);
        let (mut any_above, mut any_below) = (0, 0);
        let mut row = top;
        loop {
            // The last run ends with the last row; it may overlap the one before.
            let at = (row.min(bottom + 1 - step) % SIDE) as usize;
            any_above |= above[at];
            any_below |= below[at];
            row += step;
            if row > bottom || (any_above & mask != 0 && any_below & mask != 0) {
                return (any_above & mask != 0, any_below & mask != 0);
            }
        }
    }

    /// The same for the four texels of the cell at (`x`, `y`).
    #[inline]
    pub(crate) fn cell_sides(&self, x: u32, y: u32) -> (bool, bool) {
        let (at, shift) = ((y % SIDE) as usize, x % SIDE);
        (self.above[1][at] >> shift & 3 != 0, self.below[1][at] >> shift & 3 != 0)
    }

    /// Columns of `left..=right` in which the texel of row `row` is above, or is not.
    pub(crate) fn columns_of(&self, above: bool, left: u32, right: u32, row: u32) -> u64 {
        let mask = u64::MAX << (left % SIDE) & u64::MAX >> (SIDE - 1 - right.min(SIDE - 1));
        let planes = if above { &self.above } else { &self.below };
        planes[0][(row % SIDE) as usize] & mask
    }

    /// The stored values at (`x`, `y`), (`x` + 1, `y`), (`x`, `y` + 1) and (`x` + 1, `y` + 1) of the window, all in it.
    #[inline]
    pub(crate) fn values(&self, surface: &Surface<'_>, x: u32, y: u32) -> [f64; 4] {
        let (column, row) = (self.base[0] + i64::from(x), self.base[1] + i64::from(y));
        if self.inside
            && let Some(values) = surface.texture().square(column as u32, row as u32)
        {
            return values;
        }
        let value = |x, y| surface.value(x, y);
        [value(column, row), value(column + 1, row), value(column, row + 1), value(column + 1, row + 1)]
    }
}

/// Joins the runs of `length` rows in `from` to runs of twice as many; runs that go beyond the last row are not looked at.
fn join(from: &[u64; SIDE as usize], to: &mut [u64; SIDE as usize], length: usize) {
    for ((to, first), second) in to.iter_mut().zip(from).zip(from.iter().skip(length)) {
        *to = first | second;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampler::{AddressMode, Filter, Sampler};
    use crate::texture::Texture;

    #[test]
    fn boxes_of_texels_in_all_address_modes() {
        let texture = Texture::unorm8(70, 20, (0..1400_u32).map(|k| (k * k % 61) as u8).collect()).unwrap();
        let mut window = Window::new();
        for mode in AddressMode::ALL {
            let surface = Surface::new(&texture, Sampler::new(mode, Filter::Linear, 1.0), 40.0 / 255.0).unwrap();
            let planes = Planes::new(&surface);
            for (base, width, height) in [([3, 2], 64, 17), ([6, 0], 64, 20), ([-9, -70], 40, 64), ([50, 10], 33, 21)] {
                window.load(&surface, &planes, base, width, height);
                for (left, top) in
                    (0..width - 1).step_by(7).flat_map(|left| (0..height - 1).map(move |top| (left, top)))
                {
                    for size in [1, 2, 3, 5, 9] {
                        let (right, bottom) = ((left + size).min(width - 1), (top + size).min(height - 1));
                        let at = |x: u32, y: u32| surface.is_above(base[0] + i64::from(x), base[1] + i64::from(y));
                        let all: Vec<bool> =
                            (top..=bottom).flat_map(|y| (left..=right).map(move |x| at(x, y))).collect();
                        let expected = (all.contains(&true), all.contains(&false));
                        assert_eq!(window.sides(left, right, top, bottom), expected, "{mode:?} {base:?}");
                    }
                    assert_eq!(
                        window.columns_of(true, left, left, top) != 0,
                        surface.is_above(base[0] + i64::from(left), base[1] + i64::from(top))
                    );
                    let corner = surface.value(base[0] + i64::from(left) + 1, base[1] + i64::from(top) + 1);
                    assert_eq!(window.values(&surface, left, top)[3], corner);
                }
            }
        }
    }
}
