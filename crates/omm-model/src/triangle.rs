//! One entry of a micromap's triangle array.

use serde::{Deserialize, Serialize};

use crate::format::OpacityMicromapFormat;
use crate::level::{SubdivisionLevel, SubdivisionLevelError};
use crate::vk;

/// Where a micromap triangle's data lies and how it is to be read: the checked form of [`vk::MicromapTriangle`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct MicromapTriangle {
    /// Offset in bytes from the start of the micromap's data.
    pub data_offset: u32,
    /// Level of subdivision.
    pub subdivision_level: SubdivisionLevel,
    /// Format of the elements.
    pub format: OpacityMicromapFormat,
}

/// A field of a raw micromap triangle that has no meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MicromapTriangleError {
    /// `subdivisionLevel` is above 12.
    #[error("subdivisionLevel: {0}")]
    SubdivisionLevel(#[from] SubdivisionLevelError),
    /// `format` is neither 1 (2-state) nor 2 (4-state).
    #[error("format: {found} is neither 1 (2-state) nor 2 (4-state)")]
    Format {
        /// The value found.
        found: u16,
    },
}

impl MicromapTriangle {
    /// Bytes that the triangle's elements take.
    #[must_use]
    pub const fn data_size(self) -> u32 {
        self.format.data_size(self.subdivision_level)
    }

    /// The bytes that the triangle's elements take, counted from the start of the micromap's data.
    #[must_use]
    pub fn data_range(self) -> std::ops::Range<u64> {
        let start = u64::from(self.data_offset);
        start..start + u64::from(self.data_size())
    }
}

impl TryFrom<vk::MicromapTriangle> for MicromapTriangle {
    type Error = MicromapTriangleError;
    fn try_from(raw: vk::MicromapTriangle) -> Result<Self, Self::Error> {
        let vk::MicromapTriangle { data_offset, subdivision_level, format } = raw;
        let found = format;
        let format = OpacityMicromapFormat::from_value(found.into()).ok_or(MicromapTriangleError::Format { found })?;
        Ok(Self { data_offset, subdivision_level: subdivision_level.try_into()?, format })
    }
}

impl From<MicromapTriangle> for vk::MicromapTriangle {
    fn from(triangle: MicromapTriangle) -> Self {
        let MicromapTriangle { data_offset, subdivision_level, format } = triangle;
        // A level is at most 12.
        Self { data_offset, subdivision_level: subdivision_level.get() as u16, format: format.value() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meaningless_fields_are_named() {
        let raw = |subdivision_level, format| vk::MicromapTriangle { data_offset: 5, subdivision_level, format };
        let checked = MicromapTriangle::try_from(raw(3, 2)).unwrap();
        assert_eq!(checked.data_range(), 5..21);
        assert_eq!(vk::MicromapTriangle::from(checked), raw(3, 2));
        let text = |raw: vk::MicromapTriangle| MicromapTriangle::try_from(raw).unwrap_err().to_string();
        assert_eq!(text(raw(13, 1)), "subdivisionLevel: subdivision level 13 is above 12");
        assert_eq!(text(raw(13, 0)), "format: 0 is neither 1 (2-state) nor 2 (4-state)");
    }
}
