//! The two formats of micromap data and how an element is read from it.

use serde::{Deserialize, Serialize};

use crate::level::SubdivisionLevel;
use crate::opacity::OpacityState;
use crate::vk;

/// How many states an element can have, and so how many bits it takes.
///
/// See [`VkOpacityMicromapFormatKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkOpacityMicromapFormatKHR.html).
#[doc(alias = "VkOpacityMicromapFormatKHR")]
#[doc(alias = "VkOpacityMicromapFormatEXT")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum OpacityMicromapFormat {
    /// One bit an element: 0 transparent, 1 opaque. Value 1.
    TwoState,
    /// Two bits an element: 0 transparent, 1 opaque, 2 unknown transparent, 3 unknown opaque. Value 2.
    FourState,
}

impl OpacityMicromapFormat {
    /// Both formats.
    pub const ALL: [Self; 2] = [Self::TwoState, Self::FourState];

    /// The enumerant's value: 1 or 2.
    #[must_use]
    pub const fn value(self) -> u16 {
        match self {
            Self::TwoState => 1,
            Self::FourState => 2,
        }
    }

    /// The format of value `value`, if there is one.
    #[must_use]
    pub const fn from_value(value: u32) -> Option<Self> {
        match value {
            1 => Some(Self::TwoState),
            2 => Some(Self::FourState),
            _ => None,
        }
    }

    /// Bits of one element: 1 or 2.
    #[must_use]
    pub const fn bits(self) -> u32 {
        self.value() as u32
    }

    /// Bytes of a micromap triangle of this format at `level`, at least one: `ceil(4^level * bits / 8)`.
    #[must_use]
    pub const fn data_size(self, level: SubdivisionLevel) -> u32 {
        (level.microtriangles() * self.bits()).div_ceil(8)
    }

    /// The state of element `index` in `data`, where elements run from the least to the most significant bit of each byte.
    ///
    /// `None` if `data` ends before that element.
    #[must_use]
    pub fn state(self, data: &[u8], index: u64) -> Option<OpacityState> {
        let bit = index.checked_mul(u64::from(self.bits()))?;
        let byte = data.get(usize::try_from(bit / 8).ok()?)?;
        let value = (byte >> (bit % 8)) & self.mask();
        OpacityState::from_value(value)
    }

    /// The low bits of an element's value: `0b1` or `0b11`.
    const fn mask(self) -> u8 {
        match self {
            Self::TwoState => 0b1,
            Self::FourState => 0b11,
        }
    }
}

impl std::fmt::Display for OpacityMicromapFormat {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::TwoState => "2-state",
            Self::FourState => "4-state",
        })
    }
}

impl TryFrom<vk::OpacityMicromapFormat> for OpacityMicromapFormat {
    type Error = vk::OpacityMicromapFormat;
    /// The raw value itself is the error when it is neither 1 nor 2.
    fn try_from(raw: vk::OpacityMicromapFormat) -> Result<Self, Self::Error> {
        u32::try_from(raw.0).ok().and_then(Self::from_value).ok_or(raw)
    }
}

impl From<OpacityMicromapFormat> for vk::OpacityMicromapFormat {
    fn from(format: OpacityMicromapFormat) -> Self {
        Self(format.value().into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_of_every_level() {
        let sizes =
            |format: OpacityMicromapFormat| SubdivisionLevel::all().map(|l| format.data_size(l)).collect::<Vec<_>>();
        let two = [1, 1, 2, 8, 32, 128, 512, 2048, 8192, 32768, 131_072, 524_288, 2_097_152];
        let four = [1, 1, 4, 16, 64, 256, 1024, 4096, 16384, 65536, 262_144, 1_048_576, 4_194_304];
        assert_eq!(sizes(OpacityMicromapFormat::TwoState), two);
        assert_eq!(sizes(OpacityMicromapFormat::FourState), four);
    }

    #[test]
    fn elements_run_from_the_least_significant_bit() {
        use OpacityState::{Opaque as O, Transparent as T, UnknownOpaque as Uo, UnknownTransparent as Ut};
        let read = |format: OpacityMicromapFormat, data: &[u8]| -> Vec<_> {
            (0..).map_while(|index| format.state(data, index)).collect()
        };
        assert_eq!(read(OpacityMicromapFormat::TwoState, &[0b1000_0101]), [O, T, O, T, T, T, T, O]);
        assert_eq!(read(OpacityMicromapFormat::FourState, &[0b1110_0100, 0b0000_0010]), [T, O, Ut, Uo, Ut, T, T, T]);
        assert_eq!(OpacityMicromapFormat::FourState.state(&[0; 4], u64::MAX), None);
    }

    #[test]
    fn raw_and_checked_agree() {
        for format in OpacityMicromapFormat::ALL {
            assert_eq!(OpacityMicromapFormat::try_from(vk::OpacityMicromapFormat::from(format)), Ok(format));
        }
        for raw in [i32::MIN, -1, 0, 3, i32::MAX].map(vk::OpacityMicromapFormat) {
            assert_eq!(OpacityMicromapFormat::try_from(raw), Err(raw));
        }
    }
}
