//! The baker.

use arbitrary::{Result, Unstructured};
use num_rational::BigRational;
use omm_bake::{AddressMode, BakeInput, BakeOptions, Classification, Filter, LevelChoice, Sampler, Texture, bake};
use omm_model::curve::MicroTriangle;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;

/// The baker's own judge, which shares nothing with it.
#[allow(clippy::unwrap_used, clippy::expect_used)]
#[path = "../../omm-bake/tests/oracle/mod.rs"]
mod oracle;

use oracle::Scene;

/// One triangle on a tiny texture.
#[derive(Debug)]
struct Case {
    width: u32,
    height: u32,
    values: Vec<u8>,
    sampler: Sampler,
    cutoff: f32,
    uvs: [[f32; 2]; 3],
    level: SubdivisionLevel,
}

impl Case {
    fn made(choices: &mut Unstructured<'_>) -> Result<Self> {
        let (width, height) = (choices.int_in_range(1..=4)?, choices.int_in_range(1..=4)?);
        // Values near each other and at the cutoff, where ties are.
        let mut values = Vec::new();
        for _ in 0..width * height {
            values.push(*choices.choose(&[0, 51, 127, 128, 255])?);
        }
        let sampler = Sampler {
            address_mode_u: *choices.choose(&AddressMode::ALL)?,
            address_mode_v: *choices.choose(&AddressMode::ALL)?,
            filter: *choices.choose(&[Filter::Nearest, Filter::Linear])?,
            border_alpha: *choices.choose(&[0.0, 0.5, 1.0])?,
        };
        let cutoff = *choices.choose(&[0.5, 0.0, 1.0, 0.25, 0.2, 127.0 / 255.0])?;
        let mut uvs = [[0.0; 2]; 3];
        for coordinate in uvs.iter_mut().flatten() {
            *coordinate = match choices.int_in_range(0..=3)? {
                0 => f32::from(choices.int_in_range(-16_i8..=32)?) / 16.0,
                1 => (f32::from(choices.int_in_range(-16_i8..=32)?) / 16.0).next_up(),
                // Sixteenths of a texel, of a texture of three.
                2 => f32::from(choices.int_in_range(-48_i8..=96)?) / 48.0,
                _ => f32::from(choices.arbitrary::<i16>()?) / f32::from(i16::MAX),
            };
        }
        let level = SubdivisionLevel::new(choices.int_in_range(0..=2)?).unwrap_or(SubdivisionLevel::ZERO);
        Ok(Self { width, height, values, sampler, cutoff, uvs, level })
    }
}

/// Each microtriangle is what exact arithmetic says: opaque or transparent if all of it is, otherwise unknown.
pub fn bake_exact(bytes: &[u8]) {
    let Ok(case) = Case::made(&mut Unstructured::new(bytes)) else { return };
    let Ok(texture) = Texture::unorm8(case.width, case.height, case.values.clone()) else { return };
    let input = BakeInput { texture: &texture, uvs: &case.uvs, triangles: &[[0, 1, 2]] };
    let options = BakeOptions {
        level: LevelChoice::Uniform(case.level),
        sampler: case.sampler,
        alpha_cutoff: case.cutoff,
        special_indices: false,
        ..BakeOptions::default()
    };
    let output = match bake(&input, &options, &|_| {}) {
        Ok(output) => output,
        Err(error) => panic!("{error}: {case:?}"),
    };
    let values: Vec<f64> = case.values.iter().map(|&value| value.into()).collect();
    let scene = Scene {
        width: case.width.into(),
        height: case.height.into(),
        values: &values,
        unit: 255.0,
        address_modes: [case.sampler.address_mode_u, case.sampler.address_mode_v],
        filter: case.sampler.filter,
        border: case.sampler.border_alpha,
        cutoff: case.cutoff,
    };
    for index in 0..case.level.microtriangles() {
        let Some(microtriangle) = MicroTriangle::new(case.level, index) else { panic!("{index} of {:?}", case.level) };
        let weights = microtriangle.corners().map(|corner| (corner.u, corner.v));
        let corners = Scene::corners::<BigRational>(case.uvs, weights, case.level.get());
        let expected = scene.classify(corners);
        let found = options.format.state(&output.array, index.into());
        let agree = match expected {
            Classification::Transparent => found == Some(OpacityState::Transparent),
            Classification::Opaque => found == Some(OpacityState::Opaque),
            _ => matches!(found, Some(OpacityState::UnknownTransparent | OpacityState::UnknownOpaque)),
        };
        assert!(agree, "microtriangle {index} is {found:?}, exactly it is {expected:?}: {case:?}");
    }
}
