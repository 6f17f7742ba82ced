//! A few texels of a surface as bits: what a small part of a mesh triangle sees, in a frame of its own.

use crate::planes::Planes;
use crate::sampler::Axis;
use crate::surface::Surface;

/// Columns and rows of a window.
pub(crate) const SIDE: u32 = u64::BITS;

/// Runs of 1, 2 and 4 rows.
const RUNS: usize = 3;

/// For each row, the columns in which some texel of the run of rows that starts there is above, and in which some is not.
type Run = [[u64; 2]; SIDE as usize];

/// A square of up to 64 x 64 texels, address modes resolved, as bits: whether each is above the cutoff.
#[derive(Clone, Debug)]
pub(crate) struct Window {
    /// The texel coordinates of its first column and row.
    base: [i64; 2],
    /// Whether it lies in the texture, where texel coordinates are texels.
    inside: bool,
    runs: [Run; RUNS],
}

impl Window {
    pub(crate) fn new() -> Self {
        Self { base: [0; 2], inside: false, runs: [[[0; 2]; SIDE as usize]; RUNS] }
    }

    /// Moves the window to the texels from `base` on, `width` columns and `height` rows, `1..=SIDE` each.
    pub(crate) fn load(&mut self, surface: &Surface<'_>, planes: &Planes, base: [i64; 2], width: u32, height: u32) {
        let within =
            |axis: &Axis, start: i64, length: u32| start >= 0 && start + i64::from(length) <= axis.size().into();
        let (columns, rows) = (surface.columns(), surface.rows());
        let height = height.min(SIDE) as usize;
        self.base = base;
        self.inside = within(columns, base[0], width) && within(rows, base[1], height as u32);
        let [one, two, four] = &mut self.runs;
        let lines = one.iter_mut().take(height).map(|[above, _]| above);
        if self.inside {
            planes.load(base[1] as u32, base[0] as u32, lines);
        } else {
            let border = surface.border() > surface.threshold();
            let mut texels = [None; SIDE as usize];
            for (k, texel) in (base[0]..).zip(&mut texels).take(width as usize) {
                *texel = columns.texel(k);
            }
            for (y, above) in (base[1]..).zip(lines) {
                let row = rows.texel(y);
                let bit = |column: &Option<u32>| match (column, row) {
                    (Some(column), Some(row)) => planes.bit(row, *column),
                    _ => border,
                };
                *above =
                    texels.iter().take(width as usize).rev().fold(0, |bits, texel| bits << 1 | u64::from(bit(texel)));
            }
        }
        for [above, below] in one.iter_mut().take(height) {
            *below = !*above;
        }
        join::<1>(one, two);
        join::<2>(two, four);
    }

    /// Whether some texel in columns `left..=right` and rows `top..=bottom` of the window is above, and whether some is not.
    #[inline]
    pub(crate) fn sides(&self, left: u32, right: u32, top: u32, bottom: u32) -> (bool, bool) {
        let mask = columns(left, right);
        let [above, below] = self.columns_of(top, bottom);
        (above & mask != 0, below & mask != 0)
    }

    /// Whether some texel in columns `left..=right` and rows `top..=bottom` is above, or is not.
    #[inline]
    pub(crate) fn has(&self, above: bool, left: u32, right: u32, top: u32, bottom: u32) -> bool {
        self.columns_of(top, bottom)[usize::from(!above)] & columns(left, right) != 0
    }

    /// The columns in which some texel of rows `top..=bottom` is above, and in which some is not.
    #[inline]
    fn columns_of(&self, top: u32, bottom: u32) -> [u64; 2] {
        let height = bottom + 1 - top;
        // The longest run that is not longer, of 1, 2 or 4 rows.
        let run = u32::from(height > 1) + u32::from(height > 3);
        let (of_run, length) = (&self.runs[run as usize], 1 << run);
        let at = |row: u32| of_run[(row % SIDE) as usize];
        let join = |a: [u64; 2], b: [u64; 2]| [a[0] | b[0], a[1] | b[1]];
        // The last run ends with the last row; it may overlap the first.
        let mut found = join(at(top), at(bottom + 1 - length));
        let mut row = top + length;
        while row + length <= bottom {
            found = join(found, at(row));
            row += length;
        }
        found
    }

    /// The same for the four texels of the cell at (`x`, `y`).
    #[inline]
    pub(crate) fn cell_sides(&self, x: u32, y: u32) -> (bool, bool) {
        let (at, shift) = ((y % SIDE) as usize, x % SIDE);
        let [above, below] = self.runs[1][at];
        (above >> shift & 3 != 0, below >> shift & 3 != 0)
    }

    /// Columns of `left..=right` in which the texel of row `row` is above, or is not.
    pub(crate) fn row_of(&self, above: bool, left: u32, right: u32, row: u32) -> u64 {
        self.runs[0][(row % SIDE) as usize][usize::from(!above)] & columns(left, right)
    }

    /// The cells of `left..=right` in row `row` in which some texel is above, if `above`, or some is not, if `below`.
    #[inline]
    pub(crate) fn cells_of(&self, above: bool, below: bool, left: u32, right: u32, row: u32) -> u64 {
        let [texels_above, texels_below] = self.runs[1][(row % SIDE) as usize];
        let texels = if above { texels_above } else { 0 } | if below { texels_below } else { 0 };
        (texels | texels >> 1) & columns(left, right)
    }

    /// The cells of `left..=right` in row `row` in which some texel is above and some is not.
    #[inline]
    pub(crate) fn mixed_cells(&self, left: u32, right: u32, row: u32) -> u64 {
        let [above, below] = self.runs[1][(row % SIDE) as usize];
        (above | above >> 1) & (below | below >> 1) & columns(left, right)
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

    /// The values of `size` columns and rows of texels from `at` on, less the cutoff and divided by the surface's reach, into `block`;
    /// what else is in its rows is not looked at.
    #[inline]
    pub(crate) fn differences<const N: usize>(
        &self,
        surface: &Surface<'_>,
        at: [u32; 2],
        size: [u32; 2],
        block: &mut [[f32; N]],
    ) {
        let (column, row) = (self.base[0] + i64::from(at[0]), self.base[1] + i64::from(at[1]));
        let (threshold, scale) = (surface.threshold(), 1.0 / surface.reach());
        let Some(lines) = block.get_mut(..size[1] as usize) else { return };
        if self.inside && surface.texture().differences([column as u32, row as u32], threshold, scale, lines) {
            return;
        }
        for (y, line) in (row..).zip(lines) {
            for (x, difference) in (column..).zip(line).take(size[0] as usize) {
                *difference = ((surface.value(x, y) - threshold) * scale) as f32;
            }
        }
    }
}

/// The bits of columns `left..=right`.
#[inline]
fn columns(left: u32, right: u32) -> u64 {
    u64::MAX << (left % SIDE) & u64::MAX >> ((SIDE - 1 - right) % SIDE)
}

/// Joins the runs of `LENGTH` rows in `from` to runs of twice as many; runs that go beyond the last row are not looked at.
fn join<const LENGTH: usize>(from: &Run, to: &mut Run) {
    for row in 0..SIDE as usize - LENGTH {
        let ([above, below], [next_above, next_below]) = (from[row], from[row + LENGTH]);
        to[row] = [above | next_above, below | next_below];
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
                    for size in [0, 1, 2, 3, 5, 9, 14, 30] {
                        let (right, bottom) = ((left + size).min(width - 1), (top + size).min(height - 1));
                        let at = |x: u32, y: u32| surface.is_above(base[0] + i64::from(x), base[1] + i64::from(y));
                        let all: Vec<bool> =
                            (top..=bottom).flat_map(|y| (left..=right).map(move |x| at(x, y))).collect();
                        let expected = (all.contains(&true), all.contains(&false));
                        assert_eq!(window.sides(left, right, top, bottom), expected, "{mode:?} {base:?}");
                        assert_eq!(window.has(false, left, right, top, bottom), expected.1);
                    }
                    assert_eq!(
                        window.row_of(true, left, left, top) != 0,
                        surface.is_above(base[0] + i64::from(left), base[1] + i64::from(top))
                    );
                    let corner = surface.value(base[0] + i64::from(left) + 1, base[1] + i64::from(top) + 1);
                    assert_eq!(window.values(&surface, left, top)[3], corner);
                }
            }
        }
    }
}
