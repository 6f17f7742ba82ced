//! The classifier against the oracle on small textures on which ties are frequent.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod oracle;

use num_rational::{BigRational, Ratio};
use omm_bake::{AddressMode, Classification, Filter, Sampler, Surface, TexelTriangle, Texture, classify};
use omm_model::curve::MicroTriangle;
use omm_model::level::SubdivisionLevel;
use oracle::Scene;
use proptest::prelude::*;
use rayon::prelude::*;

/// A small generator of numbers, always the same.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        // splitmix64
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    fn below(&mut self, end: u64) -> u64 {
        self.next() % end
    }
    fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len() as u64) as usize]
    }
    /// In -1..2, any bits.
    fn coordinate(&mut self) -> f32 {
        (self.below(1 << 24) as f32 / (1 << 23) as f32) * 1.5 - 1.0
    }
}

/// One case: everything that decides the states of one triangle.
#[derive(Clone, Debug)]
struct Case {
    width: u32,
    height: u32,
    values: Vec<f64>,
    float: bool,
    sampler: Sampler,
    cutoff: f32,
    uvs: [[f32; 2]; 3],
    level: u32,
    /// Coordinates, values and cutoff have few bits.
    few_bits: bool,
}

impl Case {
    fn random(random: &mut Random) -> Self {
        let (width, height) = (1 + random.below(6) as u32, 1 + random.below(6) as u32);
        let float = random.below(4) == 0;
        let palette: &[f64] = match (float, random.below(3)) {
            (true, 0) => &[0.0, 0.5, 1.0],
            (true, _) => &[-0.5, 0.0, 0.25, 0.5, 0.75, 1.0],
            (false, 0) => &[0.0, 255.0],
            (false, 1) => &[0.0, 51.0, 127.0, 128.0, 255.0],
            (false, _) => &[0.0, 0.0, 0.0, 255.0],
        };
        let values = (0..width * height).map(|_| random.pick(palette)).collect();
        let cutoff = random.pick(&[0.5, 0.5, 0.0, 1.0, 0.25, 0.2, 127.0 / 255.0]);
        let sampler = Sampler {
            address_mode_u: random.pick(&AddressMode::ALL),
            address_mode_v: random.pick(&AddressMode::ALL),
            filter: random.pick(&[Filter::Nearest, Filter::Linear, Filter::Linear]),
            border_alpha: random.pick(&[0.0, 0.5, 1.0]),
        };
        let kind = random.below(8);
        // Multiples of a quarter texel, or of a 1/16 of the texture.
        let steps = random.pick(&[(4 * width, 4 * height), (16, 16), (2 * width, 2 * height)]);
        let grid =
            |random: &mut Random, steps: u32| (random.below(3 * u64::from(steps)) as f32 - steps as f32) / steps as f32;
        let mut uvs = [[0.0; 2]; 3].map(|_: [f32; 2]| match kind {
            0..=3 => [grid(random, steps.0), grid(random, steps.1)],
            _ => [random.coordinate(), random.coordinate()],
        });
        match kind {
            // One unit in the last place off the grid.
            3 => {
                for coordinate in uvs.iter_mut().flatten() {
                    *coordinate = random.pick(&[coordinate.next_up(), coordinate.next_down(), *coordinate]);
                }
            }
            // Around the first point, so that few cells are touched.
            5 | 6 => {
                let [u, v] = uvs[0];
                uvs = uvs.map(|[a, b]| [u + (a - u) * 0.125, v + (b - v) * 0.125]);
            }
            // Coordinates of very different size.
            7 => uvs[1] = [uvs[1][0] * 1e-20, uvs[1][1] * 1e-12],
            _ => {}
        }
        // Lines and points.
        match random.below(8) {
            0 => uvs[2] = [uvs[0][0] / 2.0 + uvs[1][0] / 2.0, uvs[0][1] / 2.0 + uvs[1][1] / 2.0],
            1 => uvs[2] = uvs[random.below(2) as usize],
            2 if random.below(2) == 0 => uvs = [uvs[0]; 3],
            _ => {}
        }
        let few_bits = kind < 3 && [4, 2, 1].contains(&width) && [4, 2, 1].contains(&height);
        Self { width, height, values, float, sampler, cutoff, uvs, level: random.pick(&[0, 0, 1, 2, 3]), few_bits }
    }

    fn texture(&self) -> Texture {
        if self.float {
            Texture::fp32(self.width, self.height, self.values.iter().map(|&v| v as f32).collect()).unwrap()
        } else {
            Texture::unorm8(self.width, self.height, self.values.iter().map(|&v| v as u8).collect()).unwrap()
        }
    }

    /// What the baker and the oracle say of one microtriangle.
    fn both(&self, index: u32) -> [Classification; 2] {
        let texture = self.texture();
        let surface = Surface::new(&texture, self.sampler, self.cutoff).unwrap();
        let level = SubdivisionLevel::new(self.level).unwrap();
        let microtriangle = MicroTriangle::new(level, index % level.microtriangles()).unwrap();
        let triangle = TexelTriangle::new(self.uvs, &texture).unwrap();
        let found = classify(&surface, &triangle, microtriangle);
        let scene = Scene {
            width: self.width.into(),
            height: self.height.into(),
            values: &self.values,
            unit: if self.float { 1.0 } else { 255.0 },
            address_modes: [self.sampler.address_mode_u, self.sampler.address_mode_v],
            filter: self.sampler.filter,
            border: self.sampler.border_alpha,
            cutoff: self.cutoff,
        };
        let weights = microtriangle.corners().map(|corner| (corner.u, corner.v));
        let expected = if self.few_bits {
            scene.classify(Scene::corners::<Ratio<i128>>(self.uvs, weights, self.level))
        } else {
            scene.classify(Scene::corners::<BigRational>(self.uvs, weights, self.level))
        };
        [found, expected]
    }
}

#[test]
fn seeded_cases_agree_with_the_oracle() {
    const CASES: u64 = 12_000;
    let counts = (0..CASES)
        .into_par_iter()
        .map(|seed| {
            let mut random = Random(seed);
            let case = Case::random(&mut random);
            let mut counts = [0_u64; 3];
            for _ in 0..2 {
                let index = random.below(1 << 24) as u32;
                let [found, expected] = case.both(index);
                assert_eq!(found, expected, "seed {seed}, microtriangle {index} of {case:?}");
                counts[match expected {
                    Classification::Transparent => 0,
                    Classification::Opaque => 1,
                    _ => 2,
                }] += 1;
            }
            counts
        })
        .reduce(|| [0; 3], |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
    let total: u64 = counts.iter().sum();
    println!(
        "{total} microtriangles agree with the oracle: {} transparent, {} opaque, {} mixed",
        counts[0], counts[1], counts[2]
    );
    assert!(total >= 20_000 && counts.iter().all(|&count| count > total / 10));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn any_case_agrees_with_the_oracle(seed: u64, index: u32) {
        let case = Case::random(&mut Random(seed));
        let [found, expected] = case.both(index);
        prop_assert_eq!(found, expected, "{:?}", case);
    }
}
