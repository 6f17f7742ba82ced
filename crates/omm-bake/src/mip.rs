//! Which mip levels a micromap must be true for.

use serde::{Deserialize, Serialize};

use crate::error::BakeError;
use crate::texture::Texture;

/// Which mip levels of a [`Texture`] the shader may read.
///
/// A microtriangle is opaque, or transparent, only if it is at every one of them. That also holds between two mips that a sampler
/// mixes: what is above the cutoff at both is above it in between. Where mips disagree the microtriangle is unknown, on the side
/// that it has at the finest of them.
///
/// A shader that always reads the same mip is baked best from that mip alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MipChoice {
    /// All that the texture has.
    #[default]
    All,
    /// Those from the finer `first` to the coarser `last`, both included.
    Range {
        /// The finest that is read; 0 is the texture itself.
        first: u32,
        /// The coarsest that is read.
        last: u32,
    },
}

impl MipChoice {
    /// The mips of `texture` that are read, the finest first, each with its other readings behind it. Never empty.
    pub(crate) fn of(self, texture: &Texture) -> Result<Vec<&Texture>, BakeError> {
        let count = texture.mip_count();
        let (first, last) = match self {
            Self::All => (0, count - 1),
            Self::Range { first, last } => (first, last),
        };
        if first > last || last >= count {
            return Err(BakeError::MipRange { first, last, count });
        }
        let mips = (first..=last).filter_map(|mip| texture.mip(mip));
        Ok(mips.flat_map(|mip| std::iter::once(mip).chain(mip.readings())).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_must_exist() {
        let mips = vec![Texture::unorm8(2, 1, vec![0; 2]).unwrap(), Texture::unorm8(1, 1, vec![0]).unwrap()];
        let texture = Texture::unorm8(5, 2, vec![0; 10]).unwrap().with_mips(mips).unwrap();
        let widths = |choice: MipChoice| choice.of(&texture).map(|mips| mips.iter().map(|mip| mip.width()).collect());
        assert_eq!(widths(MipChoice::All), Ok(vec![5, 2, 1]));
        assert_eq!(widths(MipChoice::Range { first: 1, last: 1 }), Ok(vec![2]));
        assert_eq!(widths(MipChoice::Range { first: 0, last: 1 }), Ok(vec![5, 2]));
        let other = Texture::unorm8(5, 2, vec![9; 10]).unwrap();
        let with_other = texture.clone().with_readings(vec![other.clone()]).unwrap();
        let widths_of =
            |choice: MipChoice| choice.of(&with_other).unwrap().iter().map(|mip| mip.width()).collect::<Vec<_>>();
        assert_eq!(widths_of(MipChoice::All), [5, 5, 2, 1]);
        assert!(other.with_readings(vec![with_other]).is_err(), "one with mips");
        for (first, last) in [(1, 0), (0, 3), (u32::MAX, u32::MAX)] {
            assert_eq!(widths(MipChoice::Range { first, last }), Err(BakeError::MipRange { first, last, count: 3 }));
        }
    }
}
