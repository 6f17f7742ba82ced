//! Subdivision levels: how finely a triangle is split.

use serde::{Deserialize, Serialize};

/// How often each edge of a triangle is halved: a micromap of level *N* has 2<sup>N</sup> segments on an edge and
/// 4<sup>N</sup> microtriangles.
///
/// Closed: always in `0..=12`. Twelve is the largest level that any device may report for
/// `maxOpacity2StateSubdivisionLevel` in practice and the largest whose indices the integration guide defines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "u32", into = "u32")]
pub struct SubdivisionLevel(u8);

/// A subdivision level above [`SubdivisionLevel::MAX`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("subdivision level {found} is above {}", SubdivisionLevel::MAX)]
pub struct SubdivisionLevelError {
    /// The level that was asked for.
    pub found: u32,
}

impl SubdivisionLevel {
    /// No subdivision: one microtriangle, the triangle itself.
    pub const ZERO: Self = Self(0);
    /// The finest level, 12: 16,777,216 microtriangles.
    pub const MAX: Self = Self(12);

    /// The level `level`, if it is at most 12.
    ///
    /// # Errors
    /// [`SubdivisionLevelError`] names a level above 12.
    pub const fn new(level: u32) -> Result<Self, SubdivisionLevelError> {
        if level <= Self::MAX.0 as u32 { Ok(Self(level as u8)) } else { Err(SubdivisionLevelError { found: level }) }
    }

    /// All levels, coarsest first.
    pub fn all() -> impl DoubleEndedIterator<Item = Self> + ExactSizeIterator {
        (0..=Self::MAX.0).map(Self)
    }

    /// The level as a number, `0..=12`.
    #[must_use]
    pub const fn get(self) -> u32 {
        self.0 as u32
    }

    /// Segments on each edge: 2<sup>N</sup>.
    #[must_use]
    pub const fn segments(self) -> u32 {
        1 << self.0
    }

    /// Microtriangles: 4<sup>N</sup>.
    #[must_use]
    pub const fn microtriangles(self) -> u32 {
        1 << (2 * self.0)
    }

    /// The next finer level, unless this is the finest.
    #[must_use]
    pub const fn finer(self) -> Option<Self> {
        if self.0 < Self::MAX.0 { Some(Self(self.0 + 1)) } else { None }
    }

    /// The next coarser level, unless this is level 0.
    #[must_use]
    pub const fn coarser(self) -> Option<Self> {
        match self.0.checked_sub(1) {
            Some(level) => Some(Self(level)),
            None => None,
        }
    }
}

impl std::fmt::Display for SubdivisionLevel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl TryFrom<u32> for SubdivisionLevel {
    type Error = SubdivisionLevelError;
    fn try_from(level: u32) -> Result<Self, Self::Error> {
        Self::new(level)
    }
}

impl TryFrom<u16> for SubdivisionLevel {
    type Error = SubdivisionLevelError;
    fn try_from(level: u16) -> Result<Self, Self::Error> {
        Self::new(level.into())
    }
}

impl From<SubdivisionLevel> for u32 {
    fn from(level: SubdivisionLevel) -> Self {
        level.get()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_end_at_twelve() {
        assert_eq!(SubdivisionLevel::all().len(), 13);
        assert_eq!(SubdivisionLevel::new(13), Err(SubdivisionLevelError { found: 13 }));
        assert_eq!(SubdivisionLevel::MAX.microtriangles(), 16_777_216);
        assert_eq!(SubdivisionLevel::MAX.finer(), None);
        assert_eq!(SubdivisionLevel::ZERO.coarser(), None);
        assert_eq!(SubdivisionLevel::new(13).unwrap_err().to_string(), "subdivision level 13 is above 12");
    }

    #[test]
    fn finer_and_coarser_are_inverse() {
        for level in SubdivisionLevel::all() {
            if let Some(finer) = level.finer() {
                assert_eq!(finer.coarser(), Some(level));
                assert_eq!(finer.microtriangles(), 4 * level.microtriangles());
                assert_eq!(finer.segments(), 2 * level.segments());
            }
        }
    }
}
