//! How finely each triangle is split.

use omm_model::level::SubdivisionLevel;
use serde::{Deserialize, Serialize};

use crate::texel_triangle::TexelTriangle;

/// How the subdivision level of a triangle is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LevelChoice {
    /// The same level for all triangles.
    Uniform(SubdivisionLevel),
    /// A level by the area that the triangle covers in the finest mip that is read.
    Dynamic {
        /// One microtriangle covers about `scale` x `scale` texels; finite and above 0.
        scale: f32,
        /// No triangle gets a finer level.
        max: SubdivisionLevel,
    },
}

impl LevelChoice {
    /// The level of a triangle; of one that cannot be baked if there is none.
    ///
    /// A triangle that cannot be baked has no area: under [`Dynamic`](Self::Dynamic) it has level 0.
    pub(crate) fn level(self, triangle: Option<&TexelTriangle>) -> SubdivisionLevel {
        match self {
            Self::Uniform(level) => level,
            Self::Dynamic { scale, max } => {
                triangle.map_or(SubdivisionLevel::ZERO, |t| dynamic_level(t.area(), scale, max))
            }
        }
    }
}

/// The level at which one microtriangle of a triangle that covers `area` texels covers about `scale` x `scale` of them, at most `max`.
///
/// An edge of *s* segments, *s* = sqrt(`area`) / `scale`, would give microtriangles of exactly that size; the result is the level
/// whose number of segments, 2<sup>N</sup>, is closest to *s*, and the finer one if two are equally close. So level N + 1 begins
/// where *s* reaches 1.5 * 2<sup>N</sup>. Points and lines have no area and level 0.
#[must_use]
pub fn dynamic_level(area: f64, scale: f32, max: SubdivisionLevel) -> SubdivisionLevel {
    let scale = f64::from(scale);
    let mut level = SubdivisionLevel::ZERO;
    while let Some(finer) = level.finer()
        && level < max
        // NaN compares false: no area, no level.
        && area >= 2.25 * scale * scale * f64::from(level.microtriangles())
    {
        level = finer;
    }
    level
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(level: u32) -> SubdivisionLevel {
        SubdivisionLevel::new(level).unwrap()
    }

    #[test]
    fn the_closest_number_of_segments() {
        let found = |area, scale, max| dynamic_level(area, scale, level(max)).get();
        assert_eq!(found(0.0, 2.0, 12), 0);
        assert_eq!(found(f64::NAN, 2.0, 12), 0);
        // Segments of 1.49 and 1.5 for an edge of 1 or 2.
        assert_eq!((found(1.49 * 1.49, 1.0, 12), found(1.5 * 1.5, 1.0, 12)), (0, 1));
        assert_eq!((found(11.9 * 11.9, 2.0, 12), found(12.0 * 12.0, 2.0, 12)), (2, 3));
        assert_eq!((found(1e300, 2.0, 7), found(1e300, 1e-30, 12), found(1e300, f32::MAX, 12)), (7, 12, 12));
        assert_eq!(found(1e12, 1e6, 12), 0);
    }

    /// Areas in texels and the levels that NVIDIA's OMM SDK 1.9 chose for them, from the golden jobs `dynamic2_max8`, `dynamic4_max10`
    /// and `donut_two_state`: the largest and the smallest area of each level.
    #[test]
    fn levels_of_the_golden_jobs() {
        let chosen = [
            (2.0, 32.21, 1),
            (2.0, 34.05, 1),
            (2.0, 813.56, 4),
            (2.0, 841.83, 4),
            (2.0, 6635.52, 5),
            (2.0, 10028.22, 6),
            (2.0, 10150.38, 6),
            (4.0, 813.56, 3),
            (4.0, 841.83, 3),
            (4.0, 10028.22, 5),
            (4.0, 10150.38, 5),
        ];
        for (scale, area, expected) in chosen {
            assert_eq!(dynamic_level(area, scale, level(8)).get(), expected, "{area} texels at scale {scale}");
        }
    }

    #[test]
    fn choices_in_files() {
        let text = serde_json::to_string(&[
            LevelChoice::Uniform(level(5)),
            LevelChoice::Dynamic { scale: 2.0, max: level(8) },
        ]);
        assert_eq!(text.unwrap(), r#"[{"uniform":5},{"dynamic":{"scale":2.0,"max":8}}]"#);
        assert!(serde_json::from_str::<LevelChoice>(r#"{"uniform":13}"#).is_err());
    }
}
