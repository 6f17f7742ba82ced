//! Usage counts: how many triangles of each level and format a micromap holds.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::format::OpacityMicromapFormat;
use crate::level::SubdivisionLevel;
use crate::triangle::MicromapTriangle;
use crate::vk;

/// How many triangles have one level and format: the checked form of [`vk::MicromapUsage`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct MicromapUsage {
    /// Number of triangles.
    pub count: u32,
    /// Their level of subdivision.
    pub subdivision_level: SubdivisionLevel,
    /// Their format.
    pub format: OpacityMicromapFormat,
}

impl From<MicromapUsage> for vk::MicromapUsage {
    fn from(usage: MicromapUsage) -> Self {
        let MicromapUsage { count, subdivision_level, format } = usage;
        Self { count, subdivision_level: subdivision_level.get(), format: format.into() }
    }
}

/// Counts `triangles` by level and format, finest level first and 4-state before 2-state within a level.
///
/// Every combination that occurs appears once. Counts beyond `u32::MAX` saturate; no triangle array is that long.
pub fn histogram(triangles: impl IntoIterator<Item = MicromapTriangle>) -> Vec<MicromapUsage> {
    let mut counts = BTreeMap::<_, u32>::new();
    for triangle in triangles {
        let count = counts.entry((triangle.subdivision_level, triangle.format)).or_default();
        *count = count.saturating_add(1);
    }
    let usage = |((subdivision_level, format), count)| MicromapUsage { count, subdivision_level, format };
    counts.into_iter().rev().map(usage).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_by_level_and_format() {
        let triangle = |level, format| MicromapTriangle {
            data_offset: 0,
            subdivision_level: SubdivisionLevel::new(level).unwrap(),
            format,
        };
        let (two, four) = (OpacityMicromapFormat::TwoState, OpacityMicromapFormat::FourState);
        let found = histogram([triangle(1, two), triangle(4, four), triangle(1, four), triangle(1, two)]);
        let found: Vec<_> = found.iter().map(|u| (u.count, u.subdivision_level.get(), u.format)).collect();
        assert_eq!(found, [(1, 4, four), (1, 1, four), (2, 1, two)]);
        assert_eq!(histogram([]), []);
    }
}
