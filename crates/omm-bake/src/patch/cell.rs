//! One cell's polynomial, and the way of an edge from cell to cell; the proof is with [`Patch`](super::Patch).

use crate::surface::Surface;
use crate::window::Window;

/// The lesser of two numbers that are not NaN: `f64::min` has more cases.
pub(super) fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The greater of two numbers that are not NaN.
pub(super) fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The way of a coordinate from cell to cell.
pub(super) struct Walk {
    from: f64,
    inverse: f64,
    pub(super) cell: u32,
    /// Crossings that are still to come.
    pub(super) left: u32,
    up: bool,
    /// Where the next one is, or infinity.
    pub(super) t: f64,
}

impl Walk {
    /// From `from` to `to`; `inverse` is 1 / (`to` - `from`), and not looked at unless the ends are in different cells.
    #[inline]
    pub(super) fn new(from: f64, to: f64, inverse: f64) -> Self {
        let (cell, last) = (from as u32, to as u32);
        let mut walk = Self {
            from,
            inverse,
            cell,
            left: cell.abs_diff(last),
            up: last > cell,
            t: f64::INFINITY,
        };
        walk.set_t();
        walk
    }

    fn set_t(&mut self) {
        self.t = if self.left == 0 {
            f64::INFINITY
        } else {
            (f64::from(self.cell + u32::from(self.up)) - self.from) * self.inverse
        };
    }

    pub(super) fn step(&mut self) {
        self.left = self.left.saturating_sub(1);
        self.cell = if self.up { self.cell + 1 } else { self.cell.saturating_sub(1) };
        self.set_t();
    }
}

/// A cell's polynomial: values less the cutoff.
pub(super) struct Cell {
    x: f64,
    y: f64,
    values: [f64; 4],
}

impl Cell {
    #[inline]
    pub(super) fn new(window: &Window, surface: &Surface<'_>, x: u32, y: u32, threshold: f64) -> Self {
        let [a, b, c, d] = window.values(surface, x, y);
        let values = [a - threshold, b - threshold, c - threshold, d - threshold];
        Self { x: f64::from(x), y: f64::from(y), values }
    }

    fn twist(&self) -> f64 {
        let [d00, d10, d01, d11] = self.values;
        (d11 - d10) - (d01 - d00)
    }

    pub(super) fn value(&self, x: f64, y: f64) -> f64 {
        let [d00, d10, d01, _] = self.values;
        let (a, b) = (x - self.x, y - self.y);
        d00 + a * (d10 - d00) + b * (d01 - d00) + a * b * self.twist()
    }

    /// The least value, times `towards`, on the way between two points; where it is above `enough`, perhaps a lower bound.
    pub(super) fn least(&self, from: (f64, f64), to: (f64, f64), towards: f64, enough: f64) -> f64 {
        let (a, b) = (towards * self.value(from.0, from.1), towards * self.value(to.0, to.1));
        let bend = towards * self.twist() * (to.0 - from.0) * (to.1 - from.1);
        let end = lesser(a, b);
        let bound = end - greater(bend, 0.0) / 4.0;
        if bound > enough {
            return bound;
        }
        let rise = b - a;
        if rise.abs() < bend { lesser(end, (a + b) / 2.0 - bend / 4.0 - rise * rise / (4.0 * bend)) } else { end }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where `least` is not above what is enough it is the least of many samples, and a lower bound elsewhere.
    #[test]
    fn the_least_value_on_the_way() {
        for values in [[1.0, 0.0, 0.0, 1.0], [5.0, 1.0, 2.0, -3.0], [-1.0, 4.0, 4.0, -1.0], [2.0; 4]] {
            let cell = Cell { x: 3.0, y: 7.0, values };
            for (from, to) in [((3.0, 7.0), (4.0, 8.0)), ((3.1, 8.0), (3.9, 7.2)), ((3.5, 7.0), (3.5, 8.0))] {
                for towards in [1.0, -1.0] {
                    let sample = |k: i32| {
                        let t = f64::from(k) / 1000.0;
                        towards * cell.value(from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1))
                    };
                    let expected = (0..=1000).map(sample).fold(f64::INFINITY, f64::min);
                    let found = cell.least(from, to, towards, -100.0);
                    assert!(found <= expected + 1e-9, "{found} {expected}");
                    let exact = cell.least(from, to, towards, f64::INFINITY);
                    assert!((exact - expected).abs() < 1e-5, "{exact} {expected}");
                }
            }
        }
    }

    #[test]
    fn cells_on_the_way() {
        let mut walk = Walk::new(2.25, 4.5, 1.0 / 2.25);
        assert_eq!((walk.cell, walk.left), (2, 2));
        assert!((walk.t - 1.0 / 3.0).abs() < 1e-12);
        walk.step();
        assert!((walk.t - 7.0 / 9.0).abs() < 1e-12);
        walk.step();
        assert_eq!((walk.cell, walk.left, walk.t), (4, 0, f64::INFINITY));
        let mut back = Walk::new(3.0, 2.5, -2.0);
        assert_eq!((back.cell, back.left, back.t), (3, 1, 0.0));
        back.step();
        assert_eq!((back.cell, back.left), (2, 0));
        assert_eq!(Walk::new(1.5, 1.5, f64::INFINITY).t, f64::INFINITY);
    }
}
