//! A scene that needs no file: patches of ferns, which are made of cards, on the ground; a camera and a sun.
//!
//! Positions are metres, *y* up. Only basic arithmetic and square roots are used, so that every machine builds the same scene.

use omm_bake::{AddressMode, Filter, Sampler, Texture};
use omm_model::level::SubdivisionLevel;

use crate::camera::Camera;
use crate::error::RenderError;
use crate::random::Random;
use crate::scene::{Cutout, Mesh, Paint, Part, Placement, RenderScene};

pub mod fern;

/// The mesh of the ground, which is placed once.
pub const GROUND: usize = 0;
/// The mesh of a patch of ferns. Engines put small plants that do not move into one bottom-level structure, too.
pub const PATCH: usize = 1;

/// The level that saves nine of ten any-hit calls in the garden.
pub const LEVEL: SubdivisionLevel = match SubdivisionLevel::new(9) {
    Ok(level) => level,
    Err(_) => SubdivisionLevel::MAX,
};

/// Quads along a frond.
const SEGMENTS: u32 = 3;
/// Fronds of a plant.
const FRONDS: u32 = 7;
/// Plants along each side of a patch.
const PLANTS: u32 = 15;
/// Patches along each side of the garden.
const PATCHES: u32 = 2;
/// Metres between plants.
const SPACING: f64 = 0.45;

/// The scene: four patches of 225 ferns of 42 triangles, all with the same texture, and the ground under them.
///
/// # Errors
/// None in practice: the texture has a size, the camera a direction.
pub fn garden() -> Result<RenderScene, RenderError> {
    Ok(RenderScene {
        alphas: vec![Texture::unorm8(fern::SIZE, fern::SIZE, fern::alpha())?],
        colours: Vec::new(),
        meshes: vec![Mesh { parts: vec![ground()] }, Mesh { parts: vec![patch()] }],
        placements: std::iter::once(Placement { mesh: GROUND, transform: Placement::IDENTITY })
            .chain(patches())
            .collect(),
        camera: camera()?,
        sun: [0.48, 0.8, 0.36],
    })
}

/// Looks down on the patch, so that every ray meets something.
fn camera() -> Result<Camera, RenderError> {
    let (eye, forward, height) = ([0.0, 2.6, 5.2], [0.0, -1.0, -1.55], 0.84);
    Camera::new(eye, forward, [0.0, 1.0, 0.0], height).map_err(RenderError::from)
}

/// One fern: cards that rise from the root and bend outwards, each with the whole frond texture on it.
fn plant() -> Part {
    let sampler = Sampler::new(AddressMode::Clamp, Filter::Linear, 0.0);
    let mut mesh = Part {
        positions: Vec::new(),
        uvs: Vec::new(),
        triangles: Vec::new(),
        paint: Paint::Frond { plant: 2 * SEGMENTS * FRONDS },
        cutout: Some(Cutout { alpha: 0, sampler, alpha_cutoff: 0.5 }),
    };
    // Directions of the fronds: a seventh of a turn, repeated.
    let turn = (0.623_489_801_858_733_5, 0.781_831_482_468_029_8);
    let mut out = (1.0, 0.0);
    for frond in 0..FRONDS {
        let reach = if frond % 2 == 0 { 0.50 } else { 0.42 };
        let first = mesh.positions.len() as u32;
        for step in 0..=SEGMENTS {
            let along = f64::from(step) / f64::from(SEGMENTS);
            let (away, height) = (0.04 + reach * along, 0.75 * along - 0.42 * along * along);
            for side in [-1.0, 1.0] {
                // Wide, so that fronds overlap.
                let half_width = 0.25 * side;
                let x = out.0 * away - out.1 * half_width;
                let z = out.1 * away + out.0 * half_width;
                mesh.positions.push([x as f32, height as f32, z as f32]);
                mesh.uvs.push([if side < 0.0 { 0.0 } else { 1.0 }, 1.0 - along as f32]);
            }
        }
        for step in 0..SEGMENTS {
            let at = first + 2 * step;
            mesh.triangles.extend([[at, at + 1, at + 2], [at + 2, at + 1, at + 3]]);
        }
        out = (out.0 * turn.0 - out.1 * turn.1, out.0 * turn.1 + out.1 * turn.0);
    }
    mesh
}

/// The ground: two opaque triangles.
fn ground() -> Part {
    let half = 12.0;
    Part {
        positions: vec![[-half, 0.0, -half], [half, 0.0, -half], [-half, 0.0, half], [half, 0.0, half]],
        uvs: Vec::new(),
        triangles: vec![[0, 1, 2], [2, 1, 3]],
        paint: Paint::Earth,
        cutout: None,
    }
}

/// Ferns: a grid shaken, turned and scaled by chance.
fn patch() -> Part {
    let fern = plant();
    let (paint, cutout) = (fern.paint, fern.cutout);
    let mut all = Part { positions: Vec::new(), uvs: Vec::new(), triangles: Vec::new(), paint, cutout };
    let mut random = Random::new(2026);
    for [row, column] in grid(PLANTS) {
        let (turn_x, turn_z) = direction(&mut random);
        let scale = random.between(0.75, 1.35);
        let [x, z] = [column, row].map(|at| (at + random.between(-0.4, 0.4)) * SPACING);
        let (c, s) = ((turn_x * scale) as f32, (turn_z * scale) as f32);
        let transform = [[c, 0.0, s, x as f32], [0.0, scale as f32, 0.0, 0.0], [-s, 0.0, c, z as f32]];
        let placement = Placement { mesh: PATCH, transform };
        let first = all.positions.len() as u32;
        all.positions.extend(fern.positions.iter().map(|&position| placement.apply(position).map(|x| x as f32)));
        all.uvs.extend_from_slice(&fern.uvs);
        all.triangles.extend(fern.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
    }
    all
}

/// Where the patches lie: side by side, each a quarter turn from the one before.
fn patches() -> Vec<Placement> {
    let turns = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];
    let placement = |([row, column], (c, s)): ([f64; 2], (f32, f32))| {
        let [x, z] = [column, row].map(|at| (at * f64::from(PLANTS) * SPACING) as f32);
        Placement { mesh: PATCH, transform: [[c, 0.0, s, x], [0.0, 1.0, 0.0, 0.0], [-s, 0.0, c, z]] }
    };
    grid(PATCHES).zip(turns.into_iter().cycle()).map(placement).collect()
}

/// The places of a square grid around 0, row by row.
fn grid(side: u32) -> impl Iterator<Item = [f64; 2]> {
    let at = move |place: u32| f64::from(place) - f64::from(side - 1) / 2.0;
    (0..side).flat_map(move |row| (0..side).map(move |column| [at(row), at(column)]))
}

/// A direction in the plane, by rejection.
fn direction(random: &mut Random) -> (f64, f64) {
    loop {
        let (x, y) = (random.between(-1.0, 1.0), random.between(-1.0, 1.0));
        let square = x * x + y * y;
        if (0.01..1.0).contains(&square) {
            let length = square.sqrt();
            return (x / length, y / length);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meshes_are_indexed_in_range() {
        let garden = garden().unwrap();
        for part in garden.meshes.iter().flat_map(|mesh| &mesh.parts) {
            assert!(part.triangles.iter().flatten().all(|&index| (index as usize) < part.positions.len()));
            assert!(part.uvs.is_empty() || part.uvs.len() == part.positions.len());
        }
        assert_eq!(garden.meshes[PATCH].parts[0].triangles.len(), 9450);
        assert_eq!(garden.placements.len(), 1 + 4);
    }

    #[test]
    fn every_pixel_looks_down() {
        let camera = garden().unwrap().camera;
        for pixel in [[0.5, 0.5], [959.5, 0.5], [0.5, 539.5], [959.5, 539.5], [480.0, 270.0]] {
            assert!(camera.direction(pixel, [960, 540])[1] < -0.05, "{pixel:?}");
        }
    }
}
