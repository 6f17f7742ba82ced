//! In which order blocks lie in the array.

use omm_model::format::OpacityMicromapFormat;
use serde::{Deserialize, Serialize};

use crate::packed::spread;
use crate::sampler::{AddressMode, Sampler};
use crate::schedule::{Job, Source};
use crate::surface::floor;
use crate::texture::Texture;

/// In which order blocks lie in the array.
///
/// The finest level always comes first, and 4-state before 2-state data within a level. So sizes never grow, and as all are powers of
/// two each block is aligned to its own size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BlockOrder {
    /// Blocks that lie close together in the texture lie close together in the array: by the Morton code of the texel at the triangle's centroid.
    /// What is close in the texture often is in the world, and then a cache serves the next ray.
    #[default]
    Spatial,
    /// By the first triangle of the mesh that uses them.
    Mesh,
}

impl BlockOrder {
    /// What jobs are sorted by; equal ones stay in the order of the mesh. Those that cannot be baked come last.
    pub(crate) fn key(self, job: &Job, texture: &Texture, sampler: Sampler) -> u64 {
        let coarseness = 12 - u64::from(job.level.get());
        let two_state = u64::from(job.format == OpacityMicromapFormat::TwoState);
        let place = match (job.source, self) {
            (Source::Uniform(_), _) => u64::from(u32::MAX) + 1,
            (Source::Texels, Self::Mesh) => 0,
            (Source::Texels, Self::Spatial) => place(job.uvs, texture, sampler).into(),
        };
        (coarseness << 1 | two_state) << 33 | place
    }
}

/// The Morton code of the texel at the centroid, in steps of a 2^-16th of the texture.
fn place(uvs: [[f32; 2]; 3], texture: &Texture, sampler: Sampler) -> u32 {
    let code = |axis: usize, mode: AddressMode, size: u32| {
        let centre = uvs.iter().map(|uv| f64::from(uv[axis])).sum::<f64>() / 3.0;
        // Coordinates that can be baked are below 2^30; what lies in a border belongs to the nearest texel.
        let at = floor(centre * f64::from(size));
        let texel = mode.texel(at, size).or_else(|| AddressMode::Clamp.texel(at, size)).unwrap_or_default();
        // A texel is below the size, so 16 bits are left.
        spread(((u64::from(texel) << 16) / u64::from(size)) as u16)
    };
    code(0, sampler.address_mode_u, texture.width()) | code(1, sampler.address_mode_v, texture.height()) << 1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quarters of the texture, and within them quarters again, each row by row.
    #[test]
    fn places_follow_the_z() {
        let texture = Texture::unorm8(4, 4, vec![0; 16]).unwrap();
        let at = |x: u8, y: u8| {
            let [u, v] = [x, y].map(|k| (f32::from(k) + 0.5) / 4.0);
            place([[u, v]; 3], &texture, Sampler::default()) >> 28
        };
        let found: Vec<_> = (0..4).flat_map(|y| (0..4).map(move |x| at(x, y))).collect();
        assert_eq!(found, [0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15]);
        assert_eq!(at(0, 0), at(4, 8), "a period further on");
    }
}
