//! What is on the edges of a microtriangle and within; the proof is with [`Patch`].

use super::cell::{Cell, lesser};
use super::grid::{Cells, EDGES, STRIDE, Spot};
use super::{ONE_SIDED, Patch, TWO_SIDED, UNSEEN, UNSURE};
use crate::classify::Classification;
use crate::surface::Surface;

impl Patch {
    /// The answer for a microtriangle whose corners are `above` or not, if it is certain.
    pub(super) fn leaf_by_edges(&mut self, surface: &Surface<'_>, spot: Spot, above: bool) -> Option<Classification> {
        let mut unsure = false;
        for (edge, ([a, b], direction)) in EDGES[spot.half()].into_iter().enumerate() {
            let cells = self.grid.edge_cells(spot, edge);
            if !self.window.has(!above, cells.left, cells.right + 1, cells.top, cells.bottom + 1) {
                continue;
            }
            match self.edge(surface, spot.at + a + b * STRIDE, direction, cells, above) {
                TWO_SIDED => return Some(Classification::Mixed),
                kind => unsure |= kind == UNSURE,
            }
        }
        match self.contains_other(spot, above) {
            Some(true) => Some(Classification::Mixed),
            Some(false) if !unsure => Some(Classification::of_side(above)),
            _ => None,
        }
    }

    /// Whether the edge from a point of the grid in one of three directions, whose ends are `above` or not, has points on the other
    /// side. It touches no other than `cells`.
    fn edge(&mut self, surface: &Surface<'_>, at: u32, direction: usize, cells: Cells, above: bool) -> u8 {
        let shift = 2 * direction + 2;
        let seen = self.seen.get(at as usize).map_or(UNSEEN, |seen| seen >> shift & 3);
        if seen != UNSEEN {
            return seen;
        }
        let kind = self.edge_kind(surface, self.point(at), direction, cells, above);
        if let Some(seen) = self.seen.get_mut(at as usize) {
            *seen |= kind << shift;
        }
        kind
    }

    /// The same by the parts of the edge in those cells that can have such points.
    fn edge_kind(&self, surface: &Surface<'_>, (x, y): (f64, f64), direction: usize, cells: Cells, above: bool) -> u8 {
        let (along_x, along_y) = (self.directions[0][direction], self.directions[1][direction]);
        let towards = if above { 1.0 } else { -1.0 };
        let mut unsure = false;
        for row in cells.top..=cells.bottom {
            let in_row = along_y.part(y, row, [0.0, 1.0]);
            let mut columns =
                self.window.cells_of(!above || !self.clear, above || !self.clear, cells.left, cells.right, row);
            while columns != 0 {
                let column = columns.trailing_zeros();
                columns &= columns - 1;
                let [from, to] = along_x.part(x, column, in_row);
                if from > to {
                    continue;
                }
                let at = |t: f64| (x + t * along_x.by, y + t * along_y.by);
                let cell = Cell::new(&self.window, surface, column, row, self.threshold);
                let least = cell.least(at(from), at(to), towards, self.margin);
                if least < -self.margin {
                    return TWO_SIDED;
                }
                unsure |= least <= self.margin;
            }
        }
        if unsure { UNSURE } else { ONE_SIDED }
    }

    /// Whether the microtriangle contains a texel centre that is on the other side; `None` if rounding decides.
    pub(super) fn contains_other(&self, spot: Spot, above: bool) -> Option<bool> {
        let Cells { left, right, top, bottom } = self.grid.cells(spot, 0);
        // A cell's own texel is its lower corner: that of the first column and row is outside of the box.
        if left == right || top == bottom || !self.window.has(!above, left + 1, right, top + 1, bottom) {
            return Some(false);
        }
        let [p, q, r] = spot.weights().map(|[a, b]| self.point(a + b * STRIDE));
        let orient = |p: (f64, f64), q: (f64, f64), x: f64, y: f64| (q.0 - p.0) * (y - p.1) - (q.1 - p.1) * (x - p.0);
        let area = orient(p, q, r.0, r.1);
        let turn = if area < 0.0 { -1.0 } else { 1.0 };
        let mut unsure = false;
        for row in top + 1..=bottom {
            let mut columns = self.window.row_of(!above, left + 1, right, row);
            while columns != 0 {
                let (x, y) = (f64::from(columns.trailing_zeros()), f64::from(row));
                columns &= columns - 1;
                let least =
                    lesser(lesser(turn * orient(p, q, x, y), turn * orient(q, r, x, y)), turn * orient(r, p, x, y));
                if least > self.orient_margin && area.abs() > self.orient_margin {
                    return Some(true);
                }
                unsure |= least >= -self.orient_margin || area.abs() <= self.orient_margin;
            }
        }
        (!unsure).then_some(false)
    }
}
