//! One cell's polynomial, and the part of an edge that is in a cell; the proofs are with [`Patch`](super::Patch) for `f64`,
//! and with [`tile`](super::tile) for `f32`.

use num_traits::Float;

use crate::surface::Surface;
use crate::window::Window;

/// The lesser of two numbers that are not NaN: `min` has more cases.
#[inline(always)]
pub(super) fn lesser<T: PartialOrd>(a: T, b: T) -> T {
    if a < b { a } else { b }
}

/// The greater of two numbers that are not NaN.
#[inline(always)]
pub(super) fn greater<T: PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

/// By how much a coordinate changes along an edge.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Change {
    pub(super) by: f64,
    /// 1 / `by`; finite, as 0 times infinity is not a number.
    inverse: f64,
}

impl Change {
    pub(super) fn new(by: f64) -> Self {
        Self { by, inverse: (1.0 / by).clamp(f64::MIN, f64::MAX) }
    }

    /// The part of `[from, to]` in which a coordinate that starts at `start` is in `cell`; none if `from` is above `to`. What ends at
    /// the bound of one cell starts there in the next.
    #[inline]
    pub(super) fn part(self, start: f64, cell: u32, [from, to]: [f64; 2]) -> [f64; 2] {
        let cell = f64::from(cell);
        let (lower, upper) = ((cell - start) * self.inverse, (cell + 1.0 - start) * self.inverse);
        [greater(from, lesser(lower, upper)), lesser(to, greater(lower, upper))]
    }
}

/// A cell's polynomial: values less the cutoff.
pub(super) struct Cell<T> {
    pub(super) x: T,
    pub(super) y: T,
    pub(super) values: [T; 4],
}

impl Cell<f64> {
    #[inline]
    pub(super) fn new(window: &Window, surface: &Surface<'_>, x: u32, y: u32, threshold: f64) -> Self {
        let [a, b, c, d] = window.values(surface, x, y);
        let values = [a - threshold, b - threshold, c - threshold, d - threshold];
        Self { x: f64::from(x), y: f64::from(y), values }
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

impl<T: Float> Cell<T> {
    #[inline(always)]
    fn twist(&self) -> T {
        let [d00, d10, d01, d11] = self.values;
        (d11 - d10) - (d01 - d00)
    }

    #[inline(always)]
    pub(super) fn value(&self, x: T, y: T) -> T {
        let [d00, d10, d01, _] = self.values;
        let (a, b) = (x - self.x, y - self.y);
        d00 + a * (d10 - d00) + b * (d01 - d00) + a * b * self.twist()
    }

    /// The least value, times `towards`, on a rectangle: ranges of positions within the cell.
    #[inline(always)]
    pub(super) fn least_within(&self, [x0, x1]: [T; 2], [y0, y1]: [T; 2], towards: T) -> T {
        let [d00, d10, d01, d11] = self.values.map(|value| towards * value);
        let at = |y: T| {
            let (left, right) = (d00 + y * (d01 - d00), d10 + y * (d11 - d10));
            lesser(left + x0 * (right - left), left + x1 * (right - left))
        };
        lesser(at(y0), at(y1))
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
    fn the_least_value_on_a_rectangle() {
        let cell = Cell { x: 3.0, y: 7.0, values: [5.0, 1.0, 2.0, -3.0] };
        for towards in [1.0, -1.0] {
            for (xs, ys) in [([0.0, 1.0], [0.0, 1.0]), ([0.25, 0.5], [0.5, 0.75]), ([0.5, 0.5], [0.25, 1.0])] {
                let grid = (0..=16).flat_map(|i| (0..=16).map(move |j| (f64::from(i) / 16.0, f64::from(j) / 16.0)));
                let at = |(p, q): (f64, f64)| {
                    cell.value(3.0 + xs[0] + p * (xs[1] - xs[0]), 7.0 + ys[0] + q * (ys[1] - ys[0]))
                };
                let expected = grid.map(|place| towards * at(place)).fold(f64::INFINITY, f64::min);
                assert!((cell.least_within(xs, ys, towards) - expected).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn parts_in_cells() {
        let all = [0.0, 1.0];
        let up = Change::new(2.0);
        assert_eq!(up.part(2.5, 2, all), [0.0, 0.25]);
        assert_eq!(up.part(2.5, 3, all), [0.25, 0.75]);
        assert_eq!(up.part(2.5, 4, all), [0.75, 1.0]);
        let down = Change::new(-0.5);
        assert_eq!(down.part(3.0, 2, all), [0.0, 1.0]);
        assert_eq!(down.part(3.0, 3, all), [0.0, 0.0]);
        assert_eq!(down.part(3.25, 2, [0.0, 0.75]), [0.5, 0.75]);
        for still in [Change::new(0.0), Change::new(1e-320), Change::new(-1e-320)] {
            assert_eq!(still.part(1.5, 1, all), all);
            let [from, to] = still.part(1.5, 2, all);
            assert!(from > to);
            // On a bound, at least one of its cells has all of it.
            assert!([0, 1].map(|cell| still.part(1.0, cell, all)).contains(&all));
        }
    }
}
