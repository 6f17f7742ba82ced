//! Which unknown state a mixed microtriangle gets.

use omm_model::opacity::OpacityState;
use serde::{Deserialize, Serialize};

use crate::classify::Classification;
use crate::texel_triangle::Corners;

/// Which unknown state a microtriangle gets that is neither transparent nor opaque.
///
/// In 2-state data the unknown state becomes the one that its name ends in.
#[doc(alias = "unknown_state_promotion")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum UnknownStatePromotion {
    /// Unknown opaque if at least half of the microtriangle is opaque by an estimate, else unknown transparent.
    ///
    /// The estimate takes the centroids of the 16 triangles that the microtriangle is two more levels down, and evaluates the surface
    /// there in `f64`: at least 8 of them must be above the cutoff.
    #[default]
    Nearest,
    /// Always unknown opaque.
    ForceOpaque,
    /// Always unknown transparent.
    ForceTransparent,
}

impl UnknownStatePromotion {
    /// The state for `classification`; `mostly_opaque` is asked only if it matters.
    pub(crate) fn state(self, classification: Classification, mostly_opaque: impl FnOnce() -> bool) -> OpacityState {
        match (classification, self) {
            (Classification::Transparent, _) => OpacityState::Transparent,
            (Classification::Opaque, _) => OpacityState::Opaque,
            (_, Self::ForceOpaque) => OpacityState::UnknownOpaque,
            (_, Self::ForceTransparent) => OpacityState::UnknownTransparent,
            (_, Self::Nearest) if mostly_opaque() => OpacityState::UnknownOpaque,
            (_, Self::Nearest) => OpacityState::UnknownTransparent,
        }
    }
}

/// The centroids of the triangles two levels down: weights of the second and the third corner, in twelfths. In an order
/// in which the first say much.
pub(crate) const SAMPLES: [[f64; 2]; 16] = [
    [5.0, 5.0],
    [1.0, 1.0],
    [10.0, 1.0],
    [1.0, 10.0],
    [4.0, 4.0],
    [5.0, 2.0],
    [2.0, 5.0],
    [7.0, 1.0],
    [1.0, 7.0],
    [4.0, 7.0],
    [7.0, 4.0],
    [2.0, 2.0],
    [8.0, 2.0],
    [2.0, 8.0],
    [4.0, 1.0],
    [1.0, 4.0],
];

/// Whether at least half of the samples of a microtriangle are opaque; `is_above` evaluates the surface.
pub(crate) fn mostly_opaque(corners: &Corners, is_above: impl Fn(f64, f64) -> bool) -> bool {
    let mix = |of: &[f64; 3], p: f64, q: f64| (of[0] * (12.0 - p - q) + of[1] * p + of[2] * q) / 12.0;
    let half = SAMPLES.len() / 2;
    let mut opaque = 0;
    for (seen, &[p, q]) in SAMPLES.iter().enumerate() {
        opaque += usize::from(is_above(mix(&corners.x, p, q), mix(&corners.y, p, q)));
        // The others cannot change the answer.
        if opaque == half {
            return true;
        }
        if seen + 1 - opaque > half {
            return false;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use omm_model::curve::MicroTriangle;
    use omm_model::level::SubdivisionLevel;

    use super::*;
    use crate::sampler::{AddressMode, Filter, Sampler};
    use crate::surface::Surface;
    use crate::texel_triangle::TexelTriangle;
    use crate::texture::Texture;

    #[test]
    fn unknown_states() {
        // Opaque left of the middle: the triangle's right angle is there.
        let texture = Texture::unorm8(2, 1, vec![255, 0]).unwrap();
        let sampler = Sampler::new(AddressMode::Clamp, Filter::Nearest, 0.0);
        let surface = Surface::new(&texture, sampler, 0.5).unwrap();
        let state = |promotion: UnknownStatePromotion, classification, right: f32| {
            let triangle = TexelTriangle::new([[0.0, 0.0], [right, 0.0], [0.0, 1.0]], &texture).unwrap();
            let corners = triangle.corners(MicroTriangle::ROOT.corners(), SubdivisionLevel::ZERO, 0.0);
            promotion.state(classification, || mostly_opaque(&corners, |x, y| surface.is_above_near(x, y)))
        };
        use OpacityState::{Opaque, Transparent, UnknownOpaque, UnknownTransparent};
        use UnknownStatePromotion::{ForceOpaque, ForceTransparent, Nearest};
        for promotion in [Nearest, ForceOpaque, ForceTransparent] {
            assert_eq!(state(promotion, Classification::Opaque, 1.0), Opaque);
            assert_eq!(state(promotion, Classification::Transparent, 1.0), Transparent);
        }
        for unknown in [Classification::Mixed, Classification::Undecided] {
            assert_eq!(state(ForceOpaque, unknown, 9.0), UnknownOpaque);
            assert_eq!(state(ForceTransparent, unknown, 1.0), UnknownTransparent);
            // 3/4 of the area is opaque with the right end at 1, 7/16 with it at 2.
            assert_eq!(state(Nearest, unknown, 1.0), UnknownOpaque);
            assert_eq!(state(Nearest, unknown, 2.0), UnknownTransparent);
        }
    }

    /// Whatever is opaque, stopping early gives what counting all samples gives.
    #[test]
    fn at_least_half_of_the_samples() {
        // The corners' weights themselves are the coordinates: x and y of a sample are p and q.
        let corners = Corners { x: [0.0, 12.0, 0.0], y: [0.0, 0.0, 12.0], epsilon: 0.0 };
        let at = |x: f64, y: f64| SAMPLES.iter().position(|&[p, q]| (p, q) == (x, y)).unwrap();
        for mask in 0..=u16::MAX {
            let found = mostly_opaque(&corners, |x, y| mask >> at(x, y) & 1 == 1);
            assert_eq!(found, mask.count_ones() >= 8, "{mask:016b}");
        }
    }

    #[test]
    fn samples_are_centroids_two_levels_down() {
        let mut expected: Vec<[f64; 2]> = MicroTriangle::all(SubdivisionLevel::new(2).unwrap())
            .map(|sample| {
                let [a, b, c] = sample.corners();
                [f64::from(a.u + b.u + c.u), f64::from(a.v + b.v + c.v)]
            })
            .collect();
        let mut found = SAMPLES.to_vec();
        let order = |a: &[f64; 2], b: &[f64; 2]| a.partial_cmp(b).unwrap();
        expected.sort_by(order);
        found.sort_by(order);
        assert_eq!(found, expected);
    }

    #[test]
    fn names_in_files() {
        let names: Vec<UnknownStatePromotion> =
            serde_json::from_str(r#"["nearest","force_opaque","force_transparent"]"#).unwrap();
        assert_eq!(names.len(), 3);
    }
}
