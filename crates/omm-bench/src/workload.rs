//! The texture and the triangles of one measurement.

use omm_model::level::SubdivisionLevel;

use crate::foliage::{self, Random};

/// One measurement's input: triangles strewn over the foliage texture, all at one level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Workload {
    /// Its name in the results.
    pub name: &'static str,
    /// Width and height of the texture in texels.
    pub texture_side: u32,
    /// How many triangles.
    pub triangles: u32,
    /// Their subdivision level.
    pub level: u32,
    /// Length of a triangle's two shorter sides in texture coordinates.
    pub uv_size: f64,
}

impl Workload {
    /// The three at which bakers are compared.
    pub const PEERS: [Self; 3] = [
        Self {
            name: "foliage 1024, 256 triangles, level 6",
            texture_side: 1024,
            triangles: 256,
            level: 6,
            uv_size: 0.1,
        },
        Self {
            name: "foliage 2048, 128 triangles, level 8",
            texture_side: 2048,
            triangles: 128,
            level: 8,
            uv_size: 0.1,
        },
        Self {
            name: "foliage 1024, 4096 triangles, level 4",
            texture_side: 1024,
            triangles: 4096,
            level: 4,
            uv_size: 0.02,
        },
    ];

    /// The same with a part of the triangles, one of `by`.
    #[must_use]
    pub const fn scaled_down(self, by: u32) -> Self {
        Self { triangles: self.triangles / by, ..self }
    }

    /// The level as the baker takes it; levels above 12 count as 12.
    #[must_use]
    pub fn subdivision_level(&self) -> SubdivisionLevel {
        SubdivisionLevel::new(self.level).unwrap_or(SubdivisionLevel::MAX)
    }

    /// Microtriangles of all triangles.
    #[must_use]
    pub fn microtriangles(&self) -> u64 {
        u64::from(self.triangles) * u64::from(self.subdivision_level().microtriangles())
    }

    /// The texture's alpha, a byte for each texel.
    #[must_use]
    pub fn alpha(&self) -> Vec<u8> {
        foliage::alpha(self.texture_side)
    }

    /// The triangles' texture coordinates, three vertices for each: right-angled ones, turned and placed at random, all within the
    /// texture.
    #[must_use]
    pub fn uvs(&self) -> Vec<[f32; 2]> {
        let mut random = Random(0x7219_0000 + u64::from(self.level));
        let mut uvs = Vec::new();
        for _ in 0..self.triangles {
            // Both legs stay within uv_size of the corner.
            let mut place = || self.uv_size + (1.0 - 2.0 * self.uv_size) * random.unit();
            let (u, v) = (place(), place());
            let (cosine, sine) = random.direction();
            let (a, b) = (self.uv_size * cosine, self.uv_size * sine);
            uvs.extend([[u, v], [u + a, v + b], [u - b, v + a]].map(|uv| uv.map(|coordinate| coordinate as f32)));
        }
        uvs
    }

    /// The triangles' indices into [`uvs`](Self::uvs).
    #[must_use]
    pub fn indices(&self) -> Vec<[u32; 3]> {
        (0..self.triangles).map(|triangle| [3 * triangle, 3 * triangle + 1, 3 * triangle + 2]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_within_the_texture() {
        for workload in Workload::PEERS {
            let uvs = workload.uvs();
            assert_eq!(uvs.len(), 3 * workload.triangles as usize);
            assert!(uvs.iter().flatten().all(|coordinate| (0.0..=1.0).contains(coordinate)));
        }
    }
}
