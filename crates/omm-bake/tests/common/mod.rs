//! What tests of whole bakes share.

#![allow(dead_code, unreachable_pub)]

use omm_bake::{BakeInput, BakeOptions, BakeOutput, LevelChoice, Texture, bake};
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;
use omm_model::special_index::TriangleMap;

/// A small generator of numbers, always the same for a seed.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        // splitmix64
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    pub fn below(&mut self, end: u64) -> u64 {
        self.next() % end
    }
    pub fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len() as u64) as usize]
    }
    /// In 0..1.
    pub fn unit(&mut self) -> f32 {
        self.below(1 << 24) as f32 / (1 << 24) as f32
    }
}

pub fn level(level: u32) -> SubdivisionLevel {
    SubdivisionLevel::new(level).unwrap()
}

pub fn uniform(of: u32) -> BakeOptions {
    BakeOptions { level: LevelChoice::Uniform(level(of)), ..BakeOptions::default() }
}

/// Discs of different sizes on `size` x `size` texels.
pub fn discs(size: u32, seed: u64, count: usize) -> Texture {
    let mut random = Random(seed);
    let discs: Vec<[f32; 3]> = (0..count).map(|_| [random.unit(), random.unit(), 0.02 + 0.1 * random.unit()]).collect();
    let value = |k: u32| {
        let at = |k: u32| (k as f32 + 0.5) / size as f32;
        let (x, y) = (at(k % size), at(k / size));
        let inside = |[u, v, r]: &[f32; 3]| r - ((x - u).powi(2) + (y - v).powi(2)).sqrt();
        let nearest = discs.iter().map(inside).fold(f32::MIN, f32::max);
        (nearest * size as f32 * 64.0 + 128.0).clamp(0.0, 255.0) as u8
    };
    Texture::unorm8(size, size, (0..size * size).map(value).collect()).unwrap()
}

/// `count` triangles of about `side` of the texture, anywhere in it, and their vertices.
pub fn mesh(seed: u64, count: u32, side: f32) -> (Vec<[f32; 2]>, Vec<[u32; 3]>) {
    let mut random = Random(seed);
    let mut uvs = Vec::new();
    for _ in 0..count {
        let [u, v] = [random.unit(), random.unit()];
        let mut near = |corner: [f32; 2]| [u + side * (corner[0] + 0.2 * random.unit()), v + side * corner[1]];
        uvs.extend([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(&mut near));
    }
    (uvs, (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect())
}

pub fn run(input: &BakeInput<'_>, options: &BakeOptions) -> BakeOutput {
    bake(input, options, &|_| {}).unwrap()
}

/// The level of a triangle of the mesh and its states; one if a special index says all.
pub fn states(output: &BakeOutput, triangle: usize) -> (Option<SubdivisionLevel>, Vec<OpacityState>) {
    match output.triangle_maps().nth(triangle).unwrap() {
        TriangleMap::SpecialIndex(special) => (None, vec![special.state()]),
        TriangleMap::Triangle(index) => {
            let block = output.triangles[index as usize];
            let data = &output.array[block.data_range().start as usize..block.data_range().end as usize];
            let states = 0..block.subdivision_level.microtriangles();
            let states = states.map(|index| block.format.state(data, index.into()).unwrap()).collect();
            (Some(block.subdivision_level), states)
        }
    }
}

/// The states of a triangle, as many as `level` has.
pub fn states_at(output: &BakeOutput, triangle: usize, level: SubdivisionLevel) -> Vec<OpacityState> {
    match states(output, triangle) {
        (None, state) => vec![state[0]; level.microtriangles() as usize],
        (Some(found), states) => {
            assert_eq!(found, level);
            states
        }
    }
}
