//! Opacity: the states of an element and the whole decision for a triangle candidate.

use serde::{Deserialize, Serialize};

/// The state of one microtriangle, or of a whole triangle by a special index.
///
/// 2-state data knows only the first two.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum OpacityState {
    /// 0: every ray passes through.
    Transparent,
    /// 1: every ray is stopped.
    Opaque,
    /// 2: a shader decides; transparent if two states are forced.
    UnknownTransparent,
    /// 3: a shader decides; opaque if two states are forced.
    UnknownOpaque,
}

impl OpacityState {
    /// All four, by value.
    pub const ALL: [Self; 4] = [Self::Transparent, Self::Opaque, Self::UnknownTransparent, Self::UnknownOpaque];

    /// The element's value in 4-state data, `0..=3`.
    #[must_use]
    pub const fn value(self) -> u8 {
        match self {
            Self::Transparent => 0,
            Self::Opaque => 1,
            Self::UnknownTransparent => 2,
            Self::UnknownOpaque => 3,
        }
    }

    /// The state of value `value`, if it is at most 3.
    #[must_use]
    pub const fn from_value(value: u8) -> Option<Self> {
        match value {
            0 => Some(Self::Transparent),
            1 => Some(Self::Opaque),
            2 => Some(Self::UnknownTransparent),
            3 => Some(Self::UnknownOpaque),
            _ => None,
        }
    }

    /// Whether no shader is needed: [`Transparent`](Self::Transparent) or [`Opaque`](Self::Opaque).
    #[must_use]
    pub const fn is_known(self) -> bool {
        matches!(self, Self::Transparent | Self::Opaque)
    }

    /// The state that remains when two states are forced: each unknown becomes what its name ends in.
    #[must_use]
    pub const fn to_two_state(self) -> Self {
        match self {
            Self::Transparent | Self::UnknownTransparent => Self::Transparent,
            Self::Opaque | Self::UnknownOpaque => Self::Opaque,
        }
    }

    /// The letter that scenarios and pictures use: `T`, `O`, `u` (unknown transparent), `U` (unknown opaque).
    #[must_use]
    pub const fn letter(self) -> char {
        match self {
            Self::Transparent => 'T',
            Self::Opaque => 'O',
            Self::UnknownTransparent => 'u',
            Self::UnknownOpaque => 'U',
        }
    }

    /// What the micromap alone makes of a candidate, before any override.
    const fn initial(self) -> OpacityResult {
        match self {
            Self::Transparent => OpacityResult::Ignored,
            Self::Opaque => OpacityResult::Opaque,
            Self::UnknownTransparent | Self::UnknownOpaque => OpacityResult::NonOpaque,
        }
    }
}

/// What traversal does with a triangle candidate once its opacity is decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum OpacityResult {
    /// The micromap says transparent: the candidate is dropped, as if nothing was hit.
    Ignored,
    /// A ray flag culls the opacity that was decided: the candidate is dropped.
    Culled,
    /// The hit is confirmed without a shader.
    Opaque,
    /// The any-hit shader, or the ray query's caller, decides.
    NonOpaque,
}

/// The instance flags that bear on opacity, of
/// [`VkGeometryInstanceFlagBitsKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkGeometryInstanceFlagBitsKHR.html).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct InstanceOpacity {
    /// `FORCE_OPAQUE`: as if every geometry were opaque.
    pub force_opaque: bool,
    /// `FORCE_NO_OPAQUE`: as if no geometry were opaque. Must not be combined with `force_opaque`; if it is, it wins here.
    pub force_no_opaque: bool,
    /// `FORCE_OPACITY_MICROMAP_2_STATE`: unknown states are read as the state their name ends in.
    pub force_two_state: bool,
    /// `DISABLE_OPACITY_MICROMAPS`: micromaps are not looked at; the geometry flag counts.
    pub disable_micromaps: bool,
}

/// The ray flags that bear on opacity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct RayOpacity {
    /// `OpaqueKHR`: what is not ignored is opaque.
    pub opaque: bool,
    /// `NoOpaqueKHR`: what is not ignored is non-opaque. Must not be combined with `opaque`; if it is, it wins here.
    pub no_opaque: bool,
    /// `CullOpaqueKHR`: opaque candidates are dropped.
    pub cull_opaque: bool,
    /// `CullNoOpaqueKHR`: non-opaque candidates are dropped.
    pub cull_no_opaque: bool,
    /// `ForceOpacityMicromap2StateEXT`: unknown states are read as the state their name ends in.
    pub force_two_state: bool,
}

/// All that decides the opacity of one triangle candidate.
///
/// [`resolve`](Self::resolve) is the decision of the chapters *Ray Opacity Micromap* and *Ray Intersection Candidate Determination*,
/// as one pure function. The order is: micromap or geometry flag; two-state override; what is transparent is ignored, and no
/// later flag brings it back; instance overrides; ray overrides; culling.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct CandidateOpacity {
    /// The state that the micromap gives at the hit, by element or special index; `None` if the geometry was built without one.
    pub micromap: Option<OpacityState>,
    /// Whether the geometry was built with `VK_GEOMETRY_OPAQUE_BIT_KHR`.
    pub geometry_opaque: bool,
    /// The flags of the instance.
    pub instance: InstanceOpacity,
    /// The flags of the ray.
    pub ray: RayOpacity,
}

impl CandidateOpacity {
    /// What traversal does with the candidate.
    #[must_use]
    pub const fn resolve(self) -> OpacityResult {
        let Self { micromap, geometry_opaque, instance, ray } = self;
        let initial = match micromap {
            Some(state) if !instance.disable_micromaps => {
                let two_state = instance.force_two_state || ray.force_two_state;
                (if two_state { state.to_two_state() } else { state }).initial()
            }
            _ if geometry_opaque => OpacityResult::Opaque,
            _ => OpacityResult::NonOpaque,
        };
        let mut opaque = match initial {
            OpacityResult::Ignored | OpacityResult::Culled => return OpacityResult::Ignored,
            OpacityResult::Opaque => true,
            OpacityResult::NonOpaque => false,
        };
        opaque = (opaque || instance.force_opaque) && !instance.force_no_opaque;
        opaque = (opaque || ray.opaque) && !ray.no_opaque;
        match opaque {
            true if ray.cull_opaque => OpacityResult::Culled,
            false if ray.cull_no_opaque => OpacityResult::Culled,
            true => OpacityResult::Opaque,
            false => OpacityResult::NonOpaque,
        }
    }
}

#[cfg(test)]
mod tests;
