//! The alpha surface that a shader sees: texture, sampler and cutoff together.

use std::ops::RangeInclusive;

use crate::sampler::{Axis, Filter, Sampler};
use crate::texture::Texture;

/// A texture as a sampler shows it to an alpha test: opaque where alpha is above the cutoff, transparent elsewhere.
#[derive(Clone, Debug)]
pub struct Surface<'a> {
    texture: &'a Texture,
    filter: Filter,
    /// The border's value, in the texture's stored units, exactly.
    border: f64,
    /// The cutoff in stored units, exactly: a product of 8 and 24 significant bits.
    threshold: f64,
    columns: Axis,
    rows: Axis,
    /// Whether every value that the sampler can meet is on one side of the threshold, and which.
    uniform: Option<bool>,
    /// No value that the sampler can meet is further from the threshold.
    reach: f64,
}

/// A number that a sampler or an alpha test cannot have.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// Nothing is above or below NaN.
    #[error("the alpha cutoff is NaN")]
    CutoffNan,
    /// The border must have an alpha. Checked whatever the address mode.
    #[error("the border alpha is {found}, which is not a finite number")]
    BorderNotFinite {
        /// The value given.
        found: f32,
    },
}

impl<'a> Surface<'a> {
    /// The surface of `texture` under `sampler` that a shader compares with `alpha_cutoff`.
    ///
    /// The cutoff may be any number, infinities included: above +infinity nothing is, above -infinity everything.
    ///
    /// # Errors
    /// [`SurfaceError`] if the cutoff is NaN or the border alpha is not finite.
    pub fn new(texture: &'a Texture, sampler: Sampler, alpha_cutoff: f32) -> Result<Self, SurfaceError> {
        if alpha_cutoff.is_nan() {
            return Err(SurfaceError::CutoffNan);
        }
        if !sampler.border_alpha.is_finite() {
            return Err(SurfaceError::BorderNotFinite { found: sampler.border_alpha });
        }
        let border = f64::from(sampler.border_alpha) * texture.unit();
        let threshold = f64::from(alpha_cutoff) * texture.unit();
        let [mut least, mut most] = texture.extremes();
        if sampler.shows_border() {
            [least, most] = [least.min(border), most.max(border)];
        }
        let uniform = match (least > threshold, most > threshold) {
            (true, _) => Some(true),
            (_, false) => Some(false),
            (false, true) => None,
        };
        Ok(Self {
            texture,
            filter: sampler.filter,
            border,
            threshold,
            columns: Axis::new(texture.width(), sampler.address_mode_u, sampler.filter),
            rows: Axis::new(texture.height(), sampler.address_mode_v, sampler.filter),
            uniform,
            reach: (most - threshold).abs().max((least - threshold).abs()),
        })
    }

    /// The texture.
    #[must_use]
    pub const fn texture(&self) -> &'a Texture {
        self.texture
    }

    /// The filter.
    #[must_use]
    pub const fn filter(&self) -> Filter {
        self.filter
    }

    /// Whether the surface is opaque everywhere, `Some(true)`, or transparent everywhere, `Some(false)`.
    ///
    /// Decided by the texture as a whole, and the border if the sampler shows it.
    #[must_use]
    pub const fn uniform(&self) -> Option<bool> {
        self.uniform
    }

    /// Whether the surface is opaque at (`u`, `v`), by a single evaluation in `f64`: rounding may decide close to the contour.
    /// [`classify`](crate::classify::classify) is exact. Coordinates that are not finite, or beyond the range that a
    /// [`TexelTriangle`](crate::texel_triangle::TexelTriangle) may have, are transparent.
    #[must_use]
    pub fn is_opaque_near(&self, u: f64, v: f64) -> bool {
        let (x, y) = (u * f64::from(self.texture.width()), v * f64::from(self.texture.height()));
        let limit = crate::texel_triangle::MAX_COORDINATE;
        // NaN fails the comparison.
        x.abs() <= limit && y.abs() <= limit && self.is_above_near(x - self.shift(), y - self.shift())
    }

    /// What is subtracted from u * width: integers are texel bounds for a nearest filter, texel centres for a linear one.
    pub(crate) const fn shift(&self) -> f64 {
        match self.filter {
            Filter::Nearest => 0.0,
            Filter::Linear => 0.5,
        }
    }

    pub(crate) const fn columns(&self) -> &Axis {
        &self.columns
    }

    pub(crate) const fn rows(&self) -> &Axis {
        &self.rows
    }

    pub(crate) const fn threshold(&self) -> f64 {
        self.threshold
    }

    /// No texel, and no border, is closer to the threshold.
    pub(crate) fn gap(&self) -> f64 {
        let texels = if self.texture.is_integral() {
            (self.threshold - self.threshold.floor()).min(self.threshold.ceil() - self.threshold)
        } else {
            0.0
        };
        texels.min((self.border - self.threshold).abs())
    }

    pub(crate) const fn border(&self) -> f64 {
        self.border
    }

    pub(crate) const fn reach(&self) -> f64 {
        self.reach
    }

    /// The stored value at integer texel coordinates.
    pub(crate) fn value(&self, x: i64, y: i64) -> f64 {
        match (self.columns.texel(x), self.rows.texel(y)) {
            (Some(x), Some(y)) => self.texture.stored(x, y),
            _ => self.border,
        }
    }

    /// Whether the value at integer texel coordinates is above the threshold, exactly.
    pub(crate) fn is_above(&self, x: i64, y: i64) -> bool {
        self.value(x, y) > self.threshold
    }

    /// The side on which all values at these coordinates are, if it is one. Stops at the first that differs.
    pub(crate) fn side(&self, xs: RangeInclusive<i64>, ys: RangeInclusive<i64>) -> Option<bool> {
        let side = self.is_above(*xs.start(), *ys.start());
        let same = ys.into_iter().all(|y| xs.clone().all(|x| self.is_above(x, y) == side));
        same.then_some(side)
    }

    /// Whether the surface is above the threshold at shifted texel coordinates, give or take rounding.
    pub(crate) fn is_above_near(&self, x: f64, y: f64) -> bool {
        let (column, row) = (floor(x), floor(y));
        match self.filter {
            Filter::Nearest => self.is_above(column, row),
            Filter::Linear => {
                let value = |x, y| self.value(column + x, row + y);
                let values = [value(0, 0), value(1, 0), value(0, 1), value(1, 1)];
                bilinear(values, x - column as f64, y - row as f64) > self.threshold
            }
        }
    }
}

/// The greatest integer that is not above `value`, which is within 2^62 of 0. (`f64::floor` is a call where the processor at hand is
/// not known to have it.)
pub(crate) fn floor(value: f64) -> i64 {
    let towards_zero = value as i64;
    towards_zero - i64::from(value < towards_zero as f64)
}

/// The bilinear surface between the values at (0, 0), (1, 0), (0, 1) and (1, 1), rounded.
pub(crate) fn bilinear([d00, d10, d01, d11]: [f64; 4], x: f64, y: f64) -> f64 {
    let lerp = |a: f64, b: f64, t: f64| a + (b - a) * t;
    lerp(lerp(d00, d10, x), lerp(d01, d11, x), y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampler::AddressMode;

    fn sampler(address_mode: AddressMode, filter: Filter, border_alpha: f32) -> Sampler {
        Sampler::new(address_mode, filter, border_alpha)
    }

    #[test]
    fn numbers_must_be_numbers() {
        let texture = Texture::unorm8(1, 1, vec![7]).unwrap();
        let wrap = Sampler::default();
        assert_eq!(Surface::new(&texture, wrap, f32::NAN).unwrap_err(), SurfaceError::CutoffNan);
        let border = sampler(AddressMode::Wrap, Filter::Linear, f32::INFINITY);
        let error = Surface::new(&texture, border, 0.5).unwrap_err();
        assert_eq!(error.to_string(), "the border alpha is inf, which is not a finite number");
        assert_eq!(Surface::new(&texture, wrap, f32::INFINITY).unwrap().uniform(), Some(false));
        assert_eq!(Surface::new(&texture, wrap, f32::NEG_INFINITY).unwrap().uniform(), Some(true));
    }

    /// 51 / 255 is exactly 1/5, which is less than the `f32` nearest to it; 0 and 1 are exact in both.
    #[test]
    fn the_cutoff_is_compared_exactly() {
        let texture = |value| Texture::unorm8(1, 1, vec![value]).unwrap();
        let opaque = |value, cutoff| Surface::new(&texture(value), Sampler::default(), cutoff).unwrap().uniform();
        assert!(f64::from(0.2_f32) > 0.2);
        assert_eq!(opaque(51, 0.2), Some(false));
        assert_eq!(opaque(51, 0.2_f32.next_down()), Some(true));
        assert_eq!((opaque(0, 0.0), opaque(1, 0.0), opaque(255, 1.0)), (Some(false), Some(true), Some(false)));
        assert_eq!(opaque(0, -f32::from_bits(1)), Some(true));
    }

    #[test]
    fn the_border_counts_only_where_it_shows() {
        let texture = Texture::unorm8(2, 1, vec![200, 255]).unwrap();
        let uniform =
            |mode, border| Surface::new(&texture, sampler(mode, Filter::Linear, border), 0.5).unwrap().uniform();
        assert_eq!(uniform(AddressMode::Border, 0.0), None);
        assert_eq!(uniform(AddressMode::Border, 0.6), Some(true));
        assert_eq!(uniform(AddressMode::Clamp, 0.0), Some(true));
    }

    #[test]
    fn points_between_texels() {
        let texture = Texture::unorm8(2, 1, vec![0, 255]).unwrap();
        let linear = Surface::new(&texture, sampler(AddressMode::Clamp, Filter::Linear, 0.0), 0.25).unwrap();
        assert!(!linear.is_opaque_near(0.375, 0.5) && linear.is_opaque_near(0.376, 0.5));
        let nearest = Surface::new(&texture, sampler(AddressMode::Clamp, Filter::Nearest, 0.0), 0.25).unwrap();
        assert!(!nearest.is_opaque_near(0.499, 9.0) && nearest.is_opaque_near(0.5, -9.0));
        assert!(!nearest.is_opaque_near(f64::NAN, 0.0) && !nearest.is_opaque_near(1e300, 0.0));
    }
}
