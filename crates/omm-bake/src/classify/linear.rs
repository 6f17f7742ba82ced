//! Linear filter: the scan of the cells that a microtriangle can touch.

use super::exact::ExactScan;
use super::filter::{Cell, Certainty, Edge, Interior};
use super::{Budget, Classification, EXACT_BUDGET, Node, OverBudget, Sides, cell_budget, cells};
use crate::surface::Surface;
use crate::texel_triangle::{Corners, TexelTriangle};

/// The classification of `node`.
///
/// The first pass stays in `f64`. Only if it leaves a side open that decides does the second pass evaluate the cells that left it
/// open in integers.
pub(super) fn scan(surface: &Surface<'_>, triangle: &TexelTriangle, node: Node, corners: &Corners) -> Classification {
    let scan = Scan::new(surface, corners);
    let mut seen = scan.corner_sides();
    let mut result = scan.cells(&mut seen, None);
    if result.is_ok() && (seen.above, seen.below) != (Certainty::Yes, Certainty::Yes) {
        let open = |side: Certainty| side == Certainty::Maybe;
        // A triangle has points, so at least one side is there: if the other is not, this one is all there is.
        if seen.above != Certainty::No && seen.below != Certainty::No && (open(seen.above) || open(seen.below)) {
            let certain = |side: Certainty| if open(side) { Certainty::No } else { side };
            seen = Sides { above: certain(seen.above), below: certain(seen.below) };
            result = scan.cells(&mut seen, Some(&ExactScan::new(surface, triangle, node)));
        }
    }
    match (result, seen.above, seen.below) {
        (Err(OverBudget), ..) => Classification::Undecided,
        (Ok(()), Certainty::No, Certainty::No) => Classification::Undecided,
        (Ok(()), above, Certainty::No) => Classification::of_side(above != Certainty::No),
        (Ok(()), Certainty::No, _) => Classification::Transparent,
        (Ok(()), ..) => Classification::Mixed,
    }
}

impl Sides<Certainty> {
    fn both(&self) -> bool {
        (self.above, self.below) == (Certainty::Yes, Certainty::Yes)
    }

    fn add(&mut self, other: Self) {
        self.above = self.above.max(other.above);
        self.below = self.below.max(other.below);
    }
}

struct Scan<'a> {
    surface: &'a Surface<'a>,
    corners: &'a Corners,
    interior: Interior,
    /// Values further from the cutoff than this have a certain sign.
    margin: f64,
}

impl<'a> Scan<'a> {
    fn new(surface: &'a Surface<'a>, corners: &'a Corners) -> Self {
        let margin = 128.0 * corners.epsilon * surface.reach();
        Self { surface, corners, interior: Interior::new(corners), margin }
    }

    /// The stored values at the corners of cell (`column`, `row`).
    fn values(&self, column: i64, row: i64) -> [f64; 4] {
        let value = |x, y| self.surface.value(x, y);
        [value(column, row), value(column + 1, row), value(column, row + 1), value(column + 1, row + 1)]
    }

    fn cell(&self, column: i64, row: i64, values: [f64; 4]) -> Cell {
        let bounds = |axis: &crate::sampler::Axis, k: i64| {
            [axis.lower(k).map_or(f64::NEG_INFINITY, |k| k as f64), axis.upper(k).map_or(f64::INFINITY, |k| k as f64)]
        };
        let bounds = [bounds(self.surface.columns(), column), bounds(self.surface.rows(), row)];
        Cell { bounds, values: values.map(|value| value - self.surface.threshold()) }
    }

    /// The sides that are certain at the corners of the triangle: most mixed microtriangles are decided here.
    fn corner_sides(&self) -> Sides<Certainty> {
        let mut seen = Sides::default();
        for (&x, &y) in self.corners.x.iter().zip(&self.corners.y) {
            let column = self.surface.columns().cell(x.floor() as i64);
            let row = self.surface.rows().cell(y.floor() as i64);
            let value = self.cell(column, row, self.values(column, row)).value(x, y);
            if value > self.margin {
                seen.above = Certainty::Yes;
            } else if value < -self.margin {
                seen.below = Certainty::Yes;
            }
        }
        seen
    }

    /// Adds to `seen` what the cells show, row by row, until both sides are certain. With `exact`, nothing stays open.
    fn cells(&self, seen: &mut Sides<Certainty>, exact: Option<&ExactScan<'_>>) -> Result<(), OverBudget> {
        let (mut budget, mut exact_budget) = (Budget(cell_budget(self.surface.texture())), Budget(EXACT_BUDGET));
        let epsilon = self.corners.epsilon;
        for row in cells(self.surface.rows(), self.corners.y, epsilon) {
            budget.spend()?;
            let Some([left, right]) = self.row_extent(row) else { continue };
            let column = |x: f64| self.surface.columns().cell(x.floor() as i64);
            for column in column(left - 2.0 * epsilon)..=column(right + 2.0 * epsilon) {
                if seen.both() {
                    return Ok(());
                }
                budget.spend()?;
                let values = self.values(column, row);
                let above = values.map(|value| value > self.surface.threshold());
                let news = Sides {
                    above: seen.above != Certainty::Yes && above.contains(&true),
                    below: seen.below != Certainty::Yes && above.contains(&false),
                };
                if !news.above && !news.below {
                    continue;
                }
                let mut found = self.cell_sides(column, row, values, above, news);
                if let Some(exact) = exact
                    && (found.above == Certainty::Maybe || found.below == Certainty::Maybe)
                {
                    exact_budget.spend()?;
                    let sides = exact.cell(column, row, values);
                    let certain = |side| if side { Certainty::Yes } else { Certainty::No };
                    found = Sides { above: certain(sides.above), below: certain(sides.below) };
                }
                seen.add(found);
            }
        }
        Ok(())
    }

    /// The least and the greatest x that the triangle can have in `row`, to within 2 epsilon.
    fn row_extent(&self, row: i64) -> Option<[f64; 2]> {
        let axis = self.surface.rows();
        let bounds = [
            axis.lower(row).map_or(f64::NEG_INFINITY, |k| k as f64),
            axis.upper(row).map_or(f64::INFINITY, |k| k as f64),
        ];
        let mut extent: Option<[f64; 2]> = None;
        for edge in 0..3 {
            let edge = Edge::new(self.corners, edge);
            for t in edge.part([0.0, 1.0], edge.y, bounds).into_iter().flatten() {
                let (x, _) = edge.point(t);
                extent = Some(extent.map_or([x, x], |[left, right]| [left.min(x), right.max(x)]));
            }
        }
        extent
    }

    /// The sides of `news` on the triangle's part in a cell, as far as `f64` can tell.
    fn cell_sides(
        &self,
        column: i64,
        row: i64,
        values: [f64; 4],
        above: [bool; 4],
        news: Sides<bool>,
    ) -> Sides<Certainty> {
        let cell = self.cell(column, row, values);
        let mut found = Sides::default();
        for edge in 0..3 {
            if let Some([least, most]) = cell.extremes_on_edge(self.corners, edge) {
                found.add(Sides {
                    above: Certainty::above(most, self.margin),
                    below: Certainty::above(-least, self.margin),
                });
            }
        }
        let [x, y] = cell.bounds;
        for (corner, above) in above.into_iter().enumerate() {
            let (x, y) = (x[corner % 2], y[corner / 2]);
            let open = if above {
                news.above && found.above != Certainty::Yes
            } else {
                news.below && found.below != Certainty::Yes
            };
            if open && x.is_finite() && y.is_finite() {
                let contains = self.interior.contains(x, y);
                found.add(if above {
                    Sides { above: contains, below: Certainty::No }
                } else {
                    Sides { above: Certainty::No, below: contains }
                });
            }
        }
        // The surface over a cell is between its corners: a side that none of them is on is not there. What an edge shows beyond
        // the cell's bounds with certainty is found in the cell where it is.
        let allowed = |news: bool, side: Certainty| if news { side } else { Certainty::No };
        Sides { above: allowed(news.above, found.above), below: allowed(news.below, found.below) }
    }
}
