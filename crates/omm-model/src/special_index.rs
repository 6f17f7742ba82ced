//! Special indices: a whole triangle in one state, without any data.

use serde::{Deserialize, Serialize};

use crate::opacity::OpacityState;
use crate::vk;

/// An index that stands for one state of the whole triangle instead of naming a micromap triangle.
///
/// In an index buffer the value appears as its unsigned cast to the index type: `-1` is 255, 65535 or 4294967295.
/// See [`VkOpacityMicromapSpecialIndexKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkOpacityMicromapSpecialIndexKHR.html).
#[doc(alias = "VkOpacityMicromapSpecialIndexKHR")]
#[doc(alias = "VkOpacityMicromapSpecialIndexEXT")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum OpacityMicromapSpecialIndex {
    /// -1: every ray passes through.
    FullyTransparent,
    /// -2: every ray is stopped, no shader runs.
    FullyOpaque,
    /// -3: a shader decides; transparent if two states are forced.
    FullyUnknownTransparent,
    /// -4: a shader decides; opaque if two states are forced.
    FullyUnknownOpaque,
}

impl OpacityMicromapSpecialIndex {
    /// All four, from -1 down to -4.
    pub const ALL: [Self; 4] =
        [Self::FullyTransparent, Self::FullyOpaque, Self::FullyUnknownTransparent, Self::FullyUnknownOpaque];

    /// The enumerant's value, -1 to -4.
    #[must_use]
    pub const fn value(self) -> i32 {
        match self {
            Self::FullyTransparent => -1,
            Self::FullyOpaque => -2,
            Self::FullyUnknownTransparent => -3,
            Self::FullyUnknownOpaque => -4,
        }
    }

    /// The special index of value `value`, if it is one.
    #[must_use]
    pub const fn from_value(value: i32) -> Option<Self> {
        match value {
            -1 => Some(Self::FullyTransparent),
            -2 => Some(Self::FullyOpaque),
            -3 => Some(Self::FullyUnknownTransparent),
            -4 => Some(Self::FullyUnknownOpaque),
            _ => None,
        }
    }

    /// The state that it gives to the whole triangle.
    #[must_use]
    pub const fn state(self) -> OpacityState {
        match self {
            Self::FullyTransparent => OpacityState::Transparent,
            Self::FullyOpaque => OpacityState::Opaque,
            Self::FullyUnknownTransparent => OpacityState::UnknownTransparent,
            Self::FullyUnknownOpaque => OpacityState::UnknownOpaque,
        }
    }

    /// The special index that gives a whole triangle `state`.
    #[must_use]
    pub const fn of_state(state: OpacityState) -> Self {
        match state {
            OpacityState::Transparent => Self::FullyTransparent,
            OpacityState::Opaque => Self::FullyOpaque,
            OpacityState::UnknownTransparent => Self::FullyUnknownTransparent,
            OpacityState::UnknownOpaque => Self::FullyUnknownOpaque,
        }
    }
}

impl TryFrom<vk::OpacityMicromapSpecialIndex> for OpacityMicromapSpecialIndex {
    type Error = vk::OpacityMicromapSpecialIndex;
    /// The raw value itself is the error when it is none of the four.
    fn try_from(raw: vk::OpacityMicromapSpecialIndex) -> Result<Self, Self::Error> {
        Self::from_value(raw.0).ok_or(raw)
    }
}

impl From<OpacityMicromapSpecialIndex> for vk::OpacityMicromapSpecialIndex {
    fn from(index: OpacityMicromapSpecialIndex) -> Self {
        Self(index.value())
    }
}

/// What one entry of a geometry's micromap index buffer says about its triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum TriangleMap {
    /// The whole triangle has one state.
    SpecialIndex(OpacityMicromapSpecialIndex),
    /// The triangle reads the micromap triangle of this index; `baseTriangle` is already added.
    Triangle(u32),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_states_are_inverse() {
        for (position, index) in OpacityMicromapSpecialIndex::ALL.into_iter().enumerate() {
            assert_eq!(index.value(), -1 - i32::try_from(position).unwrap());
            assert_eq!(OpacityMicromapSpecialIndex::from_value(index.value()), Some(index));
            assert_eq!(OpacityMicromapSpecialIndex::of_state(index.state()), index);
            assert_eq!(OpacityMicromapSpecialIndex::try_from(vk::OpacityMicromapSpecialIndex::from(index)), Ok(index));
        }
        for other in [i32::MIN, -6, -5, 0, 1, 252, i32::MAX] {
            assert_eq!(OpacityMicromapSpecialIndex::from_value(other), None);
        }
    }
}
